//! The impulses of a noise in one frame: the points that kernels are centered on. Each is fixed to its place on the surface;
//! how much it counts depends on how large the surface is seen there, so that as many are over every pixel.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::aim::Aim;
use super::pieces::Piece;
use super::surface::{Facet, Surface, mixed};
use super::synth::is_set;
use crate::base::maths::TAU;
use crate::base::random::{pcg4d_lanes, unit};
use crate::base::simd::vectorised;
use crate::layers::space::eye::NEAR_M;

/// 2 - 2 ln 2: with it the factors' squares add up to the number of impulses that is wanted.
pub const FADE: f64 = 2.0 - 2.0 * std::f64::consts::LN_2;
/// At most so many impulses of one piece; beyond that each counts for several.
pub const MOST: f64 = 16_384.0 * FADE;
/// What tells the second random numbers of an impulse from the first.
const SECOND: u32 = 0x8000_0000;
/// So many impulses are made at once.
const LANES: usize = 8;
/// Triangles are looked at in so many lumps, for all cores, but in no more than these at once.
const LUMPS: u32 = 256;
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

/// Tells how much of an impulse counts.
pub type Weight<'a> = &'a (dyn Fn(&Impulse) -> f64 + Sync);

/// All impulses of a noise that may be seen in the frame: by triangle, piece and number, in lumps, each of which `done` makes
/// something of. `visible` tells how much of each is seen, where that counts.
pub fn impulses<L: Extend<Impulse>, R: Send>(
    surface: &Surface,
    recipe: &Recipe,
    aim: &Aim,
    visible: Option<Weight>,
    (lump, done): (impl Fn() -> L + Sync + Send, impl Fn(&mut L) -> R + Sync + Send),
) -> Vec<R> {
    let making = Making { surface, recipe, aim, visible };
    let count = surface.mesh.triangles.len() as u32;
    let size = count.div_ceil(LUMPS).clamp(1, LUMP);
    let lumps = (0..count.div_ceil(size)).into_par_iter().map_init(lump, |lump, i| {
        let mut facet: Option<(u32, Option<(Facet, DVec3)>)> = None;
        surface.pieces.of(i * size..((i + 1) * size).min(count), |piece| {
            if is_set(surface.stop) {
                return;
            }
            if facet.as_ref().is_none_or(|(of, _)| *of != piece.triangle) {
                let own = surface.facet(piece.triangle).map(|facet| (facet, surface.plane(&facet)));
                facet = Some((piece.triangle, own));
            }
            if let Some((_, Some((facet, plane)))) = &facet {
                making.piece((facet, *plane), piece, lump);
            }
        });
        done(lump)
    });
    lumps.collect()
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
    /// How far its stroke is turned clockwise from its direction, in radians.
    pub spread: f64,
}

impl Dice {
    /// Calls `each` with those of a piece of a triangle, as many as may be there if no more than `most` are wanted.
    #[inline(always)]
    pub fn each(of: [u32; 2], recipe: &Recipe, most: f64, mut each: impl FnMut(Dice)) {
        throws(of, recipe, most, |thrown| (0..LANES).for_each(|k| each(thrown.one(k))));
    }

    /// Its place in a piece of a triangle, as weights of the triangle's corners.
    pub fn weights(&self, piece: &Piece) -> DVec3 {
        let [x, y] = self.place;
        let along = x.sqrt();
        let within = DVec3::new(1.0 - along, along * (1.0 - y), along * y);
        mixed(piece.corners, within)
    }
}

/// The dice of some impulses of a piece, whose numbers follow one another.
struct Thrown {
    first: [u32; 3],
    place: [[f64; LANES]; 2],
    phase: [f64; LANES],
    rank: [f64; LANES],
    spread: [f64; LANES],
}

impl Thrown {
    #[inline(always)]
    fn one(&self, k: usize) -> Dice {
        let [triangle, piece, number] = self.first;
        Dice {
            of: [triangle, piece, number + k as u32],
            place: [self.place[0][k], self.place[1][k]],
            phase: self.phase[k],
            rank: self.rank[k],
            spread: self.spread[k],
        }
    }
}

/// Throws the dice of the impulses of a piece, many at once, until so many are wanted.
#[inline(always)]
fn throws([triangle, piece]: [u32; 2], recipe: &Recipe, most: f64, mut each: impl FnMut(&Thrown)) {
    let mut number = 0;
    // The rank grows by 1, from 0 on.
    while f64::from(number) * FADE < most {
        let numbers: [u32; LANES] = std::array::from_fn(|k| number + k as u32);
        let (triangles, pieces) = ([triangle; LANES], [piece; LANES]);
        let [x, y, phase, rank] = pcg4d_lanes([triangles, pieces, numbers, [recipe.key; LANES]]);
        let [spread, ..] = pcg4d_lanes([triangles, pieces, numbers, [recipe.key ^ SECOND; LANES]]);
        let mut thrown = Thrown {
            first: [triangle, piece, number],
            place: [x.map(unit), y.map(unit)],
            phase: phase.map(|bits| TAU * unit(bits)),
            rank: [0.0; LANES],
            spread: spread.map(|bits| recipe.spread * (2.0 * unit(bits) - 1.0)),
        };
        for k in 0..LANES {
            thrown.rank[k] = f64::from(numbers[k]) + f64::from((rank[k] >> 8) + 1) / f64::from(1_u32 << 24);
        }
        each(&thrown);
        number += LANES as u32;
    }
}

