//! The random numbers of a waterfall: they depend on nothing but the seed and what they are for.

use crate::base::random::{pcg4d, unit};

/// The random numbers of one seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Random(pub u32);

impl Random {
    /// Four numbers in [0, 1).
    pub fn of(self, a: u32, b: u32, c: u32) -> [f64; 4] {
        pcg4d([a, b, c, self.0]).map(unit)
    }

    /// A number of mean 0 and variance 1 within 3 of 0.
    pub fn bell(self, a: u32, b: u32, c: u32) -> f64 {
        let [x, y, z, _] = self.of(a, b, c);
        2.0 * (x + y + z) - 3.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_hash() {
        assert!((Random(1).of(7, 5, 16)[0] - 0.464_396_954).abs() < 1e-9);
    }

    #[test]
    fn a_bell_has_mean_0_and_variance_1() {
        let all: Vec<f64> = (0..20_000).map(|i| Random(1).bell(i, 0, 2)).collect();
        let mean = all.iter().sum::<f64>() / 20_000.0;
        let variance = all.iter().map(|v| v * v).sum::<f64>() / 20_000.0;
        assert!(mean.abs() < 0.02 && (variance - 1.0).abs() < 0.03, "{mean} {variance}");
        assert!(all.iter().all(|v| v.abs() <= 3.0));
    }
}
