//! A mesh in space, seen by the scene's camera. What its surface shows, and what is drawn on that, are slots of its own
//! (`slots/`).

pub mod added;
pub mod around;
pub mod bundle;
pub mod drawing;
pub mod frame;
pub mod marks;
pub mod measure;
pub mod model;
mod odd;
pub mod plan;
pub mod pose;
pub mod probe;
pub mod ready;
pub mod slots;
pub mod surface;
pub mod synth;
mod unseen;

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};
use kurbo::Rect;
use serde_json::{Value, json};

use self::drawing::DrawingSlot;
use self::model::MeshLayer;
use super::parts::materials::{List, Materials, Of, Use, What};
use super::parts::measures::Measures;
use super::parts::moment::{Moment, Space};
use super::parts::pass::{self, Pass};
use super::parts::readout::ReadOut;
use super::parts::repeat::{self, Repeat};
use super::parts::shots::{Laid, Laying, Lying};
use super::parts::sketch::Sketch;
use super::ready::{Making, Ready};
use super::starts::{NewLayer, Template};
use super::technique::{Bundle, Checked, Kind, Technique};
use super::timeline::{Timeline, Wrap};
use crate::base::pointer::Pointer;
use crate::base::problem::Problem;

/// The technique.
pub static KIND: Kind = Kind {
    name: "mesh",
    space: Space::World,
    programs: &[&[&plan::PLAIN], slots::OF_SURFACES.programs, slots::OF_STROKES.programs],
    routines: slots::OF_STROKES.routines,
    twins: &[plan::TWINS, slots::OF_SURFACES.twins, slots::OF_STROKES.twins],
    bundle: Some(Bundle { names: bundle::names, write: bundle::write }),
    counted: &[],
    overlays: &[marks::OVERLAYS, slots::OF_SURFACES.overlays, slots::OF_STROKES.overlays],
    passes: &[slots::OF_STROKES.passes, slots::OF_SURFACES.passes],
    looks: &[marks::LOOKS, slots::OF_SURFACES.looks, slots::OF_STROKES.looks],
    template: Some(Template { of: List::Meshes, layer: template, ground: None }),
    blank: None,
    starts: slots::OF_STROKES.starts,
    presets: &[],
    styles: slots::OF_STROKES.styles,
    comparisons: slots::OF_STROKES.comparisons,
    example: include_str!("example.json"),
};

