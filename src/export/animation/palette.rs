//! A palette of at most 255 colours for many frames, and dithering with it.
//!
//! Colours are cut at the mean of the box that errs most (variance cut) and then settled by k-means, both in Oklab, where
//! distance is what an eye sees. Dithering is ordered (each colour becomes a fixed mixture, after Knoll's pattern
//! dithering; the place picks from it), so that what does not move does not flicker, as it would if errors spread.

use std::collections::{HashMap, HashSet};

use rayon::prelude::*;

use crate::base::oklab::{Lab, lab, srgb};
use crate::base::pixels::Frame;

/// Colours of a mixture.
const MIXED: usize = 16;
/// How much of the error the mixture makes good: all of it looks grainy.
const STRENGTH: f64 = 0.8;
/// Rounds of k-means.
const ROUNDS: usize = 6;

/// At most [`Palette::MOST`] colours, and how any other is mixed from them.
pub struct Palette {
    colors: Vec<[u8; 3]>,
    labs: Vec<Lab>,
    /// Whether it holds every colour of its frames: no mixing then.
    exact: bool,
    mixtures: HashMap<[u8; 3], [u8; MIXED]>,
}

impl Palette {
    /// One of the 256 is left for transparency.
    pub const MOST: usize = 255;

    /// The palette for the colours of `frames`, fully transparent pixels aside.
    pub fn of<'a>(frames: impl Iterator<Item = &'a Frame>) -> Self {
        let mut bins: HashMap<u32, [u64; 4]> = HashMap::new();
        let mut all = HashSet::new();
        for &[r, g, b, _] in frames.flat_map(|f| f.cells()).filter(|c| is_opaque(**c)) {
            let bin = bins.entry(u32::from(r >> 2) << 12 | u32::from(g >> 2) << 6 | u32::from(b >> 2)).or_default();
            for (sum, add) in bin.iter_mut().zip([r.into(), g.into(), b.into(), 1]) {
                *sum += add;
            }
            if all.len() <= Self::MOST {
                all.insert([r, g, b]);
            }
        }
        if all.len() <= Self::MOST {
            let mut colors: Vec<_> = all.into_iter().collect();
            colors.sort_unstable();
            return Palette::from_colors(colors, true);
        }
        let mut bins: Vec<_> = bins.into_iter().collect();
        bins.sort_unstable();
        let mean =
            |[r, g, b, n]: [u64; 4]| Point { lab: lab([r, g, b].map(|c| c as f64 / n as f64)), weight: n as f64 };
        let points: Vec<Point> = bins.into_iter().map(|(_, bin)| mean(bin)).collect();
        let mut colors: Vec<_> = settle(&points, cut(points.clone())).into_iter().map(srgb).collect();
        colors.sort_unstable();
        colors.dedup();
        Palette::from_colors(colors, false)
    }

    fn from_colors(mut colors: Vec<[u8; 3]>, exact: bool) -> Self {
        if colors.is_empty() {
            colors.push([0; 3]);
        }
        let labs = colors.iter().map(|c| lab(c.map(f64::from))).collect();
        Palette { colors, labs, exact, mixtures: HashMap::new() }
    }

    /// The colours.
    pub fn colors(&self) -> &[[u8; 3]] {
        &self.colors
    }

    /// The index that stands for transparency.
    pub fn transparent(&self) -> u8 {
        self.colors.len() as u8
    }

    /// The index of the colour for every pixel of `frame`.
    pub fn indices(&mut self, frame: &Frame) -> Vec<u8> {
        self.mix(frame);
        let width = frame.width();
        let index = |(i, color): (usize, &[u8; 4])| match self.mixtures.get(&color[..3]) {
            Some(mixture) if is_opaque(*color) => mixture[threshold(i % width, i / width)],
            _ => self.transparent(),
        };
        frame.cells().par_iter().enumerate().map(index).collect()
    }

    /// Finds the mixtures of colours not met before.
    fn mix(&mut self, frame: &Frame) {
        const KEPT: usize = 1 << 20;
        if self.mixtures.len() > KEPT {
            self.mixtures.clear();
        }
        let opaque = frame.cells().iter().filter(|c| is_opaque(**c)).map(|&[r, g, b, _]| [r, g, b]);
        let fresh: HashSet<[u8; 3]> = opaque.filter(|c| !self.mixtures.contains_key(c)).collect();
        let found: Vec<_> = fresh.into_par_iter().map(|color| (color, self.mixture(color))).collect();
        self.mixtures.extend(found);
    }

    /// Colours that together look like `color`, from dark to bright.
    fn mixture(&self, color: [u8; 3]) -> [u8; MIXED] {
        let wanted = lab(color.map(f64::from));
        if self.exact {
            return [self.nearest(wanted); MIXED];
        }
        let mut owed = [0.0; 3];
        let mut mixture: [u8; MIXED] = std::array::from_fn(|_| {
            let index = self.nearest(std::array::from_fn(|i| wanted[i] + owed[i] * STRENGTH));
            let got = self.labs[usize::from(index)];
            owed = std::array::from_fn(|i| owed[i] + wanted[i] - got[i]);
            index
        });
        mixture.sort_by(|&a, &b| self.labs[usize::from(a)][0].total_cmp(&self.labs[usize::from(b)][0]));
        mixture
    }

    fn nearest(&self, wanted: Lab) -> u8 {
        nearest(&self.labs, wanted) as u8
    }

    /// The mean square distance of the opaque colours of `frame` to the nearest of the palette, in Oklab.
    pub fn error(&self, frame: &Frame) -> f64 {
        let opaque: Vec<_> = frame.cells().iter().step_by(37).filter(|c| is_opaque(**c)).collect();
        let error = |color: &&[u8; 4]| {
            let wanted = lab([color[0], color[1], color[2]].map(f64::from));
            distance2(self.labs[nearest(&self.labs, wanted)], wanted)
        };
        let errors: Vec<f64> = opaque.par_iter().map(error).collect();
        errors.iter().sum::<f64>() / errors.len().max(1) as f64
    }
}

