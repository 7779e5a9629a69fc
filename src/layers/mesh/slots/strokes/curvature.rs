//! How a mesh is curved: a symmetric tensor at each vertex, in the model. In each face the second fundamental form that
//! fits the turn of the normals along its edges best (Rusinkiewicz 2004, "Estimating Curvatures and Their Derivatives on
//! Triangle Meshes"); a vertex has the mean of its faces, smoothed.

use std::collections::HashMap;

use glam::{DMat3, DVec3};

use crate::base::maths;
use crate::base::mesh::Mesh;

/// The most rounds of smoothing.
const MOST_ROUNDS: f64 = 256.0;

/// The tensors of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curvature {
    /// One for each vertex.
    pub tensors: Vec<DMat3>,
    /// Half the diagonal of the mesh's box, in meters.
    pub half_m: f64,
}

/// Vertices at one place are one here, whatever their texture coordinates and normals.
struct Welded {
    /// The place of each vertex.
    place: Vec<u32>,
    at: Vec<DVec3>,
    /// The triangles that have an area, by places.
    faces: Vec<[u32; 3]>,
}

impl Welded {
    fn new(mesh: &Mesh) -> Welded {
        let mut known: HashMap<[u64; 3], u32> = HashMap::new();
        let mut at = Vec::new();
        let place = mesh.vertices.iter().map(|vertex| {
            // Adding 0 turns -0 into 0.
            let key = (vertex.position + 0.0).to_array().map(f64::to_bits);
            *known.entry(key).or_insert_with(|| {
                at.push(vertex.position);
                (at.len() - 1) as u32
            })
        });
        let place: Vec<u32> = place.collect();
        let faces = mesh.triangles.iter().map(|corners| corners.map(|vertex| place[vertex as usize]));
        let area = |[a, b, c]: &[u32; 3]| {
            let [a, b, c] = [a, b, c].map(|i| at[*i as usize]);
            (b - a).cross(c - a).length_squared() > 0.0
        };
        let faces = faces.filter(area).collect();
        Welded { place, at, faces }
    }

    fn corners(&self, face: &[u32; 3]) -> [DVec3; 3] {
        face.map(|place| self.at[place as usize])
    }

    /// The normals at the places: those of the faces, each weighted by its angle there.
    fn normals(&self) -> Vec<DVec3> {
        let mut sums = vec![DVec3::ZERO; self.at.len()];
        for face in &self.faces {
            let corners = self.corners(face);
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
            for k in 0..3 {
                let way = |to: usize| (corners[(k + to) % 3] - corners[k]).normalize_or_zero();
                sums[face[k] as usize] += normal * maths::acos(way(1).dot(way(2)).clamp(-1.0, 1.0));
            }
        }
        sums.into_iter().map(|sum| sum.try_normalize().unwrap_or(DVec3::Y)).collect()
    }

    /// The neighbors of each place along edges, ascending.
    fn neighbors(&self) -> Vec<Vec<u32>> {
        let mut neighbors = vec![Vec::new(); self.at.len()];
        for face in &self.faces {
            for k in 0..3 {
                let (from, to) = (face[k], face[(k + 1) % 3]);
                neighbors[from as usize].push(to);
                neighbors[to as usize].push(from);
            }
        }
        for own in &mut neighbors {
            own.sort_unstable();
            own.dedup();
        }
        neighbors
    }

    fn mean_edge(&self) -> f64 {
        let lengths = self.neighbors().into_iter().enumerate().flat_map(|(from, to)| {
            to.into_iter().filter(move |to| *to as usize > from).map(move |to| (from, to as usize))
        });
        let (sum, count) =
            lengths.fold((0.0, 0.0), |(sum, count), (a, b)| (sum + self.at[a].distance(self.at[b]), count + 1.0));
        if count > 0.0 { sum / count } else { 1.0 }
    }
}

