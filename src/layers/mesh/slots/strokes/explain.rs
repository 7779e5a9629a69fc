//! Why there is ink in a pixel: its tone, what each noise is there and which impulses it is made of, and what each mark makes of
//! it.

use std::collections::BTreeMap;

use glam::DVec2;

use super::draw::{sheet_of, tones};
use super::ink::Sheet;
use super::marks::Set;
use super::noise::Scene;
use super::sum::Noise;
use super::synth::Ready;
use crate::layers::mesh::drawing::Given;
use crate::layers::parts::readout::{Entry, Value};

/// What is to be told of pixel number `i` of the frame, which shows the layer.
pub fn entries(ready: &Ready, given: &Given, i: usize) -> Vec<Entry> {
    let scene = Scene::new(ready, given);
    let strokes = &ready.strokes;
    let noises = strokes.noises.iter().map(|(name, wanted)| (name.clone(), scene.noise_with_shares(wanted)));
    let noises: BTreeMap<String, Noise> = noises.collect();
    let tone = tones(&scene);
    let sets: Vec<(&str, Set)> =
        strokes.marks.iter().filter_map(|mark| Some((mark.name.as_str(), Set::of(mark)?))).collect();
    let of_noises = noises.iter().map(|(name, noise)| of_noise(&scene, name, noise, i)).collect();
    let of_marks = sheet_of(&scene, (&given.shaded, &tone), &noises, |sheet| {
        let at = (i % given.size_px.0, i / given.size_px.0);
        sets.iter().map(|(name, set)| of_mark(ready, sheet, (name, set), at)).collect()
    });
    vec![
        entry("tone", "tone", Value::Number(tone[i].into())),
        entry("noises", "noises with the nearest of the impulses that reach the pixel", Value::Items(of_noises)),
        entry("marks", "marks in order", Value::Items(of_marks)),
    ]
}

fn entry(key: &'static str, label: &'static str, value: Value) -> Entry {
    Entry { key, label, value }
}

/// A number, where there is one.
fn number(value: Option<f64>) -> Value {
    value.map_or(Value::Of(None), Value::Number)
}

fn of_noise(scene: &Scene, name: &str, noise: &Noise, i: usize) -> Vec<Entry> {
    let wanted = &scene.ready.strokes.noises[name];
    let width = scene.given.size_px.0;
    let pixel = (i % width, i / width);
    let at = DVec2::new(pixel.0 as f64 + 0.5, pixel.1 as f64 + 0.5);
    let reaching = scene.reaching(wanted, pixel);
    let away = |impulse: &super::impulse::Impulse| impulse.at.distance_squared(at);
    let nearest = reaching.iter().flatten().min_by(|a, b| away(a).total_cmp(&away(b)));
    let index = |k: usize| nearest.map_or(Value::Of(None), |impulse| Value::Index(impulse.of[k] as usize));
    let degrees = nearest.map(|impulse| (-impulse.angle).to_degrees().rem_euclid(180.0));
    let count = reaching.as_ref().map_or(Value::Of(None), |all| Value::Index(all.len()));
    vec![
        entry("name", "noise", Value::Of(Some(name.to_owned()))),
        entry("x", "x", Value::Number(noise.value[i].into())),
        entry("share", "P/V", Value::Number(noise.share[i].into())),
        entry("impulses", "impulses", count),
        entry("triangle", "triangle", index(0)),
        entry("piece", "piece", index(1)),
        entry("number", "j", index(2)),
        entry("factor", "factor", number(nearest.map(|impulse| impulse.factor))),
        entry("angle", "angle", number(degrees)),
        entry("sure", "sure", number(nearest.map(|impulse| impulse.sure))),
    ]
}

fn of_mark(ready: &Ready, sheet: &Sheet, (name, set): (&str, &Set), at: (usize, usize)) -> Vec<Entry> {
    let [share, threshold, covered] = match set {
        Set::Ink(ink) => sheet.inked(&ready.strokes, ink, at).map_or([None; 3], |inked| {
            let [share, threshold, covered] = [inked.share, inked.threshold, inked.covered].map(|run| run[0]);
            [Some(share), (share > 0.0).then_some(threshold), Some(covered)]
        }),
        Set::Outline(outline) => [None, None, Some(sheet.outlined(&ready.strokes, outline)(at)[0])],
        Set::Pigment(_) | Set::Relief(_) => [None; 3],
    };
    vec![
        entry("name", "mark", Value::Of(Some(name.to_owned()))),
        entry("share", "D", number(share.map(f64::from))),
        entry("threshold", "tau", number(threshold.map(f64::from))),
        entry("covered", "c", number(covered.map(f64::from))),
    ]
}
