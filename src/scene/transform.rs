//! Moves, turns, stretches and mirrors what stands in a picture, with all that is in it: places, vectors and lengths, as the
//! schema tells which fields these are. It works on what is written, so that nothing else comes to be written.

use kurbo::{Affine, Point, Rect, Vec2};
use serde_json::Value;

use super::Document;
use super::field::layer_of;
use super::schema::{Body, Place, Shape};
use crate::base::pointer::Pointer;
use crate::layers::parts::moving::{Moved, Mover, Moving, pair, written, xy};

/// What is at `pointer` under an affine map of the picture, and the box around its places before; `None` if it has none.
///
/// # Errors
/// Why it cannot be moved.
pub fn transformed(document: &Document, pointer: &str, by: Affine) -> Option<Result<(Value, Rect), String>> {
    let is_shape = Pointer(pointer).below("/shapes").is_some_and(|way| !way.is_empty());
    let mover = if is_shape {
        |_: &mut _, _: &mut _| Ok(Moved::FieldsBut(&[]))
    } else {
        layer_of(document, pointer)?.0.mover()?
    };
    let place = Place::of(document.json(), pointer)?;
    under(by, mover, place.shape, place.value?)
}

fn under(by: Affine, mover: Mover, shape: Shape, value: &Value) -> Option<Result<(Value, Rect), String>> {
    let (mut moving, mut value) = (Moving { by, seen: None }, value.clone());
    match change(&mut moving, mover, shape, &mut value) {
        Ok(()) => moving.seen.map(|seen| Ok((value, seen))),
        Err(why) => Some(Err(why)),
    }
}

