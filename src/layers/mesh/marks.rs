//! What explains a mesh: its edges, its normals, and where its back is seen. As many strokes as a screen can bear; of a
//! larger mesh every n-th thing is drawn, and of what would run together the outline; a label says so.

use glam::DVec3;
use kurbo::Point;
use rayon::prelude::*;

use super::frame;
use super::model::Sides;
use super::synth::Synth;
use crate::layers::parts::marks::{Dot, Look, Mark, Overlay, Shape, View, When};
use crate::layers::parts::moment::{CENTER, Columns, Moment};
use crate::layers::space::eye::Eye;
use crate::layers::space::hidden::Depths;
use crate::layers::space::marks::{AXES, CAMERA_OVERLAY, FRUSTUM, GRID, GROUND_OVERLAY, deep_line, line};
use crate::layers::space::raster::{NONE, Raster};

const WIRES: &str = "view-wires";
const NORMALS: &str = "view-normals";
const BACKS: &str = "view-backs";

const fn overlay(name: &'static str, key: &'static str, help: &'static str, hidden: bool) -> Overlay {
    Overlay { hidden, ..Overlay::new(name, key, help, When::EveryFrame) }
}

/// Every overlay, but for those of surfaces and strokes.
pub static OVERLAYS: &[Overlay] = &[
    GROUND_OVERLAY,
    CAMERA_OVERLAY,
    overlay(WIRES, "M", "Edges of meshes", true),
    overlay(NORMALS, "N", "Normals at the vertices of meshes", false),
    overlay(BACKS, "B", "Where the back of a mesh is seen", false),
];

/// An edge.
static WIRE: Look = Look::new("edge", 25, [86, 180, 233, 220], 1.0);
/// A pixel that sees a triangle from behind.
static BACK: Look = Look::new("back side", 26, [230, 60, 200, 150], 0.0).dots(Dot::Square, 0.0).stroke("▒");
/// A normal at a vertex.
static NORMAL: Look = Look::new("normal", 27, [240, 160, 40, 230], 1.2);

/// Every look, from bottom to top, but for those of surfaces and strokes, which lie over them.
pub static LOOKS: &[&Look] = &[&GRID, &AXES[0], &AXES[1], &AXES[2], &FRUSTUM, &WIRE, &BACK, &NORMAL];

/// At most so many strokes, or cells, of one overlay of one layer.
const MOST: usize = 60_000;
/// Of at most so many sides of triangles it is found out which make an edge.
const MOST_SORTED: usize = 600_000;
/// The length of a normal, as a share of the size of the mesh.
const LENGTH: f64 = 0.015;

/// The marks of a layer at one time.
pub fn marks(synth: &Synth, view: &View, moment: &Moment) -> Vec<Mark> {
    let placed = synth.pose.at(synth.time(moment));
    let mut marks = synth.surface.marks(view, moment, &placed);
    if let Some(strokes) = synth.strokes.as_deref().filter(|strokes| strokes.explains(view)) {
        let seen = frame::MeshAt::new(synth, moment);
        let given = seen.given_alone();
        marks.extend(given.into_iter().flat_map(|given| strokes.marks(&given, view)));
    }
    let shown = [WIRES, NORMALS, BACKS].map(|name| view.shows(name));
    let Some(eye) = moment.eye.filter(|_| shown.contains(&true)) else { return marks };
    let vertices = synth.mesh.vertices.par_iter();
    let world = vertices.map(|vertex| placed.point(vertex.position, vertex.normal)).collect();
    let seen = MeshMarks { synth, moment, eye, world };
    let [wires, normals, backs] = shown;
    // Who looks at back sides looks into the mesh.
    let nearest = view.nearest.as_deref().filter(|_| !backs);
    marks.extend(wires.then(|| seen.wires(MOST, view.least_px, nearest)).into_iter().flatten());
    marks.extend(normals.then(|| seen.normals(MOST)).into_iter().flatten());
    marks.extend(backs.then(|| seen.backs(view.cell_px)).into_iter().flatten());
    marks
}

