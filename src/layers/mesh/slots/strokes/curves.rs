//! A kernel's curve with its wave along a row or a column, many pixels at once: arithmetic alone, in loops over lanes that
//! the compiler vectorises, with the same bits everywhere.

use crate::base::maths::TAU;
use crate::base::simd::fused;

/// e to the minus pi: what a kernel's curve has at its edge.
pub const EDGE: f64 = 0.043_213_918_263_772_25;
/// How many values are made at once.
pub const LANES: usize = 8;
/// Added to a number and taken from it again, rounds it to a whole one.
const ROUND: f32 = 12_582_912.0;
/// The same for double precision.
const ROUND_WIDE: f64 = 6_755_399_441_055_744.0;
/// The curve of a kernel by the square of the place, 1 being its edge, from the highest power on: to within 2e-7.
const CURVE: [f32; 9] = [
    0.054_373_876,
    -0.358_080_85,
    1.162_162_9,
    -2.539_284_5,
    4.200_691_8,
    -5.393_351,
    5.156_945_5,
    -3.283_457_4,
    0.999_999_8,
];
/// The sine of so many turns, up to a quarter either way, divided by them, by their square: to within 1e-8.
const SINE: [f32; 5] = [39.759_827, -76.581_17, 81.602_48, -41.341_68, std::f32::consts::TAU];

/// A kernel along a line of pixels.
#[derive(Clone, Copy)]
pub struct Line {
    /// Where the first pixel is, from the middle of the kernel, in pixels.
    pub first: f32,
    /// 1 / the radius of the kernel, in pixels.
    pub inverse: f32,
    /// How many waves there are in a pixel.
    pub waves: f32,
    /// The phase in the middle, in turns.
    pub phase: f32,
    /// What the curve is multiplied by.
    pub weight: f32,
}

impl Line {
    /// Fills lumps of lanes for so many pixels: the curve with its wave's cosine, with its sine, and squared. Beyond the edge of
    /// the kernel there is nothing.
    #[inline(always)]
    pub fn fill<const N: usize>(&self, [cosines, sines, squares]: &mut [[[f32; LANES]; N]; 3], count: usize) {
        for lump in 0..count.div_ceil(LANES).min(N) {
            let begin = self.first + (lump * LANES) as f32;
            // Apart, so that the compiler sees that none overlaps another.
            let [mut with_cosine, mut with_sine, mut squared] = [[0.0; LANES]; 3];
            for k in 0..LANES {
                let place = begin + k as f32;
                let curve = self.weight * curve(place * self.inverse);
                let (cosine, sine) = wave(fused(place, self.waves, self.phase));
                (with_cosine[k], with_sine[k], squared[k]) = (curve * cosine, curve * sine, curve * curve);
            }
            (cosines[lump], sines[lump], squares[lump]) = (with_cosine, with_sine, squared);
        }
    }
}

/// The curve of a kernel at a place, 1 being its edge.
#[inline(always)]
fn curve(place: f32) -> f32 {
    let square = place * place;
    let mut value = CURVE[0];
    for factor in &CURVE[1..] {
        value = fused(value, square, *factor);
    }
    if square < 1.0 { value } else { 0.0 }
}

/// The cosine and the sine of so many turns.
#[inline(always)]
pub fn wave(turns: f32) -> (f32, f32) {
    let part = turns - (turns + ROUND - ROUND);
    let size = part.abs();
    let sine = quarter(0.25 - (size - 0.25).abs());
    (quarter(0.25 - size), sine.copysign(part))
}

/// The sine of at most a quarter turn.
#[inline(always)]
fn quarter(turns: f32) -> f32 {
    let square = turns * turns;
    let mut value = SINE[0];
    for factor in &SINE[1..] {
        value = fused(value, square, *factor);
    }
    value * turns
}

/// An angle in radians as a part of a turn, from -1/2 to 1/2.
#[inline(always)]
pub fn turns(radians: f64) -> f32 {
    let turns = radians * (1.0 / TAU);
    (turns - (turns + ROUND_WIDE - ROUND_WIDE)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::maths::{cos, exp, sin};

    #[test]
    fn curves_and_waves_are_their_formulas() {
        for i in -2000..=2000 {
            let x = f64::from(i) / 1000.0;
            let formula = (exp(-std::f64::consts::PI * x * x) - EDGE) / (1.0 - EDGE);
            let expected = if x.abs() < 1.0 { formula } else { 0.0 };
            assert!((f64::from(curve(x as f32)) - expected).abs() < 5e-7, "{x}");
            let (cosine, sine) = wave(turns(TAU * x) + (i % 7) as f32);
            let (c, s) = (f64::from(cosine) - cos(TAU * x), f64::from(sine) - sin(TAU * x));
            assert!(c.abs() < 3e-6 && s.abs() < 3e-6, "{x}: {c} {s}");
        }
    }
}
