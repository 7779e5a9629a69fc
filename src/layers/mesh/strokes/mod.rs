//! Strokes that a mesh is drawn with (after Benard, Lagae et al. 2010, "A Dynamic Noise Primitive for Coherent
//! Stylization"): a sum of many small waves whose centers are fixed to the surface while their size, spacing and direction
//! are those of the screen; and what is drawn from that noise and the tones of the surface. The mesh layer hands out what
//! a frame shows of it ([`Given`]) and gets it back drawn.

pub mod aim;
pub mod bins;
pub mod check;
pub mod curvature;
pub mod curves;
pub mod draw;
pub mod emit;
pub mod even;
pub mod explain;
pub mod flat;
pub mod force;
pub mod grid;
pub mod impulse;
pub mod ink;
pub mod level;
pub mod marks;
pub mod measure;
pub mod model;
pub mod noise;
pub mod overlays;
pub mod passes;
pub mod pieces;
pub mod plan;
pub mod restyle;
pub mod rim;
pub mod sketch;
pub mod styles;
pub mod sum;
pub mod surface;
pub mod synth;
#[cfg(test)]
mod tests;
pub mod tone;
pub mod upload;
pub mod visible;

use glam::{DVec3, Vec3};

pub use self::force::Strokes;
pub use self::synth::Ready;
use super::pose::Placed;
use crate::base::mesh::Mesh;
use crate::base::pixels::Rgba;
use crate::layers::space::eye::Eye;

/// What a mesh layer hands out for its strokes, at one time.
pub struct Given<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// Its vertices in the world: where they are, and their normals. Empty, as the pixels below, where the device draws.
    pub world: &'a [(DVec3, DVec3)],
    /// How it is placed.
    pub placed: &'a Placed,
    /// Whether back sides are seen.
    pub both: bool,
    /// Where the light comes from, in the world.
    pub toward: DVec3,
    /// From where it is seen.
    pub eye: Eye,
    /// Width and height of the frame, in pixels.
    pub size_px: (usize, usize),
    /// How many times larger than that of the scene the frame is.
    pub magnified: f64,
    /// The scene time.
    pub t: f64,
    /// 1 / depth of whatever each pixel shows; 0 if it shows nothing.
    pub inverse: Vec<f64>,
    /// The triangle of the layer that each pixel shows; `raster::NONE` where it shows none.
    pub triangle: Vec<u32>,
    /// The normal there, in the world; zero if no mark has creases.
    pub normal: Vec<Vec3>,
    /// The shaded color there, premultiplied.
    pub shaded: Vec<Rgba>,
    /// The light that falls there; empty if tones do not depend on it.
    pub light: Vec<f32>,
}
