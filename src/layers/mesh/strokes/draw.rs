//! The strokes of a layer in one frame, and what its passes show.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::ink::{Sheet, draw};
use super::marks::Set;
use super::model::{Force, Noise as Wanted, ToneOf};
use super::noise::Scene;
use super::rim::Pixels;
use super::sum::Noise;
use super::tone::Range;
use super::{Given, Ready, passes};
use crate::base::pixels::{Rgba, linear_from_srgb, srgb_from_linear};
use crate::layers::parts::pass::{COLOR, Which};
use crate::layers::space::raster::NONE;

/// What a pass has at every pixel of the frame; transparent where there is nothing.
pub fn pass(ready: &Ready, given: &Given, which: Which) -> Vec<Rgba> {
    let scene = Scene::new(ready, given);
    let own = |i: usize| given.triangle[i] != NONE;
    let number = |v: f32| [v, v, v, 1.0];
    let all = 0..given.triangle.len();
    let filled = |at: &(dyn Fn(usize) -> Rgba + Sync)| -> Vec<Rgba> {
        all.clone().into_par_iter().map(|i| if own(i) { at(i) } else { [0.0; 4] }).collect()
    };
    match which.pass.name {
        name if name == COLOR.name => drawing(&scene).0,
        name if name == passes::INK.name => {
            let ink = drawing(&scene).1;
            filled(&|i| number(ink[i]))
        }
        name if name == passes::TONE.name => {
            let tones = tones(&scene);
            filled(&|i| number(tones[i]))
        }
        name if name == passes::NOISE.name => match asked(ready, which.of) {
            Some(wanted) => {
                let noise = scene.noise(wanted);
                filled(&|i| [noise.value[i], noise.share[i], 0.0, 1.0])
            }
            None => filled(&|_| number(0.0)),
        },
        _ => vec![[0.0; 4]; given.triangle.len()],
    }
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
    let drawn = made(&Scene::new(ready, given), &sets, &shaded, &vec![CODE as f32; shaded.len()]).0;
    let code = |[r, g, b, _]: &Rgba| {
        let [r, g, b] = [r, g, b].map(|v| f64::from(*v));
        srgb_from_linear(0.2126 * r + 0.7152 * g + 0.0722 * b) as f32
    };
    drawn.par_iter().map(code).collect()
}

/// The color of every pixel, premultiplied, and how much ink there is.
fn drawing(scene: &Scene) -> (Vec<Rgba>, Vec<f32>) {
    let sets: Vec<Set> = scene.ready.strokes.marks.iter().filter_map(Set::of).collect();
    made(scene, &sets, &scene.given.shaded, &tones(scene))
}

/// The same of these marks, on a surface of these shaded colors and tones.
fn made(scene: &Scene, sets: &[Set], shaded: &[Rgba], tone: &[f32]) -> (Vec<Rgba>, Vec<f32>) {
    let strokes = &scene.ready.strokes;
    let names: BTreeSet<&str> = sets.iter().flat_map(Set::noises).map(|(_, name)| name).collect();
    let wanted = names.into_iter().filter_map(|name| Some((name.to_owned(), strokes.noises.get(name)?)));
    let noises: BTreeMap<String, Noise> = wanted.map(|(name, wanted)| (name, scene.noise(wanted))).collect();
    sheet_of(scene, (shaded, tone), &noises, |sheet| draw(strokes, sets, sheet))
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

/// The tone of every pixel of the layer.
pub fn tones(scene: &Scene) -> Vec<f32> {
    let (tone, given) = (&scene.ready.strokes.tone, scene.given);
    let range = Range { dark: tone.dark, light: tone.light, gamma: tone.gamma };
    let at = |i: usize| match tone.of {
        _ if given.triangle[i] == NONE => 0.0,
        ToneOf::Light => range.tone([f64::from(given.light[i]); 3]) as f32,
        ToneOf::Color => {
            let [r, g, b, a] = given.shaded[i].map(f64::from);
            let straight = if a > 0.0 { [r / a, g / a, b / a] } else { [0.0; 3] };
            range.tone(straight) as f32
        }
    };
    (0..given.triangle.len()).into_par_iter().map(at).collect()
}
