//! The sum of all kernels: tile by tile, in the order of the impulses, so that the bits do not depend on threads.

use std::ops::Range;
use std::sync::OnceLock;
use std::sync::atomic::AtomicBool;

use glam::DVec3;
use rayon::prelude::*;

use super::bins::{Bins, Facet, Kernel, TILE};
use super::curves::{LANES, Line, wave};
use super::impulse::Impulse;
use super::level::Level;
use super::synth::is_set;
use crate::base::maths::{TAU, smoothstep};
use crate::base::simd::{fused, vectorised};

/// The curves of a kernel along a row or down a column of a tile.
type Curves = [[[f32; LANES]; TILE / LANES]; 3];

/// How long the rows of a tile are in memory: a lump of lanes may begin at its last pixel.
const STRIDE: usize = TILE + LANES;
/// The integral of a kernel's squared curve from -1 to 1.
pub const INTEGRAL: f64 = 0.682_939;
/// The least share of the variance that a sum is divided by.
const LEAST: f32 = 1.0 / 16.0;

/// What a kernel covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trim {
    /// What lies within so many of its radii of its triangle's plane.
    Depth(f64),
    /// All of the layer.
    Object,
    /// Its own triangle.
    Triangle,
}

/// What the frame shows of a layer.
pub struct InFrame<'a> {
    /// Width and height, in pixels.
    pub size_px: (usize, usize),
    /// Distance of the picture plane, in pixels.
    pub focal_px: f64,
    /// 1 / the depth of what each pixel shows; 0 where that is nothing.
    pub inverse: &'a [f64],
    /// The triangle of the layer that each pixel shows, `u32::MAX` where it shows none.
    pub triangle: &'a [u32],
    /// Once it is set, the sum counts no more.
    pub stop: Option<&'a AtomicBool>,
    /// The levels of its tiles, row after row, once they are needed; `None` where the layer is not seen.
    levels: OnceLock<Vec<Option<Level>>>,
}

impl<'a> InFrame<'a> {
    /// A frame of this size, with the picture plane at this distance.
    pub fn new(
        (size_px, focal_px): ((usize, usize), f64),
        inverse: &'a [f64],
        triangle: &'a [u32],
        stop: Option<&'a AtomicBool>,
    ) -> InFrame<'a> {
        InFrame { size_px, focal_px, inverse, triangle, stop, levels: OnceLock::new() }
    }

    /// What some pixels of a row have, from this one on; what is beyond the end is not to be used.
    #[inline(always)]
    fn lanes<T: Copy + Default>(&self, of: &[T], (x, y): (usize, usize)) -> [T; LANES] {
        let rest = &of[y * self.size_px.0 + x..];
        rest.first_chunk().copied().unwrap_or_else(|| {
            let mut lanes = [T::default(); LANES];
            lanes[..rest.len()].copy_from_slice(rest);
            lanes
        })
    }

    fn levels(&self) -> &[Option<Level>] {
        self.levels.get_or_init(|| {
            let (width, height) = self.size_px;
            let across = width.div_ceil(TILE);
            let tiles = (0..across * height.div_ceil(TILE)).into_par_iter();
            let level = |i: usize| {
                let (x, y) = (i % across * TILE, i / across * TILE);
                let (columns, rows) = (x..(x + TILE).min(width), y..(y + TILE).min(height));
                vectorised(
                    #[inline(always)]
                    || Level::new((width, self.inverse, self.triangle), &columns, &rows),
                )
            };
            tiles.map(level).collect()
        })
    }
}

/// A noise at each pixel: mean 0 and variance 1 on the layer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Noise {
    /// Its value.
    pub value: Vec<f32>,
    /// The variance there, as a share of what it is on average.
    pub share: Vec<f32>,
}

/// The sum of the kernels of impulses, `overlap` of which are over each pixel, with so many waves in a radius.
pub fn sum(shown: &InFrame, lumps: &[Bins], (overlap, waves): (f64, f64), trim: Trim) -> Noise {
    let (width, height) = shown.size_px;
    let (across, scale) = (width.div_ceil(TILE), Scale::new(overlap));
    let mut noise = Noise { value: vec![0.0; width * height], share: vec![0.0; width * height] };
    // What is written to, row by row of each tile.
    let mut tiles: Vec<Vec<[&mut [f32]; 2]>> = Vec::new();
    tiles.resize_with(across * height.div_ceil(TILE), || Vec::with_capacity(TILE));
    let rows = noise.value.chunks_mut(width.max(1)).zip(noise.share.chunks_mut(width.max(1)));
    for (y, (values, shares)) in rows.enumerate() {
        let parts = values.chunks_mut(TILE).zip(shares.chunks_mut(TILE));
        tiles[y / TILE * across..]
            .iter_mut()
            .zip(parts)
            .for_each(|(tile, (values, shares))| tile.push([values, shares]));
    }
    let tiles = tiles.into_par_iter().zip(shown.levels()).enumerate();
    tiles.for_each_init(Sums::new, |sums, (i, (mut out, level))| {
        let Some(level) = level else { return };
        let (x, y) = (i % across, i / across);
        let size = (out[0][0].len(), out.len());
        vectorised(
            #[inline(always)]
            || {
                let mut tile =
                    Tile { shown, corner: (x * TILE, y * TILE), size, trim, waves: waves as f32, level, sums };
                tile.sums.clear();
                tile.sums.resize(TILE, [[0.0; STRIDE]; 2]);
                for lump in lumps {
                    tile.add_all(&lump.facets, lump.of(x, y));
                }
                tile.finish(&scale, &mut out);
            },
        );
    });
    noise
}

