//! The waterfall layer as in the document. The doc comments become the help texts of forms and schema. A field that is
//! not set and has no default here follows the height of the fall (`automatic.rs`).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::look::Look;
use super::sprites::model::Sprites;
use crate::base::geometry::Xyz;

/// Sprites of water, fire or smoke from a clip, carried along flow lines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaterfallLayer {
    /// Unique among the layers.
    #[schemars(length(min = 1))]
    pub name: String,
    /// The clip that sprites come from, by its name in the scene's clips.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("reference" = "clips", "begins" = true))]
    pub clip: Option<String>,
    /// Another seed gives another fall of the same kind.
    #[serde(default = "one")]
    #[schemars(extend("unit" = "1"))]
    pub seed: u32,
    /// Simulated seconds a second: 0.5 is slow motion.
    #[serde(default = "unity")]
    #[schemars(range(min = 0.001, max = 1000.0), extend("unit" = "1"))]
    pub speed: f64,
    /// The measure of everything that is not set: by default from the pool to the highest node of the lip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.001, max = 1e5), extend("unit" = "m"))]
    pub height: Option<f64>,
    /// The height of the water in which lines end: y in the world.
    #[serde(default)]
    #[schemars(extend("unit" = "m"))]
    pub pool: f64,
    /// Where lines start: along the line through these nodes; a single one is a point source.
    #[serde(default = "lip")]
    #[schemars(length(min = 1, max = 1000))]
    pub lip: Vec<Node>,
    /// How many flow lines there are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 20000), extend("unit" = "1"))]
    pub lines: Option<u32>,
    /// Sprites that are born a second on one line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.001, max = 1000.0), extend("unit" = "1/s"))]
    pub rate: Option<f64>,
    /// The longest life of a sprite: what never meets the pool, such as smoke, lives it whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.001, max = 600.0), extend("unit" = "s"))]
    pub life: Option<f64>,
    /// How thick the sheet of water is, across the lip; of a point source its diameter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0), extend("unit" = "m"))]
    pub thickness: Option<f64>,
    /// How much the velocities at the lip differ: the standard deviation of each component.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0), extend("unit" = "m/s"))]
    pub spread: Option<f64>,
    /// How far sprites stray from their line: at birth, and more each second.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(inner(range(min = 0.0)), extend("unit" = "m"))]
    pub scatter: Option<[f64; 2]>,
    /// The acceleration downwards; negative is buoyancy, as of smoke.
    #[serde(default = "gravity")]
    #[schemars(range(min = -1000.0, max = 1000.0), extend("unit" = "m/s2"))]
    pub gravity: f64,
    /// The resistance of the air.
    #[serde(default)]
    pub drag: Drag,
    /// The wind.
    #[serde(default)]
    pub wind: Wind,
    /// Water leaves the lip in clumps.
    #[serde(default)]
    pub surge: Surge,
    /// How a sprite of water looks.
    #[serde(default)]
    pub look: Box<Look>,
    /// How a sprite changes from one picture to the next.
    #[serde(default)]
    pub between: Between,
    /// What springs up where water meets the pool.
    #[serde(default)]
    pub foam: Box<Foam>,
    /// How sprites cover one another.
    #[serde(default)]
    pub blend: Mixing,
    /// Sprites fade over this distance before a surface; 0 cuts them off.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0), extend("unit" = "m"))]
    pub soft: Option<f64>,
    /// The pictures that sprites show.
    #[serde(default)]
    pub sprites: Box<Sprites>,
}

/// A node of the lip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Node {
    /// Where it is.
    #[schemars(extend("unit" = "m"))]
    pub at: Xyz,
    /// How fast water leaves there; between nodes it changes evenly.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "m/s", "columns" = ["vx", "vy", "vz"]))]
    pub velocity: Option<Xyz>,
    /// How much water leaves there, compared with other nodes; between nodes it changes evenly.
    #[serde(default = "unity")]
    #[schemars(range(min = 0.0), extend("unit" = "1"))]
    pub flow: f64,
}

/// The resistance of the air.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Drag {
    /// How it depends on the speed.
    pub model: DragModel,
    /// How strong it is, divided by the mass: in m/s2 if constant, 1/s if linear, 1/m if quadratic.
    #[schemars(range(min = 0.0, max = 1000.0), extend("unit" = "1"))]
    pub amount: f64,
}

/// How the resistance of the air depends on the speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DragModel {
    /// There is none.
    None,
    /// Not at all: it weakens gravity.
    Constant,
    /// In proportion.
    #[default]
    Linear,
    /// With its square.
    Quadratic,
}