/// A mesh at one time, as one eye sees it.
struct MeshMarks<'a> {
    synth: &'a Synth,
    moment: &'a Moment,
    eye: Eye,
    /// The vertices in the world: where they are, and their normals.
    world: Vec<(DVec3, DVec3)>,
}

impl MeshMarks<'_> {
    fn both(&self) -> bool {
        self.synth.sides == Sides::Both
    }

    /// Whether a triangle is seen from its front.
    fn is_front(&self, triangle: &[u32; 3]) -> bool {
        let [a, b, c] = triangle.map(|i| self.eye.seen(self.world[i as usize].0));
        a.dot(b.cross(c)) < 0.0
    }

    fn line(&self, look: &'static Look, ends: [DVec3; 2]) -> Option<Mark> {
        let points = line(self.moment, &self.eye, ends)?;
        Some(Mark::new(look, "", Shape::Line { points: points.into(), closed: false }))
    }

    /// The triangles, as the eye sees them.
    fn raster(&self, both: bool) -> Raster<'_> {
        let seen = self.world.par_iter().map(|(at, _)| self.eye.seen(*at)).collect();
        Raster::new(&self.eye, self.moment.size_px, CENTER, &self.synth.mesh.triangles, seen, both)
    }

    /// The edges of what is seen, each once; without the parts that something nearer hides. Of those that are shorter than
    /// `least_px` only the outline is left.
    fn wires(&self, most: usize, least_px: f64, nearest: Option<&Depths>) -> Vec<Mark> {
        let triangles = self.synth.mesh.triangles.par_iter().map(|triangle| (triangle, self.is_front(triangle)));
        let triangles: Vec<_> = triangles.filter(|(_, front)| self.both() || *front).collect();
        let step = (3 * triangles.len()).div_ceil(MOST_SORTED.max(most)).max(1);
        let sides = |(&[a, b, c], front): (&[u32; 3], bool)| {
            [(a, b), (b, c), (c, a)].map(|(from, to)| (from.min(to), from.max(to), front))
        };
        let mut edges: Vec<(u32, u32, bool)> = triangles.into_iter().step_by(step).flat_map(sides).collect();
        edges.sort_unstable();
        let mut short = false;
        let lines = edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).filter_map(|same| {
            let ends = [same[0].0, same[0].1].map(|i| self.world[i as usize].0);
            let line = deep_line(self.moment, &self.eye, ends)?;
            let inner = same.len() > 1 && same.iter().all(|(.., front)| *front == same[0].2);
            let left_out = inner && (line[1].0 - line[0].0).hypot() < least_px;
            short |= left_out;
            (!left_out).then_some(line)
        });
        let lines: Vec<_> = lines.collect();
        let each = lines.len().div_ceil(most).max(1);
        let parts = lines.into_iter().step_by(each).flat_map(|line| match nearest {
            Some(nearest) => nearest.shown(line),
            None => vec![line.map(|(at, _)| at)],
        });
        let wire = |points: [Point; 2]| Mark::new(&WIRE, "", Shape::Line { points: points.into(), closed: false });
        let what = match (step * each, short) {
            (1, false) => None,
            (1, true) => Some("short edges are left out".to_owned()),
            (n, _) => Some(format!("1 of {n} edges")),
        };
        told(parts.map(wire).collect(), what)
    }

    /// A short line along each normal that is turned to the eye.
    fn normals(&self, most: usize) -> Vec<Mark> {
        let step = self.world.len().div_ceil(most).max(1);
        let first = self.world.first().map_or(DVec3::ZERO, |(at, _)| *at);
        let (low, high) = self.world.iter().fold((first, first), |(low, high), (at, _)| (low.min(*at), high.max(*at)));
        let length = (high - low).length() * LENGTH;
        let shown = self.world.iter().step_by(step);
        let shown = shown.filter(|(at, normal)| self.both() || normal.dot(self.eye.position - *at) > 0.0);
        let lines = shown.filter_map(|&(at, normal)| self.line(&NORMAL, [at, at + normal * length])).collect();
        told(lines, (step > 1).then(|| format!("1 of {step} vertices")))
    }

    /// Cells where the nearest triangle of the mesh is seen from behind, one every so many pixels.
    fn backs(&self, cell_px: f64) -> Vec<Mark> {
        let (width, height) = self.moment.size_px;
        let fewest = ((width * height) as f64 / MOST as f64).sqrt();
        let side = cell_px.max(fewest).max(1.0).ceil() as usize;
        let raster = self.raster(true);
        let columns: Vec<usize> = (side / 2..width).step_by(side).collect();
        let rows: Vec<usize> = (side / 2..height).step_by(side).collect();
        let wanted = Columns::Some(&columns);
        let cells = rows.into_par_iter().flat_map_iter(|y| {
            let (mut depth, mut triangles) = (vec![f64::INFINITY; columns.len()], vec![NONE; columns.len()]);
            raster.row(y, wanted, &mut depth, &mut triangles);
            let mut backs = Vec::new();
            let found = (&*depth, &*triangles);
            raster.hits(y, wanted, found, |_| (), |cell, hit, ()| backs.extend((!hit.front).then_some(columns[cell])));
            let backs = backs.into_iter().map(|x| Point::new(x as f64 + 0.5, y as f64 + 0.5));
            backs.map(|at| Mark::new(&BACK, "", Shape::Cell(at, side as f64))).collect::<Vec<_>>()
        });
        cells.collect()
    }
}

