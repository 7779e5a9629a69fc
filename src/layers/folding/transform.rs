//! Moves, turns, stretches and mirrors what stands in a layer's picture: zones with all that is in them, tools, outlines,
//! points. It works on what is written, so that nothing else comes to be written.

use kurbo::{Affine, Point, Rect, Vec2};
use serde::Deserialize;
use serde_json::{Value, json};

use super::kinds;
use super::outline::Outline;
use crate::base::maths;
use crate::base::number;
use crate::base::pointer::{self, Pointer};

/// The fields that hold a place or several.
const PLACES: &[&str] = &["at", "center", "from", "to", "points"];
/// The fields that hold a vector from one.
const VECTORS: &[&str] = &["in", "out", "jump", "by", "offset"];
/// The fields that hold a length, which grows with the scale.
const LENGTHS: &[&str] = &["feather", "radius", "ring", "spacing"];
/// The fields that hold any of these further down.
const DEEPER: &[&str] =
    &["zones", "outline", "motion", "fold", "regions", "nodes", "vertices", "jumps", "sampler", "interpolation"];

/// The `value` at `path` (relative to the layer) under an affine map of the picture, and the box around its places before;
/// `None` if it has none.
///
/// # Errors
/// Why it cannot be moved.
pub fn transformed(path: &str, value: &Value, by: Affine) -> Option<Result<(Value, Rect), String>> {
    let tokens: Vec<String> = Pointer(path).tokens().collect();
    if tokens.iter().any(|token| token == "position") {
        return None;
    }
    let key = tokens.iter().rev().find(|token| pointer::index(token).is_none()).map_or("", String::as_str);
    let (mut map, mut value) = (Map { by, seen: None }, value.clone());
    match map.change(&mut value, key) {
        Ok(()) => map.seen.map(|seen| Ok((value, seen))),
        Err(why) => Some(Err(why)),
    }
}

/// A map of the picture, and the box around the places that it was applied to.
struct Map {
    by: Affine,
    seen: Option<Rect>,
}

/// Why what is made of shapes of the scene is not moved by itself.
const SHARED: &str = "it is made of shared shapes: move those, or make it its own first (:unshare)";

/// Two numbers that differ by less are equal.
const NEAR: f64 = 1e-9;

fn is_near(a: f64, b: f64) -> bool {
    (a - b).abs() < NEAR
}

fn pair(x: f64, y: f64) -> Value {
    json!([number::json(number::tidy(x)), number::json(number::tidy(y))])
}

impl Map {
    fn place(&mut self, at: Point) -> Point {
        let own = Rect::from_points(at, at);
        self.seen = Some(self.seen.map_or(own, |seen| seen.union_pt(at)));
        self.by * at
    }

    fn vector(&self, v: Vec2) -> Vec2 {
        let [a, b, c, d, ..] = self.by.as_coeffs();
        Vec2::new(a * v.x + c * v.y, b * v.x + d * v.y)
    }

    /// By how much lengths grow, on average.
    fn scale(&self) -> f64 {
        self.by.determinant().abs().sqrt()
    }

    /// Whether upright boxes stay upright.
    fn is_upright(&self) -> bool {
        let [a, b, c, d, ..] = self.by.as_coeffs();
        is_near(b, 0.0) && is_near(c, 0.0) || is_near(a, 0.0) && is_near(d, 0.0)
    }

    /// Whether shapes stay similar.
    fn is_even(&self) -> bool {
        let [a, b, c, d, ..] = self.by.as_coeffs();
        is_near(a * c + b * d, 0.0) && is_near(a * a + b * b, c * c + d * d)
    }

    /// 1, or -1 if it mirrors.
    fn turn(&self) -> f64 {
        self.by.determinant().signum()
    }

