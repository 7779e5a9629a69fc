//! The growth law of Guan et al. (equations 1 to 4): how many windows of a clip are known by each frame.

use super::model::Growth;
use crate::base::maths::{exp, expm1};

impl Growth {
    /// How many are known by the time `t`, in seconds.
    pub fn known(&self, t: f64) -> f64 {
        self.c * exp(-(self.b / self.a) * expm1(-self.a * t))
    }

    /// How many frame `k` adds to those that were known before.
    pub fn added(&self, k: usize, fps: f64) -> usize {
        let known = |k: usize| ((self.known(k as f64 / fps) + 0.5).floor().min(f64::from(self.max))) as usize;
        known(k) - k.checked_sub(1).map_or(0, known)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_law_starts_with_c_and_ends_with_all() {
        let law = Growth::default();
        assert!((law.known(0.0) - 4.0).abs() < 1e-9);
        assert!((law.known(1e6) - 4.0 * exp(2.0)).abs() < 1e-9);
        for (max, total) in [(24, 24), (1000, 30), (3, 3)] {
            let law = Growth { max, ..law.clone() };
            assert_eq!((0..2000).map(|k| law.added(k, 25.0)).sum::<usize>(), total);
        }
        assert_eq!((0..3).map(|k| law.added(k, 1.0)).collect::<Vec<_>>(), [4, 8, 8]);
    }
}
