//! The sum of all kernels: tile by tile, in the order of the impulses, so that the bits do not depend on threads.

use std::ops::Range;
use std::sync::atomic::AtomicBool;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::bins::{Bins, TILE};
use super::curves::{Curves, LANES, Line, turns, wave};
use super::impulse::Impulse;
use super::level::Level;
use super::synth::is_set;
use crate::base::maths::{TAU, smoothstep};
use crate::base::simd::vectorised;

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
}

/// A noise at each pixel: mean 0 and variance 1 on the layer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Noise {
    /// Its value.
    pub value: Vec<f32>,
    /// The variance there, as a share of what it is on average.
    pub share: Vec<f32>,
}

/// The sum of impulses, `overlap` of which are over each pixel.
pub fn sum(shown: &InFrame, impulses: &[Impulse], overlap: f64, trim: Trim) -> Noise {
    let (width, height) = shown.size_px;
    let across = width.div_ceil(TILE).max(1);
    let bins = Bins::new(shown.size_px, impulses);
    let scale = Scale::new(overlap);
    let mut noise = Noise { value: vec![0.0; width * height], share: vec![0.0; width * height] };
    let lines = (width * TILE).max(1);
    let lines = noise.value.par_chunks_mut(lines).zip(noise.share.par_chunks_mut(lines)).enumerate();
    lines.for_each(|(j, (values, shares))| {
        let rows = j * TILE..((j + 1) * TILE).min(height);
        let tile = |i: usize| {
            let columns = i * TILE..((i + 1) * TILE).min(width);
            vectorised(
                #[inline(always)]
                || {
                    let mut tile = Tile::new(shown, columns, rows.clone(), trim)?;
                    tile.add_all(impulses, bins.of(j * across + i));
                    tile.finish(&scale);
                    Some(tile)
                },
            )
        };
        let tiles: Vec<Option<Tile>> = (0..across).into_par_iter().map(tile).collect();
        for tile in tiles.iter().flatten() {
            for (k, own) in (0..rows.len()).map(|k| (k, k * STRIDE..k * STRIDE + tile.columns.len())) {
                let out = k * width + tile.columns.start..k * width + tile.columns.end;
                values[out.clone()].copy_from_slice(&tile.value[own.clone()]);
                shares[out].copy_from_slice(&tile.power[own]);
            }
        }
    });
    noise
}

/// Some columns of some rows.
struct Tile<'a> {
    shown: &'a InFrame<'a>,
    columns: Range<usize>,
    rows: Range<usize>,
    trim: Trim,
    level: Level,
    /// 1 / the depth of what each pixel shows, in rows of `STRIDE`, as are the sums.
    inverse: Vec<f64>,
    value: Vec<f32>,
    power: Vec<f32>,
}

