//! How far each view counts at a place, looked at from somewhere. What holds for all cells there is found once; cells
//! then only ask what views tell them.

use glam::DVec3;

use super::view::{Extremes, View};
use crate::base::simd::vectorised;

/// The cosine beyond which two views look the same way.
const SAME_WAY: f64 = 0.99985;
/// The cosine at which one looks from behind a view.
const BEHIND: f64 = -0.999;
/// The least that the projection of an extreme place is divided by.
const LEAST: f64 = 1e-3;
/// How near to the middle of a view there is no way to its limit.
const MIDDLE: f64 = 1e-9;

/// How many views are looked at together.
const LANES: usize = 8;

/// One number for each of some views.
type Lanes = [f64; LANES];

/// What is known of all views at a place.
#[derive(Debug)]
pub struct Gauges<'a> {
    views: &'a [View],
    /// Where the cameras of the views are that depend on the direction; of others it is not a number, nor is anything below.
    cameras: Vec<[Lanes; 3]>,
    /// Unit vectors to them, and their cosines with the way to the eye.
    ways: Vec<[Lanes; 4]>,
    /// The views that may count.
    near: Vec<Near>,
    /// The views that limit them, each with how far the way to that limit the eye is where it tells the cell everything.
    limits: Vec<(u32, f64)>,
}

/// A view that may count at a place.
#[derive(Clone, Copy, Debug)]
pub struct Near {
    /// The view.
    pub view: usize,
    /// How far the way to its limit the eye is, as far as that does not depend on the cell.
    gauge: f64,
    /// The first of those that limit it further, and the one after the last.
    limits: [u32; 2],
}

impl<'a> Gauges<'a> {
    /// What is known of these views.
    pub fn new(views: &'a [View]) -> Gauges<'a> {
        let lump = |views: &[View]| {
            let mut lump = [[f64::NAN; LANES]; 3];
            for (k, view) in views.iter().enumerate().filter(|(_, view)| view.dependent) {
                lump.iter_mut().zip(view.camera.position.to_array()).for_each(|(lanes, at)| lanes[k] = at);
            }
            lump
        };
        let cameras: Vec<_> = views.chunks(LANES).map(lump).collect();
        let ways = vec![[[f64::NAN; LANES]; 4]; cameras.len()];
        Gauges { views, cameras, ways, near: Vec::new(), limits: Vec::new() }
    }

    /// Finds what is known at `place` (of the model) when it is looked at from `eye`, a unit vector away from it.
    pub fn set(&mut self, place: DVec3, eye: DVec3) {
        vectorised(
            #[inline(always)]
            || {
                for (way, camera) in self.ways.iter_mut().zip(&self.cameras) {
                    *way = ways(camera, place, eye);
                }
                self.near.clear();
                self.limits.clear();
                for (number, view) in self.views.iter().enumerate().filter(|(_, view)| view.dependent) {
                    let way = self.ways[number / LANES].map(|lanes| lanes[number % LANES]);
                    let [x, y, z, along] = way;
                    if along <= BEHIND {
                        continue;
                    }
                    let (gauge, limited) = match &view.extremes {
                        Extremes::Auto(reach) => (cone(along, *reach), true),
                        Extremes::Cone(reach) => (cone(along, *reach), false),
                        Extremes::Points(places) => (polygon(DVec3::new(x, y, z), place, eye, places), false),
                    };
                    if gauge < 1.0 {
                        let first = self.limits.len();
                        if limited {
                            self.limit(way, gauge);
                        }
                        let limits = [first, self.limits.len()].map(|at| at as u32);
                        self.near.push(Near { view: number, gauge, limits });
                    }
                }
            },
        );
    }

    /// Adds the views that limit one, to which this is the way, to less than it is; the nearest is the first.
    #[inline(always)]
    fn limit(&mut self, [x, y, z, along]: [f64; 4], gauge: f64) {
        let first = self.limits.len();
        for (lump, other) in self.ways.iter().enumerate() {
            let (mut across, mut whole, mut is) = ([0.0; LANES], [0.0; LANES], [false; LANES]);
            for k in 0..LANES {
                let between = other[0][k] * x + other[1][k] * y + other[2][k] * z;
                across[k] = other[3][k] - along * between;
                whole[k] = (1.0 + along) * (1.0 - between);
                is[k] = between <= SAME_WAY && across[k] > gauge * whole[k];
            }
            for k in (0..LANES).filter(|k| is[*k]) {
                self.limits.push(((lump * LANES + k) as u32, across[k] / whole[k]));
            }
        }
        let limits = &mut self.limits[first..];
        let nearest = (0..limits.len()).max_by(|a, b| limits[*a].1.total_cmp(&limits[*b].1));
        nearest.iter().for_each(|nearest| limits.swap(0, *nearest));
    }

    /// The views that may count, ascending.
    #[inline]
    pub fn near(&self) -> &[Near] {
        &self.near
    }

    /// How far the way to its limit the eye is for one of these views, at a cell to which each view tells so much, from 0 to 1:
    /// at least 1 beyond the limit.
    #[inline]
    pub fn gauge(&self, near: &Near, told: impl Fn(usize) -> f64) -> f64 {
        let [from, to] = near.limits.map(|at| at as usize);
        let mut gauge = near.gauge;
        for (view, limit) in &self.limits[from..to] {
            // A view tells a share of at most 1, so that its limit bounds the product.
            if *limit > gauge {
                gauge = gauge.max(limit * told(*view as usize));
            }
            if gauge >= 1.0 {
                break;
            }
        }
        gauge
    }
}

/// The unit vectors from a place to some cameras, and their cosines with the way to the eye.
#[inline(always)]
fn ways(cameras: &[Lanes; 3], place: DVec3, eye: DVec3) -> [Lanes; 4] {
    let mut found = [[0.0; LANES]; 4];
    for k in 0..LANES {
        let [x, y, z] = [cameras[0][k] - place.x, cameras[1][k] - place.y, cameras[2][k] - place.z];
        let scale = 1.0 / (x * x + y * y + z * z).sqrt();
        let [x, y, z] = [x * scale, y * scale, z * scale];
        (found[0][k], found[1][k], found[2][k]) = (x, y, z);
        found[3][k] = x * eye.x + y * eye.y + z * eye.z;
    }
    found
}

/// How far the way to an angle is whose half has this tangent.
#[inline]
fn cone(along: f64, reach: f64) -> f64 {
    let square = ((1.0 - along) / (1.0 + along)).max(0.0);
    // Most views are far beyond.
    if square >= reach * reach { f64::INFINITY } else { square.sqrt() / reach }
}

/// How far the way to the line between extreme places is.
fn polygon(view: DVec3, place: DVec3, eye: DVec3, places: &[DVec3]) -> f64 {
    let flat = |way: DVec3, least: f64| (way - way.dot(view) * view) / (1.0 + way.dot(view)).max(least);
    let at = flat(eye, 0.0);
    if at.length() < MIDDLE {
        return 0.0;
    }
    let corner = |k: usize| flat((places[k % places.len()] - place).normalize_or_zero(), LEAST);
    let turn = |a: DVec3, b: DVec3| view.dot(a.cross(b));
    let mut from = corner(0);
    for k in 1..=places.len() {
        let to = corner(k);
        let (before, after, whole) = (turn(from, at), turn(at, to), turn(from, to));
        if before >= 0.0 && after >= 0.0 && whole > 0.0 {
            return (before + after) / whole;
        }
        from = to;
    }
    f64::INFINITY
}
