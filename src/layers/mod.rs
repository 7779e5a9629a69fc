//! One folder a technique, the same file names in each. [`Layer`] is the only list of them.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use kurbo::{Rect, Vec2};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::base::budget::Budget;
use crate::base::change::Change;
use crate::base::picture::Picture;
use crate::base::pixels::Grid;
use crate::base::problem::Problem;

pub mod check;
pub mod folding;
pub mod parts;
pub mod ready;
pub mod timeline;

use parts::repeat::Repeat;
use ready::{Prepared, Ready};
use timeline::Wrap;

/// A position or vector in image pixels, [x, y], x right and y down.
pub type Xy = [f64; 2];

/// How many things a place of the document asks for.
pub struct Count<'a> {
    /// What is counted: "anchors", "points" (of outlines).
    pub what: &'static str,
    /// The place, relative to the layer.
    pub path: &'a dyn Fn() -> String,
    /// How many, estimated from above.
    pub count: f64,
}

/// A thing of another kind made out of an old one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Turned {
    /// What stands in its place; more than one thing only in a list, where they follow one another.
    pub items: Vec<Value>,
    /// What could not be kept, in words.
    pub lost: Option<String>,
}

/// The problems of a layer, part by part, each relative to its part: what an edit leaves alone keeps them.
#[derive(Clone, Debug, Default)]
pub struct Checked(pub Vec<Arc<[Problem]>>);

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

    /// Checks the layer by itself. Parts that are as in the layer `before` keep what was found there.
    pub fn check(&self, before: Option<(&Layer, &Checked)>) -> Checked {
        match self {
            Layer::Picture(picture) => {
                let before = before.map(|(Layer::Picture(before), checked)| (before, checked));
                folding::check::check(picture, before)
            }
        }
    }

    /// Every problem that a check has found; paths are relative to the layer.
    pub fn problems(&self, checked: &Checked) -> Vec<Problem> {
        match self {
            Layer::Picture(_) => folding::check::problems(checked),
        }
    }

    /// The layer that `json` means, where `change` is how that differs from what this one was read from; `None` if it
    /// must be read as a whole.
    pub fn reread(&self, json: &Value, change: &Change) -> Option<Layer> {
        match self {
            _ if *change.field("kind") != Change::Same => None,
            Layer::Picture(picture) => folding::reread::layer(picture, json, change).map(Layer::Picture),
        }
    }

    /// Calls `each` with what the layer asks for, place by place, told before any of it is made.
    pub fn counts(&self, each: &mut dyn FnMut(Count)) {
        match self {
            Layer::Picture(picture) => folding::check::counts(picture, each),
        }
    }

    /// Bytes of memory that places of the layer ask for while it is made ready, one place after the other.
    pub fn memory(&self) -> Vec<(String, u64)> {
        match self {
            Layer::Picture(picture) => folding::check::memory(picture),
        }
    }

    /// What the pictures and fields that it names say about the layer; paths are relative to it.
    pub fn check_materials(&self, materials: &Materials) -> Vec<Problem> {
        match self {
            Layer::Picture(picture) => folding::check::check_materials(picture, materials),
        }
    }

    /// The masks that the layer names: each with its pointer relative to the layer, and the picture that it is for.
    pub fn masks(&self) -> Vec<(String, &str, &str)> {
        match self {
            Layer::Picture(picture) => folding::check::masks(picture),
        }
    }

    /// The images that the layer names, each with its pointer relative to the layer.
    pub fn images(&self) -> Vec<(String, &str)> {
        match self {
            Layer::Picture(picture) => folding::check::images(picture),
        }
    }

    /// The files that the layer names by their paths, each with its pointer relative to the layer.
    pub fn files(&self) -> Vec<(String, &str)> {
        match self {
            Layer::Picture(picture) => folding::check::files(picture),
        }
    }

    /// The image whose size a frame may take, if the layer has one.
    pub fn frame_of(&self) -> Option<&str> {
        match self {
            Layer::Picture(picture) => Some(&picture.image),
        }
    }

    /// Makes the layer ready to be shown at any time. What `previous` has in common with it is taken over. `place` is the
    /// place in each pixel that is looked at: its centre, or another for supersampling.
    ///
    /// # Errors
    /// Something that the layer names is not among the materials, or nobody wants it any more; the problem's path is
    /// relative to the layer.
    pub fn synth(
        &self,
        wrap: Wrap,
        materials: &Materials,
        place: Vec2,
        previous: Option<&dyn Ready>,
    ) -> Result<Arc<dyn Ready>, Problem> {
        match self {
            Layer::Picture(picture) => {
                let previous = previous.and_then(|previous| previous.downcast());
                Ok(Arc::new(folding::synth::synth(picture, wrap, materials, place, previous)?))
            }
        }
    }

    /// Makes what all parts of the layer share.
    ///
    /// # Errors
    /// As [`Layer::synth`].
    pub fn prepare(&self, wrap: Wrap, materials: &Materials, place: Vec2) -> Result<Box<dyn Prepared>, Problem> {
        match self {
            Layer::Picture(picture) => {
                Ok(Box::new(folding::synth::PreparedLayer::new(picture, wrap, materials, place)?))
            }
        }
    }

    /// What happens to the layer where time starts anew.
    pub fn repeat(&self, wrap: Wrap) -> Repeat {
        match self {
            Layer::Picture(picture) => folding::seam::repeat(picture, wrap),
        }
    }

    /// What the `old` thing at `path` (relative to the layer) becomes as one of the kind `to`; `None` if fields of the
    /// same name are all that both kinds can have in common.
    pub fn turned(&self, path: &str, old: &Value, to: &str) -> Option<Turned> {
        match self {
            Layer::Picture(picture) => folding::kinds::turned(picture, path, old, to),
        }
    }

    /// The place in the layer's picture that something new at `path` (relative to the layer) belongs to.
    pub fn bounds(&self, path: &str) -> Rect {
        match self {
            Layer::Picture(picture) => folding::starts::bounds(picture, path),
        }
    }
}

