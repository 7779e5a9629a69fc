//! What brings the exposures of photographs together: where two of them see the same cells, their colors should agree.

use super::map::Map;
use crate::base::cholesky::Matrix;
use crate::base::maths::{exp, ln};
use crate::base::statistics::median;

/// The least number of cells that two views must have in common.
const LEAST_CELLS: usize = 50;
/// How much of a cell both must tell, and see squarely.
const LEAST_TOLD: f32 = 0.99;
/// The channels that are neither black nor blown out.
const CHANNELS: std::ops::RangeInclusive<f32> = 0.004..=0.9;
/// How much gains are kept near 1.
const KEPT: f64 = 0.001;

/// What two views have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Common {
    /// The views, by their place among the active ones.
    pub views: [usize; 2],
    /// How many cells.
    pub cells: usize,
    /// The medians of the logarithms of how many times brighter the first is, by channel.
    pub brighter: [f64; 3],
}

/// What the views of the base coat have in common, pair by pair.
pub fn common(map: &Map) -> Vec<Common> {
    let Some(layer) = layer(map) else { return Vec::new() };
    let lists = &map.lists[layer];
    let count = map.wanted.views.len();
    let mut ratios: Vec<Vec<[f64; 3]>> = vec![Vec::new(); count * count];
    for cell in 0..map.cells.layers[layer].len() as u32 {
        let good = lists.of(cell).filter(|at| {
            let entry = &lists.entries[*at];
            map.wanted.views[usize::from(lists.views[*at])].base
                && entry.mask >= LEAST_TOLD
                && entry.facing >= LEAST_TOLD
                && entry.color.iter().all(|channel| CHANNELS.contains(channel))
        });
        let good: Vec<usize> = good.collect();
        for (i, first) in good.iter().enumerate() {
            for second in &good[i + 1..] {
                let [a, b] = [*first, *second].map(|at| lists.entries[at].color.map(|light| ln(f64::from(light))));
                let pair = usize::from(lists.views[*first]) * count + usize::from(lists.views[*second]);
                ratios[pair].push(std::array::from_fn(|channel| a[channel] - b[channel]));
            }
        }
    }
    let enough = ratios.into_iter().enumerate().filter(|(_, ratios)| ratios.len() >= LEAST_CELLS);
    enough
        .map(|(pair, ratios)| Common {
            views: [pair / count, pair % count],
            cells: ratios.len(),
            brighter: std::array::from_fn(|channel| channel_median(&ratios, channel)),
        })
        .collect()
}

/// The median of one channel; 0 of no ratios.
fn channel_median(ratios: &[[f64; 3]], channel: usize) -> f64 {
    let mut all: Vec<f64> = ratios.iter().map(|ratio| ratio[channel]).collect();
    median(&mut all).unwrap_or(0.0)
}

/// What each active view's gain should be multiplied with so that photographs agree; 1 for views that are no photographs.
pub fn factors(map: &Map) -> Vec<[f64; 3]> {
    let (common, count) = (common(map), map.wanted.views.len());
    let base: Vec<usize> = (0..count).filter(|view| map.wanted.views[*view].base).collect();
    let all: f64 = common.iter().map(|pair| pair.cells as f64).sum();
    let mut factors = vec![[1.0; 3]; count];
    if common.is_empty() {
        return factors;
    }
    let place = |view: usize| base.iter().position(|own| *own == view).unwrap_or(0);
    // The normal equations, and a right side for each channel.
    let n = base.len();
    let mut matrix = Matrix::new(n, n + 3);
    let stride = matrix.stride;
    (0..n).for_each(|i| matrix.cells[i * stride + i] = KEPT * all / n as f64);
    for pair in &common {
        let ([u, v], cells) = (pair.views.map(place), pair.cells as f64);
        matrix.cells[u.min(v) * stride + u.max(v)] -= cells;
        for (own, sign) in [(u, 1.0), (v, -1.0)] {
            matrix.cells[own * stride + own] += cells;
            let right = &mut matrix.cells[own * stride + n..];
            right.iter_mut().zip(pair.brighter).for_each(|(right, brighter)| *right -= sign * cells * brighter);
        }
    }
    if matrix.factor(n, &|| false).is_none() {
        return factors;
    }
    let gains = [0, 1, 2].map(|channel| {
        let gains = matrix.solve(n, n + channel);
        let mean = gains.iter().sum::<f64>() / gains.len() as f64;
        gains.into_iter().map(|gain| exp(gain - mean)).collect::<Vec<f64>>()
    });
    for (i, view) in base.iter().enumerate() {
        factors[*view] = [0, 1, 2].map(|channel: usize| gains[channel][i]);
    }
    factors
}

/// The layer on which views are compared: that of their median depth.
fn layer(map: &Map) -> Option<usize> {
    let views = map.wanted.views.iter().zip(&map.reports).filter(|(view, _)| view.base);
    let mut depths: Vec<f64> = views.filter_map(|(_, report)| report.depth).collect();
    let finest = map.cells.layers.len().checked_sub(1)?;
    let median = median(&mut depths)?;
    Some((median.floor().max(0.0) as usize).min(finest))
}
