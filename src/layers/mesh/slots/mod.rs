//! The slots of the mesh layer: what its surface shows, and what is drawn on that. This file is the only list of what goes
//! there; each is a file or a folder of its own, that nothing else names.

pub mod layer;
pub mod plain;
pub mod strokes;
pub mod texture;
pub mod view_map;

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::added::Added;
use super::drawing::DrawingSlot;
use super::surface::SurfaceSlot;
use crate::layers::parts::shots::{Laid, Laying};
use crate::layers::starts::NewLayer;

/// What kinds of surface add to the technique.
pub const OF_SURFACES: Added = view_map::slot::ADDED;
/// What strokes add to it.
pub const OF_STROKES: Added = strokes::slot::ADDED;

/// What the surface of a mesh shows, told apart by `kind`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Surface {
    /// One color.
    Plain(plain::Plain),
    /// An image, by the texture coordinates of the mesh.
    Texture(texture::Texture),
    /// A layer at its own time, by the texture coordinates of the mesh.
    Layer(layer::LayerSurface),
    /// Pictures of the object, each laid on it from its own camera.
    ViewMap(view_map::model::ViewMap),
}

impl Default for Surface {
    fn default() -> Self {
        Surface::Plain(plain::Plain::default())
    }
}

impl Surface {
    /// The surface as its kind.
    pub fn slot(&self) -> &dyn SurfaceSlot {
        match self {
            Surface::Plain(surface) => surface,
            Surface::Texture(surface) => surface,
            Surface::Layer(surface) => surface,
            Surface::ViewMap(surface) => surface,
        }
    }
}

/// The surface of a new layer that shows this; `None` if it need not be written.
pub fn template(shown: &NewLayer) -> Option<Value> {
    let image = shown.image.map(|image| json!({ "kind": "texture", "image": image }));
    image.or_else(|| shown.color.map(|color| json!({ "kind": "plain", "color": color })))
}

/// How more pictures with cameras come to lie on a surface: it becomes one of a kind that can have them, if it is not.
pub fn lay(surface: &Surface, pictures: &[Laid]) -> Option<Laying> {
    let first = (!matches!(surface, Surface::ViewMap(_))).then(|| ("/surface", view_map::lay::empty(pictures)));
    Some(view_map::lay::laying(pictures, first, "/surface/views"))
}

/// The strokes that a mesh is drawn with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Strokes(strokes::force::Strokes);

impl JsonSchema for Strokes {
    fn schema_name() -> Cow<'static, str> {
        strokes::force::Strokes::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        strokes::force::Strokes::json_schema(generator)
    }
}

impl Strokes {
    /// As what is drawn on a mesh.
    pub fn slot(&self) -> &dyn DrawingSlot {
        &self.0
    }
}
