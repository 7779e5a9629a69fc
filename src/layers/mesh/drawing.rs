//! What a mesh asks of what is drawn on it: in the document ([`DrawingSlot`]), and made ([`ReadyDrawing`]); and what it hands out
//! for that ([`Given`]).

use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use glam::{DVec3, Vec3};
use serde_json::Value;

use super::pose::Placed;
use crate::base::mesh::Mesh;
use crate::base::pixels::Rgba;
use crate::base::problem::Problem;
use crate::layers::parts::marks::{Mark, View};
use crate::layers::parts::materials::Use;
use crate::layers::parts::measures::Measures;
use crate::layers::parts::pass::{Pass, Which};
use crate::layers::parts::plan::{Bind, Canvas, Plan};
use crate::layers::parts::readout::Entry;
use crate::layers::parts::sketch::Sketch;
use crate::layers::ready::Making;
use crate::layers::space::eye::Eye;

/// The interface of what is drawn on a mesh, in the document. Paths are relative to it.
pub trait DrawingSlot {
    /// The checks beyond shape.
    fn check(&self) -> Vec<Problem>;

    /// The problem with a mesh of this name that has no texture coordinates at a triangle.
    fn check_uv(&self, _mesh: &str, _triangle: usize) -> Option<Problem> {
        None
    }

    /// What it names.
    fn uses(&self) -> Vec<Use<'_>> {
        Vec::new()
    }

    /// Whether it changes while the time runs.
    fn moves(&self) -> bool {
        false
    }

    /// See `Technique::automatic`.
    fn automatic(&self, _path: &str) -> Option<Value> {
        None
    }

    /// See `Technique::laid`.
    fn laid(&self, _path: &str) -> Option<Vec<String>> {
        None
    }

    /// See `Technique::pass_names`.
    fn pass_names(&self, _pass: &Pass) -> Vec<&str> {
        Vec::new()
    }

    /// See `Technique::sketched`.
    fn sketched(&self) -> &'static [&'static str] {
        &[]
    }

    /// See `Technique::sketch`.
    fn sketch(&self, _path: &str) -> Option<Sketch> {
        None
    }

    /// Prepares it for a mesh and any time. What it has in common with what was made before for the same mesh is reused.
    ///
    /// # Errors
    /// If something that it names is not there, or there is too much of it.
    fn synth(&self, mesh: &Mesh, making: &Making, before: Before) -> Result<Arc<dyn ReadyDrawing>, Problem>;
}

/// What was made of a drawing before.
pub type Before<'a> = Option<&'a dyn ReadyDrawing>;

/// What is drawn on a mesh, ready for any time.
pub trait ReadyDrawing: Any + Debug + Send + Sync {
    /// Whether it needs the normals that pixels show.
    fn needs_normals(&self) -> bool {
        false
    }

    /// Whether it needs the light that falls there.
    fn needs_light(&self) -> bool {
        false
    }

    /// Writes what a pass has at every pixel that shows the layer, on the CPU: the reference.
    fn draw(&self, given: &Given, which: Which, out: &mut [Rgba]);

    /// Where the GPU draws what the layer shows: its shaded colors, and `Facts` in frame.wgsl.
    fn canvas(&self) -> Canvas;

    /// The same as [`ReadyDrawing::draw`] for the GPU, once what the layer shows is drawn: with textures for both. What pixels
    /// show is not given. `posed` is what binds the mesh; so much of the light comes from everywhere.
    fn plan(&self, given: &Given, ambient: f64, posed: &dyn Fn() -> Vec<Bind>) -> Plan;

    /// See `Ready::stoppable`.
    fn stoppable(&self, stop: &Arc<AtomicBool>) -> Arc<dyn ReadyDrawing>;

    /// The same for frames that are so many times smaller on each side.
    fn reduced(&self, by: usize) -> Arc<dyn ReadyDrawing>;

    /// What there is to say of pixel number `i` of the frame, which shows the layer.
    fn told(&self, _given: &Given, _i: usize) -> Vec<Entry> {
        Vec::new()
    }

    /// Whether a view shows something that explains it.
    fn explains(&self, _view: &View) -> bool {
        false
    }

    /// What explains it; paths are relative to the layer.
    fn marks(&self, _given: &Given, _view: &View) -> Vec<Mark> {
        Vec::new()
    }

    /// See `Technique::measure`.
    ///
    /// # Errors
    /// If there is nothing to measure; the path is relative to the drawing.
    fn measure(&self, _looking: Looking) -> Result<Option<Measures>, Problem> {
        Ok(None)
    }
}

impl dyn ReadyDrawing {
    /// The drawing as its own type, for its folder.
    pub fn downcast<T: ReadyDrawing>(&self) -> Option<&T> {
        (self as &dyn Any).downcast_ref()
    }
}

/// What a mesh layer hands out for what is drawn on it, at one time.
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
    /// The normal there, in the world; zero if it is not needed.
    pub normal: Vec<Vec3>,
    /// The shaded color there, premultiplied.
    pub shaded: Vec<Rgba>,
    /// The light that falls there; 0 if it is not needed.
    pub light: Vec<f32>,
}

/// How a layer is looked at to measure how what is drawn on it moves.
pub struct Looking<'a> {
    /// The camera that moves.
    pub eye: Eye,
    /// The middle of the layer; `None` if it is nowhere.
    pub middle: Option<DVec3>,
    /// How many steps each move has.
    pub steps: u32,
    /// Makes something of what a camera sees of the layer.
    pub see: &'a mut dyn FnMut(Eye, &mut dyn FnMut(&Given)),
    /// Is told how many frames are drawn of how many; `false` if it is cancelled.
    pub step: &'a mut dyn FnMut(u64, u64) -> bool,
}
