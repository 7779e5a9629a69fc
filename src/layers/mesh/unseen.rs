//! Whether anything of a mesh is in the frame at some of a few moments, and why not: by the box around it, and where that does
//! not tell by its triangles. Nothing is drawn for it.

use glam::DVec3;
use rayon::prelude::*;

use super::model::{MeshLayer, Sides};
use super::odd;
use super::pose::Placed;
use super::synth::Synth;
use crate::base::maths::atan2;
use crate::base::mesh::Mesh;
use crate::base::problem::Problem;
use crate::layers::parts::moment::Moment;
use crate::layers::space::eye::{Eye, NEAR_M};

/// About so many triangles are looked at, at all moments together.
const MOST_TRIANGLES: usize = 10_000_000;

/// Why nothing is seen at a moment. What differs from moment to moment is told as the last of these.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Why {
    Behind,
    Near,
    Beside,
    Small,
    Turned,
    Within,
}

impl Why {
    /// Where that is changed, what is so, and the cure.
    fn told(self) -> (&'static str, String, &'static str) {
        const FIT: &str = "move the layer or the camera, or in the editor :camera fit, which sees everything";
        match self {
            Why::Behind => ("/pose/position", "it is behind the camera".to_owned(), FIT),
            Why::Near => ("/pose/position", format!("it is nearer to the camera than {NEAR_M} m"), FIT),
            Why::Beside => ("/pose/position", "it is beside the frame".to_owned(), FIT),
            Why::Small => ("/pose/position", "it is smaller than a pixel in the frame".to_owned(), FIT),
            Why::Turned => (
                "/sides",
                "of what is in the frame the back is seen, which is not shown".to_owned(),
                "make sides \"both\", or turn the mesh or the camera",
            ),
            Why::Within => (
                "/sides",
                "the camera is inside it, where back sides are seen, which are not shown".to_owned(),
                "make sides \"both\", or move the camera out of it, as in the editor :camera fit does",
            ),
        }
    }
}

/// The warning that nothing of the mesh is in the frame at any of these moments, or that the camera is inside it at all of them
/// though it may see some front sides; `None` if something is seen, if there are no moments, or if the mesh is odd in itself,
/// which is told instead.
pub fn warning(layer: &MeshLayer, mesh: &Mesh, moments: &[Moment]) -> Option<Problem> {
    let bounds = mesh.bounds().filter(|_| odd::warnings(layer, mesh).is_empty())?;
    let nothing = |path: &str, why: &str, cure: &str| {
        let message = format!("nothing of the mesh \"{}\" is seen: {why}", layer.mesh);
        Some(Problem::warning(path, message).hint(cure))
    };
    if mesh.degenerate == mesh.triangles.len() {
        return nothing(
            "/mesh",
            "none of its triangles has an area",
            "name another, or export it again where it was made",
        );
    }
    if layer.pose.scale == 0.0 {
        return nothing("/pose/scale", "its scale is 0", "make scale 1");
    }
    let both = layer.sides == Sides::Both;
    let view = |moment: &Moment| Glimpse::new(layer.pose.at(moment.t), mesh, bounds, moment);
    let mut views: Vec<Glimpse> = moments.iter().filter_map(view).collect();
    views.dedup();
    let mut why = views.iter().filter_map(Glimpse::of_box).max();
    views.retain(|view| view.of_box().is_none());
    let most = (MOST_TRIANGLES / mesh.triangles.len()).max(2);
    let all_in_box = why.is_none() && views.iter().all(|view| view.within);
    let looked_at = || views.iter().step_by(views.len().div_ceil(most).max(1));
    if !both && all_in_box && !views.is_empty() && looked_at().all(|view| view.is_enclosed(mesh)) {
        let (path, what, cure) = Why::Within.told();
        return Some(Problem::warning(path, format!("of the mesh \"{}\": {what}", layer.mesh)).hint(cure));
    }
    for view in looked_at() {
        if view.shows(mesh, both) {
            return None;
        }
        why = why.max(Some(view.of_triangles(mesh)));
    }
    let (path, what, cure) = why?.told();
    nothing(path, &what, cure)
}