/// Lines, and a label where only some of them are drawn.
fn told(mut lines: Vec<Mark>, what: Option<String>) -> Vec<Mark> {
    let first = lines.first().map(|line| (line.look, line.shape.clone()));
    if let Some(((look, Shape::Line { points, .. }), what)) = first.zip(what) {
        lines.push(Mark::new(look, "", Shape::Label(points[0], what)));
    }
    lines
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::base::mesh::{Mesh, Vertex};
    use crate::layers::mesh::model::MeshLayer;
    use crate::layers::parts::materials::Materials;
    use crate::layers::ready::Making;
    use crate::layers::space::camera::Camera;
    use crate::layers::timeline::Wrap;

    /// A square of two triangles, whose front looks to +z, or from behind.
    fn seen<T>(layer: &str, z: f64, of: impl FnOnce(&MeshMarks) -> T) -> T {
        of_squares(&[(-1.0, 1.0, 0.0)], layer, z, of)
    }

    /// Such squares: where they begin and end in x, and where they are in z.
    fn of_squares<T>(squares: &[(f64, f64, f64)], layer: &str, z: f64, of: impl FnOnce(&MeshMarks) -> T) -> T {
        let corners = |&(from, to, z): &(f64, f64, f64)| {
            [[from, -1.0, z], [to, -1.0, z], [to, 1.0, z], [from, 1.0, z]].map(DVec3::from_array)
        };
        let vertex = |position: DVec3| Vertex { position, normal: DVec3::Z, ..Vertex::default() };
        let vertices = squares.iter().flat_map(corners).map(vertex).collect();
        let pair = |i: u32| [[4 * i, 4 * i + 1, 4 * i + 2], [4 * i, 4 * i + 2, 4 * i + 3]];
        let triangles = (0..squares.len() as u32).flat_map(pair).collect();
        let mesh = Arc::new(Mesh { vertices, triangles, ..Mesh::default() });
        let materials = Materials { meshes: [("m".to_owned(), mesh)].into(), ..Materials::default() };
        let layer: MeshLayer = serde_json::from_str(layer).unwrap();
        let synth = Synth::new(&layer, &Making::plain(Wrap::Repeat, &materials), None).unwrap();
        let camera = Camera { position: [0.0, 0.0, z], target: [0.0; 3], ..Camera::default() };
        let moment =
            Moment { t: 0.0, size_px: (60, 60), eye: Some(camera.at(0.0, (60, 60))), left_out: 0, magnified: 1 };
        let world = synth.mesh.vertices.iter().map(|vertex| (vertex.position, vertex.normal)).collect();
        of(&MeshMarks { synth: &synth, moment: &moment, eye: moment.eye.unwrap(), world })
    }

    const FRONT: &str = r#"{"name": "m", "mesh": "m"}"#;
    const BOTH: &str = r#"{"name": "m", "mesh": "m", "sides": "both"}"#;

    #[test]
    fn what_faces_away_has_edges_and_normals_only_where_both_sides_are_seen() {
        for (layer, z, edges, normals) in [(FRONT, 4.0, 5, 4), (FRONT, -4.0, 0, 0), (BOTH, -4.0, 5, 4)] {
            let found = seen(layer, z, |seen| (seen.wires(MOST, 0.0, None).len(), seen.normals(MOST).len()));
            assert_eq!(found, (edges, normals), "{layer} {z}");
        }
    }

    #[test]
    fn edges_end_where_the_mesh_hides_them() {
        let lengths = |squares: &[(f64, f64, f64)], hides: bool| {
            let wires = of_squares(squares, FRONT, 4.0, |seen| {
                let raster = seen.raster(false);
                let row = |y: usize, columns: Columns, depth: &mut [f64]| {
                    raster.row(y, columns, depth, &mut vec![NONE; depth.len()]);
                };
                let nearest = hides.then(|| Depths::new(seen.moment.size_px, row));
                seen.wires(MOST, 0.0, nearest.as_ref())
            });
            let length = |mark: &Mark| match &mark.shape {
                Shape::Line { points, .. } => (points[1] - points[0]).hypot(),
                _ => 0.0,
            };
            (wires.len(), wires.iter().map(length).sum::<f64>())
        };
        let near = (-1.0, 1.0, 0.0);
        let alone = lengths(&[near], true);
        assert_eq!((alone.0, lengths(&[near, (-0.5, 0.5, -1.0)], false).0), (5, 10));
        assert_eq!(lengths(&[near, (-0.5, 0.5, -1.0)], true), alone, "all of it is behind");
        // From the middle to beyond the edge, which is at 1.25.
        let [all, half] = [false, true].map(|hides| lengths(&[near, (0.0, 1.7, -1.0)], hides));
        assert_eq!(half.0, 9, "the left side is hidden, three edges are cut");
        let share = (half.1 - alone.1) / (all.1 - alone.1);
        assert!((0.3..0.45).contains(&share), "as far as the edge in front of it: {share}");
    }

    #[test]
    fn there_are_never_too_many_and_a_label_says_so() {
        let (wires, normals) = seen(FRONT, 4.0, |seen| (seen.wires(3, 0.0, None), seen.normals(2)));
        assert_eq!((wires.len(), normals.len()), (4, 3), "with the labels");
        for (marks, text) in [(wires, "1 of 2 edges"), (normals, "1 of 2 vertices")] {
            let label = marks.last().map(|mark| mark.shape.clone());
            assert!(matches!(&label, Some(Shape::Label(_, told)) if told == text), "{label:?}");
        }
    }

    #[test]
    fn of_short_edges_the_outline_is_left_and_a_label_says_so() {
        // The square is 41 pixels wide, and its diagonal 58 long.
        for (least, edges) in [(57.0, 5), (59.0, 4)] {
            let wires = seen(FRONT, 4.0, |seen| seen.wires(MOST, least, None));
            let (lines, labels): (Vec<_>, Vec<_>) =
                wires.iter().partition(|mark| matches!(mark.shape, Shape::Line { .. }));
            assert_eq!((lines.len(), labels.len()), (edges, 5 - edges), "{least}");
        }
    }

    #[test]
    fn backs_are_marked_where_they_are_seen() {
        assert_eq!(seen(FRONT, 4.0, |seen| seen.backs(4.0).len()), 0);
        let cells = seen(FRONT, -4.0, |seen| seen.backs(4.0));
        // The square is 41 pixels wide.
        assert!((81..=121).contains(&cells.len()), "{}", cells.len());
        assert!(cells.iter().all(|mark| matches!(mark.shape, Shape::Cell(_, 4.0))));
    }

    #[test]
    fn nothing_is_made_that_is_not_shown() {
        let shown =
            |names: &[&'static str]| seen(BOTH, 4.0, |seen| marks(seen.synth, &View::of(names), seen.moment).len());
        assert_eq!((shown(&[]), shown(&["view-ground"]), shown(&[WIRES]), shown(&[NORMALS])), (0, 0, 5, 4));
    }
}
