//! A mesh layer at one time, on the CPU: the reference.

use std::sync::OnceLock;

use glam::{DVec2, DVec3, Vec3};
use kurbo::Vec2;
use rayon::prelude::*;

use super::added::Added;
use super::drawing::{Given, ReadyDrawing};
use super::model::Sides;
use super::pose::Placed;
use super::slots;
use super::surface::{Reader, StillSurface, SurfacePoint};
use super::synth::Synth;
use crate::base::mesh::Mesh;
use crate::base::pixels::Rgba;
use crate::layers::parts::moment::{Columns, Moment};
use crate::layers::parts::pass::{self, Pass, Which};
use crate::layers::ready::{Still, Surfaces};
use crate::layers::space::raster::{Hit, NONE, Raster};

/// Where a mesh is in the frame at one time.
pub struct PosedMesh<'a> {
    mesh: &'a Mesh,
    /// The vertices in the world: where they are, and their normals.
    world: Vec<(DVec3, DVec3)>,
    /// `None` if there is no camera.
    raster: Option<Raster<'a>>,
}

/// The vertices of a mesh in the world: where they are, and their normals.
pub fn world(mesh: &Mesh, placed: &Placed) -> Vec<(DVec3, DVec3)> {
    mesh.vertices.par_iter().map(|vertex| placed.point(vertex.position, vertex.normal)).collect()
}

/// What is known of one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// The triangle there.
    pub hit: Hit,
    /// The place in the world.
    pub position: DVec3,
    /// The normal in the world, of length 1.
    pub normal: DVec3,
    /// The texture coordinates.
    pub uv: DVec2,
}

impl Spot {
    /// Between corners: where they are in the world with their normals, and their texture coordinates.
    #[inline]
    fn new(hit: Hit, corners: &[((DVec3, DVec3), DVec2); 3]) -> Spot {
        let mut spot = Spot { hit, position: DVec3::ZERO, normal: DVec3::ZERO, uv: DVec2::ZERO };
        for (((position, normal), uv), weight) in corners.iter().zip(hit.weights) {
            spot.position += position * weight;
            spot.normal += normal * weight;
            spot.uv += uv * weight;
        }
        spot.normal = spot.normal.normalize_or_zero();
        if !hit.front {
            spot.normal = -spot.normal;
        }
        spot
    }

    /// The place on the surface.
    pub fn place(&self) -> SurfacePoint {
        SurfacePoint { hit: self.hit, position: self.position, uv: self.uv }
    }
}

impl<'a> PosedMesh<'a> {
    /// The mesh in a pose, seen at `place` in each pixel.
    pub fn new(mesh: &'a Mesh, sides: Sides, placed: &Placed, place: Vec2, moment: &Moment) -> Self {
        let world = world(mesh, placed);
        let raster = moment.eye.map(|eye| {
            let seen = world.par_iter().map(|(position, _)| eye.seen(*position)).collect();
            Raster::new(&eye, moment.size_px, place, &mesh.triangles, seen, sides == Sides::Both)
        });
        PosedMesh { mesh, world, raster }
    }

    /// Calls `each` with every wanted cell of row `y` that shows the mesh nearer than `depth`, which becomes its depth.
    #[inline]
    fn row_of(&self, y: usize, columns: Columns, depth: &mut [f64], each: impl FnMut(usize, Spot)) {
        let triangles = self.triangles(y, columns, depth);
        self.spots(y, columns, (depth, &triangles), each);
    }

    /// The triangle that each wanted cell of row `y` shows nearer than `depth`, which becomes its depth, or [`NONE`].
    fn triangles(&self, y: usize, columns: Columns, depth: &mut [f64]) -> Vec<u32> {
        let mut triangles = vec![NONE; depth.len()];
        if let Some(raster) = &self.raster {
            raster.row(y, columns, depth, &mut triangles);
        }
        triangles
    }

    /// Calls `each` with every wanted cell of row `y` that shows one of these triangles at these depths.
    #[inline]
    fn spots(&self, y: usize, columns: Columns, found: (&[f64], &[u32]), mut each: impl FnMut(usize, Spot)) {
        let Some(raster) = &self.raster else { return };
        let corners = |triangle: usize| {
            self.mesh.triangles[triangle].map(|i| (self.world[i as usize], self.mesh.vertices[i as usize].uv))
        };
        raster.hits(y, columns, found, corners, |cell, hit, corners| each(cell, Spot::new(hit, corners)));
    }

