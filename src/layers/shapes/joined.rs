//! A closed path made of shapes, one after the other (docs/folding.md, section 7).

use std::collections::BTreeMap;

use super::node::Node;
use super::shape::{Part, Shape};
use crate::base::geometry::point;

/// Ends that are no farther apart are one node.
const SAME_PX: f64 = 1e-6;

/// The closed path of parts, one after the other. Where an end meets the next beginning they are one node; otherwise a
/// straight side leads from one to the other. Handles that would reach over an end do not count. Empty if a shape is not there.
pub fn joined(parts: &[Part], shapes: &BTreeMap<String, Shape>) -> Vec<Node> {
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
