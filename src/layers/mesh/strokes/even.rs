//! Strokes of equal strength everywhere: a noise divided by its own strength around each pixel.

use rayon::prelude::*;

use super::sum::Noise;
use crate::base::maths::exp;

/// The standard deviation of the neighborhood, in spacings.
const WIDE: f64 = 0.75;
/// Pixels up to so many standard deviations away count.
const FAR: f64 = 3.0;
/// The least mean square that a noise is divided by.
const LEAST: f32 = 0.02;

/// Evens out a noise with this spacing.
pub fn even((width, height): (usize, usize), triangle: &[u32], spacing_px: f64, noise: &mut Noise) {
    let deviation = WIDE * spacing_px;
    let reach = (FAR * deviation).ceil() as usize;
    let weights: Vec<f32> =
        (0..=reach).map(|d| exp(-0.5 * (d as f64 / deviation) * (d as f64 / deviation)) as f32).collect();
    let own = |i: usize| triangle[i] != u32::MAX;
    let mut sums: Vec<[f32; 2]> =
        (0..width * height).map(|i| if own(i) { [noise.value[i] * noise.value[i], 1.0] } else { [0.0; 2] }).collect();
    let rows: Vec<[f32; 2]> = sums.par_chunks(width.max(1)).flat_map_iter(|row| spread(row, &weights)).collect();
    let columns: Vec<Vec<[f32; 2]>> = (0..width)
        .into_par_iter()
        .map(|x| spread(&(0..height).map(|y| rows[y * width + x]).collect::<Vec<_>>(), &weights))
        .collect();
    sums.par_iter_mut().enumerate().for_each(|(i, sum)| *sum = columns[i % width][i / width]);
    noise.value.par_iter_mut().zip(&sums).enumerate().filter(|(i, _)| own(*i)).for_each(|(_, (value, [q, u]))| {
        *value /= (q / u).max(LEAST).sqrt();
    });
}

/// The weighted sums around each value; beyond the ends there is nothing.
fn spread(values: &[[f32; 2]], weights: &[f32]) -> Vec<[f32; 2]> {
    let at = |x: usize| {
        let mut sum = values[x].map(|v| v * weights[0]);
        for (d, weight) in weights.iter().enumerate().skip(1) {
            let (before, after) = (x.checked_sub(d).map(|i| values[i]), values.get(x + d));
            for other in before.iter().chain(after) {
                sum = [sum[0] + weight * other[0], sum[1] + weight * other[1]];
            }
        }
        sum
    };
    (0..values.len()).map(at).collect()
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