    /// What the pixel in column `x`, row `y` shows.
    pub fn at(&self, x: usize, y: usize) -> Option<Spot> {
        let mut found = None;
        self.row_of(y, Columns::Some(&[x]), &mut [f64::INFINITY], |_, spot| found = Some(spot));
        found
    }
}

/// A mesh layer at one time.
pub struct MeshAt<'a> {
    synth: &'a Synth,
    moment: &'a Moment,
    placed: Placed,
    view: PosedMesh<'a>,
    /// Where the light comes from, of length 1, and the share of it that comes from everywhere.
    light: (DVec3, f64),
    surface: Box<dyn StillSurface + 'a>,
    /// The frame of the layer alone, if it is drawn with strokes, once it is needed.
    alone: OnceLock<Vec<Rgba>>,
}

impl<'a> MeshAt<'a> {
    /// The layer at one time.
    pub fn new(synth: &'a Synth, moment: &'a Moment) -> Self {
        let placed = synth.pose.at(synth.time(moment));
        let view = PosedMesh::new(&synth.mesh, synth.sides, &placed, synth.place(moment), moment);
        let light = (synth.light.toward(), synth.light.ambient);
        MeshAt {
            synth,
            moment,
            placed,
            view,
            light,
            surface: synth.surface.at(moment, &placed),
            alone: OnceLock::new(),
        }
    }

    /// How much light falls on a spot.
    fn lit(&self, spot: &Spot) -> f32 {
        let (toward, ambient) = self.light;
        (ambient + (1.0 - ambient) * spot.normal.dot(toward).max(0.0)) as f32
    }

    /// The light that a spot sends to the camera: linear, premultiplied.
    fn shaded(&self, spot: &Spot, reader: &mut Reader) -> Rgba {
        let light = if self.surface.is_lit() { self.lit(spot) } else { 1.0 };
        let [r, g, b, a] = reader(&spot.place());
        [r * light, g * light, b * light, a]
    }

    /// What its strokes are drawn from; `None` without a camera.
    fn given(&self, strokes: &dyn ReadyDrawing, surfaces: &Surfaces) -> Option<Given<'_>> {
        // Memory that nothing is written to is never touched.
        let (normals, lights) = (strokes.needs_normals(), strokes.needs_light());
        let (width, count) = (self.moment.size_px.0.max(1), surfaces.depth.len());
        let mut given = Given {
            mesh: &self.synth.mesh,
            world: &self.view.world,
            placed: &self.placed,
            both: self.synth.sides == Sides::Both,
            toward: self.light.0,
            eye: self.moment.eye?,
            size_px: self.moment.size_px,
            magnified: f64::from(self.moment.magnified),
            t: self.synth.time(self.moment),
            inverse: surfaces.depth.par_iter().map(|depth| 1.0 / depth).collect(),
            triangle: vec![NONE; count],
            normal: vec![Vec3::ZERO; count],
            shaded: vec![[0.0; 4]; count],
            light: vec![0.0; count],
        };
        let cells = given.triangle.par_chunks_mut(width).zip(given.normal.par_chunks_mut(width));
        let cells = cells.zip(given.shaded.par_chunks_mut(width)).zip(given.light.par_chunks_mut(width));
        cells.enumerate().for_each(|(y, (((triangle, normal), shaded), light))| {
            let row = y * width..(y + 1) * width;
            let parts = surfaces.layer[row.clone()].iter().zip(&surfaces.part[row.clone()]);
            let own = parts.map(|(layer, part)| if *layer == surfaces.own { *part } else { NONE });
            triangle.iter_mut().zip(own).for_each(|(triangle, own)| *triangle = own);
            let mut reader = self.surface.reader();
            self.view.spots(y, Columns::All, (&surfaces.depth[row], triangle), |x, spot| {
                shaded[x] = self.shaded(&spot, &mut reader);
                if normals {
                    normal[x] = spot.normal.as_vec3();
                }
                if lights {
                    light[x] = self.lit(&spot);
                }
            });
        });
        Some(given)
    }

    /// The frame of the layer alone, without strokes.
    pub fn bare(&self) -> Vec<Rgba> {
        let (width, height) = self.moment.size_px;
        let mut out = vec![[0.0; 4]; width * height];
        let rows = out.par_chunks_mut(width.max(1)).enumerate();
        rows.for_each(|(y, row)| self.surface(y, Columns::All, &mut vec![f64::INFINITY; row.len()], row));
        out
    }

    /// Makes something of the surfaces of a frame in which nothing else is.
    fn by_itself<R>(&self, make: impl FnOnce(&Surfaces) -> R) -> R {
        let (width, height) = self.moment.size_px;
        let mut depth = vec![f64::INFINITY; width * height];
        let mut part = vec![NONE; depth.len()];
        let rows = depth.par_chunks_mut(width.max(1)).zip(part.par_chunks_mut(width.max(1))).enumerate();
        rows.for_each(|(y, (depth, part))| self.parts(y, depth, part));
        make(&Surfaces { depth: &depth, layer: &vec![0; depth.len()], part: &part, own: 0 })
    }

    /// What its strokes are drawn from if nothing else is there.
    pub fn given_alone(&self) -> Option<Given<'_>> {
        let strokes = self.synth.strokes.as_deref()?;
        self.by_itself(|surfaces| self.given(strokes, surfaces))
    }

    /// The frame of the layer alone, with its strokes.
    fn alone(&self) -> Vec<Rgba> {
        let mut out = vec![[0.0; 4]; self.moment.size_px.0 * self.moment.size_px.1];
        let which = Which { pass: &pass::COLOR, of: None };
        self.by_itself(|surfaces| self.strokes(which, surfaces, &mut out));
        out
    }
}

