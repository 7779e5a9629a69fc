//! How a mesh is made from what a file lists: corners become vertices, and vertices get the normals that they lack.

use glam::{DVec2, DVec3};

use super::normals::{angles, facing, groups};
use super::{Mesh, Vertex};
use crate::base::budget::{Budget, Share};
use crate::base::error::{Error, Result};

/// How much of each a mesh is made from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Positions, each listed once.
    pub positions: u64,
    /// Normals.
    pub normals: u64,
    /// Texture coordinates.
    pub uvs: u64,
    /// Corners of polygons.
    pub corners: u64,
    /// Triangles that the polygons are cut into.
    pub triangles: u64,
}

impl Counts {
    /// Both together; what is more than 64 bits count is as much as they can.
    pub fn and(self, more: Counts) -> Counts {
        Counts {
            positions: self.positions.saturating_add(more.positions),
            normals: self.normals.saturating_add(more.normals),
            uvs: self.uvs.saturating_add(more.uvs),
            corners: self.corners.saturating_add(more.corners),
            triangles: self.triangles.saturating_add(more.triangles),
        }
    }
}

/// A corner of a polygon: indices into the lists of a [`Builder`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corner {
    /// Where it is.
    pub position: u32,
    /// Its texture coordinates.
    pub uv: Option<u32>,
    /// Its normal.
    pub normal: Option<u32>,
}

/// A mesh in the making: first the lists, then the polygons over them.
#[derive(Debug)]
pub struct Builder {
    /// Positions; all numbers are finite.
    pub positions: Vec<DVec3>,
    /// Normals of length 1, as `unit` makes them; one of zero counts as not named.
    pub normals: Vec<DVec3>,
    /// Texture coordinates.
    pub uvs: Vec<DVec2>,
    /// The newest vertex at each position, from which the chain of the others begins.
    newest: Vec<u32>,
    chain: Vec<Link>,
    triangles: Vec<[u32; 3]>,
    place: String,
    budget: Budget,
    share: Share,
}

/// A vertex in the making: its corner, and the next older vertex at the same position.
#[derive(Clone, Copy, Debug)]
struct Link {
    position: u32,
    uv: u32,
    normal: u32,
    older: u32,
}

/// In place of an index: there is none.
const NONE: u32 = u32::MAX;

/// How many vertices at one position are compared before a new one is made: a file whose corners all meet in one point
/// must not take for ever. More of them than needed change nothing that is seen.
const COMPARED: usize = 64;

impl Builder {
    /// Takes the memory for a mesh of this size; `place` is its file, in messages.
    ///
    /// # Errors
    /// If it is more than `budget` has, or than 32 bits can number.
    pub fn new(counts: Counts, place: &str, budget: &Budget) -> Result<Builder> {
        let Counts { positions, normals, uvs, corners, triangles } = counts;
        if [positions, normals, uvs, corners, triangles].iter().any(|&count| count >= u64::from(NONE)) {
            return Err(Error::at(place, format!("has too many vertices: {NONE} or more")).cure("make it simpler"));
        }
        let of = |count: u64, size: usize| count * size as u64;
        let lists = of(positions + normals, size_of::<DVec3>()) + of(uvs, size_of::<DVec2>());
        let joined = of(positions, size_of::<u32>()) + of(corners, size_of::<Link>());
        let share = budget.take(lists + joined + of(triangles, size_of::<[u32; 3]>()), place)?;
        Ok(Builder {
            positions: Vec::with_capacity(positions as usize),
            normals: Vec::with_capacity(normals as usize),
            uvs: Vec::with_capacity(uvs as usize),
            newest: vec![NONE; positions as usize],
            chain: Vec::with_capacity(corners as usize),
            triangles: Vec::with_capacity(triangles as usize),
            place: place.to_owned(),
            budget: budget.clone(),
            share,
        })
    }

