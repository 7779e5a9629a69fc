//! Strokes in the memory layout of the shaders: the same names as there.

use std::f64::consts::{PI, TAU};

use super::emit;
use super::ink::{Paint, linear};
use super::marks::{Ink, Outline, Pigment, Relief, Set};
use super::model::{Force, Ground, Side, ToneOf};
use super::noise::Scene;
use crate::base::maths::{cos, sin};
use crate::layers::parts::twin::{Twin, twin};
use crate::layers::space::eye::NEAR_M;

/// `Sheet` in sheet.wgsl.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Sheet {
    size: [f32; 2],
    middle: [f32; 2],
    focal: f32,
    near: f32,
    padding: [f32; 2],
}

/// `Noise` in kernel.wgsl.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Noise {
    /// How far a kernel reaches beyond its plane, in radii.
    pub reach: f32,
    /// The variance of its sum.
    pub variance: f32,
    /// The radius of its kernels, in pixels.
    pub radius: f32,
    /// Its spacing, in pixels.
    pub spacing: f32,
    /// Pixels of a meter, for a texture.
    pub px_per_m: f32,
    /// The standard deviation of what is evened out at a time, in pixels.
    pub deviation: f32,
    /// How far that reaches.
    pub wide: i32,
    /// Nothing.
    pub padding: f32,
}

/// `Rim` in rims.wgsl.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Rim {
    step: f32,
    crease: f32,
    reach: i32,
    padding: f32,
}

/// `Style` in ink.wgsl.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Style {
    paper: [f32; 3],
    fade: f32,
    toward: [f32; 3],
    ambient: f32,
    dark: f32,
    light: f32,
    gamma: f32,
    ground: u32,
    count: u32,
    by_light: u32,
    padding: [f32; 2],
}

/// `Mark` in ink.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Mark {
    color: [f32; 3],
    scene: f32,
    kind: u32,
    noise: i32,
    grain: i32,
    rims: i32,
    start: f32,
    full: f32,
    amount: f32,
    soft: f32,
    opacity: f32,
    rim: f32,
    grained: f32,
    side: f32,
    strength: f32,
    even: f32,
    half_width: f32,
    vary: f32,
    toward: [f32; 2],
    padding: [f32; 2],
}

/// What shaders read.
pub const TWINS: &[Twin] = &[
    twin!(Sheet: size, middle, focal, near),
    twin!(Noise: reach, variance, radius, spacing, px_per_m, deviation, wide),
    twin!(Rim: step, crease, reach),
    twin!(Style: paper, fade, toward, ambient, dark, light, gamma, ground, count, by_light),
    twin!(Mark: color, scene, kind, noise, grain, rims, start, full, amount, soft, opacity, rim, grained, side, strength,
        even, half_width, vary, toward),
    emit::TWIN,
];

impl Sheet {
    /// That of a frame.
    pub fn of(scene: &Scene) -> Sheet {
        let (eye, (width, height)) = (&scene.given.eye, scene.given.size_px);
        Sheet {
            size: [width as f32, height as f32],
            middle: eye.middle_px.as_vec2().to_array(),
            focal: eye.focal_px as f32,
            near: NEAR_M as f32,
            padding: [0.0; 2],
        }
    }
}

/// Outlines vary as a noise does, which is hardly ever farther from 0 than this.
const FARTHEST: f64 = 5.0;

impl Rim {
    /// That of outlines in a frame.
    pub fn of(scene: &Scene, outline: &Outline) -> Rim {
        let crease = outline.creases.map_or(-2.0, |degrees| cos(degrees.to_radians()));
        let vary = if outline.noise.is_some() { outline.vary * FARTHEST } else { 0.0 };
        let half = outline.width * scene.ready.strokes.size / 2.0 * (1.0 + vary);
        let reach = ((half + outline.softness / 2.0) * scene.scale).ceil() + 1.0;
        let most = scene.given.size_px.0.max(scene.given.size_px.1);
        let reach = reach.min(most as f64) as i32;
        Rim { step: (outline.step * scene.scale) as f32, crease: crease as f32, reach, padding: 0.0 }
    }
}