    /// Changes what is in the field `key`.
    fn change(&mut self, value: &mut Value, key: &str) -> Result<(), String> {
        if let Some(&[x, y]) = numbers(value).as_deref() {
            if PLACES.contains(&key) {
                let Point { x, y } = self.place(Point::new(x, y));
                *value = pair(x, y);
            } else if VECTORS.contains(&key) {
                let Vec2 { x, y } = self.vector(Vec2::new(x, y));
                *value = pair(x, y);
            }
            return Ok(());
        }
        match value {
            Value::Number(old) if LENGTHS.contains(&key) => {
                let new = old.as_f64().unwrap_or(0.0) * self.scale();
                *value = number::json(number::tidy(new));
                Ok(())
            }
            Value::Array(items) => items.iter_mut().try_for_each(|item| self.change(item, key)),
            Value::Object(fields) => {
                let word = |name: &str| fields.get(name).and_then(Value::as_str).unwrap_or_default().to_owned();
                match (word("kind").as_str(), word("tool").as_str(), word("rule").as_str()) {
                    ("shapes", ..) => Err(SHARED.into()),
                    (_, "curve", _) if fields.get("nodes").is_some_and(Value::is_string) => Err(SHARED.into()),
                    ("rectangle" | "ellipse", ..) => self.box_shape(value),
                    (_, "curve", _) if word("frame") == "curve" => self.curve(value),
                    (_, "scale" | "rotate" | "shear" | "affine", _) => self.dense(value),
                    (_, "field", _) => Err("a field that is read from a file stays where it is".into()),
                    (.., "mask") => {
                        Err("a mask is a picture, which stays where it is: take the fold away first".into())
                    }
                    _ => self.fields(value),
                }
            }
            _ => Ok(()),
        }
    }

    /// Changes all fields of an object that have something to do with places.
    fn fields(&mut self, value: &mut Value) -> Result<(), String> {
        let fields = value.as_object_mut().into_iter().flatten();
        let known = |key: &str| [PLACES, VECTORS, LENGTHS, DEEPER].iter().any(|list| list.contains(&key));
        fields.filter(|(key, _)| known(key)).try_for_each(|(key, inner)| self.change(inner, key))
    }

    /// A rectangle or an ellipse: it becomes a polygon or a path where it would not be upright.
    fn box_shape(&mut self, value: &mut Value) -> Result<(), String> {
        let outline = Outline::deserialize(&*value).map_err(|error| error.to_string())?;
        let (to, rect) = match &outline {
            Outline::Rectangle { x, y, width, height } => ("polygon", Rect::new(*x, *y, x + width, y + height)),
            Outline::Ellipse { center: [x, y], radii: [w, h] } => ("path", Rect::new(x - w, y - h, x + w, y + h)),
            Outline::Polygon { .. } | Outline::Path { .. } | Outline::Shapes { .. } => return self.fields(value),
        };
        if !self.is_upright() {
            *value = kinds::outline_as(&outline, to).ok_or("this outline cannot be turned")?;
            return self.fields(value);
        }
        self.seen = Some(self.seen.map_or(rect, |seen| seen.union(rect)));
        let Rect { x0, y0, x1, y1 } = self.by.transform_rect_bbox(rect);
        let json = |number: f64| number::json(number::tidy(number));
        let new = match to {
            "polygon" => vec![("x", json(x0)), ("y", json(y0)), ("width", json(x1 - x0)), ("height", json(y1 - y0))],
            _ => vec![
                ("center", pair((x0 + x1) / 2.0, (y0 + y1) / 2.0)),
                ("radii", pair((x1 - x0) / 2.0, (y1 - y0) / 2.0)),
            ],
        };
        new.into_iter().for_each(|(name, number)| value[name] = number);
        Ok(())
    }

    /// A curve whose jump vectors are measured along it and to its left, which is its right in a mirror.
    fn curve(&mut self, value: &mut Value) -> Result<(), String> {
        if !self.is_even() {
            return Err("the jump vectors of a curve in its own frame are only scaled evenly".into());
        }
        let (scale, turn) = (self.scale(), self.turn());
        for jump in value.get_mut("jumps").and_then(Value::as_array_mut).into_iter().flatten() {
            if let Some(&[along, left]) = jump.get("jump").and_then(numbers).as_deref() {
                jump["jump"] = pair(along * scale, left * scale * turn);
            }
        }
        value.get_mut("nodes").map_or(Ok(()), |nodes| self.change(nodes, "nodes"))
    }

