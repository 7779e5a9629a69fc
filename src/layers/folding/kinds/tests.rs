//! Every kind turned into every other one.

use serde_json::{Value, json};

use super::*;
use crate::layers::folding::model::Zone;
use crate::layers::folding::outline::Outline;
use crate::layers::folding::position::Position;
use crate::layers::folding::tools::Tool;
use crate::layers::tests::variants;

fn zone() -> Zone {
    let outline = json!({ "kind": "rectangle", "x": 0, "y": 0, "width": 100, "height": 80 });
    serde_json::from_value(json!({ "name": "z", "outline": outline })).unwrap()
}

/// The only resulting thing, and the message about what is lost.
fn one(turned: Option<Turned>) -> (Value, String) {
    let Turned { items, lost } = turned.unwrap();
    assert_eq!(items.len(), 1, "{items:?}");
    (items[0].clone(), lost.unwrap_or_default())
}

#[track_caller]
fn assert_near(found: &Value, expected: &Value) {
    match (found, expected) {
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            a.iter().zip(b).for_each(|(a, b)| assert_near(a, b))
        }
        (Value::Object(a), Value::Object(b)) if a.len() == b.len() => {
            a.iter().for_each(|(key, a)| assert_near(a, b.get(key).unwrap_or_else(|| panic!("{key} in {expected}"))));
        }
        (a, b) if a.is_number() && b.is_number() => {
            let (a, b) = (a.as_f64().unwrap(), b.as_f64().unwrap());
            assert!((a - b).abs() < 1e-4, "{a} {b}");
        }
        (a, b) => assert_eq!(a, b),
    }
}

#[test]
fn outlines_keep_their_shape() {
    let rectangle = json!({ "kind": "rectangle", "x": 10, "y": 5, "width": 80, "height": 40 });
    let ellipse = json!({ "kind": "ellipse", "center": [50, 25], "radii": [40, 20] });
    let polygon = json!({ "kind": "polygon", "points": [[10, 10], [50, 5], [90, 40], [40, 45], [20, 30.123456789]] });
    let straight = json!({ "kind": "path", "nodes": [{ "at": [0, 0] }, { "at": [9, 0] }, { "at": [4, 7.25] }] });
    let curved =
        json!({ "kind": "path", "nodes": [{ "at": [0, 0], "out": [0, 20] }, { "at": [30, 0], "in": [0, 20] }] });
    let k = 0.5522847;
    let of_ellipse = json!({ "kind": "path", "nodes": [
        { "at": [90, 25], "in": [0, -20.0 * k], "out": [0, 20.0 * k] },
        { "at": [50, 45], "in": [40.0 * k, 0], "out": [-40.0 * k, 0] },
        { "at": [10, 25], "in": [0, 20.0 * k], "out": [0, -20.0 * k] },
        { "at": [50, 5], "in": [-40.0 * k, 0], "out": [40.0 * k, 0] },
    ] });
    let nodes = |points: &[[f64; 2]]| json!({ "kind": "path", "nodes": points.iter().map(|at| json!({ "at": at })).collect::<Vec<_>>() });
    let corners = [[10.0, 5.0], [90.0, 5.0], [90.0, 45.0], [10.0, 45.0]];
    for (old, to, new, lost) in [
        (&rectangle, "polygon", json!({ "kind": "polygon", "points": corners }), ""),
        (&rectangle, "path", nodes(&corners), ""),
        (&rectangle, "ellipse", ellipse.clone(), "only the ellipse inside its box is kept: 3200 px² became 2513.27"),
        (&ellipse, "rectangle", rectangle.clone(), "only its box is kept: 2513.27 px² became 3200"),
        (&ellipse, "path", of_ellipse, ""),
        (&polygon, "path", nodes(&[[10.0, 10.0], [50.0, 5.0], [90.0, 40.0], [40.0, 45.0], [20.0, 30.123456789]]), ""),
        (&polygon, "rectangle", rectangle.clone(), "only its box is kept: 1876.85 px² became 3200"),
        (&polygon, "ellipse", ellipse.clone(), "only the ellipse inside its box is kept: 1876.85 px² became 2513.27"),
        (&straight, "polygon", json!({ "kind": "polygon", "points": [[0, 0], [9, 0], [4, 7.25]] }), ""),
        (
            &curved,
            "rectangle",
            json!({ "kind": "rectangle", "x": 0, "y": 0, "width": 30, "height": 15 }),
            "only its box is kept: 360 px² became 450",
        ),
        (
            &curved,
            "ellipse",
            json!({ "kind": "ellipse", "center": [15, 7.5], "radii": [15, 7.5] }),
            "only the ellipse inside its box is kept: 360 px² became 353.43",
        ),
    ] {
        let (found, told) = one(outlines::turned(&read(old).unwrap(), to));
        assert_near(&found, &new);
        assert_eq!(told, lost, "{old} {to}");
    }
    // Curves as straight sides: close to them, and few.
    for (old, most) in [(&ellipse, 70), (&curved, 30)] {
        let (found, told) = one(outlines::turned(&read(old).unwrap(), "polygon"));
        let (curve, sides) = (read::<Outline>(old).unwrap().polygon(), read::<Outline>(&found).unwrap().polygon());
        assert!((8..most).contains(&sides.vertices().len()), "{found}");
        assert!(curve.vertices().iter().all(|&p| sides.distance(p) < 0.051), "{found}");
        assert!(told.ends_with("straight sides, within 0.05 px of it"), "{told}");
    }
    for kind in variants::<Outline>("kind") {
        // A polygon stays as it is, and shapes are made by hand.
        let is_turned = !["polygon", "shapes"].contains(&kind.as_str());
        assert_eq!(outlines::turned(&read(&polygon).unwrap(), &kind).is_some(), is_turned, "{kind}");
    }
    let bow = json!({ "kind": "polygon", "points": [[0, 0], [9, 9], [9, 0], [0, 9]] });
    assert_eq!(one(outlines::turned(&read(&bow).unwrap(), "rectangle")).1, "only its box is kept");
    assert_eq!(outlines::turned(&read(&bow).unwrap(), "polygon"), None);
}

