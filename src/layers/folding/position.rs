//! Position functions: local time τ in [0, 1] to s, the place along the jump path (docs/folding.md, section 5).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::base::maths::{TAU, cos, exp, expm1, sin, tanh};
use crate::base::problem::Problem;
use crate::layers::keyframes::{self, Between};

/// A position function: where along its jump path a sampler is at each local time τ. 0 is its own pixel, 1 the end.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "function", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Position {
    /// s = τ.
    #[schemars(extend("formula" = "s = τ"))]
    #[default]
    Linear,
    /// s = (e^(kτ) - 1) / (e^k - 1): slow, then fast.
    #[schemars(extend("formula" = "s = (e^(kτ) - 1) / (e^k - 1)"))]
    Exponential {
        /// k, not 0; a negative k swaps slow and fast.
        #[serde(default = "three")]
        #[schemars(range(min = -1e6, max = 1e6), extend("unit" = "1"))]
        rate: f64,
    },
    /// s = (1 - e^(-kτ)) / (1 - e^(-k)): fast, then slow.
    #[schemars(extend("formula" = "s = (1 - e^(-kτ)) / (1 - e^(-k))"))]
    ExponentialInverse {
        /// k, not 0; a negative k swaps slow and fast.
        #[serde(default = "three")]
        #[schemars(range(min = -1e6, max = 1e6), extend("unit" = "1"))]
        rate: f64,
    },
    /// The logistic curve through (0, 0) and (1, 1): slow at both ends.
    #[schemars(extend("formula" = "s = (σ(k(τ - 1/2)) - σ(-k/2)) / (σ(k/2) - σ(-k/2)), where σ(x) = 1 / (1 + e^-x)"))]
    Sigmoid {
        /// k; larger is steeper in the middle.
        #[serde(default = "ten")]
        #[schemars(range(min = -1e6, max = 1e6), extend("unit" = "1"))]
        rate: f64,
    },
    /// s = offset + amplitude sin(2π (cycles τ + phase)).
    #[schemars(extend("formula" = "s = offset + amplitude sin(2π (cycles τ + phase))"))]
    Sine {
        /// Cycles in one pass.
        #[serde(default = "half")]
        #[schemars(range(min = -10000.0, max = 10000.0), extend("unit" = "1"))]
        cycles: f64,
        /// Phase.
        #[serde(default)]
        #[schemars(range(min = -10000.0, max = 10000.0), extend("unit" = "cycles"))]
        phase: f64,
        /// Amplitude, as a share of the path.
        #[serde(default = "one")]
        #[schemars(range(min = -1e6, max = 1e6), extend("unit" = "1"))]
        amplitude: f64,
        /// Middle, as a share of the path.
        #[serde(default)]
        #[schemars(range(min = -1e6, max = 1e6), extend("unit" = "1"))]
        offset: f64,
    },
    /// s = offset + amplitude (1 - cos(2π (cycles τ + phase))) / 2: from 0 to 1 and back.
    #[schemars(extend("formula" = "s = offset + amplitude (1 - cos(2π (cycles τ + phase))) / 2"))]
    Cosine {
        /// Cycles in one pass.
        #[serde(default = "one")]
        #[schemars(range(min = -10000.0, max = 10000.0), extend("unit" = "1"))]
        cycles: f64,
        /// Phase.
        #[serde(default)]
        #[schemars(range(min = -10000.0, max = 10000.0), extend("unit" = "cycles"))]
        phase: f64,
        /// Height, as a share of the path.
        #[serde(default = "one")]
        #[schemars(range(min = -1e6, max = 1e6), extend("unit" = "1"))]
        amplitude: f64,
        /// Lowest place, as a share of the path.
        #[serde(default)]
        #[schemars(range(min = -1e6, max = 1e6), extend("unit" = "1"))]
        offset: f64,
    },
    /// CSS easing: a cubic Bezier from (0, 0) to (1, 1) with two handles.
    #[schemars(extend("formula" = "s = 3(1-u)²u y1 + 3(1-u)u² y2 + u³ at the u where τ is the same of x1 and x2"))]
    CubicBezier {
        /// First handle, τ.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1"))]
        x1: f64,
        /// First handle, s.
        #[schemars(range(min = -1e6, max = 1e6), extend("unit" = "1"))]
        y1: f64,
        /// Second handle, τ.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1"))]
        x2: f64,
        /// Second handle, s.
        #[schemars(range(min = -1e6, max = 1e6), extend("unit" = "1"))]
        y2: f64,
    },
    /// Through given points; constant before the first and after the last.
    #[schemars(extend("formula" = "s = s0 + (s1 - s0) f((τ - τ0) / (τ1 - τ0)) between points 0 and 1; f by between"))]
    Keyframes {
        /// [τ, s] with ascending τ.
        #[schemars(length(min = 1), extend("unit" = "1", "columns" = ["τ", "s"]))]
        points: Vec<[f64; 2]>,
        /// What happens between two points.
        #[serde(default)]
        between: Between,
    },
    /// Segments, each with its own easing; jumps in s between them are allowed.
    #[schemars(extend("formula" = "s = from + (to - from) ease((τ - a) / (until - a)) for a < τ <= until, a where the segment begins"))]
    Piecewise {
        /// The segments, ascending; the last ends at 1.
        #[schemars(length(min = 1))]
        segments: Vec<Segment>,
    },
}

