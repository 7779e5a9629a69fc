//! View maps as in the document. The doc comments become the help texts of forms and schema. Everything in a view is in
//! the model's own coordinates, before the pose.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::base::geometry::{Xy, Xyz};
use crate::layers::parts::shots::Feeds;

/// The most views.
pub const MOST_VIEWS: usize = 256;

/// Pictures of the object, photographed or painted, each laid on the surface from its own camera.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ViewMap {
    /// The pictures, each with its camera.
    #[schemars(length(max = 256))]
    pub views: Vec<View>,
    /// Cells along a side of the coarsest layer; each next layer has twice as many.
    #[schemars(range(min = 8, max = 256), extend("unit" = "1"))]
    pub cells: u32,
    /// How many layers of cells there are; by default as many as the pictures have detail for.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 9), extend("unit" = "1"))]
    pub levels: Option<u32>,
    /// The side of the array of directions that each cell keeps; by default directions are exact.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 4, max = 32), extend("unit" = "1"))]
    pub directions: Option<u32>,
    /// How the surface is laid out in the plane; by default by the texture coordinates of the mesh, or as boxes where it
    /// has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub atlas: Option<Atlas>,
    /// The color where no view tells anything: sRGB, #rrggbb.
    pub missing: String,
    /// From where the base coat alone is seen.
    pub blend: Blend,
}

impl Default for ViewMap {
    fn default() -> Self {
        ViewMap {
            views: Vec::new(),
            cells: 32,
            levels: None,
            directions: None,
            atlas: None,
            missing: "#808080".into(),
            blend: Blend::default(),
        }
    }
}

/// How the surface is laid out in the plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Atlas {
    /// By the texture coordinates of the mesh.
    Uv,
    /// Seen from the six sides of a box.
    Box,
}

/// A picture of the object and where it is seen from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct View {
    /// Unique among the views.
    #[schemars(length(min = 1))]
    pub name: String,
    /// The picture, by its name in the scene's images; its alpha says what of it counts.
    #[schemars(extend("reference" = "images"))]
    pub image: String,
    /// What it feeds.
    #[serde(default)]
    pub kind: Feeds,
    /// Where it is seen from: either by position and target, or by a matrix with focal lengths.
    pub camera: ViewCamera,
    /// How far to the side it is seen.
    #[serde(default)]
    pub extremes: Extremes,
    /// How it fades on the way there.
    #[serde(default)]
    pub fade: Fade,
    /// The share of the way on which it stays whole.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 0.95), extend("unit" = "1"))]
    pub hold: f64,
    /// An image of the same size whose brightness says what of the picture counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("reference" = "images"))]
    pub mask: Option<String>,
    /// The image that was painted over: only what differs from it counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("reference" = "images"))]
    pub changed: Option<String>,
    /// How far it fades towards the border of the picture.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 10000.0), extend("unit" = "px"))]
    pub feather: f64,
    /// How much is left out beside steps in depth.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 64.0), extend("unit" = "px"))]
    pub edge: f64,
    /// What its red, green and blue are multiplied with, in linear light.
    #[serde(default = "ones")]
    #[schemars(inner(range(min = 0.0, max = 100.0)), extend("unit" = "1", "columns" = ["gain r", "gain g", "gain b"]))]
    pub gain: Xyz,
    /// It is gone when the camera is a layer (half the distance) closer than so many; by default it stays.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 9.0), extend("unit" = "layers"))]
    pub closer: Option<f64>,
    /// It is gone when the camera is a layer (twice the distance) farther than so many; by default it stays.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 9.0), extend("unit" = "layers"))]
    pub farther: Option<f64>,
    /// Whether it counts at all.
    #[serde(default = "yes")]
    pub active: bool,
}

/// Where a picture is seen from, in the model's coordinates: by `position`, or by `matrix` and `focal`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ViewCamera {
    /// Where it is: right, up, to the front.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "m"))]
    pub position: Option<Xyz>,
    /// What it looks at.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "m"))]
    pub target: Option<Xyz>,
    /// The direction that is up in the picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "1"))]
    pub up: Option<Xyz>,
    /// Its vertical field of view.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.01, max = 179.0), extend("unit" = "degrees"))]
    pub fov: Option<f64>,
    /// Three rows of a world-to-camera matrix: x right, y down, z forward.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "1"))]
    pub matrix: Option<[[f64; 4]; 3]>,
    /// Its focal lengths across and down, beside a matrix.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "px"))]
    pub focal: Option<Xy>,
    /// Where its axis meets the picture, beside a matrix; by default the middle.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "px"))]
    pub center: Option<Xy>,
    /// The width and height that focal lengths and center are for; by default the picture's.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(inner(range(min = 1, max = 1_000_000)), extend("unit" = "px"))]
    pub size: Option<[u32; 2]>,
}

/// How far to the side a view is seen, told apart by `kind`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Extremes {
    /// As far as its neighbors; if there are none, so many degrees.
    Auto {
        /// The angle at which it is gone.
        #[serde(default = "thirty")]
        #[schemars(range(min = 1.0, max = 170.0), extend("unit" = "degrees"))]
        reach: f64,
    },
    /// The same angle to all sides.
    Cone {
        /// The angle at which it is gone.
        #[serde(default = "thirty")]
        #[schemars(range(min = 1.0, max = 170.0), extend("unit" = "degrees"))]
        degrees: f64,
    },
    /// Camera places at which it is gone, once round the view.
    Points {
        /// How far each is turned about the target: to the right and up.
        #[schemars(length(min = 3, max = 32), inner(inner(range(min = -170.0, max = 170.0))), extend("unit" = "degrees"))]
        points: Vec<Xy>,
    },
}

impl Default for Extremes {
    fn default() -> Self {
        Extremes::Auto { reach: thirty() }
    }
}

/// How a view fades between where it is whole and where it is gone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Fade {
    /// Slowly at both ends.
    #[default]
    Smooth,
    /// Evenly.
    Linear,
}

/// From where the base coat alone is seen.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Blend {
    /// Places to look from, and how much of the base coat is seen from there.
    #[schemars(length(max = 64))]
    pub points: Vec<BlendPoint>,
    /// How far a point reaches in the direction of looking; by default to the others.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.1, max = 180.0), extend("unit" = "degrees"))]
    pub angle: Option<f64>,
    /// How far a point reaches in place; by default to the others.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-9), extend("unit" = "m"))]
    pub distance: Option<f64>,
}

/// A place to look from, in the model's coordinates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BlendPoint {
    /// Where one stands.
    #[schemars(extend("unit" = "m"))]
    pub position: Xyz,
    /// What one looks at.
    #[serde(default)]
    #[schemars(extend("unit" = "m"))]
    pub target: Xyz,
    /// How much of the base coat alone is seen from there.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1"))]
    pub base: f64,
}

fn ones() -> Xyz {
    [1.0; 3]
}

fn one() -> f64 {
    1.0
}

fn thirty() -> f64 {
    30.0
}

fn yes() -> bool {
    true
}
