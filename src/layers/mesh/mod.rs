//! A mesh in space, seen by the scene's camera. What its surface shows is a slot of its own (`surface/`).

pub mod frame;
pub mod marks;
pub mod model;
pub mod plan;
pub mod pose;
pub mod probe;
pub mod ready;
pub mod surface;
pub mod synth;

use std::sync::Arc;

use kurbo::Rect;
use serde_json::{Value, json};

use self::model::MeshLayer;
use super::parts::materials::{List, Materials, Of, Use, What};
use super::parts::moment::{Moment, Space};
use super::parts::readout::ReadOut;
use super::ready::{Making, Ready};
use super::technique::{Checked, Kind, Shown, Starts, Technique, Template};
use crate::base::problem::Problem;

/// The technique.
pub static KIND: Kind = Kind {
    name: "mesh",
    space: Space::World,
    programs: &[&plan::PLAIN, &plan::PICTURED],
    bundle: None,
    counted: &[],
    overlays: marks::OVERLAYS,
    passes: &[],
    looks: marks::LOOKS,
    template: Some(Template { of: List::Meshes, layer: template }),
    starts: Starts::PLAIN,
    presets: &[],
    example: include_str!("example.json"),
};

/// A layer that shows a mesh, with an image on its surface.
fn template(shown: &Shown) -> Value {
    let mut layer = json!({ "kind": "mesh", "name": shown.name, "mesh": shown.name });
    if let Some(image) = shown.image {
        layer["surface"] = json!({ "kind": "texture", "image": image });
    }
    layer
}

impl Technique for MeshLayer {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn name(&self) -> &str {
        &self.name
    }

    fn check(&self, _before: Option<(&dyn Technique, &Checked)>) -> Checked {
        Checked(vec![MeshLayer::check(self).into()])
    }

    fn check_materials(&self, materials: &Materials) -> Vec<Problem> {
        let mesh = materials.meshes.get(&self.mesh).filter(|_| self.surface.slot().needs_uv());
        let without = mesh.and_then(|mesh| mesh.without_uv);
        let problem = |triangle: usize| {
            let message =
                format!("the mesh \"{}\" has no texture coordinates at triangle {triangle} (from 0)", self.mesh);
            Problem::error("/surface", message).hint("make the surface plain, or unwrap the mesh")
        };
        without.map(problem).into_iter().collect()
    }

    fn uses(&self) -> Vec<Use<'_>> {
        let mesh = Use { at: "/mesh".into(), of: Of::Name(List::Meshes, &self.mesh), what: What::Mesh };
        let surface = self.surface.slot().uses().into_iter();
        let surface = surface.map(|used| Use { at: format!("/surface{}", used.at), ..used });
        std::iter::once(mesh).chain(surface).collect()
    }

    fn bounds(&self, _path: &str) -> Rect {
        Rect::new(0.0, 0.0, 1.0, 1.0)
    }

    fn probe(
        &self,
        making: &Making,
        _ready: Option<&dyn Ready>,
        pixel: (usize, usize),
        moment: &Moment,
    ) -> Result<Option<ReadOut>, Problem> {
        probe::probe(self, making, pixel, moment).map(Some)
    }

    fn synth(&self, making: &Making, _previous: Option<&dyn Ready>) -> Result<Arc<dyn Ready>, Problem> {
        Ok(Arc::new(synth::Synth::new(self, making)?))
    }
}
