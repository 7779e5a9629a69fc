//! How far each view counts at a place, looked at from somewhere. What holds for all cells there is found once; cells
//! then only ask what views tell them.

use glam::DVec3;

use super::cells::NONE;
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
    /// The place of each view in that list.
    slots: Vec<u32>,
    /// By how much each view limits each of them where it tells the cell everything.
    limits: Vec<f64>,
}

/// A view that may count at a place.
#[derive(Clone, Copy, Debug)]
struct Near {
    view: u32,
    /// How far the way to its limit the eye is, as far as that does not depend on the cell.
    gauge: f64,
    /// Whether other views limit it.
    limited: bool,
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
        self.near.iter().for_each(|near| self.slots[near.view as usize] = NONE);
        self.near.clear();
        self.limits.clear();
        self.slots.resize(views.len(), NONE);
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
                self.slots[number] = self.near.len() as u32;
                self.near.push(Near { view: number as u32, gauge, limited });
                self.limit(views, number, limited);
            }
        }
    }

    /// Adds by how much each view limits one.
    fn limit(&mut self, views: &[View], number: usize, limited: bool) {
        if !limited {
            return self.limits.resize(self.limits.len() + views.len(), 0.0);
        }
        let [x, y, z, along] = self.ways[number];
        self.limits.extend(self.ways.iter().zip(views).map(|(other, view)| {
            let between = other[0] * x + other[1] * y + other[2] * z;
            let across = other[3] - along * between;
            let limits = view.dependent && between <= SAME_WAY && across > 0.0;
            if limits { across / ((1.0 + along) * (1.0 - between)) } else { 0.0 }
        }));
    }

    /// Whether no view counts.
    pub fn none(&self) -> bool {
        self.near.is_empty()
    }

    /// The place of a view in the list of those that may count; [`NONE`] if it is not there.
    #[inline]
    pub fn slot(&self, view: u8) -> u32 {
        self.slots[usize::from(view)]
    }

    /// How far the way to its limit the eye is for the view in a slot, at a cell where views tell so much: 0 to 1, above 1
    /// beyond the limit.
    #[inline]
    pub fn gauge(&self, slot: u32, told: impl Iterator<Item = (u8, f64)>) -> f64 {
        let near = &self.near[slot as usize];
        if !near.limited {
            return near.gauge;
        }
        let limits = &self.limits[slot as usize * self.ways.len()..][..self.ways.len()];
        told.fold(near.gauge, |gauge, (view, strength)| gauge.max(strength * limits[usize::from(view)]))
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
