//! What the GPU draws for a picture layer: its picture, then its zones in order, each in its box.

use super::synth::{Synth, ZoneSynth};
use crate::base::pixels::Beyond;
use crate::layers::parts::plan::{Bind, Blend, COMMON, Draw, Plan, Program};
use crate::layers::parts::twin::{Twin, twin};

/// Draws the layer's own picture.
static STILL: Program = Program {
    name: "still.wgsl",
    source: &[COMMON, include_str!("still.wgsl")],
    vertex: "whole_frame",
    fragment: "still",
};

/// Draws a zone.
static ZONE: Program = Program {
    name: "frame.wgsl",
    source: &[COMMON, include_str!("frame.wgsl")],
    vertex: "whole_frame",
    fragment: "shown",
};

/// Every program of the technique.
pub static PROGRAMS: &[&Program] = &[&STILL, &ZONE];

/// The uniform `Zone` of frame.wgsl.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct ZoneUniform {
    offset: [f32; 2],
    origin: [i32; 2],
    s: f32,
    padding: f32,
}

/// What shaders read.
pub const TWINS: &[Twin] = &[twin!(ZoneUniform as "Zone": offset, origin, s)];

/// The plan for the layer at scene time `t`.
pub fn plan(synth: &Synth, t: f64) -> Plan {
    let still = Draw::frame(&STILL, vec![Bind::Upload(synth.picture.clone(), 0)]);
    Plan::of(std::iter::once(still).chain(synth.zones.iter().map(|one| zone(one, t))))
}

fn zone(zone: &ZoneSynth, t: f64) -> Draw {
    let (field, source) = (&zone.field, &zone.source);
    let uniform = ZoneUniform {
        offset: [source.offset.x as f32, source.offset.y as f32],
        origin: [field.x0 as i32, field.y0 as i32],
        s: zone.clock.s(t) as f32,
        padding: 0.0,
    };
    let clamps = match source.beyond {
        Beyond::Clamp => 1.0,
        Beyond::Transparent => 0.0,
    };
    let size = [field.x0, field.y0, field.inside.width(), field.inside.height()];
    let binds = vec![
        Bind::Bytes(bytemuck::bytes_of(&uniform).to_vec()),
        Bind::Upload(field.clone(), 0),
        Bind::Upload(field.clone(), 1),
        Bind::Upload(source.picture_at(t).clone(), 0),
    ];
    Draw {
        constants: vec![
            ("rule", f64::from(field.folds.as_ref().map_or(0, |folds| folds.rule.number()))),
            ("clamps", clamps),
        ],
        blend: if source.over { Blend::Over } else { Blend::Replace },
        scissor_px: Some(size.map(|n| n as u32)),
        ..Draw::frame(&ZONE, binds)
    }
}
