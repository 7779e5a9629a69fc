//! Strokes as in the document: every field as it is in force, in a schema in which nothing need be written, since what is
//! not comes from the style. The doc comments become the help texts of forms and schema.

use std::collections::BTreeMap;

use schemars::{JsonSchema, Schema};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::styles::Style;
use crate::base::geometry::Xyz;

/// Strokes that a mesh is drawn with, from its tones: hatches, dots, paint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(rename = "Strokes", transform = open)]
pub struct Force {
    /// Where everything comes from that is not said here.
    #[serde(skip_serializing)]
    pub style: Style,
    /// What strokes are fixed to.
    pub anchor: Anchor,
    /// How many times larger all strokes are.
    #[schemars(range(min = 0.1, max = 20.0), extend("unit" = "1"))]
    pub size: f64,
    /// How many times more ink there is.
    #[schemars(range(min = 0.0, max = 4.0), extend("unit" = "1"))]
    pub amount: f64,
    /// What marks call ink: sRGB, #rrggbb.
    pub ink: String,
    /// What marks call paper: sRGB, #rrggbb.
    pub paper: String,
    /// What is under the marks.
    pub ground: Ground,
    /// How far the scene's color, as a ground, goes to the paper.
    #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1"))]
    pub fade: f64,
    /// How dark a place is.
    pub tone: Tone,
    /// Where strokes run.
    pub direction: Direction,
    /// What makes strokes larger or finer from place to place, if anything does.
    pub vary: Option<Vary>,
    /// How often it is drawn anew: 0 is never, all is coherent.
    #[schemars(range(min = 0.0, max = 60.0), extend("unit" = "1/s"))]
    pub redraw: f64,
    /// Another seed gives another drawing of the same kind.
    #[schemars(extend("unit" = "1"))]
    pub seed: u32,
    /// The noises that marks are made of, by name; null takes away one of the style's.
    #[schemars(with = "BTreeMap<String, Option<Noise>>", extend("laid" = "null"))]
    pub noises: BTreeMap<String, Noise>,
    /// What is drawn, in this order. One of a name that the style has changes that; any other is added at the end.
    #[schemars(length(max = 64), extend("laid" = "off"))]
    pub marks: Vec<Mark>,
}

/// What strokes are fixed to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Anchor {
    /// To places of the surface, while their size and direction are those of the screen: flat, and moving with it.
    #[default]
    Surface,
    /// To the frame, as if seen through a patterned shower door.
    Screen,
    /// To the surface in every way, as a texture: near strokes are larger.
    Texture,
}

/// The anchors, with their names in the document.
pub const ANCHORS: [(Anchor, &str); 3] =
    [(Anchor::Surface, "surface"), (Anchor::Screen, "screen"), (Anchor::Texture, "texture")];

/// What is under the marks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Ground {
    /// The paper.
    #[default]
    Paper,
    /// The shaded color.
    Scene,
    /// Nothing: the marks alone, over what lies behind.
    Clear,
}

/// How dark a place is, from the lightness of its color.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(transform = open)]
pub struct Tone {
    /// Which color.
    pub of: ToneOf,
    /// What counts as black, as an sRGB code from 0 to 1.
    #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1"))]
    pub dark: f64,
    /// What counts as white, as an sRGB code from 0 to 1.
    #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1"))]
    pub light: f64,
    /// The exponent that bends what is between: below 1 is lighter.
    #[schemars(range(min = 0.1, max = 10.0), extend("unit" = "1"))]
    pub gamma: f64,
}

/// The color whose lightness is the tone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ToneOf {
    /// That of the surface in its light.
    #[default]
    Color,
    /// That of a white surface in its light.
    Light,
}

/// Where strokes run. Angles are counter-clockwise, 0 to the right.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(transform = open)]
pub struct Direction {
    /// What they follow.
    pub along: Along,
    /// The angle on the screen, also where there is nothing to follow.
    #[schemars(extend("unit" = "degrees"))]
    pub angle: f64,
    /// How far they are turned against what they follow.
    #[schemars(extend("unit" = "degrees"))]
    pub turn: f64,
    /// How far curvature is smoothed, in shares of half the size of the mesh.
    #[schemars(range(min = 0.0, max = 10.0), extend("unit" = "1"))]
    pub smooth: f64,
    /// The axis of the model that they follow, if they follow one.
    #[schemars(extend("unit" = "1"))]
    pub axis: Xyz,
    /// The flow map that they follow, if they follow one: red to the right, green up, code 128 is 0.
    #[schemars(with = "Option<String>", extend("reference" = "images"))]
    #[serde(skip_serializing_if = "String::is_empty")]
    pub image: String,
}

