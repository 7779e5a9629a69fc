//! The current document, and every edit that was ever made, with its inverse. A plain value: no files, no clock; times are passed
//! in.

use serde_json::Value;

use super::tree::{Route, Stamp, Step, Tree};
use crate::base::problem::Problem;
use crate::scene::check::Rules;
use crate::scene::{Document, Edit, words};

/// What a change of the history did, for the journal and the link.
#[derive(Clone, Debug, PartialEq)]
pub struct Applied {
    /// The revision it led to; every change has its own, including undo and redo.
    pub revision: u64,
    /// The step it belongs to: edits with the same step are undone together.
    pub step: u64,
    /// The edit that was applied.
    pub edit: Edit,
    /// Its inverse.
    pub inverse: Edit,
}

/// In which direction a step was taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Undone.
    Back,
    /// Redone.
    On,
}

/// A step of another branch, in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Aside {
    /// The state that the step leads to.
    pub state: usize,
    /// The state before it.
    pub before: usize,
    /// When the step was made, in milliseconds since the epoch.
    pub time_ms: u64,
    /// What it did.
    pub words: String,
}

/// A document with its past and all other branches.
#[derive(Clone, Debug)]
pub struct History {
    pub(super) document: Document,
    pub(super) revision: u64,
    /// The state that is in the file.
    pub(super) saved: Option<usize>,
    pub(super) tree: Tree,
}

impl History {
    /// The history of a document that has just been read from its file.
    pub fn new(document: Document) -> History {
        History { document, revision: 0, saved: Some(0), tree: Tree::default() }
    }

    /// The document as it is now.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// From now on edits are checked by these rules.
    pub fn govern(&mut self, rules: Rules) {
        self.document.govern(rules);
    }

    /// How many changes there have been, including undo and redo.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Applies an edit; what was undone stays as another branch. `None` if the edit changes nothing.
    pub fn apply(&mut self, edit: Edit, stamp: Stamp) -> Result<Option<Applied>, Vec<Problem>> {
        let Some((document, inverse)) = self.document.change(&edit)? else { return Ok(None) };
        self.document = document;
        self.revision += 1;
        let step = self.tree.note(edit.clone(), inverse.clone(), stamp, None);
        Ok(Some(Applied { revision: self.revision, step, edit, inverse }))
    }

    /// Ends the step: a held key that follows begins a new one.
    pub fn close_step(&mut self) {
        self.tree.close();
    }

    /// The number of a step that is not in the history, for changes that are recorded all the same.
    pub fn reserve_step(&mut self) -> u64 {
        self.tree.reserve_next()
    }

    /// Undoes the last step; `None` if there is none.
    pub fn undo(&mut self) -> Option<Applied> {
        let step = self.tree.step(self.tree.here())?;
        let (id, edit, inverse) = (step.id, step.inverse.clone(), step.edit.clone());
        let applied = self.go(id, edit, inverse)?;
        self.tree.go_back();
        Some(applied)
    }

    /// Redoes what was undone last; `None` if there is nothing to redo.
    pub fn redo(&mut self) -> Option<Applied> {
        self.on_to(self.tree.next(self.tree.here())?)
    }

    fn on_to(&mut self, state: usize) -> Option<Applied> {
        let step = self.tree.step(state)?;
        let (id, edit, inverse) = (step.id, step.edit.clone(), step.inverse.clone());
        let applied = self.go(id, edit, inverse)?;
        self.tree.arrive(state);
        Some(applied)
    }

    fn go(&mut self, step: u64, edit: Edit, inverse: Edit) -> Option<Applied> {
        self.document = self.document.apply(&edit).ok()?;
        self.revision += 1;
        Some(Applied { revision: self.revision, step, edit, inverse })
    }

    /// Goes to a state, wherever it is: back to where its branch begins, then forward.
    pub fn go_to(&mut self, state: usize) -> Vec<(Way, Applied)> {
        let Some(route) = self.tree.route(state) else { return Vec::new() };
        let mut all = Vec::new();
        for _ in 0..route.back {
            let Some(applied) = self.undo() else { return all };
            all.push((Way::Back, applied));
        }
        for state in route.on {
            let Some(applied) = self.on_to(state) else { return all };
            all.push((Way::On, applied));
        }
        all
    }

    /// Goes back to the document as it was at a time, in milliseconds since the epoch, on whatever branch it was then.
    pub fn earlier(&mut self, time_ms: u64) -> Vec<(Way, Applied)> {
        let mut state = self.tree.here();
        while self.tree.step(state).is_some_and(|step| step.time_ms > time_ms) {
            state -= 1;
        }
        self.go_to(state)
    }

    /// Goes forward to the document as it was at a time.
    pub fn later(&mut self, time_ms: u64) -> Vec<(Way, Applied)> {
        let mut state = self.tree.here();
        while self.tree.step(state + 1).is_some_and(|step| step.time_ms <= time_ms) {
            state += 1;
        }
        self.go_to(state)
    }

