//! Whether changes come one right after the other, as from a key that is held: pictures are then made in as much of a hurry as
//! while it plays. A value that reads no clock.

use std::time::{Duration, Instant};

/// A change that follows within this time is one of several.
const SOON: Duration = Duration::from_millis(400);

/// When the last change was, and whether it followed another.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hurry {
    last: Option<Instant>,
    quick: bool,
}

impl Hurry {
    /// Something that is shown has changed.
    pub fn changed(&mut self, now: Instant) {
        self.quick = self.last.is_some_and(|last| now.saturating_duration_since(last) < SOON);
        self.last = Some(now);
    }

    /// When it ends, if there is one.
    pub fn ends(&self) -> Option<Instant> {
        self.last.filter(|_| self.quick).map(|last| last + SOON)
    }

    /// Whether there is one at this moment.
    pub fn is_on(&mut self, now: Instant) -> bool {
        self.quick &= self.ends().is_some_and(|end| now < end);
        self.quick
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_that_follow_one_another_are_a_hurry_until_they_stop() {
        let (begin, mut hurry) = (Instant::now(), Hurry::default());
        let at = |ms: u64| begin + Duration::from_millis(ms);
        for (ms, changes, is_on) in [
            (0, true, false),
            (100, true, true),
            (450, true, true),
            (849, false, true),
            (850, false, false),
            (900, false, false),
            (1000, true, false),
        ] {
            if changes {
                hurry.changed(at(ms));
            }
            assert_eq!(hurry.is_on(at(ms)), is_on, "{ms}");
            assert_eq!(hurry.ends().is_some(), is_on, "{ms}");
        }
    }
}
