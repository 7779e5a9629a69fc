//! Strokes of equal strength everywhere: a noise divided by its own strength around each pixel.

use rayon::prelude::*;

use super::sum::Noise;
use crate::base::maths::exp;
use crate::base::simd::vectorised;

/// The standard deviation of the neighborhood, in spacings.
pub const WIDE: f64 = 0.75;
/// Pixels up to so many standard deviations away count.
pub const FAR: f64 = 3.0;
/// The least mean square that a noise is divided by.
const LEAST: f32 = 0.02;

/// Evens out a noise with this spacing.
pub fn even((width, height): (usize, usize), triangle: &[u32], spacing_px: f64, noise: &mut Noise) {
    let deviation = WIDE * spacing_px;
    let reach = (FAR * deviation).ceil() as usize;
    let weights: Vec<f32> =
        (0..=reach).map(|d| exp(-0.5 * (d as f64 / deviation) * (d as f64 / deviation)) as f32).collect();
    let own = |i: usize| triangle[i] != u32::MAX;
    let around = |values: Vec<f32>| {
        let rows = along_rows(&values, width.max(1), &weights);
        down_columns(&rows, width.max(1), &weights)
    };
    let squares =
        around((0..width * height).map(|i| if own(i) { noise.value[i] * noise.value[i] } else { 0.0 }).collect());
    let ones = around((0..width * height).map(|i| f32::from(u8::from(own(i)))).collect());
    let sums = squares.par_iter().zip(&ones);
    noise.value.par_iter_mut().zip(sums).enumerate().filter(|(i, _)| own(*i)).for_each(|(_, (value, (q, u)))| {
        *value /= (q / u).max(LEAST).sqrt();
    });
}

/// The weighted sums around each value in its row; beyond the ends there is nothing.
fn along_rows(values: &[f32], width: usize, weights: &[f32]) -> Vec<f32> {
    let reach = weights.len() - 1;
    let mut out = vec![0.0; values.len()];
    out.par_chunks_mut(width).zip(values.par_chunks(width)).for_each(|(out, row)| {
        let mut padded = vec![0.0; row.len() + 2 * reach];
        padded[reach..reach + row.len()].copy_from_slice(row);
        sum(out, weights, |d| [Some(&padded[reach - d..]), Some(&padded[reach + d..])]);
    });
    out
}

/// The same in its column.
fn down_columns(values: &[f32], width: usize, weights: &[f32]) -> Vec<f32> {
    let rows: Vec<&[f32]> = values.chunks(width).collect();
    let mut out = vec![0.0; values.len()];
    out.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        sum(out, weights, |d| [y.checked_sub(d).map(|y| rows[y]), rows.get(y + d).copied()]);
    });
    out
}

/// The weighted sum of a row and of those on both sides of it.
fn sum<'a>(out: &mut [f32], weights: &[f32], sides: impl Fn(usize) -> [Option<&'a [f32]>; 2]) {
    vectorised(
        #[inline(always)]
        || {
            for (d, weight) in weights.iter().enumerate() {
                for side in sides(d).into_iter().take(if d == 0 { 1 } else { 2 }).flatten() {
                    out.iter_mut().zip(side).for_each(|(sum, value)| *sum += weight * value);
                }
            }
        },
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_twice_as_strong_comes_out_the_same() {
        let (width, height) = (64, 40);
        let wave = |x: usize| crate::base::maths::sin(x as f64 * 0.9) as f32;
        let noise = |factor: f32| {
            let value = (0..width * height).map(|i| factor * wave(i % width)).collect();
            let mut noise = Noise { value, share: vec![1.0; width * height] };
            even((width, height), &vec![0; width * height], 7.0, &mut noise);
            noise.value
        };
        let (one, two) = (noise(1.0), noise(2.0));
        assert!(one.iter().zip(&two).all(|(a, b)| (a - b).abs() < 1e-4));
        let squares: f32 = one.iter().map(|v| v * v).sum::<f32>() / one.len() as f32;
        assert!((squares - 1.0).abs() < 0.1, "{squares}");
    }
}
