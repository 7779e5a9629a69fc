//! The thin-plate spline: r² ln r with an affine part. The equations are solved by faer, whose sums may differ in the
//! last bits from one kind of processor to the next (tests/interpolation holds them to 1e-6 px of the anchors).

use faer::{Mat, linalg::solvers::Solve};
use kurbo::{Point, Vec2};

use super::{Jumps, Run};
use crate::base::maths;
use crate::layers::folding::anchors::Anchor;

/// Anchors nearer than this to an earlier one are dropped, in pixels.
const SAME_PX: f64 = 1e-6;

/// A solved plate. Lengths are in units of `scale` about `center`, which leaves the plate as it is and its equations
/// well conditioned.
pub struct Plate {
    center: Point,
    scale: f64,
    /// Place and weights (for x and y) of each kernel.
    kernels: Vec<(Vec2, Vec2)>,
    /// The affine part: constant, along x, along y.
    affine: [Vec2; 3],
}

impl Plate {
    /// Solves for the plate through [`distinct`] anchors; none with fewer than three, or all on one line.
    pub fn solve(anchors: &[Anchor], smoothing: f64) -> Option<Self> {
        let n = anchors.len();
        let sum = anchors.iter().fold(Vec2::ZERO, |sum, anchor| sum + anchor.at.to_vec2());
        let center = (sum / n.max(1) as f64).to_point();
        let scale = anchors.iter().map(|a| (a.at - center).hypot2()).fold(0.0, f64::max).sqrt();
        let places: Vec<Vec2> = anchors.iter().map(|a| (a.at - center) / scale).collect();
        if n < 3 || on_one_line(&places) {
            return None;
        }
        let smoothing = smoothing / (scale * scale);
        let equations = Mat::from_fn(n + 3, n + 3, |row, column| match (row < n, column < n) {
            (true, true) if row == column => smoothing,
            (true, true) => kernel((places[row] - places[column]).hypot2()),
            (true, false) => affine_term(places[row], column - n),
            (false, true) => affine_term(places[column], row - n),
            (false, false) => 0.0,
        });
        let given = Mat::from_fn(n + 3, 2, |row, column| match anchors.get(row) {
            Some(anchor) if column == 0 => anchor.jump.x,
            Some(anchor) => anchor.jump.y,
            None => 0.0,
        });
        let solved = equations.partial_piv_lu().solve(&given);
        let weight = |row: usize| Vec2::new(solved[(row, 0)], solved[(row, 1)]);
        let kernels = places.iter().enumerate().map(|(i, place)| (*place, weight(i))).collect();
        Some(Plate { center, scale, kernels, affine: [weight(n), weight(n + 1), weight(n + 2)] })
    }

    /// The plate at the places of the run.
    pub fn run(&self, run: &Run, out: &mut Jumps) {
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

/// r² ln r of r²; 0 at 0.
#[inline(always)]
fn kernel(r2: f64) -> f64 {
    0.5 * r2 * maths::ln_in_loops(r2)
}

fn affine_term(place: Vec2, i: usize) -> f64 {
    [1.0, place.x, place.y][i]
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

/// Whether all places lie on one line, to a billionth of their spread.
fn on_one_line(places: &[Vec2]) -> bool {
    let Some(&first) = places.first() else { return true };
    let from_first = || places.iter().map(|place| *place - first);
    let Some(farthest) = from_first().max_by(|a, b| a.hypot2().total_cmp(&b.hypot2())) else { return true };
    from_first().all(|place| place.cross(farthest).abs() < 1e-9)
}