/// Whether a part of the mesh of a layer that is ready is in the frame; what stands before it does not count.
pub fn is_in_frame(synth: &Synth, moment: &Moment) -> bool {
    let Some(bounds) = synth.mesh.bounds() else { return false };
    let view = Glimpse::new(synth.pose.at(synth.time(moment)), &synth.mesh, bounds, moment);
    view.is_none_or(|view| view.of_box().is_none() && view.shows(&synth.mesh, synth.sides == Sides::Both))
}

/// The mesh at one moment.
#[derive(Clone, Debug, PartialEq)]
struct Glimpse {
    placed: Placed,
    eye: Eye,
    size_px: (usize, usize),
    /// The normals of the planes through the camera and the sides of the frame, pointing inward.
    sides: [DVec3; 4],
    /// The corners of a box around it, in camera coordinates.
    corners: [DVec3; 8],
    /// Whether the camera is in that box.
    within: bool,
}

impl Glimpse {
    /// `None` without a camera.
    fn new(placed: Placed, mesh: &Mesh, (low, high): (DVec3, DVec3), moment: &Moment) -> Option<Glimpse> {
        let eye = moment.eye?;
        let half = eye.middle_px / eye.focal_px;
        let sides = [[1.0, 0.0, half.x], [-1.0, 0.0, half.x], [0.0, 1.0, half.y], [0.0, -1.0, half.y]];
        // A bend keeps the distance from the model's origin.
        let (low, high) = match placed.bend_radians {
            0.0 => (low, high),
            _ => {
                let far = low.abs().max(high.abs()).length();
                (DVec3::splat(-far), DVec3::splat(far))
            }
        };
        let place = |way: usize| {
            let pick = |axis: usize| if way >> axis & 1 == 0 { low[axis] } else { high[axis] };
            let model = DVec3::new(pick(0), pick(1), pick(2));
            eye.seen(placed.turn * (model * placed.scale) + placed.position)
        };
        let model = placed.turn.transpose() * (eye.position - placed.position) / placed.scale;
        let within = model.cmpge(low).all() && model.cmple(high).all() && !mesh.triangles.is_empty();
        let sides = sides.map(|[x, y, back]| DVec3::new(x, y, -back));
        Some(Glimpse { placed, eye, size_px: moment.size_px, sides, corners: std::array::from_fn(place), within })
    }

    /// Why nothing is seen, if the box alone tells.
    fn of_box(&self) -> Option<Why> {
        let corners = &self.corners;
        if corners.iter().all(|corner| corner.z >= 0.0) {
            return Some(Why::Behind);
        }
        if corners.iter().all(|corner| -corner.z < NEAR_M) {
            return Some(Why::Near);
        }
        if self.sides.iter().any(|side| corners.iter().all(|corner| corner.dot(*side) < 0.0)) {
            return Some(Why::Beside);
        }
        if corners.iter().any(|corner| -corner.z < NEAR_M) {
            return None;
        }
        let places = corners.map(|corner| self.eye.project(corner));
        let (low, high) = places.iter().fold((places[0], places[0]), |(low, high), at| (low.min(*at), high.max(*at)));
        // The middle of no pixel is in it.
        let small = (high - low).max_element() < 1.0 && ((low - 0.5).ceil().cmpgt((high - 0.5).floor())).any();
        small.then_some(Why::Small)
    }

    /// Why no triangle is seen.
    fn of_triangles(&self, mesh: &Mesh) -> Why {
        match (self.shows(mesh, true), self.within) {
            (true, true) => Why::Within,
            (true, false) => Why::Turned,
            (false, _) => Why::Beside,
        }
    }

    /// Whether a closed mesh encloses the camera, its back sides inward: they fill most of the solid angle around it (Van Oosterom and
    /// Strackee 1983).
    fn is_enclosed(&self, mesh: &Mesh) -> bool {
        let halves =
            |triangles: &[[u32; 3]]| triangles.iter().map(|triangle| self.half_angle(mesh, triangle)).sum::<f64>();
        // In order: the sum is the same on any number of threads.
        let halves: Vec<f64> = mesh.triangles.par_chunks(4096).map(halves).collect();
        halves.iter().sum::<f64>() > 0.75 * std::f64::consts::TAU
    }

