//! When frames were and are due.

use std::time::Instant;

/// When frames were and are due.
pub struct Clock {
    pub last: Instant,
    pub due: Instant,
    pub counted_from: Instant,
    pub frames: u32,
}

impl Clock {
    /// Time runs from now.
    pub fn start(&mut self) {
        let now = Instant::now();
        *self = Clock { last: now, due: now, counted_from: now, frames: 0 };
    }
}
