//! The sprites of one pixel explained.

use super::between::texels;
use super::cells::{covered, inside};
use super::color::{before, read, shaded};
use super::frame::places;
use super::model::WaterfallLayer;
use super::splat::{Splat, splats};
use super::synth::Synth;
use crate::base::pixels::{Rgba, encode};
use crate::layers::parts::moment::{Columns, Moment};
use crate::layers::parts::readout::{Entry, ReadOut, Value};

/// The most sprites that are told of.
const MOST: usize = 8;

/// The sprites that cover the pixel in column `x`, row `y`.
pub fn probe(layer: &WaterfallLayer, synth: &Synth, pixel: (usize, usize), moment: &Moment) -> ReadOut {
    let places = places(synth, moment, &[pixel.1], Columns::Some(&[pixel.0]));
    let at = [places[0][0], places[1][0]];
    let over = |splat: &Splat| covered(splat, &places).is_some() && inside(splat, at[0], at[1]).is_some();
    let mut found: Vec<(Splat, Rgba)> = splats(synth, moment)
        .into_iter()
        .filter(over)
        .map(|splat| {
            let color = color(synth, &splat, at);
            (splat, color)
        })
        .collect();
    let count = found.len();
    found.sort_by(|a, b| b.1[3].total_cmp(&a.1[3]));
    found.truncate(MOST);
    let listed = found.len();
    let items = found.iter().map(|(splat, color)| entries(layer, splat, *color)).collect();
    let layer = Some(layer.name.clone()).filter(|_| count > 0);
    let entry = |key, label, value| Entry { key, label, value };
    let entries = vec![
        entry("layer", "layer", Value::Of(layer)),
        entry("count", "sprites", Value::Index(count)),
        entry("listed", "", Value::Index(listed)),
        entry("sprites", "the most opaque first", Value::Items(items)),
    ];
    ReadOut { entries, ..ReadOut::default() }
}

/// What a sprite adds to a place: linear light, premultiplied.
fn color(synth: &Synth, splat: &Splat, [x, y]: [f64; 2]) -> Rgba {
    let mut own = Vec::new();
    let side = synth.pictures.side >> splat.level;
    texels((&synth.pictures, &synth.residues), &splat.mix, splat.level, 0..side, &mut own);
    let Some(place) = inside(splat, x, y) else { return [0.0; 4] };
    let opacity = splat.opacity * before(f64::INFINITY, splat.depth, synth.values.soft);
    (shaded(read(&own, side, place), splat.tint) * opacity as f32).to_array()
}

fn entries(layer: &WaterfallLayer, splat: &Splat, color: Rgba) -> Vec<Entry> {
    let entry = |key, value| Entry { key, label: key, value };
    // What follows from the rest is for scripts.
    let untold = |key, value| Entry { key, label: "", value };
    let called = |key, label, value| Entry { key, label, value };
    let kind = if splat.foam { "foam" } else { "water" };
    let (track, _) = splat.mix.keys().first().map_or((0, 0), |(place, _)| *place);
    vec![
        untold("layer", Value::Of(Some(layer.name.clone()))),
        entry("kind", Value::Of(Some(kind.to_owned()))),
        entry("line", Value::Index(splat.line as usize)),
        entry("birth", Value::Index(splat.alive.birth as usize)),
        entry("age", Value::Number(splat.alive.age)),
        entry("life", Value::Number(splat.life)),
        entry("track", Value::Index(track)),
        entry("key", Value::Index(splat.key.0)),
        entry("u", Value::Number(splat.key.1)),
        entry("at", Value::Coordinates(splat.at.to_array().to_vec(), "m")),
        entry("depth", Value::Number(splat.depth)),
        called("width_px", "width", Value::Number(splat.size_px.x)),
        called("length_px", "length", Value::Number(splat.size_px.y)),
        entry("angle", Value::Number(splat.angle)),
        untold("level", Value::Index(splat.level)),
        untold("axis_aligned", Value::Flag { on: splat.angle == 0.0, off: "turned" }),
        entry("color", Value::Color(encode(color))),
    ]
}
