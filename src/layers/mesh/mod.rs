//! A mesh in space, seen by the scene's camera. What its surface shows is a slot of its own (`surface/`).

pub mod around;
pub mod bundle;
#[cfg(test)]
mod checks;
pub mod frame;
pub mod marks;
pub mod measure;
pub mod model;
mod odd;
pub mod plan;
pub mod pose;
pub mod probe;
pub mod ready;
pub mod slot;
pub mod strokes;
pub mod surface;
pub mod synth;
mod unseen;

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};
use kurbo::Rect;
use serde_json::{Value, json};

use self::model::MeshLayer;
use super::parts::materials::{List, Materials, Of, Use, What};
use super::parts::measures::Measures;
use super::parts::moment::{Moment, Space};
use super::parts::pass::Pass;
use super::parts::readout::ReadOut;
use super::parts::repeat::{self, Repeat};
use super::parts::shots::{Laid, Laying, Lying};
use super::parts::sketch::Sketch;
use super::ready::{Making, Ready};
use super::starts::{Shown, Starts, Template};
use super::technique::{Bundle, Checked, Kind, Technique};
use super::timeline::{Timeline, Wrap};
use crate::base::problem::Problem;

/// The technique.
pub static KIND: Kind = Kind {
    name: "mesh",
    space: Space::World,
    programs: &[&[&plan::PLAIN], surface::PROGRAMS, strokes::plan::PROGRAMS],
    routines: strokes::emit::ROUTINES,
    twins: &[plan::TWINS, surface::TWINS, strokes::upload::TWINS, strokes::emit::TWINS],
    bundle: Some(Bundle { names: bundle::names, write: bundle::write }),
    counted: &[],
    overlays: &[marks::OVERLAYS, surface::OVERLAYS, strokes::overlays::OVERLAYS],
    passes: &[strokes::passes::PASSES, surface::PASSES],
    looks: &[marks::LOOKS, surface::LOOKS, strokes::overlays::LOOKS],
    template: Some(Template { of: List::Meshes, layer: template, ground: None }),
    blank: None,
    // A new mark needs no noise.
    starts: Starts { beyond: |_, list| (list == "marks").then(|| ("kind", "outline".into())), ..Starts::PLAIN },
    presets: &[],
    styles: Some(&strokes::restyle::STYLES),
    comparisons: strokes::restyle::COMPARISONS,
    example: include_str!("example.json"),
};

/// A layer that shows a mesh, with an image or a color on its surface.
fn template(shown: &Shown) -> Value {
    let mut layer = json!({ "kind": "mesh", "name": shown.name, "mesh": shown.name });
    if shown.both_sides {
        layer["sides"] = "both".into();
    }
    if let Some(image) = shown.image {
        layer["surface"] = json!({ "kind": "texture", "image": image });
    } else if let Some(color) = shown.color {
        layer["surface"] = json!({ "kind": "plain", "color": color });
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
        let strokes = self.strokes.as_ref().zip(without);
        let strokes = strokes.and_then(|(own, triangle)| strokes::check::without_uv(own, &self.mesh, triangle));
        let fits = self.surface.slot().check_materials(materials).into_iter().map(|problem| problem.under("/surface"));
        let odd = materials.meshes.get(&self.mesh).into_iter().flat_map(|mesh| odd::warnings(self, mesh));
        let strokes = strokes.map(|problem| problem.under("/strokes"));
        surface.into_iter().chain(fits).chain(strokes).chain(odd).collect()
    }

    fn moves(&self) -> bool {
        let (pose, redrawn) = (&self.pose, self.strokes.as_ref().is_some_and(|own| own.redraw > 0.0));
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
        let images = self.strokes.iter().flat_map(strokes::check::images);
        let images = images.map(|(at, image)| Use {
            at: format!("/strokes{at}"),
            of: Of::Name(List::Images, image),
            what: What::Picture,
        });
        std::iter::once(mesh).chain(surface).chain(images).collect()
    }

    fn automatic(&self, path: &str) -> Option<Value> {
        self.strokes.as_ref()?.automatic(path.strip_prefix("/strokes")?)
    }

    fn laid(&self, path: &str) -> Option<Vec<String>> {
        self.strokes.as_ref()?.laid(path.strip_prefix("/strokes")?)
    }

    fn pass_names(&self, pass: &Pass) -> Vec<&str> {
        let noises = self.strokes.iter().filter(|_| *pass == strokes::passes::NOISE).flat_map(|own| own.noises.keys());
        noises.map(String::as_str).collect()
    }

    fn has_pass(&self, pass: &Pass) -> bool {
        if surface::PASSES.contains(pass) { self.surface.slot().explains() } else { self.strokes.is_some() }
    }

    fn sketched(&self) -> &'static [&'static str] {
        if self.strokes.is_some() { strokes::sketch::OF } else { &[] }
    }

    fn sketch(&self, path: &str) -> Option<Sketch> {
        strokes::sketch::sketch(self.strokes.as_ref()?, path.strip_prefix("/strokes")?)
    }

    fn item_name(&self, path: &str) -> Option<&str> {
        self.surface.slot().item_name(path.strip_prefix("/surface")?)
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
        surface::lay(&self.surface, pictures)
    }

    fn model_to_world(&self, t: f64) -> Option<DAffine3> {
        let placed = self.pose.at(t);
        Some(DAffine3::from_mat3_translation(
            placed.turn * DMat3::from_diagonal(DVec3::splat(placed.scale)),
            placed.position,
        ))
    }

    fn is_in_model(&self, path: &str) -> bool {
        path.starts_with("/surface/")
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
