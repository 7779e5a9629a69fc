//! Changing the kind of an outline. Corners and nodes stay as they are; a curve becomes straight sides no farther from
//! it than [`WITHIN_PX`]: fine enough for a zone's edge, and few enough to be edited by hand.

use kurbo::{PathEl, Point, Rect, Shape};
use serde_json::{Value, json};

use crate::base::crossings::self_crossing;
use crate::base::geometry::{FLATNESS_PX, Polygon, Xy, point};
use crate::base::maths::{self, TAU};
use crate::base::number;
use crate::base::text::short;
use crate::layers::folding::neat::{pair, px};
use crate::layers::folding::outline::Outline;
use crate::layers::shapes::node::{bezier, written};
use crate::layers::technique::Turned;

/// How far the straight sides may be from the curve that they replace.
const WITHIN_PX: f64 = 0.05;

/// The length of the handles of an ellipse's four nodes, as a share of its radii: the error is at most 0.03 % of them.
const HANDLE: f64 = 0.552_284_749_830_793_6;

/// The outline turned into the kind `to`; `None` if it is of that kind already, or there is no such kind.
pub fn turned(old: &Outline, to: &str) -> Option<Turned> {
    let there = kind(old);
    Some(match (old, to) {
        _ if there == to => return None,
        (_, "rectangle") => {
            let Rect { x0, y0, x1, y1 } = bounds(old);
            let [x, y, width, height] = [x0, y0, x1 - x0, y1 - y0].map(px);
            let box_ = json!({ "kind": "rectangle", "x": x, "y": y, "width": width, "height": height });
            Turned::whole(box_).but_if(area_lost(old, bounds(old).area(), "its box is kept"))
        }
        (_, "ellipse") => {
            let box_ = bounds(old);
            let radii = pair((box_.width() / 2.0, box_.height() / 2.0));
            let area = std::f64::consts::PI * box_.area() / 4.0;
            Turned::whole(json!({ "kind": "ellipse", "center": pair(box_.center()), "radii": radii }))
                .but_if(area_lost(old, area, "the ellipse inside its box is kept"))
        }
        (Outline::Rectangle { .. }, "polygon") => polygon(&corners(old)),
        (Outline::Rectangle { .. }, "path") => path(corners(old).map(|at| json!({ "at": pair(at) })).to_vec()),
        (Outline::Ellipse { center, radii }, "polygon") => straightened(&ring(*center, *radii), there),
        (Outline::Ellipse { center, radii }, "path") => path(nodes_of_ellipse(*center, *radii).to_vec()),
        (Outline::Polygon { points }, "path") => path(points.iter().map(|&at| json!({ "at": exact(at) })).collect()),
        (Outline::Shapes { nodes, .. }, "path") => path(nodes.iter().map(written).collect()),
        (Outline::Path { nodes } | Outline::Shapes { nodes, .. }, "polygon") => {
            let curved = nodes.iter().any(|node| node.handle_in != [0.0; 2] || node.handle_out != [0.0; 2]);
            match curved {
                false => polygon_of(nodes.iter().map(|node| exact(node.at)).collect()),
                true => straightened(&flattened(old), there),
            }
        }
        // A shape as it is already, or of a kind that is no shape.
        (
            Outline::Rectangle { .. }
            | Outline::Ellipse { .. }
            | Outline::Polygon { .. }
            | Outline::Path { .. }
            | Outline::Shapes { .. },
            _,
        ) => return None,
    })
}

fn kind(outline: &Outline) -> &'static str {
    match outline {
        Outline::Rectangle { .. } => "rectangle",
        Outline::Ellipse { .. } => "ellipse",
        Outline::Polygon { .. } => "polygon",
        Outline::Path { .. } => "path",
        Outline::Shapes { .. } => "shapes",
    }
}

/// A position, kept to the last bit.
fn exact([x, y]: Xy) -> Value {
    json!([number::json(x), number::json(y)])
}

