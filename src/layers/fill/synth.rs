//! A fill, ready for rendering at any time; it does not change over time.

use std::sync::Arc;

use kurbo::Vec2;

use super::model::{FillLayer, MOST_STOPS};
use crate::base::pixels::Rgba;
use crate::base::reduce::Reduced;
use crate::layers::parts::moment::Moment;
use crate::layers::parts::plan::{Bind, COMMON, Draw, Plan, Program};
use crate::layers::parts::twin::{Twin, twin};
use crate::layers::ready::{Ready, Still};

/// The shader.
pub static PROGRAM: Program =
    Program { name: "fill", source: &[COMMON, include_str!("frame.wgsl")], vertex: "whole_frame", fragment: "color" };

/// What a frame needs.
#[derive(Clone, Debug)]
pub struct Synth {
    /// Colors and their places along the line, ascending.
    pub stops: Vec<(f64, Rgba)>,
    /// Where the line begins, in pixels.
    pub from: Vec2,
    /// Its direction divided by its length.
    pub axis: Vec2,
    /// The place in each pixel that is evaluated.
    pub place: Vec2,
}

impl Synth {
    /// The layer, evaluated at this place in each pixel.
    pub fn new(layer: &FillLayer, place: Vec2) -> Self {
        let (from, axis) = layer.line();
        Synth { stops: layer.stops(), from, axis, place }
    }
}

/// `Stop` in frame.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Default, bytemuck::Pod, bytemuck::Zeroable)]
struct Stop {
    color: [f32; 4],
    along: f32,
    padding: [f32; 3],
}

/// `Fill` in frame.wgsl.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Fill {
    stops: [Stop; MOST_STOPS],
    origin: [f32; 2],
    axis: [f32; 2],
    place: [f32; 2],
    count: u32,
    padding: u32,
}

/// What shaders read.
pub const TWINS: &[Twin] = &[twin!(Stop: color, along), twin!(Fill: stops, origin, axis, place, count)];

impl Ready for Synth {
    fn at<'a>(&'a self, _moment: &'a Moment) -> Box<dyn Still + 'a> {
        Box::new(self)
    }

    fn plan(&self, _moment: &Moment) -> Plan {
        let pair = |v: Vec2| [v.x as f32, v.y as f32];
        let mut fill = Fill {
            stops: [Stop::default(); MOST_STOPS],
            origin: pair(self.from),
            axis: pair(self.axis),
            place: pair(self.place),
            count: self.stops.len() as u32,
            padding: 0,
        };
        for (stop, &(along, color)) in fill.stops.iter_mut().zip(&self.stops) {
            *stop = Stop { color, along: along as f32, padding: [0.0; 3] };
        }
        Plan::of([Draw::frame(&PROGRAM, vec![Bind::Bytes(bytemuck::bytes_of(&fill).to_vec())])])
    }

    fn unmoved(self: Arc<Self>) -> Arc<dyn Ready> {
        self
    }

    fn reduced(&self, pictures: &mut Reduced) -> Arc<dyn Ready> {
        let by = pictures.by as f64;
        Arc::new(Synth { from: self.from / by, axis: self.axis * by, ..self.clone() })
    }

    fn largest_texture(&self) -> usize {
        0
    }
}