fn change(moving: &mut Moving, mover: Mover, shape: Shape, value: &mut Value) -> Result<(), String> {
    let in_picture = shape.unit() == Some("px");
    match (shape.body(), value) {
        // Sizes are no places: what has them moves them.
        (Body::Numbers(2), value) if in_picture && shape.range().is_none_or(|(least, _)| least < 0.0) => {
            let Some((x, y)) = xy(value) else { return Ok(()) };
            let (x, y) = match shape.is_relative() {
                true => moving.vector(Vec2::new(x, y)).into(),
                false => moving.place(Point::new(x, y)).into(),
            };
            *value = pair(x, y);
        }
        (Body::Number { .. }, value @ Value::Number(_)) if in_picture => {
            *value = written(value.as_f64().unwrap_or(0.0) * moving.scale());
        }
        (Body::List(item, ..), Value::Array(items)) => {
            items.iter_mut().try_for_each(|value| change(moving, mover, item, value))?;
        }
        (Body::Object | Body::Tagged(_), value @ Value::Object(_)) => {
            let Moved::FieldsBut(others) = mover(moving, value)? else { return Ok(()) };
            let Some(branch) = shape.branch(Some(value)) else { return Ok(()) };
            for (name, value) in value.as_object_mut().into_iter().flatten() {
                let field = branch.property(None, name).filter(|_| !others.contains(&name.as_str()));
                field.map_or(Ok(()), |field| change(moving, mover, field, value))?;
            }
        }
        // What is no place and no length stays; so does what is not written as the schema has it.
        (Body::Number { .. } | Body::Numbers(_) | Body::Text | Body::Bool | Body::Choice | Body::Row(_), _) => {}
        (Body::List(..) | Body::Map(_) | Body::Object | Body::Tagged(_), _) => {}
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// A value at a place of a layer that folds, under a map.
    fn transformed(path: &str, value: &Value, by: Affine) -> Option<Result<(Value, Rect), String>> {
        let layer = json!({ "kind": "picture", "name": "l", "image": "a" });
        let json = json!({ "plica": 1, "images": { "a": { "path": "a.png" } }, "layers": [layer] });
        let document = Document::from_json(json).unwrap();
        let way = format!("/layers/0{path}");
        let deeper =
            |shapes: Vec<Shape>, token: String| shapes.into_iter().flat_map(|shape| shape.below(&token)).collect();
        let shapes = Pointer(&way).tokens().fold(vec![Shape::root()], deeper);
        under(by, document.scene().layers[0].technique().mover()?, *shapes.first()?, value)
    }

    fn quarter() -> Affine {
        // Counter-clockwise on the screen about the origin: (x, y) goes to (y, -x).
        Affine::new([0.0, -1.0, 1.0, 0.0, 0.0, 0.0])
    }

    fn mirror() -> Affine {
        Affine::new([-1.0, 0.0, 0.0, 1.0, 100.0, 0.0])
    }

    /// What each becomes by a transform.
    fn go_there(cases: &[(&str, Value, Affine, Value)]) {
        for (path, value, by, expected) in cases {
            let (new, _) = transformed(path, value, *by).unwrap().unwrap();
            assert_eq!(new, *expected, "{value}");
        }
    }

    #[test]
    fn outlines_and_what_they_are_made_of_go_there() {
        let eighth = Affine::new([0.6, -0.8, 0.8, 0.6, 0.0, 0.0]);
        let rectangle = json!({ "kind": "rectangle", "x": 20, "y": 45, "width": 30, "height": 10 });
        go_there(&[
            (
                "/zones/0/outline",
                rectangle.clone(),
                quarter(),
                json!({ "kind": "rectangle", "x": 45, "y": -50, "width": 10, "height": 30 }),
            ),
            (
                "/zones/0/outline",
                rectangle.clone(),
                mirror(),
                json!({ "kind": "rectangle", "x": 50, "y": 45, "width": 30, "height": 10 }),
            ),
            (
                "/zones/0/fold/regions/0",
                rectangle,
                eighth,
                json!({ "kind": "polygon", "points": [[48, 11], [66, -13], [74, -7], [56, 17]] }),
            ),
            (
                "/zones/0/outline",
                json!({ "kind": "ellipse", "center": [10, 20], "radii": [3, 5] }),
                quarter(),
                json!({ "kind": "ellipse", "center": [20, -10], "radii": [5, 3] }),
            ),
            ("/zones/0/outline/points/2", json!([10, 20]), mirror(), json!([90, 20])),
            (
                "/zones/0/outline/nodes/1",
                json!({ "at": [10, 20], "in": [1, 2] }),
                mirror(),
                json!({ "at": [90, 20], "in": [-1, 2] }),
            ),
        ]);
    }

    #[test]
    fn tools_and_zones_go_there() {
        go_there(&[
            (
                "/zones/0/motion/0",
                json!({ "tool": "point", "at": [10, 20], "jump": [3, 4] }),
                quarter(),
                json!({ "tool": "point", "at": [20, -10], "jump": [4, -3] }),
            ),
            (
                "/zones/0/motion/0",
                json!({ "tool": "lasso", "vertices": [{ "from": [1, 2], "to": [3, 4] }] }),
                Affine::scale(2.0),
                json!({ "tool": "lasso", "vertices": [{ "from": [2, 4], "to": [6, 8] }] }),
            ),
            (
                "/zones/0/motion/0",
                json!({ "tool": "curve", "frame": "curve", "samples": 2, "nodes": [{ "at": [1, 2] }], "jumps": [{ "along": 0, "jump": [3, 4] }] }),
                mirror(),
                json!({ "tool": "curve", "frame": "curve", "samples": 2, "nodes": [{ "at": [99, 2] }], "jumps": [{ "along": 0, "jump": [3, -4] }] }),
            ),
            (
                "/zones/0/motion/0",
                json!({ "tool": "rotate", "center": [1, 2], "degrees": 15 }),
                mirror(),
                json!({ "tool": "rotate", "center": [99, 2], "degrees": -15 }),
            ),
            (
                "/zones/0/motion/0",
                json!({ "tool": "scale", "center": [1, 2], "factor": [3, 4] }),
                quarter(),
                json!({ "tool": "scale", "center": [2, -1], "factor": [4, 3] }),
            ),
            (
                "/zones/0/motion/0",
                json!({ "tool": "shear", "center": [1, 2], "factor": [0.5, 0] }),
                mirror(),
                json!({ "tool": "shear", "center": [99, 2], "factor": [-0.5, 0] }),
            ),
            (
                "/zones/0",
                json!({ "name": "a", "outline": { "kind": "polygon", "points": [[1, 2]] }, "feather": 3,
                "interpolation": { "method": "modified-shepard", "radius": 60 }, "position": { "function": "keyframes", "points": [[0, 1]] },
                "motion": [{ "tool": "still-border", "spacing": 8 }, { "tool": "translate", "by": [1, 2] }] }),
                Affine::scale(2.0),
                json!({ "name": "a", "outline": { "kind": "polygon", "points": [[2, 4]] }, "feather": 6,
                "interpolation": { "method": "modified-shepard", "radius": 120 }, "position": { "function": "keyframes", "points": [[0, 1]] },
                "motion": [{ "tool": "still-border", "spacing": 16 }, { "tool": "translate", "by": [2, 4] }] }),
            ),
        ]);
    }

    #[test]
    fn a_dense_tool_that_its_kind_cannot_say_becomes_an_affine_map() {
        let eighth = Affine::new([0.6, -0.8, 0.8, 0.6, 0.0, 0.0]);
        let scale = json!([{ "tool": "scale", "center": [10, 0], "factor": [2, 1] }]);
        let (new, seen) = transformed("/zones/0/motion", &scale, eighth).unwrap().unwrap();
        assert_eq!((&new[0]["tool"], seen), (&json!("affine"), Rect::new(10.0, 0.0, 10.0, 0.0)));
        // What it did to a place before, it does to where that place has gone.
        let map = |row: usize, at: Point| {
            let row: Vec<f64> = serde_json::from_value(new[0]["matrix"][row].clone()).unwrap();
            row[0] * at.x + row[1] * at.y + row[2]
        };
        let (at, to) = (eighth * Point::new(13.0, 5.0), eighth * Point::new(16.0, 5.0));
        assert!((map(0, at) - to.x).abs() < 1e-9 && (map(1, at) - to.y).abs() < 1e-9, "{new}");
    }

    #[test]
    fn what_cannot_move_says_so() {
        let by = Affine::scale_non_uniform(2.0, 1.0);
        for (path, value, part) in [
            ("/zones/0/motion/0", json!({ "tool": "field", "path": "a.flo" }), "stays where it is"),
            ("/zones/0/fold", json!({ "rule": "mask", "image": "a" }), "a mask is a picture"),
            ("/zones/0/outline", json!({ "kind": "shapes", "parts": [{ "shape": "lid" }] }), "made of shared shapes"),
            (
                "/zones/0/motion/0",
                json!({ "tool": "curve", "samples": 2, "nodes": "lid", "jumps": [] }),
                "made of shared shapes",
            ),
            (
                "/zones/0/motion/0",
                json!({ "tool": "curve", "frame": "curve", "samples": 2, "nodes": [], "jumps": [] }),
                "scaled evenly",
            ),
        ] {
            assert!(transformed(path, &value, by).unwrap().unwrap_err().contains(part), "{value}");
        }
        for (path, value) in [
            ("/zones/0/position/points/0", json!([0, 1])),
            ("/zones/0/name", json!("a")),
            ("/zones/0/motion/0/jumps/0", json!({ "along": 0, "jump": [1, 2] })),
        ] {
            assert!(transformed(path, &value, by).is_none(), "{value}");
        }
    }
}
