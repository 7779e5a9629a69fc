//! The tools of a zone's motion: what gives anchors, and what gives a dense field (folding.md, section 4).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::outline::Node;
use crate::layers::Xy;

/// One tool of a zone's motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "tool", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Tool {
    /// One anchor; a jump of (0, 0) is a still point.
    Point {
        /// Position.
        #[schemars(extend("unit" = "px"))]
        at: Xy,
        /// Jump vector: where the sampler goes. The picture is seen to move the opposite way.
        #[serde(default)]
        #[schemars(extend("unit" = "px", "columns" = ["dx", "dy"]))]
        jump: Xy,
    },
    /// Anchors along a cubic Bezier spline, evenly by arc length, with jump vectors given at a few places along it.
    Curve {
        /// What the jump vectors are measured in.
        #[serde(default)]
        frame: CurveFrame,
        /// Number of anchors, both ends included; one stands in the middle.
        #[schemars(range(min = 1, max = 1000000))]
        samples: u32,
        /// How vectors change between two places.
        #[serde(default)]
        distribution: Distribution,
        /// The nodes, at least two.
        #[schemars(length(min = 2))]
        nodes: Vec<Node>,
        /// Jump vectors at places along the curve, ascending.
        #[schemars(length(min = 1))]
        jumps: Vec<JumpAlong>,
    },
    /// A closed polygon dragged from one place to another: one anchor a vertex, and more along the sides.
    Lasso {
        /// Further anchors on every side, evenly.
        #[serde(default)]
        #[schemars(range(min = 0, max = 1000000))]
        samples: u32,
        /// The vertices, at least three.
        #[schemars(length(min = 3))]
        vertices: Vec<LassoVertex>,
    },
    /// Dense: the same vector everywhere.
    Translate {
        /// Jump vector.
        #[schemars(extend("unit" = "px", "columns" = ["dx", "dy"]))]
        by: Xy,
    },
    /// Dense: scaled about a centre.
    Scale {
        /// Centre, which stays.
        #[schemars(extend("unit" = "px"))]
        center: Xy,
        /// Factors along x and y; 1 changes nothing, 3 gives twice the distance to the centre.
        #[schemars(extend("columns" = ["x", "y"]))]
        factor: Xy,
    },
    /// Dense: turned about a centre.
    Rotate {
        /// Centre, which stays.
        #[schemars(extend("unit" = "px"))]
        center: Xy,
        /// Angle; positive turns x toward y, clockwise on the screen.
        #[schemars(range(min = -36000.0, max = 36000.0), extend("unit" = "degrees"))]
        degrees: f64,
    },
    /// Dense: sheared about a centre.
    Shear {
        /// Centre, which stays.
        #[schemars(extend("unit" = "px"))]
        center: Xy,
        /// [a, b]: a times y is added to x, and b times x to y.
        #[schemars(extend("columns" = ["a", "b"]))]
        factor: Xy,
    },
    /// Dense: an affine map about the image's origin.
    Affine {
        /// [[a, b, tx], [c, d, ty]]: x' = a x + b y + tx, y' = c x + d y + ty.
        matrix: [[f64; 3]; 2],
    },
    /// Still anchors along the zone's outline.
    StillBorder {
        /// Distance between two of them, by arc length.
        #[schemars(range(min = 0.01, max = 1000000.0), extend("unit" = "px"))]
        spacing: f64,
    },
    /// Dense: a sampled vector field from a file (.flo, KITTI PNG, EXR), bilinear.
    Field {
        /// The file, relative to the scene.
        #[schemars(length(min = 1))]
        path: String,
        /// Multiplies every vector.
        #[serde(default = "one")]
        scale: f64,
    },
}

/// What the jump vectors of a curve are measured in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CurveFrame {
    /// The image's axes.
    #[default]
    Image,
    /// The curve at the sample: along its unit tangent T, along its left normal (T.y, -T.x).
    Curve,
}

/// How jump vectors change between two places along a curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Distribution {
    /// Evenly.
    #[default]
    Linear,
    /// By smoothstep.
    Smooth,
    /// Not at all: the earlier vector until the next place, where the next begins.
    Constant,
}

/// A jump vector at a place along a curve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JumpAlong {
    /// The place, as a fraction of the arc length.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub along: f64,
    /// Jump vector, in the curve's `frame`.
    #[schemars(extend("unit" = "px", "columns" = ["dx", "dy"]))]
    pub jump: Xy,
}

/// A vertex of a lasso.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LassoVertex {
    /// Where the vertex is.
    #[schemars(extend("unit" = "px"))]
    pub from: Xy,
    /// Where it is dragged to.
    #[schemars(extend("unit" = "px"))]
    pub to: Xy,
}

fn one() -> f64 {
    1.0
}