fn tool(old: &Value, to: &str) -> (Vec<Value>, String) {
    let Turned { items, lost } = tools::turned(&zone(), &read(old).unwrap(), to).unwrap();
    (items, lost.unwrap_or_default())
}

/// A tool that is changed into others.
fn old(name: &str) -> Value {
    match name {
        "point" => json!({ "tool": "point", "at": [50, 40], "jump": [3, -4] }),
        "curve" => json!({ "tool": "curve", "samples": 3, "nodes": [{ "at": [0, 0] }, { "at": [10, 0] }],
        "jumps": [{ "along": 0, "jump": [0, 0] }, { "along": 1, "jump": [0, -8] }] }),
        "turning" => json!({ "tool": "curve", "frame": "curve", "samples": 2,
        "nodes": [{ "at": [0, 0] }, { "at": [0, 10] }], "jumps": [{ "along": 0, "jump": [2, 1] }] }),
        "lasso" => json!({ "tool": "lasso", "vertices": [{ "from": [0, 0], "to": [0, 1] },
        { "from": [3, 0], "to": [3, 2] }, { "from": [3, 4], "to": [3, 4] }] }),
        "border" => json!({ "tool": "still-border", "spacing": 90 }),
        "scale" => json!({ "tool": "scale", "center": [10, 20], "factor": [1.5, 0.5] }),
        "turn" => json!({ "tool": "rotate", "center": [10, 20], "degrees": 90 }),
        "shear" => json!({ "tool": "shear", "center": [10, 20], "factor": [0.5, 0] }),
        "move" => json!({ "tool": "translate", "by": [3, -4] }),
        other => panic!("{other}"),
    }
}

fn at(x: f64, y: f64, dx: f64, dy: f64) -> Value {
    json!({ "tool": "point", "at": [x, y], "jump": [dx, dy] })
}

