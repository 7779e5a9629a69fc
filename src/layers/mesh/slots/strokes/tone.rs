//! How dark a place is, and how much of a noise that inks: for many places at once, in loops that become vectors.

use super::curves::wave;
use crate::base::simd::fused;

/// The exponent and the divisor of the curve that stands for the normal quantile.
const BEND: f32 = 0.135;
const SCALE: f32 = 0.1975;

/// Which part of the range from black to white is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// What is full ink, as an sRGB code from 0 to 1.
    pub dark: f64,
    /// What is none.
    pub light: f64,
    /// How the middle is bent.
    pub gamma: f64,
}

impl Range {
    /// Makes tones of the brightness of linear colors: 0 is dark, 1 is light.
    #[inline(always)]
    pub fn tones(&self, lights: &mut [f32]) {
        let (dark, often, gamma) = (self.dark as f32, (1.0 / (self.light - self.dark)) as f32, self.gamma as f32);
        for light in &mut *lights {
            *light = within((code(*light) - dark) * often);
        }
        if gamma != 1.0 {
            lights.iter_mut().for_each(|tone| *tone = power(*tone, gamma));
        }
    }
}

/// The brightness of a linear color.
#[inline(always)]
pub fn brightness([r, g, b]: [f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// The sRGB code, 0 to 1, of linear light.
#[inline(always)]
fn code(light: f32) -> f32 {
    let (dark, bright) = (12.92 * light, 1.055 * power(light, 1.0 / 2.4) - 0.055);
    if light <= 0.003_130_8 { dark } else { bright }
}

/// A number from 0 on to a power above 0, to within 2e-6 of itself where that power is not far from 1.
#[inline(always)]
fn power(base: f32, exponent: f32) -> f32 {
    let power = two_to(exponent * log_2(base));
    if base > 0.0 { power } else { 0.0 }
}

/// The logarithm to base 2 of a positive, normal number.
#[inline(always)]
fn log_2(x: f32) -> f32 {
    /// The bits of the square root of 1/2: mantissas go from there to the square root of 2.
    const LOW: i32 = 0x3F35_04F3;
    /// 2 / ln 2 times the series of artanh.
    const ARTANH: [f32; 5] = [0.320_598_9, 0.412_198_6, 0.577_078, 0.961_796_7, 2.885_39];
    let above = x.to_bits() as i32 - LOW;
    let mantissa = f32::from_bits(((above & 0x007F_FFFF) + LOW) as u32);
    let ratio = (mantissa - 1.0) / (mantissa + 1.0);
    let series = ARTANH[1..].iter().fold(ARTANH[0], |sum, factor| fused(sum, ratio * ratio, *factor));
    fused(series, ratio, (above >> 23) as f32)
}

/// 2 to a power; below -126 and above 127 as there.
#[inline(always)]
fn two_to(x: f32) -> f32 {
    /// 1.5 * 2^23: the sum with a smaller number is that number rounded to a whole one, in the last bits.
    const ROUND: f32 = 12_582_912.0;
    /// Taylor's series.
    const SERIES: [f32; 8] = [
        1.525_273_4e-5,
        1.540_353e-4,
        1.333_355_8e-3,
        9.618_129e-3,
        5.550_411e-2,
        0.240_226_5,
        std::f32::consts::LN_2,
        1.0,
    ];
    let x = if x > -126.0 { x } else { -126.0 };
    let x = if x < 127.0 { x } else { 127.0 };
    let rounded = x + ROUND;
    let rest = x - (rounded - ROUND);
    let series = SERIES[1..].iter().fold(SERIES[0], |sum, factor| fused(sum, rest, *factor));
    series * f32::from_bits(rounded.to_bits().wrapping_add(127) << 23)
}

/// The value that a noise of mean 0 and variance 1 is below in this share of places.
#[inline(always)]
pub fn threshold(share: f32, even: bool) -> f32 {
    let normal = (power(share, BEND) - power(1.0 - share, BEND)) / SCALE;
    if even { (normal - std::f32::consts::SQRT_2 * wave(share / 2.0).0) / 2.0 } else { normal }
}

/// The share of ink at a tone: 0 from `from` on, 1 up to `to`.
#[inline(always)]
pub fn share(tone: f32, from: f32, to: f32) -> f32 {
    // If `from` is `to`, lower tones give infinity, which is all ink, and that tone itself NaN, which is none.
    within((from - tone) / (from - to))
}

/// A number clamped to 0 to 1; 0 if it is not a number.
#[inline(always)]
pub fn within(x: f32) -> f32 {
    let least = if x > 0.0 { x } else { 0.0 };
    if least < 1.0 { least } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::maths::pow;

    #[test]
    fn the_threshold_is_the_normal_quantile() {
        for (share, quantile) in
            [(0.5, 0.0), (0.841_344_7, 1.0), (0.158_655_3, -1.0), (0.977_249_9, 2.0), (0.9, 1.281_55)]
        {
            assert!((threshold(share, false) - quantile).abs() < 0.01, "{share}: {}", threshold(share, false));
        }
    }

    #[test]
    fn thresholds_are_their_formulas() {
        for i in 0..=4000_u16 {
            let own = f32::from(i) / 4000.0;
            let share = f64::from(own);
            let normal = (pow(share, 0.135) - pow(1.0 - share, 0.135)) / 0.1975;
            let line =
                (normal - std::f64::consts::SQRT_2 * crate::base::maths::cos(std::f64::consts::PI * share)) / 2.0;
            for (even, expected) in [(false, normal), (true, line)] {
                let found = f64::from(threshold(own, even));
                assert!((found - expected).abs() < 1e-5, "{share} {even}: {found} for {expected}");
            }
        }
    }

    #[test]
    fn tones_are_their_formulas() {
        for (gamma, dark, light) in [(1.0, 0.0, 1.0), (0.4, 0.1, 0.8), (2.2, 0.9, 0.2)] {
            let lights: Vec<f32> = (0..300_u16).map(|i| f32::from(i) * f32::from(i) / 80_000.0).collect();
            let mut tones = lights.clone();
            Range { dark, light, gamma }.tones(&mut tones);
            for (tone, linear) in tones.iter().zip(lights) {
                let share = (crate::base::pixels::srgb_from_linear(f64::from(linear)) - dark) / (light - dark);
                let expected = pow(share.clamp(0.0, 1.0), gamma);
                assert!((f64::from(*tone) - expected).abs() < 1e-4 * expected.max(1e-2), "{linear} {gamma}: {tone}");
            }
        }
    }

    #[test]
    fn shares_fall_with_the_tone_or_rise() {
        for (tone, from, to, expected) in [
            (0.9, 0.8, 0.2, 0.0),
            (0.5, 0.8, 0.2, 0.5),
            (0.1, 0.8, 0.2, 1.0),
            (0.5, 0.4, 0.6, 0.5),
            (0.7, 0.4, 0.6, 1.0),
            (0.5, 0.5, 0.5, 0.0),
            (0.4, 0.5, 0.5, 1.0),
            (1.0, 2.0, 1.0, 1.0),
        ] {
            assert!((share(tone, from, to) - expected).abs() < 1e-6, "{tone} {from} {to}");
        }
    }
}