    /// A dense tool maps places to places: the new one goes back, does what the old one does, and comes again. Where its own
    /// kind cannot say that, it becomes an affine map.
    fn dense(&mut self, value: &mut Value) -> Result<(), String> {
        let center =
            value.get("center").and_then(numbers).and_then(|all| Some(Point::new(*all.first()?, *all.get(1)?)));
        let own = self.own_map(value, center.unwrap_or_default()).ok_or("this tool cannot be read")?;
        let [a, b, c, d, e, f] = (self.by * own * self.by.inverse()).as_coeffs();
        let to = center.map(|center| self.place(center));
        let upright = is_near(b, 0.0) && is_near(c, 0.0);
        let sheared = is_near(a, 1.0) && is_near(d, 1.0);
        let even = self.is_even();
        let turn = self.turn();
        let kept = match value["tool"].as_str() {
            Some("scale") if upright => Some(("factor", pair(a, d))),
            Some("rotate") if even => {
                let degrees = value["degrees"].as_f64().unwrap_or(0.0);
                Some(("degrees", number::json(degrees * turn)))
            }
            Some("shear") if sheared => Some(("factor", pair(c, b))),
            _ => None,
        };
        match (kept, to) {
            (Some((field, new)), Some(to)) => {
                value[field] = new;
                value["center"] = pair(to.x, to.y);
            }
            _ => {
                // An affine map has no place of its own: its zone has.
                let json = |number: f64| number::json(number::tidy(number));
                let rows = [[a, c, e], [b, d, f]].map(|row| Value::from(row.map(json).to_vec()));
                *value = json!({ "tool": "affine", "matrix": rows });
            }
        }
        Ok(())
    }

    /// Where a dense tool maps places to.
    fn own_map(&self, value: &Value, center: Point) -> Option<Affine> {
        let factor = || numbers(value.get("factor")?).and_then(|all| Some((*all.first()?, *all.get(1)?)));
        let linear = match value["tool"].as_str()? {
            "scale" => factor().map(|(x, y)| [x, 0.0, 0.0, y])?,
            "shear" => factor().map(|(a, b)| [1.0, b, a, 1.0])?,
            "rotate" => {
                let angle = value.get("degrees")?.as_f64()?.to_radians();
                let (sin, cos) = (maths::sin(angle), maths::cos(angle));
                [cos, sin, -sin, cos]
            }
            _ => {
                let row =
                    |i: usize| numbers(value.get("matrix")?.get(i)?).and_then(|row| <[f64; 3]>::try_from(row).ok());
                let ([a, c, e], [b, d, f]) = (row(0)?, row(1)?);
                return Some(Affine::new([a, b, c, d, e, f]));
            }
        };
        let [a, b, c, d] = linear;
        let about = center.to_vec2();
        Some(Affine::translate(about) * Affine::new([a, b, c, d, 0.0, 0.0]) * Affine::translate(-about))
    }
}

