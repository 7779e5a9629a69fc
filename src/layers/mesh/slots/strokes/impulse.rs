//! The impulses of a noise in one frame: the points that kernels are centered on. Each is fixed to its place on the surface;
//! how much it counts depends on how large the surface is seen there, so that as many are over every pixel.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::aim::Aim;
use super::pieces::Piece;
use super::surface::{Facet, Surface, mixed};
use super::synth::is_set;
use crate::base::maths::TAU;
use crate::base::random::{pcg4d, unit};
use crate::layers::space::eye::NEAR_M;

/// 2 - 2 ln 2: with it the factors' squares add up to the number of impulses that is wanted.
pub const FADE: f64 = 2.0 - 2.0 * std::f64::consts::LN_2;
/// At most so many impulses of one piece; beyond that each counts for several.
pub const MOST: f64 = 16_384.0 * FADE;
/// What tells the second random numbers of an impulse from the first.
const SECOND: u32 = 0x8000_0000;
/// Triangles are looked at in so many lumps, for all cores, but in no more than these at once.
const LUMPS: u32 = 64;
const LUMP: u32 = 1024;

/// What the impulses of a noise are made by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recipe {
    /// What its random numbers are drawn with.
    pub key: u32,
    /// The mean distance of strokes, in pixels.
    pub spacing_px: f64,
    /// The radius of a kernel, in pixels.
    pub radius_px: f64,
    /// How many kernels are over a pixel.
    pub overlap: f64,
    /// How far directions vary either way, in radians.
    pub spread: f64,
}

impl Recipe {
    /// The key of a noise: of the seed of the strokes, the number of the drawing, and the seed of the noise.
    pub fn key(strokes: u32, drawing: u32, noise: u32) -> u32 {
        let one = strokes.wrapping_add(drawing).wrapping_mul(0x9E37_79B9);
        one.wrapping_add(noise.wrapping_mul(0x85EB_CA6B))
    }

    /// Impulses for each square pixel, where kernels are `larger` times as large.
    pub fn density(&self, larger: f64) -> f64 {
        let radius = self.radius_px * larger;
        self.overlap / (std::f64::consts::PI * radius * radius)
    }
}

/// One impulse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impulse {
    /// Its triangle, its piece, and its number there.
    pub of: [u32; 3],
    /// Its place in the frame, in pixels.
    pub at: DVec2,
    /// How far away it is, in meters.
    pub depth: f64,
    /// How much it counts.
    pub factor: f64,
    /// The phase of its wave, in radians.
    pub phase: f64,
    /// The direction of its stroke, clockwise from +x, in radians.
    pub angle: f64,
    /// How sure its direction is, from 0 to 1.
    pub sure: f64,
    /// The radius of its kernel, in pixels.
    pub radius_px: f64,
    /// The spacing of its strokes, in pixels.
    pub spacing_px: f64,
    /// 1 / the depth of its triangle's plane at a pixel (x, y): x times the first, y times the second, plus the third.
    pub plane: DVec3,
}

/// All impulses of a noise that may be seen in the frame: by triangle, piece and number.
pub fn impulses(surface: &Surface, recipe: &Recipe, aim: &Aim) -> Vec<Impulse> {
    let count = surface.mesh.triangles.len() as u32;
    let size = count.div_ceil(LUMPS).clamp(1, LUMP);
    let lumps: Vec<Vec<Impulse>> = (0..count.div_ceil(size))
        .into_par_iter()
        .map(|lump| {
            let mut found = Vec::new();
            let mut facet: Option<(u32, Option<(Facet, DVec3)>)> = None;
            surface.pieces.of(lump * size..((lump + 1) * size).min(count), |piece| {
                if is_set(surface.stop) {
                    return;
                }
                if facet.as_ref().is_none_or(|(of, _)| *of != piece.triangle) {
                    let own = surface.facet(piece.triangle).map(|facet| (facet, surface.plane(&facet)));
                    facet = Some((piece.triangle, own));
                }
                if let Some((_, Some((facet, plane)))) = &facet {
                    of_piece(surface, recipe, aim, (facet, *plane), piece, &mut found);
                }
            });
            found
        })
        .collect();
    lumps.concat()
}

/// The random numbers of one impulse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dice {
    /// Its triangle, its piece, and its number there.
    pub of: [u32; 3],
    /// Where it is, in two numbers from 0 to 1.
    pub place: [f64; 2],
    /// The phase of its wave, in radians.
    pub phase: f64,
    /// It is there once so many are wanted: above its number, and at most 1 above.
    pub rank: f64,
}

impl Dice {
    /// Those of an impulse.
    #[inline]
    pub fn of(of: [u32; 3], key: u32) -> Dice {
        let bits = pcg4d([of[0], of[1], of[2], key]);
        let [x, y, phase, _] = bits.map(unit);
        let rank = f64::from(of[2]) + f64::from((bits[3] >> 8) + 1) / f64::from(1_u32 << 24);
        Dice { of, place: [x, y], phase: TAU * phase, rank }
    }

