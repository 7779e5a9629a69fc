//! The sum of all kernels: tile by tile, in the order of the impulses, so that the bits do not depend on threads.

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::bins::{Bins, Facet, Kernel, TILE};
use super::curves::{LANES, Line, wave};
use super::impulse::Impulse;
use super::level::{Apart, Level};
use super::shown::InFrame;
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

/// A noise at each pixel: mean 0 and variance 1 on the layer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Noise {
    /// Its value.
    pub value: Vec<f32>,
    /// The variance there, as a share of what it is on average; empty if that is not asked for.
    pub share: Vec<f32>,
}

impl Noise {
    /// Room for one of so many pixels, without shares.
    pub fn of_values(count: usize) -> Noise {
        Noise { value: vec![0.0; count], share: Vec::new() }
    }

    /// The same with shares.
    pub fn with_shares(count: usize) -> Noise {
        Noise { share: vec![0.0; count], ..Noise::of_values(count) }
    }

    /// What it has room for in each tile of a frame of this width, row by row: for values and for shares.
    fn tiles(&mut self, width: usize) -> Vec<Vec<[&mut [f32]; 2]>> {
        let (across, height) = (width.div_ceil(TILE), self.value.len() / width.max(1));
        let mut tiles = Vec::new();
        tiles.resize_with(across * height.div_ceil(TILE), || Vec::with_capacity(TILE));
        let mut shares = self.share.chunks_mut(width.max(1));
        for (y, values) in self.value.chunks_mut(width.max(1)).enumerate() {
            let mut shares = shares.next().unwrap_or_default().chunks_mut(TILE);
            let own = tiles[y / TILE * across..].iter_mut().zip(values.chunks_mut(TILE));
            own.for_each(|(tile, values)| tile.push([values, shares.next().unwrap_or_default()]));
        }
        tiles
    }
}

/// Writes the sum of the kernels of impulses, `overlap` of which are over each pixel, with so many waves in a radius, to what
/// `noise` has room for.
pub fn sum(shown: &InFrame, lumps: &[Bins], (overlap, waves): (f64, f64), trim: Trim, noise: &mut Noise) {
    let (across, scale) = (shown.size_px.0.div_ceil(TILE), Scale::new(overlap));
    let tiles = noise.tiles(shown.size_px.0).into_par_iter().enumerate();
    tiles.for_each_init(Sums::new, |sums, (i, mut out)| {
        let (x, y) = (i % across, i / across);
        let Some(level) = shown.level((x, y)) else { return };
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
        // Those of a triangle follow one another.
        let mut last = None;
        for lump in kernels.chunks(LANES) {
            if is_set(self.shown.stop) {
                return;
            }
            let places = Places::new(lump, self.size);
            for (k, kernel) in lump.iter().enumerate() {
                let facet = &facets[kernel.facet as usize];
                let apart = match last {
                    Some((own, apart)) if own == kernel.facet => apart,
                    _ => self.level.apart(facet.plane),
                };
                last = Some((kernel.facet, apart));
                self.add(kernel, (facet, &apart), &places.of(k), &mut curves);
            }
        }
    }

    /// Adds a kernel whose plane is so far apart from the level.
    #[inline(always)]
    fn add(
        &mut self,
        kernel: &Kernel,
        (facet, apart): (&Facet, &Apart),
        place: &Place,
        [across, down]: &mut [Curves; 2],
    ) {
        let Place { columns, rows, cosine, sine } = place;
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        let covered = match self.trim {
            Trim::Object => Some(true),
            Trim::Triangle => None,
            Trim::Depth(reach) => self.level.covered(apart, (f64::from(kernel.scale), reach), columns, rows),
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
        for lump in 0..columns.len().div_ceil(LANES) {
            let left = columns.start + lump * LANES;
            let block = Block { left, rows: rows.clone(), across: across.each_ref().map(|line| line[lump]), down };
            let (shown, (x, y)) = (self.shown, (self.corner.0 + left, self.corner.1));
            match self.trim {
                _ if covered.is_some() => block.add(self.sums, |_| [1.0; LANES]),
                Trim::Depth(reach) => {
                    let near = Near::new(facet.plane, kernel.scale, reach);
                    block.add(
                        self.sums,
                        #[inline(always)]
                        |row| near.covers((x, y + row), shown.lanes(shown.inverse, (x, y + row))),
                    );
                }
                Trim::Object | Trim::Triangle => {
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
            values.copy_from_slice(&value[..values.len()]);
            shares.copy_from_slice(&power[..shares.len()]);
        }
    }
}

/// Where some kernels are in a tile.
struct Places {
    /// The columns that they reach: from and to; and the rows.
    columns: [[f32; LANES]; 2],
    rows: [[f32; LANES]; 2],
    /// Of the angles of their strokes.
    cosines: [f32; LANES],
    sines: [f32; LANES],
}

/// Where one of them is.
struct Place {
    columns: Range<usize>,
    rows: Range<usize>,
    cosine: f32,
    sine: f32,
}

impl Places {
    /// Where these are in a tile of this size.
    #[inline(always)]
    fn new(kernels: &[Kernel], size: (usize, usize)) -> Places {
        let (mut at, [mut radius, mut angle]) = ([[0.0; LANES]; 2], [[0.0; LANES]; 2]);
        for (k, kernel) in kernels.iter().enumerate() {
            [at[0][k], at[1][k]] = kernel.at;
            (radius[k], angle[k]) = (kernel.radius_px, kernel.angle);
        }
        let [mut cosines, mut sines] = [[0.0; LANES]; 2];
        for k in 0..LANES {
            (cosines[k], sines[k]) = wave(angle[k]);
        }
        let [columns, rows] = [(at[0], size.0), (at[1], size.1)].map(
            #[inline(always)]
            |(at, length)| {
                let mut reached = [[0.0; LANES]; 2];
                for k in 0..LANES {
                    // The pixels whose centers are nearer than the radius.
                    let within = |at: f32| at.clamp(0.0, length as f32);
                    reached[0][k] = within((at[k] - radius[k] - 0.5).floor() + 1.0);
                    reached[1][k] = within((at[k] + radius[k] - 0.5).ceil());
                }
                reached
            },
        );
        Places { columns, rows, cosines, sines }
    }

    #[inline(always)]
    fn of(&self, k: usize) -> Place {
        let range = |[from, to]: [[f32; LANES]; 2]| from[k] as i32 as usize..to[k] as i32 as usize;
        Place { columns: range(self.columns), rows: range(self.rows), cosine: self.cosines[k], sine: self.sines[k] }
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
        let mut noise = Noise::with_shares(shown.triangle.len());
        sum(shown, &[binning.sorted()], (16.0, impulse.radius_px / impulse.spacing_px), trim, &mut noise);
        noise
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
