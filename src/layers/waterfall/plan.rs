//! What the GPU draws for a waterfall layer: its picture from the CPU. Both ways of blending are associative, so that all
//! sprites can be blended with one another first.

use std::sync::Arc;

use super::frame::Seen;
use super::model::Mixing;
use super::synth::Synth;
use crate::base::picture::Picture;
use crate::layers::parts::moment::{Columns, Moment};
use crate::layers::parts::plan::{Bind, Blend, COMMON, Draw, Plan, Program};
use crate::layers::ready::Still;

/// The shader.
pub static PROGRAM: Program = Program {
    name: "waterfall",
    source: &[COMMON, include_str!("frame.wgsl")],
    vertex: "whole_frame",
    fragment: "lay",
};

/// The layer at one time, before surfaces at these depths.
pub fn plan(synth: &Synth, moment: &Moment, depth: &[f64]) -> Plan {
    let (width, height) = moment.size_px;
    let mut out = vec![[0.0; 4]; width * height];
    Seen::new(synth, moment).sprites(&(0..height).collect::<Vec<_>>(), Columns::All, depth, &mut out);
    let picture = Arc::new(Picture::from_cells(width, height, out));
    let blend = match synth.blend {
        Mixing::Screen => Blend::Screen,
        Mixing::Over => Blend::Over,
    };
    Plan {
        draws: vec![Draw {
            program: &PROGRAM,
            constants: Vec::new(),
            binds: vec![Bind::Upload(picture, 0)],
            blend,
            vertices: 3,
            instances: 1,
            depth: false,
            scissor_px: None,
        }],
    }
}
