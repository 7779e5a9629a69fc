//! A mesh layer at one time, on the CPU: the reference.

use glam::{DVec2, DVec3};
use kurbo::Vec2;
use rayon::prelude::*;

use super::model::Sides;
use super::pose::Placed;
use super::surface::StillSurface;
use super::synth::Synth;
use crate::base::mesh::Mesh;
use crate::base::pixels::Rgba;
use crate::layers::parts::moment::{Columns, Moment};
use crate::layers::parts::pass::{self, Pass};
use crate::layers::ready::Still;
use crate::layers::space::raster::{Hit, NONE, Raster};

/// Where a mesh is in the frame at one time.
pub struct View<'a> {
    mesh: &'a Mesh,
    /// The vertices in the world: where they are, and their normals.
    world: Vec<(DVec3, DVec3)>,
    /// `None` if there is no camera.
    raster: Option<Raster<'a>>,
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
}

impl<'a> View<'a> {
    /// The mesh in a pose, seen at `place` in each pixel.
    pub fn new(mesh: &'a Mesh, sides: Sides, placed: &Placed, place: Vec2, moment: &Moment) -> Self {
        let vertices = mesh.vertices.par_iter();
        let world: Vec<(DVec3, DVec3)> = vertices.map(|vertex| placed.point(vertex.position, vertex.normal)).collect();
        let raster = moment.eye.map(|eye| {
            let seen = world.par_iter().map(|(position, _)| eye.seen(*position)).collect();
            Raster::new(&eye, moment.size_px, place, &mesh.triangles, seen, sides == Sides::Both)
        });
        View { mesh, world, raster }
    }

    /// Calls `each` with every wanted cell of row `y` that shows the mesh nearer than `depth`, which becomes its depth.
    #[inline]
    fn row_of(&self, y: usize, columns: Columns, depth: &mut [f64], mut each: impl FnMut(usize, Spot)) {
        let Some(raster) = &self.raster else { return };
        let mut triangles = vec![NONE; depth.len()];
        raster.row(y, columns, depth, &mut triangles);
        let corners = |triangle: usize| {
            self.mesh.triangles[triangle].map(|i| (self.world[i as usize], self.mesh.vertices[i as usize].uv))
        };
        let found = (&*depth, &*triangles);
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
pub struct Seen<'a> {
    view: View<'a>,
    /// Where the light comes from, of length 1, and the share of it that comes from everywhere.
    light: (DVec3, f64),
    surface: Box<dyn StillSurface + 'a>,
}

impl<'a> Seen<'a> {
    /// The layer at one time.
    pub fn new(synth: &'a Synth, moment: &'a Moment) -> Self {
        let placed = synth.pose.at(synth.time(moment));
        let view = View::new(&synth.mesh, synth.sides, &placed, synth.place, moment);
        Seen { view, light: (synth.light.toward(), synth.light.ambient), surface: synth.surface.at(moment) }
    }

    /// The light that a spot sends to the camera: linear, premultiplied.
    fn shaded(&self, spot: &Spot) -> Rgba {
        let (toward, ambient) = self.light;
        let light = (ambient + (1.0 - ambient) * spot.normal.dot(toward).max(0.0)) as f32;
        let [r, g, b, a] = self.surface.color(spot.uv);
        [r * light, g * light, b * light, a]
    }
}

impl Still for Seen<'_> {
    fn row(&self, y: usize, columns: Columns, out: &mut [Rgba]) {
        self.surface(y, columns, &mut vec![f64::INFINITY; out.len()], out);
    }

    fn surface(&self, y: usize, columns: Columns, depth: &mut [f64], out: &mut [Rgba]) {
        self.view.row_of(y, columns, depth, |cell, spot| out[cell] = self.shaded(&spot));
    }

    fn pass(&self, pass: &Pass, y: usize, columns: Columns, depth: &mut [f64], out: &mut [Rgba]) {
        self.view.row_of(y, columns, depth, |cell, spot| {
            let [x, y, z] = match pass.name {
                name if name == pass::DEPTH.name => [spot.hit.depth; 3],
                name if name == pass::NORMAL.name => spot.normal.to_array(),
                name if name == pass::UV.name => [spot.uv.x, spot.uv.y, spot.hit.triangle as f64 + 1.0],
                name if name == pass::SHADE.name => {
                    out[cell] = self.shaded(&spot);
                    return;
                }
                _ => return,
            };
            out[cell] = [x as f32, y as f32, z as f32, 1.0];
        });
    }
}