/// The sums of a tile, row by row: of kernels, and of their variances.
type Sums = Vec<[[f32; STRIDE]; 2]>;

/// A part of the frame.
struct Tile<'a> {
    shown: &'a InFrame<'a>,
    /// Its first column and row, and how many it has.
    corner: (usize, usize),
    size: (usize, usize),
    trim: Trim,
    /// How many waves a radius has.
    waves: f32,
    level: &'a Level,
    sums: &'a mut Sums,
}

impl Tile<'_> {
    /// Adds these kernels, of impulses of these triangles.
    #[inline(always)]
    fn add_all(&mut self, facets: &[Facet], kernels: &[Kernel]) {
        let mut curves = [[[[0.0; LANES]; TILE / LANES]; 3]; 2];
        for lump in kernels.chunks(LANES) {
            if is_set(self.shown.stop) {
                return;
            }
            let mut angles = [0.0; LANES];
            angles.iter_mut().zip(lump).for_each(|(angle, kernel)| *angle = kernel.angle);
            let (mut cosines, mut sines) = ([0.0; LANES], [0.0; LANES]);
            for k in 0..LANES {
                (cosines[k], sines[k]) = wave(angles[k]);
            }
            for (k, kernel) in lump.iter().enumerate() {
                self.add(kernel, &facets[kernel.facet as usize], (cosines[k], sines[k]), &mut curves);
            }
        }
    }

    /// Adds a kernel whose angle has this cosine and this sine.
    #[inline(always)]
    fn add(&mut self, kernel: &Kernel, facet: &Facet, (cosine, sine): (f32, f32), [across, down]: &mut [Curves; 2]) {
        let columns = reached(kernel.at[0], kernel.radius_px, self.size.0);
        let rows = reached(kernel.at[1], kernel.radius_px, self.size.1);
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        let covered = match self.trim {
            Trim::Object => Some(true),
            Trim::Triangle => None,
            Trim::Depth(reach) => self.level.covered((facet.plane, f64::from(kernel.scale), reach), &columns, &rows),
        };
        if covered == Some(false) {
            return;
        }
        let (inverse, often) = (1.0 / kernel.radius_px, self.waves / kernel.radius_px);
        let first = columns.start as f32 + 0.5 - kernel.at[0];
        Line { first, inverse, waves: -sine * often, phase: 0.0, weight: 1.0 }.fill(across, columns.len());
        let first = rows.start as f32 + 0.5 - kernel.at[1];
        let (phase, weight) = (kernel.phase, kernel.factor);
        Line { first, inverse, waves: cosine * often, phase, weight }.fill(down, rows.len());
        let near = match self.trim {
            Trim::Depth(reach) => Some(Near::new(facet.plane, kernel.scale, reach)),
            Trim::Object | Trim::Triangle => None,
        };
        for lump in 0..columns.len().div_ceil(LANES) {
            let left = columns.start + lump * LANES;
            let block = Block { left, rows: rows.clone(), across: across.each_ref().map(|line| line[lump]), down };
            let (shown, (x, y)) = (self.shown, (self.corner.0 + left, self.corner.1));
            match &near {
                _ if covered.is_some() => block.add(self.sums, |_| [1.0; LANES]),
                Some(near) => block.add(
                    self.sums,
                    #[inline(always)]
                    |row| near.covers((x, y + row), shown.lanes(shown.inverse, (x, y + row))),
                ),
                None => {
                    let own = |triangle: u32| f32::from(u8::from(triangle == facet.triangle));
                    block.add(self.sums, |row| shown.lanes(shown.triangle, (x, y + row)).map(own));
                }
            }
        }
    }

    /// Writes the noise and its variance that the sums make.
    #[inline(always)]
    fn finish(&self, scale: &Scale, out: &mut [[&mut [f32]; 2]]) {
        for (row, ([values, shares], sums)) in out.iter_mut().zip(&*self.sums).enumerate() {
            let first = (self.corner.1 + row) * self.shown.size_px.0 + self.corner.0;
            let (mut triangles, [mut value, mut power]) = ([u32::MAX; STRIDE], *sums);
            triangles[..self.size.0].copy_from_slice(&self.shown.triangle[first..first + self.size.0]);
            for x in 0..STRIDE {
                let (own, found) = (triangles[x] != u32::MAX, scale.of(value[x], power[x]));
                value[x] = if own { found.0 } else { 0.0 };
                power[x] = if own { found.1 } else { 0.0 };
            }
            values.copy_from_slice(&value[..self.size.0]);
            shares.copy_from_slice(&power[..self.size.0]);
        }
    }
}

