//! The thin-plate spline: r² ln r with an affine part, K c + P a = u with P'c = 0. Three reflections make all but the
//! last three rows of P zero; the rest of the reflected K is positive definite, so that Cholesky's method solves it, in
//! half the time of elimination with pivoting and with the same bits everywhere.

use kurbo::{Point, Vec2};
use rayon::prelude::*;

use super::chebyshev::Chebyshev;
use super::kernel::{Apart, Fate, GAPS, Kernel, TOLERANCE_PX};
use crate::base::cholesky::{Matrix, stride};
use crate::base::maths;
use crate::layers::folding::anchor::Anchor;

/// Anchors closer than this to an earlier one, in pixels, are dropped.
const SAME_PX: f64 = 1e-6;

/// The share of [`TOLERANCE_PX`] that interpolated kernels may take.
const SHARE: f64 = 0.25;

/// Terms of the affine part: constant, along x, along y.
const AFFINE: usize = 3;

/// A solved plate. Lengths are in units of `scale` about `center`: this does not change the plate, and its equations
/// are well conditioned.
pub struct Plate {
    center: Point,
    scale: f64,
    /// The weights of the anchors' kernels, for x and y.
    weights: Vec<Vec2>,
    /// The affine part.
    affine: [Vec2; AFFINE],
    /// The square of one pixel, in squares of `scale`.
    shrink: f64,
    /// Where kernels may be interpolated.
    reaches: Vec<Reach>,
}

/// Kernels are interpolated in cells of at most this size that are this far away.
struct Reach {
    /// The square of the gap in half sides of the cell.
    gap2: f64,
    /// The largest square of half the side of the cell, in pixels.
    half2: f64,
}

/// Bytes that solving a plate through `count` anchors takes.
pub fn bytes(count: u64) -> u64 {
    count.saturating_mul(count.saturating_add(6)).saturating_mul(size_of::<f64>() as u64)
}

/// Why there is no plate.
#[derive(Debug, PartialEq, Eq)]
pub enum NoPlate {
    /// Fewer than three anchors, or all on one line.
    Flat,
    /// The synthesis was cancelled.
    Stopped,
}

impl Plate {
    /// Solves for the plate through [`distinct`] anchors, unless `stopped` becomes true.
    ///
    /// # Errors
    /// If there is no plate.
    pub fn solve(anchors: &[Anchor], smoothing: f64, stopped: &(impl Fn() -> bool + Sync)) -> Result<Self, NoPlate> {
        let n = anchors.len();
        let sum = anchors.iter().fold(Vec2::ZERO, |sum, anchor| sum + anchor.at.to_vec2());
        let center = (sum / n.max(1) as f64).to_point();
        let scale = anchors.iter().map(|a| (a.at - center).hypot2()).fold(0.0, f64::max).sqrt();
        let places: Vec<Vec2> = anchors.iter().map(|a| (a.at - center) / scale).collect();
        if n < AFFINE || on_one_line(&places) {
            return Err(NoPlate::Flat);
        }
        let mut equations =
            equations(anchors, &places, smoothing / (scale * scale), stopped).ok_or(NoPlate::Stopped)?;
        let reflections = Reflections::of(&places);
        reflections.apply(&mut equations, n);
        let bent = n - AFFINE;
        equations.factor(bent, stopped).ok_or(NoPlate::Stopped)?;
        let mut weights = vec![Vec2::ZERO; n];
        let mut affine = [Vec2::ZERO; AFFINE];
        for (column, part) in [(n, Vec2::new(1.0, 0.0)), (n + 1, Vec2::new(0.0, 1.0))] {
            let mut solved = equations.solve(bent, column);
            // The rows below are still unfactored: they determine the affine part.
            let below = equations.cells[bent * equations.stride..].chunks_exact(equations.stride);
            let rest: Vec<f64> = below
                .map(|row| solved.iter().zip(row).fold(row[column], |rest, (weight, cell)| rest - weight * cell))
                .collect();
            let terms = reflections.affine(&rest);
            solved.resize(n, 0.0);
            reflections.turn_back(&mut solved);
            weights.iter_mut().zip(&solved).for_each(|(weight, x)| *weight += part * *x);
            affine.iter_mut().zip(terms).for_each(|(affine, term)| *affine += part * term);
        }
        let reaches = reaches(&weights, scale);
        Ok(Plate { center, scale, weights, affine, shrink: 1.0 / (scale * scale), reaches })
    }
}

