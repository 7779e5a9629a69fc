//! A mesh as one eye sees it: its triangles in camera coordinates, and what is known of each.

use std::sync::atomic::AtomicBool;

use glam::{DMat3, DVec2, DVec3};

use super::pieces::Pieces;
use crate::base::mesh::Mesh;
use crate::layers::mesh::pose::Placed;
use crate::layers::space::eye::Eye;

/// A mesh as one eye sees it.
pub struct Surface<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// Its pieces.
    pub pieces: &'a Pieces,
    /// Its vertices and their normals in camera coordinates.
    pub seen: Vec<(DVec3, DVec3)>,
    /// How it is placed in the world.
    pub placed: &'a Placed,
    /// Whether back sides are seen.
    pub both: bool,
    /// From where it is seen.
    pub eye: Eye,
    /// Width and height of the frame, in pixels.
    pub size_px: (usize, usize),
    /// Once it is set, what is made of it counts no more.
    pub stop: Option<&'a AtomicBool>,
}

/// A triangle as it is seen.
#[derive(Clone, Copy, Debug)]
pub struct Facet {
    /// Its number.
    pub triangle: u32,
    /// Its corners, in camera coordinates.
    pub corners: [DVec3; 3],
    /// The normals there.
    pub normals: [DVec3; 3],
    /// Whether its front is seen.
    pub front: bool,
    /// Six times the volume of it and the eye.
    pub volume: f64,
}

impl Surface<'_> {
    /// A triangle, if it can be seen at all.
    pub fn facet(&self, triangle: u32) -> Option<Facet> {
        let vertices = self.mesh.triangles[triangle as usize].map(|vertex| self.seen[vertex as usize]);
        let corners = vertices.map(|(at, _)| at);
        let volume = corners[0].dot(corners[1].cross(corners[2]));
        let front = volume < 0.0;
        let seen = volume != 0.0 && volume.is_finite() && (front || self.both);
        seen.then(|| self.any_facet(triangle)).flatten()
    }

    /// A triangle, also if it faces away.
    pub fn any_facet(&self, triangle: u32) -> Option<Facet> {
        let vertices = self.mesh.triangles[triangle as usize].map(|vertex| self.seen[vertex as usize]);
        let corners = vertices.map(|(at, _)| at);
        let volume = corners[0].dot(corners[1].cross(corners[2]));
        let facet = Facet {
            triangle,
            corners,
            normals: vertices.map(|(_, normal)| normal),
            front: volume < 0.0,
            volume: volume.abs(),
        };
        volume.is_finite().then_some(facet)
    }

    /// The texture coordinates at a place of a triangle.
    pub fn uv(&self, facet: &Facet, weights: DVec3) -> DVec2 {
        let [a, b, c] =
            self.mesh.triangles[facet.triangle as usize].map(|vertex| self.mesh.vertices[vertex as usize].uv);
        a * weights.x + b * weights.y + c * weights.z
    }

    /// The directions in which texture coordinates grow on a triangle, of length 1; zero where they do not.
    pub fn texture_axes(&self, facet: &Facet) -> [DVec3; 2] {
        let [a, b, c] =
            self.mesh.triangles[facet.triangle as usize].map(|vertex| self.mesh.vertices[vertex as usize].uv);
        let (ab, ac) = (facet.corners[1] - facet.corners[0], facet.corners[2] - facet.corners[0]);
        let (b, c) = (b - a, c - a);
        let sense = (b.x * c.y - b.y * c.x).signum();
        let axis = |way: DVec3| (way * sense).normalize_or_zero();
        [axis(ab * c.y - ac * b.y), axis(ac * b.x - ab * c.x)]
    }

    /// How the model is turned at the first corner of a triangle, to camera coordinates.
    pub fn turn_at(&self, triangle: u32) -> DMat3 {
        let [first, ..] = self.mesh.triangles[triangle as usize];
        self.eye.turn * self.placed.turn_at(self.mesh.vertices[first as usize].position)
    }

    /// What a tensor at the vertices is at a place of a triangle.
    pub fn tensor(&self, facet: &Facet, tensors: &[DMat3], weights: DVec3) -> DMat3 {
        let [a, b, c] = self.mesh.triangles[facet.triangle as usize].map(|vertex| tensors[vertex as usize]);
        a * weights.x + b * weights.y + c * weights.z
    }

    /// 1 / the depth of a triangle's plane at a pixel; see `plane` of an impulse.
    pub fn plane(&self, facet: &Facet) -> DVec3 {
        let [a, b, c] = facet.corners;
        let normal = (b - a).cross(c - a);
        let level = normal / normal.dot(a);
        let Eye { focal_px, middle_px, .. } = self.eye;
        let (x, y) = (level.x / focal_px, -level.y / focal_px);
        DVec3::new(x, y, -level.z - x * middle_px.x - y * middle_px.y)
    }
}

/// A mean of three points with these weights.
pub fn mixed(of: [DVec3; 3], weights: DVec3) -> DVec3 {
    of[0] * weights.x + of[1] * weights.y + of[2] * weights.z
}
