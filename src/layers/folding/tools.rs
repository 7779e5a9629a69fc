//! The tools of a zone's motion: what gives anchors, and what gives a dense field (docs/folding.md, section 4).

use kurbo::{Rect, Vec2};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::neat::{corners, middle, neat_pair};
use crate::base::geometry::Xy;
use crate::base::problem::Problem;
use crate::layers::check as rules;
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

/// What is to be known of a tool, whichever it is.
pub struct Facts<'a> {
    /// What it gives; anchors are counted before any of them is made.
    pub gives: Gives,
    /// What tools that are turned into one keep.
    pub keeps: Keeps,
    /// Whether anything can move by it.
    pub moves: bool,
    /// The center that it turns or stretches the samplers' places about.
    pub center: Option<Xy>,
    /// The file that it reads: its field depends on more than the document.
    pub file: Option<&'a str>,
    /// The path that its anchors lie on, which may be a shape of the scene.
    pub path: Option<&'a Nodes>,
    /// The polygon that it drags.
    pub dragged: Option<&'a [LassoVertex]>,
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

/// What is kept when a tool is turned into one of another kind.
pub enum Keeps {
    /// Every anchor, as a tool of its own.
    Points,
    /// Every anchor, as a vertex.
    Vertices,
    /// Every anchor, as a place on a path.
    Path,
    /// The map of the samplers' places, as far as the kind can express it.
    Map,
    /// Nothing.
    Nothing,
}

impl<'a> Facts<'a> {
    fn new(gives: Gives, keeps: Keeps) -> Facts<'a> {
        Facts { gives, keeps, moves: true, center: None, file: None, path: None, dragged: None }
    }
}

impl Tool {
    /// What is to be known of it.
    pub fn facts(&self) -> Facts<'_> {
        match self {
            Tool::Point { .. } => Facts::new(Gives::Anchors(1.0), Keeps::Points),
            Tool::Curve { samples, nodes, .. } => {
                Facts { path: Some(nodes), ..Facts::new(Gives::Anchors(f64::from(*samples)), Keeps::Path) }
            }
            Tool::Lasso { samples, vertices } => {
                let count = vertices.len() as f64 * (1.0 + f64::from(*samples));
                Facts { dragged: Some(vertices), ..Facts::new(Gives::Anchors(count), Keeps::Vertices) }
            }
            Tool::Translate { .. } | Tool::Affine { .. } => Facts::new(Gives::Field, Keeps::Map),
            Tool::Scale { center, .. } | Tool::Rotate { center, .. } | Tool::Shear { center, .. } => {
                Facts { center: Some(*center), ..Facts::new(Gives::Field, Keeps::Map) }
            }
            Tool::StillBorder { spacing } => {
                Facts { moves: false, ..Facts::new(Gives::AnchorsAlong(*spacing), Keeps::Nothing) }
            }
            Tool::Field { path, .. } => Facts { file: Some(path), ..Facts::new(Gives::Field, Keeps::Nothing) },
        }
    }

    /// Looks up the shape that its path is, if it is one.
    pub fn look_up(&mut self, find: impl Fn(&str) -> Vec<Node>) {
        if let Tool::Curve { nodes, .. } = self {
            nodes.look_up(find);
        }
    }

    /// Checks fields that depend on each other.
    pub fn check(&self) -> Vec<Problem> {
        let Tool::Curve { jumps, .. } = self else { return Vec::new() };
        let along = jumps.iter().map(|jump| jump.along);
        rules::ascending("places along a curve", along, |j| format!("/jumps/{j}/along"))
    }
}

/// A new tool in a zone with this box, as it is written; `None` if there is no such tool.
pub fn fresh(tool: &str, bounds: Rect) -> Option<Value> {
    let (c, aside) = (bounds.center(), Vec2::new(bounds.width() / 4.0, 0.0));
    let center = neat_pair(c);
    let fields = match tool {
        "point" => json!({ "at": center }),
        "curve" => json!({
            "samples": 9,
            "nodes": [{ "at": neat_pair(c - aside) }, { "at": neat_pair(c + aside) }],
            "jumps": [{ "along": 0, "jump": [0, 0] }],
        }),
        "lasso" => json!({ "vertices": corners(middle(bounds)).map(|at| json!({ "from": at, "to": at })) }),
        "translate" => json!({ "by": [0, 0] }),
        "scale" => json!({ "center": center, "factor": [1, 1] }),
        "rotate" => json!({ "center": center, "degrees": 0 }),
        "shear" => json!({ "center": center, "factor": [0, 0] }),
        "affine" => json!({ "matrix": [[1, 0, 0], [0, 1, 0]] }),
        "still-border" => json!({ "spacing": 8 }),
        "field" => json!({ "path": "field.flo" }),
        _ => return None,
    };
    let mut whole = json!({ "tool": tool });
    fields.as_object()?.iter().for_each(|(name, value)| whole[name] = value.clone());
    Some(whole)
}

#[cfg(test)]
mod tests {
    use kurbo::Affine;

    use super::*;
    use crate::layers::folding::anchors::{given, nearest, transform};
    use crate::layers::folding::outline::Outline;
    use crate::layers::tests::variants;

    #[test]
    fn every_tool_begins_as_one_and_gives_what_it_says() {
        let bounds = Rect::new(10.0, 20.0, 70.0, 60.0);
        let outline = Outline::Rectangle { x: 10.0, y: 20.0, width: 60.0, height: 40.0 };
        for name in variants::<Tool>("tool") {
            let tool: Tool = serde_json::from_value(fresh(&name, bounds).unwrap()).unwrap();
            assert_eq!(serde_json::to_value(&tool).unwrap()["tool"], name);
            let (facts, count) = (tool.facts(), given(&tool, &outline).len());
            match facts.gives {
                Gives::Anchors(most) => assert_eq!(count as f64, most, "{name}"),
                Gives::AnchorsAlong(_) => assert!(count > 1, "{name}"),
                Gives::Field => assert!(transform(&tool).is_some() != facts.file.is_some(), "{name}"),
            }
            let like = nearest(Affine::IDENTITY, &name, &tool, None, bounds.center());
            assert_eq!(like.is_some(), matches!(facts.keeps, Keeps::Map), "{name}");
        }
        assert_eq!(fresh("none", bounds), None);
    }
}