/// What strokes follow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Along {
    /// Nothing: all run at the angle.
    #[default]
    Screen,
    /// The form: they run round it.
    Curvature,
    /// The shading: they run down it.
    Light,
    /// An axis of the model.
    Axis,
    /// The outline: they run round what faces the camera.
    Outline,
    /// A flow map, by texture coordinates.
    Image,
}

/// What makes strokes larger or finer from place to place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(transform = open)]
pub struct Vary {
    /// What it is that does.
    pub by: By,
    /// How many times larger they are where there is none of it.
    #[schemars(range(min = 0.1, max = 10.0), extend("unit" = "1"))]
    pub low: f64,
    /// How many times larger they are where it is strongest.
    #[schemars(range(min = 0.1, max = 10.0), extend("unit" = "1"))]
    pub high: f64,
    /// The image, if its brightness does.
    #[schemars(with = "Option<String>", extend("reference" = "images"))]
    #[serde(skip_serializing_if = "String::is_empty")]
    pub image: String,
}

/// What makes strokes larger.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum By {
    /// The light that falls there.
    #[default]
    Light,
    /// How curved the form is.
    Curvature,
    /// How much it faces the camera.
    Facing,
    /// The brightness of an image, by texture coordinates.
    Image,
}

/// A noise: many small waves, as many over each pixel wherever it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(transform = open)]
pub struct Noise {
    /// The mean distance of strokes.
    #[schemars(range(min = 1.0, max = 400.0), extend("unit" = "px"))]
    pub spacing: f64,
    /// The radius of a wave in spacings: how long and even strokes are.
    #[schemars(range(min = 0.4, max = 8.0), extend("unit" = "1"))]
    pub regularity: f64,
    /// How many waves are over a pixel; it takes as many times longer.
    #[schemars(range(min = 2.0, max = 128.0), extend("unit" = "1"))]
    pub overlap: f64,
    /// How far directions vary either way; with 90 there is none, only dots.
    #[schemars(range(min = 0.0, max = 90.0), extend("unit" = "degrees"))]
    pub spread: f64,
    /// How far its strokes are turned against their direction.
    #[schemars(range(min = -180.0, max = 180.0), extend("unit" = "degrees"))]
    pub turn: f64,
    /// Whether strokes are equally strong everywhere, as engraved.
    pub even: bool,
    /// Where a wave ends.
    pub trim: Trim,
    /// How far a wave reaches in depth, in its radii, if it ends there.
    #[schemars(range(min = 0.05, max = 8.0), extend("unit" = "1"))]
    pub reach: f64,
    /// Noises of the same seed have their waves at the same places.
    #[schemars(extend("unit" = "1"))]
    pub seed: u32,
    /// What it is fixed to, if not to what all are.
    pub anchor: Option<Anchor>,
    /// Where its strokes run, if not where all do.
    pub direction: Option<Direction>,
    /// What makes its strokes larger or finer, if it is not what does so with all.
    pub vary: Option<Vary>,
}

/// Where a wave ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Trim {
    /// Where the surface leaves the plane of its triangle.
    #[default]
    Depth,
    /// Where the layer ends; it fades as it is hidden.
    Object,
    /// Where its triangle ends: facets show.
    Triangle,
}

/// Something that is drawn. Which fields count depends on its kind.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(transform = open)]
pub struct Mark {
    /// Its name; one that the style has changes that mark.
    #[schemars(length(min = 1))]
    pub name: String,
    /// What it does; a new mark needs one.
    pub kind: Option<Does>,
    /// Whether it is left out.
    #[serde(skip_serializing)]
    pub off: bool,
    /// The noise that it is made of.
    pub noise: Option<String>,
    /// ink, paper, scene or #rrggbb; of ink and outlines.
    pub color: Option<String>,
    /// What the color is multiplied by.
    #[schemars(range(min = 0.0, max = 4.0), extend("unit" = "1"))]
    pub shade: Option<f64>,
    /// How much it covers at most.
    #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1"))]
    pub opacity: Option<f64>,
    /// The tone from which on there is none of it.
    #[schemars(range(min = -2.0, max = 3.0), extend("unit" = "1"))]
    pub from: Option<f64>,
    /// The tone at which there is most of it.
    #[schemars(range(min = -2.0, max = 3.0), extend("unit" = "1"))]
    pub to: Option<f64>,
    /// The share that is inked at most.
    #[schemars(range(min = 0.0, max = 4.0), extend("unit" = "1"))]
    pub amount: Option<f64>,
    /// How wide its edges are.
    #[schemars(range(min = 0.0, max = 100.0), extend("unit" = "px"))]
    pub softness: Option<f64>,
    /// A finer noise that is mixed in.
    pub grain: Option<Grain>,
    /// How much darker its edges are, as those of wet paint.
    #[schemars(range(min = 0.0, max = 4.0), extend("unit" = "1"))]
    pub rim: Option<f64>,
    /// Which values of the noise ink.
    pub side: Option<Side>,
    /// How strong pigment (up to 1) or relief is.
    #[schemars(range(min = 0.0, max = 4.0), extend("unit" = "1"))]
    pub strength: Option<f64>,
    /// Where the light on a relief comes from.
    #[schemars(extend("unit" = "degrees"))]
    pub angle: Option<f64>,
    /// The width of an outline.
    #[schemars(range(min = 0.0, max = 200.0), extend("unit" = "px"))]
    pub width: Option<f64>,
    /// How much the noise changes the width.
    #[schemars(range(min = 0.0, max = 4.0), extend("unit" = "1"))]
    pub vary: Option<f64>,
    /// The angle between normals from which on a crease has an outline, if creases have one.
    #[schemars(range(min = 0.0, max = 180.0), extend("unit" = "degrees"))]
    pub creases: Option<f64>,
    /// The step in depth from which on there is an outline within the layer.
    #[schemars(range(min = 0.1, max = 1000.0), extend("unit" = "px"))]
    pub step: Option<f64>,
}

