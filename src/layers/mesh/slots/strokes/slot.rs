//! Strokes as what is drawn on a mesh.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use serde_json::Value;

use super::force::Strokes;
use super::synth::Ready;
use super::{check, draw, emit, explain, measure, overlays, passes, plan, restyle, sketch, upload};
use crate::base::mesh::Mesh;
use crate::base::pixels::Rgba;
use crate::base::problem::Problem;
use crate::layers::mesh::added::Added;
use crate::layers::mesh::drawing::{Before, DrawingSlot, Given, Looking, ReadyDrawing};
use crate::layers::parts::marks::{Mark, View};
use crate::layers::parts::materials::{List, Of, Use, What};
use crate::layers::parts::measures::Measures;
use crate::layers::parts::pass::{Pass, Which};
use crate::layers::parts::plan::{Bind, Canvas, Plan};
use crate::layers::parts::readout::Entry;
use crate::layers::parts::sketch::Sketch;
use crate::layers::ready::Making;
use crate::layers::starts::Starts;

/// What is known of them without a layer.
pub const ADDED: Added = Added {
    programs: plan::PROGRAMS,
    routines: emit::ROUTINES,
    twins: upload::TWINS,
    overlays: overlays::OVERLAYS,
    looks: overlays::LOOKS,
    passes: passes::PASSES,
    // A new mark needs no noise.
    starts: Starts { beyond: |_, list| (list == "marks").then(|| ("kind", "outline".into())), ..Starts::PLAIN },
    styles: Some(&restyle::STYLES),
    comparisons: restyle::COMPARISONS,
    ..Added::NONE
};

impl DrawingSlot for Strokes {
    fn check(&self) -> Vec<Problem> {
        check::problems(self)
    }

    fn check_uv(&self, mesh: &str, triangle: usize) -> Option<Problem> {
        check::without_uv(self, mesh, triangle)
    }

    fn uses(&self) -> Vec<Use<'_>> {
        let images = check::images(self).into_iter();
        images.map(|(at, image)| Use { at, of: Of::Name(List::Images, image), what: What::Picture }).collect()
    }

    fn moves(&self) -> bool {
        self.redraw > 0.0
    }

    fn automatic(&self, path: &str) -> Option<Value> {
        self.value(path)
    }

    fn laid(&self, path: &str) -> Option<Vec<String>> {
        self.of_style(path)
    }

    fn pass_names(&self, pass: &Pass) -> Vec<&str> {
        if *pass == passes::NOISE { self.noises.keys().map(String::as_str).collect() } else { Vec::new() }
    }

    fn sketched(&self) -> &'static [&'static str] {
        sketch::OF
    }

    fn sketch(&self, path: &str) -> Option<Sketch> {
        sketch::sketch(self, path)
    }

    fn synth(&self, mesh: &Mesh, making: &Making, before: Before) -> Result<Arc<dyn ReadyDrawing>, Problem> {
        Ok(Arc::new(Ready::new(self, mesh, making, before.and_then(|before| before.downcast()))?))
    }
}

impl ReadyDrawing for Ready {
    fn needs_normals(&self) -> bool {
        self.has_creases()
    }

    fn needs_light(&self) -> bool {
        self.is_of_light()
    }

    fn draw(&self, given: &Given, which: Which, out: &mut [Rgba]) {
        draw::pass(self, given, which, out);
    }

    fn canvas(&self) -> Canvas {
        plan::shown()
    }

    fn plan(&self, given: &Given, ambient: f64, posed: &dyn Fn() -> Vec<Bind>) -> Plan {
        plan::plan(self, given, ambient, posed)
    }

    fn stoppable(&self, stop: &Arc<AtomicBool>) -> Arc<dyn ReadyDrawing> {
        Arc::new(Ready { stop: Some(stop.clone()), ..self.clone() })
    }

    fn reduced(&self, by: usize) -> Arc<dyn ReadyDrawing> {
        Arc::new(Ready { scale: self.scale / by as f64, ..self.clone() })
    }

    fn told(&self, given: &Given, i: usize) -> Vec<Entry> {
        explain::entries(self, given, i)
    }

    fn explains(&self, view: &View) -> bool {
        overlays::is_shown(view)
    }

    fn marks(&self, given: &Given, view: &View) -> Vec<Mark> {
        overlays::marks(self, given, view)
    }

    fn measure(&self, looking: Looking) -> Result<Option<Measures>, Problem> {
        measure::measure(self, looking)
    }
}