/// One segment of a piecewise position function.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Segment {
    /// Local time τ at which the segment ends; it begins where the one before ends.
    #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1"))]
    pub until: f64,
    /// s at its beginning.
    #[schemars(range(min = -1e6, max = 1e6), extend("unit" = "1"))]
    pub from: f64,
    /// s at its end.
    #[schemars(range(min = -1e6, max = 1e6), extend("unit" = "1"))]
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

/// What a position function is made of.
pub enum Pieces<'a> {
    /// One curve.
    Whole,
    /// Points [τ, s], and what happens between two of them.
    Points(&'a [[f64; 2]], Between),
    /// Segments.
    Segments(&'a [Segment]),
}

/// The initial value of a field of a function; `None` if zeros will do.
pub fn fresh(function: &str, field: &str) -> Option<Value> {
    match (function, field) {
        ("cubic-bezier", "x1" | "x2") => Some(json!(0.25)),
        ("cubic-bezier", "y1") => Some(json!(0.1)),
        ("cubic-bezier", "y2") => Some(json!(1)),
        ("keyframes", "points") => Some(json!([[0, 0], [1, 1]])),
        ("piecewise", "segments") => Some(json!([{ "until": 1, "from": 0, "to": 1 }])),
        _ => None,
    }
}

impl Position {
    /// What single numbers may not be, beyond their ranges.
    pub fn check(&self) -> Option<Problem> {
        match self {
            Position::Exponential { rate } | Position::ExponentialInverse { rate } => (*rate == 0.0)
                .then(|| Problem::error("/rate", "a rate of 0 has no curve").hint("use the function linear")),
            Position::Linear
            | Position::Sigmoid { .. }
            | Position::Sine { .. }
            | Position::Cosine { .. }
            | Position::CubicBezier { .. }
            | Position::Keyframes { .. }
            | Position::Piecewise { .. } => None,
        }
    }

    /// What it is made of.
    pub fn pieces(&self) -> Pieces<'_> {
        match self {
            Position::Keyframes { points, between } => Pieces::Points(points, *between),
            Position::Piecewise { segments } => Pieces::Segments(segments),
            Position::Linear
            | Position::Exponential { .. }
            | Position::ExponentialInverse { .. }
            | Position::Sigmoid { .. }
            | Position::Sine { .. }
            | Position::Cosine { .. }
            | Position::CubicBezier { .. } => Pieces::Whole,
        }
    }

    /// Cycles in one pass; `None` if the function has none.
    pub fn cycles(&self) -> Option<f64> {
        match self {
            Position::Sine { cycles, .. } | Position::Cosine { cycles, .. } => Some(*cycles),
            Position::Linear
            | Position::Exponential { .. }
            | Position::ExponentialInverse { .. }
            | Position::Sigmoid { .. }
            | Position::CubicBezier { .. }
            | Position::Keyframes { .. }
            | Position::Piecewise { .. } => None,
        }
    }

    /// s at local time `tau` in [0, 1].
    pub fn eval(&self, tau: f64) -> f64 {
        match self {
            Position::Linear => tau,
            Position::Exponential { rate } => exponential(*rate, tau),
            Position::ExponentialInverse { rate } => exponential(-rate, tau),
            Position::Sigmoid { rate } => sigmoid(*rate, tau),
            Position::Sine { cycles, phase, amplitude, offset } => {
                offset + amplitude * sin(TAU * (cycles * tau + phase))
            }
            Position::Cosine { cycles, phase, amplitude, offset } => {
                offset + amplitude * (1.0 - cos(TAU * (cycles * tau + phase))) / 2.0
            }
            Position::CubicBezier { x1, y1, x2, y2 } => cubic_bezier([*x1, *y1], [*x2, *y2], tau),
            Position::Keyframes { points, between } => keyframes::value(points, *between, tau),
            Position::Piecewise { segments } => piecewise(segments, tau),
        }
    }

    /// The smallest and the largest s over all τ in [0, 1].
    pub fn range(&self) -> (f64, f64) {
        match self {
            Position::Linear
            | Position::Exponential { .. }
            | Position::ExponentialInverse { .. }
            | Position::Sigmoid { .. } => (0.0, 1.0),
            Position::Sine { cycles, phase, .. } => self.over(turning_points(*cycles, *phase, 0.25)),
            Position::Cosine { cycles, phase, .. } => self.over(turning_points(*cycles, *phase, 0.0)),
            // A cubic lies within the hull of its control points.
            Position::CubicBezier { y1, y2, .. } => (y1.min(*y2).min(0.0), y1.max(*y2).max(1.0)),
            Position::Keyframes { points, .. } => hull(points.iter().map(|p| p[1])),
            Position::Piecewise { segments } => hull(segments.iter().flat_map(|segment| {
                let (low, high) = segment.ease.range();
                [segment.at(low), segment.at(high)]
            })),
        }
    }

    /// The range of s over both ends and the given inner places.
    fn over(&self, turning: Vec<f64>) -> (f64, f64) {
        hull(turning.into_iter().chain([0.0, 1.0]).map(|tau| self.eval(tau)))
    }
}