/// What impulses are made of.
struct Making<'a> {
    surface: &'a Surface<'a>,
    recipe: &'a Recipe,
    aim: &'a Aim<'a>,
    visible: Option<Weight<'a>>,
}

impl Making<'_> {
    /// Makes those of a piece.
    fn piece(&self, (facet, plane): (&Facet, DVec3), piece: &Piece, lump: &mut impl Extend<Impulse>) {
        let Making { surface, recipe, aim, .. } = *self;
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
        vectorised(
            #[inline(always)]
            || {
                throws(
                    [facet.triangle, piece.number],
                    recipe,
                    most,
                    #[inline(always)]
                    |thrown| self.lot((facet, plane, piece), (corners, area), thrown, lump),
                );
            },
        );
    }

    /// Makes those of these dice that are in the frame. `corners` are those of the piece; `area` is what all of it would have at
    /// a depth of 1 m, in square pixels.
    #[inline(always)]
    fn lot(
        &self,
        (facet, plane, piece): (&Facet, DVec3, &Piece),
        (corners, area): ([DVec3; 3], f64),
        thrown: &Thrown,
        lump: &mut impl Extend<Impulse>,
    ) {
        let Making { surface, recipe, aim, .. } = *self;
        let ([a, b, c], eye) = (corners, &surface.eye);
        let ([along, across], [mut x, mut y, mut z]) = (thrown.place, [[0.0; LANES]; 3]);
        for k in 0..LANES {
            let along = along[k].sqrt();
            x[k] = a.x + along * (b.x - a.x + across[k] * (c.x - b.x));
            y[k] = a.y + along * (b.y - a.y + across[k] * (c.y - b.y));
            z[k] = a.z + along * (b.z - a.z + across[k] * (c.z - b.z));
        }
        let mut larger = [1.0; LANES];
        if aim.vary.is_some() {
            for k in 0..LANES {
                larger[k] = aim.larger(surface, facet, thrown.one(k).weights(piece), DVec3::new(x[k], y[k], z[k]));
            }
        }
        let ([mut right, mut down, mut factors], density) = ([[0.0; LANES]; 3], recipe.density(1.0) * area);
        for k in 0..LANES {
            let inverse = -1.0 / z[k];
            right[k] = eye.middle_px.x + x[k] * (eye.focal_px * inverse);
            down[k] = eye.middle_px.y - y[k] * (eye.focal_px * inverse);
            let wanted = density * (inverse * inverse * inverse) / (larger[k] * larger[k]);
            factors[k] = factor(wanted, thrown.rank[k]);
        }
        for k in 0..LANES {
            let half = recipe.radius_px * larger[k];
            let is_in = (-z[k] >= NEAR_M) & meets((right[k], down[k]), half, surface.size_px);
            factors[k] = if is_in { factors[k] } else { 0.0 };
        }
        for k in (0..LANES).filter(|k| factors[*k] > 0.0) {
            let dice = thrown.one(k);
            let (angle, sure) = aim.angle(surface, facet, || dice.weights(piece), DVec3::new(x[k], y[k], z[k]));
            let mut impulse = Impulse {
                of: dice.of,
                at: DVec2::new(right[k], down[k]),
                depth: -z[k],
                factor: factors[k],
                phase: dice.phase,
                angle: angle + dice.spread,
                sure,
                radius_px: recipe.radius_px * larger[k],
                spacing_px: recipe.spacing_px * larger[k],
                plane,
            };
            impulse.factor *= self.visible.map_or(1.0, |visible| visible(&impulse));
            lump.extend([impulse]);
        }
    }
}

/// How much an impulse of this rank counts where so many are wanted.
#[inline(always)]
pub fn factor(wanted: f64, rank: f64) -> f64 {
    let counted = if wanted < MOST { wanted } else { MOST };
    (counted / (FADE * rank) - 1.0).clamp(0.0, 1.0) * (wanted / counted).sqrt()
}

/// Whether a square around a place has any of the frame.
#[inline(always)]
fn meets((x, y): (f64, f64), half: f64, (width, height): (usize, usize)) -> bool {
    (x + half > 0.0) & (y + half > 0.0) & (x - half < width as f64) & (y - half < height as f64)
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
