//! One folder per technique, with the same file names in each. This file is the only list of them.

use std::collections::{BTreeMap, BTreeSet};

use kurbo::{Affine, Rect};
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

pub use folding::nodes::Handles;
pub use folding::shapes::Shape;
use technique::{Kind, Technique};

/// The techniques: what `kind` can be in the document.
pub static KINDS: &[&Kind] = &[&folding::KIND, &fill::KIND, &mesh::KIND, &waterfall::KIND];

/// A shape of the scene, or something in it, under a map of the picture: as [`Technique::transformed`].
///
/// # Errors
/// Why it cannot be.
pub fn transformed_shape(path: &str, value: &Value, by: Affine) -> Option<Result<(Value, Rect), String>> {
    folding::transform::transformed(path, value, by)
}

/// Nodes of a path as they are written, with the handles of some made anew; `None` if they are no nodes.
pub fn handled(nodes: &[Value], closed: bool, chosen: &BTreeSet<usize>, handles: Handles) -> Option<Vec<Value>> {
    let all = folding::nodes::handled(&folding::node::read(nodes)?, closed, chosen, handles);
    // Those that stay are written as they were.
    let each = nodes.iter().zip(&all).enumerate();
    let written = |(i, (old, new)): (usize, (&Value, &_))| {
        if chosen.contains(&i) { folding::node::written(new) } else { old.clone() }
    };
    Some(each.map(written).collect())
}

/// So many nodes evenly along the path of nodes as they are written; `None` if they are no nodes.
pub fn resampled(nodes: &[Value], closed: bool, count: usize) -> Option<Vec<Value>> {
    let all = folding::nodes::resampled(&folding::node::read(nodes)?, closed, count);
    Some(all.iter().map(folding::node::written).collect())
}

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

    /// Looks up the shapes of the scene that the layer names.
    pub fn resolve(&mut self, shapes: &BTreeMap<String, Shape>) {
        if let Layer::Picture(layer) = self {
            folding::shared::resolve(layer, shapes);
        }
    }

    /// Whether the thing at `path` in the layer can be left out by itself.
    pub fn can_mute(&self, path: &str) -> bool {
        matches!(self, Layer::Picture(_)) && folding::muted::can_be(path)
    }

    /// The layer as if the things at these paths were not there, with the others in their places; the layer itself is at the
    /// empty path.
    pub fn without(&self, paths: &[&str]) -> Layer {
        match self {
            _ if paths.is_empty() => self.clone(),
            _ if paths.contains(&"") => Layer::Fill(fill::model::FillLayer::clear(self.technique().name())),
            Layer::Picture(layer) => Layer::Picture(folding::muted::layer(layer, paths)),
            Layer::Fill(_) | Layer::Mesh(_) | Layer::Waterfall(_) => self.clone(),
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
