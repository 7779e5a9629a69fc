//! Folding textures (Thorben 2012; Ren, TU Delft 2023): every pixel of a zone owns a sampler that moves along a jump
//! path through the picture as time passes; thresholds along the path let one part slide over another.

mod along;
pub mod anchor;
pub mod anchors;
pub mod atlas;
pub mod breaks;
pub mod bundle;
pub mod changed;
pub mod check;
pub mod clock;
pub mod counts;
pub mod field;
pub mod fold;
pub mod frame;
pub mod inside;
pub mod interpolation;
pub mod kinds;
pub mod looks;
pub mod marks;
pub mod model;
pub mod muted;
pub mod neat;
pub mod needs;
pub mod outline;
pub mod pick;
pub mod pixel_marks;
pub mod plan;
pub mod position;
pub mod probe;
pub mod ragged;
mod ready;
pub mod reduce;
pub mod regions;
pub mod reread;
pub mod seam;
pub mod shared;
pub mod starts;
pub mod streamlines;
pub mod synth;
pub mod texels;
pub mod thresholds;
mod tiles;
pub mod tools;
pub mod transform;

#[cfg(test)]
mod tests;

use std::any::Any;
use std::collections::BTreeMap;
use std::sync::Arc;

use kurbo::{Point, Rect};
use serde_json::Value;

use self::model::{PictureLayer, Zone};
use super::parts::marks::{Hit, Mark, View};
use super::parts::materials::{List, Materials, Use};
use super::parts::moment::{Moment, Space};
use super::parts::moving::Mover;
use super::parts::readout::{Curve, ReadOut};
use super::parts::repeat::Repeat;
use super::ready::{Making, Prepared, Ready};
use super::shapes::node::Node;
use super::shapes::shape::Shape;
use super::starts::{Starts, Template};
use super::technique::{Bundle, Checked, Count, Counted, Kind, Lead, Technique, Turned};
use super::timeline::{Timeline, Wrap};
use crate::base::change::Change;
use crate::base::pointer::Pointer;
use crate::base::problem::Problem;

/// The technique.
pub static KIND: Kind = Kind {
    name: "picture",
    space: Space::Plane,
    programs: &[plan::PROGRAMS],
    routines: &[],
    twins: &[plan::TWINS],
    bundle: Some(Bundle { names: bundle::names, write: bundle::write }),
    counted: &[
        Counted { name: "anchors", help: "anchors of a scene", most: 1_000_000 },
        Counted { name: "points", help: "points of a scene's outlines", most: 1_000_000 },
    ],
    overlays: &[looks::OVERLAYS],
    passes: &[],
    looks: &[looks::LOOKS],
    template: Some(Template { of: List::Images, layer: starts::template, ground: None }),
    blank: None,
    starts: Starts {
        start: starts::start,
        beyond: starts::beyond,
        ascending: starts::ascending,
        item: starts::item,
        closed: starts::closed,
    },
    presets: &[],
    styles: None,
    comparisons: &[],
    example: include_str!("example.json"),
};

impl Technique for PictureLayer {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn name(&self) -> &str {
        &self.name
    }

    fn check(&self, before: Option<(&dyn Technique, &Checked)>) -> Checked {
        let before = before.and_then(|(before, checked)| Some(((before as &dyn Any).downcast_ref()?, checked)));
        check::check(self, before)
    }

    fn problems(&self, checked: &Checked) -> Vec<Problem> {
        check::problems(checked)
    }

    fn counts(&self, each: &mut dyn FnMut(Count)) {
        needs::counts(self, each);
    }

    fn memory(&self) -> Vec<(String, u64)> {
        needs::memory(self)
    }

    fn moves(&self) -> bool {
        self.zones.iter().any(Zone::moves)
    }

    fn check_materials(&self, materials: &Materials) -> Vec<Problem> {
        check::check_materials(self, materials)
    }

    fn covers(&self, size_px: (usize, usize), materials: &Materials) -> bool {
        needs::covers(self, size_px, materials)
    }

    fn uses(&self) -> Vec<Use<'_>> {
        needs::uses(self)
    }

    fn frame_of(&self) -> Option<&str> {
        Some(&self.image)
    }

    fn turned(&self, path: &str, old: &Value, to: &str) -> Option<Turned> {
        kinds::turned(self, path, old, to)
    }

    fn mover(&self) -> Option<Mover> {
        Some(transform::moved)
    }

    fn resolve(&mut self, shapes: &BTreeMap<String, Shape>) {
        shared::resolve(self, shapes);
    }

    fn along(&self, path: &str, shape: (&str, &[Node]), lead: Lead) -> Option<(String, Value)> {
        along::along(self, path, shape, lead)
    }

    fn can_mute(&self, path: &str) -> bool {
        muted::can_be(path)
    }

    fn without(&self, paths: &[&str]) -> PictureLayer {
        muted::layer(self, paths)
    }

    fn reread(&self, json: &Value, change: &Change) -> Option<PictureLayer> {
        reread::layer(self, json, change)
    }

    fn bounds(&self, path: &str) -> Rect {
        starts::bounds(self, path)
    }

    fn item_name(&self, path: &str) -> Option<&str> {
        self.zones.get(Pointer(path).item("/zones")?).map(|zone| zone.name.as_str())
    }

    fn curves(&self, wrap: Wrap) -> Vec<Curve<'_>> {
        let zones = self.zones.iter().enumerate();
        let curve = zones.map(|(i, zone)| {
            let clock = zone.clock(wrap);
            Curve { path: format!("/zones/{i}"), name: &zone.name, symbol: "s", value: Box::new(move |t| clock.s(t)) }
        });
        curve.collect()
    }

    fn probe(
        &self,
        making: &Making,
        _ready: Option<&dyn Ready>,
        pixel: (usize, usize),
        moment: &Moment,
    ) -> Result<Option<ReadOut>, Problem> {
        Ok(Some(probe::read_out(probe::probe(self, making, pixel, moment.t)?)))
    }

    fn marks(&self, view: &View) -> Vec<Mark> {
        marks::marks(self, view)
    }

    fn pick(&self, at: Point, reach_px: f64) -> Option<Hit> {
        pick::pick(self, at, reach_px)
    }

    fn repeat(&self, timeline: &Timeline, materials: &Materials) -> Repeat {
        seam::repeat(self, timeline, materials)
    }

    fn synth(&self, making: &Making, previous: Option<&dyn Ready>) -> Result<Arc<dyn Ready>, Problem> {
        let previous = previous.and_then(|previous| previous.downcast());
        Ok(Arc::new(synth::synth(self, making, previous)?))
    }

    fn prepare(&self, making: &Making, _previous: Option<&dyn Ready>) -> Result<Box<dyn Prepared>, Problem> {
        Ok(Box::new(synth::PreparedLayer::new(self, making)?))
    }
}
