//! One folder a technique, the same file names in each. [`Layer`] is the only list of them.

use std::{collections::BTreeMap, sync::Arc};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::base::pixels::{Grid, Picture};
use crate::base::problem::Problem;

pub mod folding;
pub mod timeline;

/// A position or vector in image pixels, [x, y], x right and y down.
pub type Xy = [f64; 2];

/// One layer of a scene, told apart by `kind`. Layers are composed in list order, later over earlier.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Layer {
    /// A still picture whose motion zones fold over time.
    Picture(folding::model::PictureLayer),
}

impl Layer {
    /// The layer's name, unique in its scene.
    pub fn name(&self) -> &str {
        match self {
            Layer::Picture(picture) => &picture.name,
        }
    }
}

/// What a scene names and synthesis needs: decoded pictures and vector fields. Values, no handles.
#[derive(Clone, Debug, Default)]
pub struct Materials {
    /// Pictures by their name in the scene's images.
    pub pictures: BTreeMap<String, Arc<Picture>>,
    /// Sampled vector fields by their path in the scene, in pixels.
    pub fields: BTreeMap<String, Arc<Grid<[f32; 2]>>>,
}

impl Materials {
    /// The picture of that name.
    ///
    /// # Errors
    /// It is not there; `path` tells where it is named.
    pub fn picture(&self, name: &str, path: &str) -> Result<Arc<Picture>, Problem> {
        let missing = || Problem::error(path, format!("the picture \"{name}\" is not there"));
        self.pictures.get(name).cloned().ok_or_else(missing)
    }
}