impl Style {
    /// That of a layer in its light, with so many marks.
    pub fn of(scene: &Scene, ambient: f64, count: usize) -> Style {
        let strokes: &Force = &scene.ready.strokes;
        Style {
            paper: linear(&strokes.paper),
            fade: strokes.fade as f32,
            toward: scene.given.toward.as_vec3().to_array(),
            ambient: ambient as f32,
            dark: strokes.tone.dark as f32,
            light: strokes.tone.light as f32,
            gamma: strokes.tone.gamma as f32,
            ground: match strokes.ground {
                Ground::Paper => 0,
                Ground::Scene => 1,
                Ground::Clear => 2,
            },
            count: count as u32,
            by_light: u32::from(strokes.tone.of == ToneOf::Light),
            padding: [0.0; 2],
        }
    }
}

/// Where the values of a mark are.
pub struct Layers<'a> {
    /// That of a noise of this name.
    pub of: &'a dyn Fn(&str) -> Option<usize>,
    /// That of its distances to rims.
    pub rims: usize,
}

impl Mark {
    /// A mark of a layer; `None` if it is made of a noise that is not there.
    pub fn of(scene: &Scene, set: &Set, layers: &Layers) -> Option<Mark> {
        match set {
            Set::Ink(ink) => Mark::ink(scene, ink, layers),
            Set::Pigment(Pigment { noise, strength }) => {
                let noise = (layers.of)(noise)? as i32;
                Some(Mark { kind: 1, noise, strength: *strength as f32, ..Mark::default() })
            }
            Set::Relief(relief) => Mark::relief(scene, relief, layers),
            Set::Outline(outline) => Some(Mark::outline(scene, outline, layers)),
        }
    }

    fn ink(scene: &Scene, ink: &Ink, layers: &Layers) -> Option<Mark> {
        let strokes: &Force = &scene.ready.strokes;
        let noise = strokes.noises.get(&ink.noise)?;
        let grain = ink.grain.as_ref().and_then(|grain| Some(((layers.of)(&grain.noise)?, grain.amount)));
        Some(Mark {
            kind: 0,
            noise: (layers.of)(&ink.noise)? as i32,
            grain: grain.map_or(-1, |(layer, _)| layer as i32),
            start: ink.from as f32,
            full: ink.to as f32,
            amount: (ink.amount * strokes.amount) as f32,
            soft: (ink.softness * PI / (noise.spacing * strokes.size)) as f32,
            opacity: ink.opacity as f32,
            rim: ink.rim as f32,
            grained: grain.map_or(0.0, |(_, amount)| amount as f32),
            side: if ink.side == Side::High { -1.0 } else { 1.0 },
            even: f32::from(u8::from(noise.even)),
            ..Mark::painted(Paint::new(&ink.color, ink.shade, strokes))
        })
    }

    fn relief(scene: &Scene, relief: &Relief, layers: &Layers) -> Option<Mark> {
        let strokes: &Force = &scene.ready.strokes;
        let spacing = strokes.noises.get(&relief.noise)?.spacing;
        let angle = relief.angle.to_radians();
        Some(Mark {
            kind: 2,
            noise: (layers.of)(&relief.noise)? as i32,
            strength: (relief.strength * spacing * strokes.size * scene.scale / TAU) as f32,
            toward: [cos(angle) as f32, -sin(angle) as f32],
            ..Mark::default()
        })
    }

    fn outline(scene: &Scene, outline: &Outline, layers: &Layers) -> Mark {
        let strokes: &Force = &scene.ready.strokes;
        let noise = outline.noise.as_ref().and_then(|name| (layers.of)(name));
        Mark {
            kind: 3,
            noise: noise.map_or(-1, |layer| layer as i32),
            rims: layers.rims as i32,
            // A hard edge is the limit of a soft one.
            soft: (outline.softness * scene.scale).max(1e-9) as f32,
            opacity: outline.opacity as f32,
            half_width: (outline.width * strokes.size * scene.scale / 2.0) as f32,
            vary: outline.vary as f32,
            ..Mark::painted(Paint::new(&outline.color, outline.shade, strokes))
        }
    }

    fn painted(paint: Paint) -> Mark {
        let Paint { color, scene } = paint;
        Mark { color, scene, ..Mark::default() }
    }
}