impl<'a> Tile<'a> {
    /// `None` if the layer is not seen in it.
    #[inline(always)]
    fn new(shown: &'a InFrame<'a>, columns: Range<usize>, rows: Range<usize>, trim: Trim) -> Option<Tile<'a>> {
        let level = Level::new((shown.size_px.0, shown.inverse, shown.triangle), &columns, &rows)?;
        let cells = STRIDE * rows.len();
        let mut inverse = vec![0.0; cells];
        for (own, y) in inverse.chunks_exact_mut(STRIDE).zip(rows.clone()) {
            let from = y * shown.size_px.0;
            own[..columns.len()].copy_from_slice(&shown.inverse[from + columns.start..from + columns.end]);
        }
        Some(Tile { shown, columns, rows, trim, level, inverse, value: vec![0.0; cells], power: vec![0.0; cells] })
    }

    /// Adds these impulses.
    #[inline(always)]
    fn add_all(&mut self, impulses: &[Impulse], wanted: &[u32]) {
        let mut scratch = Scratch::default();
        for lump in wanted.chunks(LANES) {
            if is_set(self.shown.stop) {
                return;
            }
            let mut angles = [0.0; LANES];
            for (angle, &i) in angles.iter_mut().zip(lump) {
                *angle = turns(impulses[i as usize].angle);
            }
            let (mut cosines, mut sines) = ([0.0; LANES], [0.0; LANES]);
            for k in 0..LANES {
                (cosines[k], sines[k]) = wave(angles[k]);
            }
            for (k, &i) in lump.iter().enumerate() {
                self.add(&impulses[i as usize], (cosines[k], sines[k]), &mut scratch);
            }
        }
    }

    /// Adds an impulse whose angle has this cosine and this sine.
    #[inline(always)]
    fn add(&mut self, impulse: &Impulse, (cosine, sine): (f32, f32), scratch: &mut Scratch) {
        let columns = reached(impulse.at.x, impulse.radius_px, &self.columns);
        let rows = reached(impulse.at.y, impulse.radius_px, &self.rows);
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        let whole = match self.trim {
            Trim::Object => true,
            Trim::Triangle => false,
            Trim::Depth(reach) => match self.all(impulse, reach, &columns, &rows) {
                Some(false) => return,
                all => all.is_some(),
            },
        };
        let often = (1.0 / impulse.spacing_px) as f32;
        let radius_px = impulse.radius_px;
        let Scratch { across, down, covers } = scratch;
        let first = columns.start as f64 + 0.5 - impulse.at.x;
        let wide = columns.len().next_multiple_of(LANES);
        Line { first, radius_px, waves: -sine * often, phase: 0.0, weight: 1.0 }.fill(lines(across, wide));
        let first = rows.start as f64 + 0.5 - impulse.at.y;
        let (phase, weight) = (turns(impulse.phase), impulse.factor as f32);
        let high = rows.len().next_multiple_of(LANES);
        Line { first, radius_px, waves: cosine * often, phase, weight }.fill(lines(down, high));
        let left = columns.start - self.columns.start;
        let [cosines, sines, squares] = across;
        let curves = (&cosines[..wide], &sines[..wide], &squares[..wide]);
        for (k, y) in rows.enumerate() {
            let from = (y - self.rows.start) * STRIDE + left;
            let (value, power) = (&mut self.value[from..from + wide], &mut self.power[from..from + wide]);
            let (a, b, c) = (down[0][k], down[1][k], down[2][k] * 0.5);
            if whole {
                add_row(value, power, curves, (a, b, c), |_| 1.0);
                continue;
            }
            match self.trim {
                Trim::Depth(reach) => {
                    let inverse = &self.inverse[from..from + wide];
                    let scale = impulse.depth * self.shown.focal_px / radius_px;
                    let level = impulse.plane.y * (y as f64 + 0.5) + impulse.plane.z;
                    let level = level + impulse.plane.x * (columns.start as f64 + 0.5);
                    near(&mut covers[..wide], inverse, (impulse.plane.x, level), (scale, reach));
                }
                Trim::Object | Trim::Triangle => {
                    let covered = trimmed(self.shown, self.trim, impulse, y, columns.clone());
                    covers.iter_mut().zip(covered).for_each(|(cover, covered)| *cover = covered);
                }
            }
            let covers = &covers[..wide];
            add_row(value, power, curves, (a, b, c), |i| covers[i]);
        }
    }

    /// Makes the noise and its variance of the sums.
    #[inline(always)]
    fn finish(&mut self, scale: &Scale) {
        for (k, y) in self.rows.clone().enumerate() {
            let own = k * STRIDE..k * STRIDE + self.columns.len();
            let from = y * self.shown.size_px.0;
            let triangle = &self.shown.triangle[from + self.columns.start..from + self.columns.end];
            let sums = self.value[own.clone()].iter_mut().zip(&mut self.power[own]);
            for ((value, power), triangle) in sums.zip(triangle) {
                let (own, found) = (*triangle != u32::MAX, scale.of(*value, *power));
                *value = if own { found.0 } else { 0.0 };
                *power = if own { found.1 } else { 0.0 };
            }
        }
    }

    /// Whether all of the layer here is within the reach of a kernel, or none of it; `None` if that differs.
    #[inline(always)]
    fn all(&self, impulse: &Impulse, reach: f64, columns: &Range<usize>, rows: &Range<usize>) -> Option<bool> {
        let plane = self.level.plane - impulse.plane;
        let corner = DVec2::new(self.columns.start as f64 + 0.5, self.rows.start as f64 + 0.5);
        let first = plane.x * corner.x + plane.y * corner.y + plane.z;
        let own = |range: &Range<usize>, from: usize| range.start - from..range.end - from;
        let (columns, rows) = (own(columns, self.columns.start), own(rows, self.rows.start));
        let scale = impulse.depth * self.shown.focal_px / impulse.radius_px;
        self.level.within((first, plane.truncate()), &columns, &rows, reach / scale)
    }
}

/// What a kernel is made of before it is added, one after the other in the same place.
struct Scratch {
    /// Its curves along a row and down a column; see `Line::fill`.
    across: [[f32; STRIDE]; 3],
    down: [[f32; STRIDE]; 3],
    /// How much of a row it covers.
    covers: [f32; STRIDE],
}

impl Default for Scratch {
    fn default() -> Scratch {
        Scratch { across: [[0.0; STRIDE]; 3], down: [[0.0; STRIDE]; 3], covers: [0.0; STRIDE] }
    }
}

/// The beginnings of three lines.
#[inline(always)]
fn lines([a, b, c]: &mut [[f32; STRIDE]; 3], count: usize) -> Curves<'_> {
    [&mut a[..count], &mut b[..count], &mut c[..count]]
}

/// Adds a row of a kernel, so much of it as covers each pixel.
#[inline(always)]
fn add_row(
    value: &mut [f32],
    power: &mut [f32],
    (cosines, sines, squares): (&[f32], &[f32], &[f32]),
    (a, b, c): (f32, f32, f32),
    covers: impl Fn(usize) -> f32,
) {
    let cells = value.as_chunks_mut::<LANES>().0.iter_mut().zip(power.as_chunks_mut::<LANES>().0);
    let curves =
        cosines.as_chunks::<LANES>().0.iter().zip(sines.as_chunks::<LANES>().0).zip(squares.as_chunks::<LANES>().0);
    for (lump, ((value, power), ((cosines, sines), squares))) in cells.zip(curves).enumerate() {
        // Copies, so that the compiler sees that none overlaps another.
        let (mut values, mut powers, cosines, sines, squares) = (*value, *power, *cosines, *sines, *squares);
        for k in 0..LANES {
            let cover = covers(lump * LANES + k);
            values[k] += (a * cosines[k] - b * sines[k]) * cover;
            powers[k] += c * squares[k] * (cover * cover);
        }
        (*value, *power) = (values, powers);
    }
}

