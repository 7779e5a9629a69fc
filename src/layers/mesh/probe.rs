//! One pixel of a mesh layer explained.

use super::frame::{MeshAt, PosedMesh, Spot};
use super::model::MeshLayer;
use super::synth::Synth;
use crate::base::problem::Problem;
use crate::layers::parts::moment::Moment;
use crate::layers::parts::readout::{Entry, ReadOut, Under, Value};
use crate::layers::ready::Making;

/// What the pixel in column `x`, row `y` shows of the mesh. What was made of the layer is used, if that is at hand.
///
/// # Errors
/// If the mesh, or what its surface names, is not there; the problem's path is relative to the layer.
pub fn probe(
    layer: &MeshLayer,
    (making, ready): (&Making, Option<&Synth>),
    pixel: (usize, usize),
    moment: &Moment,
) -> Result<ReadOut, Problem> {
    let mesh = making.materials.mesh(&layer.mesh, "/mesh")?;
    let placed = layer.pose.at(moment.t);
    let view = PosedMesh::new(&mesh, layer.sides, &placed, making.place, moment);
    let spot = spot(&view, pixel, moment);
    let mut read = read_out(layer, spot);
    let Some(spot) = spot.filter(|_| layer.strokes.is_some() || layer.surface.slot().explains()) else {
        return Ok(read);
    };
    let made = if ready.is_none() { Some(Synth::new(layer, making, None)?) } else { None };
    if let Some(synth) = ready.or(made.as_ref()) {
        read.entries.extend(synth.surface.at(moment, &placed).told(&spot.place()));
        read.entries.extend(of_strokes(synth, pixel, moment));
    }
    Ok(read)
}

/// What its strokes are in a pixel, as if nothing hid the layer; nothing without strokes.
fn of_strokes(synth: &Synth, (x, y): (usize, usize), moment: &Moment) -> Vec<Entry> {
    let Some(strokes) = synth.strokes.as_deref() else { return Vec::new() };
    let seen = MeshAt::new(synth, moment);
    let i = y * moment.size_px.0 + x;
    seen.given_alone().map_or_else(Vec::new, |given| strokes.told(&given, i))
}

/// The triangle in column `x`, row `y` of what was synthesised.
pub fn under(synth: &Synth, pixel: (usize, usize), moment: &Moment) -> Option<Under> {
    let placed = synth.pose.at(synth.time(moment));
    let view = PosedMesh::new(&synth.mesh, synth.sides, &placed, synth.place, moment);
    spot(&view, pixel, moment).map(|spot| Under { triangle: spot.hit.triangle, depth_m: spot.hit.depth })
}

fn spot(view: &PosedMesh, (x, y): (usize, usize), moment: &Moment) -> Option<Spot> {
    let within = x < moment.size_px.0 && y < moment.size_px.1;
    within.then(|| view.at(x, y)).flatten()
}

fn read_out(layer: &MeshLayer, spot: Option<Spot>) -> ReadOut {
    let entry = |key, label, value| Entry { key, label, value };
    let Some(spot) = spot else {
        return ReadOut { entries: vec![entry("layer", "surface", Value::Of(None))], ..ReadOut::default() };
    };
    let entries = vec![
        entry("layer", "layer", Value::Of(Some(layer.name.clone()))),
        entry("triangle", "triangle", Value::Index(spot.hit.triangle)),
        entry("position", "position", Value::Coordinates(spot.position.to_array().to_vec(), "m")),
        entry("normal", "normal", Value::Coordinates(spot.normal.to_array().to_vec(), "")),
        entry("uv", "uv", Value::Coordinates(spot.uv.to_array().to_vec(), "")),
        entry("depth", "depth", Value::Coordinates(vec![spot.hit.depth], "m")),
        entry("front", "front", Value::Flag { on: spot.hit.front, off: "back" }),
    ];
    ReadOut { entries, axis: None, uv: Some(spot.uv.to_array()) }
}