impl Still for MeshAt<'_> {
    fn row(&self, y: usize, columns: Columns, out: &mut [Rgba]) {
        if self.synth.strokes.is_none() {
            return self.surface(y, columns, &mut vec![f64::INFINITY; out.len()], out);
        }
        let alone = self.alone.get().unwrap_or_else(|| {
            // On all cores, so nobody may wait for it: a thread that does could be the one that is needed.
            let made = self.alone();
            self.alone.get_or_init(|| made)
        });
        let row = &alone[y * self.moment.size_px.0..];
        out.iter_mut().enumerate().for_each(|(cell, out)| *out = row[columns.at(cell)]);
    }

    fn strokes(&self, which: Which, surfaces: &Surfaces, out: &mut [Rgba]) {
        let Some(strokes) = self.synth.strokes.as_deref() else { return };
        if let Some(given) = self.given(strokes, surfaces) {
            strokes.draw(&given, which, out);
        }
    }

    fn surface(&self, y: usize, columns: Columns, depth: &mut [f64], out: &mut [Rgba]) {
        let mut reader = self.surface.reader();
        self.view.row_of(y, columns, depth, |cell, spot| out[cell] = self.shaded(&spot, &mut reader));
    }

    fn parts(&self, y: usize, depth: &mut [f64], parts: &mut [u32]) {
        let triangles = self.view.triangles(y, Columns::All, depth);
        let nearer = parts.iter_mut().zip(triangles).filter(|(_, triangle)| *triangle != NONE);
        nearer.for_each(|(part, triangle)| *part = triangle);
    }

    fn pass(&self, pass: &Pass, y: usize, columns: Columns, depth: &mut [f64], out: &mut [Rgba]) {
        let Added { passes, colors, .. } = slots::OF_SURFACES;
        if passes.contains(pass) || colors.contains(pass) {
            // Other surfaces have nothing there, and hide what is behind them.
            let mut reader = self.surface.pass(pass);
            let mut read = |spot: &Spot| reader.as_mut().map_or([0.0; 4], |reader| reader(&spot.place()));
            return self.view.row_of(y, columns, depth, |cell, spot| out[cell] = read(&spot));
        }
        let mut reader = self.surface.reader();
        self.view.row_of(y, columns, depth, |cell, spot| {
            let [x, y, z] = match pass.name {
                name if name == pass::DEPTH.name => [spot.hit.depth; 3],
                name if name == pass::NORMAL.name => spot.normal.to_array(),
                name if name == pass::UV.name => [spot.uv.x, spot.uv.y, spot.hit.triangle as f64 + 1.0],
                name if name == pass::SHADE.name => {
                    out[cell] = self.shaded(&spot, &mut reader);
                    return;
                }
                _ => return,
            };
            out[cell] = [x as f32, y as f32, z as f32, 1.0];
        });
    }
}
