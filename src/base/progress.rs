//! How far long work is: counted where it is done, reported in whole percent.

use std::fmt;
use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};

/// Counts pieces of work on any number of threads, and reports each new percentage once.
pub struct Progress {
    all: AtomicU64,
    done: AtomicU64,
    told: AtomicU8,
    tell: Box<dyn Fn(u8) + Send + Sync>,
}

impl Progress {
    /// Work of which nothing is known yet. `tell` is given percentages, 1 to 100, on the threads that do the work.
    pub fn new(tell: impl Fn(u8) + Send + Sync + 'static) -> Progress {
        let (all, done, told) = (AtomicU64::new(0), AtomicU64::new(0), AtomicU8::new(0));
        Progress { all, done, told, tell: Box::new(tell) }
    }

    /// So many pieces are still to be done, beside those expected before. What was told is not taken back.
    pub fn expect(&self, pieces: u64) {
        self.all.fetch_add(pieces, Ordering::Relaxed);
    }

    /// So many pieces are done.
    pub fn done(&self, pieces: u64) {
        let done = self.done.fetch_add(pieces, Ordering::Relaxed) + pieces;
        let all = self.all.load(Ordering::Relaxed).max(1);
        let percent = (u128::from(done) * 100 / u128::from(all)).min(100) as u8;
        if self.told.fetch_max(percent, Ordering::Relaxed) < percent {
            (self.tell)(percent);
        }
    }
}

/// What watches over long work.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Whether it should end.
    pub stopped: &'a (dyn Fn() -> bool + Sync),
    /// Called with the index of each piece that is done.
    pub done: &'a (dyn Fn(usize) + Sync),
}

impl Watch<'_> {
    /// Nobody watches: it never ends early, and no piece is counted.
    pub const NONE: Watch<'static> = Watch { stopped: &|| false, done: &|_| () };
}

impl fmt::Debug for Progress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} of {:?}", self.done, self.all)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::{Arc, Mutex};

    use super::*;

    #[test]
    fn every_per_cent_is_told_once_and_none_is_taken_back() {
        let told = Arc::new(Mutex::new(Vec::new()));
        let heard = told.clone();
        let progress = Progress::new(move |percent| heard.lock().unwrap().push(percent));
        progress.expect(1000);
        (0..15).for_each(|_| progress.done(3));
        progress.done(455);
        progress.expect(1000);
        progress.done(100);
        progress.done(1400);
        assert_eq!(*told.lock().unwrap(), [1, 2, 3, 4, 50, 100]);
    }
}
