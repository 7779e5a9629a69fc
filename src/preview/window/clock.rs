//! When frames were and are due, and how many there were.

use std::time::{Duration, Instant};

/// Frames are counted over this many seconds.
const COUNTED: f64 = 1.0;
/// A whole frame that is waited for has surely begun this much later.
const SURELY: f64 = 0.0005;

/// When frames were and are due.
pub struct Clock {
    last: Instant,
    due: Instant,
    counted_from: Instant,
    frames: u32,
    /// The number of drawings since the window opened.
    pub drawn: u64,
}

impl Default for Clock {
    fn default() -> Self {
        let now = Instant::now();
        Clock { last: now, due: now, counted_from: now, frames: 0, drawn: 0 }
    }
}

impl Clock {
    /// Time runs from now.
    pub fn start(&mut self) {
        *self = Clock { drawn: self.drawn, ..Clock::default() };
    }

    /// A frame is drawn: the seconds since the one before, and once a second how many there were in it.
    pub fn tick(&mut self) -> (f64, Option<f64>) {
        let now = Instant::now();
        let passed = (now - self.last).as_secs_f64();
        self.last = now;
        self.frames += 1;
        let counted = (now - self.counted_from).as_secs_f64();
        if counted < COUNTED {
            return (passed, None);
        }
        let rate = f64::from(self.frames) / counted;
        (self.counted_from, self.frames) = (now, 0);
        (passed, Some(rate))
    }

    /// When the next frame is due: after a frame of the display, or after the seconds that are left of a whole frame.
    pub fn next(&mut self, interval: Duration, rest: Option<f64>) -> Instant {
        let now = Instant::now();
        if let Some(rest) = rest {
            self.due = self.last + Duration::from_secs_f64(rest + SURELY);
        } else if self.due <= now {
            self.due = (self.due + interval).max(now);
        }
        self.due
    }
}