impl Curvature {
    /// Of a mesh, smoothed over this share of half its size.
    pub fn new(mesh: &Mesh, smooth: f64) -> Curvature {
        let Some((least, most)) = mesh.bounds() else { return Curvature::default() };
        let half_m = (most - least).length() / 2.0;
        let welded = Welded::new(mesh);
        let normals = welded.normals();
        let (mut sums, mut areas) = (vec![DMat3::ZERO; welded.at.len()], vec![0.0; welded.at.len()]);
        for face in &welded.faces {
            let corners = welded.corners(face);
            let area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).length() / 2.0;
            let Some(tensor) = of_face(corners, face.map(|place| normals[place as usize])) else { continue };
            for place in face {
                sums[*place as usize] += tensor * area;
                areas[*place as usize] += area;
            }
        }
        let flat = |tensor: DMat3, normal: DVec3| {
            let across = DMat3::IDENTITY - outer(normal, normal);
            across * tensor * across
        };
        let mut tensors: Vec<DMat3> = (0..sums.len())
            .map(|i| if areas[i] > 0.0 { flat(sums[i] * (1.0 / areas[i]), normals[i]) } else { DMat3::ZERO })
            .collect();
        let reach = smooth * half_m / welded.mean_edge();
        let rounds = (reach * reach).ceil().min(MOST_ROUNDS) as usize;
        let neighbors = welded.neighbors();
        for _ in 0..rounds {
            let smoothed = |i: usize| {
                let (mut sum, mut weight) = (tensors[i] * areas[i], areas[i]);
                for &other in &neighbors[i] {
                    sum += tensors[other as usize] * areas[other as usize];
                    weight += areas[other as usize];
                }
                if weight > 0.0 { flat(sum * (1.0 / weight), normals[i]) } else { DMat3::ZERO }
            };
            tensors = (0..tensors.len()).map(smoothed).collect();
        }
        Curvature { tensors: welded.place.iter().map(|place| tensors[*place as usize]).collect(), half_m }
    }
}

fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// The second fundamental form of a face by the normals at its corners, as a tensor of the model: least squares over the
/// three edges.
fn of_face(corners: [DVec3; 3], normals: [DVec3; 3]) -> Option<DMat3> {
    let one = (corners[1] - corners[0]).try_normalize()?;
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).try_normalize()?;
    let two = normal.cross(one);
    // Unknown are the entries 11, 12 and 22; each edge says how the normal turns along it, in both directions.
    let (mut matrix, mut right) = (DMat3::ZERO, DVec3::ZERO);
    for k in 0..3 {
        let (edge, turn) = (corners[(k + 1) % 3] - corners[k], normals[(k + 1) % 3] - normals[k]);
        let (u, v) = (edge.dot(one), edge.dot(two));
        for (row, value) in [(DVec3::new(u, v, 0.0), turn.dot(one)), (DVec3::new(0.0, u, v), turn.dot(two))] {
            matrix += outer(row, row);
            right += row * value;
        }
    }
    let found = matrix.inverse() * right;
    let mixed = outer(one, two) + outer(two, one);
    found.is_finite().then(|| outer(one, one) * found.x + mixed * found.y + outer(two, two) * found.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::mesh::Vertex;

    /// A surface over a grid, with its seams: each quad has its own vertices.
    fn grid(n: usize, at: impl Fn(f64, f64) -> DVec3) -> Mesh {
        let mut mesh = Mesh::default();
        for j in 0..n {
            for i in 0..n {
                let first = mesh.vertices.len() as u32;
                for (x, y) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                    let position = at((i + x) as f64 / n as f64, (j + y) as f64 / n as f64);
                    mesh.vertices.push(Vertex { position, ..Vertex::default() });
                }
                mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
            }
        }
        mesh
    }

    #[test]
    fn a_cylinder_is_curved_around_its_axis_alone() {
        let radius = 2.0;
        let mesh = grid(24, |u, v| {
            let angle = 3.0 * u;
            DVec3::new(radius * maths::sin(angle), 3.0 * v, radius * maths::cos(angle))
        });
        let found = Curvature::new(&mesh, 0.0);
        let middle = mesh.vertices.iter().position(|vertex| {
            (vertex.position.y - 1.5).abs() < 1e-9
                && (maths::atan2(vertex.position.x, vertex.position.z) - 1.5).abs() < 1e-9
        });
        let (i, tensor) = (middle.unwrap(), found.tensors[middle.unwrap()]);
        let normal = DVec3::new(mesh.vertices[i].position.x, 0.0, mesh.vertices[i].position.z).normalize();
        let around = DVec3::Y.cross(normal);
        assert!((around.dot(tensor * around) - 1.0 / radius).abs() < 0.01, "{tensor}");
        assert!(DVec3::Y.dot(tensor * DVec3::Y).abs() < 0.01 && (tensor * normal).length() < 1e-9, "{tensor}");
    }

    #[test]
    fn smoothing_keeps_a_sphere_and_a_plane() {
        let sphere = grid(16, |u, v| {
            let (a, b) = (0.4 + 2.2 * u, 0.4 + 2.2 * v);
            DVec3::new(maths::cos(a) * maths::sin(b), maths::cos(b), maths::sin(a) * maths::sin(b)) * -1.0
        });
        let found = Curvature::new(&sphere, 0.08);
        let middle = found.tensors[4 * (8 * 16 + 8)];
        let squares: f64 = middle.to_cols_array().iter().map(|v| v * v).sum();
        assert!((squares - 2.0).abs() < 0.1, "{squares}");
        let plane = Curvature::new(&grid(4, |u, v| DVec3::new(u, v, 0.0)), 0.08);
        assert!(plane.tensors.iter().all(|tensor| tensor.to_cols_array().iter().all(|v| v.abs() < 1e-12)));
    }
}