    /// How far its stroke is turned clockwise from its direction, in radians.
    pub fn spread(&self, recipe: &Recipe) -> f64 {
        let [a, b, c] = self.of;
        recipe.spread * (2.0 * unit(pcg4d([a, b, c, recipe.key ^ SECOND])[0]) - 1.0)
    }

    /// Its place in a piece of a triangle, as weights of the triangle's corners.
    pub fn weights(&self, piece: &Piece) -> DVec3 {
        let [x, y] = self.place;
        let along = x.sqrt();
        let within = DVec3::new(1.0 - along, along * (1.0 - y), along * y);
        mixed(piece.corners, within)
    }
}

fn of_piece(
    surface: &Surface,
    recipe: &Recipe,
    aim: &Aim,
    (facet, plane): (&Facet, DVec3),
    piece: &Piece,
    found: &mut Vec<Impulse>,
) {
    let eye = &surface.eye;
    let corners = piece.corners.map(|weights| mixed(facet.corners, weights));
    let near = corners.map(|corner| -corner.z < NEAR_M);
    if near == [true; 3] {
        return;
    }
    if near == [false; 3] && beside(surface, corners, recipe.radius_px * aim.largest()) {
        return;
    }
    let nearest = corners.iter().map(|corner| -corner.z).fold(f64::INFINITY, f64::min).max(NEAR_M);
    let area = eye.focal_px * eye.focal_px * facet.volume * piece.share / 2.0;
    let most = (recipe.density(aim.smallest()) * area / (nearest * nearest * nearest)).min(MOST);
    for number in 0.. {
        // The rank grows by 1, from 0 on.
        if f64::from(number) * FADE >= most {
            break;
        }
        let dice = Dice::of([facet.triangle, piece.number, number], recipe.key);
        if dice.rank * FADE < most {
            found.extend(impulse(surface, recipe, aim, (facet, plane, area), (dice, piece)));
        }
    }
}

/// The impulse, if it is in the frame. `area` is what the whole piece would have at a depth of 1 m, in square pixels.
fn impulse(
    surface: &Surface,
    recipe: &Recipe,
    aim: &Aim,
    (facet, plane, area): (&Facet, DVec3, f64),
    (dice, piece): (Dice, &Piece),
) -> Option<Impulse> {
    let weights = dice.weights(piece);
    let place = mixed(facet.corners, weights);
    let depth = -place.z;
    if depth < NEAR_M {
        return None;
    }
    let larger = aim.larger(surface, facet, weights, place);
    let factor = factor(recipe.density(larger) * area / (depth * depth * depth), dice.rank);
    let at = surface.eye.project(place);
    let radius_px = recipe.radius_px * larger;
    if factor <= 0.0 || !meets(at, radius_px, surface.size_px) {
        return None;
    }
    let (angle, sure) = aim.angle(surface, facet, weights, place);
    Some(Impulse {
        of: dice.of,
        at,
        depth,
        factor,
        phase: dice.phase,
        angle: angle + dice.spread(recipe),
        sure,
        radius_px,
        spacing_px: recipe.spacing_px * larger,
        plane,
    })
}

/// How much an impulse of this rank counts where so many are wanted.
pub fn factor(wanted: f64, rank: f64) -> f64 {
    let counted = wanted.min(MOST);
    (counted / (FADE * rank) - 1.0).clamp(0.0, 1.0) * (wanted / counted).sqrt()
}

/// Whether a square around a place has any of the frame.
fn meets(at: DVec2, half: f64, (width, height): (usize, usize)) -> bool {
    at.x + half > 0.0 && at.y + half > 0.0 && at.x - half < width as f64 && at.y - half < height as f64
}

/// Whether all that is drawn around these points is beside the frame.
fn beside(surface: &Surface, corners: [DVec3; 3], reach: f64) -> bool {
    let at = corners.map(|corner| surface.eye.project(corner));
    let (width, height) = (surface.size_px.0 as f64, surface.size_px.1 as f64);
    let all = |beyond: &dyn Fn(DVec2) -> bool| at.iter().all(|at| beyond(*at));
    all(&|at| at.x + reach < 0.0)
        || all(&|at| at.y + reach < 0.0)
        || all(&|at| at.x - reach > width)
        || all(&|at| at.y - reach > height)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_squares_of_the_factors_add_up_to_what_is_wanted() {
        // Mean over ranks, in a fine grid in place of chance.
        const STEPS: usize = 20_000;
        for wanted in [0.02, 0.3, 1.0, 2.5, 64.0] {
            let most = (wanted / FADE).ceil() as usize + 1;
            let ranks = (0..most * STEPS).map(|i| (i as f64 + 0.5) / STEPS as f64);
            let sum = ranks.map(|rank| factor(wanted, rank)).map(|m| m * m).sum::<f64>() / STEPS as f64;
            assert!((sum / wanted - 1.0).abs() < 1e-3, "{wanted}: {sum}");
        }
        assert!((factor(4.0 * MOST, 1.0) - 2.0).abs() < 1e-12, "beyond the most each counts for several");
    }

    #[test]
    fn keys_are_as_published() {
        assert_eq!(Recipe::key(1, 0, 2), 2_853_113_487);
    }
}
