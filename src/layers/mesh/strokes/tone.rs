//! How dark a place is, and how much of a noise that inks.

use crate::base::maths::{cos, pow};

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
    /// The tone of a linear color: 0 is dark, 1 is light.
    pub fn tone(&self, [r, g, b]: [f64; 3]) -> f64 {
        let code = code(0.2126 * r + 0.7152 * g + 0.0722 * b);
        pow(((code - self.dark) / (self.light - self.dark)).clamp(0.0, 1.0), self.gamma)
    }
}

/// The sRGB code, 0 to 1, of linear light.
fn code(light: f64) -> f64 {
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * pow(light, 1.0 / 2.4) - 0.055 }
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
    table: Vec<f64>,
}

impl Thresholds {
    /// How many steps there are, and an error that is far above that of the arithmetic.
    const STEPS: usize = 256;
    const SAFE: f64 = 1e-9;

    /// Those of a noise.
    pub fn new(even: bool) -> Thresholds {
        let table = (0..=Self::STEPS).map(|k| threshold(k as f64 / Self::STEPS as f64, even)).collect();
        Thresholds { even, table }
    }

    /// A threshold that covers a place with the noise `x`, where edges reach `soft` far, just as that of its share.
    pub fn serving(&self, share: f64, x: f64, soft: f64) -> f64 {
        let k = ((share * Self::STEPS as f64) as usize).min(Self::STEPS - 1);
        // It grows with the share.
        let (low, high) = (self.table[k], self.table[k + 1]);
        match () {
            () if x >= high + soft + Self::SAFE => high,
            () if x <= low - soft - Self::SAFE => low,
            () => threshold(share, self.even),
        }
    }
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
                    assert!(a.to_bits() == b.to_bits(), "{share} {x} {soft}: {exact} {served}");
                    saved += usize::from(exact != served);
                }
            }
            assert!(saved > 6000, "{saved}");
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
