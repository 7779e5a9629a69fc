//! Sprites that are left out while it plays or a key is held, where frames would take too long otherwise; at rest all are shown.

/// A frame that takes longer than this, in seconds, shows fewer sprites from then on.
const LONGEST: f64 = 0.04;
/// One that takes no longer than this shows more again: twice as many would still be fast enough.
const SHORT: f64 = 0.015;
/// So many frames have to agree.
const FRAMES: u32 = 4;
/// How many births are left out after each that is shown.
const STEPS: [u32; 3] = [0, 1, 3];
/// Those in words.
const WORDS: [Option<&str>; 3] = [None, Some("every second sprite"), Some("every fourth sprite")];

/// How many sprites are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Thin {
    /// An index of [`STEPS`].
    step: usize,
    /// How many frames in a row were too slow, or fast enough.
    slow: u32,
    fast: u32,
}

impl Thin {
    /// How many births are left out after each that is shown.
    pub fn left_out(&self) -> u32 {
        STEPS[self.step]
    }

    /// The same in words, if any are left out.
    pub fn words(&self) -> Option<&'static str> {
        WORDS[self.step]
    }

    /// A frame took so many seconds while one followed the other.
    pub fn took(&mut self, seconds: f64) {
        let count = |is: bool, before: u32| if is { before + 1 } else { 0 };
        self.slow = count(seconds > LONGEST, self.slow);
        self.fast = count(seconds < SHORT, self.fast);
        let step = match (self.slow >= FRAMES, self.fast >= FRAMES) {
            (true, _) => (self.step + 1).min(STEPS.len() - 1),
            (_, true) => self.step.saturating_sub(1),
            _ => return,
        };
        *self = Thin { step, ..Thin::default() };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slow_frames_show_fewer_sprites_and_fast_ones_more() {
        let mut thin = Thin::default();
        let mut after = |times: u32, seconds: f64| {
            (0..times).for_each(|_| thin.took(seconds));
            thin.left_out()
        };
        assert_eq!(after(3, 0.2), 0, "a few slow frames are nothing");
        assert_eq!(after(1, 0.03), 0);
        assert_eq!((after(3, 0.2), after(1, 0.2), after(4, 0.1), after(9, 0.1)), (0, 1, 3, 3));
        assert_eq!((after(9, 0.03), after(4, 0.01), after(4, 0.01), after(4, 0.01)), (3, 1, 0, 0));
    }
}
