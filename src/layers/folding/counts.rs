//! How many anchors and outline points a zone asks for, told from the document before any of them is made: ten digits in
//! a file must not cost gigabytes. Estimates from above.

use super::model::Zone;
use super::outline::{Node, Outline, vector};
use super::tools::Tool;
use crate::base::geometry::FLATNESS_PX;
use crate::base::maths::TAU;

/// Anchors of one tool of a zone with this outline.
pub fn anchors(tool: &Tool, outline: &Outline) -> f64 {
    match tool {
        Tool::Point { .. } => 1.0,
        Tool::Curve { samples, .. } => f64::from(*samples),
        Tool::Lasso { samples, vertices } => vertices.len() as f64 * (1.0 + f64::from(*samples)),
        Tool::StillBorder { spacing } => perimeter(outline) / spacing + 1.0,
        _ => 0.0,
    }
}

/// Points of the outlines of a zone and its fold regions.
pub fn points(zone: &Zone) -> f64 {
    let regions = zone.fold.iter().flat_map(|fold| fold.regions());
    std::iter::once(&zone.outline).chain(regions).map(flattened).sum()
}

/// A little more than the points that flattening gives.
fn flattened(outline: &Outline) -> f64 {
    match outline {
        Outline::Rectangle { .. } => 4.0,
        Outline::Ellipse { radii: [x, y], .. } => 16.0 + TAU * (x.abs().max(y.abs()) / FLATNESS_PX).sqrt() / 4.0,
        Outline::Polygon { points } => points.len() as f64,
        Outline::Path { nodes } => sides(nodes).map(|(a, b)| 1.0 + (control_length(a, b) / FLATNESS_PX).sqrt()).sum(),
    }
}

fn perimeter(outline: &Outline) -> f64 {
    match outline {
        Outline::Rectangle { width, height, .. } => 2.0 * (width.abs() + height.abs()),
        Outline::Ellipse { radii: [x, y], .. } => TAU * x.abs().max(y.abs()),
        Outline::Polygon { .. } => outline.polygon().perimeter(),
        Outline::Path { nodes } => sides(nodes).map(|(a, b)| control_length(a, b)).sum(),
    }
}

fn sides(nodes: &[Node]) -> impl Iterator<Item = (&Node, &Node)> {
    nodes.iter().zip(nodes.iter().cycle().skip(1))
}

/// Length of a segment's control polygon: the curve is no longer.
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
            json!({ "kind": "path", "nodes": [
                { "at": [0, 0], "out": [90, 0] }, { "at": [100, 50], "in": [0, -90], "out": [-300, 70] }] }),
        ] {
            let outline: Outline = serde_json::from_value(outline).unwrap();
            let polygon = outline.polygon();
            assert!(flattened(&outline) >= polygon.vertices().len() as f64);
            assert!(perimeter(&outline) >= polygon.perimeter());
        }
    }
}
