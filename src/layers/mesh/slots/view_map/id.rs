//! What a view sees: which triangle is at each pixel of a picture twice as large as its own, and what that tells.

use glam::{DVec2, DVec3};
use kurbo::Vec2;
use rayon::prelude::*;

use super::atlas::{self, Atlas};
use super::camera::Camera;
use crate::base::maths::{ln_in_loops, smoothstep};
use crate::base::mesh::Mesh;
use crate::layers::parts::moment::Columns;
use crate::layers::space::raster::{Hit, NONE, Raster};

/// How many times larger than the picture the image of triangles is.
pub const TIMES: usize = 2;
/// The least cosine between the normal of a triangle and the way to the camera.
const LEAST_FACE: f64 = 0.05;
/// The same for the normal between corners, and what more it takes to count in full.
const LEAST_NORMAL: f64 = 0.1;
/// How much counts what is seen at the least angle.
const LEAST_FACING: f64 = 0.01;
/// A step in depth, in pixels of the image of triangles at that depth.
const STEP_PX: f64 = 20.0;
/// The depth of what is not there.
const NOWHERE_M: f64 = 1e30;
/// Rows that are computed as one piece.
const BAND: usize = 32;

/// A used pixel of the image of triangles.
#[derive(Clone, Copy, Debug)]
pub struct Pixel {
    /// The pixel of the picture that it is in.
    pub at: u32,
    /// The chart that it shows.
    pub chart: u32,
    /// Where in the chart, in cells of [`Pixel::FINEST`].
    pub x: u32,
    /// The same, down.
    pub y: u32,
    /// Its depth in layers.
    pub depth: f64,
    /// How many cells of layer 0 it covers.
    pub share: f64,
    /// How much it counts by the angle that it is seen at; 0 where it does not, but for the depth of the view.
    pub facing: f64,
}

impl Pixel {
    /// The layer whose cells places are told in: the finest that there may be.
    pub const FINEST: usize = 8;
}

/// What a view sees.
#[derive(Debug, Default)]
pub struct Seen {
    /// The used pixels, row by row, in pieces.
    pub bands: Vec<Vec<Pixel>>,
    /// The mean of their depths.
    pub depth: Option<f64>,
}

/// The number of a layer whose cells are as large as what covers so many cells of layer 0.
#[inline]
pub fn depth_of(cells: f64) -> f64 {
    ln_in_loops(cells) * (-0.5 / std::f64::consts::LN_2)
}

/// The share of a triangle's area that a pixel shows, but for the third power of its depth.
#[inline]
pub fn share_of(seen: [DVec3; 3], focal_px: f64) -> f64 {
    let volume = seen[0].dot(seen[1].cross(seen[2])).abs();
    2.0 / (focal_px * focal_px * volume)
}

/// A mesh as a camera sees it.
struct SeenMesh<'a> {
    mesh: &'a Mesh,
    atlas: &'a Atlas,
    camera: &'a Camera,
    raster: Raster<'a>,
    /// Cells of layer 0 in a unit of the atlas.
    first: f64,
}

/// What is known of a triangle.
struct Facet {
    corners: [DVec3; 3],
    normals: [DVec3; 3],
    flat: [DVec2; 3],
    outward: DVec3,
    chart: u32,
    /// How many cells of layer 0 a pixel of the picture covers, but for the third power of its depth.
    cells: f64,
}

impl Seen {
    /// What a camera sees of a mesh; `first` is how many cells of layer 0 are in a unit of the atlas. Pixels within
    /// `edge` of the picture beside steps in depth have no colors.
    pub fn new(mesh: &Mesh, atlas: &Atlas, camera: &Camera, first: u32, edge: f64) -> Seen {
        let eye = camera.eye(TIMES as f64);
        let size = (camera.size_px.0 * TIMES, camera.size_px.1 * TIMES);
        let seen = mesh.vertices.iter().map(|vertex| camera.seen(vertex.position)).collect();
        let raster = Raster::new(&eye, size, Vec2::new(0.5, 0.5), &mesh.triangles, seen, true);
        let sight = SeenMesh { mesh, atlas, camera, raster, first: f64::from(first) };
        let left_out = if edge > 0.0 { sight.beside_steps(size, edge) } else { Vec::new() };
        let bands = (0..size.1.div_ceil(BAND)).into_par_iter().map(|band| {
            let rows = band * BAND..((band + 1) * BAND).min(size.1);
            let mut out = Vec::with_capacity(rows.len() * size.0);
            let nowhere = vec![false; if left_out.is_empty() { size.0 } else { 0 }];
            for y in rows {
                let left_out = if left_out.is_empty() { &nowhere } else { &left_out[y * size.0..][..size.0] };
                sight.row(y, left_out, &mut out);
            }
            out.shrink_to_fit();
            out
        });
        let bands: Vec<Vec<Pixel>> = bands.collect();
        let (sum, count) = bands.iter().flatten().fold((0.0, 0.0), |(sum, n), pixel| (sum + pixel.depth, n + 1.0));
        Seen { bands, depth: (count > 0.0).then(|| sum / count) }
    }

    /// The memory that it takes.
    pub fn bytes(&self) -> usize {
        self.bands.iter().map(|band| band.capacity() * size_of::<Pixel>()).sum()
    }
}

