//! Work that takes long in one piece, with its progress shown meanwhile.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use super::{Context, Progress};
use crate::base::error::Result;
use crate::base::progress::Watch;

/// How often progress is shown.
const EVERY: Duration = Duration::from_millis(200);

/// Runs `work` on a thread of its own and returns its result. `work` reports how many more of the `total` steps are done,
/// and `messages` shows that as steps of `what`; the last step is not shown, as the result follows.
pub fn watched<T: Send>(
    messages: &mut dyn Progress,
    what: &str,
    total: usize,
    work: impl FnOnce(&(dyn Fn(usize) + Sync)) -> T + Send,
) -> T {
    let done = &AtomicUsize::new(0);
    let count = |steps| {
        done.fetch_add(steps, Ordering::Relaxed);
    };
    told(messages, (what, total), || done.load(Ordering::Relaxed), || work(&count))
}

/// The same of work in so many pieces that is watched over: it ends if it is to be cancelled.
///
/// # Errors
/// It was.
pub fn in_pieces<T: Send>(
    context: &mut Context,
    what: &str,
    total: usize,
    work: impl FnOnce(&Watch) -> T + Send,
) -> Result<T> {
    let cancel = context.cancel.clone();
    let stopped = || cancel.load(Ordering::Relaxed);
    let messages = &mut *context.messages;
    let made = watched(messages, what, total, |done| work(&Watch { stopped: &stopped, done: &|_| done(1) }));
    context.check_cancelled()?;
    Ok(made)
}

/// The same of work that counts what it has done elsewhere.
pub fn told<T: Send>(
    messages: &mut dyn Progress,
    (what, total): (&str, usize),
    done: impl Fn() -> usize,
    work: impl FnOnce() -> T + Send,
) -> T {
    thread::scope(|scope| {
        let (working, end) = mpsc::channel::<()>();
        let worker = scope.spawn(move || {
            // Dropped with the end of the work.
            let _working = working;
            work()
        });
        while end.recv_timeout(EVERY) == Err(RecvTimeoutError::Timeout) {
            let done = done();
            if done < total {
                messages.step(what, done as u64, total as u64);
            }
        }
        worker.join().unwrap_or_else(|panic| resume_unwind(panic))
    })
}

#[cfg(test)]
mod tests {
    use std::panic::{AssertUnwindSafe, catch_unwind};

    use super::*;

    struct Heard(Vec<(u64, u64)>);

    impl Progress for Heard {
        fn say(&mut self, _line: &str) {}

        fn step(&mut self, _what: &str, done: u64, total: u64) {
            self.0.push((done, total));
        }
    }

    #[test]
    fn what_takes_long_is_shown_and_what_does_not_is_not() {
        let mut heard = Heard(Vec::new());
        assert_eq!(watched(&mut heard, "row", 9, |done| done(9)), ());
        assert_eq!(heard.0, []);
        let slow = |done: &(dyn Fn(usize) + Sync)| {
            done(4);
            thread::sleep(EVERY * 2);
            7
        };
        assert_eq!(watched(&mut heard, "row", 9, slow), 7);
        assert_eq!(heard.0.first(), Some(&(4, 9)));
        let failing = || watched(&mut heard, "row", 9, |_| panic!("as it must"));
        assert!(catch_unwind(AssertUnwindSafe(failing)).is_err());
    }
}
