//! What the GPU draws of a view map: what is filled as textures, which stay as long as the filling is the same, and what changes
//! with the camera or with how views fade.

use std::sync::Arc;

use super::arrays::Arrays;
use super::map::Map;
use super::upload::{CHARTS, ELEMENTS, ENTRIES, SQUARES, STARTS, TURNS};
use super::view::{Extremes, View};
use crate::layers::mesh::surface::{Look, Own};
use crate::layers::parts::plan::{Bind, COMMON, Program};
use crate::layers::parts::twin::{Twin, twin};

const SOURCE: &[&str] =
    &[COMMON, include_str!("../../posed.wgsl"), include_str!("../../frame.wgsl"), include_str!("sample.wgsl")];

/// The map on the mesh.
pub static SAMPLED: Program = sampled("sampled");
/// The same with what strokes are drawn from.
static FACTS: Program = sampled("sampled_facts");

const fn sampled(fragment: &'static str) -> Program {
    Program { name: "view_map/sample.wgsl", source: SOURCE, vertex: "spot", fragment }
}

/// The most layers.
const MOST_LAYERS: usize = 9;

/// `Map` in sample.wgsl.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Uniform {
    layers: [[u32; 4]; MOST_LAYERS],
    missing: [f32; 3],
    base: f32,
    scale: f32,
    first: f32,
    levels: u32,
    charts: u32,
    side: u32,
    unused: [u32; 3],
}

/// What shaders read.
pub const TWINS: &[Twin] = &[twin!(Uniform as "Map": layers, missing, base, scale, first, levels, charts, side)];

/// A map of which so much of the base coat alone is seen, by a camera of this focal length, in pixels of the finished frame.
pub fn look((map, arrays): (&Arc<Map>, Option<&Arc<Arrays>>), base: f64, focal_px: f64) -> Look {
    let (mut layers, mut next) = ([[0; 4]; MOST_LAYERS], [0; 2]);
    for (own, layer) in layers.iter_mut().zip(&map.cells.layers) {
        *own = [next[0], next[1], 0, 0];
        next = [next[0] + layer.numbers.len() as u32, next[1] + layer.len() as u32];
    }
    let first = f64::from(map.wanted.first);
    let uniform = Uniform {
        layers,
        missing: map.wanted.missing,
        base: base as f32,
        scale: (2.0 * first * first / (focal_px * focal_px)) as f32,
        first: first as f32,
        levels: map.cells.layers.len().max(1) as u32,
        charts: map.atlas.extents.len() as u32,
        side: arrays.map_or(0, |arrays| arrays.side() as u32),
        unused: [0; 3],
    };
    let (cells, corners) = (|part| Bind::Upload(map.cells.clone(), part), || Bind::Upload(map.atlas.clone(), 0));
    let uniform = Bind::Bytes(bytemuck::bytes_of(&uniform).to_vec());
    let mut binds = vec![uniform, corners(), cells(CHARTS), cells(SQUARES), Bind::Upload(map.coats.clone(), 0)];
    // Something has to stand where nothing is read.
    let (lists, of_arrays) = match arrays {
        None => ([STARTS, ENTRIES].map(|part| Bind::Upload(map.lists.clone(), part)), [corners(), corners()]),
        Some(arrays) => ([CHARTS, CHARTS].map(cells), [TURNS, ELEMENTS].map(|part| Bind::Upload(arrays.clone(), part))),
    };
    binds.extend(lists);
    binds.push(Bind::List(bytemuck::cast_slice(&views(&map.wanted.views)).to_vec()));
    binds.extend(of_arrays);
    let constants = vec![("from_arrays", f64::from(u8::from(arrays.is_some())))];
    Look::Own(Own { program: &SAMPLED, facts: &FACTS, constants, binds })
}

/// Of each view two, then the extreme places of all; never empty.
fn views(views: &[View]) -> Vec<[f32; 4]> {
    let (mut all, mut places) = (Vec::with_capacity(2 * views.len()), Vec::new());
    for view in views {
        let (kind, reach, own) = match &view.extremes {
            _ if !view.dependent => (0, 1.0, &[][..]),
            Extremes::Auto(reach) => (1, *reach, &[][..]),
            Extremes::Cone(reach) => (2, *reach, &[][..]),
            Extremes::Points(places) => (3, 1.0, &places[..]),
        };
        let kind = if view.fade.linear && view.dependent { kind + 4 } else { kind };
        let [x, y, z] = view.camera.position.as_vec3().to_array();
        let first = 2 * views.len() + places.len();
        all.push([x, y, z, reach as f32]);
        all.push([(1.0 / (1.0 - view.fade.hold)) as f32, kind as f32, first as f32, own.len() as f32]);
        places.extend(own.iter().map(|place| place.as_vec3().extend(0.0).to_array()));
    }
    all.extend(places);
    if all.is_empty() { vec![[0.0; 4]] } else { all }
}
