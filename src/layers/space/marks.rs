//! What explains a scene in space: the ground with the axes of the world, and where the scene's camera looks. Lines of the
//! world as marks of the frame.

use glam::DVec3;
use kurbo::{Point, Rect};

use super::camera::Camera;
use super::eye::{Eye, NEAR_M};
use super::hidden::Depths;
use crate::base::maths::{lerp, nice};
use crate::base::number::tidy;
use crate::layers::parts::marks::{Dot, Look, Mark, Overlay, Shape, View, When};
use crate::layers::parts::moment::Moment;

const GROUND: &str = "view-ground";
const CAMERA: &str = "view-camera";

/// The ground and the axes: an overlay of every technique in space.
pub const GROUND_OVERLAY: Overlay =
    Overlay { hidden: true, ..Overlay::new(GROUND, "G", "The ground and the axes of the world", When::EveryFrame) };
/// The scene's camera: an overlay of every technique in space.
pub const CAMERA_OVERLAY: Overlay =
    Overlay::new(CAMERA, "C", "What the scene's camera sees, looked at from elsewhere", When::EveryFrame);

/// A line on the ground.
pub static GRID: Look = Look::new("ground", 20, [190, 200, 215, 215], 0.9);
/// The axes of the world: x, y, z.
pub static AXES: [Look; 3] = [
    Look::new("x axis", 21, [235, 110, 90, 255], 1.6).stroke("x"),
    Look::new("y axis", 22, [60, 210, 160, 255], 1.6).dashed(8.0, 3.0).stroke("y"),
    Look::new("z axis", 23, [86, 160, 240, 255], 1.6).dashed(3.0, 3.0).stroke("z"),
];
/// What the scene's camera sees.
pub static FRUSTUM: Look = Look::new("camera", 24, [240, 228, 66, 255], 1.4).dots(Dot::Diamond, 4.0);

/// The grid has so many lines to each side of the origin.
const LINES: i32 = 10;
/// The y axis is as long as so many of its cells.
const TALL: i32 = 4;

/// The line between two places of the world as far as it is in the frame; `None` if all of it is behind the eye or beside the
/// frame.
pub fn line(moment: &Moment, eye: &Eye, ends: [DVec3; 2]) -> Option<[Point; 2]> {
    deep_line(moment, eye, ends).map(|ends| ends.map(|(at, _)| at))
}

/// The same, each end with 1 / its depth, which is even along the line in the frame.
pub fn deep_line(moment: &Moment, eye: &Eye, ends: [DVec3; 2]) -> Option<[(Point, f64); 2]> {
    deep_part(moment, eye, ends, 0.0)
}

/// A place of the world in the frame, or beside it by at most half of its sides.
pub fn spot(moment: &Moment, eye: &Eye, at: DVec3) -> Option<Point> {
    deep_part(moment, eye, [at; 2], 0.5).map(|[(at, _), _]| at)
}

/// As [`deep_line`], reaching beyond the frame by this share of its sides.
fn deep_part(moment: &Moment, eye: &Eye, ends: [DVec3; 2], beyond: f64) -> Option<[(Point, f64); 2]> {
    let [mut a, mut b] = ends.map(|end| eye.seen(end));
    let (depth_a, depth_b) = (-a.z, -b.z);
    if depth_a < NEAR_M && depth_b < NEAR_M {
        return None;
    }
    let near = a.lerp(b, (NEAR_M - depth_a) / (depth_b - depth_a));
    if depth_a < NEAR_M {
        a = near;
    } else if depth_b < NEAR_M {
        b = near;
    }
    // Cut at the near plane, an end may be a hair before it.
    let [a, b] = [a, b].map(|end| end.with_z(end.z.min(-NEAR_M)));
    let [at_a, at_b] = [a, b].map(|end| eye.project(end)).map(|at| Point::new(at.x, at.y));
    let (width, height) = (moment.size_px.0 as f64, moment.size_px.1 as f64);
    let room = Rect::new(0.0, 0.0, width, height).inflate(width * beyond, height * beyond);
    let shares = within(room, [at_a, at_b])?;
    Some(shares.map(|share| (at_a + (at_b - at_a) * share, lerp(-1.0 / a.z, -1.0 / b.z, share))))
}

/// The part of a line that is in a rectangle, as shares of its length.
fn within(room: Rect, [a, b]: [Point; 2]) -> Option<[f64; 2]> {
    let way = b - a;
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    let sides = [(way.x, room.x0 - a.x, room.x1 - a.x), (way.y, room.y0 - a.y, room.y1 - a.y)];
    for (way, low, high) in sides {
        if way == 0.0 {
            if low > 0.0 || high < 0.0 {
                return None;
            }
            continue;
        }
        let (enters, leaves) = if way > 0.0 { (low / way, high / way) } else { (high / way, low / way) };
        (from, to) = (from.max(enters), to.min(leaves));
    }
    (from <= to).then_some([from, to])
}