fn drag(x: f64, y: f64, dx: f64, dy: f64) -> Value {
    json!({ "from": [x, y], "to": [x + dx, y + dy] })
}

fn place(along: f64, dx: f64, dy: f64) -> Value {
    json!({ "along": along, "jump": [dx, dy] })
}

/// What tools become, and what is said to be lost.
fn become_these(cases: &[(&str, &str, Vec<Value>, &str)]) {
    for (name, to, new, lost) in cases {
        let (found, told) = tool(&old(name), to);
        assert_near(&found.clone().into(), &new.clone().into());
        assert_eq!(told, *lost, "{name} {to}");
    }
}

#[test]
fn what_gives_anchors_becomes_points() {
    become_these(&[
        (
            "curve",
            "point",
            vec![at(0.0, 0.0, 0.0, 0.0), at(5.0, 0.0, 0.0, -4.0), at(10.0, 0.0, 0.0, -8.0)],
            "the curve is now 3 points, one for each anchor",
        ),
        (
            "turning",
            "point",
            vec![at(0.0, 0.0, 1.0, 2.0), at(0.0, 10.0, 1.0, 2.0)],
            "the curve is now 2 points, one for each anchor",
        ),
        (
            "lasso",
            "point",
            vec![at(0.0, 0.0, 0.0, 1.0), at(3.0, 0.0, 0.0, 2.0), at(3.0, 4.0, 0.0, 0.0)],
            "the lasso is now 3 points, one for each anchor",
        ),
        (
            "border",
            "point",
            vec![at(0.0, 0.0, 0.0, 0.0), at(90.0, 0.0, 0.0, 0.0), at(100.0, 80.0, 0.0, 0.0), at(10.0, 80.0, 0.0, 0.0)],
            "the still-border is now 4 points, one for each anchor",
        ),
    ]);
}

#[test]
fn what_gives_anchors_becomes_lassos_and_curves() {
    become_these(&[
        (
            "curve",
            "lasso",
            vec![json!({ "tool": "lasso", "vertices":
                [drag(0.0, 0.0, 0.0, 0.0), drag(5.0, 0.0, 0.0, -4.0), drag(10.0, 0.0, 0.0, -8.0)] })],
            "the curve's 3 anchors are the vertices",
        ),
        (
            "point",
            "lasso",
            vec![json!({ "tool": "lasso", "vertices": [drag(25.0, 20.0, 3.0, -4.0), drag(75.0, 20.0, 3.0, -4.0),
                drag(75.0, 60.0, 3.0, -4.0), drag(25.0, 60.0, 3.0, -4.0)] })],
            "",
        ),
        (
            "lasso",
            "curve",
            vec![json!({ "tool": "curve", "samples": 4,
                "nodes": [{ "at": [0, 0] }, { "at": [3, 0] }, { "at": [3, 4] }, { "at": [0, 0] }],
                "jumps": [place(0.0, 0.0, 1.0), place(0.25, 0.0, 2.0), place(7.0 / 12.0, 0.0, 0.0),
                    place(1.0, 0.0, 1.0)] })],
            "the 4 anchors are now evenly spaced along the curve",
        ),
        (
            "point",
            "curve",
            vec![json!({ "tool": "curve", "samples": 9, "nodes": [{ "at": [25, 40] }, { "at": [75, 40] }],
                "jumps": [place(0.0, 3.0, -4.0)] })],
            "",
        ),
    ]);
}

#[test]
fn what_gives_anchors_loses_them_in_other_tools() {
    become_these(&[
        ("point", "translate", vec![json!({ "tool": "translate", "by": [3, -4] })], ""),
        (
            "curve",
            "translate",
            vec![json!({ "tool": "translate", "by": [0, -4] })],
            "only the mean of its 3 jump vectors is kept",
        ),
        ("point", "affine", vec![json!({ "tool": "affine", "matrix": [[1, 0, 3], [0, 1, -4]] })], ""),
        (
            "point",
            "scale",
            vec![json!({ "tool": "scale", "center": [50, 40], "factor": [1, 1] })],
            "its jump vectors are not kept, only their places",
        ),
        (
            "lasso",
            "still-border",
            vec![json!({ "tool": "still-border", "spacing": 8 })],
            "nothing of the lasso is kept",
        ),
        ("border", "field", vec![json!({ "tool": "field", "path": "field.flo" })], "its spacing is not kept"),
    ]);
}

