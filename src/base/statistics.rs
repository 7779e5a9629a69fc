//! What measures are told in: correlations, medians, percentiles.

/// The sums that a correlation of pairs follows from.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sums {
    /// How many pairs there are.
    pub count: usize,
    each: [f64; 2],
    squares: [f64; 2],
    products: f64,
}

impl Sums {
    /// One more pair.
    #[inline]
    pub fn add(&mut self, a: f32, b: f32) {
        let (a, b) = (f64::from(a), f64::from(b));
        self.count += 1;
        self.each = [self.each[0] + a, self.each[1] + b];
        self.squares = [self.squares[0] + a * a, self.squares[1] + b * b];
        self.products += a * b;
    }

    /// The correlation; `None` without pairs, or if one side does not vary.
    pub fn correlation(&self) -> Option<f64> {
        let [a, b] = self.each;
        let count = self.count.max(1) as f64;
        let [own, other] = [self.squares[0] - a * a / count, self.squares[1] - b * b / count];
        (own > 1e-9 && other > 1e-9).then(|| (self.products - a * b / count) / (own * other).sqrt())
    }
}

/// The correlation of pairs, as [`Sums::correlation`].
pub fn correlation(pairs: impl Iterator<Item = (f32, f32)>) -> Option<f64> {
    let mut sums = Sums::default();
    pairs.for_each(|(a, b)| sums.add(a, b));
    sums.correlation()
}

/// The value that a share of all values is below, between two of them in proportion; `None` of no values.
pub fn percentile(values: &mut [f64], share: f64) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let at = share * (values.len().checked_sub(1)? as f64);
    let (below, above) = (values[at.floor() as usize], values[at.ceil() as usize]);
    Some(below + (above - below) * at.fract())
}

/// The value in the middle; `None` of no values.
pub fn median(values: &mut [f64]) -> Option<f64> {
    percentile(values, 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_are_their_formulas() {
        let pairs = [(1.0, 2.0), (2.0, 4.0), (3.0, 7.0)];
        // 5 over the root of 2 and 114 / 9.
        let expected = 5.0 / (2.0 * 114.0 / 9.0_f64).sqrt();
        let found = correlation(pairs.into_iter()).unwrap();
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        assert_eq!(correlation([(1.0, 2.0), (1.0, 3.0)].into_iter()), None);
        assert_eq!(
            (median(&mut [3.0, 1.0, 2.0]), median(&mut [4.0, 1.0]), median(&mut [])),
            (Some(2.0), Some(2.5), None)
        );
        assert_eq!(percentile(&mut [10.0, 0.0, 20.0], 0.1), Some(2.0));
    }
}
