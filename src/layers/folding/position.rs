//! Position functions: local time τ in [0, 1] to s, the place along the jump path (folding.md, section 5).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A position function: where along its jump path a sampler is at each local time τ. 0 is its own pixel, 1 the end.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "function", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Position {
    /// s = τ.
    #[default]
    Linear,
    /// s = (e^(kτ) - 1) / (e^k - 1): slow, then fast.
    Exponential {
        /// k, not 0; negative turns the curve over.
        #[serde(default = "three")]
        #[schemars(range(min = -500.0, max = 500.0))]
        rate: f64,
    },
    /// s = (1 - e^(-kτ)) / (1 - e^(-k)): fast, then slow.
    ExponentialInverse {
        /// k, not 0; negative turns the curve over.
        #[serde(default = "three")]
        #[schemars(range(min = -500.0, max = 500.0))]
        rate: f64,
    },
    /// The logistic curve through (0, 0) and (1, 1): slow at both ends.
    Sigmoid {
        /// k, not 0; larger is steeper in the middle.
        #[serde(default = "ten")]
        #[schemars(range(min = -500.0, max = 500.0))]
        rate: f64,
    },
    /// s = offset + amplitude sin(2π (cycles τ + phase)).
    Sine {
        /// Cycles in one pass.
        #[serde(default = "half")]
        #[schemars(range(min = -10000.0, max = 10000.0))]
        cycles: f64,
        /// Phase.
        #[serde(default)]
        #[schemars(range(min = -10000.0, max = 10000.0), extend("unit" = "cycles"))]
        phase: f64,
        /// Amplitude, as a share of the path.
        #[serde(default = "one")]
        #[schemars(range(min = -1e6, max = 1e6))]
        amplitude: f64,
        /// Middle, as a share of the path.
        #[serde(default)]
        #[schemars(range(min = -1e6, max = 1e6))]
        offset: f64,
    },
    /// s = offset + amplitude (1 - cos(2π (cycles τ + phase))) / 2: from 0 to 1 and back.
    Cosine {
        /// Cycles in one pass.
        #[serde(default = "one")]
        #[schemars(range(min = -10000.0, max = 10000.0))]
        cycles: f64,
        /// Phase.
        #[serde(default)]
        #[schemars(range(min = -10000.0, max = 10000.0), extend("unit" = "cycles"))]
        phase: f64,
        /// Height, as a share of the path.
        #[serde(default = "one")]
        #[schemars(range(min = -1e6, max = 1e6))]
        amplitude: f64,
        /// Lowest place, as a share of the path.
        #[serde(default)]
        #[schemars(range(min = -1e6, max = 1e6))]
        offset: f64,
    },
    /// CSS easing: a cubic Bezier from (0, 0) to (1, 1) with two handles.
    CubicBezier {
        /// First handle, τ.
        #[schemars(range(min = 0.0, max = 1.0))]
        x1: f64,
        /// First handle, s.
        #[schemars(range(min = -1e6, max = 1e6))]
        y1: f64,
        /// Second handle, τ.
        #[schemars(range(min = 0.0, max = 1.0))]
        x2: f64,
        /// Second handle, s.
        #[schemars(range(min = -1e6, max = 1e6))]
        y2: f64,
    },
    /// Through given points; constant before the first and after the last.
    Keyframes {
        /// [τ, s] with ascending τ.
        #[schemars(length(min = 1), extend("columns" = ["τ", "s"]))]
        points: Vec<[f64; 2]>,
        /// What happens between two points.
        #[serde(default)]
        between: Between,
    },
    /// Segments, each with its own easing; jumps in s between them are allowed.
    Piecewise {
        /// The segments, ascending; the last ends at 1.
        #[schemars(length(min = 1))]
        segments: Vec<Segment>,
    },
}

/// What happens between two keyframes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Between {
    /// A straight line.
    #[default]
    Linear,
    /// A smooth monotone curve (Fritsch and Carlson).
    Smooth,
    /// Nothing: the new value is taken at its τ.
    Step,
}

/// One segment of a piecewise position function.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Segment {
    /// Local time τ at which the segment ends; it begins where the one before ends.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub until: f64,
    /// s at its beginning.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub from: f64,
    /// s at its end.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub to: f64,
    /// How it gets there: any function but piecewise.
    #[serde(default)]
    pub ease: Box<Position>,
}

fn half() -> f64 {
    0.5
}
fn one() -> f64 {
    1.0
}
fn three() -> f64 {
    3.0
}
fn ten() -> f64 {
    10.0
}