    /// Half the solid angle of a triangle, positive if its back is seen.
    fn half_angle(&self, mesh: &Mesh, triangle: &[u32; 3]) -> f64 {
        let [a, b, c] = triangle.map(|vertex| self.seen(mesh, vertex));
        let [x, y, z] = [a, b, c].map(DVec3::length);
        atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
    }

    /// A vertex in camera coordinates.
    fn seen(&self, mesh: &Mesh, vertex: u32) -> DVec3 {
        self.eye.seen(self.placed.point(mesh.vertices[vertex as usize].position, DVec3::ZERO).0)
    }

    /// Whether a part of a triangle is in the frame; `both` counts those too that face away.
    fn shows(&self, mesh: &Mesh, both: bool) -> bool {
        mesh.triangles.par_iter().any(|triangle| {
            let [a, b, c] = triangle.map(|vertex| self.seen(mesh, vertex));
            let facing = a.dot(b.cross(c));
            (facing < 0.0 || both && facing > 0.0) && self.holds([a, b, c])
        })
    }

    /// Whether a part of a triangle is in what the camera sees.
    fn holds(&self, corners: [DVec3; 3]) -> bool {
        let inside = |at: &DVec3| -at.z >= NEAR_M && self.sides.iter().all(|side| at.dot(*side) >= 0.0);
        if corners.iter().any(inside) {
            return true;
        }
        let outside = |side: &DVec3| corners.iter().all(|corner| corner.dot(*side) < 0.0);
        if self.sides.iter().any(outside) || corners.iter().all(|corner| -corner.z < NEAR_M) {
            return false;
        }
        let near = cut(&corners, |at| -at.z - NEAR_M);
        let left = self.sides.iter().fold(near, |left, side| cut(&left, |at| at.dot(*side)));
        !left.is_empty()
    }
}

