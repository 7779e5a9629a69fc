//! A view map as textures for other engines (docs/textures.md): of each layer the base coat, what depends on the direction
//! and how cells are turned; and the mesh, whose texture coordinates lead to them.

use glam::{DMat3, DQuat, DVec3};
use serde_json::Value;

use self::layout::{Layout, Texels};
use self::manifest::{Blend, CONVENTIONS, Chart, Layer, Manifest, Point};
use super::arrays;
use super::blend::Points;
use super::cells::NONE;
use super::frames::{self, Frame};
use super::looked::Filled;
use super::map::Map;
use crate::base::error::{Error, Result};
use crate::base::pixels::Grid;
use crate::base::problem::quoted;
use crate::layers::parts::bundle::{Channel, Form, Sink, Texture};

mod bake;
mod layout;
mod manifest;
mod obj;

/// How many directions there are along a side where the map has none.
const DIRECTIONS: usize = 8;
/// The fewest that it may have.
const FEWEST: usize = 4;
/// The most layers that a map has.
const MOST_LAYERS: usize = 9;
/// The most texels of a texture along a side, which engines can hold, and in all.
const MOST_SIDE: usize = 16384;
/// See [`MOST_SIDE`].
const MOST_TEXELS: usize = 1 << 27;
/// How many cells are made between two looks at whether it is to end.
const AT_ONCE: usize = 2048;

/// The files of a layer of cells.
const OF_A_LAYER: [(Form, &str); 3] = [(Form::Picture, "base"), (Form::Halves, "directions"), (Form::Texture, "turns")];
/// What the name of the baked base coat ends in.
const BAKED: &str = "baked";

/// The files of a map, and what their names end in.
pub fn ends() -> Vec<(Form, String)> {
    let layers = (0..MOST_LAYERS).flat_map(|i| OF_A_LAYER.map(|(form, name)| (form, format!("{name}-{i}"))));
    let others = [(Form::Mesh, String::new()), (Form::Picture, BAKED.to_owned())];
    layers.chain(others).collect()
}

/// Writes the textures of a map on the layer `name`, and gives what the manifest says about it.
///
/// # Errors
/// Those of `to`; it is too large; or it is to be baked and has no texture coordinates.
pub fn write(filled: Filled, points: &Points, name: &str, to: &mut dyn Sink) -> Result<Value> {
    let (map, arrays) = filled;
    let side = arrays.map_or(DIRECTIONS, |arrays| arrays.side());
    let layout = Layout::new(&map.cells);
    fits(&layout, map.cells.layers.len(), side, name)?;
    can_be_baked(map, name, to)?;
    let mut steps = Steps { done: 0, all: all(filled) };
    let stem = to.stem(None, name, "turns-0");
    steps.step(to)?;
    let mesh = to.mesh(stem.trim_end_matches('-'), &obj::text(map, &layout))?;
    let frames = frames::all(map);
    let mut layers = Vec::new();
    for (number, frames) in frames.iter().enumerate() {
        layers.push(layer(filled, &layout, (number, frames, side), &stem, (to, &mut steps))?);
    }
    let baked = match to.baked_px() {
        Some(px) => {
            let picture = bake::baked(map, px, &mut || steps.step(to))?;
            Some(to.picture(&format!("{stem}{BAKED}"), &picture, &|_| ())?)
        }
        None => None,
    };
    let charts = map.cells.layers.iter().take(1).flat_map(|layer| &layer.charts).zip(&layout.places);
    let chart = |(chart, (x, y)): (&super::cells::Chart, &(usize, usize))| Chart {
        x: *x,
        y: *y,
        width: chart.width as usize,
        height: chart.height as usize,
    };
    let manifest = Manifest {
        kind: "view-map",
        conventions: CONVENTIONS,
        mesh,
        directions: side,
        missing: map.wanted.missing,
        layers,
        charts: charts.map(chart).collect(),
        blend: blend(points),
        baked,
    };
    serde_json::to_value(manifest).map_err(|error| Error::at("manifest.json", error))
}

