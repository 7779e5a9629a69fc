//! A mesh: triangles in space, as a surface that can be drawn.

use glam::{DVec2, DVec3};

pub mod builder;

/// Triangles over shared vertices: right-handed, y up, in meters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The vertices; two that differ in their normal or texture coordinates alone are two.
    pub vertices: Vec<Vertex>,
    /// The corners of each triangle as indices of vertices, counter-clockwise as seen from the front. A triangle's index
    /// is its number in the file.
    pub triangles: Vec<[u32; 3]>,
    /// The first triangle with a corner that has no texture coordinates.
    pub without_uv: Option<usize>,
    /// How many triangles have no area, and so are never seen.
    pub degenerate: usize,
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

    /// The memory that it takes.
    pub fn bytes(&self) -> u64 {
        (size_of_val(&self.vertices[..]) + size_of_val(&self.triangles[..])) as u64
    }
}
