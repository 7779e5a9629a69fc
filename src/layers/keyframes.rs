//! Values that change over time, given at a few times.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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

/// The value at `tau` of the points [τ, value], ascending in τ: constant before the first and after the last; 0 without
/// points.
pub fn value(points: &[[f64; 2]], between: Between, tau: f64) -> f64 {
    let after = points.partition_point(|p| p[0] <= tau);
    let (Some(i), true) = (after.checked_sub(1), after < points.len()) else {
        let end = if after == 0 { points.first() } else { points.last() };
        return end.map_or(0.0, |p| p[1]);
    };
    let ([t0, s0], [t1, s1]) = (points[i], points[after]);
    let u = (tau - t0) / (t1 - t0);
    match between {
        Between::Step => s0,
        Between::Linear => s0 + (s1 - s0) * u,
        Between::Smooth => {
            let h = t1 - t0;
            let (m0, m1) = (slope(points, i) * h, slope(points, after) * h);
            let (u2, u3) = (u * u, u * u * u);
            s0 * (2.0 * u3 - 3.0 * u2 + 1.0) + m0 * (u3 - 2.0 * u2 + u) + s1 * (3.0 * u2 - 2.0 * u3) + m1 * (u3 - u2)
        }
    }
}

/// The slope of the smooth curve at point `i` (Fritsch and Carlson's monotone choice).
fn slope(points: &[[f64; 2]], i: usize) -> f64 {
    let width = |k: usize| points[k + 1][0] - points[k][0];
    let secant = |k: usize| (points[k + 1][1] - points[k][1]) / width(k);
    if i == 0 {
        return secant(0);
    }
    if i + 1 == points.len() {
        return secant(i - 1);
    }
    let (d0, d1) = (secant(i - 1), secant(i));
    if d0 == 0.0 || d1 == 0.0 || (d0 < 0.0) != (d1 < 0.0) {
        return 0.0;
    }
    let (h0, h1) = (width(i - 1), width(i));
    let (w1, w2) = (2.0 * h1 + h0, h1 + 2.0 * h0);
    (w1 + w2) / (w1 / d0 + w2 / d1)
}
