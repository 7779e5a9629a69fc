//! The thin-plate spline: r² ln r with an affine part, K c + P a = u with P'c = 0. Three reflections make all but the
//! last three rows of P zero; the rest of the reflected K is positive definite, so that Cholesky's method solves it, in
//! half the time of elimination with pivoting and with the same bits everywhere.

use kurbo::{Point, Vec2};
use rayon::prelude::*;

use super::{Jumps, Method, Run};
use crate::base::cholesky::{Matrix, stride};
use crate::base::maths;
use crate::layers::folding::anchor::Anchor;

/// Anchors closer than this to an earlier one, in pixels, are dropped.
const SAME_PX: f64 = 1e-6;

/// Terms of the affine part: constant, along x, along y.
const AFFINE: usize = 3;

/// A solved plate. Lengths are in units of `scale` about `center`: this does not change the plate, and its equations
/// are well conditioned.
pub struct Plate {
    center: Point,
    scale: f64,
    /// Place and weights (for x and y) of each kernel.
    kernels: Vec<(Vec2, Vec2)>,
    /// The affine part.
    affine: [Vec2; AFFINE],
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
        let kernels = places.into_iter().zip(weights).collect();
        Ok(Plate { center, scale, kernels, affine })
    }
}

impl Method for Plate {
    fn passes_anchors(&self) -> bool {
        false
    }

    /// Evaluates the plate at the places of the run; it has its own copy of the anchors.
    fn run(&self, _anchors: &[Anchor], run: &Run, out: &mut Jumps) {
        let xs = run.xs().map(|x| (x - self.center.x) / self.scale);
        let y = (run.y() - self.center.y) / self.scale;
        for (k, x) in xs.into_iter().enumerate() {
            let flat = self.affine[0] + self.affine[1] * x + self.affine[2] * y;
            (out.x[k], out.y[k]) = (flat.x, flat.y);
        }
        for (at, weight) in &self.kernels {
            let dy = y - at.y;
            for (k, x) in xs.into_iter().enumerate() {
                let dx = x - at.x;
                let u = kernel(dx * dx + dy * dy);
                out.x[k] += weight.x * u;
                out.y[k] += weight.y * u;
            }
        }
    }
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
