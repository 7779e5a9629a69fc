//! The states that a document has been in, as a tree: an edit after an undo begins another branch, and no state is ever
//! forgotten. States are numbered in the order in which they came to be, from 0, the one at the beginning.

use super::Stamp;
use crate::scene::Edit;

/// One step: what leads to the state that has its number from the state before.
#[derive(Clone, Debug)]
pub struct Step {
    /// Its name in the journal.
    pub(super) id: u64,
    pub(super) edit: Edit,
    pub(super) inverse: Edit,
    /// The last time it grew, in milliseconds since the epoch.
    pub time_ms: u64,
    /// Whether it may still take in a held key.
    open: bool,
    /// The state before it.
    pub(super) before: usize,
    /// The state after it that was left last: redo goes there.
    next: Option<usize>,
}

/// A way from one state to another: back by undoing so many steps, then on to these states.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Route {
    /// Steps to be undone.
    pub back: usize,
    /// States to be reached one after another.
    pub on: Vec<usize>,
}

/// All states and the present one.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    steps: Vec<Step>,
    here: usize,
    /// The state after the first one that was left last.
    first: Option<usize>,
    next_id: u64,
}

impl Tree {
    /// The present state.
    pub fn here(&self) -> usize {
        self.here
    }

    /// The state that came to be last.
    pub fn newest(&self) -> usize {
        self.steps.len()
    }

    /// The step that leads to a state; none leads to the first one.
    pub fn step(&self, state: usize) -> Option<&Step> {
        self.steps.get(state.checked_sub(1)?)
    }

    fn step_mut(&mut self, state: usize) -> Option<&mut Step> {
        self.steps.get_mut(state.checked_sub(1)?)
    }

    /// The state before.
    pub fn before(&self, state: usize) -> Option<usize> {
        self.step(state).map(|step| step.before)
    }

    /// The state that redo leads to.
    pub fn next(&self, state: usize) -> Option<usize> {
        if state == 0 { self.first } else { self.step(state)?.next }
    }

    /// The present state and those before it, the present one first and without the one at the beginning.
    pub fn behind(&self) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(self.here), |state| self.before(*state)).filter(|state| *state > 0)
    }

    /// The states that redo leads to, one after another.
    pub fn ahead(&self) -> impl Iterator<Item = usize> {
        std::iter::successors(self.next(self.here), |state| self.next(*state))
    }

    /// Notes an edit that was made: a new state, or the present one grown. Gives the step's name.
    pub fn note(&mut self, edit: Edit, inverse: Edit, stamp: Stamp, id: Option<u64>) -> u64 {
        let open = self.step_mut(self.here).filter(|last| stamp.held && last.open);
        let joined = match open {
            Some(last) => last.edit.absorb(edit).map(|()| last),
            None => Err(edit),
        };
        match joined {
            Ok(last) => {
                last.time_ms = stamp.time_ms;
                last.id
            }
            Err(edit) => {
                let id = id.unwrap_or(self.next_id);
                self.next_id = self.next_id.max(id + 1);
                let (time_ms, before) = (stamp.time_ms, self.here);
                self.steps.push(Step { id, edit, inverse, time_ms, open: true, before, next: None });
                self.arrive(self.steps.len());
                id
            }
        }
    }

    /// No states but the present one; names that were taken stay so.
    pub fn begun_anew(self) -> Tree {
        Tree { next_id: self.next_id, ..Tree::default() }
    }

    /// A name in the journal that is taken.
    pub fn reserve(&mut self, id: u64) {
        self.next_id = self.next_id.max(id + 1);
    }

    /// A name in the journal that was not taken.
    pub fn reserve_next(&mut self) -> u64 {
        self.next_id += 1;
        self.next_id - 1
    }

    /// Ends the present step: a held key that follows begins another.
    pub fn close(&mut self) {
        if let Some(last) = self.step_mut(self.here) {
            last.open = false;
        }
    }

    /// The state before becomes the present one.
    pub fn go_back(&mut self) {
        self.close();
        if let Some(before) = self.before(self.here) {
            let left = std::mem::replace(&mut self.here, before);
            self.set_next(before, left);
            self.close();
        }
    }

    /// A state right after the present one becomes the present one.
    pub fn arrive(&mut self, state: usize) {
        self.set_next(self.here, state);
        self.here = state;
    }

    fn set_next(&mut self, of: usize, next: usize) {
        match self.step_mut(of) {
            Some(step) => step.next = Some(next),
            None => self.first = Some(next),
        }
    }

    /// The state right after the present one that `edit` leads to: the one called `id`, or else the newest.
    pub fn after_by(&self, edit: &Edit, id: u64) -> Option<usize> {
        let fits = |state: &usize| self.step(*state).is_some_and(|step| step.before == self.here && step.edit == *edit);
        // The one that was left last is it nearly always.
        let likely = self.next(self.here).filter(|next| fits(next) && self.step(*next).is_some_and(|s| s.id == id));
        likely.or_else(|| {
            let mut all = (1..=self.steps.len()).rev().filter(fits);
            let newest = all.next()?;
            let named = std::iter::once(newest).chain(all).find(|state| self.step(*state).is_some_and(|s| s.id == id));
            Some(named.unwrap_or(newest))
        })
    }

    /// The states right after each state, by its number.
    pub fn after_each(&self) -> Vec<Vec<usize>> {
        let mut after = vec![Vec::new(); self.steps.len() + 1];
        self.steps.iter().zip(1..).for_each(|(step, state)| after[step.before].push(state));
        after
    }

    /// The way from the present state to another. `None` if there is no such state.
    pub fn route(&self, to: usize) -> Option<Route> {
        if to > self.steps.len() {
            return None;
        }
        // A state's number is greater than that of every state before it.
        let (mut back, mut on) = (0, Vec::new());
        let (mut from, mut at) = (self.here, to);
        while from != at {
            if from > at {
                (back, from) = (back + 1, self.before(from)?);
            } else {
                on.push(at);
                at = self.before(at)?;
            }
        }
        on.reverse();
        Some(Route { back, on })
    }
}