/// Some columns of a kernel.
struct Block<'a> {
    /// Its first column, and its rows.
    left: usize,
    rows: Range<usize>,
    /// The kernel's curves along a row, only here, and down a column.
    across: [[f32; LANES]; 3],
    down: &'a Curves,
}

impl Block<'_> {
    /// Adds it, so much of it as covers each pixel of a row.
    #[inline(always)]
    fn add(&self, sums: &mut Sums, covers: impl Fn(usize) -> [f32; LANES]) {
        let ([cosines, sines, squares], [a, b, c]) =
            (self.across, self.down.each_ref().map(|line| line.as_flattened()));
        let (squares, own) = (squares.map(|square| 0.5 * square), self.left..self.left + LANES);
        let down = a.iter().zip(b).zip(c);
        for ((row, ((&a, &b), &c)), y) in sums[self.rows.clone()].iter_mut().zip(down).zip(self.rows.start..) {
            let [values, powers] = row.each_mut().map(|sums| &mut sums[own.clone()]);
            // Copies, so that the compiler sees that none overlaps another.
            let ([mut value, mut power], covers) = ([[0.0; LANES]; 2], covers(y));
            value.copy_from_slice(values);
            power.copy_from_slice(powers);
            for k in 0..LANES {
                let cover = covers[k];
                value[k] = fused(b * cover, -sines[k], fused(a * cover, cosines[k], value[k]));
                power[k] = fused(c * cover * cover, squares[k], power[k]);
            }
            values.copy_from_slice(&value);
            powers.copy_from_slice(&power);
        }
    }
}

/// How much each pixel of a row shows of a kernel, by its 1 / depth: less the farther that is from the plane of the kernel, and
/// nothing beyond `reach`.
struct Near {
    /// The plane, times `scale`.
    plane: DVec3,
    scale: f32,
    reach: f32,
    often: f32,
}

impl Near {
    #[inline(always)]
    fn new(plane: DVec3, scale: f32, reach: f64) -> Near {
        Near { plane: plane * f64::from(scale), scale, reach: reach as f32, often: (1.0 / reach) as f32 }
    }

    /// Of some pixels from this one on, by the 1 / depth there.
    #[inline(always)]
    fn covers(&self, (x, y): (usize, usize), inverse: [f64; LANES]) -> [f32; LANES] {
        let level = self.plane.dot(DVec3::new(x as f64 + 0.5, y as f64 + 0.5, 1.0)) as f32;
        let (slope, mut covers) = (self.plane.x as f32, [0.0; LANES]);
        for k in 0..LANES {
            let away = fused(inverse[k] as f32, self.scale, -fused(slope, k as f32, level)).abs();
            let x = ((away - self.reach) * self.often).clamp(0.0, 1.0);
            covers[k] = 1.0 - x * x * (3.0 - 2.0 * x);
        }
        covers
    }
}

/// The variance of a sum on average.
pub fn variance(overlap: f64) -> f32 {
    (overlap * INTEGRAL * INTEGRAL / TAU) as f32
}

/// What sums are divided by.
struct Scale {
    /// 1 / the variance on average.
    often: f32,
    least: f32,
}

impl Scale {
    fn new(overlap: f64) -> Scale {
        let variance = variance(overlap);
        Scale { often: 1.0 / variance, least: variance * LEAST }
    }

    /// A noise and its variance by the sums of kernels and of their variances.
    #[inline(always)]
    fn of(&self, sum: f32, power: f32) -> (f32, f32) {
        (sum / power.max(self.least).sqrt(), power * self.often)
    }
}

/// A noise by its sums: of kernels, and of their variances.
pub fn normalized(shown: &InFrame, sums: &[[f32; 2]], overlap: f64) -> Noise {
    let scale = Scale::new(overlap);
    let own = |i: usize| shown.triangle[i] != u32::MAX;
    let of = |(i, [sum, power]): (usize, &[f32; 2])| if own(i) { scale.of(*sum, *power) } else { (0.0, 0.0) };
    let (value, share) = sums.par_iter().enumerate().map(of).unzip();
    Noise { value, share }
}

