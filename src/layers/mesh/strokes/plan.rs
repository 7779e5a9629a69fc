//! What the GPU draws of strokes: what the layer shows, the kernels of each noise as splats that add up, the noises, the
//! distances to rims, and of all that the marks. Where impulses are is computed here, with double precision.

use std::collections::BTreeSet;

use bytemuck::{Pod, Zeroable, bytes_of, cast_slice};

use super::even::{FAR, WIDE};
use super::marks::{Outline, Set};
use super::model::{Anchor, Noise as Wanted};
use super::noise::Scene;
use super::sum::{Trim, variance};
use super::upload::{Flat, Layers, Mark, Noise, Rim, Sheet, Splat, Style};
use super::{Given, Ready};
use crate::layers::parts::plan::{Bind, Blend, COMMON, Canvas, Draw, Format, Program, Scratch};

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

/// At most so many impulses are drawn at once.
const MOST: usize = 1 << 20;

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
pub static PROGRAMS: [&Program; 5] = [&SPLATS, &FLATS, &PLAIN, &RIMS, &INK];

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

/// The strokes of a layer, once what it shows is drawn: with textures for both. What pixels show need not be given.
pub fn plan(ready: &Ready, given: &Given, ambient: f64) -> (Vec<Scratch>, Vec<Draw>) {
    let scene = Scene::new(ready, given);
    let strokes = &ready.strokes;
    let sets: Vec<Set> = strokes.marks.iter().filter_map(Set::of).collect();
    let named: BTreeSet<&str> = sets.iter().flat_map(Set::noises).map(|(_, name)| name).collect();
    let noises: Vec<(&str, &Wanted)> =
        named.into_iter().filter_map(|name| Some((name, strokes.noises.get(name)?))).collect();
    let place = |name: &str| noises.iter().position(|(known, _)| *known == name);
    let drawing = Drawing { scene: &scene, sheet: Sheet::of(&scene) };
    let mut draws = Vec::new();
    for (layer, (_, noise)) in noises.iter().enumerate() {
        draws.extend(drawing.noise(noise, layer as u32));
    }
    let (mut layers, mut marks) = (noises.len(), Vec::new());
    for set in &sets {
        marks.extend(Mark::of(&scene, set, &Layers { of: &place, rims: layers }));
        if let Set::Outline(outline) = set {
            draws.extend(drawing.distances(outline, layers as u32));
            layers += 1;
        }
    }
    let list = list(&marks);
    let style = Style::of(&scene, ambient, marks.len());
    let read = [Bind::Bytes(bytes_of(&style).to_vec()), list, Bind::Scratch(SHADED), Bind::Scratch(VALUES)];
    draws.push(Draw::frame(&INK, drawing.binds(read)));
    let scratch = vec![
        Scratch::Texels(Format::Rgba32Float),
        Scratch::Texels(Format::Rgba32Uint),
        Scratch::Depths,
        Scratch::Texels(Format::Rg32Float),
        Scratch::Layers(Format::R32Float, layers as u32),
        Scratch::Texels(Format::Rg32Float),
    ];
    (scratch, draws)
}

/// An array. A buffer cannot be empty: an empty array gets one item that is never read.
fn list<T: Pod + Zeroable>(all: &[T]) -> Bind {
    Bind::List(if all.is_empty() { bytes_of(&T::zeroed()).to_vec() } else { cast_slice(all).to_vec() })
}

/// The strokes of a layer in one frame.
struct Drawing<'a> {
    scene: &'a Scene<'a>,
    sheet: Sheet,
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
    fn noise(&self, wanted: &Wanted, layer: u32) -> Vec<Draw> {
        let uniform = self.uniform(wanted);
        let uniform = || Bind::Bytes(bytes_of(&uniform).to_vec());
        let (sums, rows) = (|| Bind::Scratch(SUMS), || Bind::Scratch(PAIRS));
        let mut draws = self.kernels(wanted, &uniform);
        if wanted.even {
            draws.push(self.draw(&ALONG_ROWS, [uniform(), sums()], (PAIRS, 0)));
            draws.push(self.draw(&EVEN, [uniform(), sums(), rows()], (VALUES, layer)));
        } else {
            draws.push(self.draw(&PLAIN, [uniform(), sums()], (VALUES, layer)));
        }
        draws
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
    fn kernels(&self, wanted: &Wanted, uniform: &dyn Fn() -> Bind) -> Vec<Draw> {
        let Some((points, trim)) = self.scene.emitted(wanted) else {
            let flats: Vec<Flat> = self.scene.flats(wanted).iter().map(Flat::of).collect();
            return self.splats(&FLATS, &flats, Vec::new(), uniform);
        };
        let focal_px = self.scene.given.eye.focal_px;
        let splats: Vec<Splat> = points.iter().map(|impulse| Splat::of(impulse, focal_px)).collect();
        let covers = match trim {
            Trim::Depth(_) => 0.0,
            Trim::Object if self.scene.anchor(wanted) == Anchor::Screen => 1.0,
            Trim::Triangle => 2.0,
            Trim::Object => 3.0,
        };
        self.splats(&SPLATS, &splats, vec![("covers", covers)], uniform)
    }

    fn splats<T: Pod + Zeroable>(
        &self,
        program: &'static Program,
        all: &[T],
        constants: Vec<(&'static str, f64)>,
        uniform: &dyn Fn() -> Bind,
    ) -> Vec<Draw> {
        let draw = |(i, some): (usize, &[T])| {
            let draw = self.draw(program, [uniform(), list(some)], (SUMS, 0));
            let into = draw.into.map(|canvas| Canvas { clear: i == 0, ..canvas });
            let (constants, instances) = (constants.clone(), some.len() as u32);
            Draw { into, constants, blend: Blend::Add, vertices: 6, instances, ..draw }
        };
        // The sums are cleared where there are none.
        let lumps: Vec<&[T]> = if all.is_empty() { vec![all] } else { all.chunks(MOST).collect() };
        lumps.into_iter().enumerate().map(draw).collect()
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