impl Segment {
    /// s when the easing is at `eased`.
    pub fn at(&self, eased: f64) -> f64 {
        self.from + (self.to - self.from) * eased
    }
}

fn hull(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), s| (low.min(s), high.max(s)))
}

/// The first two τ in [0, 1] where cycles τ + phase is `first` plus a multiple of 1/2: enough for the range.
fn turning_points(cycles: f64, phase: f64, first: f64) -> Vec<f64> {
    if cycles == 0.0 {
        return Vec::new();
    }
    let (low, high) = (phase.min(phase + cycles), phase.max(phase + cycles));
    let start = ((low - first) * 2.0).ceil();
    let turns = (0..2).map(|i| first + (start + f64::from(i)) / 2.0).filter(|turn| *turn <= high);
    turns.map(|turn| ((turn - phase) / cycles).clamp(0.0, 1.0)).collect()
}

/// Rates below this make no visible curve, and their quotients lose all digits.
const NO_RATE: f64 = 1e-100;

/// (e^(kτ) - 1) / (e^k - 1) without overflow; its limit τ for k = 0.
fn exponential(k: f64, tau: f64) -> f64 {
    match k {
        k if k.abs() < NO_RATE => tau,
        k if k > 0.0 => exp(k * (tau - 1.0)) * expm1(-k * tau) / expm1(-k),
        k => expm1(k * tau) / expm1(k),
    }
}

/// (σ(k(τ - 1/2)) - σ(-k/2)) / (σ(k/2) - σ(-k/2)), by σ(x) = (1 + tanh(x/2)) / 2; its limit τ for k = 0.
fn sigmoid(k: f64, tau: f64) -> f64 {
    if k.abs() < NO_RATE {
        return tau;
    }
    0.5 + tanh(k * (tau - 0.5) / 2.0) / (2.0 * tanh(k / 4.0))
}

/// CSS easing: y where x(u) = tau. x is monotone, so bisection always finds it.
fn cubic_bezier([x1, y1]: [f64; 2], [x2, y2]: [f64; 2], tau: f64) -> f64 {
    let at = |p1: f64, p2: f64, u: f64| {
        let v = 1.0 - u;
        3.0 * v * v * u * p1 + 3.0 * v * u * u * p2 + u * u * u
    };
    if tau <= 0.0 || tau >= 1.0 {
        return tau.clamp(0.0, 1.0);
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if at(x1, x2, middle) < tau { low = middle } else { high = middle }
    }
    at(y1, y2, (low + high) / 2.0)
}