/// The bounding box of an outline; exact for ellipses and curves.
fn bounds(outline: &Outline) -> Rect {
    match outline {
        Outline::Ellipse { center: [x, y], radii: [w, h] } => Rect::new(x - w, y - h, x + w, y + h),
        Outline::Path { nodes } | Outline::Shapes { nodes, .. } => bezier(nodes, true).bounding_box(),
        other => other.polygon().bounds(),
    }
}

fn corners(outline: &Outline) -> [Point; 4] {
    let r = bounds(outline);
    [r.origin(), Point::new(r.x1, r.y0), Point::new(r.x1, r.y1), Point::new(r.x0, r.y1)]
}

fn polygon(points: &[Point]) -> Turned {
    polygon_of(points.iter().map(|&at| pair(at)).collect())
}

/// A polygon needs three points: if there are fewer, the last one is repeated.
fn polygon_of(mut points: Vec<Value>) -> Turned {
    while let (1..3, Some(last)) = (points.len(), points.last().cloned()) {
        points.push(last);
    }
    Turned::whole(json!({ "kind": "polygon", "points": points }))
}

fn path(nodes: Vec<Value>) -> Turned {
    Turned::whole(json!({ "kind": "path", "nodes": nodes }))
}

fn straightened(points: &[Point], kind: &str) -> Turned {
    let count = points.len();
    polygon(points).but(format!("the {kind} is now {count} straight sides, within {} px of it", short(WITHIN_PX, 2)))
}

/// Points on an ellipse from its rightmost one, clockwise on the screen.
fn ring([x, y]: Xy, [w, h]: Xy) -> Vec<Point> {
    let largest = w.abs().max(h.abs()).max(WITHIN_PX);
    let half_step = maths::acos(1.0 - WITHIN_PX / largest);
    let n = ((std::f64::consts::PI / half_step).ceil() as usize).max(8).next_multiple_of(4);
    let at = |i: usize| {
        let angle = TAU * i as f64 / n as f64;
        Point::new(x + w * maths::cos(angle), y + h * maths::sin(angle))
    };
    (0..n).map(at).collect()
}

fn nodes_of_ellipse([x, y]: Xy, [w, h]: Xy) -> [Value; 4] {
    let (kx, ky) = (HANDLE * w, HANDLE * h);
    let node = |at: (f64, f64), to: (f64, f64)| json!({ "at": pair(at), "in": pair((-to.0, -to.1)), "out": pair(to) });
    [
        node((x + w, y), (0.0, ky)),
        node((x, y + h), (-kx, 0.0)),
        node((x - w, y), (0.0, -ky)),
        node((x, y - h), (kx, 0.0)),
    ]
}

fn flattened(outline: &Outline) -> Vec<Point> {
    let (Outline::Path { nodes } | Outline::Shapes { nodes, .. }) = outline else { return Vec::new() };
    let mut points: Vec<Point> = Vec::new();
    kurbo::flatten(bezier(nodes, true), WITHIN_PX, |part| match part {
        PathEl::MoveTo(p) | PathEl::LineTo(p) if points.last() != Some(&p) => points.push(p),
        _ => {}
    });
    if points.len() > 1 && points.last() == nodes.first().map(|node| point(node.at)).as_ref() {
        points.pop();
    }
    points
}

/// A message that only `kept` is left, unless the outline enclosed exactly the area `new`.
fn area_lost(old: &Outline, new: f64, kept: &str) -> Option<String> {
    let polygon = old.polygon();
    if old.is_drawn() && self_crossing(&polygon, FLATNESS_PX).is_some() {
        return Some(format!("only {kept}"));
    }
    let area = match old {
        Outline::Ellipse { radii: [w, h], .. } => std::f64::consts::PI * w * h,
        _ => area(&polygon),
    };
    let differs = (new - area).abs() > 1e-6 * area.max(1.0);
    differs.then(|| format!("only {kept}: {} px² became {}", short(area, 2), short(new, 2)))
}

fn area(polygon: &Polygon) -> f64 {
    let origin = polygon.bounds().origin();
    let twice: f64 = polygon.sides().map(|(a, b)| (a - origin).cross(b - origin)).sum();
    twice.abs() / 2.0
}
