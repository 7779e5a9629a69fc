//! How many anchors and outline points a zone asks for, estimated from the document before any of them is made: ten
//! digits in a file must not cost gigabytes. The estimates are upper bounds.

use kurbo::Vec2;

use super::model::Zone;
use super::outline::Outline;
use super::tools::{Gives, Tool};
use crate::base::geometry::{FLATNESS_PX, vector};
use crate::base::maths::{TAU, pow};
use crate::layers::shapes::node::Node;

/// The number of anchors of one tool in a zone with this outline.
pub fn anchors(tool: &Tool, outline: &Outline) -> f64 {
    match tool.facts().gives {
        Gives::Anchors(count) => count,
        Gives::AnchorsAlong(spacing) => perimeter(outline) / spacing + 1.0,
        Gives::Field => 0.0,
    }
}

/// The number of anchors of all tools of a zone.
pub fn all_anchors(zone: &Zone) -> f64 {
    zone.motion.iter().map(|tool| anchors(tool, &zone.outline)).sum()
}

/// The number of points of an outline: slightly more than flattening gives.
pub fn points(outline: &Outline) -> f64 {
    match outline {
        Outline::Rectangle { .. } => 4.0,
        Outline::Ellipse { radii: [x, y], .. } => 16.0 + TAU * (x.abs().max(y.abs()) / FLATNESS_PX).sqrt() / 4.0,
        Outline::Polygon { points } => points.len() as f64,
        Outline::Path { nodes } | Outline::Shapes { nodes, .. } => {
            sides(nodes).map(|(a, b)| flattened_side(a, b)).sum()
        }
    }
}

/// The number of points of one cubic: it is first approximated by quadratics, by the third difference of its control
/// points and a tenth of the tolerance; each of those becomes straight sides, by the second differences (Wang 1984) and
/// the rest of the tolerance.
fn flattened_side(a: &Node, b: &Node) -> f64 {
    let (out, back, across) = (vector(a.handle_out), vector(b.handle_in), vector(b.at) - vector(a.at));
    if out == Vec2::ZERO && back == Vec2::ZERO {
        return 1.0;
    }
    let third = (across - (across + back) * 3.0 + out * 3.0).length();
    let quadratics = pow(third * third / (432.0 * 0.01 * FLATNESS_PX * FLATNESS_PX), 1.0 / 6.0).ceil();
    let straight = |handle: Vec2| handle.cross(across).abs() <= 1e-9 * across.hypot2();
    let bend = if straight(out) && straight(back) {
        0.0
    } else {
        (across + back - out * 2.0).length().max((out - back * 2.0 - across).length())
    };
    1.0 + quadratics + (0.75 * bend / (0.9 * FLATNESS_PX)).sqrt()
}

fn perimeter(outline: &Outline) -> f64 {
    match outline {
        Outline::Rectangle { width, height, .. } => 2.0 * (width.abs() + height.abs()),
        Outline::Ellipse { radii: [x, y], .. } => TAU * x.abs().max(y.abs()),
        Outline::Polygon { .. } => outline.polygon().perimeter(),
        Outline::Path { nodes } | Outline::Shapes { nodes, .. } => {
            sides(nodes).map(|(a, b)| control_length(a, b)).sum()
        }
    }
}

fn sides(nodes: &[Node]) -> impl Iterator<Item = (&Node, &Node)> {
    nodes.iter().zip(nodes.iter().cycle().skip(1))
}

/// The length of a segment's control polygon: the curve is not longer.
fn control_length(a: &Node, b: &Node) -> f64 {
    let (out, back, across) = (vector(a.handle_out), vector(b.handle_in), vector(b.at) - vector(a.at));
    out.length() + (across + back - out).length() + back.length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn the_estimate_is_from_above() {
        for outline in [
            json!({ "kind": "ellipse", "center": [0, 0], "radii": [300, 20] }),
            json!({ "kind": "path", "nodes": [{ "at": [0, 0] }, { "at": [1000, 50] }, { "at": [9, 50], "in": [20, 0] }] }),
            json!({ "kind": "path", "nodes": [{ "at": [0, 0] }, { "at": [100, 0], "out": [50, 50], "in": [-30, 0] }] }),
            json!({ "kind": "path", "nodes": [{ "at": [0, 0], "out": [500, 900] }, { "at": [0, 1], "in": [-500, 900] }] }),
            json!({ "kind": "path", "nodes": [
                { "at": [0, 0], "out": [90, 0] }, { "at": [100, 50], "in": [0, -90], "out": [-300, 70] }] }),
        ] {
            let outline: Outline = serde_json::from_value(outline).unwrap();
            let polygon = outline.polygon();
            let (estimate, exact) = (points(&outline), polygon.vertices().len() as f64);
            assert!(estimate >= exact && estimate < 20.0 * exact.max(50.0), "{outline:?}: {estimate} for {exact}");
            assert!(perimeter(&outline) >= polygon.perimeter());
        }
    }
}