fn piecewise(segments: &[Segment], tau: f64) -> f64 {
    let i = segments.partition_point(|segment| segment.until < tau).min(segments.len().saturating_sub(1));
    let Some(segment) = segments.get(i) else { return 0.0 };
    let start = if i == 0 { 0.0 } else { segments[i - 1].until };
    let length = segment.until - start;
    let local = if length > 0.0 { ((tau - start) / length).clamp(0.0, 1.0) } else { 1.0 };
    segment.at(segment.ease.eval(local))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::tests::variants;

    fn parse(json: &str) -> Position {
        serde_json::from_str(json).unwrap()
    }

    /// Every function with its default and with unusual parameters.
    fn all() -> Vec<Position> {
        [
            r#"{"function":"linear"}"#,
            r#"{"function":"exponential"}"#,
            r#"{"function":"exponential","rate":-40}"#,
            r#"{"function":"exponential","rate":1500}"#,
            r#"{"function":"exponential-inverse","rate":1e-9}"#,
            r#"{"function":"sigmoid","rate":5e-324}"#,
            r#"{"function":"exponential","rate":-5e-324}"#,
            r#"{"function":"sigmoid","rate":1500}"#,
            r#"{"function":"exponential-inverse"}"#,
            r#"{"function":"sigmoid"}"#,
            r#"{"function":"sigmoid","rate":-300}"#,
            r#"{"function":"sine"}"#,
            r#"{"function":"sine","cycles":-1.3,"phase":0.2,"amplitude":-2,"offset":0.3}"#,
            r#"{"function":"sine","cycles":0.05,"phase":0.6}"#,
            r#"{"function":"cosine"}"#,
            r#"{"function":"cosine","cycles":2.4,"phase":-0.1,"amplitude":0.5,"offset":1}"#,
            r#"{"function":"cubic-bezier","x1":0.25,"y1":0.1,"x2":0.25,"y2":1.4}"#,
            r#"{"function":"cubic-bezier","x1":1,"y1":0,"x2":0,"y2":1}"#,
            r#"{"function":"keyframes","points":[[0.1,0.5],[0.4,1.5],[0.8,-0.25]]}"#,
            r#"{"function":"keyframes","points":[[0,0],[0.3,0.2],[0.5,0.9],[1,1]],"between":"smooth"}"#,
            r#"{"function":"keyframes","points":[[0.5,2]],"between":"step"}"#,
            r#"{"function":"piecewise","segments":[{"until":0.4,"from":0,"to":1.2,"ease":{"function":"sigmoid"}},{"until":1,"from":0.5,"to":-1,"ease":{"function":"sine"}}]}"#,
        ]
        .into_iter()
        .map(parse)
        .collect()
    }

    #[test]
    fn every_function_of_the_schema_is_looked_at() {
        for function in variants::<Position>("function") {
            let listed = |position: &Position| serde_json::to_value(position).unwrap()["function"] == *function;
            assert!(all().iter().any(listed), "all() has no {function}");
        }
    }

    #[test]
    fn every_function_is_finite_and_in_its_range_and_round_trips() {
        for position in all() {
            let (low, high) = position.range();
            let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
            for i in 0..=5000 {
                let s = position.eval(f64::from(i) / 5000.0);
                assert!(s.is_finite(), "{position:?} at {i}");
                (least, most) = (least.min(s), most.max(s));
            }
            assert!(low - 1e-12 <= least && most <= high + 1e-12, "{position:?}: {least} {most} in {low} {high}");
            if !matches!(position, Position::CubicBezier { .. }) {
                assert!(least - low < 1e-3 && high - most < 1e-3, "{position:?}: {least} {most} fill {low} {high}");
            }
            assert_eq!(parse(&serde_json::to_string(&position).unwrap()), position);
        }
    }

    #[test]
    fn functions_have_the_values_of_their_formulae() {
        for (json, tau, s) in [
            (r#"{"function":"exponential","rate":2}"#, 0.5, 0.268_941_421_369_995_1),
            (r#"{"function":"exponential-inverse","rate":2}"#, 0.5, 0.731_058_578_630_004_9),
            (r#"{"function":"sigmoid"}"#, 0.5, 0.5),
            (r#"{"function":"sigmoid"}"#, 1.0, 1.0),
            (r#"{"function":"sine"}"#, 0.5, 1.0),
            (r#"{"function":"sine","cycles":1,"phase":0.25}"#, 0.5, -1.0),
            (r#"{"function":"cosine"}"#, 0.5, 1.0),
            (r#"{"function":"cosine"}"#, 0.25, 0.5),
            (r#"{"function":"cubic-bezier","x1":0.42,"y1":0,"x2":0.58,"y2":1}"#, 0.5, 0.5),
            (r#"{"function":"cubic-bezier","x1":0.25,"y1":0.1,"x2":0.25,"y2":1}"#, 0.5, 0.802403387),
            (r#"{"function":"keyframes","points":[[0.2,1],[0.6,3]]}"#, 0.4, 2.0),
            (r#"{"function":"keyframes","points":[[0.2,1],[0.6,3]]}"#, 0.1, 1.0),
            (r#"{"function":"keyframes","points":[[0.2,1],[0.6,3]]}"#, 0.9, 3.0),
            (r#"{"function":"keyframes","points":[[0,1],[0.5,3],[1,4]],"between":"step"}"#, 0.5, 3.0),
            (r#"{"function":"keyframes","points":[[0,0],[0.5,1],[1,0]],"between":"smooth"}"#, 0.25, 0.625),
            (
                r#"{"function":"piecewise","segments":[{"until":0.5,"from":0,"to":1},{"until":1,"from":5,"to":6}]}"#,
                0.5,
                1.0,
            ),
            (
                r#"{"function":"piecewise","segments":[{"until":0.5,"from":0,"to":1},{"until":1,"from":5,"to":6}]}"#,
                0.75,
                5.5,
            ),
        ] {
            let found = parse(json).eval(tau);
            assert!((found - s).abs() < 1e-8, "{json} at {tau}: {found}, not {s}");
        }
    }
}
