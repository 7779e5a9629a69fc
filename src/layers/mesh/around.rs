//! A mesh seen from around as it is at one time: pictures with cameras that together show its surface.

use glam::DVec3;

use super::frame::MeshAt;
use super::pose::{Bend, Pose};
use super::synth::Synth;
use crate::base::maths;
use crate::base::mesh::Mesh;
use crate::base::pixels::Linear;
use crate::base::progress::Watch;
use crate::base::{geometry, number};
use crate::layers::parts::moment::Moment;
use crate::layers::parts::shots::{SeenFrom, Taken};
use crate::layers::space::eye::Eye;
use crate::layers::space::fit::fit;

/// Where one stands: before the sides of a cube, then before its corners.
const WAYS: [(&str, [f64; 3]); 14] = [
    ("front", [0.0, 0.0, 1.0]),
    ("right", [1.0, 0.0, 0.0]),
    ("back", [0.0, 0.0, -1.0]),
    ("left", [-1.0, 0.0, 0.0]),
    ("above", [0.0, 1.0, 0.0]),
    ("below", [0.0, -1.0, 0.0]),
    ("above-front-right", [1.0, 1.0, 1.0]),
    ("above-back-right", [1.0, 1.0, -1.0]),
    ("above-back-left", [-1.0, 1.0, -1.0]),
    ("above-front-left", [-1.0, 1.0, 1.0]),
    ("below-front-right", [1.0, -1.0, 1.0]),
    ("below-back-right", [1.0, -1.0, -1.0]),
    ("below-back-left", [-1.0, -1.0, -1.0]),
    ("below-front-left", [-1.0, -1.0, 1.0]),
];
/// The vertical field of view, in degrees.
const FOV: f64 = 30.0;
/// Cells side by side in a unit of the atlas, on the finest layer that a view map has by itself; the surface fills half of a square unit.
const CELLS: f64 = 1024.0;
/// How many pixels the side of a picture has at least.
const LEAST_SIDE: usize = 64;
/// So many units of the last decimal the distance is at least.
const UNITS: f64 = 1e5;

/// What is seen of a mesh at scene time `t`, unbent and without strokes, but in the light that falls on it in its pose: pictures
/// of so many pixels a side at most, in the model's coordinates. One that shows nothing is left out. Each is one piece of work.
pub fn around(synth: &Synth, t: f64, most_px: usize, watch: &Watch) -> Vec<Taken> {
    let pose = Pose { bend: Bend::default(), ..synth.pose.clone() };
    let own = Synth { pose, strokes: None, ..synth.clone() };
    let unseen = Moment { t, size_px: (most_px, most_px), eye: None, left_out: 0, magnified: 1 };
    let placed = own.pose.at(own.time(&unseen));
    let cell = cell(&own.mesh);
    let ways = WAYS.into_iter().enumerate().take_while(|_| !(watch.stopped)());
    let taken = ways.filter_map(|(number, (name, back))| {
        let back = DVec3::from(back).normalize_or_zero();
        let up = if back.y.abs() < 1.0 { DVec3::Y } else { DVec3::Z };
        let [position, target] = fit(&|ways| own.mesh.reach(ways), [back, up], FOV, unseen.size_px)?;
        // Without decimals that do not matter at this distance.
        let decimals = number::decimals(position.distance(target), UNITS);
        let [position, target] = [position, target].map(|at| geometry::rounded(at, decimals));
        let side_px = side(nearest(&own.mesh, [position, target]), cell).clamp(LEAST_SIDE.min(most_px), most_px);
        let size_px = (side_px, side_px);
        let world = |at| placed.point(at, DVec3::ZERO).0;
        let eye = Eye::new([world(position), world(target), placed.turn * up], FOV, size_px);
        let moment = Moment { eye: Some(eye), size_px, ..unseen };
        let picture = Linear::from_cells(side_px, side_px, MeshAt::new(&own, &moment).bare());
        (watch.done)(number);
        let up = Some(up).filter(|up| *up != DVec3::Y);
        Some(Taken { name, from: SeenFrom::Standing { position, target, up, fov: Some(FOV) }, picture })
    });
    taken.filter(|taken| taken.picture.cells().iter().any(|cell| cell[3] > 0.0)).collect()
}

/// How large a cell of a view map is on the surface, on its finest layer.
fn cell(mesh: &Mesh) -> f64 {
    let area = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| mesh.vertices[corner as usize].position);
        (b - a).cross(c - a).length() / 2.0
    };
    (2.0 * mesh.triangles.iter().map(area).sum::<f64>()).sqrt() / CELLS
}

/// How far what is nearest of a mesh is, by how far one looks along the way to the target.
fn nearest(mesh: &Mesh, [position, target]: [DVec3; 2]) -> f64 {
    let forward = (target - position).normalize_or_zero();
    mesh.vertices.iter().map(|vertex| (vertex.position - position).dot(forward)).fold(f64::INFINITY, f64::min)
}

/// How many pixels as large as a cell there are side by side in a picture at a distance: finer ones would be lost.
fn side(distance: f64, cell: f64) -> usize {
    (2.0 * distance * maths::tan(FOV.to_radians() / 2.0) / cell).ceil() as usize
}