/// A list of numbers.
fn numbers(value: &Value) -> Option<Vec<f64>> {
    value.as_array().filter(|items| !items.is_empty())?.iter().map(Value::as_f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quarter() -> Affine {
        // Counter-clockwise on the screen about the origin: (x, y) goes to (y, -x).
        Affine::new([0.0, -1.0, 1.0, 0.0, 0.0, 0.0])
    }

    #[test]
    fn everything_with_a_place_goes_there() {
        let mirror = Affine::new([-1.0, 0.0, 0.0, 1.0, 100.0, 0.0]);
        let double = Affine::scale(2.0);
        let eighth = Affine::new([0.6, -0.8, 0.8, 0.6, 0.0, 0.0]);
        let rectangle = json!({ "kind": "rectangle", "x": 20, "y": 45, "width": 30, "height": 10 });
        for (path, value, by, expected) in [
            (
                "/zones/0/outline",
                rectangle.clone(),
                quarter(),
                json!({ "kind": "rectangle", "x": 45, "y": -50, "width": 10, "height": 30 }),
            ),
            (
                "/zones/0/outline",
                rectangle.clone(),
                mirror,
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
            ("/zones/0/outline/points/2", json!([10, 20]), mirror, json!([90, 20])),
            (
                "/zones/0/outline/nodes/1",
                json!({ "at": [10, 20], "in": [1, 2] }),
                mirror,
                json!({ "at": [90, 20], "in": [-1, 2] }),
            ),
            (
                "/zones/0/motion/0",
                json!({ "tool": "point", "at": [10, 20], "jump": [3, 4] }),
                quarter(),
                json!({ "tool": "point", "at": [20, -10], "jump": [4, -3] }),
            ),
            (
                "/zones/0/motion/0",
                json!({ "tool": "lasso", "vertices": [{ "from": [1, 2], "to": [3, 4] }] }),
                double,
                json!({ "tool": "lasso", "vertices": [{ "from": [2, 4], "to": [6, 8] }] }),
            ),
            (
                "/zones/0/motion/0",
                json!({ "tool": "curve", "frame": "curve", "nodes": [{ "at": [1, 2] }], "jumps": [{ "along": 0, "jump": [3, 4] }] }),
                mirror,
                json!({ "tool": "curve", "frame": "curve", "nodes": [{ "at": [99, 2] }], "jumps": [{ "along": 0, "jump": [3, -4] }] }),
            ),
            (
                "/zones/0/motion/0",
                json!({ "tool": "rotate", "center": [1, 2], "degrees": 15 }),
                mirror,
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
                mirror,
                json!({ "tool": "shear", "center": [99, 2], "factor": [-0.5, 0] }),
            ),
            (
                "/zones/0",
                json!({ "name": "a", "outline": { "kind": "polygon", "points": [[1, 2]] }, "feather": 3,
                "interpolation": { "method": "modified-shepard", "radius": 60 }, "position": { "function": "keyframes", "points": [[0, 1]] },
                "motion": [{ "tool": "still-border", "spacing": 8 }, { "tool": "translate", "by": [1, 2] }] }),
                double,
                json!({ "name": "a", "outline": { "kind": "polygon", "points": [[2, 4]] }, "feather": 6,
                "interpolation": { "method": "modified-shepard", "radius": 120 }, "position": { "function": "keyframes", "points": [[0, 1]] },
                "motion": [{ "tool": "still-border", "spacing": 16 }, { "tool": "translate", "by": [2, 4] }] }),
            ),
        ] {
            let (new, _) = transformed(path, &value, by).unwrap().unwrap();
            assert_eq!(new, expected, "{value}");
        }
    }

    #[test]
    fn a_dense_tool_that_its_kind_cannot_say_becomes_an_affine_map() {
        let eighth = Affine::new([0.6, -0.8, 0.8, 0.6, 0.0, 0.0]);
        let scale = json!([{ "tool": "scale", "center": [10, 0], "factor": [2, 1] }]);
        let (new, seen) = transformed("/zones/0/motion", &scale, eighth).unwrap().unwrap();
        assert_eq!((&new[0]["tool"], seen), (&json!("affine"), Rect::new(10.0, 0.0, 10.0, 0.0)));
        // What it did to a place before, it does to where that place has gone.
        let map = |row: usize, at: Point| {
            let row: Vec<f64> = numbers(&new[0]["matrix"][row]).unwrap();
            row[0] * at.x + row[1] * at.y + row[2]
        };
        let (at, to) = (eighth * Point::new(13.0, 5.0), eighth * Point::new(16.0, 5.0));
        assert!(is_near(map(0, at), to.x) && is_near(map(1, at), to.y), "{new}");
    }

    #[test]
    fn what_cannot_move_says_so() {
        let by = Affine::scale_non_uniform(2.0, 1.0);
        for (path, value, part) in [
            ("/zones/0/motion/0", json!({ "tool": "field", "path": "a.flo" }), "stays where it is"),
            ("/zones/0/fold", json!({ "rule": "mask", "image": "a" }), "a mask is a picture"),
            ("/zones/0/outline", json!({ "kind": "shapes", "parts": [{ "shape": "lid" }] }), "made of shared shapes"),
            ("/zones/0/motion/0", json!({ "tool": "curve", "nodes": "lid", "jumps": [] }), "made of shared shapes"),
            (
                "/zones/0/motion/0",
                json!({ "tool": "curve", "frame": "curve", "nodes": [], "jumps": [] }),
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