    /// The current state. States are numbered from 0 in the order in which they were created.
    pub fn state(&self) -> usize {
        self.tree.here()
    }

    /// The state that was created last.
    pub fn newest(&self) -> usize {
        self.tree.newest()
    }

    /// The state before another; for the first state, itself.
    pub fn before(&self, state: usize) -> usize {
        self.tree.before(state).unwrap_or(0)
    }

    /// The way from the current state to another; `None` if there is no such state.
    pub fn route(&self, to: usize) -> Option<Route> {
        self.tree.route(to)
    }

    /// When the current state was created, in milliseconds since the epoch; for the first state, when it was left.
    pub fn time_ms(&self) -> u64 {
        self.tree.step(self.tree.here().max(1)).map_or(0, |step| step.time_ms)
    }

    /// The steps that can be undone, with the states that they lead to, last first.
    pub fn done(&self) -> impl Iterator<Item = (usize, &Step)> {
        self.tree.behind().filter_map(|state| Some((state, self.tree.step(state)?)))
    }

    /// The steps that can be redone, with the states that they lead to, next first.
    pub fn undone(&self) -> impl Iterator<Item = (usize, &Step)> {
        self.tree.ahead().filter_map(|state| Some((state, self.tree.step(state)?)))
    }

    /// What the last `most` steps did, in words, last first.
    pub fn told(&self, most: usize) -> Vec<String> {
        let mut json = self.document.json().clone();
        let back = self.done().take(most).map_while(|(_, step)| {
            step.inverse.patch(&mut json).ok()?;
            Some(words::in_short(&json, &step.edit))
        });
        back.collect()
    }

    /// What the next `most` steps to redo will do, in words, next first.
    pub fn told_ahead(&self, most: usize) -> Vec<String> {
        let mut json = self.document.json().clone();
        let ahead = self.undone().take(most).map_while(|(_, step)| {
            let words = words::in_short(&json, &step.edit);
            step.edit.patch(&mut json).ok().map(|_| words)
        });
        ahead.collect()
    }

    /// At most `most` steps of other branches, those that begin near the current state first.
    pub fn told_aside(&self, most: usize) -> Vec<Aside> {
        let after = self.tree.after_each();
        let mut json = self.document.json().clone();
        let ahead: Vec<usize> = self.tree.ahead().collect();
        if ahead.iter().any(|state| self.tree.step(*state).is_none_or(|step| step.edit.patch(&mut json).is_err())) {
            return Vec::new();
        }
        let mut told = Vec::new();
        let mut from = None;
        for at in ahead.iter().rev().copied().chain(self.tree.behind()).chain([0]) {
            // The state that the walk came from is on this branch.
            if after[at].iter().any(|state| Some(*state) != from) {
                self.tell_branches(&after, (at, from), &json, most, &mut told);
            }
            if told.len() >= most || self.tree.step(at).is_some_and(|step| step.inverse.patch(&mut json).is_err()) {
                break;
            }
            from = Some(at);
        }
        told
    }

    /// Adds the steps that follow the state `at`, except for the branch at `from`; `json` is the document at `at`.
    fn tell_branches(
        &self,
        after: &[Vec<usize>],
        (at, from): (usize, Option<usize>),
        json: &Value,
        most: usize,
        told: &mut Vec<Aside>,
    ) {
        let mut json = json.clone();
        // (state, true) enters a state, (state, false) leaves it again.
        let mut open: Vec<(usize, bool)> =
            after[at].iter().filter(|state| Some(**state) != from).map(|state| (*state, true)).collect();
        while let Some((state, on)) = open.pop() {
            let Some(step) = self.tree.step(state) else { continue };
            if !on {
                if step.inverse.patch(&mut json).is_err() {
                    return;
                }
                continue;
            }
            if told.len() >= most {
                return;
            }
            let words = words::in_short(&json, &step.edit);
            told.push(Aside { state, before: step.before, time_ms: step.time_ms, words });
            if step.edit.patch(&mut json).is_err() {
                return;
            }
            open.push((state, false));
            open.extend(after[state].iter().map(|state| (*state, true)));
        }
    }

    /// The state that is in the file; `None` if it is not known.
    pub fn saved(&self) -> Option<usize> {
        self.saved
    }

    /// How many steps can be undone and redone.
    pub fn depth(&self) -> (usize, usize) {
        (self.tree.behind().count(), self.tree.ahead().count())
    }

    /// Notes that the document as it is now was written to its file.
    pub fn mark_saved(&mut self) {
        self.saved = Some(self.tree.here());
        self.tree.close();
    }

    /// Notes that the file is not any known state (it was recovered, or another program wrote it).
    pub fn mark_unsaved(&mut self) {
        self.saved = None;
    }

    /// Whether the document is what was last written; undo can lead back to it.
    pub fn is_saved(&self) -> bool {
        self.saved == Some(self.tree.here())
    }
}
