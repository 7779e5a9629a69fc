//! One folder per technique, with the same file names in each. This file is the only list of them: to each belong the
//! line with its folder, and the two with its layer in [`Layer`].

use std::collections::BTreeMap;

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
pub mod shapes;
pub mod space;
pub mod starts;
pub mod technique;
#[cfg(test)]
mod tests;
pub mod timeline;
pub mod waterfall;

use shapes::shape::Shape;
use technique::{Kind, Technique};

/// The list of techniques, and one of their layers, which passes on what it is asked.
macro_rules! techniques {
    ($(#[$doc:meta])* enum Layer { $($(#[$help:meta])* $name:ident($folder:ident::model::$layer:ident),)* }) => {
        /// The techniques: what `kind` can be in the document.
        pub static KINDS: &[&Kind] = &[$(&$folder::KIND),*];

        $(#[$doc])*
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(tag = "kind", rename_all = "kebab-case")]
        pub enum Layer { $($(#[$help])* $name($folder::model::$layer),)* }

        impl Layer {
            /// The layer as its technique.
            pub fn technique(&self) -> &dyn Technique {
                match self { $(Layer::$name(layer) => layer,)* }
            }

            /// As [`Technique::resolve`].
            pub fn resolve(&mut self, shapes: &BTreeMap<String, Shape>) {
                match self { $(Layer::$name(layer) => layer.resolve(shapes),)* }
            }

            /// As [`Technique::without`].
            #[must_use]
            pub fn without(&self, paths: &[&str]) -> Layer {
                match self { $(Layer::$name(layer) => Layer::$name(layer.without(paths)),)* }
            }

            /// As [`Technique::reread`].
            pub fn reread(&self, json: &Value, change: &Change) -> Option<Layer> {
                match self {
                    _ if *change.field("kind") != Change::Same => None,
                    $(Layer::$name(layer) => layer.reread(json, change).map(Layer::$name),)*
                }
            }
        }
    };
}

techniques! {
    /// One layer of a scene, told apart by `kind`. Layers are composed in list order, later over earlier.
    enum Layer {
        /// A still picture whose motion zones fold over time.
        Picture(folding::model::PictureLayer),
        /// A color or a gradient over the whole frame.
        Fill(fill::model::FillLayer),
        /// A mesh in space, seen by the scene's camera.
        Mesh(mesh::model::MeshLayer),
        /// Sprites of water, fire or smoke from a clip, carried along flow lines.
        Waterfall(waterfall::model::WaterfallLayer),
    }
}