impl SeenMesh<'_> {
    fn facet(&self, triangle: usize) -> Facet {
        let vertices = self.mesh.triangles[triangle].map(|corner| &self.mesh.vertices[corner as usize]);
        let corners = vertices.map(|vertex| vertex.position);
        let per_area = share_of(corners.map(|corner| self.camera.seen(corner)), self.camera.focal_px.x);
        Facet {
            corners,
            normals: vertices.map(|vertex| vertex.normal),
            flat: self.atlas.corners[triangle],
            outward: atlas::normal(self.mesh, triangle).normalize_or_zero(),
            chart: self.atlas.chart[triangle],
            cells: per_area * self.atlas.areas[triangle] * self.first * self.first,
        }
    }

    /// The used pixels of row `y`; those that are left out have no colors.
    fn row(&self, y: usize, left_out: &[bool], out: &mut Vec<Pixel>) {
        let width = left_out.len();
        let (mut depth, mut triangles) = (vec![f64::INFINITY; width], vec![NONE; width]);
        self.raster.row(y, Columns::All, &mut depth, &mut triangles);
        let at = y / TIMES * self.camera.size_px.0;
        let facet = |triangle: usize| self.facet(triangle);
        self.raster.hits(y, Columns::All, (&depth, &triangles), facet, |x, hit, facet| {
            if let Some(mut pixel) = self.pixel(&hit, facet) {
                pixel.at = (at + x / TIMES) as u32;
                pixel.facing = if left_out[x] { 0.0 } else { pixel.facing };
                out.push(pixel);
            }
        });
    }

    #[inline]
    fn pixel(&self, hit: &Hit, facet: &Facet) -> Option<Pixel> {
        let [a, b, c] = hit.weights;
        let mixed = |of: &[DVec3; 3]| of[0] * a + of[1] * b + of[2] * c;
        let toward = self.camera.position - mixed(&facet.corners);
        let far = toward.length_squared();
        let face = facet.outward.dot(toward);
        let cells = facet.cells * hit.depth * hit.depth * hit.depth;
        // A triangle without area in the atlas shows no cell.
        if !(face > 0.0 && face * face >= LEAST_FACE * LEAST_FACE * far && cells > 0.0) {
            return None;
        }
        let facing = facing(mixed(&facet.normals), toward, far)?;
        let fine = self.first * f64::from(1 << Pixel::FINEST);
        let at = atlas::mixed(&facet.flat, hit.weights) * fine;
        Some(Pixel {
            at: 0,
            chart: facet.chart,
            x: at.x as u32,
            y: at.y as u32,
            depth: depth_of(cells),
            share: cells / (TIMES * TIMES) as f64,
            facing,
        })
    }

    /// Which pixels are at steps in depth, or so near to them.
    fn beside_steps(&self, (width, height): (usize, usize), edge: f64) -> Vec<bool> {
        let mut depth = vec![f64::INFINITY; width * height];
        depth.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, row)| {
            self.raster.row(y, Columns::All, row, &mut vec![NONE; width]);
            row.iter_mut().filter(|depth| !depth.is_finite()).for_each(|depth| *depth = NOWHERE_M);
        });
        let most = STEP_PX / (self.camera.focal_px.x * TIMES as f64);
        let mut steps = vec![false; depth.len()];
        let mut compare = |a: usize, b: usize| {
            if (depth[a] - depth[b]).abs() > most * depth[a].min(depth[b]) {
                (steps[a], steps[b]) = (true, true);
            }
        };
        for i in 0..depth.len() {
            if (i + 1) % width != 0 {
                compare(i, i + 1);
            }
            if i + width < depth.len() {
                compare(i, i + width);
            }
        }
        let reach = (TIMES as f64 * edge).ceil() as usize;
        spread(&mut steps, width, height, reach, (1, width));
        spread(&mut steps, height, width, reach, (width, 1));
        steps
    }
}

/// How much counts what has this normal and is seen along this way, whose square is known; nothing if it is too oblique.
#[inline]
fn facing(normal: DVec3, toward: DVec3, far: f64) -> Option<f64> {
    let (along, whole) = (normal.dot(toward), far * normal.length_squared());
    let beyond = |cosine: f64| along > 0.0 && along * along >= cosine * cosine * whole;
    // Most need no root.
    if beyond(2.0 * LEAST_NORMAL) {
        return Some(1.0);
    }
    let part = || along / whole.sqrt() / LEAST_NORMAL - 1.0;
    beyond(LEAST_NORMAL).then(|| LEAST_FACING + (1.0 - LEAST_FACING) * smoothstep(0.0, 1.0, part()))
}

/// Makes true what is within `reach` of something true in each of `lines` lines of cells.
fn spread(cells: &mut [bool], length: usize, lines: usize, reach: usize, (along, across): (usize, usize)) {
    let mut near = vec![false; length];
    for line in 0..lines {
        near.fill(false);
        let at = |i: usize| line * across + i * along;
        let mark = |order: &mut dyn Iterator<Item = usize>, near: &mut [bool], cells: &[bool]| {
            let mut left = 0;
            for i in order {
                left = if cells[at(i)] { reach + 1 } else { left };
                near[i] |= left > 0;
                left = left.saturating_sub(1);
            }
        };
        mark(&mut (0..length), &mut near, cells);
        mark(&mut (0..length).rev(), &mut near, cells);
        near.iter().enumerate().for_each(|(i, near)| cells[at(i)] = *near);
    }
}
