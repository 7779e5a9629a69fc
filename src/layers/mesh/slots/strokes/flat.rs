//! Impulses drawn on the surface itself, of a fixed size there: a texture. They shrink and lean with it.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::aim::Aim;
use super::curves::EDGE;
use super::impulse::{Dice, MOST, Recipe, factor};
use super::shown::InFrame;
use super::sum::{Noise, normalized};
use super::surface::{Facet, Surface, mixed};
use super::synth::is_set;
use crate::base::maths::{TAU, cos, exp, sin, smoothstep};
use crate::layers::space::eye::NEAR_M;

/// An impulse on the surface.
pub struct Flat {
    /// Where it is, in camera coordinates.
    pub at: DVec3,
    /// The directions along its stroke and across it, and the normal of its plane.
    pub axes: [DVec3; 3],
    /// How much it counts.
    pub factor: f64,
    /// The phase of its wave, in radians.
    pub phase: f64,
    /// The pixels that it may cover: columns and rows, and the ones after them.
    pub from: (usize, usize),
    /// See `from`.
    pub to: (usize, usize),
}

/// The sum of all impulses, `px_per_m` pixels of the frame being a meter of the surface. `reach` is how far a kernel goes
/// beyond its plane, in radii.
pub fn sum(surface: &Surface, shown: &InFrame, recipe: &Recipe, aim: &Aim, px_per_m: f64, reach: f64) -> Noise {
    let (width, height) = shown.size_px;
    let flats = flats(surface, recipe, aim, (px_per_m, reach));
    let mut rows: Vec<Vec<u32>> = vec![Vec::new(); height];
    for (i, flat) in flats.iter().enumerate() {
        rows[flat.from.1..flat.to.1].iter_mut().for_each(|row| row.push(i as u32));
    }
    let sums = rows.into_par_iter().enumerate().map(|(y, of_row)| {
        let mut sums = vec![[0.0; 2]; width];
        for flat in of_row.into_iter().map(|i| &flats[i as usize]).take_while(|_| !is_set(shown.stop)) {
            for (x, sum) in (flat.from.0..).zip(&mut sums[flat.from.0..flat.to.0]) {
                let i = y * width + x;
                if shown.triangle[i] == u32::MAX {
                    continue;
                }
                let ray = surface.eye.ray(DVec2::new(x as f64 + 0.5, y as f64 + 0.5));
                let [n, p] = kernel(flat, recipe, ray / shown.inverse[i] - flat.at, px_per_m, reach);
                *sum = [sum[0] + n as f32, sum[1] + p as f32];
            }
        }
        sums
    });
    let sums: Vec<[f32; 2]> = sums.flatten_iter().collect();
    normalized(shown, &sums, recipe.overlap)
}

/// What a kernel adds at a place relative to it: to the noise, and to its variance.
fn kernel(flat: &Flat, recipe: &Recipe, away: DVec3, px_per_m: f64, reach: f64) -> [f64; 2] {
    let radius = recipe.radius_px;
    let [along, across, off] = flat.axes.map(|axis| away.dot(axis) * px_per_m);
    if along.abs() >= radius || across.abs() >= radius {
        return [0.0; 2];
    }
    let curve = |d: f64| (exp(-std::f64::consts::PI * (d / radius) * (d / radius)) - EDGE) / (1.0 - EDGE);
    let trimmed = 1.0 - smoothstep(reach, 2.0 * reach, off.abs() / radius);
    let weight = flat.factor * trimmed * curve(along) * curve(across);
    [weight * cos(TAU / recipe.spacing_px * across + flat.phase), weight * weight / 2.0]
}

/// The impulses that may cover a pixel of the frame; see [`sum`].
pub fn flats(surface: &Surface, recipe: &Recipe, aim: &Aim, (px_per_m, reach): (f64, f64)) -> Vec<Flat> {
    let halves = [1.0, 1.0, 2.0 * reach].map(|radii| radii * recipe.radius_px / px_per_m);
    let count = surface.mesh.triangles.len() as u32;
    let density = recipe.density(1.0);
    let mut found = Vec::new();
    let mut facet: Option<(u32, Option<(Facet, f64)>)> = None;
    surface.pieces.of(0..count, |piece| {
        if is_set(surface.stop) {
            return;
        }
        if facet.as_ref().is_none_or(|(of, _)| *of != piece.triangle) {
            let own = surface.any_facet(piece.triangle).map(|own| {
                let [a, b, c] = own.corners;
                (own, (b - a).cross(c - a).length() / 2.0)
            });
            facet = Some((piece.triangle, own));
        }
        let Some((_, Some((facet, area)))) = &facet else { return };
        let wanted = density * px_per_m * px_per_m * area * piece.share;
        Dice::each([facet.triangle, piece.number], recipe, wanted.min(MOST), |dice| {
            let factor = factor(wanted, dice.rank);
            if factor <= 0.0 {
                return;
            }
            let weights = dice.weights(piece);
            let at = mixed(facet.corners, weights);
            let axes = axes(surface, facet, aim, weights, dice.spread);
            if let Some([from, to]) = pixels(surface, at, axes, halves) {
                found.push(Flat { at, axes, factor, phase: dice.phase, from, to });
            }
        });
    });
    found
}

/// The directions along a stroke and across it in the plane of the triangle, and the normal of that.
fn axes(surface: &Surface, facet: &Facet, aim: &Aim, weights: DVec3, spread: f64) -> [DVec3; 3] {
    let [a, b, c] = facet.corners;
    // A texture does not change where a triangle turns away.
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let way = aim.way(surface, facet, weights, normal);
    // Clockwise about the normal, as on the screen.
    let turn = -spread;
    let along = way * cos(turn) + normal.cross(way) * sin(turn);
    [along, along.cross(normal), normal]
}

/// The pixels that a kernel of these half sides along its axes may cover; `None` if there are none.
fn pixels(surface: &Surface, at: DVec3, axes: [DVec3; 3], halves: [f64; 3]) -> Option<[(usize, usize); 2]> {
    let (width, height) = surface.size_px;
    let sides = [0, 1, 2].map(|k| axes[k] * halves[k]);
    let side = |bits: usize, k: usize| if bits >> k & 1 == 0 { sides[k] } else { -sides[k] };
    let corners: [DVec3; 8] = std::array::from_fn(|bits| at + side(bits, 0) + side(bits, 1) + side(bits, 2));
    let near = corners.iter().filter(|corner| -corner.z < NEAR_M).count();
    if near > 0 {
        return (near < corners.len()).then_some([(0, 0), (width, height)]);
    }
    let seen = corners.map(|corner| surface.eye.project(corner));
    let low = seen.into_iter().fold(seen[0], DVec2::min).floor().max(DVec2::ZERO);
    let high = seen.into_iter().fold(seen[0], DVec2::max).ceil().min(DVec2::new(width as f64, height as f64));
    let (from, to) = ((low.x as usize, low.y as usize), (high.x.max(0.0) as usize, high.y.max(0.0) as usize));
    (from.0 < to.0 && from.1 < to.1).then_some([from, to])
}