/// What a mark does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Does {
    /// Inks where the noise is below a threshold that follows the tone.
    Ink,
    /// Puts more or less pigment into the color.
    Pigment,
    /// Lights the noise as a relief.
    Relief,
    /// Draws along rims.
    Outline,
}

/// A finer noise that is mixed into another.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(transform = open)]
pub struct Grain {
    /// Its name.
    pub noise: String,
    /// How much of it.
    #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1"))]
    pub amount: f64,
}

/// Which values of a noise ink.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// Low ones.
    #[default]
    Low,
    /// High ones.
    High,
}

impl Default for Force {
    fn default() -> Self {
        Force {
            style: Style::default(),
            anchor: Anchor::Surface,
            size: 1.0,
            amount: 1.0,
            ink: "#1c1a18".into(),
            paper: "#f6f1e6".into(),
            ground: Ground::Paper,
            fade: 0.0,
            tone: Tone::default(),
            direction: Direction::default(),
            vary: None,
            redraw: 0.0,
            seed: 1,
            noises: BTreeMap::new(),
            marks: Vec::new(),
        }
    }
}

impl Default for Tone {
    fn default() -> Self {
        Tone { of: ToneOf::Color, dark: 0.25, light: 0.9, gamma: 1.0 }
    }
}

impl Default for Direction {
    fn default() -> Self {
        let (angle, turn, smooth) = (45.0, 0.0, 0.08);
        Direction { along: Along::Screen, angle, turn, smooth, axis: [0.0, 1.0, 0.0], image: String::new() }
    }
}

impl Default for Vary {
    fn default() -> Self {
        Vary { by: By::Light, low: 1.0, high: 1.0, image: String::new() }
    }
}

impl Default for Noise {
    fn default() -> Self {
        Noise {
            spacing: 12.0,
            regularity: 1.25,
            overlap: 16.0,
            spread: 6.0,
            turn: 0.0,
            even: false,
            trim: Trim::Depth,
            reach: 0.5,
            seed: 0,
            anchor: None,
            direction: None,
            vary: None,
        }
    }
}

/// Makes a schema one of what is laid over a style: nothing need be written but a name, everything may be null, and there
/// are no defaults.
fn open(schema: &mut Schema) {
    let Some(map) = schema.as_object_mut() else { return };
    map.remove("default");
    if let Some(Value::Array(required)) = map.get_mut("required") {
        required.retain(|name| name == "name");
    }
    let names = matches!(map.get("properties").and_then(|all| all.get("name")), Some(Value::Object(_)));
    if names {
        map.insert("required".into(), json!(["name"]));
    }
    let Some(Value::Object(properties)) = map.get_mut("properties") else { return };
    for (name, property) in properties.iter_mut().filter(|(name, _)| *name != "name") {
        let Value::Object(field) = property else { continue };
        field.remove("default");
        if let Some(Value::String(kind)) = field.get("type").cloned() {
            field.insert("type".into(), json!([kind, "null"]));
        } else if let Some(to) = field.remove("$ref") {
            field.insert("anyOf".into(), json!([{ "$ref": to }, { "type": "null" }]));
        }
        debug_assert!(field.contains_key("type") || field.contains_key("anyOf"), "{name}");
    }
    if let Some(Value::Object(name)) = properties.get_mut("name") {
        name.remove("default");
    }
}
