//! What measures are told in: correlations, medians, percentiles.

/// The correlation of pairs; none of fewer than two, or where one side does not vary.
pub fn correlation(pairs: impl Iterator<Item = (f32, f32)> + Clone) -> Option<f64> {
    let (mut count, mut sums) = (0.0, [0.0; 2]);
    for (a, b) in pairs.clone() {
        count += 1.0;
        sums = [sums[0] + f64::from(a), sums[1] + f64::from(b)];
    }
    let mean = sums.map(|sum| sum / count);
    let (mut own, mut both) = ([0.0; 2], 0.0);
    for (a, b) in pairs {
        let (a, b) = (f64::from(a) - mean[0], f64::from(b) - mean[1]);
        own = [own[0] + a * a, own[1] + b * b];
        both += a * b;
    }
    (own[0] > 1e-9 && own[1] > 1e-9).then(|| both / (own[0] * own[1]).sqrt())
}

/// The value that a share of all values is below, between two of them in proportion; none of none.
pub fn percentile(values: &mut [f64], share: f64) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let at = share * (values.len().checked_sub(1)? as f64);
    let (below, above) = (values[at.floor() as usize], values[at.ceil() as usize]);
    Some(below + (above - below) * at.fract())
}

/// The value in the middle; none of none.
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