/// GIF knows all or nothing.
pub fn is_opaque(color: [u8; 4]) -> bool {
    color[3] >= 128
}

/// Which colour of a mixture stands at (x, y): interleaved gradient noise (Jimenez 2014), even in every neighbourhood.
fn threshold(x: usize, y: usize) -> usize {
    let part = |x: f64| x - x.floor();
    let noise = part(52.982_918_9 * part(0.067_110_56 * x as f64 + 0.005_837_15 * y as f64));
    (noise * MIXED as f64) as usize
}

#[derive(Clone, Copy)]
struct Point {
    lab: Lab,
    weight: f64,
}

/// Points together: their mean, and the axis on which they spread most.
struct Group {
    points: Vec<Point>,
    mean: Lab,
    axis: usize,
    /// Sum of weighted squared distances to the mean on that axis.
    spread: f64,
}

impl Group {
    fn of(points: Vec<Point>) -> Self {
        let weight: f64 = points.iter().map(|p| p.weight).sum();
        let mean: Lab = std::array::from_fn(|i| points.iter().map(|p| p.lab[i] * p.weight).sum::<f64>() / weight);
        let spread = |i: usize| points.iter().map(|p| (p.lab[i] - mean[i]) * (p.lab[i] - mean[i]) * p.weight).sum();
        let spreads: [f64; 3] = std::array::from_fn(spread);
        let axis = (0..3).max_by(|&a, &b| spreads[a].total_cmp(&spreads[b])).unwrap_or(0);
        Group { points, mean, axis, spread: spreads[axis] }
    }
}

/// The means of at most [`Palette::MOST`] groups.
fn cut(points: Vec<Point>) -> Vec<Lab> {
    let mut groups = vec![Group::of(points)];
    while groups.len() < Palette::MOST {
        let Some(worst) = (0..groups.len()).max_by(|&a, &b| groups[a].spread.total_cmp(&groups[b].spread)) else {
            break;
        };
        let Group { points, mean, axis, .. } = groups.swap_remove(worst);
        let (low, high): (Vec<_>, Vec<_>) = points.iter().partition(|p| p.lab[axis] <= mean[axis]);
        if low.is_empty() || high.is_empty() {
            groups.push(Group { points, mean, axis, spread: 0.0 }); // one place: cannot be cut, and so can no other
            break;
        }
        groups.extend([Group::of(low), Group::of(high)]);
    }
    groups.into_iter().map(|g| g.mean).collect()
}

/// Moves each colour to the mean of the points nearest to it, a few times.
fn settle(points: &[Point], mut colors: Vec<Lab>) -> Vec<Lab> {
    for _ in 0..ROUNDS {
        let owners: Vec<usize> = points.par_iter().map(|p| nearest(&colors, p.lab)).collect();
        let mut sums = vec![([0.0; 3], 0.0); colors.len()];
        for (point, owner) in points.iter().zip(owners) {
            let (sum, weight) = &mut sums[owner];
            *sum = std::array::from_fn(|i| sum[i] + point.lab[i] * point.weight);
            *weight += point.weight;
        }
        for (color, (sum, weight)) in colors.iter_mut().zip(sums) {
            if weight > 0.0 {
                *color = sum.map(|s| s / weight);
            }
        }
    }
    colors
}

fn nearest(colors: &[Lab], wanted: Lab) -> usize {
    let mut best = (f64::INFINITY, 0);
    for (i, &color) in colors.iter().enumerate() {
        let distance = distance2(color, wanted);
        if distance < best.0 {
            best = (distance, i);
        }
    }
    best.1
}

fn distance2(a: Lab, b: Lab) -> f64 {
    let [x, y, z] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    x * x + y * y + z * z
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(width: usize, height: usize) -> Frame {
        let cell = |i: usize| [(i % width * 255 / (width - 1)) as u8, (i / width * 255 / (height - 1)) as u8, 90, 255];
        Frame::from_cells(width, height, (0..width * height).map(cell).collect())
    }

    #[test]
    fn few_colours_are_exact() {
        let mut frame = ramp(15, 16);
        frame.cells_mut()[3] = [9, 9, 9, 0];
        let mut palette = Palette::of([&frame].into_iter());
        let indices = palette.indices(&frame);
        assert_eq!(indices[3], palette.transparent());
        for (i, (color, index)) in frame.cells().iter().zip(indices).enumerate() {
            assert!(i == 3 || palette.colors()[usize::from(index)] == color[..3], "{i}");
        }
    }

    #[test]
    fn many_colours_are_mixed_to_the_right_mean() {
        let frame = ramp(256, 256);
        let mut palette = Palette::of([&frame].into_iter());
        assert!((200..=Palette::MOST).contains(&palette.colors().len()));
        let flat = Frame::filled(64, 64, [131, 77, 90, 255]);
        let indices = palette.indices(&flat);
        let mean = |channel: usize| {
            let sum: f64 = indices.iter().map(|&i| f64::from(palette.colors()[usize::from(i)][channel])).sum();
            sum / indices.len() as f64
        };
        for (channel, wanted) in [131.0, 77.0, 90.0].into_iter().enumerate() {
            assert!((mean(channel) - wanted).abs() < 4.0, "{channel}: {}", mean(channel));
        }
        assert!(palette.error(&frame) < 1e-3);
    }
}
