//! The views of a map drawn again, each from its own camera: how near that comes to their pictures.

use glam::DVec3;
use kurbo::Vec2;
use rayon::prelude::*;

use super::id::{depth_of, share_of};
use super::looked::Filled;
use super::sample::{Reader, Spot};
use crate::base::maths::ln;
use crate::base::pixels::{Rgba, encode};
use crate::layers::parts::moment::Columns;
use crate::layers::space::raster::{NONE, Raster};

/// The least cosine between the normal and the way to the camera.
const LEAST_NORMAL: f64 = 0.2;

/// The peak signal-to-noise ratio of each active view, in dB; `None` if nothing of it is seen, infinite if there is no
/// difference at all.
pub fn compare(filled: Filled) -> Vec<Option<f64>> {
    (0..filled.0.wanted.views.len()).map(|view| one(filled, view)).collect()
}

fn one((map, arrays): Filled, view: usize) -> Option<f64> {
    let own = &map.wanted.views[view];
    let (camera, mesh) = (&own.camera, &map.wanted.mesh);
    let seen: Vec<DVec3> = mesh.vertices.iter().map(|vertex| camera.seen(vertex.position)).collect();
    let (eye, (width, height)) = (camera.eye(1.0), camera.size_px);
    let raster = Raster::new(&eye, (width, height), Vec2::new(0.5, 0.5), &mesh.triangles, seen.clone(), false);
    let cells = f64::from(map.wanted.first) * f64::from(map.wanted.first);
    let pixels = own.paint.pixels();
    let rows = (0..height).into_par_iter().map(|y| {
        let (mut sum, mut count, mut reader) = (0_u64, 0_u64, Reader::new(map, arrays));
        let (mut depth, mut triangles) = (vec![f64::INFINITY; width], vec![NONE; width]);
        raster.row(y, Columns::All, &mut depth, &mut triangles);
        let known = |triangle: usize| {
            let corners = mesh.triangles[triangle];
            let share = share_of(corners.map(|corner| seen[corner as usize]), eye.focal_px);
            (corners.map(|corner| &mesh.vertices[corner as usize]), share * map.atlas.areas[triangle] * cells)
        };
        raster.hits(y, Columns::All, (&depth, &triangles), known, |x, hit, (corners, cells)| {
            let (mut point, mut normal) = (DVec3::ZERO, DVec3::ZERO);
            for (corner, weight) in corners.iter().zip(hit.weights) {
                point += corner.position * weight;
                normal += corner.normal * weight;
            }
            let (toward, depth) = ((camera.position - point).normalize_or_zero(), hit.depth);
            let picture = pixels[y * width + x];
            if picture[3] < 1.0 || normal.normalize_or_zero().dot(toward) < LEAST_NORMAL {
                return;
            }
            let depth = depth_of(cells * depth * depth * depth);
            let spot = Spot { triangle: hit.triangle, weights: hit.weights, point, eye: toward, depth };
            let [r, g, b] = reader.at(&spot, None).over.map(|light| light as f32);
            sum += squares([r, g, b, 1.0], picture);
            count += 3;
        });
        (sum, count)
    });
    let (sum, count) = rows.reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
    (count > 0).then(|| 10.0 / std::f64::consts::LN_10 * ln(255.0 * 255.0 * count as f64 / sum as f64))
}

/// The squares of the differences between codes.
fn squares(own: Rgba, picture: Rgba) -> u64 {
    let (own, picture) = (encode(own), encode(picture));
    own.iter().zip(picture).map(|(own, picture)| u64::from(own.abs_diff(picture)).pow(2)).sum()
}
