//! The clock of a zone: from scene time to s (docs/folding.md, section 5).

use super::position::Position;
use crate::layers::timeline::Wrap;

/// A zone's clock: scene time to s.
#[derive(Clone, Debug, PartialEq)]
pub struct Clock {
    /// s = p(τ).
    pub position: Position,
    /// Passes in one timeline.
    pub speed: f64,
    /// Temporal shift in timelines.
    pub shift: f64,
    /// What follows the end.
    pub wrap: Wrap,
}

impl Clock {
    /// Local time τ in [0, 1] at `scene_time`.
    pub fn tau(&self, scene_time: f64) -> f64 {
        self.wrap.wrap(self.speed * (scene_time + self.shift))
    }

    /// The place s along the jump path at `scene_time`.
    pub fn s(&self, scene_time: f64) -> f64 {
        self.position.eval(self.tau(scene_time))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_wraps_before_it_evaluates() {
        let clock = Clock { position: Position::Linear, speed: -1.0, shift: 0.25, wrap: Wrap::Repeat };
        assert_eq!(clock.s(0.25), 0.5);
    }
}
