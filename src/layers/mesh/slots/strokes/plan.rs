//! What the GPU draws of strokes: what the layer shows, the kernels of each noise as splats that add up, the noises, the
//! distances to rims, and of all that the marks.

use std::collections::BTreeSet;

use bytemuck::{Pod, Zeroable, bytes_of, cast_slice};

use super::emit::{self, Places};
use super::even::{FAR, WIDE};
use super::marks::{Outline, Set};
use super::model::{Anchor, Noise as Wanted};
use super::noise::Scene;
use super::sum::{Trim, variance};
use super::synth::Ready;
use super::upload::{Layers, Mark, Noise, Rim, Sheet, Style};
use crate::layers::mesh::drawing::Given;
use crate::layers::parts::plan::{Bind, Blend, COMMON, Canvas, Draw, Format, Plan, Program, Scratch, Step};

/// The numbers of the textures. What the layer shows: its shaded colors, and `Facts` in frame.wgsl.
const SHADED: usize = 0;
const FACTS: usize = 1;
/// Its depths.
const OWN: usize = 2;
/// Sums of kernels, and others.
const SUMS: usize = 3;
/// Noises, then distances to rims.
const VALUES: usize = 4;
/// Sums of sums, and rims.
const PAIRS: usize = 5;

/// What impulses are made of.
const PLACES: Places = Places { pieces: 6, blocks: 7, made: 8, tally: 9 };

const SPLAT_SOURCE: &[&str] = &[include_str!("sheet.wgsl"), include_str!("kernel.wgsl"), include_str!("splats.wgsl")];
const FLAT_SOURCE: &[&str] = &[include_str!("sheet.wgsl"), include_str!("kernel.wgsl"), include_str!("flats.wgsl")];
const NOISE_SOURCE: &[&str] =
    &[COMMON, include_str!("sheet.wgsl"), include_str!("kernel.wgsl"), include_str!("noises.wgsl")];
const RIM_SOURCE: &[&str] = &[COMMON, include_str!("sheet.wgsl"), include_str!("rims.wgsl")];
const INK_SOURCE: &[&str] = &[COMMON, include_str!("sheet.wgsl"), include_str!("ink.wgsl")];

/// Kernels on the screen.
static SPLATS: Program =
    Program { name: "mesh/strokes/splats.wgsl", source: SPLAT_SOURCE, vertex: "corner", fragment: "kernel" };
/// Kernels on the surface.
static FLATS: Program =
    Program { name: "mesh/strokes/flats.wgsl", source: FLAT_SOURCE, vertex: "corner", fragment: "kernel" };
static PLAIN: Program = noises("plain");
static ALONG_ROWS: Program = noises("along_rows");
static EVEN: Program = noises("even");
static RIMS: Program = rims("rims");
static IN_COLUMN: Program = rims("in_column");
static NEAREST: Program = rims("nearest");
/// The drawing.
static INK: Program =
    Program { name: "mesh/strokes/ink.wgsl", source: INK_SOURCE, vertex: "whole_frame", fragment: "drawn" };

/// One of each shader.
pub static PROGRAMS: &[&Program] = &[&SPLATS, &FLATS, &PLAIN, &RIMS, &INK];

const fn noises(fragment: &'static str) -> Program {
    Program { name: "mesh/strokes/noises.wgsl", source: NOISE_SOURCE, vertex: "whole_frame", fragment }
}

const fn rims(fragment: &'static str) -> Program {
    Program { name: "mesh/strokes/rims.wgsl", source: RIM_SOURCE, vertex: "whole_frame", fragment }
}

/// Where what the layer shows is drawn.
pub fn shown() -> Canvas {
    Canvas { textures: vec![(SHADED, 0), (FACTS, 0)], depths: Some(OWN), clear: true }
}

/// The strokes of a layer, once what it shows is drawn: with textures for both. What pixels show need not be given. `posed` is
/// what binds the mesh.
pub fn plan(ready: &Ready, given: &Given, ambient: f64, posed: &dyn Fn() -> Vec<Bind>) -> Plan {
    let scene = Scene::new(ready, given);
    let strokes = &ready.strokes;
    let sets: Vec<Set> = strokes.marks.iter().filter_map(Set::of).collect();
    let named: BTreeSet<&str> = sets.iter().flat_map(Set::noises).map(|(_, name)| name).collect();
    let noises: Vec<(&str, &Wanted)> =
        named.into_iter().filter_map(|name| Some((name, strokes.noises.get(name)?))).collect();
    let place = |name: &str| noises.iter().position(|(known, _)| *known == name);
    let drawing = Drawing { scene: &scene, sheet: Sheet::of(&scene), posed };
    let mut steps = Vec::new();
    for (layer, (_, noise)) in noises.iter().enumerate() {
        steps.extend(drawing.noise(noise, layer as u32));
    }
    let (mut layers, mut marks) = (noises.len(), Vec::new());
    for set in &sets {
        marks.extend(Mark::of(&scene, set, &Layers { of: &place, rims: layers }));
        if let Set::Outline(outline) = set {
            steps.extend(drawing.distances(outline, layers as u32).map(Step::Draw));
            layers += 1;
        }
    }
    let list = list(&marks);
    let style = Style::of(&scene, ambient, marks.len());
    let read = [Bind::Bytes(bytes_of(&style).to_vec()), list, Bind::Scratch(SHADED), Bind::Scratch(VALUES)];
    steps.push(Step::Draw(Draw::frame(&INK, drawing.binds(read))));
    let mut scratch = vec![
        Scratch::Texels(Format::Rgba32Float),
        Scratch::Texels(Format::Rgba32Uint),
        Scratch::Depths,
        Scratch::Texels(Format::Rg32Float),
        Scratch::Layers(Format::R32Float, layers as u32),
        Scratch::Texels(Format::Rg32Float),
    ];
    scratch.extend(emit::scratch(&scene, noises.iter().map(|(_, noise)| *noise)));
    Plan { scratch, steps }
}