impl Plate {
    /// What is summed for anchor `index`.
    pub fn terms(&self, index: usize) -> [f64; 2] {
        let weight = self.weights[index];
        [weight.x, weight.y]
    }
}

impl Kernel<2> for Plate {
    const PASSES_ANCHORS: bool = false;

    #[inline(always)]
    fn weight(&self, d2: f64) -> f64 {
        kernel(d2 * self.shrink)
    }

    fn fate(&self, apart: &Apart) -> Fate {
        let near_enough = |reach: &Reach| apart.half2 <= reach.half2 && apart.nearest2 >= reach.gap2 * apart.half2;
        if self.reaches.iter().any(near_enough) { Fate::Far } else { Fate::Near }
    }

    #[inline(always)]
    fn jumps<const N: usize>(&self, sums: &[[f64; N]; 2], xs: &[f64; N], y: f64) -> [[f64; N]; 2] {
        let mut jumps = *sums;
        let y = (y - self.center.y) / self.scale;
        for (k, x) in xs.iter().enumerate() {
            let x = (x - self.center.x) / self.scale;
            jumps[0][k] += self.affine[0].x + self.affine[1].x * x + self.affine[2].x * y;
            jumps[1][k] += self.affine[0].y + self.affine[1].y * x + self.affine[2].y * y;
        }
        jumps
    }
}

/// For each gap the cells in which the errors of all kernels together are within the tolerance. In a cell of half side h
/// a kernel is h² times that in one of half side 1, but for a multiple of r², which is interpolated exactly: so are errors.
fn reaches(weights: &[Vec2], scale: f64) -> Vec<Reach> {
    let chebyshev = Chebyshev::new();
    let all: f64 = weights.iter().map(|weight| weight.hypot2().sqrt()).sum();
    let reach = |gap: f64| {
        let error = chebyshev.error(gap, kernel, |_| 1.0);
        Reach { gap2: gap * gap, half2: SHARE * TOLERANCE_PX * scale * scale / (error * all) }
    };
    GAPS.into_iter().map(reach).collect()
}

/// K with the smoothing on its diagonal, and the x and y of the jump vectors as columns beside it.
fn equations(
    anchors: &[Anchor],
    places: &[Vec2],
    smoothing: f64,
    stopped: &(impl Fn() -> bool + Sync),
) -> Option<Matrix> {
    let n = places.len();
    let mut equations = Matrix::new(n, n + 2);
    let fill = |(i, row): (usize, &mut [f64])| {
        if stopped() {
            return None;
        }
        for (j, cell) in row[..n].iter_mut().enumerate() {
            // Both differences of a pair are taken in the same order, so that both halves have the same bits.
            let apart = if i < j { places[i] - places[j] } else { places[j] - places[i] };
            *cell = if i == j { smoothing } else { kernel(apart.hypot2()) };
        }
        (row[n], row[n + 1]) = (anchors[i].jump.x, anchors[i].jump.y);
        Some(())
    };
    equations.cells.par_chunks_mut(stride(n + 2)).enumerate().map(fill).collect::<Option<()>>()?;
    Some(equations)
}

/// Three Householder reflections; the first one ends at the last row, the next ones each a row above.
struct Reflections {
    /// The normals v, each with 2 / v'v.
    mirrors: [(Vec<f64>, f64); AFFINE],
    /// The last rows of the reflected P: term by term, row by row.
    ends: [[f64; AFFINE]; AFFINE],
}

