//! A synthesised layer as the rest of the program sees it: frames on the CPU and the GPU, a smaller layer, a still
//! layer.

use std::sync::Arc;

use super::frame::Frame;
use super::pixel_marks;
use super::plan;
use super::reduce;
use super::synth::Synth;
use crate::base::reduce::Reduced;
use crate::layers::parts::marks::{Mark, View};
use crate::layers::parts::moment::Moment;
use crate::layers::parts::plan::Plan;
use crate::layers::parts::readout::{Flag, VectorField};
use crate::layers::ready::{Ready, Still};

impl Ready for Synth {
    fn at<'a>(&'a self, moment: &'a Moment) -> Box<dyn Still + 'a> {
        Box::new(Frame::new(self, moment.t))
    }

    fn fields(&self) -> Vec<VectorField<'_>> {
        let zones = self.zones.iter().map(|zone| VectorField {
            path: format!("/zones/{}", zone.index),
            name: &zone.name,
            corner: (zone.field.x0, zone.field.y0),
            inside: &zone.field.inside,
            vectors: &zone.field.jumps,
            flag: zone.field.folds.as_ref().map(|folds| -> Flag<'_> { ("folds", Box::new(|i| folds.meets(i))) }),
        });
        zones.collect()
    }

    fn plan(&self, moment: &Moment) -> Plan {
        plan::plan(self, moment.t)
    }

    fn unmoved(self: Arc<Self>) -> Arc<dyn Ready> {
        Arc::new(Synth { picture: self.picture.clone(), zones: Vec::new() })
    }

    fn reduced(&self, pictures: &mut Reduced) -> Arc<dyn Ready> {
        Arc::new(reduce::layer(self, pictures))
    }

    fn largest_texture(&self) -> usize {
        let read = self.zones.iter().map(|zone| &zone.source.picture).chain([&self.picture]);
        read.map(|picture| picture.width().max(picture.height())).max().unwrap_or(1)
    }

    fn marks(&self, view: &View, _moment: &Moment) -> Vec<Mark> {
        pixel_marks::marks(self, view)
    }

    fn keep_clear_color(&self, (x, y): (usize, usize), code: &mut [u8; 4]) {
        let within = x < self.picture.width() && y < self.picture.height();
        self.picture.keep_clear_color(within.then_some((x, y)), code);
    }
}