/// The marks of all that is in space together; `camera` is the scene's. The ground is hidden by what `view` has as the
/// nearest.
pub fn marks(view: &View, moment: &Moment, camera: Option<&Camera>) -> Vec<Mark> {
    let Some(eye) = moment.eye else { return Vec::new() };
    let mut drawn = Drawn { moment, eye, nearest: view.nearest.as_deref(), marks: Vec::new() };
    if view.shows(GROUND) {
        drawn.ground();
    }
    if let Some(camera) = camera.filter(|camera| view.shows(CAMERA) && camera.at(moment.t, moment.size_px) != eye) {
        drawn.camera(camera);
    }
    drawn.marks
}

/// Marks in the making.
struct Drawn<'a> {
    moment: &'a Moment,
    eye: Eye,
    nearest: Option<&'a Depths>,
    marks: Vec<Mark>,
}

impl Drawn<'_> {
    /// A line without the parts that something nearer hides.
    fn ground_line(&mut self, look: &'static Look, ends: [DVec3; 2]) {
        let Some(line) = deep_line(self.moment, &self.eye, ends) else { return };
        let parts = match self.nearest {
            Some(nearest) => nearest.shown(line),
            None => vec![line.map(|(at, _)| at)],
        };
        let mark = |points: [Point; 2]| Mark::new(look, "", Shape::Line { points: points.into(), closed: false });
        self.marks.extend(parts.into_iter().map(mark));
    }

    fn line(&mut self, look: &'static Look, ends: [DVec3; 2]) {
        if let Some(points) = line(self.moment, &self.eye, ends) {
            self.marks.push(Mark::new(look, "/camera", Shape::Line { points: points.into(), closed: false }));
        }
    }

    /// The name of an axis, at the first of so many cells along it that is seen.
    fn label(&mut self, look: &'static Look, name: &str, axis: DVec3, (cell, cells): (f64, i32)) {
        let seen = (1..=cells).find_map(|k| {
            let at = f64::from(k) * cell;
            let found = deep_line(self.moment, &self.eye, [axis * at; 2])?;
            let hidden = self.nearest.is_some_and(|nearest| nearest.shown(found).is_empty());
            (!hidden).then_some((found[0].0, at))
        });
        if let Some((point, at)) = seen {
            self.marks.push(Mark::new(look, "", Shape::Label(point, format!("{name} {} m", tidy(at)))));
        }
    }

    fn ground(&mut self) {
        let cell = nice(self.eye.position.length() / 4.0).unwrap_or(1.0);
        let far = cell * f64::from(LINES);
        for k in (-LINES..=LINES).filter(|&k| k != 0) {
            let at = f64::from(k) * cell;
            self.ground_line(&GRID, [DVec3::new(at, 0.0, -far), DVec3::new(at, 0.0, far)]);
            self.ground_line(&GRID, [DVec3::new(-far, 0.0, at), DVec3::new(far, 0.0, at)]);
        }
        let [x, y, z] = [&AXES[0], &AXES[1], &AXES[2]];
        self.ground_line(x, [DVec3::X * -far, DVec3::X * far]);
        self.ground_line(y, [DVec3::ZERO, DVec3::Y * cell * f64::from(TALL)]);
        self.ground_line(z, [DVec3::Z * -far, DVec3::Z * far]);
        self.label(x, "x", DVec3::X, (cell, LINES));
        self.label(y, "y", DVec3::Y, (cell, TALL));
        self.label(z, "z", DVec3::Z, (cell, LINES));
    }

    fn camera(&mut self, camera: &Camera) {
        let ([position, target, _], _) = camera.view(self.moment.t);
        let (depth, eye) = (position.distance(target), camera.at(self.moment.t, self.moment.size_px));
        let (right, down) = (eye.middle_px.x * 2.0, eye.middle_px.y * 2.0);
        let world = |at: (f64, f64)| position + eye.turn.transpose() * (eye.ray(at.into()) * depth);
        let corners = [(0.0, 0.0), (right, 0.0), (right, down), (0.0, down)].map(world);
        for (i, corner) in corners.into_iter().enumerate() {
            self.line(&FRUSTUM, [position, corner]);
            self.line(&FRUSTUM, [corner, corners[(i + 1) % 4]]);
        }
        // A roof shows which side is up.
        let roof = world((right / 2.0, -down / 4.0));
        self.line(&FRUSTUM, [corners[0], roof]);
        self.line(&FRUSTUM, [corners[1], roof]);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::layers::parts::moment::Columns;

    fn moment() -> Moment {
        let camera = Camera { position: [0.0, 2.0, 4.0], target: [0.0, 0.0, 0.0], ..Camera::default() };
        Moment { t: 0.0, size_px: (200, 100), eye: Some(camera.at(0.0, (200, 100))), left_out: 0, magnified: 1 }
    }

    #[test]
    fn lines_are_cut_at_the_near_plane_and_beside_the_frame() {
        let moment = moment();
        let eye = moment.eye.unwrap();
        let through = line(&moment, &eye, [DVec3::new(0.0, 0.0, -50.0), DVec3::new(0.0, 0.0, 50.0)]).unwrap();
        assert!(through.iter().all(|end| (end.x - 100.0).abs() < 1e-9), "{through:?}");
        assert!((through[1].y - 100.0).abs() < 1e-6, "to the edge of the frame: {through:?}");
        let beside = DVec3::new(4.0, 0.0, 0.0);
        assert_eq!(line(&moment, &eye, [beside; 2]), None);
        assert!(spot(&moment, &eye, beside).is_some_and(|at| at.x > 200.0), "dots are gripped a little beside it too");
        assert_eq!(spot(&moment, &eye, beside * 9.0), None);
        assert_eq!(line(&moment, &eye, [DVec3::new(0.0, 0.0, 9.0), DVec3::new(1.0, 3.0, 50.0)]), None, "behind");
        assert_eq!(line(&moment, &eye, [DVec3::new(90.0, 0.0, 0.0), DVec3::new(90.0, 1.0, 0.0)]), None, "beside");
        let [a, b] = line(&moment, &eye, [DVec3::ZERO, DVec3::X]).unwrap();
        assert!(a.distance(Point::new(100.0, 50.0)) < 1e-9 && (b.y - 50.0).abs() < 1e-9 && b.x > 110.0, "{a} {b}");
    }

    #[test]
    fn the_camera_is_seen_from_elsewhere_only() {
        let (view, own) = (View::of(&[CAMERA]), Camera::default());
        let seen = Moment { eye: Some(own.at(0.0, (200, 100))), ..moment() };
        assert_eq!(marks(&view, &seen, Some(&own)), []);
        let marks = marks(&view, &moment(), Some(&own));
        assert!(marks.len() > 4 && marks.iter().all(|mark| &*mark.path == "/camera"), "{marks:?}");
    }

    #[test]
    fn the_ground_is_hidden_by_what_is_nearer() {
        let left = |_: usize, columns: Columns, depths: &mut [f64]| {
            let Columns::Some(columns) = columns else { return };
            depths.iter_mut().zip(columns).filter(|(_, x)| **x < 100).for_each(|(depth, _)| *depth = 0.1);
        };
        let nearest = Some(Arc::new(Depths::new((200, 100), left)));
        let found = marks(&View { nearest, ..View::of(&[GROUND]) }, &moment(), None);
        let ends = found.iter().flat_map(|mark| match &mark.shape {
            Shape::Line { points, .. } => points.clone(),
            _ => Vec::new(),
        });
        let ends: Vec<f64> = ends.filter(|end| (1.0..99.0).contains(&end.y)).map(|end| end.x).collect();
        // Beside the frame nothing is known.
        assert!(ends.iter().all(|x| *x < 1.0 || *x > 98.0) && ends.iter().any(|x| *x > 100.0), "{ends:?}");
    }

    #[test]
    fn the_ground_has_axes_with_their_lengths_where_they_are_seen() {
        let labels = |found: &[Mark]| {
            let text = |mark: &Mark| match &mark.shape {
                Shape::Label(_, text) => Some(text.clone()),
                _ => None,
            };
            found.iter().filter_map(text).collect::<Vec<_>>()
        };
        let found = marks(&View::of(&[GROUND]), &moment(), None);
        assert_eq!(labels(&found), ["x 1 m", "y 1 m", "z 1 m"]);
        // Something before all that is not far to the right, or low.
        let hides = |x: usize, y: usize| x < 140 && y < 85;
        let near = |y: usize, columns: Columns, depths: &mut [f64]| {
            let Columns::Some(columns) = columns else { return };
            depths.iter_mut().zip(columns).filter(|(_, x)| hides(**x, y)).for_each(|(depth, _)| *depth = 0.1);
        };
        let nearest = Some(Arc::new(Depths::new((200, 100), near)));
        let hidden = marks(&View { nearest, ..View::of(&[GROUND]) }, &moment(), None);
        assert_eq!(labels(&hidden), ["x 2 m", "z 2 m"], "the y axis is hidden");
        assert!(found.len() > 30 && found.len() < 60, "{}", found.len());
        assert_eq!(marks(&View::default(), &moment(), None), []);
    }
}
