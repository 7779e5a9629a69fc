//! A map drawn again from the camera of one of its views, pixel for pixel of its picture.

use glam::DVec3;
use kurbo::Vec2;
use rayon::prelude::*;

use super::arrays::Arrays;
use super::blend::Points;
use super::id::{depth_of, share_of};
use super::looked::Filled;
use super::map::{KEPT_BYTES, Map, Wanted};
use super::sample::{Reader, Spot};
use super::view::View;
use crate::base::pixels::{Linear, Rgba};
use crate::base::progress::Watch;
use crate::layers::parts::moment::Columns;
use crate::layers::space::raster::{NONE, Raster};

/// A map as a view sees it.
pub struct Again<'a> {
    map: &'a Map,
    view: &'a View,
    /// The corners of the mesh in the view's camera.
    seen: Vec<DVec3>,
    raster: Raster<'a>,
    /// Cells of layer 0 in the square of the atlas.
    cells: f64,
}

impl<'a> Again<'a> {
    /// The map as `view` sees it, which need not be one of its own.
    pub fn new(map: &'a Map, view: &'a View) -> Again<'a> {
        let (camera, mesh) = (&view.camera, &map.wanted.mesh);
        let seen: Vec<DVec3> = mesh.vertices.iter().map(|vertex| camera.seen(vertex.position)).collect();
        let (eye, middle) = (camera.eye(1.0), Vec2::new(0.5, 0.5));
        let raster = Raster::new(&eye, camera.size_px, middle, &mesh.triangles, seen.clone(), false);
        Again { map, view, seen, raster, cells: f64::from(map.wanted.first) * f64::from(map.wanted.first) }
    }

    /// Calls `each` with every pixel of row `y` that shows the mesh: its column, the cosine between the normal and the way to
    /// the camera, and the place.
    pub fn row(&self, y: usize, mut each: impl FnMut(usize, f64, &Spot)) {
        let (camera, mesh, width) = (&self.view.camera, &self.map.wanted.mesh, self.view.camera.size_px.0);
        let (mut depth, mut triangles) = (vec![f64::INFINITY; width], vec![NONE; width]);
        self.raster.row(y, Columns::All, &mut depth, &mut triangles);
        let known = |triangle: usize| {
            let corners = mesh.triangles[triangle];
            let share = share_of(corners.map(|corner| self.seen[corner as usize]), camera.focal_px.x);
            (corners.map(|corner| &mesh.vertices[corner as usize]), share * self.map.atlas.areas[triangle] * self.cells)
        };
        self.raster.hits(y, Columns::All, (&depth, &triangles), known, |x, hit, (corners, cells)| {
            let (mut point, mut normal) = (DVec3::ZERO, DVec3::ZERO);
            for (corner, weight) in corners.iter().zip(hit.weights) {
                point += corner.position * weight;
                normal += corner.normal * weight;
            }
            let (eye, depth) = ((camera.position - point).normalize_or_zero(), hit.depth);
            let depth = depth_of(cells * depth * depth * depth);
            let spot = Spot { triangle: hit.triangle, weights: hit.weights, point, eye, depth };
            each(x, normal.normalize_or_zero().dot(eye), &spot);
        });
    }
}

/// What the view of this number in the document sees of the map without it; `None` if the map is not made of it, or it was stopped.
pub fn without((map, arrays): Filled, points: &Points, number: usize, watch: &Watch) -> Option<Linear> {
    let view = map.wanted.views.iter().find(|view| view.number == number)?;
    let views = map.wanted.views.iter().filter(|other| other.number != number).cloned().collect();
    let wanted = Wanted { levels: Some(map.cells.layers.len()), views, ..map.wanted.clone() };
    let left = Map::new(wanted, Some(map), KEPT_BYTES, watch)?;
    let arrays = arrays.and_then(|arrays| Arrays::new(&left, arrays.side(), watch.stopped));
    Some(seen((&left, arrays.as_ref()), points, view, watch))
}

/// What a view sees of a map; less if it was stopped.
pub fn seen((map, arrays): Filled, points: &Points, view: &View, watch: &Watch) -> Linear {
    let (again, (width, height)) = (Again::new(map, view), view.camera.size_px);
    let base = points.at(view.camera.position, -view.camera.axes()[2]);
    let mut picture: Vec<Rgba> = vec![[0.0; 4]; width * height];
    picture.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, row)| {
        if (watch.stopped)() {
            return;
        }
        let mut reader = Reader::new(map, arrays);
        again.row(y, |x, _, spot| {
            let [r, g, b] = reader.at(spot, None).shown(base).map(|light| light as f32);
            row[x] = [r, g, b, 1.0];
        });
    });
    Linear::from_cells(width, height, picture)
}
