//! The strokes of a layer in one frame, and what its passes show.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::ink::{Drawing, Sheet};
use super::marks::Set;
use super::model::{Force, Noise as Wanted, ToneOf};
use super::noise::Scene;
use super::passes;
use super::rim::Pixels;
use super::sum::Noise;
use super::synth::Ready;
use super::tone::{Range, brightness};
use crate::base::pixels::{Rgba, linear_from_srgb, srgb_from_linear};
use crate::base::simd::vectorised;
use crate::layers::mesh::drawing::Given;
use crate::layers::parts::pass::{COLOR, Which};
use crate::layers::space::raster::NONE;

/// Writes what a pass has at every pixel that shows the layer to `out`.
pub fn pass(ready: &Ready, given: &Given, which: Which, out: &mut [Rgba]) {
    let scene = Scene::new(ready, given);
    let number = |v: f32| [v, v, v, 1.0];
    match which.pass.name {
        name if name == COLOR.name => drawn(&scene, |drawing| draw(out, given, drawing, |color, _| color)),
        name if name == passes::INK.name => drawn(&scene, |drawing| draw(out, given, drawing, |_, ink| number(ink))),
        name if name == passes::TONE.name => {
            let tones = tones(&scene);
            fill(out, given, |i| number(tones[i]));
        }
        name if name == passes::NOISE.name => match asked(ready, which.of) {
            Some(wanted) => {
                let noise = scene.noise_with_shares(wanted);
                fill(out, given, |i| [noise.value[i], noise.share[i], 0.0, 1.0]);
            }
            None => fill(out, given, |_| number(0.0)),
        },
        _ => fill(out, given, |_| [0.0; 4]),
    }
}

/// Writes the pixels that show the layer.
fn fill(out: &mut [Rgba], given: &Given, at: impl Fn(usize) -> Rgba + Sync) {
    let pixels = out.par_iter_mut().zip(&given.triangle).enumerate();
    pixels.filter(|(_, (_, triangle))| **triangle != NONE).for_each(|(i, (out, _))| *out = at(i));
}

/// Writes something of the colors and the ink of a drawing to the pixels that show the layer.
fn draw(out: &mut [Rgba], given: &Given, drawing: &Drawing, of: impl Fn(Rgba, f32) -> Rgba + Sync) {
    let rows = out.par_chunks_mut(given.size_px.0.max(1)).enumerate();
    rows.for_each(|(y, row)| drawing.row(y, |x, color, ink| row[x] = of(color, ink)));
}

/// The noise of this name, or that of the first mark that has one.
fn asked<'a>(ready: &'a Ready, name: Option<&str>) -> Option<&'a Wanted> {
    let strokes = &ready.strokes;
    strokes.noises.get(name.or_else(|| main_noise(strokes))?)
}

/// The name of the noise of the first mark that has one.
pub fn main_noise(strokes: &Force) -> Option<&str> {
    let first = strokes.marks.iter().find_map(|mark| Some(Set::of(mark)?.noises().next()?.1.to_owned()))?;
    strokes.noises.keys().find(|name| **name == first).map(String::as_str)
}

/// The lightness of every pixel, as an sRGB code from 0 to 1, of a gray surface of one tone without outlines.
pub fn grey(ready: &Ready, given: &Given) -> Vec<f32> {
    const CODE: f64 = 0.5;
    let light = linear_from_srgb(CODE) as f32;
    let own = |triangle: &u32| if *triangle == NONE { [0.0; 4] } else { [light, light, light, 1.0] };
    let shaded: Vec<Rgba> = given.triangle.iter().map(own).collect();
    let sets: Vec<Set> = ready.strokes.marks.iter().filter_map(Set::of).collect();
    let sets: Vec<Set> = sets.into_iter().filter(|set| !matches!(set, Set::Outline(_))).collect();
    let code = |[r, g, b, _]: Rgba| {
        let [r, g, b] = [r, g, b].map(f64::from);
        srgb_from_linear(0.2126 * r + 0.7152 * g + 0.0722 * b) as f32
    };
    let mut drawn = vec![[0.0; 4]; shaded.len()];
    made(&Scene::new(ready, given), &sets, (&shaded, &vec![CODE as f32; shaded.len()]), |drawing| {
        draw(&mut drawn, given, drawing, |color, _| color);
    });
    drawn.into_par_iter().map(code).collect()
}