/// The part of a polygon where something that changes evenly is not negative.
fn cut(corners: &[DVec3], over: impl Fn(DVec3) -> f64) -> Vec<DVec3> {
    let next = corners.iter().cycle().skip(1);
    let sides = corners.iter().zip(next).map(|(a, b)| ((*a, over(*a)), (*b, over(*b))));
    let kept = sides.flat_map(|((a, over_a), (b, over_b))| {
        let crossed = (over_a < 0.0) != (over_b < 0.0);
        let between = crossed.then(|| a.lerp(b, over_a / (over_a - over_b)));
        (over_a >= 0.0).then_some(a).into_iter().chain(between)
    });
    kept.collect()
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::base::mesh::Vertex;
    use crate::layers::space::camera::Camera;

    /// A tetrahedron, 1 m from its middle to its corners, whose faces look outward.
    fn mesh() -> Mesh {
        let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
        let vertex = |at: [f64; 3]| Vertex { position: DVec3::from(at), ..Vertex::default() };
        let triangles = vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];
        Mesh { vertices: corners.map(vertex).to_vec(), triangles, ..Mesh::default() }
    }

    fn told(layer: Value, camera: Value, mesh: &Mesh) -> Option<String> {
        let mut whole = json!({ "name": "m", "mesh": "m" });
        whole.as_object_mut().unwrap().extend(layer.as_object().unwrap().clone());
        let layer: MeshLayer = serde_json::from_value(whole).unwrap();
        let camera: Camera = serde_json::from_value(camera).unwrap();
        let moments = (0..8).map(|k| {
            let (t, size_px) = (f64::from(k) / 8.0, (200, 100));
            Moment { t, size_px, eye: Some(camera.at(t, size_px)), left_out: 0, magnified: 1 }
        });
        warning(&layer, mesh, &moments.collect::<Vec<_>>()).map(|problem| problem.to_string())
    }

    #[test]
    fn why_nothing_is_seen_is_told_with_its_cure() {
        let front = json!({ "position": [0, 0, 6], "target": [0, 0, 0] });
        let inside = json!({ "position": [0, 0, 0], "target": [0, 0, -1] });
        for (layer, camera, parts) in [
            (json!({}), &front, &[][..]),
            (json!({ "sides": "both" }), &inside, &[]),
            (json!({}), &inside, &["sides: warning: ", "the camera is inside it", "make sides \"both\""]),
            (json!({ "pose": { "scale": 0 } }), &front, &["pose.scale: warning: ", "its scale is 0", "make scale 1"]),
            (json!({ "pose": { "position": [0, 0, 9] } }), &front, &["behind the camera", ":camera fit"]),
            (
                json!({ "pose": { "position": [0, 0, 6], "scale": 0.006 } }),
                &front,
                &["nearer to the camera than 0.01 m"],
            ),
            (json!({ "pose": { "position": [9, 0, 0] } }), &front, &["pose.position: warning: ", "beside the frame"]),
            (json!({ "pose": { "position": [0, -5, 0] } }), &front, &["beside the frame", ":camera fit"]),
            (json!({ "pose": { "position": [0.02, 0.02, -900], "scale": 0.02 } }), &front, &["smaller than a pixel"]),
            // Something is seen at some moment.
            (
                json!({ "pose": { "position": [0, 0, 9] } }),
                &json!({ "turn": 180, "target": [0, 0, 0], "position": [0, 0, 6] }),
                &[],
            ),
            (json!({ "pose": { "position": [3.4, 0, 0] } }), &front, &[]),
            (
                json!({ "pose": { "position": [0, 9, 0], "bend": { "degrees": 170, "axis": "x", "from": 0, "to": 1 } } }),
                &front,
                &["beside the frame"],
            ),
        ] {
            let told = told(layer.clone(), camera.clone(), &mesh());
            assert_eq!(told.is_some(), !parts.is_empty(), "{layer} {camera}: {told:?}");
            assert!(parts.iter().all(|part| told.as_ref().unwrap().contains(part)), "{layer}: {told:?}");
        }
    }

    #[test]
    fn a_camera_inside_is_told_though_something_is_seen() {
        let mut mesh = mesh();
        let sliver = [[0.1, 0.0, -0.2], [0.0, 0.1, -0.2], [0.0, 0.0, -0.2]];
        mesh.vertices.extend(sliver.map(|at| Vertex { position: DVec3::from(at), ..Vertex::default() }));
        mesh.triangles.push([6, 4, 5]);
        let at = |z: f64| json!({ "position": [0, 0, z], "target": [0, 0, -9] });
        let inside = told(json!({}), at(0.0), &mesh).unwrap();
        assert!(inside.contains("sides: warning: of the mesh \"m\": the camera is inside it"), "{inside}");
        // From outside, with both sides, and where it leaves on its way nothing is wrong.
        assert_eq!(told(json!({}), at(6.0), &mesh), None);
        assert_eq!(told(json!({ "sides": "both" }), at(0.0), &mesh), None);
        let leaves = json!({ "position": [0, 0, 0], "target": [0, 0, -9], "keys": [{ "at": 0 }, { "at": 0.9, "position": [0, 0, 6] }] });
        assert_eq!(told(json!({}), leaves, &mesh), None);
        // A room, whose front sides look inward.
        mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        assert_eq!(told(json!({}), at(0.0), &mesh), None);
    }

    #[test]
    fn a_surface_is_seen_whose_corners_are_all_beside_the_frame() {
        let vertices = [[-90.0, -1.0, 50.0], [90.0, -1.0, 50.0], [0.0, -1.0, -300.0]];
        let vertices = vertices.map(|at| Vertex { position: DVec3::from(at), ..Vertex::default() }).to_vec();
        let floor = Mesh { vertices, triangles: vec![[0, 1, 2]], ..Mesh::default() };
        let level = json!({ "position": [0, 0, 6], "target": [0, 0, 0] });
        assert_eq!(told(json!({}), level.clone(), &floor), None);
        let below = json!({ "position": [0, -3, 6], "target": [0, -3, 0] });
        let turned = told(json!({}), below.clone(), &floor).unwrap();
        assert!(turned.contains("the back is seen") && turned.contains("make sides \"both\""), "{turned}");
        assert_eq!(told(json!({ "sides": "both" }), below, &floor), None);
        let up = json!({ "position": [0, 0, 6], "target": [0, 40, 0] });
        assert!(told(json!({}), up, &floor).unwrap().contains("beside the frame"));
        let flat = Mesh { degenerate: 1, ..floor };
        assert!(told(json!({}), level, &flat).unwrap().contains("none of its triangles has an area"));
    }
}
