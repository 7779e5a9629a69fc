//! Undo and redo, without end: the present document, and every edit that led to it with its inverse. A value: no files,
//! no clock; times come in.

use serde_json::Value;

use super::check::Rules;
use super::edit::Copies;
use super::{Document, Edit, words};
use crate::base::problem::Problem;

/// When and how an edit was made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stamp {
    /// Milliseconds since the epoch.
    pub time_ms: u64,
    /// By a key held down: it joins the edit before it where it only replaces what that one wrote, into one step.
    pub held: bool,
}

/// What a change of the history did, as the journal and the link want it.
#[derive(Clone, Debug, PartialEq)]
pub struct Applied {
    /// The revision it led to; every change has one of its own, undo and redo too.
    pub revision: u64,
    /// The step it belongs to: edits that share it are undone as one.
    pub step: u64,
    /// What was applied.
    pub edit: Edit,
    /// What takes it back.
    pub inverse: Edit,
}

/// One step of undo.
#[derive(Clone, Debug)]
pub struct Step {
    id: u64,
    edit: Edit,
    inverse: Edit,
    /// The last time it grew, in milliseconds since the epoch.
    pub time_ms: u64,
    /// Whether it may still take in a held key.
    open: bool,
    /// Names of the states before and after it.
    before: u64,
    after: u64,
}

/// A document with its past and its undone future.
#[derive(Clone, Debug)]
pub struct History {
    document: Document,
    revision: u64,
    /// The name of the present state: undo comes back to the same one.
    state: u64,
    saved: Option<u64>,
    next_step: u64,
    done: Vec<Step>,
    undone: Vec<Step>,
}

impl History {
    /// The history of a document that was just read from its file.
    pub fn new(document: Document) -> History {
        History { document, revision: 0, state: 0, saved: Some(0), next_step: 0, done: Vec::new(), undone: Vec::new() }
    }

    /// The document as it is now.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// From now on edits are checked by these rules.
    pub fn govern(&mut self, rules: Rules) {
        self.document.govern(rules);
    }

    /// How many changes there were, undo and redo included.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Applies an edit; what was undone is forgotten. None where the edit changes nothing.
    pub fn apply(&mut self, edit: Edit, stamp: Stamp) -> Result<Option<Applied>, Vec<Problem>> {
        let Some((document, inverse)) = self.document.change(&edit)? else { return Ok(None) };
        self.document = document;
        let step = self.note(edit.clone(), inverse.clone(), stamp);
        Ok(Some(Applied { revision: self.revision, step, edit, inverse }))
    }

    /// Notes an edit that was applied; gives its step.
    fn note(&mut self, edit: Edit, inverse: Edit, stamp: Stamp) -> u64 {
        self.revision += 1;
        self.undone.clear();
        let before = std::mem::replace(&mut self.state, self.revision);
        let open = self.done.last_mut().filter(|last| stamp.held && last.open);
        let joined = match open {
            Some(last) => last.edit.absorb(edit).map(|()| last),
            None => Err(edit),
        };
        match joined {
            Ok(last) => {
                (last.time_ms, last.after) = (stamp.time_ms, self.state);
                last.id
            }
            Err(edit) => {
                let id = self.next_step;
                self.next_step += 1;
                let time_ms = stamp.time_ms;
                self.done.push(Step { id, edit, inverse, time_ms, open: true, before, after: self.state });
                id
            }
        }
    }

    /// Ends the step: a held key that follows begins another.
    pub fn close_step(&mut self) {
        if let Some(last) = self.done.last_mut() {
            last.open = false;
        }
    }

    /// Takes the last step back; none where there is none.
    pub fn undo(&mut self) -> Option<Applied> {
        let mut step = self.done.pop()?;
        step.open = false;
        let applied = self.go(&step, step.inverse.clone(), step.edit.clone(), step.before);
        self.undone.push(step);
        self.close_step();
        applied
    }

    /// Does again what was undone last; none where there is nothing.
    pub fn redo(&mut self) -> Option<Applied> {
        let step = self.undone.pop()?;
        let applied = self.go(&step, step.edit.clone(), step.inverse.clone(), step.after);
        self.done.push(step);
        applied
    }

    fn go(&mut self, step: &Step, edit: Edit, inverse: Edit, state: u64) -> Option<Applied> {
        self.document = self.document.apply(&edit).ok()?;
        self.revision += 1;
        self.state = state;
        Some(Applied { revision: self.revision, step: step.id, edit, inverse })
    }

    /// Back to the document as it was at a time, in milliseconds since the epoch.
    pub fn earlier(&mut self, time_ms: u64) -> Vec<Applied> {
        let mut all = Vec::new();
        while self.done.last().is_some_and(|step| step.time_ms > time_ms) {
            all.extend(self.undo());
        }
        all
    }

    /// On to the document as it was at a time, as far as it was undone.
    pub fn later(&mut self, time_ms: u64) -> Vec<Applied> {
        let mut all = Vec::new();
        while self.undone.last().is_some_and(|step| step.time_ms <= time_ms) {
            all.extend(self.redo());
        }
        all
    }

