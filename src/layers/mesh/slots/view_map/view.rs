//! A view as it counts on the surface.

use glam::{DVec2, DVec3};

use super::camera::Camera;
use super::entries::Reach;
use super::paint::Paint;
use crate::base::maths::{cos, sin};

/// An active view.
#[derive(Clone, Debug)]
pub struct View {
    /// Its name.
    pub name: String,
    /// Its place in the document's list, from 0.
    pub number: usize,
    /// From where it was seen, for its picture's size.
    pub camera: Camera,
    /// What that looks at.
    pub target: DVec3,
    /// Its picture.
    pub paint: Paint,
    /// Whether the base coat is made of it.
    pub base: bool,
    /// Whether it counts by the direction from which one looks.
    pub dependent: bool,
    /// How far it counts.
    pub extremes: Extremes,
    /// How it fades.
    pub fade: Fade,
    /// How near and how far it reaches.
    pub reach: Reach,
    /// How much is left out beside steps in depth, in pixels of the picture.
    pub edge_px: f64,
}

/// How far a view counts.
#[derive(Clone, Debug, PartialEq)]
pub enum Extremes {
    /// Up to the other views, and so far at most: the tangent of half the angle.
    Auto(f64),
    /// As far as the tangent of half an angle.
    Cone(f64),
    /// Up to these camera places, once round the view, counter-clockwise as it is seen from there.
    Points(Vec<DVec3>),
}

/// How a view fades towards its limits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fade {
    /// Evenly, not smoothly.
    pub linear: bool,
    /// The share of the way on which it stays whole.
    pub hold: f64,
}

impl Fade {
    /// How much a view counts at a part of the way to its limit.
    #[inline]
    pub fn factor(&self, gauge: f64) -> f64 {
        if gauge >= 1.0 {
            return 0.0;
        }
        let y = ((1.0 - gauge) / (1.0 - self.hold)).min(1.0);
        if self.linear { y } else { y * y * (3.0 - 2.0 * y) }
    }
}

impl View {
    /// Whether both tell the cells of a map the same.
    pub fn tells_the_same(&self, other: &View) -> bool {
        (self.camera, self.edge_px, self.reach) == (other.camera, other.edge_px, other.reach)
            && self.paint.same(&other.paint)
    }
}

impl View {
    /// Whether both count the same in what they tell.
    pub fn counts_the_same(&self, other: &View) -> bool {
        (&self.name, self.number, self.dependent) == (&other.name, other.number, other.dependent)
            && (&self.extremes, self.fade, self.target) == (&other.extremes, other.fade, other.target)
    }
}

impl Extremes {
    /// Camera places from degrees to the right and up, for a camera that looks at `target`.
    pub fn points(camera: &Camera, target: DVec3, degrees: &[DVec2]) -> Extremes {
        let [x, y, _] = camera.axes();
        let way = camera.position - target;
        let (radius, front) = (way.length(), way.normalize_or_zero());
        let place = |degrees: &DVec2| {
            let [right, up] = [degrees.x.to_radians(), degrees.y.to_radians()];
            target + radius * (cos(up) * (cos(right) * front + sin(right) * x) + sin(up) * y)
        };
        let mut places: Vec<DVec3> = degrees.iter().map(place).collect();
        if turning(degrees) < 0.0 {
            places.reverse();
        }
        Extremes::Points(places)
    }
}

/// Twice the area that points go round: positive counter-clockwise.
fn turning(points: &[DVec2]) -> f64 {
    (0..points.len()).map(|k| points[k].perp_dot(points[(k + 1) % points.len()])).sum()
}

/// The point of a camera's axis that is nearest to a place, in front of it.
pub fn nearest_on_axis(camera: &Camera, place: DVec3) -> DVec3 {
    const LEAST_M: f64 = 1e-3;
    let forward = -camera.axes()[2];
    camera.position + forward * (place - camera.position).dot(forward).max(LEAST_M)
}
