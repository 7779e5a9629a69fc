//! Mathematics with the same bits on every machine: the transcendental functions come from `libm`, never from the
//! platform (clippy.toml bans the others).

pub use libm::{acos, atan2, cbrt, cos, exp, expm1, log as ln, pow, sin, tanh};

/// One whole turn in radians.
pub const TAU: f64 = std::f64::consts::TAU;

/// The Hermite step 3x² - 2x³ from 0 at `from` to 1 at `to`; a hard step where they are equal.
pub fn smoothstep(from: f64, to: f64, x: f64) -> f64 {
    if to <= from {
        return if x < from { 0.0 } else { 1.0 };
    }
    let x = ((x - from) / (to - from)).clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// Linear interpolation, exact at both ends.
pub fn lerp(a: f64, b: f64, t: f64) -> f64 {
    a * (1.0 - t) + b * t
}

/// `base` to a whole power by repeated multiplication.
pub fn powi(base: f64, exponent: u32) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * base)
}
