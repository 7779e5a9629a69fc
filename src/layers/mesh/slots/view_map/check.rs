//! What can be wrong with a view map on its own. Paths are relative to the surface.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec3};

use super::model::{BlendPoint, Extremes, View, ViewCamera, ViewMap};
use crate::base::geometry::Xy;
use crate::base::maths;
use crate::base::problem::Problem;
use crate::base::text::short;
use crate::layers::check as rules;
use crate::layers::parts::shots::Feeds;

/// How far a matrix may be from a rotation.
const ROTATION_OFF: f64 = 1e-3;
/// The most directions to a side of an array.
const MOST_DIRECTIONS: f64 = 32.0;

/// The checks beyond shape.
pub fn problems(map: &ViewMap) -> Vec<Problem> {
    let names = map.views.iter().enumerate().map(|(i, view)| (format!("/views/{i}/name"), view.name.as_str()));
    let mut problems = rules::names(names);
    problems.extend(rules::color(&map.missing, "/missing"));
    for (i, view) in map.views.iter().enumerate() {
        let odd = of_view(view).into_iter().chain(map.directions.and_then(|side| narrow(view, side)));
        problems.extend(odd.map(|problem| problem.under(&format!("/views/{i}"))));
    }
    for (i, point) in map.blend.points.iter().enumerate() {
        problems.extend(of_blend_point(point).map(|problem| problem.under(&format!("/blend/points/{i}"))));
    }
    problems
}

fn of_view(view: &View) -> Vec<Problem> {
    let mut problems: Vec<_> = of_camera(&view.camera).into_iter().map(|problem| problem.under("/camera")).collect();
    if let Extremes::Points { points } = &view.extremes
        && !go_round(points)
    {
        let message = "they do not go round the view";
        let problem = Problem::error("/extremes/points", message);
        problems.push(problem.hint("list them in order, on all sides of [0, 0]"));
    }
    if view.kind == Feeds::Independent && view.extremes != Extremes::default() {
        let problem = Problem::warning("/extremes", "an independent view has none: it is seen from everywhere");
        problems.push(problem.hint("set its kind to both or dependent, or its extremes to auto"));
    }
    problems
}

/// A cone that falls between the elements of the arrays of directions, which have so many to a side.
fn narrow(view: &View, side: u32) -> Option<Problem> {
    let Extremes::Cone { degrees } = view.extremes else { return None };
    // Of the directions near the normal, where elements are narrowest.
    let element = (4.0 / f64::from(side)).to_degrees();
    let counts = view.active && view.kind != Feeds::Independent;
    (counts && degrees < element).then(|| {
        let message = format!(
            "a cone of {degrees} degrees to each side is narrower than two elements of {side} x {side} directions, {} degrees",
            short(2.0 * element, 1)
        );
        let wanted = (4.0_f64.to_degrees() / degrees).ceil();
        Problem::warning("/extremes", message).hint(match wanted <= MOST_DIRECTIONS {
            true => format!("set directions to {wanted}, or take it out: they are exact then"),
            false => "take directions out: they are exact then".to_owned(),
        })
    })
}

fn of_blend_point(point: &BlendPoint) -> Option<Problem> {
    let nowhere = (DVec3::from(point.target) - DVec3::from(point.position)).try_normalize().is_none();
    nowhere.then(|| Problem::error("/position", "the point looks nowhere").hint("move its position or its target"))
}

fn of_camera(camera: &ViewCamera) -> Option<Problem> {
    match (camera.position, &camera.matrix) {
        (None, None) => {
            let problem = Problem::error("", "the camera is nowhere");
            Some(problem.hint("give it a position and a target, or a matrix and focal lengths"))
        }
        (Some(_), Some(_)) => {
            let problem = Problem::error("", "the camera has a position and a matrix");
            Some(problem.hint("leave one of them out"))
        }
        (Some(position), None) => placed(camera, position.into()),
        (None, Some(matrix)) => by_matrix(camera, matrix),
    }
}

/// A camera by position and target.
fn placed(camera: &ViewCamera, position: DVec3) -> Option<Problem> {
    let stray =
        [("focal", camera.focal.is_some()), ("center", camera.center.is_some()), ("size", camera.size.is_some())];
    if let Some((name, _)) = stray.into_iter().find(|(_, given)| *given) {
        let problem = Problem::error(format!("/{name}"), format!("{name} is of cameras with a matrix"));
        return Some(problem.hint("leave it out; fov is the field of view"));
    }
    let up = DVec3::from(camera.up.unwrap_or([0.0, 1.0, 0.0])).try_normalize();
    let along = (DVec3::from(camera.target.unwrap_or_default()) - position).try_normalize();
    let looks = up.zip(along).is_some_and(|(up, along)| along.cross(up).length() >= 1e-9);
    (!looks).then(|| {
        let problem = Problem::error("", "the camera looks nowhere");
        problem.hint("move its position or its target, or turn up")
    })
}

/// A camera by its matrix.
fn by_matrix(camera: &ViewCamera, matrix: &[[f64; 4]; 3]) -> Option<Problem> {
    let stray = [("target", camera.target.is_some()), ("up", camera.up.is_some()), ("fov", camera.fov.is_some())];
    if let Some((name, _)) = stray.into_iter().find(|(_, given)| *given) {
        let problem = Problem::error(format!("/{name}"), format!("{name} is of cameras with a position"));
        return Some(problem.hint("leave it out; the matrix and focal lengths say it"));
    }
    let off = rotation_off(matrix);
    if off > ROTATION_OFF {
        let message = format!("rows are no rotation (off by {off:.2})");
        return Some(Problem::error("/matrix", message).hint("world-to-camera, x right, y down, z forward"));
    }
    let Some([across, down]) = camera.focal else {
        return Some(
            Problem::error("", "a camera with a matrix has no focal lengths").hint("give focal, [fx, fy] in px"),
        );
    };
    (across <= 0.0 || down <= 0.0).then(|| {
        let problem = Problem::error("/focal", format!("a focal length is not above 0 ([{across}, {down}])"));
        problem.hint("give focal, [fx, fy] in px")
    })
}