/// The wind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Wind {
    /// How fast it is.
    #[schemars(range(min = 0.0, max = 1000.0), extend("unit" = "m/s"))]
    pub speed: f64,
    /// Where it blows: 0 to +x, 90 to +z.
    #[schemars(extend("unit" = "degrees"))]
    pub angle: f64,
    /// How it carries things along.
    pub mode: WindMode,
    /// How fast it does so, if in time.
    #[schemars(range(min = 0.0, max = 1000.0), extend("unit" = "1/s"))]
    pub rate: f64,
}

/// How the wind carries things along.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WindMode {
    /// At once: its speed is added.
    #[default]
    Additive,
    /// In time: speeds approach its own.
    Relax,
}

/// Water leaves the lip in clumps, with gaps between them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Surge {
    /// The size of a clump along the lip.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-6), extend("unit" = "m"))]
    pub width: Option<f64>,
    /// How long a clump takes to leave the lip.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-6), extend("unit" = "s"))]
    pub time: Option<f64>,
    /// How empty gaps are; 0 is an even flow.
    #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1"))]
    pub amount: f64,
    /// How sharply clumps and gaps are told apart.
    #[schemars(range(min = 0.0, max = 100.0), extend("unit" = "1"))]
    pub contrast: f64,
    /// Clumps drift sideways together, up to this fast.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0), extend("unit" = "m/s"))]
    pub sway: Option<f64>,
}

/// How a sprite changes from one picture to the next.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Between {
    /// Which pictures it shows one after the other.
    pub order: Order,
    /// How often it runs through them in a life, there and back in turn: 2 is there and back.
    #[schemars(range(min = 0.01, max = 100.0), extend("unit" = "1"))]
    pub passes: f64,
    /// How a picture changes as it is left and reached.
    pub tangents: Tangents,
    /// How far the pattern runs ahead along the line from one picture to the next, if it does.
    #[schemars(range(min = -64.0, max = 64.0), extend("unit" = "texels"))]
    pub drift: f64,
    /// How much what is between two pictures differs from them at random: linear light.
    #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1"))]
    pub noise: f64,
}

/// Which pictures a sprite shows one after the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Order {
    /// Those of one track.
    #[default]
    Track,
    /// Some of all tracks.
    Shuffle,
}

/// How a picture changes as it is left and reached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Tangents {
    /// Not at all: a smooth cross-fade.
    Zero,
    /// As from the picture before to the one after.
    Catmull,
    /// As if it ran ahead along the line.
    #[default]
    Advect,
}

/// What springs up where water meets the pool.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Foam {
    /// How many lines of foam spring from the end of a flow line; 0 is no foam.
    #[schemars(range(min = 0, max = 64), extend("unit" = "1"))]
    pub lines: u32,
    /// Sprites that are born a second on one of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.001, max = 1000.0), extend("unit" = "1/s"))]
    pub rate: Option<f64>,
    /// How fast it springs up, as a share of the speed of the impact.
    #[schemars(range(min = 0.0, max = 2.0), extend("unit" = "1"))]
    pub restitution: f64,
    /// How steeply it springs up, in the middle.
    #[schemars(range(min = 0.0, max = 90.0), extend("unit" = "degrees"))]
    pub elevation: f64,
    /// How far it may be steeper or flatter.
    #[schemars(range(min = 0.0, max = 90.0), extend("unit" = "degrees"))]
    pub fan: f64,
    /// The longest life of a sprite of foam.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.001, max = 600.0), extend("unit" = "s"))]
    pub life: Option<f64>,
    /// How a sprite of foam looks.
    pub look: Look,
}

/// How sprites cover one another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Mixing {
    /// Like light: for white water and fire, in any order.
    #[default]
    Screen,
    /// Like paint, from far to near: for smoke and clouds.
    Over,
}

impl Default for Drag {
    fn default() -> Self {
        Drag { model: DragModel::Linear, amount: 0.6 }
    }
}

impl Default for Wind {
    fn default() -> Self {
        Wind { speed: 0.0, angle: 0.0, mode: WindMode::Additive, rate: 0.6 }
    }
}

impl Default for Surge {
    fn default() -> Self {
        Surge { width: None, time: None, amount: 0.9, contrast: 3.0, sway: None }
    }
}

impl Default for Between {
    fn default() -> Self {
        Between { order: Order::Track, passes: 1.0, tangents: Tangents::Advect, drift: 1.0, noise: 0.015 }
    }
}

impl Default for Foam {
    fn default() -> Self {
        let (restitution, elevation, fan) = (0.35, 50.0, 30.0);
        Foam { lines: 5, rate: None, restitution, elevation, fan, life: None, look: Look::default() }
    }
}

fn lip() -> Vec<Node> {
    [-1.0, 1.0].map(|x| Node { at: [x, 2.0, 0.0], velocity: None, flow: 1.0 }).into()
}

fn one() -> u32 {
    1
}

fn unity() -> f64 {
    1.0
}

fn gravity() -> f64 {
    9.81
}