/// How much each pixel of a row shows of a kernel, by its 1 / depth: less the farther that is from the plane of the kernel, and
/// nothing beyond `reach`. `level` is the slope of 1 / depth of the plane along the row, and its value at the first pixel.
#[inline(always)]
fn near(covers: &mut [f32], inverse: &[f64], level: (f64, f64), (scale, reach): (f64, f64)) {
    let (from, often) = (reach as f32, (1.0 / reach) as f32);
    let lumps = covers.as_chunks_mut::<LANES>().0.iter_mut().zip(inverse.as_chunks::<LANES>().0);
    for (lump, (covers, inverse)) in lumps.enumerate() {
        let first = level.0 * (lump * LANES) as f64 + level.1;
        let (mut own, inverse) = ([0.0; LANES], *inverse);
        for k in 0..LANES {
            let away = ((inverse[k] - (level.0 * k as f64 + first)).abs() * scale) as f32;
            let x = ((away - from) * often).clamp(0.0, 1.0);
            own[k] = 1.0 - x * x * (3.0 - 2.0 * x);
        }
        *covers = own;
    }
}

/// The variance of a sum on average.
pub fn variance(overlap: f64) -> f32 {
    (overlap * INTEGRAL * INTEGRAL / TAU) as f32
}

/// What sums are divided by.
struct Scale {
    variance: f32,
    least: f32,
}

impl Scale {
    fn new(overlap: f64) -> Scale {
        let variance = variance(overlap);
        Scale { variance, least: variance * LEAST }
    }

    /// A noise and its variance by the sums of kernels and of their variances.
    #[inline(always)]
    fn of(&self, sum: f32, power: f32) -> (f32, f32) {
        (sum / power.max(self.least).sqrt(), power / self.variance)
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

/// The pixels of a range whose centers are nearer to a place than a distance.
fn reached(middle: f64, radius: f64, of: &Range<usize>) -> Range<usize> {
    let from = (middle - radius - 0.5).floor() + 1.0;
    let to = (middle + radius - 0.5).ceil();
    let within = |at: f64| at.clamp(of.start as f64, of.end as f64) as usize;
    within(from)..within(to)
}

/// How much of a kernel a pixel shows.
pub fn covers(shown: &InFrame, trim: Trim, impulse: &Impulse, (x, y): (usize, usize)) -> f32 {
    trimmed(shown, trim, impulse, y, x..x + 1).next().unwrap_or(0.0)
}

/// How much of a kernel the pixels of a row show.
fn trimmed(
    shown: &InFrame,
    trim: Trim,
    impulse: &Impulse,
    y: usize,
    columns: Range<usize>,
) -> impl Iterator<Item = f32> {
    let row = y * shown.size_px.0;
    let DVec3 { x: slope, y: down, z: base } = impulse.plane;
    let first = down * (y as f64 + 0.5) + base;
    let scale = impulse.depth * shown.focal_px / impulse.radius_px;
    let [own] = [impulse.of[0]];
    columns.map(move |x| match trim {
        Trim::Object => 1.0,
        Trim::Triangle => f32::from(u8::from(shown.triangle[row + x] == own)),
        Trim::Depth(reach) => {
            let away = (shown.inverse[row + x] - (slope * (x as f64 + 0.5) + first)).abs() * scale;
            (1.0 - smoothstep(reach, 2.0 * reach, away)) as f32
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::maths::{cos, exp, sin};
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

    #[test]
    fn a_kernel_is_its_formula() {
        let (width, height) = (100, 90);
        let (inverse, triangle) = (vec![0.5; width * height], vec![0; width * height]);
        let shown =
            InFrame { size_px: (width, height), focal_px: 100.0, inverse: &inverse, triangle: &triangle, stop: None };
        let own = impulse((61.3, 63.9));
        let found = sum(&shown, &[own], 16.0, Trim::Depth(0.5));
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
        let shown =
            InFrame { size_px: (width, height), focal_px: 100.0, inverse: &inverse, triangle: &triangle, stop: None };
        let found = sum(&shown, &[own], 16.0, Trim::Depth(0.5));
        let all = sum(&shown, &[own], 16.0, Trim::Object);
        for y in 0..height {
            let (left, right) = (y * width + 20, y * width + 35);
            assert_eq!(found.share[left], all.share[left]);
            let expected = if y < 5 { 0.0 } else { 0.25 * all.share[right] };
            assert!((found.share[right] - expected).abs() < 1e-6, "half way between reach and twice it");
        }
    }
}
