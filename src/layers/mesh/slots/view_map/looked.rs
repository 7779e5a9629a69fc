//! How a view map is looked at: by one camera at one time.

use glam::DVec3;

use super::arrays::Arrays;
use super::blend::Points;
use super::id::{depth_of, share_of};
use super::map::Map;
use super::sample::{Reader, Spot};
use crate::layers::mesh::pose::Placed;
use crate::layers::mesh::surface::SurfacePoint;
use crate::layers::parts::moment::Moment;
use crate::layers::space::eye::Eye;
use crate::layers::space::raster::NONE;

/// A map, and its arrays of directions if it has some.
pub type Filled<'a> = (&'a Map, Option<&'a Arrays>);

/// A view map as one camera sees it at one time.
pub struct Looked<'a> {
    map: &'a Map,
    arrays: Option<&'a Arrays>,
    placed: Placed,
    /// `None` without a camera.
    eye: Option<Eye>,
    /// How many pixels of the frame that is drawn are one of the finished frame.
    samples: f64,
    /// How much of the base coat alone is seen.
    base: f64,
}

/// How much of the base coat alone an eye sees.
pub fn base(points: &Points, eye: &Eye, placed: &Placed) -> f64 {
    let position = placed.turn.transpose() * (eye.position - placed.position) / placed.scale;
    points.at(position, placed.turn.transpose() * -eye.turn.row(2))
}

impl<'a> Looked<'a> {
    /// The map at one time.
    pub fn new(filled: Filled<'a>, points: &Points, moment: &Moment, placed: &Placed) -> Looked<'a> {
        let (map, arrays) = filled;
        let base = moment.eye.map_or(0.0, |eye| base(points, &eye, placed));
        let samples = f64::from(moment.magnified.max(1));
        Looked { map, arrays, placed: *placed, eye: moment.eye, samples: samples * samples, base }
    }

    /// The map.
    pub fn map(&self) -> &'a Map {
        self.map
    }

    /// What reads it.
    pub fn sampler(&self) -> Reader<'a> {
        Reader::new(self.map, self.arrays)
    }

    /// How much of the base coat alone is seen.
    pub fn base(&self) -> f64 {
        self.base
    }

    /// What tells how the surface is looked at, at one place after the other.
    pub fn spots(&self) -> impl FnMut(&SurfacePoint) -> Option<Spot> + '_ {
        // Neighbors mostly show the same triangle.
        let mut last = (NONE, 0.0);
        move |place| {
            let (eye, triangle) = (self.eye.as_ref()?, place.hit.triangle);
            if triangle as u32 != last.0 {
                last = (triangle as u32, self.cells(eye, triangle));
            }
            let mesh = &self.map.wanted.mesh;
            let corners = mesh.triangles[triangle].map(|corner| mesh.vertices[corner as usize].position);
            let weighed = corners.iter().zip(place.hit.weights);
            let point = weighed.fold(DVec3::ZERO, |sum, (corner, weight)| sum + *corner * weight);
            let toward = (eye.position - place.position).normalize_or_zero();
            let depth = place.hit.depth;
            Some(Spot {
                triangle,
                weights: place.hit.weights,
                point,
                eye: self.placed.turn_at(point).transpose() * toward,
                depth: depth_of(last.1 * depth * depth * depth),
            })
        }
    }

    /// How many cells of layer 0 a pixel covers on a triangle, but for the third power of its depth.
    fn cells(&self, eye: &Eye, triangle: usize) -> f64 {
        let (mesh, first) = (&self.map.wanted.mesh, f64::from(self.map.wanted.first));
        let seen = mesh.triangles[triangle].map(|corner| {
            let at = mesh.vertices[corner as usize].position;
            eye.seen(self.placed.point(at, DVec3::ZERO).0)
        });
        share_of(seen, eye.focal_px) * self.samples * self.map.atlas.areas[triangle] * first * first
    }
}
