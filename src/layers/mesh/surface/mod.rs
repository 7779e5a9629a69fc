//! What a mesh shows on its surface. This file is the only list of kinds of surface; each is a file of its own.

pub mod layer;
pub mod plain;
pub mod texture;
pub mod view_map;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::slot::Slot;
use crate::layers::parts::marks::{self, Overlay};
use crate::layers::parts::pass::Pass;
use crate::layers::parts::plan::Program;
use crate::layers::parts::shots::{Laid, Laying};
use crate::layers::parts::twin::Twin;

/// The passes that kinds of surface add.
pub const PASSES: &[Pass] = &[view_map::passes::INDEPENDENT, view_map::passes::DEPENDENT, view_map::passes::COVERAGE];
/// What is looked at in place of one of them.
pub const COLORS: &[Pass] = &[view_map::passes::COLORS];
/// The programs that kinds of surface add.
pub static PROGRAMS: &[&Program] = &[&view_map::plan::SAMPLED];

/// What shaders of kinds of surface read.
pub const TWINS: &[Twin] = view_map::plan::TWINS;

/// The overlays that kinds of surface add, and their looks.
pub static OVERLAYS: &[Overlay] = &[view_map::marks::OVERLAY];
/// See [`OVERLAYS`].
pub static LOOKS: &[&marks::Look] =
    &[&view_map::marks::CAMERA, &view_map::marks::WHOLE, &view_map::marks::GONE, &view_map::marks::BLEND];

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
    pub fn slot(&self) -> &dyn Slot {
        match self {
            Surface::Plain(surface) => surface,
            Surface::Texture(surface) => surface,
            Surface::Layer(surface) => surface,
            Surface::ViewMap(surface) => surface,
        }
    }
}

/// How more pictures with cameras come to lie on a surface: it becomes one of a kind that can have them, if it is not.
pub fn lay(surface: &Surface, pictures: &[Laid]) -> Option<Laying> {
    let first = (!matches!(surface, Surface::ViewMap(_))).then(|| ("/surface", view_map::lay::empty(pictures)));
    Some(view_map::lay::laying(pictures, first, "/surface/views"))
}
