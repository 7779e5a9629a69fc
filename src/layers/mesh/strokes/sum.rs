//! The sum of all kernels: tile by tile, in the order of the impulses, so that the bits do not depend on threads.

use std::ops::Range;
use std::sync::atomic::AtomicBool;

use glam::DVec3;
use rayon::prelude::*;

use super::impulse::Impulse;
use super::synth::is_set;
use crate::base::maths::{TAU, cos, exp, sin, smoothstep};

/// The side of a tile, in pixels.
const TILE: usize = 64;
/// e to the minus pi: what a kernel's curve has at its edge.
pub const EDGE: f64 = 0.043_213_918_263_772_25;
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
pub struct Shown<'a> {
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
pub fn sum(shown: &Shown, impulses: &[Impulse], overlap: f64, trim: Trim) -> Noise {
    let (width, height) = shown.size_px;
    let across = width.div_ceil(TILE).max(1);
    let bins = bins(shown.size_px, impulses);
    let tiles: Vec<Option<Tile>> = bins
        .into_par_iter()
        .enumerate()
        .map(|(i, bin)| {
            let (x, y) = (i % across * TILE, i / across * TILE);
            let columns = x..(x + TILE).min(width);
            Tile::new(shown, columns, y..(y + TILE).min(height), trim).map(|mut tile| {
                let wanted = bin.iter().take_while(|_| !is_set(shown.stop));
                wanted.for_each(|&k| tile.add(&impulses[k as usize]));
                tile
            })
        })
        .collect();
    let mut sums = vec![[0.0; 2]; width * height];
    for tile in tiles.into_iter().flatten() {
        let across = tile.columns.len();
        for (y, cells) in tile.rows.clone().zip((0..).step_by(across)) {
            let row = &mut sums[y * width + tile.columns.start..y * width + tile.columns.end];
            let own = tile.value[cells..].iter().zip(&tile.power[cells..]);
            row.iter_mut().zip(own).for_each(|(sum, (value, power))| *sum = [*value, *power]);
        }
    }
    normalized(shown, &sums, overlap)
}

/// The impulses that may reach each tile, in order.
fn bins((width, height): (usize, usize), impulses: &[Impulse]) -> Vec<Vec<u32>> {
    let (across, down) = (width.div_ceil(TILE).max(1), height.div_ceil(TILE).max(1));
    let mut bins = vec![Vec::new(); across * down];
    for (i, impulse) in impulses.iter().enumerate() {
        let tiles = |middle: f64, most: usize| {
            let tile = |at: f64| (at / TILE as f64).floor().clamp(0.0, most as f64) as usize;
            tile(middle - impulse.radius_px)..tile(middle + impulse.radius_px + TILE as f64).min(most)
        };
        for y in tiles(impulse.at.y, down) {
            tiles(impulse.at.x, across).for_each(|x| bins[y * across + x].push(i as u32));
        }
    }
    bins
}

/// Some columns of some rows.
struct Tile<'a> {
    shown: &'a Shown<'a>,
    columns: Range<usize>,
    rows: Range<usize>,
    trim: Trim,
    /// The least and the greatest 1 / depth of the layer's pixels.
    inverse: [f64; 2],
    value: Vec<f32>,
    power: Vec<f32>,
    /// A kernel's curve, with its wave's cosine and sine, and squared, in each column.
    curves: [Vec<f32>; 3],
}

