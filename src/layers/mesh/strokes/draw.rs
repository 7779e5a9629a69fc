//! The strokes of a layer in one frame, and what its passes show.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::ink::{Sheet, draw};
use super::marks::Set;
use super::model::{Noise as Wanted, ToneOf};
use super::noise::Scene;
use super::rim::Pixels;
use super::sum::Noise;
use super::tone::Range;
use super::{Given, Ready, passes};
use crate::base::pixels::Rgba;
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
    let sets: Vec<Set> = strokes.marks.iter().filter_map(Set::of).collect();
    let first = || sets.iter().find_map(|set| Some(set.noises().next()?.1));
    strokes.noises.get(name.or_else(first)?)
}

/// The color of every pixel, premultiplied, and how much ink there is.
fn drawing(scene: &Scene) -> (Vec<Rgba>, Vec<f32>) {
    let (strokes, given) = (&scene.ready.strokes, scene.given);
    let sets: Vec<Set> = strokes.marks.iter().filter_map(Set::of).collect();
    let names: BTreeSet<&str> = sets.iter().flat_map(Set::noises).map(|(_, name)| name).collect();
    let wanted = names.into_iter().filter_map(|name| Some((name.to_owned(), strokes.noises.get(name)?)));
    let noises: BTreeMap<String, Noise> = wanted.map(|(name, wanted)| (name, scene.noise(wanted))).collect();
    let plane = |triangle: u32| scene.surface.any_facet(triangle).map(|facet| scene.surface.plane(&facet));
    let pixels = Pixels {
        size_px: given.size_px,
        focal_px: given.eye.focal_px,
        inverse: &given.inverse,
        triangle: &given.triangle,
        normal: &given.normal,
        plane: &|triangle| plane(triangle).unwrap_or_default(),
    };
    let sheet =
        Sheet { pixels: &pixels, shaded: &given.shaded, tone: &tones(scene), noises: &noises, scale: scene.scale };
    draw(strokes, &sets, &sheet)
}

/// The tone of every pixel of the layer.
fn tones(scene: &Scene) -> Vec<f32> {
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
