//! Outlines of zones and fold regions: as in the document, and as polygons.

use kurbo::{BezPath, Point, Rect, Shape, Vec2};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::node::Node;
use super::shapes::Part;
use crate::base::geometry::Polygon;
use crate::base::geometry::Xy;

/// A closed outline on the layer's image, even-odd where it crosses itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Outline {
    /// An upright rectangle.
    Rectangle {
        /// Left edge.
        #[schemars(extend("unit" = "px"))]
        x: f64,
        /// Top edge.
        #[schemars(extend("unit" = "px"))]
        y: f64,
        /// Width.
        #[schemars(range(min = 0.0, max = 1048576.0), extend("unit" = "px"))]
        width: f64,
        /// Height.
        #[schemars(range(min = 0.0, max = 1048576.0), extend("unit" = "px"))]
        height: f64,
    },
    /// An upright ellipse.
    Ellipse {
        /// Center.
        #[schemars(extend("unit" = "px"))]
        center: Xy,
        /// Half the width, half the height.
        #[schemars(inner(range(min = 0.0, max = 1048576.0)), extend("unit" = "px"))]
        radii: Xy,
    },
    /// Straight sides between points, closed by itself.
    Polygon {
        /// The corners, at least three.
        #[schemars(length(min = 3), extend("unit" = "px"))]
        points: Vec<Xy>,
    },
    /// A closed cubic Bezier path.
    Path {
        /// The nodes, at least two.
        #[schemars(length(min = 2))]
        nodes: Vec<Node>,
    },
    /// A closed path of shapes of the scene, which others may be made of too.
    Shapes {
        /// The shapes, one after the other, closed by itself.
        #[schemars(length(min = 1))]
        parts: Vec<Part>,
        /// The nodes of the path, once the shapes are looked up.
        #[serde(skip)]
        nodes: Vec<Node>,
    },
}

impl Outline {
    /// The outline as a polygon from its first point: for a rectangle the top-left corner, for an ellipse the rightmost
    /// point, then clockwise on the screen.
    pub fn polygon(&self) -> Polygon {
        match self {
            Outline::Rectangle { x, y, width, height } => {
                let r = Rect::new(*x, *y, x + width, y + height);
                Polygon::new(vec![r.origin(), (r.x1, r.y0).into(), (r.x1, r.y1).into(), (r.x0, r.y1).into()])
            }
            Outline::Ellipse { center, radii } => Polygon::ellipse(point(*center), vector(*radii)),
            Outline::Polygon { points } => Polygon::new(points.iter().copied().map(point).collect()),
            Outline::Path { nodes } | Outline::Shapes { nodes, .. } => Polygon::flatten(&bezier(nodes, true)),
        }
    }
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

/// A document position as a point.
pub fn point([x, y]: Xy) -> Point {
    Point::new(x, y)
}

/// A document vector as a vector.
pub fn vector([x, y]: Xy) -> Vec2 {
    Vec2::new(x, y)
}
