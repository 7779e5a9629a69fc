//! Looks up the shapes that outlines and curves are made of (docs/folding.md, section 7).

use std::collections::BTreeMap;

use super::model::PictureLayer;
use super::node::Node;
use super::outline::{Outline, point};
use super::shapes::{Part, Shape};
use super::tools::Tool;

/// Ends that are no farther apart are one node.
const SAME_PX: f64 = 1e-6;

/// Looks up the shapes that a layer names. Those that are not there have no nodes.
pub fn resolve(layer: &mut PictureLayer, shapes: &BTreeMap<String, Shape>) {
    for zone in &mut layer.zones {
        let regions = zone.fold.iter_mut().flat_map(|fold| fold.regions_mut());
        for outline in regions.chain([&mut zone.outline]) {
            if let Outline::Shapes { parts, nodes } = outline {
                *nodes = joined(parts, shapes);
            }
        }
        for tool in &mut zone.motion {
            if let Tool::Curve { nodes, .. } = tool {
                nodes.look_up(|name| shapes.get(name).map(|shape| shape.nodes.clone()).unwrap_or_default());
            }
        }
    }
}

/// The shapes that a layer names, each with its place.
pub fn uses(layer: &PictureLayer) -> impl Iterator<Item = (String, &str)> {
    layer.zones.iter().enumerate().flat_map(|(i, zone)| {
        let regions = zone.fold.iter().flat_map(|fold| fold.regions()).enumerate();
        let regions = regions.map(move |(r, region)| (format!("/zones/{i}/fold/regions/{r}"), region));
        let outlines = std::iter::once((format!("/zones/{i}/outline"), &zone.outline)).chain(regions);
        let parts = outlines.flat_map(|(at, outline)| {
            let parts: &[Part] = if let Outline::Shapes { parts, .. } = outline { parts } else { &[] };
            let named = parts.iter().enumerate();
            named.map(move |(p, part)| (format!("{at}/parts/{p}/shape"), part.shape.as_str())).collect::<Vec<_>>()
        });
        let curves = zone.motion.iter().enumerate().filter_map(move |(t, tool)| match tool {
            Tool::Curve { nodes, .. } => Some((format!("/zones/{i}/motion/{t}/nodes"), nodes.shape.as_deref()?)),
            _ => None,
        });
        parts.chain(curves)
    })
}

/// The closed path of parts, one after the other. Where an end meets the next beginning they are one node; otherwise a
/// straight side leads from one to the other. Handles that would reach over an end do not count.
fn joined(parts: &[Part], shapes: &BTreeMap<String, Shape>) -> Vec<Node> {
    let mut all: Vec<Node> = Vec::new();
    for part in parts {
        let Some(shape) = shapes.get(&part.shape) else { return Vec::new() };
        let mut nodes = if part.reverse { reversed(&shape.nodes) } else { shape.nodes.clone() };
        if let Some(first) = nodes.first_mut() {
            first.handle_in = [0.0; 2];
        }
        if let Some(last) = nodes.last_mut() {
            last.handle_out = [0.0; 2];
        }
        let mut nodes = nodes.into_iter();
        match (all.last_mut(), nodes.next()) {
            (Some(end), Some(begin)) if meet(end, &begin) => end.handle_out = begin.handle_out,
            (_, begin) => all.extend(begin),
        }
        all.extend(nodes);
    }
    if all.len() > 2 && all.first().zip(all.last()).is_some_and(|(first, last)| meet(first, last)) {
        let end = all.pop().map(|end| end.handle_in);
        if let (Some(first), Some(handle)) = (all.first_mut(), end) {
            first.handle_in = handle;
        }
    }
    all
}

fn meet(a: &Node, b: &Node) -> bool {
    point(a.at).distance(point(b.at)) <= SAME_PX
}

fn reversed(nodes: &[Node]) -> Vec<Node> {
    let turned = |node: &Node| Node { at: node.at, handle_in: node.handle_out, handle_out: node.handle_in };
    nodes.iter().rev().map(turned).collect()
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn shapes() -> BTreeMap<String, Shape> {
        let shapes = json!({
            "lid": { "nodes": [{ "at": [0, 0], "in": [9, 9], "out": [1, -2] }, { "at": [10, 0], "in": [-1, -2], "out": [9, 9] }] },
            "lower": { "nodes": [{ "at": [0, 0], "out": [0, 3] }, { "at": [10, 0], "in": [0, 4] }] },
            "far": { "nodes": [{ "at": [10, 5] }, { "at": [0, 5] }] },
            "ring": { "nodes": [{ "at": [0, 0], "out": [1, 0] }, { "at": [5, 5] }, { "at": [0, 0], "in": [0, 1] }] }
        });
        serde_json::from_value(shapes).unwrap()
    }

    #[test]
    fn parts_are_joined_where_they_meet_and_by_straight_sides_where_not() {
        for (parts, expected) in [
            (
                json!([{ "shape": "lid" }, { "shape": "lower", "reverse": true }]),
                json!([{ "at": [0.0, 0.0], "in": [0.0, 3.0], "out": [1.0, -2.0] }, { "at": [10.0, 0.0], "in": [-1.0, -2.0], "out": [0.0, 4.0] }]),
            ),
            (
                json!([{ "shape": "lid" }, { "shape": "far" }]),
                json!([{ "at": [0.0, 0.0], "out": [1.0, -2.0] }, { "at": [10.0, 0.0], "in": [-1.0, -2.0] }, { "at": [10.0, 5.0] }, { "at": [0.0, 5.0] }]),
            ),
            (
                json!([{ "shape": "ring" }]),
                json!([{ "at": [0.0, 0.0], "in": [0.0, 1.0], "out": [1.0, 0.0] }, { "at": [5.0, 5.0] }]),
            ),
            (json!([{ "shape": "lid" }, { "shape": "none" }]), json!([])),
        ] {
            let parts: Vec<Part> = serde_json::from_value(parts).unwrap();
            assert_eq!(serde_json::to_value(joined(&parts, &shapes())).unwrap(), expected);
        }
    }
}
