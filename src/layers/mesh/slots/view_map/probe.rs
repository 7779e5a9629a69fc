//! One place of a view map explained.

use super::cells::{Cell, NONE};
use super::frames;
use super::looked::Looked;
use crate::base::pixels::encode;
use crate::layers::mesh::surface::SurfacePoint;
use crate::layers::parts::readout::{Entry, Value};

/// The least share of a view that is told.
const LEAST_SHARE: f64 = 0.0005;

/// What a pixel shows of the map: its depth, its cell, from where it is looked at, and which views are seen.
pub fn entry(looked: &Looked, place: &SurfacePoint) -> Option<Entry> {
    let map = looked.map();
    let spot = looked.spots()(place)?;
    let mut shares = vec![0.0; map.wanted.views.len()];
    let sample = looked.sampler().at(&spot, Some(&mut |view, share| shares[view] += share));
    let finest = map.cells.layers.len().checked_sub(1)?;
    let layer = (spot.depth.clamp(0.0, finest as f64) + 0.5) as usize;
    let chart = map.atlas.chart[spot.triangle];
    let at = (map.atlas.at(spot.triangle, spot.weights) * map.cells.layers[layer].resolution).floor();
    let cell = Cell { chart, x: at.x as i32, y: at.y as i32 };
    let is_there = map.cells.layers[layer].find(chart, cell.x, cell.y) != NONE;
    let frame = is_there.then(|| frames::of(map, layer, &cell)).flatten();
    let direction = frame.map(|frame| frame.direction(spot.eye).to_array().to_vec());
    let [r, g, b] = sample.independent.map(|light| light as f32);
    let [r, g, b, _] = encode([r, g, b, 1.0]).map(usize::from);
    let names = map.wanted.views.iter().map(|view| view.name.clone());
    let mut views: Vec<(String, f64)> = names.zip(shares).filter(|(_, share)| *share > LEAST_SHARE).collect();
    views.sort_by(|a, b| b.1.total_cmp(&a.1));
    let entry = |key, label, value| Entry { key, label, value };
    let all = vec![
        entry("depth", "depth", Value::Number(spot.depth)),
        entry("cell", "cell", Value::Indices(vec![layer, chart as usize, cell.x as usize, cell.y as usize])),
        entry("direction", "", Value::Coordinates(direction.unwrap_or_default(), "")),
        entry("opacity", "opacity", Value::Number(sample.opacity)),
        entry("blend", "", Value::Number(looked.base())),
        entry("base", "", Value::Indices(vec![r, g, b])),
        entry("known", "known", Value::Number(sample.known)),
        entry("views", "views", Value::Shares(views)),
    ];
    Some(entry("view_map", "view map", Value::Group(all)))
}