impl<'a> Tile<'a> {
    /// `None` if the layer is not seen in it.
    fn new(shown: &'a Shown<'a>, columns: Range<usize>, rows: Range<usize>, trim: Trim) -> Option<Tile<'a>> {
        let width = shown.size_px.0;
        let mut inverse = [f64::INFINITY, f64::NEG_INFINITY];
        for y in rows.clone() {
            for i in y * width + columns.start..y * width + columns.end {
                if shown.triangle[i] != u32::MAX {
                    inverse = [inverse[0].min(shown.inverse[i]), inverse[1].max(shown.inverse[i])];
                }
            }
        }
        let cells = columns.len() * rows.len();
        (inverse[0] <= inverse[1]).then(|| Tile {
            shown,
            columns,
            rows,
            trim,
            inverse,
            value: vec![0.0; cells],
            power: vec![0.0; cells],
            curves: [Vec::new(), Vec::new(), Vec::new()],
        })
    }

    fn add(&mut self, impulse: &Impulse) {
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
        let wave = TAU / impulse.spacing_px;
        let (along, down) = (-wave * sin(impulse.angle), wave * cos(impulse.angle));
        self.curve(impulse, along, &columns);
        let mut curve = Curve::new(rows.start as f64 + 0.5 - impulse.at.y, impulse.radius_px);
        let mut turn = Turn::new(down * (rows.start as f64 + 0.5 - impulse.at.y) + impulse.phase, down);
        let width = self.columns.len();
        for y in rows {
            let (curve, (cosine, sine)) = (curve.next(), turn.next());
            let weight = impulse.factor * curve;
            let first = (y - self.rows.start) * width + columns.start - self.columns.start;
            let cells = first..first + columns.len();
            let [cosines, sines, squares] = &self.curves;
            let (a, b, c) = ((weight * cosine) as f32, (weight * sine) as f32, (weight * weight / 2.0) as f32);
            let value = self.value[cells.clone()].iter_mut().zip(&mut self.power[cells]);
            let curves = cosines.iter().zip(sines).zip(squares);
            if whole {
                value.zip(curves).for_each(|((value, power), ((cosine, sine), square))| {
                    *value += a * cosine - b * sine;
                    *power += c * square;
                });
            } else {
                let trimmed = trimmed(self.shown, self.trim, impulse, y, columns.clone());
                value.zip(curves).zip(trimmed).for_each(|(((value, power), ((cosine, sine), square)), trimmed)| {
                    *value += (a * cosine - b * sine) * trimmed;
                    *power += c * square * trimmed * trimmed;
                });
            }
        }
    }

    /// The kernel's curve in these columns: with the cosine and the sine of its wave, and squared.
    fn curve(&mut self, impulse: &Impulse, along: f64, columns: &Range<usize>) {
        let first = columns.start as f64 + 0.5 - impulse.at.x;
        let (mut curve, mut turn) = (Curve::new(first, impulse.radius_px), Turn::new(along * first, along));
        self.curves.iter_mut().for_each(Vec::clear);
        let [cosines, sines, squares] = &mut self.curves;
        for _ in columns.clone() {
            let (curve, (cosine, sine)) = (curve.next(), turn.next());
            cosines.push((curve * cosine) as f32);
            sines.push((curve * sine) as f32);
            squares.push((curve * curve) as f32);
        }
    }

    /// Whether all of the layer here is within the reach of a kernel, or none of it; `None` if that differs.
    fn all(&self, impulse: &Impulse, reach: f64, columns: &Range<usize>, rows: &Range<usize>) -> Option<bool> {
        let plane = impulse.plane;
        let [x, y] = [columns, rows].map(|range| [range.start as f64 + 0.5, range.end as f64 - 0.5]);
        let ends =
            |factor: f64, [from, to]: [f64; 2]| [(factor * from).min(factor * to), (factor * from).max(factor * to)];
        let (across, down) = (ends(plane.x, x), ends(plane.y, y));
        let (low, high) = (across[0] + down[0] + plane.z, across[1] + down[1] + plane.z);
        let scale = impulse.depth * self.shown.focal_px / impulse.radius_px;
        let [least, most] = self.inverse;
        let farthest = (most - low).max(high - least) * scale;
        let nearest = (least - high).max(low - most) * scale;
        match () {
            () if farthest <= reach => Some(true),
            () if nearest >= 2.0 * reach => Some(false),
            () => None,
        }
    }
}

/// A noise by its sums: of kernels, and of their variances.
pub fn normalized(shown: &Shown, sums: &[[f32; 2]], overlap: f64) -> Noise {
    let variance = (overlap * INTEGRAL * INTEGRAL / TAU) as f32;
    let least = variance * LEAST;
    let own = |i: usize| shown.triangle[i] != u32::MAX;
    let (value, share) = sums
        .par_iter()
        .enumerate()
        .map(|(i, [sum, power])| if own(i) { (sum / power.max(least).sqrt(), power / variance) } else { (0.0, 0.0) })
        .unzip();
    Noise { value, share }
}

/// The pixels of a range whose centres are nearer to a place than a distance.
fn reached(middle: f64, radius: f64, of: &Range<usize>) -> Range<usize> {
    let from = (middle - radius - 0.5).floor() + 1.0;
    let to = (middle + radius - 0.5).ceil();
    let within = |at: f64| at.clamp(of.start as f64, of.end as f64) as usize;
    within(from)..within(to)
}

/// How much of a kernel a pixel shows.
pub fn covers(shown: &Shown, trim: Trim, impulse: &Impulse, (x, y): (usize, usize)) -> f32 {
    trimmed(shown, trim, impulse, y, x..x + 1).next().unwrap_or(0.0)
}

/// How much of a kernel the pixels of a row show.
fn trimmed(shown: &Shown, trim: Trim, impulse: &Impulse, y: usize, columns: Range<usize>) -> impl Iterator<Item = f32> {
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

/// A kernel's curve in steps of a pixel: each value follows from the one before by multiplication.
struct Curve {
    bell: f64,
    ratio: f64,
    change: f64,
}

impl Curve {
    fn new(first: f64, radius: f64) -> Curve {
        let steep = std::f64::consts::PI / (radius * radius);
        Curve { bell: exp(-steep * first * first), ratio: exp(-steep * (2.0 * first + 1.0)), change: exp(-2.0 * steep) }
    }

    #[inline]
    fn next(&mut self) -> f64 {
        let value = (self.bell - EDGE) / (1.0 - EDGE);
        self.bell *= self.ratio;
        self.ratio *= self.change;
        value
    }
}

/// The cosine and the sine of an angle that grows in equal steps.
struct Turn {
    now: (f64, f64),
    step: (f64, f64),
}

impl Turn {
    fn new(first: f64, step: f64) -> Turn {
        Turn { now: (cos(first), sin(first)), step: (cos(step), sin(step)) }
    }

    #[inline]
    fn next(&mut self) -> (f64, f64) {
        let (now, (c, s)) = (self.now, self.step);
        self.now = (now.0 * c - now.1 * s, now.1 * c + now.0 * s);
        now
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;

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
            Shown { size_px: (width, height), focal_px: 100.0, inverse: &inverse, triangle: &triangle, stop: None };
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
            Shown { size_px: (width, height), focal_px: 100.0, inverse: &inverse, triangle: &triangle, stop: None };
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
