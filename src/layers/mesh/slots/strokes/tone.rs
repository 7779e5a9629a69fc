//! How dark a place is, and how much of a noise that inks.

use std::sync::LazyLock;

use crate::base::maths::{cos, exp_in_loops, ln_in_loops, pow};

/// The exponent and the divisor of the curve that stands for the normal quantile.
const BEND: f64 = 0.135;
const SCALE: f64 = 0.1975;

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
    pub fn tones(&self, lights: &mut [f64]) {
        for light in &mut *lights {
            *light = ((code(*light) - self.dark) / (self.light - self.dark)).clamp(0.0, 1.0);
        }
        if self.gamma != 1.0 {
            for tone in lights {
                let bent = power(*tone, self.gamma);
                *tone = if *tone > 0.0 { bent } else { 0.0 };
            }
        }
    }
}

/// The brightness of a linear color.
#[inline(always)]
pub fn brightness([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// The sRGB code, 0 to 1, of linear light.
#[inline(always)]
fn code(light: f64) -> f64 {
    let (dark, bright) = (12.92 * light, 1.055 * power(light, 1.0 / 2.4) - 0.055);
    if light <= 0.003_130_8 { dark } else { bright }
}

/// A positive number to a power, to within 1e-12 of itself, in loops that become vectors.
#[inline(always)]
fn power(base: f64, exponent: f64) -> f64 {
    exp_in_loops(ln_in_loops(base) * exponent)
}

/// The value that a noise of mean 0 and variance 1 is below in this share of places.
pub fn threshold(share: f64, even: bool) -> f64 {
    let normal = (pow(share, BEND) - pow(1.0 - share, BEND)) / SCALE;
    if even { (normal - std::f64::consts::SQRT_2 * cos(std::f64::consts::PI * share)) / 2.0 } else { normal }
}

/// Thresholds for many places: where a noise is far from one, it is not computed.
pub struct Thresholds {
    even: bool,
    /// Those of shares in equal steps from 0 to 1.
    table: &'static [f64],
}

/// Those of a noise, and of one that is evened out.
static TABLES: LazyLock<[Vec<f64>; 2]> = LazyLock::new(|| {
    let of = |even| (0..=Thresholds::STEPS).map(|k| threshold(k as f64 / Thresholds::STEPS as f64, even)).collect();
    [of(false), of(true)]
});

impl Thresholds {
    /// How many steps there are, and an error that is far above that of the arithmetic.
    const STEPS: usize = 1024;
    const SAFE: f64 = 1e-9;
    /// So many steps from the ends on, cubics through the table are within 1e-6 of the thresholds.
    const ENDS: usize = 16;

    /// Those of a noise.
    pub fn new(even: bool) -> Thresholds {
        Thresholds { even, table: &TABLES[usize::from(even)] }
    }

    /// A threshold that covers a place with the noise `x`, where edges reach `soft` far, just as that of its share, or as one that
    /// is within 1e-6 of it, if they are soft.
    pub fn serving(&self, share: f64, x: f64, soft: f64) -> f64 {
        let k = ((share * Self::STEPS as f64) as usize).min(Self::STEPS - 1);
        // It grows with the share.
        let (low, high) = (self.table[k], self.table[k + 1]);
        match () {
            () if x >= high + soft + Self::SAFE => high,
            () if x <= low - soft - Self::SAFE => low,
            () if soft > 0.0 && (Self::ENDS..Self::STEPS - Self::ENDS).contains(&k) => cubic(
                [-1, 0, 1, 2].map(|step| self.table[k.wrapping_add_signed(step)]),
                share * Self::STEPS as f64 - k as f64,
            ),
            () => threshold(share, self.even),
        }
    }
}

/// What the cubic through four values at -1, 0, 1 and 2 has at `x`.
fn cubic([a, b, c, d]: [f64; 4], x: f64) -> f64 {
    let (one, three) = ((d - a) / 6.0 + (b - c) / 2.0, (a + c) / 2.0 - b);
    ((one * x + three) * x + (c - b - one - three)) * x + b
}

/// The share of ink at a tone: none from `from` on, all up to `to`.
pub fn share(tone: f64, from: f64, to: f64) -> f64 {
    if from == to {
        return if tone < from { 1.0 } else { 0.0 };
    }
    ((from - tone) / (from - to)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::maths::smoothstep;

    #[test]
    fn the_threshold_is_the_normal_quantile() {
        for (share, quantile) in
            [(0.5, 0.0), (0.841_344_7, 1.0), (0.158_655_3, -1.0), (0.977_249_9, 2.0), (0.9, 1.281_55)]
        {
            assert!((threshold(share, false) - quantile).abs() < 0.01, "{share}: {}", threshold(share, false));
        }
        assert_eq!(threshold(0.5, true), -std::f64::consts::SQRT_2 * cos(std::f64::consts::PI * 0.5) / 2.0);
    }

    #[test]
    fn thresholds_that_serve_cover_as_the_exact_ones() {
        for even in [false, true] {
            let thresholds = Thresholds::new(even);
            let mut saved = 0;
            for i in 0..=4000 {
                let (share, x) = (f64::from(i) / 4000.0, f64::from(i * 37 % 601 - 300) / 60.0);
                for soft in [0.0, 0.4, 2.0] {
                    let [exact, served] = [threshold(share, even), thresholds.serving(share, x, soft)];
                    let [a, b] = [exact, served].map(|threshold| smoothstep(-soft, soft, x - threshold));
                    let within = if soft > 0.0 { 1e-6 / soft } else { 0.0 };
                    assert!((a - b).abs() <= within, "{share} {x} {soft}: {exact} {served}");
                    saved += usize::from(exact != served);
                }
            }
            assert!(saved > 6000, "{saved}");
        }
    }

    #[test]
    fn tones_are_their_formulas() {
        for (gamma, dark, light) in [(1.0, 0.0, 1.0), (0.4, 0.1, 0.8), (2.2, 0.9, 0.2)] {
            let lights: Vec<f64> = (0..300).map(|i| f64::from(i * i) / 80_000.0).collect();
            let mut tones = lights.clone();
            Range { dark, light, gamma }.tones(&mut tones);
            for (tone, linear) in tones.iter().zip(lights) {
                let share: f64 = (crate::base::pixels::srgb_from_linear(linear) - dark) / (light - dark);
                assert!((tone - pow(share.clamp(0.0, 1.0), gamma)).abs() < 1e-9, "{linear} {gamma}: {tone}");
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
            assert!((share(tone, from, to) - expected).abs() < 1e-12, "{tone} {from} {to}");
        }
    }
}
