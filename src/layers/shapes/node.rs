//! A node of a path, as in the document, and the path through several.

use kurbo::{BezPath, Shape};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::base::geometry::{Xy, point, vector};
use crate::base::number;

/// A node of a cubic Bezier path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Node {
    /// Position.
    #[schemars(extend("unit" = "px"))]
    pub at: Xy,
    /// Handle towards the node before, relative to the node.
    #[serde(default, rename = "in", skip_serializing_if = "is_zero")]
    #[schemars(extend("default" = [0, 0], "unit" = "px", "columns" = ["dx", "dy"]))]
    pub handle_in: Xy,
    /// Handle towards the next node, relative to the node.
    #[serde(default, rename = "out", skip_serializing_if = "is_zero")]
    #[schemars(extend("default" = [0, 0], "unit" = "px", "columns" = ["dx", "dy"]))]
    pub handle_out: Xy,
}

impl Node {
    /// A node without handles.
    pub fn corner(at: Xy) -> Node {
        Node { at, handle_in: [0.0; 2], handle_out: [0.0; 2] }
    }
}

fn is_zero(xy: &Xy) -> bool {
    *xy == [0.0, 0.0]
}

/// Nodes as they are written; `None` if they are no nodes.
pub fn read(nodes: &[Value]) -> Option<Vec<Node>> {
    nodes.iter().map(|node| Node::deserialize(node).ok()).collect()
}

/// A node as it is written, to the last bit.
pub fn written(node: &Node) -> Value {
    let exact = |[x, y]: Xy| json!([number::json(x), number::json(y)]);
    let mut written = json!({ "at": exact(node.at) });
    for (name, handle) in [("in", node.handle_in), ("out", node.handle_out)] {
        if !is_zero(&handle) {
            written[name] = exact(handle);
        }
    }
    written
}

/// The cubic Bezier path through `nodes`.
pub fn bezier(nodes: &[Node], closed: bool) -> BezPath {
    let mut path = BezPath::new();
    let Some(first) = nodes.first() else { return path };
    path.move_to(point(first.at));
    let next = nodes.iter().skip(1).chain(closed.then_some(first));
    for (a, b) in nodes.iter().zip(next) {
        path.curve_to(point(a.at) + vector(a.handle_out), point(b.at) + vector(b.handle_in), point(b.at));
    }
    if closed {
        path.close_path();
    }
    debug_assert!(path.bounding_box().is_finite());
    path
}
