//! Where cells are in space, and how they are turned: what directions are told in.

use glam::{DVec2, DVec3};

use super::atlas;
use super::cells::{Cell, NONE};
use super::map::Map;

/// How much nearer a triangle must be to stand for a cell in place of one before it, as a square in cells.
const NEARER: f64 = 1e-12;
/// The length below which a direction is none.
const NO_LENGTH: f64 = 1e-12;

/// Where a cell is, and how it is turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The place on the model.
    pub at: DVec3,
    /// The normal.
    pub normal: DVec3,
    /// The direction in which the atlas goes right.
    pub along: DVec3,
}

impl Frame {
    fn new(at: DVec3, normal: DVec3, along: DVec3) -> Frame {
        let normal = normal.try_normalize().unwrap_or(DVec3::Y);
        let flat = |way: DVec3| way - normal * way.dot(normal);
        let own = Some(flat(along)).filter(|own| own.length() > NO_LENGTH);
        let other = || if normal.x.abs() >= 0.9 { DVec3::Y } else { DVec3::X };
        Frame { at, normal, along: own.unwrap_or_else(|| flat(other())).normalize_or_zero() }
    }

    /// The direction at a place of the disc.
    pub fn way(&self, at: DVec2) -> DVec3 {
        let square = at.length_squared();
        let flat = 2.0 * (at.x * self.along + at.y * self.normal.cross(self.along));
        (flat + (1.0 - square) * self.normal) / (1.0 + square)
    }

    /// A direction as a place of a disc: the normal is its middle, the horizon its rim.
    pub fn direction(&self, way: DVec3) -> DVec2 {
        let (flat, up) =
            (DVec2::new(way.dot(self.along), way.dot(self.normal.cross(self.along))), way.dot(self.normal));
        match up < 0.0 {
            true if flat.length() <= NO_LENGTH => DVec2::ZERO,
            true => flat.normalize(),
            false => flat / (1.0 + up),
        }
    }
}

/// The frame of a cell.
pub fn of(map: &Map, layer: usize, cell: &Cell) -> Option<Frame> {
    let finest = map.cells.layers.len().checked_sub(1)?;
    let wide = 1_usize << (finest - layer);
    let corner = [cell.x << (finest - layer), cell.y << (finest - layer)];
    let own = map.atlas.chart.iter().enumerate().filter(|(_, chart)| **chart == cell.chart);
    let own: Vec<usize> = own.map(|(triangle, _)| triangle).collect();
    let mut frames = of_square(map, (cell.chart, &own), corner, wide);
    for halvings in 0..finest - layer {
        frames = halved(&frames, wide >> halvings);
    }
    frames.first().copied().flatten()
}

/// The frames of all cells, by layer.
pub fn all(map: &Map) -> Vec<Vec<Frame>> {
    let none = Frame::new(DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
    let mut all: Vec<Vec<Frame>> = map.cells.layers.iter().map(|layer| vec![none; layer.len()]).collect();
    let Some(finest) = map.cells.layers.last() else { return all };
    let mut triangles = vec![Vec::new(); map.atlas.extents.len()];
    map.atlas.chart.iter().enumerate().for_each(|(triangle, chart)| triangles[*chart as usize].push(triangle));
    for (chart, own) in triangles.iter().enumerate() {
        let side = (map.atlas.extents[chart].max_element() * finest.resolution) as usize + 1;
        let mut wide = side.next_power_of_two().max(1 << (map.cells.layers.len() - 1));
        let mut frames = of_square(map, (chart as u32, own), [0, 0], wide);
        for (number, layer) in map.cells.layers.iter().enumerate().rev() {
            for (i, frame) in frames.iter().enumerate() {
                let cell = layer.find(chart as u32, (i % wide) as i32, (i / wide) as i32);
                if let Some(frame) = frame.filter(|_| cell != NONE) {
                    all[number][cell as usize] = frame;
                }
            }
            if number > 0 {
                frames = halved(&frames, wide);
                wide /= 2;
            }
        }
    }
    all
}

/// The frames of the next coarser cells in a square that is so many wide.
fn halved(frames: &[Option<Frame>], wide: usize) -> Vec<Option<Frame>> {
    let half = wide / 2;
    let mean = |i: usize| {
        let (x, y) = (i % half * 2, i / half * 2);
        let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(right, down)| frames[(y + down) * wide + x + right]);
        let (mut sum, mut count) = ([DVec3::ZERO; 3], 0.0);
        for frame in four.iter().flatten() {
            sum = [sum[0] + frame.at, sum[1] + frame.normal, sum[2] + frame.along];
            count += 1.0;
        }
        (count > 0.0).then(|| Frame::new(sum[0] / count, sum[1], sum[2]))
    };
    (0..half * half).map(mean).collect()
}

