//! The document: a scene is a value, and so is an edit.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::layers::parts::materials::{Of, Use};
use crate::layers::{Layer, timeline::Timeline};

pub mod address;
pub mod build;
pub mod check;
mod document;
pub mod edit;
pub mod field;
mod follow;
pub mod history;
pub mod insert;
pub mod json;
pub mod layout;
pub mod merge;
pub mod migrate;
pub mod pointer;
pub mod schema;
mod shape;
pub mod words;

pub use document::Document;
pub use edit::Edit;
pub use history::History;

/// The version of the document that this program writes.
pub const VERSION: u32 = 1;

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
    /// The pictures, by name.
    #[serde(default)]
    pub images: BTreeMap<String, Image>,
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

    /// Pointers to where layers name the image `name`.
    pub fn users_of_image<'a>(&'a self, name: &'a str) -> impl Iterator<Item = String> + 'a {
        self.uses().filter(move |used| used.of == Of::Image(name)).map(|used| used.at)
    }
}

/// A picture of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Image {
    /// The file, relative to the scene.
    #[schemars(length(min = 1))]
    pub path: String,
}

#[cfg(test)]
mod tests;