fn blend(own: &Points) -> Blend {
    let point = |(position, direction, base): &(DVec3, DVec3, f64)| Point {
        position: position.to_array(),
        direction: direction.to_array(),
        base: *base,
    };
    Blend { points: own.points.iter().map(point).collect(), cosine: own.cosine, distance: own.distance }
}

/// How far it is.
struct Steps {
    done: u64,
    all: u64,
}

impl Steps {
    /// One more is begun. Where there are more than were counted the last is begun again.
    fn step(&mut self, to: &mut dyn Sink) -> Result<()> {
        to.step(self.done, self.all)?;
        self.done = (self.done + 1).min(self.all.saturating_sub(1));
        Ok(())
    }
}

/// How many steps there are.
fn all((map, arrays): Filled) -> u64 {
    let parts = |cells: usize| if arrays.is_some() { 0 } else { cells.div_ceil(AT_ONCE) as u64 };
    1 + map.cells.layers.iter().map(|layer| 2 + parts(layer.len())).sum::<u64>()
}

/// Refuses textures that are too large, of so many layers and directions a side.
fn fits(layout: &Layout, layers: usize, side: usize, name: &str) -> Result<()> {
    let size = |layers: usize, side: usize| {
        let (width, height) = layout.size(layers.saturating_sub(1));
        (width * side, height * side)
    };
    let fits = |(width, height): (usize, usize)| width.max(height) <= MOST_SIDE && width * height <= MOST_TEXELS;
    let (width, height) = size(layers, side);
    if fits((width, height)) {
        return Ok(());
    }
    let fewer_layers = (1..layers).rev().find(|layers| fits(size(*layers, side)));
    let fewer_layers = fewer_layers.map(|layers| format!("\"levels\": {layers}"));
    let fewer_directions = (FEWEST..side).rev().find(|side| fits(size(layers, *side)));
    let fewer_directions = fewer_directions.map(|side| format!("\"directions\": {side}"));
    let cures: Vec<String> = fewer_layers.into_iter().chain(fewer_directions).collect();
    let cure = match cures.is_empty() {
        true => "make \"cells\" smaller, or lay the mesh out in fewer charts".to_owned(),
        false => format!("{} would fit", cures.join(" or ")),
    };
    let (charts, most) = (layout.places.len(), MOST_TEXELS >> 20);
    let what = format!(
        "the directions of its {charts} charts would be {width}x{height} texels, and {MOST_SIDE} a side and {most} million in \
         all may be"
    );
    Err(Error::at(format!("layer {}", quoted(name)), what).cure(cure))
}

/// Refuses to bake what has no texture coordinates.
fn can_be_baked(map: &Map, name: &str, to: &dyn Sink) -> Result<()> {
    match map.wanted.mesh.without_uv.filter(|_| to.baked_px().is_some()) {
        None => Ok(()),
        Some(triangle) => {
            let what = format!("has no texture coordinates at triangle {triangle} (from 0) to bake it by");
            let cure = "unwrap the mesh, or leave out --bake and take the mesh that is written with the textures";
            Err(Error::at(format!("layer {}", quoted(name)), what).cure(cure))
        }
    }
}

/// Writes a layer of cells.
fn layer(
    (map, arrays): Filled,
    layout: &Layout,
    (number, frames, side): (usize, &[Frame], usize),
    stem: &str,
    (to, steps): (&mut dyn Sink, &mut Steps),
) -> Result<Layer> {
    let layer = &map.cells.layers[number];
    let (width, height) = layout.size(number);
    let shown = layout.shown(number, layer);
    let name = |of: usize| format!("{stem}{}-{number}", OF_A_LAYER[of].1);
    steps.step(to)?;
    let colors = shown.cells.iter().map(|cell| match map.coats[number].colors.get(*cell as usize) {
        Some([r, g, b]) => [*r, *g, *b, 1.0],
        None => [0.0; 4],
    });
    let colors = Grid::from_cells(width, height, colors.collect());
    let base = to.picture(&name(0), &colors, &|codes| {
        let alphas = codes.cells_mut().iter_mut().map(|[.., alpha]| alpha);
        alphas.zip(&shown.own).filter(|(_, own)| !**own).for_each(|(alpha, _)| *alpha = 0);
    })?;
    drop(colors);
    let mut made = Vec::new();
    let elements = match arrays {
        Some(arrays) => &arrays.elements[number],
        None => {
            for (part, frames) in frames.chunks(AT_ONCE).enumerate() {
                steps.step(to)?;
                made.extend(arrays::elements(map, (number, part * AT_ONCE), frames, side, &|| false));
            }
            &made
        }
    };
    steps.step(to)?;
    let directions = to.halves(&name(1), (width * side, height * side), &|x, y| {
        let cell = shown.cells[y / side * width + x / side];
        if cell == NONE { [0; 4] } else { elements[(cell as usize * side + y % side) * side + x % side] }
    })?;
    let turns = to.texture(&name(2), &turns(&shown, frames, (width, height)))?;
    Ok(Layer { density: layer.resolution, width, height, base, directions, turns })
}

