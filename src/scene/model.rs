//! A scene, as in the document. The doc comments become the help texts of forms and schema.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::clip::Clip;
use crate::base::problem;
use crate::layers::parts::materials::{List, Of, Use};
use crate::layers::space::camera::Camera;
use crate::layers::{Layer, shapes::shape::Shape, timeline::Timeline};

/// The version of the document that this program writes.
pub const VERSION: u32 = 1;

/// Width and height of a frame if neither the scene nor a picture in it says another.
pub const FRAME: (usize, usize) = (1280, 720);

/// A scene: what `NAME.plica.json` holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Version of the document format.
    #[schemars(extend("unit" = "1", "readOnly" = true))]
    pub plica: u32,
    /// What the scene is called.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    #[schemars(extend("default" = ""))]
    pub title: String,
    /// Length, frame rate and what follows the end.
    #[serde(default)]
    pub timeline: Timeline,
    /// Width and height of a frame; without them, those of the first picture that a layer shows, else 1280 x 720.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "px"), inner(range(min = 1, max = 65535)))]
    pub size: Option<[u32; 2]>,
    /// The color behind all layers: sRGB with straight alpha, #rrggbb or #rrggbbaa.
    #[serde(default = "clear", skip_serializing_if = "is_clear")]
    #[schemars(extend("default" = "#00000000"))]
    pub background: String,
    /// Where layers in space are seen from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub camera: Option<Camera>,
    /// The pictures, by name.
    #[serde(default)]
    pub images: BTreeMap<String, Image>,
    /// The meshes, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(extend("default" = {}))]
    pub meshes: BTreeMap<String, Mesh>,
    /// The clips, by name: moving pictures.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(extend("default" = {}))]
    pub clips: BTreeMap<String, Clip>,
    /// The shapes, by name: paths that outlines and curves share.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(extend("default" = {}))]
    pub shapes: BTreeMap<String, Shape>,
    /// The layers, composed in this order: later over earlier.
    #[serde(default)]
    pub layers: Vec<Layer>,
}

impl Scene {
    /// Everything that layers name, each with its pointer.
    pub fn uses(&self) -> impl Iterator<Item = Use<'_>> {
        self.layers.iter().enumerate().flat_map(|(i, layer)| {
            let uses = layer.technique().uses().into_iter();
            uses.map(move |used| Use { at: format!("/layers/{i}{}", used.at), ..used })
        })
    }

    /// The index of the layer with this name.
    ///
    /// # Errors
    /// There is none: in words, with those that there are.
    pub fn layer_called(&self, name: &str) -> Result<usize, String> {
        let names = || self.layers.iter().map(|layer| layer.technique().name());
        let unknown = || match problem::nearest(name, names()) {
            Some(hint) => format!("there is no layer {} ({hint})", problem::quoted(name)),
            None => "the scene has no layers".to_owned(),
        };
        names().position(|own| own == name).ok_or_else(unknown)
    }

    /// Pointers to where layers name what is called `name` in a list of the scene.
    pub fn users_of<'a>(&'a self, list: List, name: &'a str) -> impl Iterator<Item = String> + 'a {
        self.uses().filter(move |used| used.of == Of::Name(list, name)).map(|used| used.at)
    }
}

impl Default for Scene {
    fn default() -> Self {
        Scene {
            plica: VERSION,
            title: String::new(),
            timeline: Timeline::default(),
            size: None,
            background: clear(),
            camera: None,
            images: BTreeMap::new(),
            meshes: BTreeMap::new(),
            clips: BTreeMap::new(),
            shapes: BTreeMap::new(),
            layers: Vec::new(),
        }
    }
}

fn clear() -> String {
    "#00000000".into()
}

fn is_clear(color: &String) -> bool {
    *color == clear()
}

/// A picture of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Image {
    /// The file, relative to the scene.
    #[schemars(length(min = 1))]
    pub path: String,
}

/// A mesh of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// The file, relative to the scene: Wavefront OBJ or glTF 2.0.
    #[schemars(length(min = 1))]
    pub path: String,
}
