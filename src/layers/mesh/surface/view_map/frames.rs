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

    /// A direction as a place of a disc: the normal is its middle, the horizon its rim.
    pub fn direction(&self, way: DVec3) -> DVec2 {
        let (flat, up) =
            (DVec2::new(way.dot(self.along), way.dot(self.normal.cross(self.along))), way.dot(self.normal));
        if up < 0.0 { flat.normalize_or_zero() } else { flat / (1.0 + up) }
    }
}

/// The frame of a cell.
pub fn of(map: &Map, layer: usize, cell: &Cell) -> Option<Frame> {
    let finest = map.cells.layers.len().checked_sub(1)?;
    let mut wide = 1_usize << (finest - layer);
    let corner = [cell.x << (finest - layer), cell.y << (finest - layer)];
    let mut frames = of_square(map, cell.chart, corner, wide);
    while wide > 1 {
        wide /= 2;
        let mean = |i: usize| {
            let (x, y) = (i % wide * 2, i / wide * 2);
            let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(right, down)| frames[(y + down) * wide * 2 + x + right]);
            let (mut sum, mut count) = ([DVec3::ZERO; 3], 0.0);
            for frame in four.iter().flatten() {
                sum = [sum[0] + frame.at, sum[1] + frame.normal, sum[2] + frame.along];
                count += 1.0;
            }
            (count > 0.0).then(|| Frame::new(sum[0] / count, sum[1], sum[2]))
        };
        frames = (0..wide * wide).map(mean).collect();
    }
    frames.first().copied().flatten()
}

/// The frames of the finest cells in a square of a chart, row by row.
fn of_square(map: &Map, chart: u32, corner: [i32; 2], wide: usize) -> Vec<Option<Frame>> {
    let Some(layer) = map.cells.layers.last() else { return Vec::new() };
    let mut found: Vec<Option<(f64, Frame)>> = vec![None; wide * wide];
    let own = map.atlas.chart.iter().enumerate().filter(|(_, own)| **own == chart);
    for (triangle, _) in own {
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
