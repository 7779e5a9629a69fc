//! A mesh: triangles in space, as a surface that can be drawn.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::geometry;

pub mod builder;
pub mod normals;

/// Triangles over shared vertices: right-handed, y up, in meters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The vertices, each a corner of some triangle; two that differ in their normal or texture coordinates alone are two.
    pub vertices: Vec<Vertex>,
    /// The corners of each triangle as indices of vertices, counter-clockwise as seen from the front. A triangle's index
    /// is its number in the file.
    pub triangles: Vec<[u32; 3]>,
    /// The first triangle with a corner that has no texture coordinates.
    pub without_uv: Option<usize>,
    /// How many triangles have no area, and so are never seen.
    pub degenerate: usize,
    /// Whether what its triangles face is its inside, wherever that is not quite closed.
    pub inside_out: bool,
    /// The file, relative to its own, of the picture that it comes with; `None` if that is in its own, or if there is none.
    pub picture: Option<String>,
}

/// A corner that triangles share.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vertex {
    /// Where it is.
    pub position: DVec3,
    /// Length 1, outward.
    pub normal: DVec3,
    /// Texture coordinates; v = 0 is the bottom edge of a picture. Zero if there are none.
    pub uv: DVec2,
}

impl Mesh {
    /// The least and the greatest coordinates of what the triangles cover; `None` if there are no triangles.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let corners = self.triangles.iter().flatten().map(|&vertex| self.vertices[vertex as usize].position);
        corners
            .map(|corner| (corner, corner))
            .reduce(|(least, most), (corner, _)| (least.min(corner), most.max(corner)))
    }

    /// How far it reaches along each of these ways; `None` if there is nothing of it.
    pub fn reach(&self, ways: &[DVec3]) -> Option<Vec<f64>> {
        geometry::reach(self.vertices.par_iter().map(|vertex| vertex.position), ways)
    }

    /// See [`Mesh::inside_out`]. The volume that is enclosed, in boxes around it, by the divergence theorem: a sum over
    /// triangles of that between each and the middle of the box. Where the mesh has holes, another middle changes that by at
    /// most a sixth of the sum of its areas as vectors, which is none of a closed mesh.
    fn is_inside_out(&self) -> bool {
        const LEAST: f64 = 1e-6;
        let Some((low, high)) = self.bounds() else { return false };
        let (middle, size) = (low * 0.5 + high * 0.5, (high * 0.5 - low * 0.5).length() * 2.0);
        let mut sums = (0.0, DVec3::ZERO);
        for corners in &self.triangles {
            let [a, b, c] = corners.map(|corner| (self.vertices[corner as usize].position - middle) / size);
            sums.0 += a.dot(b.cross(c)) / 6.0;
            sums.1 += (b - a).cross(c - a) / 2.0;
        }
        sums.0 < -LEAST - sums.1.length() / 6.0
    }

    /// The memory that it takes.
    pub fn bytes(&self) -> u64 {
        (size_of_val(&self.vertices[..]) + size_of_val(&self.triangles[..])) as u64
    }
}
