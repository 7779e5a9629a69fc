//! Random numbers that depend on nothing but what they are for: pcg4d of Jarzynski and Olano 2020, "Hash Functions for GPU
//! Rendering". The same call gives the same number on every machine, in any order, and on the GPU.

/// The random numbers of one seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Random(pub u32);

impl Random {
    /// Four numbers in [0, 1).
    pub fn of(self, a: u32, b: u32, c: u32) -> [f64; 4] {
        pcg4d([a, b, c, self.0]).map(|bits| f64::from(bits >> 8) / f64::from(1_u32 << 24))
    }

    /// A number of mean 0 and variance 1 within 3 of 0.
    pub fn bell(self, a: u32, b: u32, c: u32) -> f64 {
        let [x, y, z, _] = self.of(a, b, c);
        2.0 * (x + y + z) - 3.0
    }
}

fn pcg4d(v: [u32; 4]) -> [u32; 4] {
    let v = v.map(|n| n.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    mixed(mixed(v).map(|n| n ^ (n >> 16)))
}

fn mixed([mut x, mut y, mut z, mut w]: [u32; 4]) -> [u32; 4] {
    x = x.wrapping_add(y.wrapping_mul(w));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    w = w.wrapping_add(y.wrapping_mul(z));
    [x, y, z, w]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_the_published_one() {
        assert_eq!(pcg4d([7, 5, 16, 1]), [1_994_569_773, 3_797_644_551, 1_317_212_266, 398_917_715]);
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