impl Reflections {
    fn of(places: &[Vec2]) -> Self {
        let n = places.len();
        let mut terms: [Vec<f64>; AFFINE] =
            std::array::from_fn(|k| places.iter().map(|place| [1.0, place.x, place.y][k]).collect());
        let mirrors = std::array::from_fn(|k| {
            let end = n - 1 - k;
            let mut normal = terms[k].clone();
            normal[end + 1..].fill(0.0);
            let length = dot(&normal, &normal).sqrt();
            normal[end] += if normal[end] < 0.0 { -length } else { length };
            let squared = dot(&normal, &normal);
            let factor = if squared > 0.0 { 2.0 / squared } else { 0.0 };
            terms.iter_mut().for_each(|term| reflect(term, &normal, factor));
            (normal, factor)
        });
        let ends = std::array::from_fn(|k| std::array::from_fn(|row| terms[k][n - AFFINE + row]));
        Reflections { mirrors, ends }
    }

    /// Replaces K with Q'KQ, and the two columns beside it with Q' times them.
    fn apply(&self, equations: &mut Matrix, n: usize) {
        let stride = equations.stride;
        for (normal, factor) in &self.mirrors {
            let cells = &mut equations.cells;
            let through: Vec<f64> = cells.par_chunks(stride).map(|row| factor * dot(&row[..n], normal)).collect();
            let half = factor / 2.0 * dot(&through, normal);
            let sheared: Vec<f64> = through.iter().zip(normal).map(|(through, v)| through - half * v).collect();
            let beside = [n, n + 1].map(|column| {
                let sum = cells.chunks_exact(stride).zip(normal).fold(0.0, |sum, (row, v)| sum + row[column] * v);
                factor * sum
            });
            cells.par_chunks_mut(stride).enumerate().for_each(|(i, row)| {
                let (v, q) = (normal[i], sheared[i]);
                for (cell, (other_v, other_q)) in row[..n].iter_mut().zip(normal.iter().zip(&sheared)) {
                    *cell -= v * other_q + q * other_v;
                }
                row[n] -= v * beside[0];
                row[n + 1] -= v * beside[1];
            });
        }
    }

    /// Q times the weights.
    fn turn_back(&self, weights: &mut [f64]) {
        self.mirrors.iter().rev().for_each(|(normal, factor)| reflect(weights, normal, *factor));
    }

    /// The affine part, from its product `rest` with the last rows of the reflected P. Term k of those is 0 above row 2
    /// - k.
    fn affine(&self, rest: &[f64]) -> [f64; AFFINE] {
        let mut terms = [0.0; AFFINE];
        for k in (0..AFFINE).rev() {
            let row = AFFINE - 1 - k;
            let known = (k + 1..AFFINE).fold(rest[row], |left, other| left - self.ends[other][row] * terms[other]);
            terms[k] = known / self.ends[k][row];
        }
        terms
    }
}

fn reflect(numbers: &mut [f64], normal: &[f64], factor: f64) {
    let along = factor * dot(numbers, normal);
    numbers.iter_mut().zip(normal).for_each(|(number, v)| *number -= along * v);
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b)
}

/// r² ln r as a function of r²; 0 at 0.
#[inline(always)]
fn kernel(r2: f64) -> f64 {
    0.5 * r2 * maths::ln_in_loops(r2)
}

/// The anchors without those that are at an earlier one.
pub fn distinct(anchors: &[Anchor]) -> Vec<Anchor> {
    let mut kept: Vec<Anchor> = Vec::with_capacity(anchors.len());
    for anchor in anchors {
        if kept.iter().all(|other| (other.at - anchor.at).hypot2() >= SAME_PX * SAME_PX) {
            kept.push(*anchor);
        }
    }
    kept
}

/// Whether all places are on one line, to within a billionth of their spread.
fn on_one_line(places: &[Vec2]) -> bool {
    let Some(&first) = places.first() else { return true };
    let from_first = || places.iter().map(|place| *place - first);
    let Some(farthest) = from_first().max_by(|a, b| a.hypot2().total_cmp(&b.hypot2())) else { return true };
    from_first().all(|place| place.cross(farthest).abs() < 1e-9)
}