    /// Adds a polygon, cut into triangles that fan out from its first corner. Its normals are those of the file only if
    /// every corner names one. The corners are indices of what is in the lists already.
    pub fn polygon(&mut self, corners: &[Corner]) {
        let named = |corner: &Corner| corner.normal.is_some_and(|normal| self.normals[normal as usize] != DVec3::ZERO);
        let own = corners.iter().all(named);
        let [first, second, rest @ ..] = corners else { return };
        let first = self.vertex(*first, own);
        let mut last = self.vertex(*second, own);
        for corner in rest {
            let next = self.vertex(*corner, own);
            self.triangles.push([first, last, next]);
            last = next;
        }
    }

    /// The vertex for a corner, with the normal that it names or without one.
    fn vertex(&mut self, corner: Corner, own: bool) -> u32 {
        let Corner { position, uv, normal } = corner;
        let (uv, normal) = (uv.unwrap_or(NONE), normal.filter(|_| own).unwrap_or(NONE));
        let newest = self.newest[position as usize];
        let mut at = newest;
        for _ in 0..COMPARED {
            let Some(link) = self.chain.get(at as usize) else { break };
            if (link.uv, link.normal) == (uv, normal) {
                return at;
            }
            at = link.older;
        }
        let vertex = self.chain.len() as u32;
        self.chain.push(Link { position, uv, normal, older: newest });
        self.newest[position as usize] = vertex;
        vertex
    }

    /// The mesh, and the memory that it takes. Normals that the file does not give are the mean of those of all faces at
    /// the position, each weighted by its angle there.
    ///
    /// # Errors
    /// If it takes more memory than there is.
    pub fn finish(mut self) -> Result<(Mesh, Share)> {
        // Few corners are vertices of their own.
        self.newest = Vec::new();
        self.chain.shrink_to_fit();
        self.share.shrink(self.bytes());
        let computed = self.chain.iter().any(|link| link.normal == NONE);
        let vertices = size_of::<Vertex>() * self.chain.len();
        let group = size_of::<(f64, u32)>() + 2 * size_of::<u32>();
        let grouping = if computed { group * self.positions.len() } else { 0 };
        let more = self.budget.take((vertices + grouping) as u64, &self.place)?;
        let groups = computed.then(|| groups(&self.positions));
        let vertex = |link: &Link| Vertex {
            position: self.positions[link.position as usize],
            normal: self.normals.get(link.normal as usize).copied().unwrap_or_default(),
            uv: self.uvs.get(link.uv as usize).copied().unwrap_or_default(),
        };
        let mut vertices: Vec<Vertex> = self.chain.iter().map(vertex).collect();
        if let Some(groups) = groups {
            self.compute_normals(groups, &mut vertices);
        }
        let without_uv = |corners: &[u32; 3]| corners.iter().any(|&at| self.chain[at as usize].uv == NONE);
        let without_uv = self.triangles.iter().position(without_uv);
        let degenerate = self.triangles.iter().filter(|corners| facing(self.places(corners)).is_none()).count();
        let mut mesh = Mesh { vertices, triangles: self.triangles, without_uv, degenerate, ..Mesh::default() };
        mesh.inside_out = mesh.is_inside_out();
        let mut share = self.share.and(more);
        share.shrink(mesh.bytes());
        Ok((mesh, share))
    }

    /// The memory that it takes without what finds vertices.
    fn bytes(&self) -> u64 {
        let lists = size_of_val(&self.positions[..]) + size_of_val(&self.normals[..]) + size_of_val(&self.uvs[..]);
        (lists + size_of_val(&self.chain[..]) + size_of_val(&self.triangles[..])) as u64
    }

