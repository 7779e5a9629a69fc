//! Outlines of zones and fold regions: as in the document, and as polygons.

use kurbo::Rect;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::base::geometry::{Polygon, Xy, point, vector};
use crate::layers::shapes::node::{Node, bezier};
use crate::layers::shapes::shape::Part;

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

    /// Whether it is drawn point by point, so that it can cross itself.
    pub fn is_drawn(&self) -> bool {
        match self {
            Outline::Polygon { .. } | Outline::Path { .. } | Outline::Shapes { .. } => true,
            Outline::Rectangle { .. } | Outline::Ellipse { .. } => false,
        }
    }

    /// Whether the polygon is only as near to it as curves are flattened.
    pub fn is_curved(&self) -> bool {
        match self {
            Outline::Ellipse { .. } | Outline::Path { .. } | Outline::Shapes { .. } => true,
            Outline::Rectangle { .. } | Outline::Polygon { .. } => false,
        }
    }
}
