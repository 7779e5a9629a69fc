//! What the GPU draws for a waterfall: one draw of all sprites. Where they are is computed here, with double precision; the
//! pictures between keys are made on the device.

use super::draw::in_order;
use super::model::Mixing;
use super::splat::{Splat, splats};
use super::synth::Synth;
use super::upload::Atlas;
use crate::layers::parts::moment::Moment;
use crate::layers::parts::plan::{Bind, Blend, COMMON, Draw, Plan, Program};
use crate::layers::parts::twin::{Twin, twin};
use crate::layers::space::eye::NEAR_M;

/// The sprites of a waterfall.
pub static PROGRAM: Program = Program {
    name: "waterfall/sprites.wgsl",
    source: &[COMMON, include_str!("sprites.wgsl")],
    vertex: "corner",
    fragment: "shade",
};

/// `Frame` in sprites.wgsl.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Frame {
    size: [f32; 2],
    place: [f32; 2],
    soft: f32,
    near: f32,
    unused: [f32; 2],
}

/// `Sprite` in sprites.wgsl.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Sprite {
    middle: [f32; 2],
    size: [f32; 2],
    turn: [f32; 2],
    side: f32,
    mirrored: f32,
    tint: [f32; 3],
    opacity: f32,
    slopes: [f32; 4],
    keys: [[f32; 4]; 4],
    residue: [f32; 4],
    depth: [f32; 4],
}

/// What shaders read.
pub const TWINS: &[Twin] = &[
    twin!(Frame: size, place, soft, near),
    twin!(Sprite: middle, size, turn, side, mirrored, tint, opacity, slopes, keys, residue, depth),
];

/// The layer at one time; nothing without a camera, or without anything that is seen.
pub fn plan(synth: &Synth, moment: &Moment) -> Plan {
    let splats = splats(synth, moment);
    let atlas = Atlas { side: synth.pictures.side };
    let shown = in_order(synth.blend, &splats).into_iter();
    let sprites: Vec<Sprite> = shown.map(|splat| sprite(synth, &atlas, splat)).collect();
    if sprites.is_empty() {
        return Plan::default();
    }
    let frame = Frame {
        size: [moment.size_px.0 as f32, moment.size_px.1 as f32],
        place: [synth.place.x as f32, synth.place.y as f32],
        soft: synth.values.soft as f32,
        near: NEAR_M as f32,
        unused: [0.0; 2],
    };
    let binds = vec![
        Bind::Bytes(bytemuck::bytes_of(&frame).to_vec()),
        Bind::List(bytemuck::cast_slice(&sprites).to_vec()),
        Bind::Upload(synth.pictures.clone(), 0),
        Bind::Upload(synth.residues.clone(), 0),
        Bind::Linear,
        Bind::Depth,
    ];
    let blend = match synth.blend {
        Mixing::Screen => Blend::Screen,
        Mixing::Over => Blend::Over,
    };
    let draw = Draw { blend, vertices: 6, instances: sprites.len() as u32, ..Draw::frame(&PROGRAM, binds) };
    Plan::of([draw])
}

fn sprite(synth: &Synth, atlas: &Atlas, splat: &Splat) -> Sprite {
    let mix = &splat.mix;
    let place = |i: usize, weight: f32| {
        let [x, y] = atlas.first_texel(i, splat.level).map(|v| v as f32);
        [x, y, weight, 0.0]
    };
    let mut keys = [[0.0; 4]; 4];
    for (out, &(key, weight)) in keys.iter_mut().zip(mix.keys()) {
        *out = place(synth.pictures.number(key), weight);
    }
    // Central differences, in texels of the largest level.
    let each = (2 << splat.level) as f32;
    let [[a, b], [c, d]] = mix.slopes;
    Sprite {
        middle: splat.middle.as_vec2().to_array(),
        size: splat.size_px.as_vec2().to_array(),
        turn: splat.turn.as_vec2().to_array(),
        side: (synth.pictures.side >> splat.level) as f32,
        mirrored: f32::from(u8::from(splat.mirrored)),
        tint: splat.tint.truncate().to_array(),
        opacity: splat.opacity as f32,
        slopes: [a, b, c, d].map(|slope| slope / each),
        keys,
        residue: mix
            .residue
            .map_or([0.0; 4], |(track, interval, weight)| place(synth.residues.number(track, interval), weight)),
        depth: [splat.depth as f32, 0.0, 0.0, 0.0],
    }
}