#[test]
fn transforms_stay_the_same_map_where_they_can() {
    become_these(&[
        ("scale", "affine", vec![json!({ "tool": "affine", "matrix": [[1.5, 0, -5], [0, 0.5, 10]] })], ""),
        ("turn", "affine", vec![json!({ "tool": "affine", "matrix": [[0, -1, 30], [1, 0, 10]] })], ""),
        ("shear", "affine", vec![json!({ "tool": "affine", "matrix": [[1, 0.5, -10], [0, 1, 0]] })], ""),
        ("move", "affine", vec![json!({ "tool": "affine", "matrix": [[1, 0, 3], [0, 1, -4]] })], ""),
        (
            "scale",
            "rotate",
            vec![json!({ "tool": "rotate", "center": [10, 20], "degrees": 0 })],
            "no rotate is that scale: jump vectors differ by up to 54.08 px",
        ),
        (
            "scale",
            "shear",
            vec![json!({ "tool": "shear", "center": [10, 20], "factor": [0, 0] })],
            "no shear is that scale: jump vectors differ by up to 54.08 px",
        ),
        (
            "turn",
            "scale",
            vec![json!({ "tool": "scale", "center": [10, 20], "factor": [1, 1] })],
            "no scale is that rotate: jump vectors differ by up to 152.97 px",
        ),
        (
            "scale",
            "translate",
            vec![json!({ "tool": "translate", "by": [20, -10] })],
            "no translate is that scale: jump vectors differ by up to 32.02 px",
        ),
    ]);
}

#[test]
fn transforms_are_read_at_the_anchors_of_other_tools() {
    become_these(&[
        (
            "scale",
            "point",
            vec![json!({ "tool": "point", "at": [10, 20], "jump": [0, 0] })],
            "only the jump of the scale at the point is kept",
        ),
        ("move", "point", vec![json!({ "tool": "point", "at": [50, 40], "jump": [3, -4] })], ""),
        (
            "move",
            "curve",
            vec![json!({ "tool": "curve", "samples": 9, "nodes": [{ "at": [25, 40] }, { "at": [75, 40] }],
                "jumps": [{ "along": 0, "jump": [3, -4] }] })],
            "",
        ),
        (
            "scale",
            "curve",
            vec![json!({ "tool": "curve", "samples": 9, "nodes": [{ "at": [25, 40] }, { "at": [75, 40] }],
                "jumps": [{ "along": 0, "jump": [7.5, -10] }, { "along": 1, "jump": [32.5, -10] }] })],
            "only the jumps of the scale along the curve are kept",
        ),
        (
            "turn",
            "lasso",
            vec![json!({ "tool": "lasso", "vertices": [{ "from": [25, 20], "to": [10, 35] },
                { "from": [75, 20], "to": [10, 85] }, { "from": [75, 60], "to": [-30, 85] },
                { "from": [25, 60], "to": [-30, 35] }] })],
            "only the jumps of the rotate at the vertices are kept",
        ),
    ]);
}

#[test]
fn transforms_stay_the_same_through_a_matrix() {
    // To a matrix and back, nothing changes.
    for old in ["scale", "turn", "shear", "move"].map(old) {
        let (through, _) = tool(&old, "affine");
        let (back, told) = tool(&through[0], old["tool"].as_str().unwrap());
        assert_eq!(told, "", "{old}");
        let map = |tool: &Value| crate::layers::folding::anchors::transform(&read::<Tool>(tool).unwrap()).unwrap();
        let there = [(0.0, 0.0), (100.0, 0.0), (0.0, 80.0)].map(kurbo::Point::from);
        assert!(there.iter().all(|&q| (map(&old) * q - map(&back[0]) * q).hypot() < 1e-4), "{old} {back:?}");
    }
}