/// What the field `field` of a new `variant` starts as, where the schema has no default and zeros will not do.
pub fn start(variant: &str, field: &str, bounds: Rect) -> Option<Value> {
    folding::starts::start(variant, field, bounds)
}

/// What a new item of a list has beyond what must be written: a field and its value.
pub fn beyond(list: &str) -> Option<(&'static str, Value)> {
    folding::starts::beyond(list)
}

/// Where in its items a list of a `variant` ascends (a JSON pointer), if it does.
pub fn ascending(variant: &str, list: &str) -> Option<&'static str> {
    folding::starts::ascending(variant, list)
}

/// A new item of a list before item `index`, and the index it gets, where it depends on its neighbours.
pub fn item(variant: &str, list: &str, items: &[Value], index: usize) -> Option<(usize, Value)> {
    folding::starts::item(variant, list, items, index)
}

/// What a scene names and synthesis needs: decoded pictures and vector fields. Values, no handles.
#[derive(Clone, Debug, Default)]
pub struct Materials {
    /// Pictures by their name in the scene's images.
    pub pictures: BTreeMap<String, Arc<Picture>>,
    /// Masks without alpha laid on the pictures that they are for, by the names of both.
    pub masks: BTreeMap<(String, String), Arc<Picture>>,
    /// Sampled vector fields by their path in the scene, in pixels.
    pub fields: BTreeMap<String, Arc<Grid<[f32; 2]>>>,
    /// Cancellation flag: once set, a synthesis under way ends with an error.
    pub stop: Option<Arc<AtomicBool>>,
    /// The memory that is left for what is made of them.
    pub budget: Budget,
}

impl Materials {
    /// Whether the synthesis has been cancelled.
    pub fn stopped(&self) -> bool {
        self.stop.as_ref().is_some_and(|stop| stop.load(Ordering::Relaxed))
    }

    /// What samplers read through the mask `name` of the picture `own`.
    ///
    /// # Errors
    /// It is not there; `path` tells where it is named.
    pub fn mask(&self, name: &str, own: &str, path: &str) -> Result<Arc<Picture>, Problem> {
        match self.masks.get(&(name.to_owned(), own.to_owned())) {
            Some(laid) => Ok(laid.clone()),
            None => self.picture(name, path),
        }
    }

    /// The picture of that name.
    ///
    /// # Errors
    /// It is not there; `path` tells where it is named.
    pub fn picture(&self, name: &str, path: &str) -> Result<Arc<Picture>, Problem> {
        let missing = || Problem::error(path, format!("the picture \"{name}\" is not there"));
        self.pictures.get(name).cloned().ok_or_else(missing)
    }
}
