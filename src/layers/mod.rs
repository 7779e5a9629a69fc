//! One folder per technique, with the same file names in each. This file is the only list of them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::base::change::Change;

pub mod check;
pub mod fill;
pub mod folding;
pub mod keyframes;
pub mod mesh;
pub mod parts;
pub mod ready;
pub mod space;
pub mod starts;
pub mod technique;
#[cfg(test)]
mod tests;
pub mod timeline;
pub mod waterfall;

use technique::{Kind, Technique};

/// The techniques: what `kind` can be in the document.
pub static KINDS: &[&Kind] = &[&folding::KIND, &fill::KIND, &mesh::KIND, &waterfall::KIND];

/// One layer of a scene, told apart by `kind`. Layers are composed in list order, later over earlier.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Layer {
    /// A still picture whose motion zones fold over time.
    Picture(folding::model::PictureLayer),
    /// A color or a gradient over the whole frame.
    Fill(fill::model::FillLayer),
    /// A mesh in space, seen by the scene's camera.
    Mesh(mesh::model::MeshLayer),
    /// Sprites of water, fire or smoke from a clip, carried along flow lines.
    Waterfall(waterfall::model::WaterfallLayer),
}

impl Layer {
    /// The layer as its technique.
    pub fn technique(&self) -> &dyn Technique {
        match self {
            Layer::Picture(layer) => layer,
            Layer::Fill(layer) => layer,
            Layer::Mesh(layer) => layer,
            Layer::Waterfall(layer) => layer,
        }
    }

    /// The layer that `json` means, if `change` is how it differs from what this one was read from; `None` if it must
    /// be read as a whole.
    pub fn reread(&self, json: &Value, change: &Change) -> Option<Layer> {
        match self {
            _ if *change.field("kind") != Change::Same => None,
            Layer::Picture(layer) => folding::reread::layer(layer, json, change).map(Layer::Picture),
            Layer::Fill(_) | Layer::Mesh(_) | Layer::Waterfall(_) => None,
        }
    }
}
