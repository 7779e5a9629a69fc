//! How far each view counts at a place, looked at from somewhere. What holds for all cells there is found once; cells
//! then only ask what views tell them.

use glam::DVec3;

use super::view::{Extremes, View};

/// The cosine beyond which two views look the same way.
const SAME_WAY: f64 = 0.99985;
/// The cosine at which one looks from behind a view.
const BEHIND: f64 = -0.999;
/// The least that the projection of an extreme place is divided by.
const LEAST: f64 = 1e-3;
/// How near to the middle of a view there is no way to its limit.
const MIDDLE: f64 = 1e-9;

/// What is known of all views at a place.
#[derive(Debug, Default)]
pub struct Gauges {
    /// Unit vectors to the cameras of the views, and their cosines with the way to the eye.
    ways: Vec<[f64; 4]>,
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

impl Gauges {
    /// Finds what is known at `place` (of the model) when it is looked at from `eye`, a unit vector away from it.
    pub fn set(&mut self, views: &[View], place: DVec3, eye: DVec3) {
        self.ways.clear();
        self.ways.extend(views.iter().map(|view| {
            let way = view.camera.position - place;
            let way = way * (1.0 / way.length());
            [way.x, way.y, way.z, way.dot(eye)]
        }));
        self.near.clear();
        self.limits.clear();
        for (number, view) in views.iter().enumerate().filter(|(_, view)| view.dependent) {
            let [x, y, z, along] = self.ways[number];
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
                    self.limit(views, number, gauge);
                }
                let limits = [first, self.limits.len()].map(|at| at as u32);
                self.near.push(Near { view: number, gauge, limits });
            }
        }
    }

    /// Adds the views that limit one to less than it is; the nearest is the first.
    fn limit(&mut self, views: &[View], number: usize, gauge: f64) {
        let (first, [x, y, z, along]) = (self.limits.len(), self.ways[number]);
        for (view, (other, own)) in self.ways.iter().zip(views).enumerate() {
            let between = other[0] * x + other[1] * y + other[2] * z;
            let across = other[3] - along * between;
            let whole = (1.0 + along) * (1.0 - between);
            if own.dependent && between <= SAME_WAY && across > gauge * whole {
                self.limits.push((view as u32, across / whole));
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
            // It tells at most everything.
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
