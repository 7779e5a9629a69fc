//! Time, shared by all techniques (docs/folding.md, section 1): the timeline of a scene and the local time of what plays on
//! it, all in double precision.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How long a scene plays and what follows its end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Timeline {
    /// Length of one pass.
    #[schemars(range(min = 0.0, max = 86400.0), extend("unit" = "s"))]
    pub duration: f64,
    /// Frames per second.
    #[schemars(range(min = 0.001, max = 1000.0), extend("unit" = "fps"))]
    pub fps: f64,
    /// What follows the end.
    #[serde(rename = "loop")]
    pub wrap: Wrap,
}

/// What follows the end of a timeline.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Wrap {
    /// The beginning, at once: frame n would equal frame 0 and is not written.
    #[default]
    Repeat,
    /// There and back in one pass.
    PingPong,
    /// Nothing: the end holds.
    Once,
}

impl Default for Timeline {
    fn default() -> Self {
        Timeline { duration: 2.0, fps: 30.0, wrap: Wrap::Repeat }
    }
}

impl Timeline {
    /// Number of frames, at least 1.
    pub fn frames(&self) -> u64 {
        ((self.duration * self.fps + 0.5).floor() as u64).max(1)
    }

    /// Scene time t of frame `k`, in [0, 1].
    pub fn time_of(&self, k: u64) -> f64 {
        let n = self.frames();
        match self.wrap {
            Wrap::Repeat | Wrap::PingPong => k as f64 / n as f64,
            Wrap::Once => k as f64 / n.saturating_sub(1).max(1) as f64,
        }
    }
}

impl Wrap {
    /// The local time τ in [0, 1] of x = speed (t + shift).
    pub fn wrap(self, x: f64) -> f64 {
        let part = x - x.floor();
        match self {
            Wrap::Repeat => part,
            Wrap::PingPong => 1.0 - (1.0 - 2.0 * part).abs(),
            Wrap::Once => x.clamp(0.0, 1.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_and_their_times() {
        let mut timeline = Timeline { duration: 2.0, fps: 2.0, wrap: Wrap::Repeat };
        assert_eq!(timeline.frames(), 4);
        assert_eq!(timeline.time_of(1), 0.25);
        timeline.wrap = Wrap::Once;
        assert_eq!(timeline.time_of(3), 1.0);
        timeline.duration = 0.0;
        assert_eq!((timeline.frames(), timeline.time_of(0)), (1, 0.0));
    }

    #[test]
    fn wraps() {
        for (wrap, x, tau) in [
            (Wrap::Repeat, 1.25, 0.25),
            (Wrap::Repeat, -0.25, 0.75),
            (Wrap::PingPong, 0.25, 0.5),
            (Wrap::PingPong, 0.5, 1.0),
            (Wrap::PingPong, -0.25, 0.5),
            (Wrap::Once, 1.5, 1.0),
            (Wrap::Once, -0.5, 0.0),
        ] {
            assert_eq!(wrap.wrap(x), tau, "{wrap:?} {x}");
        }
    }
}