/// How cells are turned.
fn turns(shown: &Texels, frames: &[Frame], (width, height): (usize, usize)) -> Texture {
    let turn = |cell: &u32| match frames.get(*cell as usize) {
        Some(Frame { normal, along, .. }) => {
            DQuat::from_mat3(&DMat3::from_cols(*along, normal.cross(*along), *normal)).to_array()
        }
        None => [0.0; 4],
    };
    let channel = |name| Channel::new(name, "of the quaternion that turns the axes into T, B and N", 0);
    let values = Grid::from_cells(width, height, shown.cells.iter().map(turn).collect());
    Texture { values, channels: ["x", "y", "z", "w"].map(channel).to_vec() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::mesh::slots::view_map::cells::{self, Cells};

    #[test]
    fn what_is_too_large_says_what_would_fit() {
        let cells = |sizes: &[[i32; 2]]| {
            let charts = sizes.iter().map(|[width, height]| cells::Chart { first: 0, width: *width, height: *height });
            Cells { layers: vec![cells::Layer { charts: charts.collect(), ..cells::Layer::default() }] }
        };
        let said = |sizes: &[[i32; 2]], layers: usize, side: usize| {
            fits(&Layout::new(&cells(sizes)), layers, side, "cow").map_err(|error| error.to_string()).err()
        };
        assert_eq!(said(&[[40, 30]], 5, 8), None);
        let told = said(&[[98, 62]], 6, 8).unwrap();
        let (what, cure) = told.split_once(" (").unwrap();
        assert!(
            what.starts_with("layer \"cow\": the directions of its 1 charts would be 25600x16384 texels"),
            "{what}"
        );
        assert_eq!(cure, "\"levels\": 5 or \"directions\": 4 would fit)");
        let told = said(&[[9000, 1]], 2, 4).unwrap();
        assert!(told.ends_with("(make \"cells\" smaller, or lay the mesh out in fewer charts)"), "{told}");
    }

    #[test]
    fn charts_stay_apart_on_all_layers() {
        let sizes = [[3, 2], [1, 1], [5, 4], [2, 7]];
        let charts = sizes.map(|[width, height]| cells::Chart { first: 0, width, height });
        let layer = cells::Layer { charts: charts.to_vec(), ..cells::Layer::default() };
        let layout = Layout::new(&Cells { layers: vec![layer.clone()] });
        for number in 0..3 {
            let all = sizes.iter().enumerate().flat_map(|(chart, [width, height])| {
                (0..height << number)
                    .flat_map(move |y| (0..width << number).map(move |x| cells::Cell { chart: chart as u32, x, y }))
            });
            let all: Vec<cells::Cell> = all.collect();
            let shown = layout.shown(number, &cells::Layer { cells: all.clone(), ..layer.clone() });
            assert_eq!(shown.own.iter().filter(|own| **own).count(), all.len(), "none lies over another");
            let (width, height) = layout.size(number);
            for (i, own) in shown.own.iter().enumerate().filter(|(_, own)| **own) {
                let (x, y) = (i % width, i / width);
                assert!(*own && x > 0 && y > 0 && x + 1 < width && y + 1 < height);
                let chart = all[shown.cells[i] as usize].chart;
                let beside = [i - 1, i + 1, i - width, i + width, i - width - 1, i + width + 1];
                assert!(beside.iter().all(|at| all[shown.cells[*at] as usize].chart == chart), "a border all round");
            }
        }
    }
}