    /// Gives vertices the normals that they lack; of each position the group is known, and how many there are. Sums are in the
    /// order of the file, so that the bits are the same everywhere.
    fn compute_normals(&self, (groups, count): (Vec<u32>, usize), vertices: &mut [Vertex]) {
        let group = |vertex: usize| groups[self.chain[vertex].position as usize] as usize;
        let lack = || self.chain.iter().enumerate().filter(|(_, link)| link.normal == NONE).map(|(at, _)| at);
        // The first of each group that lacks one is where its sum is made: no list of them is needed.
        let mut first = vec![NONE; count];
        lack().for_each(|at| first[group(at)] = first[group(at)].min(at as u32));
        for corners in &self.triangles {
            let places = self.places(corners);
            let Some(normal) = facing(places) else { continue };
            for (corner, angle) in corners.iter().zip(angles(places)) {
                if let Some(sum) = vertices.get_mut(first[group(*corner as usize)] as usize) {
                    sum.normal += normal * angle;
                }
            }
        }
        for at in lack() {
            let first = first[group(at)] as usize;
            // The first is the first to come here.
            let sum = vertices[first].normal;
            vertices[at].normal = if at == first { sum.try_normalize().unwrap_or(DVec3::Y) } else { sum };
        }
    }

    fn places(&self, corners: &[u32; 3]) -> [DVec3; 3] {
        corners.map(|corner| self.positions[self.chain[corner as usize].position as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::super::normals::unit;
    use super::*;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    type Polygon<'a> = &'a [(u32, Option<u32>, Option<u32>)];

    fn mesh(positions: &[[f64; 3]], normals: &[[f64; 3]], uvs: &[[f64; 2]], polygons: &[Polygon]) -> Mesh {
        let counts = Counts {
            positions: positions.len() as u64,
            normals: normals.len() as u64,
            uvs: uvs.len() as u64,
            corners: polygons.iter().map(|polygon| polygon.len() as u64).sum(),
            triangles: polygons.iter().map(|polygon| polygon.len() as u64 - 2).sum(),
        };
        let budget = Budget::new(1 << 20);
        let mut builder = Builder::new(counts, "a mesh", &budget).unwrap();
        builder.positions.extend(positions.iter().copied().map(DVec3::from_array));
        builder.normals.extend(normals.iter().copied().map(|normal| unit(DVec3::from_array(normal))));
        builder.uvs.extend(uvs.iter().copied().map(DVec2::from_array));
        for polygon in polygons {
            let corner = |&(position, uv, normal): &(u32, Option<u32>, Option<u32>)| Corner { position, uv, normal };
            builder.polygon(&polygon.iter().map(corner).collect::<Vec<_>>());
        }
        let (mesh, share) = builder.finish().unwrap();
        assert_eq!(budget.taken(), mesh.bytes(), "what was needed on the way is given back");
        drop(share);
        mesh
    }

    fn bare(corners: &[u32]) -> Vec<(u32, Option<u32>, Option<u32>)> {
        corners.iter().map(|&position| (position, None, None)).collect()
    }

    fn close(found: DVec3, expected: DVec3) -> bool {
        found.abs_diff_eq(expected.normalize(), 1e-14)
    }

    #[test]
    fn the_normals_of_a_cube_are_its_diagonals() {
        let positions: Vec<[f64; 3]> =
            (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2 & 1].map(|bit| f64::from(bit) * 2.0 - 1.0)).collect();
        let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let sides: Vec<_> = sides.iter().map(|side| bare(side)).collect();
        let mesh = mesh(&positions, &[], &[], &sides.iter().map(|side| &side[..]).collect::<Vec<_>>());
        assert_eq!((mesh.vertices.len(), mesh.triangles.len()), (8, 12));
        assert_eq!((mesh.degenerate, mesh.without_uv), (0, Some(0)));
        assert_eq!(mesh.triangles[..2], [[0, 1, 2], [0, 2, 3]], "a polygon is a fan");
        for vertex in &mesh.vertices {
            assert!(close(vertex.normal, vertex.position), "{vertex:?}");
        }
        assert_eq!(mesh.bounds(), Some((DVec3::NEG_ONE, DVec3::ONE)));
        assert_eq!(mesh.bytes(), 8 * 64 + 12 * 12);
    }

    #[test]
    fn a_mesh_turned_inside_out_is_known_also_with_holes() {
        let corners: Vec<[f64; 3]> =
            (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2 & 1].map(|bit| 100.0 + f64::from(bit))).collect();
        let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let turned = |side: &[u32; 4]| bare(&[side[0], side[3], side[2], side[1]]);
        for (kept, inside_out) in [(6, true), (5, true), (4, true), (2, true), (1, false)] {
            let of =
                |sides: Vec<Vec<_>>| mesh(&corners, &[], &[], &sides.iter().map(|side| &side[..]).collect::<Vec<_>>());
            assert_eq!(of(sides[..kept].iter().map(turned).collect()).inside_out, inside_out, "{kept} sides");
            assert!(!of(sides[..kept].iter().map(|side| bare(side)).collect()).inside_out, "{kept} sides");
        }
    }

    #[test]
    fn normals_are_weighted_by_angles() {
        // At the origin one face up with a right angle, and one to the left with half of it, twice as large.
        let positions = [[0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 4.0, 4.0], [0.0, 0.0, 4.0]];
        let mesh = mesh(&positions, &[], &[], &[&bare(&[0, 1, 2]), &bare(&[0, 4, 3])]);
        assert!(close(mesh.vertices[0].normal, DVec3::new(-FRAC_PI_4, FRAC_PI_2, 0.0)), "{:?}", mesh.vertices[0]);
        assert!(close(mesh.vertices[1].normal, DVec3::Y));
    }

    #[test]
    fn positions_that_are_equal_as_numbers_share_their_normal() {
        let positions = [
            [0.0, 0.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 0.0],
            // The same corner with other signs, for a face to the left.
            [-0.0, 0.0, -0.0],
            [0.0, -0.0, 1.0],
            [0.0, 1.0, 0.0],
        ];
        let mesh = mesh(&positions, &[], &[], &[&bare(&[0, 1, 2]), &bare(&[3, 4, 5])]);
        assert_eq!(mesh.vertices.len(), 6);
        for at in [0, 3] {
            assert!(close(mesh.vertices[at].normal, DVec3::new(-1.0, 1.0, 0.0)), "{:?}", mesh.vertices[at]);
        }
    }

    #[test]
    fn faces_without_area_keep_their_numbers_and_count_nothing() {
        let positions =
            [[0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [9.0, 9.0, 9.0], [1e300, 0.0, 0.0]];
        let faces = [bare(&[0, 2, 3]), bare(&[0, 1, 2]), bare(&[0, 0, 1]), bare(&[4, 4, 4])];
        let mesh = mesh(&positions, &[], &[], &faces.iter().map(|face| &face[..]).collect::<Vec<_>>());
        assert_eq!((mesh.triangles.len(), mesh.degenerate), (4, 3));
        let at = |corner: usize, triangle: usize| mesh.vertices[mesh.triangles[triangle][corner] as usize];
        assert!(close(at(0, 1).normal, DVec3::Y));
        assert_eq!(at(0, 3).normal, DVec3::Y, "some normal where no face has an area");
        assert_eq!(mesh.bounds(), Some((DVec3::ZERO, DVec3::splat(9.0))), "what no triangle uses does not count");
    }

    #[test]
    fn the_largest_and_the_smallest_triangles_have_an_area() {
        for corners in [
            [[0.0; 3], [0.0, 0.0, 1e300], [1.0, 0.0, 0.0]],
            [[0.0; 3], [0.0, 0.0, 1e300], [1e300, 0.0, 0.0]],
            [[-f64::MAX, 0.0, 0.0], [0.0, 0.0, f64::MAX], [f64::MAX, 0.0, 0.0]],
            [[0.0; 3], [0.0, 0.0, 1e-300], [1e-300, 0.0, 0.0]],
            [[0.0; 3], [0.0, 0.0, 1e-200], [1.0, 0.0, 1e-200]],
        ] {
            let mesh = mesh(&corners, &[], &[], &[&bare(&[0, 1, 2])]);
            assert_eq!(mesh.degenerate, 0, "{corners:?}");
            assert!(mesh.vertices.iter().all(|vertex| close(vertex.normal, DVec3::Y)), "{corners:?}: {mesh:?}");
            let angles = angles(corners.map(DVec3::from_array));
            assert!((angles.iter().sum::<f64>() - 2.0 * FRAC_PI_2).abs() < 1e-7, "{corners:?}: {angles:?}");
        }
    }

    #[test]
    fn normals_of_the_file_need_all_corners_and_a_length() {
        let positions = [[0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [1.0, 0.0, 1.0]];
        let normals = [[3.0, 0.0, 4.0], [0.0; 3], [-1e-200, 0.0, 0.0]];
        let named = |normals: [Option<u32>; 3]| [0, 1, 2].map(|at| (at as u32, None, normals[at]));
        for (face, own) in [
            ([Some(0); 3], true),
            ([Some(0), Some(0), None], false),
            ([Some(0), Some(1), Some(0)], false),
            ([Some(0), Some(2), Some(0)], false),
        ] {
            let mesh = mesh(&positions, &normals, &[], &[&named(face)]);
            let expected = if own { DVec3::new(0.6, 0.0, 0.8) } else { DVec3::Y };
            assert!(mesh.vertices.iter().all(|vertex| close(vertex.normal, expected)), "{face:?}: {mesh:?}");
        }
    }

    #[test]
    fn equal_corners_are_one_vertex() {
        let positions = [[0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [1.0, 0.0, 1.0]];
        let uvs = [[0.0, 0.0], [0.5, 1.0]];
        let [a, b] = [Some(0), Some(1)];
        let faces: [Polygon; 3] = [
            &[(0, a, None), (1, a, None), (2, a, None)],
            &[(1, a, None), (3, a, None), (2, b, None)],
            &[(0, a, None), (1, None, None), (2, b, None)],
        ];
        let mesh = mesh(&positions, &[], &uvs, &faces);
        assert_eq!(mesh.triangles, [[0, 1, 2], [1, 3, 4], [0, 5, 4]]);
        assert_eq!((mesh.vertices[4].uv, mesh.vertices[5].uv), (DVec2::new(0.5, 1.0), DVec2::ZERO));
        assert_eq!(mesh.without_uv, Some(2));
    }

    #[test]
    fn many_vertices_at_one_position_do_not_take_for_ever() {
        const MANY: u32 = 200_000;
        let uvs: Vec<[f64; 2]> = (0..MANY).map(|i| [f64::from(i), 0.0]).collect();
        let faces: Vec<_> = (0..MANY).map(|i| [(0, Some(i), None), (1, Some(0), None), (2, Some(0), None)]).collect();
        let counts = Counts { positions: 3, uvs: uvs.len() as u64, corners: 600_000, triangles: 200_000, normals: 0 };
        let mut builder = Builder::new(counts, "a mesh", &Budget::default()).unwrap();
        builder.positions.extend([DVec3::ZERO, DVec3::Z, DVec3::X]);
        builder.uvs.extend(uvs.into_iter().map(DVec2::from_array));
        for face in &faces {
            builder.polygon(&face.map(|(position, uv, normal)| Corner { position, uv, normal }));
        }
        assert_eq!(builder.finish().unwrap().0.vertices.len(), MANY as usize + 2);
    }

    #[test]
    fn memory_is_asked_for_before_it_is_taken() {
        let counts = Counts { positions: 1 << 30, ..Counts::default() };
        let error = Builder::new(counts, "a.obj", &Budget::new(1 << 30)).unwrap_err().to_string();
        assert!(error.starts_with("a.obj: needs 28 GiB of memory"), "{error}");
        let counts = Counts { triangles: u64::MAX, ..counts };
        let error = Builder::new(counts, "a.obj", &Budget::default()).unwrap_err().to_string();
        assert!(error.starts_with("a.obj: has too many"), "{error}");
    }
}
