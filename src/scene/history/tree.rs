//! The states that a document has been in, as a tree: an edit after an undo begins another branch, and no state is ever
//! forgotten. States are numbered in the order in which they were created; the first is 0.

use crate::scene::Edit;

/// When and how an edit was made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stamp {
    /// Milliseconds since the epoch.
    pub time_ms: u64,
    /// Whether by a key held down: if it only replaces what the edit before it wrote, the two become one step.
    pub held: bool,
}

/// One step: it leads from the state `before` to the state with the step's number.
#[derive(Clone, Debug)]
pub struct Step {
    /// Its number in the journal.
    pub(super) id: u64,
    pub(super) edit: Edit,
    pub(super) inverse: Edit,
    /// When it last grew, in milliseconds since the epoch.
    pub time_ms: u64,
    /// Whether the next edit by a held key may still join it.
    open: bool,
    /// The state before it.
    pub(super) before: usize,
    /// Of the states after it, the one that was left last: redo goes there.
    next: Option<usize>,
}

/// A way from one state to another: back by undoing steps, then forward to other states.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Route {
    /// The number of steps to undo.
    pub back: usize,
    /// The states to reach, in order.
    pub on: Vec<usize>,
}

/// All states, and which one is current.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    steps: Vec<Step>,
    here: usize,
    /// Of the states after the first state, the one that was left last.
    first: Option<usize>,
    next_id: u64,
}

impl Tree {
    /// The current state.
    pub fn here(&self) -> usize {
        self.here
    }

    /// The state that was created last.
    pub fn newest(&self) -> usize {
        self.steps.len()
    }

    /// The step that leads to a state; `None` for the first state.
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

    /// The current state and those before it, current first, without the first state.
    pub fn behind(&self) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(self.here), |state| self.before(*state)).filter(|state| *state > 0)
    }

    /// The states that redo leads to, in order.
    pub fn ahead(&self) -> impl Iterator<Item = usize> {
        std::iter::successors(self.next(self.here), |state| self.next(*state))
    }

    /// Records an edit that was made: as a new state, or as part of the step to the current one. Returns the step's
    /// number.
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

    /// A tree with only the current state; numbers that are in use stay reserved.
    pub fn begun_anew(self) -> Tree {
        Tree { next_id: self.next_id, ..Tree::default() }
    }

    /// Marks a step number as used.
    pub fn reserve(&mut self, id: u64) {
        self.next_id = self.next_id.max(id + 1);
    }

    /// Marks an unused step number as used and returns it.
    pub fn reserve_next(&mut self) -> u64 {
        self.next_id += 1;
        self.next_id - 1
    }

    /// Ends the current step: a held key that follows begins a new one.
    pub fn close(&mut self) {
        if let Some(last) = self.step_mut(self.here) {
            last.open = false;
        }
    }

    /// Makes the state before the current one.
    pub fn go_back(&mut self) {
        self.close();
        if let Some(before) = self.before(self.here) {
            let left = std::mem::replace(&mut self.here, before);
            self.set_next(before, left);
            self.close();
        }
    }

    /// Makes a state right after the current one the current one.
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

    /// The state right after the current one that `edit` leads to: the one whose step is `id`, otherwise the newest.
    pub fn after_by(&self, edit: &Edit, id: u64) -> Option<usize> {
        let fits = |state: &usize| self.step(*state).is_some_and(|step| step.before == self.here && step.edit == *edit);
        // It is nearly always the one that was left last.
        let likely = self.next(self.here).filter(|next| fits(next) && self.step(*next).is_some_and(|s| s.id == id));
        likely.or_else(|| {
            let mut all = (1..=self.steps.len()).rev().filter(fits);
            let newest = all.next()?;
            let named = std::iter::once(newest).chain(all).find(|state| self.step(*state).is_some_and(|s| s.id == id));
            Some(named.unwrap_or(newest))
        })
    }

    /// For each state, by its number: the states right after it.
    pub fn after_each(&self) -> Vec<Vec<usize>> {
        let mut after = vec![Vec::new(); self.steps.len() + 1];
        self.steps.iter().zip(1..).for_each(|(step, state)| after[step.before].push(state));
        after
    }

    /// The way from the current state to another; `None` if there is no such state.
    pub fn route(&self, to: usize) -> Option<Route> {
        if to > self.steps.len() {
            return None;
        }
        // A state's number is greater than those of all states before it.
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
