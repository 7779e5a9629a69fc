//! Where strokes run, and how large they are: one angle and one size for each impulse.

use glam::{DMat3, DVec2, DVec3};

use super::surface::{Facet, Surface, mixed};
use crate::base::maths::{atan2, cos, sin};

/// How little the angle of the drawing counts against a direction that is sure.
const UNSURE: f64 = 0.25;
/// A form with radii of curvature this many times its own is flat.
const FLAT: f64 = 0.1;

/// Which direction strokes follow; vectors are in camera coordinates.
#[derive(Clone)]
pub enum Follows<'a> {
    /// Only the angle.
    Screen,
    /// Round the form: the tensor of curvature at each vertex, turned as the mesh is, and half the size of the mesh.
    Curvature(&'a [DMat3], f64),
    /// Down the shading: the direction of the light.
    Light(DVec3),
    /// Along an axis, as it is at each triangle's first corner.
    Axis(&'a (dyn Fn(u32) -> DVec3 + Sync)),
    /// Across the normal, as it is seen.
    Outline,
    /// Along a flow map: its vector at texture coordinates, to the right and up.
    Image(&'a (dyn Fn(DVec2) -> DVec2 + Sync)),
}

/// What makes strokes larger or finer.
#[derive(Clone)]
pub enum Grows<'a> {
    /// How much light there is: the direction of the light, in camera coordinates.
    Light(DVec3),
    /// How curved the form is.
    Curvature(&'a [DMat3], f64),
    /// How much the surface faces the camera.
    Facing,
    /// The brightness of a picture at texture coordinates.
    Image(&'a (dyn Fn(DVec2) -> f64 + Sync)),
}

/// Directions and sizes of a noise.
pub struct Aim<'a> {
    /// What strokes follow.
    pub along: Follows<'a>,
    /// The angle where that is not sure, counter-clockwise from +x, in radians; without turns.
    pub angle: f64,
    /// The turn of all directions, counter-clockwise, in radians.
    pub turn: f64,
    /// What makes strokes larger or finer, and how large they are at its least and most.
    pub vary: Option<(Grows<'a>, [f64; 2])>,
    /// The angle of the drawing alone, clockwise from +x, as half an argument: one of the two ends of a stroke counts.
    pub drawn: f64,
}

impl<'a> Aim<'a> {
    /// Strokes along something, at an angle where that is not sure, all turned; both counter-clockwise, in radians.
    pub fn new(along: Follows<'a>, angle: f64, turn: f64, vary: Option<(Grows<'a>, [f64; 2])>) -> Self {
        Aim { along, angle, turn, vary, drawn: half_way(-(angle + turn)) }
    }
}

impl Aim<'_> {
    /// The least factor of sizes.
    pub fn smallest(&self) -> f64 {
        self.vary.as_ref().map_or(1.0, |(_, [low, high])| low.min(*high))
    }

    /// The greatest factor of sizes.
    pub fn largest(&self) -> f64 {
        self.vary.as_ref().map_or(1.0, |(_, [low, high])| low.max(*high))
    }

    /// How much larger strokes are at a place of a triangle.
    #[inline]
    pub fn larger(&self, surface: &Surface, facet: &Facet, weights: DVec3, place: DVec3) -> f64 {
        let Some((by, [low, high])) = &self.vary else { return 1.0 };
        let normal = || facing(facet, weights);
        let share = match by {
            Grows::Light(light) => (-normal().dot(*light)).max(0.0),
            Grows::Facing => normal().dot(-place.normalize_or_zero()).abs(),
            Grows::Curvature(tensors, half) => {
                let tensor = surface.tensor(facet, tensors, weights);
                let squares: f64 = tensor.to_cols_array().iter().map(|v| v * v).sum();
                let curved = half * squares.sqrt() / (4.0 * std::f64::consts::SQRT_2);
                curved / (1.0 + curved)
            }
            Grows::Image(image) => image(surface.uv(facet, weights)),
        };
        low + (high - low) * share
    }

    /// The direction of a stroke in the plane of its triangle, of length 1, for strokes that lie on the surface: how sure it
    /// is counts for nothing, and the first edge serves where there is none.
    pub fn way(&self, surface: &Surface, facet: &Facet, weights: DVec3, normal: DVec3) -> DVec3 {
        let plain = surface.turn_at(facet.triangle);
        let found = match &self.along {
            Follows::Screen | Follows::Outline => Some(plain * DVec3::new(cos(self.angle), sin(self.angle), 0.0)),
            Follows::Curvature(..) | Follows::Light(_) | Follows::Axis(_) | Follows::Image(_) => {
                self.tangent(surface, facet, weights, normal).map(|(way, _)| way)
            }
        };
        let laid = |way: DVec3| (way - normal * way.dot(normal)).try_normalize();
        let way = found.and_then(laid).or_else(|| laid(facet.corners[1] - facet.corners[0])).unwrap_or(DVec3::X);
        way * cos(self.turn) + normal.cross(way) * sin(self.turn)
    }

    /// The direction of a stroke at a place of a triangle, clockwise from +x, and how sure it is.
    #[inline(always)]
    pub fn angle(&self, surface: &Surface, facet: &Facet, weights: impl FnOnce() -> DVec3, place: DVec3) -> (f64, f64) {
        match self.along {
            Follows::Screen => (self.drawn, 1.0),
            _ => self.angle_on(surface, facet, weights(), place),
        }
    }

    fn angle_on(&self, surface: &Surface, facet: &Facet, weights: DVec3, place: DVec3) -> (f64, f64) {
        let (normal, drawn) = (facing(facet, weights), -(self.angle + self.turn));
        if let Follows::Outline = self.along {
            let across = DVec2::new(normal.x, -normal.y);
            let turned = DVec2::from_angle(-self.turn).rotate(DVec2::new(-across.y, across.x));
            return blended(turned, across.length(), drawn);
        }
        let Some((way, sure)) = self.tangent(surface, facet, weights, normal) else { return (self.drawn, 1.0) };
        let Some(way) = way.try_normalize() else { return (self.drawn, 0.0) };
        // Counter-clockwise about the normal.
        let way = way * cos(self.turn) + normal.cross(way) * sin(self.turn);
        let depth = -place.z;
        let focal = surface.eye.focal_px;
        let seen = DVec2::new(
            way.x / depth + place.x * way.z / (depth * depth),
            -way.y / depth - place.y * way.z / (depth * depth),
        ) * focal;
        let sure = sure * (seen.length() * depth / focal).min(1.0);
        blended(seen, sure, drawn)
    }

    /// What strokes follow on the surface, in the plane across the normal, and how sure that is; `None` if they follow
    /// nothing there.
    fn tangent(&self, surface: &Surface, facet: &Facet, weights: DVec3, normal: DVec3) -> Option<(DVec3, f64)> {
        let laid = |v: DVec3| v - normal * v.dot(normal);
        match &self.along {
            Follows::Screen | Follows::Outline => None,
            Follows::Light(light) => Some((laid(*light), laid(*light).length())),
            Follows::Axis(axis) => {
                let way = laid(axis(facet.triangle));
                Some((way, way.length()))
            }
            Follows::Curvature(tensors, half) => {
                let one = laid(facet.corners[1] - facet.corners[0]).normalize_or_zero();
                let two = normal.cross(one);
                let tensor = surface.tensor(facet, tensors, weights);
                let (a, b, c) = (one.dot(tensor * one), one.dot(tensor * two), two.dot(tensor * two));
                // Squared, so that a saddle is unsure, and hollow and round are the same.
                let (q11, q12, q22) = (a * a + b * b, a * b + b * c, b * b + c * c);
                let apart = ((q11 - q22) * (q11 - q22) + 4.0 * q12 * q12).sqrt();
                let angle = atan2(2.0 * q12, q11 - q22) / 2.0;
                let flat = FLAT / half;
                Some((one * cos(angle) + two * sin(angle), apart / (q11 + q22 + flat * flat)))
            }
            Follows::Image(flow) => {
                let vector = flow(surface.uv(facet, weights));
                let [right, up] = surface.texture_axes(facet);
                Some((laid(right * vector.x + up * vector.y), vector.length().min(1.0)))
            }
        }
    }
}

/// The end of a stroke at this angle that counts.
pub fn half_way(angle: f64) -> f64 {
    blended(DVec2::X, 0.0, angle).0
}

/// The normal at a place of a triangle, turned to the camera.
fn facing(facet: &Facet, weights: DVec3) -> DVec3 {
    let normal = mixed(facet.normals, weights).normalize_or_zero();
    if facet.front { normal } else { -normal }
}

/// A direction that is sure, mixed with the angle of the drawing: by twice their angles, so that a stroke has no front.
fn blended(way: DVec2, sure: f64, drawn: f64) -> (f64, f64) {
    let twice = 2.0 * atan2(way.y, way.x);
    let rest = (1.0 - sure) * UNSURE;
    let x = sure * cos(twice) + rest * cos(2.0 * drawn);
    let y = sure * sin(twice) + rest * sin(2.0 * drawn);
    (atan2(y, x) / 2.0, sure)
}