/// Makes something of the drawing of all marks.
fn drawn<R>(scene: &Scene, make: impl FnOnce(&Drawing) -> R) -> R {
    let sets: Vec<Set> = scene.ready.strokes.marks.iter().filter_map(Set::of).collect();
    made(scene, &sets, (&scene.given.shaded, &tones(scene)), make)
}

/// The same of these marks, on a surface of these shaded colors and tones.
fn made<R>(scene: &Scene, sets: &[Set], (shaded, tone): (&[Rgba], &[f32]), make: impl FnOnce(&Drawing) -> R) -> R {
    let strokes = &scene.ready.strokes;
    let names: BTreeSet<&str> = sets.iter().flat_map(Set::noises).map(|(_, name)| name).collect();
    let wanted = names.into_iter().filter_map(|name| Some((name.to_owned(), strokes.noises.get(name)?)));
    // Side by side: no thread waits while another sorts.
    let wanted: Vec<_> = wanted.collect();
    let noises: BTreeMap<String, Noise> =
        wanted.into_par_iter().map(|(name, wanted)| (name, scene.noise(wanted))).collect();
    sheet_of(scene, (shaded, tone), &noises, |sheet| make(&Drawing::new(strokes, sets, sheet)))
}

/// Makes something of what a drawing is made from: of these shaded colors and tones, and these noises.
pub fn sheet_of<R>(
    scene: &Scene,
    (shaded, tone): (&[Rgba], &[f32]),
    noises: &BTreeMap<String, Noise>,
    make: impl FnOnce(&Sheet) -> R,
) -> R {
    let given = scene.given;
    let plane = |triangle: u32| scene.surface.any_facet(triangle).map(|facet| scene.surface.plane(&facet));
    let pixels = Pixels {
        size_px: given.size_px,
        focal_px: given.eye.focal_px,
        inverse: &given.inverse,
        triangle: &given.triangle,
        normal: &given.normal,
        plane: &|triangle| plane(triangle).unwrap_or_default(),
    };
    make(&Sheet { pixels: &pixels, shaded, tone, noises, scale: scene.scale })
}

/// So many tones are made at once.
const RUN: usize = 1024;

/// The tone of every pixel of the layer.
pub fn tones(scene: &Scene) -> Vec<f32> {
    let (tone, given) = (&scene.ready.strokes.tone, scene.given);
    let range = Range { dark: tone.dark, light: tone.light, gamma: tone.gamma };
    let light = |i: usize| match tone.of {
        ToneOf::Light => given.light[i],
        ToneOf::Color => {
            let [r, g, b, a] = given.shaded[i];
            let often = if a > 0.0 { 1.0 / a } else { 0.0 };
            brightness([r, g, b]) * often
        }
    };
    let mut tones = vec![0.0; given.triangle.len()];
    let runs = tones.par_chunks_mut(RUN).zip(given.triangle.par_chunks(RUN)).enumerate();
    runs.filter(|(_, (_, triangles))| triangles.iter().any(|triangle| *triangle != NONE)).for_each(
        |(run, (tones, triangles))| {
            vectorised(
                #[inline(always)]
                || {
                    tones.iter_mut().enumerate().for_each(|(k, own)| *own = light(run * RUN + k));
                    range.tones(tones);
                },
            );
            let empty = tones.iter_mut().zip(triangles).filter(|(_, triangle)| **triangle == NONE);
            empty.for_each(|(tone, _)| *tone = 0.0);
        },
    );
    tones
}
