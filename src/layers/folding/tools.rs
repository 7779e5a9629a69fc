//! The tools of a zone's motion: what gives anchors, and what gives a dense field (docs/folding.md, section 4).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::base::geometry::Xy;
use crate::layers::shapes::node::Node;
use crate::layers::shapes::shape::Nodes;

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
        #[schemars(extend("unit" = "px", "columns" = ["dx", "dy"], "symbol" = "J"))]
        jump: Xy,
    },
    /// Anchors along a cubic Bezier spline, evenly by arc length, with jump vectors given at a few places along it.
    Curve {
        /// What the jump vectors are measured in.
        #[serde(default)]
        frame: CurveFrame,
        /// Number of anchors, both ends included; one stands in the middle.
        #[schemars(range(min = 1, max = 1000000), extend("unit" = "1"))]
        samples: u32,
        /// How vectors change between two places.
        #[serde(default)]
        distribution: Distribution,
        /// The nodes, at least two; or the name of one of the scene's shapes.
        #[schemars(with = "Vec<Node>", length(min = 2), extend("named" = "shapes"))]
        nodes: Nodes,
        /// Jump vectors at places along the curve, ascending.
        #[schemars(length(min = 1))]
        jumps: Vec<JumpAlong>,
    },
    /// A closed polygon dragged from one place to another: one anchor per vertex, and more along the sides. The samplers go
    /// along; the picture is seen to move the opposite way.
    Lasso {
        /// Further anchors on every side, evenly.
        #[serde(default)]
        #[schemars(range(min = 0, max = 1000000), extend("unit" = "1"))]
        samples: u32,
        /// The vertices, at least three.
        #[schemars(length(min = 3))]
        vertices: Vec<LassoVertex>,
    },
    /// Dense: the same jump vector everywhere. The picture is seen to move the opposite way.
    Translate {
        /// Jump vector: where the samplers go. The picture is seen to move the opposite way.
        #[schemars(extend("unit" = "px", "columns" = ["dx", "dy"]))]
        by: Xy,
    },
    /// Dense: the samplers' places scaled about a center. The picture is seen to change the opposite way: factors over 1
    /// show it smaller.
    Scale {
        /// Center, which stays.
        #[schemars(extend("unit" = "px"))]
        center: Xy,
        /// Factors along x and y: where the samplers go, so that 2 shows the picture half as large. 1 changes nothing; the
        /// jump vector of 3 is twice the distance to the center.
        #[schemars(extend("unit" = "1", "columns" = ["x", "y"]))]
        factor: Xy,
    },
    /// Dense: the samplers' places turned about a center. The picture is seen to turn the opposite way.
    Rotate {
        /// Center, which stays.
        #[schemars(extend("unit" = "px"))]
        center: Xy,
        /// Angle: positive turns the samplers' places clockwise on the screen (x toward y), so the picture is seen to turn
        /// counter-clockwise. The ° of a jump vector counts the other way.
        #[schemars(range(min = -36000.0, max = 36000.0), extend("unit" = "degrees"))]
        degrees: f64,
    },
    /// Dense: the samplers' places sheared about a center. The picture is seen to shear the opposite way.
    Shear {
        /// Center, which stays.
        #[schemars(extend("unit" = "px"))]
        center: Xy,
        /// [a, b]: a times y is added to a sampler's x, and b times x to its y. The picture is seen to move the opposite way.
        #[schemars(extend("unit" = "1", "columns" = ["a", "b"]))]
        factor: Xy,
    },
    /// Dense: an affine map of the samplers' places about the image's origin. The picture is seen to move the opposite way.
    Affine {
        /// [[a, b, tx], [c, d, ty]]: x' = a x + b y + tx, y' = c x + d y + ty is where a sampler goes. The picture is seen
        /// to move the opposite way.
        #[schemars(extend("unit" = "1"))]
        matrix: [[f64; 3]; 2],
    },
    /// Still anchors along the zone's outline.
    StillBorder {
        /// Distance from one to the next, measured along the outline.
        #[schemars(range(min = 0.01, max = 1000000.0), extend("unit" = "px"))]
        spacing: f64,
    },
    /// Dense: jump vectors from a file (.flo, KITTI PNG, EXR), read bilinearly. The picture is seen to move the opposite way.
    Field {
        /// The file, relative to the scene.
        #[schemars(length(min = 1))]
        path: String,
        /// Multiplies every vector.
        #[serde(default = "one")]
        #[schemars(extend("unit" = "1"))]
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
    /// Constant: the vector of the place before holds until the next place.
    Constant,
}

/// A jump vector at a place along a curve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JumpAlong {
    /// The place, as a fraction of the arc length.
    #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1"))]
    pub along: f64,
    /// Jump vector, in the curve's `frame`: where the sampler goes. The picture is seen to move the opposite way.
    #[schemars(extend("unit" = "px", "columns" = ["dx", "dy"], "symbol" = "J"))]
    pub jump: Xy,
}

/// A vertex of a lasso.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LassoVertex {
    /// Where the vertex is.
    #[schemars(extend("unit" = "px"))]
    pub from: Xy,
    /// Where its sampler goes. The picture is seen to move the opposite way.
    #[schemars(extend("unit" = "px"))]
    pub to: Xy,
}

fn one() -> f64 {
    1.0
}

/// What a tool gives.
pub enum Gives {
    /// This many anchors.
    Anchors(f64),
    /// Anchors along the zone's outline, this many pixels apart.
    AnchorsAlong(f64),
    /// A dense field.
    Field,
}

impl Tool {
    /// What it gives: the anchors are counted before any of them is made.
    pub fn gives(&self) -> Gives {
        match self {
            Tool::Point { .. } => Gives::Anchors(1.0),
            Tool::Curve { samples, .. } => Gives::Anchors(f64::from(*samples)),
            Tool::Lasso { samples, vertices } => Gives::Anchors(vertices.len() as f64 * (1.0 + f64::from(*samples))),
            Tool::StillBorder { spacing } => Gives::AnchorsAlong(*spacing),
            Tool::Translate { .. }
            | Tool::Scale { .. }
            | Tool::Rotate { .. }
            | Tool::Shear { .. }
            | Tool::Affine { .. }
            | Tool::Field { .. } => Gives::Field,
        }
    }

    /// The center that it turns or stretches the samplers' places about, if it does.
    pub fn center(&self) -> Option<Xy> {
        match self {
            Tool::Scale { center, .. } | Tool::Rotate { center, .. } | Tool::Shear { center, .. } => Some(*center),
            Tool::Point { .. }
            | Tool::Curve { .. }
            | Tool::Lasso { .. }
            | Tool::Translate { .. }
            | Tool::Affine { .. }
            | Tool::StillBorder { .. }
            | Tool::Field { .. } => None,
        }
    }

    /// The file that it reads, if it reads one: its field depends on more than the document.
    pub fn file(&self) -> Option<&str> {
        match self {
            Tool::Field { path, .. } => Some(path),
            Tool::Point { .. }
            | Tool::Curve { .. }
            | Tool::Lasso { .. }
            | Tool::Translate { .. }
            | Tool::Scale { .. }
            | Tool::Rotate { .. }
            | Tool::Shear { .. }
            | Tool::Affine { .. }
            | Tool::StillBorder { .. } => None,
        }
    }
}
