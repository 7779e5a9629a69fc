//! The base coat as an ordinary texture, by the texture coordinates of the mesh itself.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use crate::base::pixels::{Grid, Linear, Rgba};
use crate::layers::mesh::slots::view_map::cells::NONE;
use crate::layers::mesh::slots::view_map::id::depth_of;
use crate::layers::mesh::slots::view_map::map::Map;
use crate::layers::mesh::slots::view_map::sample::{Reader, Spot};

/// How far what triangles cover is repeated round them, in texels.
const PADDING: usize = 4;

/// A triangle in the texture, and the place of its first repetition there.
struct Flat {
    corners: [DVec2; 3],
    /// Twice its area, in texels; signed.
    area: f64,
}

impl Flat {
    fn new(map: &Map, triangle: usize, side: f64) -> Flat {
        let mesh = &map.wanted.mesh;
        let uv = mesh.triangles[triangle].map(|corner| mesh.vertices[corner as usize].uv);
        let tile = ((uv[0] + uv[1] + uv[2]) / 3.0).floor();
        let corners = uv.map(|uv| DVec2::new(uv.x - tile.x, 1.0 - (uv.y - tile.y)) * side);
        Flat { corners, area: (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]) }
    }

    /// How much its corners count at a place, if that is in it.
    fn weights(&self, at: DVec2) -> Option<[f64; 3]> {
        let [a, b, c] = self.corners;
        let weights = [(b, c), (c, a), (a, b)].map(|(from, to)| (to - from).perp_dot(at - from) / self.area);
        weights.iter().all(|weight| *weight >= 0.0).then_some(weights)
    }
}

/// The triangle that each texel shows, of several the first; marks those of `triangle`.
fn mark(owners: &mut [u32], side: usize, map: &Map, triangle: usize) {
    let flat = Flat::new(map, triangle, side as f64);
    if flat.area == 0.0 {
        return;
    }
    let whole = side as f64;
    let low = flat.corners.iter().fold(DVec2::INFINITY, |low, corner| low.min(*corner)).max(DVec2::splat(-whole));
    let high =
        flat.corners.iter().fold(-DVec2::INFINITY, |high, corner| high.max(*corner)).min(DVec2::splat(2.0 * whole));
    for y in low.y.floor() as i64..high.y.ceil() as i64 {
        for x in low.x.floor() as i64..high.x.ceil() as i64 {
            let at = |x: i64| x.rem_euclid(side as i64) as usize;
            let owner = &mut owners[at(y) * side + at(x)];
            if *owner == NONE && flat.weights(DVec2::new(x as f64 + 0.5, y as f64 + 0.5)).is_some() {
                *owner = triangle as u32;
            }
        }
    }
}

/// The base coat of a mesh that has texture coordinates, in so many texels a side; transparent where no triangle is near.
/// `step` is called now and then.
///
/// # Errors
/// That of `step`.
pub fn baked<E>(map: &Map, side: usize, step: &mut dyn FnMut() -> Result<(), E>) -> Result<Linear, E> {
    const AT_ONCE: usize = 1024;
    let mut owners = vec![NONE; side * side];
    for triangle in 0..map.wanted.mesh.triangles.len() {
        if triangle % AT_ONCE == 0 {
            step()?;
        }
        mark(&mut owners, side, map, triangle);
    }
    let mut texels: Vec<Rgba> = vec![[0.0; 4]; side * side];
    texels.par_chunks_mut(side).zip(owners.par_chunks(side)).enumerate().for_each(|(y, (row, owners))| {
        let reader = Reader::new(map, None);
        for (x, (texel, owner)) in row.iter_mut().zip(owners).enumerate().filter(|(_, (_, owner))| **owner != NONE) {
            *texel = color(&reader, map, *owner as usize, (x, y), side);
        }
    });
    for _ in 0..PADDING {
        step()?;
        pad(&mut texels, side);
    }
    Ok(Grid::from_cells(side, side, texels))
}

/// What a triangle shows at a texel.
fn color(reader: &Reader, map: &Map, triangle: usize, (x, y): (usize, usize), side: usize) -> Rgba {
    let flat = Flat::new(map, triangle, side as f64);
    let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
    let whole = side as f64;
    let tiles =
        [0.0, whole, -whole].into_iter().flat_map(|down| [0.0, whole, -whole].map(|right| DVec2::new(right, down)));
    let weights = tiles.filter_map(|tile| flat.weights(at + tile)).next().unwrap_or([1.0 / 3.0; 3]);
    let first = f64::from(map.wanted.first);
    let depth = depth_of(2.0 * map.atlas.areas[triangle] / flat.area.abs() * first * first);
    let [r, g, b] = reader.coated(&Spot { triangle, weights, depth, point: DVec3::ZERO, eye: DVec3::ZERO });
    [r as f32, g as f32, b as f32, 1.0]
}

/// Gives each empty texel beside full ones their mean.
fn pad(texels: &mut [Rgba], side: usize) {
    let rows = |y: usize| y.saturating_sub(1)..(y + 2).min(side);
    let empty = (0..side * side).into_par_iter().filter(|i| texels[*i][3] == 0.0);
    let found = empty.filter_map(|i| {
        let around = rows(i / side).flat_map(|y| rows(i % side).map(move |x| y * side + x));
        let sum = around.fold([0.0; 4], |sum: Rgba, at| std::array::from_fn(|k| sum[k] + texels[at][k]));
        (sum[3] > 0.0).then(|| (i, sum.map(|value| value / sum[3])))
    });
    let found: Vec<(usize, Rgba)> = found.collect();
    found.into_iter().for_each(|(i, texel)| texels[i] = texel);
}