#[test]
fn thousands_of_anchors_are_thinned_and_counted() {
    let curve = json!({ "tool": "curve", "samples": 1000000, "nodes": [{ "at": [0, 0] }, { "at": [10, 0] }],
        "jumps": [{ "along": 0, "jump": [0, 0] }] });
    let (points, told) = tool(&curve, "point");
    assert_eq!(points.len(), 10_000);
    assert_eq!(told, "the curve is now 10000 points, 990000 anchors are left out");
}

#[test]
fn position_functions_keep_their_curve() {
    let segment = |until: f64, from: f64, to: f64| json!({ "until": until, "from": from, "to": to });
    let keys = json!({ "function": "keyframes", "points": [[0.25, 0], [0.5, 1], [0.75, 0.5]] });
    let steps = json!({ "function": "keyframes", "between": "step", "points": [[0, 0], [0.5, 1]] });
    let pieces = json!({ "function": "piecewise", "segments": [segment(0.25, 0.0, 0.0), segment(0.5, 0.0, 1.0),
        segment(0.75, 1.0, 0.5), segment(1.0, 0.5, 0.5)] });
    let sine = json!({ "function": "sine", "cycles": 2.0, "phase": 0.0, "amplitude": 1.0, "offset": 0.0 });
    let eased = json!({ "function": "piecewise", "segments": [{ "until": 1, "from": 0, "to": 1, "ease": sine }] });
    for (old, to, new, lost) in [
        (&keys, "piecewise", pieces.clone(), ""),
        (
            &pieces,
            "keyframes",
            json!({ "function": "keyframes", "points": [[0, 0], [0.25, 0], [0.5, 1], [0.75, 0.5], [1, 0.5]] }),
            "",
        ),
        (
            &steps,
            "piecewise",
            json!({ "function": "piecewise", "segments": [segment(0.5, 0.0, 0.0), segment(1.0, 1.0, 1.0)] }),
            "at each step the earlier value still holds now",
        ),
        (&sine, "piecewise", eased.clone(), ""),
        (&eased, "sine", sine.clone(), ""),
        (
            &json!({ "function": "linear" }),
            "piecewise",
            json!({ "function": "piecewise", "segments": [segment(1.0, 0.0, 1.0)] }),
            "",
        ),
    ] {
        let (found, told) = one(positions::turned(&read(old).unwrap(), to));
        assert_near(&found, &new);
        assert_eq!(told, lost, "{old} {to}");
    }
    for (old, count) in [(json!({ "function": "sigmoid" }), 9), (sine, 17)] {
        let (found, told) = one(positions::turned(&read(&old).unwrap(), "keyframes"));
        assert_eq!(told, format!("{count} keyframes are on it, smooth between them"));
        let (old, new): (Position, Position) = (read(&old).unwrap(), read(&found).unwrap());
        let apart = (0..=64).map(|i| f64::from(i) / 64.0).map(|tau| (old.eval(tau) - new.eval(tau)).abs());
        assert!(apart.fold(0.0, f64::max) < 0.1, "{found}");
    }
    assert_eq!(positions::turned(&Position::Linear, "keyframes"), None);
}

#[test]
fn every_tool_becomes_every_other() {
    let point = json!({ "tool": "point", "at": [10, 10], "jump": [3, 4] });
    for from in variants::<Tool>("tool") {
        let old = if from == "point" { point.clone() } else { tool(&point, &from).0[0].clone() };
        for to in variants::<Tool>("tool").iter().filter(|to| **to != from) {
            let new = tool(&old, to).0;
            assert!(new.iter().all(|new| read::<Tool>(new).is_some() && new["tool"] == **to), "{old} is {new:?}");
        }
        assert_eq!(tools::turned(&zone(), &read(&old).unwrap(), &from), None);
    }
    assert_eq!(tools::turned(&zone(), &read(&point).unwrap(), "brush"), None);
}