/// A layer that shows a mesh, with an image or a color on its surface.
fn template(shown: &NewLayer) -> Value {
    let mut layer = json!({ "kind": "mesh", "name": shown.name, "mesh": shown.name });
    if shown.both_sides {
        layer["sides"] = "both".into();
    }
    if let Some(surface) = slots::template(shown) {
        layer["surface"] = surface;
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
        let without = materials.meshes.get(&self.mesh).and_then(|mesh| mesh.without_uv);
        let problem = |triangle: usize| {
            let message =
                format!("the mesh \"{}\" has no texture coordinates at triangle {triangle} (from 0)", self.mesh);
            Problem::error("/surface", message).hint("make the surface plain, or unwrap the mesh")
        };
        let surface = without.filter(|_| self.surface.slot().needs_uv()).map(problem);
        let strokes = self.drawing().zip(without);
        let strokes = strokes.and_then(|(own, triangle)| own.check_uv(&self.mesh, triangle));
        let fits = self.surface.slot().check_materials(materials).into_iter().map(|problem| problem.under("/surface"));
        let odd = materials.meshes.get(&self.mesh).into_iter().flat_map(|mesh| odd::warnings(self, mesh));
        let strokes = strokes.map(|problem| problem.under("/strokes"));
        surface.into_iter().chain(fits).chain(strokes).chain(odd).collect()
    }

    fn moves(&self) -> bool {
        let (pose, redrawn) = (&self.pose, self.drawing().is_some_and(DrawingSlot::moves));
        pose.spin != 0.0 || pose.bend.swing * pose.bend.degrees != 0.0 || redrawn
    }

    fn unseen(&self, moments: &[Moment], materials: &Materials) -> Option<Problem> {
        unseen::warning(self, materials.meshes.get(&self.mesh)?, moments)
    }

    fn check_made(&self, making: &Making) -> Vec<Problem> {
        let surface = self.surface.slot();
        let made = (self.strokes.is_some() || surface.explains()).then(|| synth::Synth::new(self, making, None));
        match made {
            Some(Ok(made)) => surface.check_made(&*made.surface).into_iter().map(|odd| odd.under("/surface")).collect(),
            Some(Err(problem)) => vec![problem],
            None => Vec::new(),
        }
    }

    fn repeat(&self, timeline: &Timeline, _materials: &Materials) -> Repeat {
        let spin = (timeline.wrap == Wrap::Repeat).then(|| repeat::turned("/pose/spin", self.pose.spin)).flatten();
        Repeat { snaps: spin.into_iter().collect(), speeds: Vec::new() }
    }

    fn uses(&self) -> Vec<Use<'_>> {
        let mesh = Use { at: "/mesh".into(), of: Of::Name(List::Meshes, &self.mesh), what: What::Mesh };
        let surface = self.surface.slot().uses().into_iter();
        let surface = surface.map(|used| Use { at: format!("/surface{}", used.at), ..used });
        let strokes = self.drawing().into_iter().flat_map(DrawingSlot::uses);
        let strokes = strokes.map(|used| Use { at: format!("/strokes{}", used.at), ..used });
        std::iter::once(mesh).chain(surface).chain(strokes).collect()
    }

    fn automatic(&self, path: &str) -> Option<Value> {
        self.drawing()?.automatic(Pointer(path).below("/strokes")?)
    }

    fn laid(&self, path: &str) -> Option<Vec<String>> {
        self.drawing()?.laid(Pointer(path).below("/strokes")?)
    }

    fn pass_names(&self, pass: &Pass) -> Vec<&str> {
        self.drawing().map(|own| own.pass_names(pass)).unwrap_or_default()
    }

    fn pass_colors(&self, pass: &Pass) -> Vec<(&str, [u8; 3])> {
        self.surface.slot().pass_colors(pass)
    }

    fn has_pass(&self, pass: &Pass) -> bool {
        match pass {
            pass if pass::PASSES.contains(&pass) => true,
            pass if slots::OF_SURFACES.passes.contains(pass) => self.surface.slot().explains(),
            _ => self.strokes.is_some(),
        }
    }

    fn sketched(&self) -> &'static [&'static str] {
        self.drawing().map(DrawingSlot::sketched).unwrap_or_default()
    }

    fn sketch(&self, path: &str) -> Option<Sketch> {
        self.drawing()?.sketch(Pointer(path).below("/strokes")?)
    }

    fn item_name(&self, path: &str) -> Option<&str> {
        self.surface.slot().item_name(Pointer(path).below("/surface")?)
    }

    fn lying(&self) -> Option<Vec<Lying<'_>>> {
        Some(self.surface.slot().lying().unwrap_or_default())
    }

    fn check_lying(&self, materials: &Materials) -> Vec<Problem> {
        let mesh = materials.meshes.get(&self.mesh);
        let odd = mesh.map(|mesh| self.surface.slot().check_lying(mesh)).unwrap_or_default();
        odd.into_iter().map(|problem| problem.under("/surface")).collect()
    }

    fn lay(&self, pictures: &[Laid]) -> Option<Laying> {
        slots::lay(&self.surface, pictures)
    }

    fn model_to_world(&self, t: f64) -> Option<DAffine3> {
        let placed = self.pose.at(t);
        Some(DAffine3::from_mat3_translation(
            placed.turn * DMat3::from_diagonal(DVec3::splat(placed.scale)),
            placed.position,
        ))
    }

    fn is_in_model(&self, path: &str) -> bool {
        Pointer(path).is_inside("/surface")
    }

    fn bounds(&self, _path: &str) -> Rect {
        Rect::new(0.0, 0.0, 1.0, 1.0)
    }

    fn probe(
        &self,
        making: &Making,
        ready: Option<&dyn Ready>,
        pixel: (usize, usize),
        moment: &Moment,
    ) -> Result<Option<ReadOut>, Problem> {
        let ready = ready.and_then(|ready| ready.downcast());
        probe::probe(self, (making, ready), pixel, moment).map(Some)
    }

    fn measure(
        &self,
        making: &Making,
        moment: &Moment,
        steps: u32,
        step: &mut dyn FnMut(u64, u64) -> bool,
    ) -> Result<Option<Measures>, Problem> {
        measure::measure(self, making, moment, steps, step)
    }

    fn synth(&self, making: &Making, previous: Option<&dyn Ready>) -> Result<Arc<dyn Ready>, Problem> {
        let previous = previous.and_then(|previous| previous.downcast());
        Ok(Arc::new(synth::Synth::new(self, making, previous)?))
    }
}
