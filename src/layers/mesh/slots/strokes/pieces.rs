//! The pieces of triangles that impulses are counted in. A large triangle is halved until no piece is long, once, on the
//! model: splitting by what is seen would draw other impulses in every frame.

use glam::DVec3;
use rayon::prelude::*;

use crate::base::mesh::Mesh;

/// A piece has no edge longer than this share of the diagonal of the mesh's box.
const LONGEST: f64 = 1.0 / 32.0;
/// Lengths that differ by less than this share are the same, squared.
const SAME: f64 = 1e-9;

/// A part of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// The triangle.
    pub triangle: u32,
    /// Its number in the triangle: 1 is the whole, 2p and 2p + 1 are the halves of p.
    pub number: u32,
    /// Its corners as weights of the triangle's.
    pub corners: [DVec3; 3],
    /// Its share of the triangle's area.
    pub share: f64,
}

impl Piece {
    /// The whole of a triangle.
    fn whole(triangle: u32) -> Piece {
        Piece { triangle, number: 1, corners: [DVec3::X, DVec3::Y, DVec3::Z], share: 1.0 }
    }

    /// The halves, the edge from corner k to the next being cut in its middle.
    fn halves(&self, k: usize) -> [Piece; 2] {
        let next = (k + 1) % 3;
        let middle = (self.corners[k] + self.corners[next]) / 2.0;
        let half = |add: u32, replaced: usize| {
            let mut corners = self.corners;
            corners[replaced] = middle;
            Piece { number: 2 * self.number + add, corners, share: self.share / 2.0, ..*self }
        };
        [half(0, next), half(1, k)]
    }
}

/// The pieces of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pieces {
    /// Those of triangles that are halved, by triangle, then number.
    halved: Vec<Piece>,
    triangles: u32,
    count: usize,
}

impl Pieces {
    /// Halves the triangles of a mesh.
    pub fn new(mesh: &Mesh) -> Pieces {
        let Some((least, most)) = mesh.bounds() else { return Pieces::default() };
        let limit = (most - least).length_squared() * LONGEST * LONGEST;
        let triangles = mesh.triangles.par_iter().enumerate();
        let halved = triangles.flat_map_iter(|(i, triangle)| {
            let corners = triangle.map(|vertex| mesh.vertices[vertex as usize].position);
            let mut found = Vec::new();
            halve(Piece::whole(i as u32), corners, limit, &mut found);
            found.sort_unstable_by_key(|piece: &Piece| piece.number);
            if found.len() > 1 { found } else { Vec::new() }
        });
        let (halved, triangles): (Vec<Piece>, usize) = (halved.collect(), mesh.triangles.len());
        let whole = triangles - halved.chunk_by(|one, next| one.triangle == next.triangle).count();
        Pieces { count: whole + halved.len(), halved, triangles: triangles as u32 }
    }

    /// How many triangles the mesh has.
    pub fn triangles(&self) -> u32 {
        self.triangles
    }

    /// How many pieces they have.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Calls `each` with the pieces of the triangles `from..to`, in order.
    pub fn of(&self, triangles: std::ops::Range<u32>, mut each: impl FnMut(&Piece)) {
        let mut next = self.halved.partition_point(|piece| piece.triangle < triangles.start);
        for triangle in triangles {
            if self.halved.get(next).is_none_or(|piece| piece.triangle != triangle) {
                each(&Piece::whole(triangle));
            }
            while let Some(piece) = self.halved.get(next).filter(|piece| piece.triangle == triangle) {
                each(piece);
                next += 1;
            }
        }
    }
}

/// Halves a piece until none of its edges is longer than the root of `limit`.
fn halve(piece: Piece, corners: [DVec3; 3], limit: f64, found: &mut Vec<Piece>) {
    let at = piece.corners.map(|weights| corners[0] * weights.x + corners[1] * weights.y + corners[2] * weights.z);
    let squares = [0, 1, 2].map(|k| (at[(k + 1) % 3] - at[k]).length_squared());
    let longest = squares.into_iter().fold(0.0, f64::max);
    if longest <= limit * (1.0 + SAME) || !longest.is_finite() {
        found.push(piece);
        return;
    }
    let k = squares.iter().position(|square| *square >= longest * (1.0 - SAME)).unwrap_or(0);
    piece.halves(k).into_iter().for_each(|half| halve(half, corners, limit, found));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::mesh::Vertex;

    fn mesh(corners: &[[f64; 3]], triangles: &[[u32; 3]]) -> Mesh {
        let vertices = corners.iter().map(|&at| Vertex { position: at.into(), ..Vertex::default() }).collect();
        Mesh { vertices, triangles: triangles.to_vec(), ..Mesh::default() }
    }

    fn all(mesh: &Mesh) -> Vec<Piece> {
        let mut all = Vec::new();
        Pieces::new(mesh).of(0..mesh.triangles.len() as u32, |piece| all.push(*piece));
        all
    }

    #[test]
    fn pieces_are_short_and_make_up_the_triangle() {
        let square = mesh(&[[0., 0., 0.], [4., 0., 0.], [4., 4., 0.], [0., 4., 0.]], &[[0, 1, 2], [0, 2, 3]]);
        let found = all(&square);
        for triangle in [0, 1] {
            let own: Vec<&Piece> = found.iter().filter(|piece| piece.triangle == triangle).collect();
            assert!((own.iter().map(|piece| piece.share).sum::<f64>() - 1.0).abs() < 1e-12);
            assert!(own.windows(2).all(|pair| pair[0].number < pair[1].number), "in order");
            assert_eq!(own.len(), 1024);
        }
        // The first cut is that of the diagonal.
        let [first, second] = Piece::whole(0).halves(2);
        assert_eq!((first.number, first.corners[0]), (2, DVec3::new(0.5, 0.0, 0.5)));
        assert_eq!((second.number, second.corners[2]), (3, DVec3::new(0.5, 0.0, 0.5)));
    }

    #[test]
    fn small_triangles_are_whole_beside_large_ones() {
        let found = all(&mesh(
            &[[0., 0., 0.], [0.01, 0., 0.], [0., 0.01, 0.], [1., 0., 0.], [0., 1., 0.]],
            &[[0, 1, 2], [0, 3, 4], [0, 2, 1]],
        ));
        let of = |triangle: u32| found.iter().filter(|piece| piece.triangle == triangle).count();
        assert_eq!((of(0), of(2)), (1, 1));
        assert!(of(1) > 100 && found.is_sorted_by_key(|piece| (piece.triangle, piece.number)));
    }
}