/// The pixels of a tile of this length whose centers are nearer to a place than a distance.
#[inline(always)]
fn reached(middle: f32, radius: f32, length: usize) -> Range<usize> {
    let within = |at: f32| at.clamp(0.0, length as f32) as usize;
    within((middle - radius - 0.5).floor() + 1.0)..within((middle + radius - 0.5).ceil())
}

/// How much of a kernel a pixel shows.
pub fn covers(shown: &InFrame, trim: Trim, impulse: &Impulse, (x, y): (usize, usize)) -> f64 {
    let i = y * shown.size_px.0 + x;
    match trim {
        Trim::Object => 1.0,
        Trim::Triangle => f64::from(u8::from(shown.triangle[i] == impulse.of[0])),
        Trim::Depth(reach) => {
            let level = impulse.plane.dot(DVec3::new(x as f64 + 0.5, y as f64 + 0.5, 1.0));
            let scale = impulse.depth * shown.focal_px / impulse.radius_px;
            1.0 - smoothstep(reach, 2.0 * reach, (shown.inverse[i] - level).abs() * scale)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::maths::{cos, exp, sin};
    use glam::DVec2;

    use crate::layers::mesh::slots::strokes::bins::Binning;
    use crate::layers::mesh::slots::strokes::curves::EDGE;

    fn impulse(at: (f64, f64)) -> Impulse {
        Impulse {
            of: [0, 1, 0],
            at: DVec2::new(at.0, at.1),
            depth: 2.0,
            factor: 0.8,
            phase: 0.7,
            angle: 0.4,
            sure: 1.0,
            radius_px: 20.0,
            spacing_px: 16.0,
            plane: DVec3::new(0.0, 0.0, 0.5),
        }
    }

    fn sum_of(shown: &InFrame, impulse: &Impulse, trim: Trim) -> Noise {
        let mut binning = Binning::new(shown.size_px, shown.focal_px);
        binning.extend([*impulse]);
        sum(shown, &[binning.sorted()], (16.0, impulse.radius_px / impulse.spacing_px), trim)
    }

    #[test]
    fn a_kernel_is_its_formula() {
        let (width, height) = (100, 90);
        let (inverse, triangle) = (vec![0.5; width * height], vec![0; width * height]);
        let shown = InFrame::new(((width, height), 100.0), &inverse, &triangle, None);
        let own = impulse((61.3, 63.9));
        let found = sum_of(&shown, &own, Trim::Depth(0.5));
        let curve = |d: f64| (exp(-std::f64::consts::PI * d * d / 400.0) - EDGE) / (1.0 - EDGE);
        let variance = 16.0 * INTEGRAL * INTEGRAL / TAU;
        for y in 0..height {
            for x in 0..width {
                let (dx, dy) = (x as f64 + 0.5 - own.at.x, y as f64 + 0.5 - own.at.y);
                let k = TAU / 16.0;
                let wave = cos(k * (-sin(0.4) * dx + cos(0.4) * dy) + 0.7);
                let weight = if dx.abs() < 20.0 && dy.abs() < 20.0 { 0.8 * curve(dx) * curve(dy) } else { 0.0 };
                let (n, p) = (weight * wave, weight * weight / 2.0);
                let i = y * width + x;
                assert!((f64::from(found.share[i]) - p / variance).abs() < 1e-6, "{x} {y}");
                assert!((f64::from(found.value[i]) - n / p.max(variance / 16.0).sqrt()).abs() < 1e-5, "{x} {y}");
            }
        }
    }

    #[test]
    fn what_is_far_in_depth_is_not_reached_and_what_is_not_the_layer_is_empty() {
        let (width, height) = (70, 40);
        let own = impulse((30.0, 20.0));
        // e = |1/z - 1/2| * 2 * 100 / 20.
        let inverse: Vec<f64> = (0..width * height).map(|i| if i % width < 30 { 0.5 } else { 0.5 + 0.075 }).collect();
        let triangle: Vec<u32> = (0..width * height).map(|i| if i / width < 5 { u32::MAX } else { 0 }).collect();
        let shown = InFrame::new(((width, height), 100.0), &inverse, &triangle, None);
        let found = sum_of(&shown, &own, Trim::Depth(0.5));
        let all = sum_of(&shown, &own, Trim::Object);
        for y in 0..height {
            let (left, right) = (y * width + 20, y * width + 35);
            assert_eq!(found.share[left], all.share[left]);
            let expected = if y < 5 { 0.0 } else { 0.25 * all.share[right] };
            assert!((found.share[right] - expected).abs() < 1e-6, "half way between reach and twice it");
        }
    }
}
