//! Mathematics with the same bits on every machine: the transcendental functions come from `libm`, never from the
//! platform (clippy.toml bans the others).

pub use libm::{acos, atan, atan2, atanh, cbrt, cos, exp, expm1, log as ln, log1p as ln_1p, log2, pow, sin, tan, tanh};

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

/// A whole power of ten.
pub fn ten_to(power: i32) -> f64 {
    let size = powi(10.0, power.unsigned_abs());
    if power < 0 { 1.0 / size } else { size }
}

/// The largest of 1, 2 and 5 times a power of ten that is not above `most`, for scales and legends: from a millionth to 50
/// million. `None` if `most` is smaller, or no number.
pub fn nice(most: f64) -> Option<f64> {
    // What was computed to be as large as a round number may be smaller by an error of floating point.
    let reach = most * 1.000_001;
    (-6..8).flat_map(|power| [1.0, 2.0, 5.0].map(|step| step * ten_to(power))).rfind(|&n| n <= reach)
}

/// The natural logarithm of a positive, normal number to within 1e-13 (0 gives some finite number): arithmetic alone, so
/// that the compiler vectorises loops over it, with the same bits everywhere. Outside such loops use [`ln`].
#[inline(always)]
pub fn ln_in_loops(x: f64) -> f64 {
    /// The bits of the square root of 1/2: mantissas go from there to the square root of 2.
    const LOW: u64 = 0x3FE6_A09E_667F_3BCD;
    const MANTISSA: u64 = (1 << 52) - 1;
    /// The bits of 2^52: a small whole number in the place of its mantissa reads as 2^52 and that number.
    const WHOLE: u64 = 0x4330_0000_0000_0000;
    const BIAS: u64 = 1023;
    // Shifts of unsigned numbers only: those are what every vector unit has.
    let above = x.to_bits().wrapping_sub(LOW).wrapping_add(BIAS << 52);
    let exponent = f64::from_bits(above >> 52 | WHOLE) - (f64::from_bits(WHOLE) + BIAS as f64);
    let m = f64::from_bits((above & MANTISSA).wrapping_add(LOW));
    // ln m = 2 artanh f, by its series: |f| is at most 0.1716.
    let f = (m - 1.0) / (m + 1.0);
    let f2 = f * f;
    let odd = [1.0 / 17.0, 1.0 / 15.0, 1.0 / 13.0, 1.0 / 11.0, 1.0 / 9.0, 1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0, 1.0];
    let series = odd.iter().fold(0.0, |sum, term| sum * f2 + term);
    exponent * std::f64::consts::LN_2 + 2.0 * f * series
}

/// e to the power of `x`, to within 1e-13 of itself; below -700 it is as at -700, above 700 as at 700. Arithmetic alone,
/// as in [`ln_in_loops`]. Outside such loops use [`exp`].
#[inline(always)]
pub fn exp_in_loops(x: f64) -> f64 {
    /// 1.5 * 2^52: the sum with a smaller number is that number rounded to a whole one, in the last bits.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    /// The natural logarithm of 2 in two parts: the first has few bits, so that its products with exponents are exact.
    const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];
    let x = if x < -700.0 { -700.0 } else { x };
    let x = if x > 700.0 { 700.0 } else { x };
    let rounded = x * std::f64::consts::LOG2_E + ROUND;
    let exponent = rounded - ROUND;
    let rest = x - exponent * LN_2[0] - exponent * LN_2[1];
    // Taylor's series: |rest| is at most 0.347.
    let factors = [12.0, 11.0, 10.0, 9.0, 8.0, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.0];
    let series = factors.iter().fold(1.0, |sum, factor| 1.0 + sum * (rest * (1.0 / factor)));
    series * f64::from_bits(rounded.to_bits().wrapping_add(1023) << 52)
}

/// 1 / `x` to within 1e-13 of itself, for `x` from 1e-37 to 1e37: faster in loops than the division, with the same bits
/// everywhere.
#[inline(always)]
pub fn reciprocal_in_loops(x: f64) -> f64 {
    let near = f64::from(1.0 / x as f32);
    near * (2.0 - x * near)
}

/// 1 / √`x` to within 1e-13 of itself, for `x` from 1e-37 to 1e37, as [`reciprocal_in_loops`].
#[inline(always)]
pub fn reciprocal_root_in_loops(x: f64) -> f64 {
    let near = f64::from(1.0 / (x as f32).sqrt());
    near * (1.5 - 0.5 * x * near * near)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nice_numbers_are_not_above() {
        for (most, nice_one) in [
            (1.0, Some(1.0)),
            (4.999_99, Some(2.0)),
            (4.999_999, Some(5.0)),
            (0.03, Some(0.02)),
            (2903.0, Some(2000.0)),
            (1e-6, Some(1e-6)),
            (9e-7, None),
            (f64::INFINITY, Some(5e7)),
            (f64::NAN, None),
        ] {
            assert_eq!(nice(most), nice_one, "{most}");
        }
    }

    #[test]
    fn the_logarithm_of_loops_is_the_logarithm() {
        let mut x = 1e-300;
        while x < 1e300 {
            let error = (ln_in_loops(x) - ln(x)).abs();
            assert!(error <= 1e-13 * ln(x).abs().max(1.0), "{x}: {error}");
            x *= 1.000_37;
        }
        assert!(ln_in_loops(0.0).is_finite());
    }
}