/// An array. A buffer cannot be empty: an empty array gets one item that is never read.
fn list<T: Pod + Zeroable>(all: &[T]) -> Bind {
    Bind::List(if all.is_empty() { bytes_of(&T::zeroed()).to_vec() } else { cast_slice(all).to_vec() })
}

/// The strokes of a layer in one frame.
struct Drawing<'a> {
    scene: &'a Scene<'a>,
    sheet: Sheet,
    posed: &'a dyn Fn() -> Vec<Bind>,
}

impl Drawing<'_> {
    /// What a program reads besides what all of them do.
    fn binds<const N: usize>(&self, own: [Bind; N]) -> Vec<Bind> {
        let sheet = Bind::Bytes(bytes_of(&self.sheet).to_vec());
        [sheet, Bind::Scratch(FACTS), Bind::Scratch(OWN), Bind::Depth].into_iter().chain(own).collect()
    }

    /// A draw into one of the textures.
    fn draw<const N: usize>(&self, program: &'static Program, own: [Bind; N], (texture, layer): (usize, u32)) -> Draw {
        Draw { into: Canvas::one(texture, layer), ..Draw::frame(program, self.binds(own)) }
    }

    /// Draws a noise into a layer of the values.
    fn noise(&self, wanted: &Wanted, layer: u32) -> Vec<Step> {
        let uniform = self.uniform(wanted);
        let uniform = || Bind::Bytes(bytes_of(&uniform).to_vec());
        let (sums, rows) = (|| Bind::Scratch(SUMS), || Bind::Scratch(PAIRS));
        let mut draws = vec![self.kernels(wanted, uniform())];
        if wanted.even {
            draws.push(self.draw(&ALONG_ROWS, [uniform(), sums()], (PAIRS, 0)));
            draws.push(self.draw(&EVEN, [uniform(), sums(), rows()], (VALUES, layer)));
        } else {
            draws.push(self.draw(&PLAIN, [uniform(), sums()], (VALUES, layer)));
        }
        let impulses = emit::steps(self.scene, wanted, self.posed, &PLACES);
        impulses.into_iter().map(Step::Compute).chain(draws.into_iter().map(Step::Draw)).collect()
    }

    fn uniform(&self, wanted: &Wanted) -> Noise {
        let recipe = self.scene.recipe(wanted);
        let deviation = WIDE * recipe.spacing_px;
        Noise {
            reach: wanted.reach as f32,
            variance: variance(wanted.overlap),
            radius: recipe.radius_px as f32,
            spacing: recipe.spacing_px as f32,
            px_per_m: self.scene.px_per_m() as f32,
            deviation: deviation as f32,
            wide: (FAR * deviation).ceil() as i32,
            padding: 0.0,
        }
    }

    /// The kernels of a noise, which add up.
    fn kernels(&self, wanted: &Wanted, uniform: Bind) -> Draw {
        let anchor = self.scene.anchor(wanted);
        let covers = match self.scene.trim(wanted) {
            Trim::Depth(_) => 0.0,
            Trim::Object if anchor == Anchor::Screen => 1.0,
            Trim::Triangle => 2.0,
            Trim::Object => 3.0,
        };
        let (program, constants) = match anchor {
            Anchor::Texture => (&FLATS, Vec::new()),
            Anchor::Surface | Anchor::Screen => (&SPLATS, vec![("covers", covers)]),
        };
        let draw = self.draw(program, [uniform, Bind::Scratch(PLACES.made)], (SUMS, 0));
        Draw { constants, blend: Blend::Add, found: Some(PLACES.tally), ..draw }
    }

    /// Draws the distances to the rims that an outline follows into a layer of the values.
    fn distances(&self, outline: &Outline, layer: u32) -> [Draw; 3] {
        let rim = Rim::of(self.scene, outline);
        let uniform = || Bind::Bytes(bytes_of(&rim).to_vec());
        [
            self.draw(&RIMS, [uniform()], (PAIRS, 0)),
            self.draw(&IN_COLUMN, [uniform(), Bind::Scratch(PAIRS)], (SUMS, 0)),
            self.draw(&NEAREST, [uniform(), Bind::Scratch(SUMS)], (VALUES, layer)),
        ]
    }
}