    /// The steps that can be undone, the last one last.
    pub fn done(&self) -> &[Step] {
        &self.done
    }

    /// The steps that can be done again, the next one last.
    pub fn undone(&self) -> &[Step] {
        &self.undone
    }

    /// What the last `most` steps did, in words, the last one first.
    pub fn told(&self, most: usize) -> Vec<String> {
        let mut json = self.document.json().clone();
        let steps = self.done.iter().rev().take(most);
        let back = steps.map_while(|step| {
            step.inverse.patch(&mut json).ok()?;
            Some(words::in_short(&json, &step.edit))
        });
        back.collect()
    }

    /// What the next `most` steps to be done again will do, in words, the next one first.
    pub fn told_ahead(&self, most: usize) -> Vec<String> {
        let mut json = self.document.json().clone();
        let steps = self.undone.iter().rev().take(most);
        let ahead = steps.map_while(|step| {
            let words = words::in_short(&json, &step.edit);
            step.edit.patch(&mut json).ok().map(|_| words)
        });
        ahead.collect()
    }

    /// How many steps lie between the present and the last save: back by so many, or on. None where neither leads there.
    pub fn since_saved(&self) -> Option<(usize, usize)> {
        let back = self.done.iter().rev().position(|step| Some(step.before) == self.saved).map(|i| (i + 1, 0));
        let ahead = self.undone.iter().rev().position(|step| Some(step.after) == self.saved).map(|i| (0, i + 1));
        if self.is_saved() { Some((0, 0)) } else { back.or(ahead) }
    }

    /// How many steps can be undone and redone.
    pub fn depth(&self) -> (usize, usize) {
        (self.done.len(), self.undone.len())
    }

    /// The document as it is now was written to its file.
    pub fn mark_saved(&mut self) {
        self.saved = Some(self.state);
        self.close_step();
    }

    /// The file is not what any state was (it was recovered, or another program wrote it).
    pub fn mark_unsaved(&mut self) {
        self.saved = None;
    }

    /// Whether the document is what was last written; undo comes back to it.
    pub fn is_saved(&self) -> bool {
        self.saved == Some(self.state)
    }
}

/// A history made again from what a journal recorded. The changes were checked when they were made: only the document
/// they lead to is checked again, once, so that thousands of them cost no more than a moment.
#[derive(Debug)]
pub struct Replay {
    json: Value,
    history: History,
    copies: Copies,
}

impl Replay {
    /// Begins with the document before the first change; whether a file holds it is not known.
    pub fn new(document: Document) -> Replay {
        let json = document.json().clone();
        let mut history = History::new(document);
        history.mark_unsaved();
        Replay { json, history, copies: Copies::default() }
    }

    /// An edit and its inverse.
    ///
    /// # Errors
    /// When it cannot be applied; the replay is of no use any more.
    pub fn edit(&mut self, edit: &Edit, inverse: &Edit, stamp: Stamp) -> Result<(), Problem> {
        edit.patch_within(&mut self.json, &mut self.copies)?;
        self.history.note(edit.clone(), inverse.clone(), stamp);
        Ok(())
    }

    /// The undo that `edit` records. Where it takes back no step that is known, it is an edit like others.
    ///
    /// # Errors
    /// As [`Replay::edit`].
    pub fn undo(&mut self, edit: &Edit, inverse: &Edit, stamp: Stamp) -> Result<(), Problem> {
        let history = &mut self.history;
        let Some(mut step) = history.done.pop_if(|last| last.inverse == *edit) else {
            return self.edit(edit, inverse, stamp);
        };
        edit.patch_within(&mut self.json, &mut self.copies)?;
        step.open = false;
        (history.revision, history.state) = (history.revision + 1, step.before);
        history.undone.push(step);
        history.close_step();
        Ok(())
    }

    /// The redo that `edit` records; as [`Replay::undo`].
    ///
    /// # Errors
    /// As [`Replay::edit`].
    pub fn redo(&mut self, edit: &Edit, inverse: &Edit, stamp: Stamp) -> Result<(), Problem> {
        let history = &mut self.history;
        let Some(step) = history.undone.pop_if(|last| last.edit == *edit) else {
            return self.edit(edit, inverse, stamp);
        };
        edit.patch_within(&mut self.json, &mut self.copies)?;
        (history.revision, history.state) = (history.revision + 1, step.after);
        history.done.push(step);
        Ok(())
    }

    /// The document as it is now.
    pub fn json(&self) -> &Value {
        &self.json
    }

    /// The document was written to its file.
    pub fn saved(&mut self) {
        self.history.mark_saved();
    }

    /// The history, its last step closed.
    ///
    /// # Errors
    /// What is wrong with the document that the changes lead to.
    pub fn finish(self, rules: Rules) -> Result<History, Vec<Problem>> {
        let Replay { json, mut history, .. } = self;
        history.document = Document::from_json_under(json, rules)?;
        history.close_step();
        Ok(history)
    }
}
