//! What the GPU draws for a mesh layer: all triangles, the nearest in front; and strokes on them.

use glam::DVec3;

use super::drawing::{Given, ReadyDrawing};
use super::model::Sides;
use super::pose::Placed;
use super::surface::{Look, Own};
use super::synth::Synth;
use crate::base::pixels::Rgba;
use crate::layers::parts::moment::Moment;
use crate::layers::parts::plan::{Bind, COMMON, Draw, Plan, Program, Step};
use crate::layers::parts::twin::{Twin, twin};
use crate::layers::space::eye::{Eye, NEAR_M};
use crate::layers::space::upload::{TRIANGLES, VERTICES, matrix};

const SOURCE: &[&str] = &[COMMON, include_str!("posed.wgsl"), include_str!("frame.wgsl")];

/// The mesh in one color.
pub static PLAIN: Program = Program { name: "mesh/frame.wgsl", source: SOURCE, vertex: "corner", fragment: "plain" };
/// The mesh with a picture.
pub static PICTURED: Program =
    Program { name: "mesh/frame.wgsl", source: SOURCE, vertex: "corner", fragment: "pictured" };
/// The same with what strokes are drawn from.
static PLAIN_FACTS: Program =
    Program { name: "mesh/frame.wgsl", source: SOURCE, vertex: "facet", fragment: "plain_facts" };
static PICTURED_FACTS: Program =
    Program { name: "mesh/frame.wgsl", source: SOURCE, vertex: "facet", fragment: "pictured_facts" };

/// `Mesh` in frame.wgsl.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Uniform {
    eye_from_model: [f32; 16],
    world_from_normal: [f32; 16],
    along: [f32; 3],
    start: f32,
    light: [f32; 3],
    ambient: f32,
    color: [f32; 4],
    focal: [f32; 2],
    shift: [f32; 2],
    bend: f32,
    length: f32,
    near: f32,
    both: f32,
}

/// What shaders read.
pub const TWINS: &[Twin] =
    &[twin!(Uniform as "Mesh": eye_from_model, world_from_normal, along, start, light, ambient, color,
    focal, shift, bend, length, near, both)];

/// The layer at one time; nothing without a camera.
pub fn plan(synth: &Synth, moment: &Moment) -> Plan {
    let Some(eye) = moment.eye else { return Plan::default() };
    let placed = synth.pose.at(synth.time(moment));
    let own = |program, facts, binds| Own { program, facts, constants: Vec::new(), binds };
    let (color, look) = match synth.surface.plan(moment, &placed) {
        Look::Color(color) => (color, own(&PLAIN, &PLAIN_FACTS, Vec::new())),
        Look::Picture(picture) => ([0.0; 4], own(&PICTURED, &PICTURED_FACTS, vec![picture])),
        Look::Own(own) => ([0.0; 4], own),
    };
    let uniform = uniform(synth, moment, (&eye, &placed), color);
    let posed = || {
        let parts = [VERTICES, TRIANGLES].map(|part| Bind::Upload(synth.mesh.clone(), part));
        [Bind::Bytes(bytemuck::bytes_of(&uniform).to_vec())].into_iter().chain(parts).collect()
    };
    let draw = |program, read: Vec<Bind>| {
        let mut binds: Vec<Bind> = posed();
        binds.extend(read);
        let vertices = 3 * synth.mesh.triangles.len() as u32;
        Draw { vertices, depth: true, ..Draw::frame(program, binds) }
    };
    let Some(strokes) = synth.strokes.as_deref() else {
        return Plan::of([Draw { constants: look.constants, ..draw(look.program, look.binds) }]);
    };
    // Strokes hide all of its color: only its depths count.
    let surface = draw(&PLAIN, Vec::new());
    let into = Some(strokes.canvas());
    let facts = Draw { into, constants: look.constants, ..draw(look.facts, look.binds) };
    let mut plan = on_it(synth, moment, (eye, &placed), (strokes, &posed));
    plan.steps.splice(..0, [surface, facts].map(Step::Draw));
    plan
}

/// The strokes on it.
fn on_it(
    synth: &Synth,
    moment: &Moment,
    (eye, placed): (Eye, &Placed),
    (strokes, posed): (&dyn ReadyDrawing, &dyn Fn() -> Vec<Bind>),
) -> Plan {
    let given = Given {
        mesh: &synth.mesh,
        world: &[],
        placed,
        both: synth.sides == Sides::Both,
        toward: synth.light.toward(),
        eye,
        size_px: moment.size_px,
        magnified: f64::from(moment.magnified),
        t: synth.time(moment),
        inverse: Vec::new(),
        triangle: Vec::new(),
        normal: Vec::new(),
        shaded: Vec::new(),
        light: Vec::new(),
    };
    strokes.plan(&given, synth.light.ambient, posed)
}

fn uniform(synth: &Synth, moment: &Moment, (eye, placed): (&Eye, &Placed), color: Rgba) -> Uniform {
    let (width, height) = (moment.size_px.0 as f64, moment.size_px.1 as f64);
    let focal = [2.0 * eye.focal_px / width, 2.0 * eye.focal_px / height];
    // A pixel is drawn at its center; what is to be seen there is moved there.
    let place = synth.place(moment);
    let shift = [(1.0 - 2.0 * place.x) / width, (2.0 * place.y - 1.0) / height];
    Uniform {
        eye_from_model: eye_from_model(eye, placed),
        world_from_normal: matrix(placed.turn, DVec3::ZERO),
        along: placed.along.as_vec3().to_array(),
        start: placed.from as f32,
        light: synth.light.toward().as_vec3().to_array(),
        ambient: synth.light.ambient as f32,
        color,
        focal: focal.map(|v| v as f32),
        shift: shift.map(|v| v as f32),
        bend: placed.bend_radians as f32,
        length: placed.length as f32,
        near: NEAR_M as f32,
        both: if synth.sides == Sides::Both { 1.0 } else { 0.0 },
    }
}

fn eye_from_model(eye: &Eye, placed: &Placed) -> [f32; 16] {
    matrix(eye.turn * placed.turn * placed.scale, eye.turn * (placed.position - eye.position))
}