/// The greatest difference from 1 and 0 of the products of the rows, or 2 where they mirror.
pub fn rotation_off(matrix: &[[f64; 4]; 3]) -> f64 {
    let rows = matrix.map(|[x, y, z, _]| DVec3::new(x, y, z));
    let turn = DMat3::from_cols(rows[0], rows[1], rows[2]);
    let products = turn.transpose() * turn - DMat3::IDENTITY;
    let off = products.to_cols_array().into_iter().fold(0.0, |most: f64, one| most.max(one.abs()));
    // Rows as columns: the same determinant.
    if turn.determinant() < 0.0 { off.max(2.0) } else { off }
}

/// Whether extreme points go once round [0, 0], one way or the other.
fn go_round(points: &[Xy]) -> bool {
    let turn = |[ax, ay]: Xy, [bx, by]: Xy| maths::atan2(ax * by - ay * bx, ax * bx + ay * by);
    let next = points.iter().cycle().skip(1);
    let turns: Vec<f64> = points.iter().zip(next).map(|(one, next)| turn(*one, *next)).collect();
    let sum: f64 = turns.iter().sum();
    let onward = turns.iter().all(|turn| turn * sum >= 0.0 && turn.abs() < PI - 1e-9);
    onward && (sum.abs() - TAU).abs() < 1e-6
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    fn found(view: Value) -> Vec<(String, String)> {
        let mut whole = json!({ "name": "a", "image": "a", "camera": { "position": [0, 0, 4] } });
        for (key, value) in view.as_object().unwrap() {
            whole[key] = value.clone();
        }
        let map: ViewMap = serde_json::from_value(json!({ "views": [whole] })).unwrap();
        problems(&map).into_iter().map(|problem| (problem.path, problem.message)).collect()
    }

    #[test]
    fn what_is_wrong_names_its_place() {
        let nowhere = "the camera looks nowhere";
        let scaled = [[1.2, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 4.0]];
        let mirrored = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 4.0]];
        for (view, path, message) in [
            (json!({ "camera": { "position": [0, 0, 0] } }), "/camera", nowhere),
            (json!({ "camera": { "position": [0, 2, 0] } }), "/camera", nowhere),
            (json!({ "camera": {} }), "/camera", "the camera is nowhere"),
            (json!({ "camera": { "position": [0, 0, 1], "size": [2, 2] } }), "/camera/size", "size is of cameras"),
            (json!({ "camera": { "matrix": scaled, "focal": [1, 1] } }), "/camera/matrix", "(off by 0.44)"),
            (json!({ "camera": { "matrix": mirrored, "focal": [1, 1] } }), "/camera/matrix", "(off by 2.00)"),
            (
                json!({ "extremes": { "kind": "points", "points": [[1, 0], [0, 1], [-1, 0]] } }),
                "/extremes/points",
                "they do not go round the view",
            ),
            (
                json!({ "kind": "independent", "extremes": { "kind": "cone" } }),
                "/extremes",
                "an independent view has none",
            ),
        ] {
            let found = found(view.clone());
            assert_eq!(found.len(), 1, "{view}: {found:?}");
            assert_eq!(found[0].0, format!("/views/0{path}"), "{view}");
            assert!(found[0].1.contains(message), "{found:?}");
        }
    }

    #[test]
    fn a_cone_is_wider_than_two_elements() {
        let exact = "take directions out: they are exact then";
        let odd = |side: Value, view: Value| {
            let mut whole = json!({ "name": "a", "image": "a", "camera": { "position": [0, 0, 4] } });
            whole.as_object_mut().unwrap().extend(view.as_object().unwrap().clone());
            let map = serde_json::from_value(json!({ "directions": side, "views": [whole] })).unwrap();
            problems(&map).into_iter().map(|problem| problem.to_string()).collect::<String>()
        };
        let cone = |degrees: f64| json!({ "extremes": { "kind": "cone", "degrees": degrees } });
        // An element is 28.6 degrees wide of 8 to a side, 14.3 of 16.
        for (side, view, told) in [
            (json!(8), cone(29.0), ""),
            (
                json!(8),
                cone(28.0),
                "two elements of 8 x 8 directions, 57.3 degrees (set directions to 9, or take it out",
            ),
            (json!(16), cone(15.0), ""),
            (json!(16), cone(14.0), "narrower than two elements of 16 x 16 directions, 28.6 degrees"),
            (json!(16), cone(7.0), exact),
            (Value::Null, cone(1.0), ""),
            (json!(4), json!({ "active": false, "extremes": { "kind": "cone", "degrees": 10 } }), ""),
            (json!(4), json!({}), ""),
        ] {
            let found = odd(side.clone(), view.clone());
            let is_told = found.starts_with("views.0.extremes: warning: a cone of ") && found.contains(told);
            assert!(if told.is_empty() { found.is_empty() } else { is_told }, "{side} {view}: {found}");
        }
    }

    #[test]
    fn points_go_round_either_way() {
        let round = [[-30.0, 0.0], [0.0, -20.0], [30.0, 0.0], [0.0, 20.0]];
        let mut back = round;
        back.reverse();
        let twice = [round, round].concat();
        let crossed = [round[0], round[2], round[1], round[3]];
        let all = [(&round[..], true), (&back, true), (&twice, false), (&crossed, false), (&round[..3], false)];
        for (points, good) in all {
            assert_eq!(go_round(points), good, "{points:?}");
        }
    }
}