/// The frames of the finest cells in a square of a chart, row by row.
fn of_square(map: &Map, (chart, own): (u32, &[usize]), corner: [i32; 2], wide: usize) -> Vec<Option<Frame>> {
    let Some(layer) = map.cells.layers.last() else { return Vec::new() };
    let mut found: Vec<Option<(f64, Frame)>> = vec![None; wide * wide];
    for &triangle in own {
        let corners = map.atlas.corners[triangle].map(|corner| corner * layer.resolution);
        let low = corners[0].min(corners[1]).min(corners[2]).floor();
        let high = corners[0].max(corners[1]).max(corners[2]).floor();
        // The nearest place of a cell's chart may be beside the cell.
        let range = |low: f64, high: f64, from: i32| {
            (low as i32 - 1 - from).clamp(0, wide as i32) as usize
                ..(high as i32 + 2 - from).clamp(0, wide as i32) as usize
        };
        for y in range(low.y, high.y, corner[1]) {
            for x in range(low.x, high.x, corner[0]) {
                let [column, row] = [corner[0] + x as i32, corner[1] + y as i32];
                if layer.find(chart, column, row) == NONE {
                    continue;
                }
                let middle = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
                let weights = nearest(corners, middle);
                let far = atlas::mixed(&corners, weights).distance_squared(middle);
                let known = &mut found[y * wide + x];
                if known.is_none_or(|(best, _)| far < best - NEARER) {
                    *known = Some((far, on_triangle(map, triangle, weights)));
                }
            }
        }
    }
    found.into_iter().map(|found| found.map(|(_, frame)| frame)).collect()
}

fn on_triangle(map: &Map, triangle: usize, weights: [f64; 3]) -> Frame {
    let mesh = &map.wanted.mesh;
    let vertices = mesh.triangles[triangle].map(|corner| &mesh.vertices[corner as usize]);
    let (mut at, mut normal) = (DVec3::ZERO, DVec3::ZERO);
    for (vertex, weight) in vertices.iter().zip(weights) {
        at += vertex.position * weight;
        normal += vertex.normal * weight;
    }
    let [a, b, c] = map.atlas.corners[triangle];
    let [p, q, r] = vertices.map(|vertex| vertex.position);
    let area = (b - a).perp_dot(c - a);
    let along = if area == 0.0 { DVec3::ZERO } else { ((q - p) * (c - a).y - (r - p) * (b - a).y) / area };
    Frame::new(at, normal, along.normalize_or_zero())
}

/// How much the corners of a triangle count at its place nearest to a point.
fn nearest(corners: [DVec2; 3], to: DVec2) -> [f64; 3] {
    let area = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]);
    let inside = [0, 1, 2]
        .map(|k: usize| (corners[(k + 2) % 3] - corners[(k + 1) % 3]).perp_dot(to - corners[(k + 1) % 3]) / area);
    if area != 0.0 && inside.iter().all(|weight| *weight >= 0.0) {
        return inside;
    }
    let sides = (0..3).map(|k| {
        let (from, way) = (corners[k], corners[(k + 1) % 3] - corners[k]);
        let along = ((to - from).dot(way) / way.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let mut weights = [0.0; 3];
        weights[k] = 1.0 - along;
        weights[(k + 1) % 3] = along;
        ((from + way * along).distance_squared(to), weights)
    });
    let best = sides.reduce(|best, side| if side.0 < best.0 { side } else { best });
    best.map_or([1.0, 0.0, 0.0], |(_, weights)| weights)
}
