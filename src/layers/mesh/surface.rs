//! What a mesh asks of its surface: in the document ([`SurfaceSlot`]), made ([`ReadySurface`]), and at one time ([`StillSurface`]).

use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use serde_json::Value;

use super::pose::Placed;
use crate::base::error::Error;
use crate::base::mesh::Mesh;
use crate::base::pixels::{Linear, Rgba};
use crate::base::problem::Problem;
use crate::base::progress::Watch;
use crate::base::reduce::Reduced;
use crate::layers::parts::bundle::{Form, Sink};
use crate::layers::parts::marks::{self, Mark};
use crate::layers::parts::materials::{Materials, Use};
use crate::layers::parts::moment::Moment;
use crate::layers::parts::pass::Pass;
use crate::layers::parts::plan::{Bind, Program};
use crate::layers::parts::readout::Entry;
use crate::layers::parts::shots::{Lying, Painted, Put};
use crate::layers::ready::Making;
use crate::layers::space::eye::Ray;
use crate::layers::space::raster::Hit;

/// The interface of a kind of surface in the document. Paths are relative to it.
pub trait SurfaceSlot {
    /// The checks beyond shape.
    fn check(&self) -> Vec<Problem> {
        Vec::new()
    }

    /// What only shows with the files that it names.
    fn check_materials(&self, _materials: &Materials) -> Vec<Problem> {
        Vec::new()
    }

    /// What is odd about how pictures lie on this mesh.
    fn check_lying(&self, _mesh: &Mesh) -> Vec<Problem> {
        Vec::new()
    }

    /// What it names.
    fn uses(&self) -> Vec<Use<'_>> {
        Vec::new()
    }

    /// Whether the mesh needs texture coordinates.
    fn needs_uv(&self) -> bool {
        false
    }

    /// Its files for other engines, and what their names end in.
    fn files(&self) -> Vec<(Form, String)> {
        Vec::new()
    }

    /// See `Technique::pass_colors`.
    fn pass_colors(&self, _pass: &Pass) -> Vec<(&str, [u8; 3])> {
        Vec::new()
    }

    /// Whether it tells something of each of its places ([`StillSurface::told`]) and has passes.
    fn explains(&self) -> bool {
        false
    }

    /// What is odd about it that only shows once it is made.
    fn check_made(&self, _made: &dyn ReadySurface) -> Vec<Problem> {
        Vec::new()
    }

    /// The pictures with cameras that lie on it; `None` if it is of a kind without.
    fn lying(&self) -> Option<Vec<Lying<'_>>> {
        None
    }

    /// The name of the item at `path`, if it is in a list whose items have names.
    fn item_name(&self, _path: &str) -> Option<&str> {
        None
    }

    /// Prepares it for a mesh and any time. What it has in common with what was made before is reused.
    ///
    /// # Errors
    /// If something that it names is not there or does not fit, or it is cancelled.
    fn synth(&self, mesh: &Arc<Mesh>, making: &Making, before: Before) -> Result<Arc<dyn ReadySurface>, Problem>;
}

/// What was made of a surface before.
pub type Before<'a> = Option<&'a dyn ReadySurface>;

/// A surface ready for any time.
pub trait ReadySurface: Any + Debug + Send + Sync {
    /// The surface of a mesh that is placed so, at one time, on the CPU: the reference.
    fn at<'a>(&'a self, moment: &'a Moment, placed: &Placed) -> Box<dyn StillSurface + 'a>;

    /// The same for the GPU.
    fn plan(&self, moment: &Moment, placed: &Placed) -> Look;

    /// See `Ready::by_cpu`.
    fn by_cpu(&self) -> Option<&'static str> {
        None
    }

    /// See `Ready::takes_long`.
    fn takes_long(&self) -> bool {
        false
    }

    /// See `Ready::lying`.
    fn lying(&self, _compare: Option<&Watch>) -> Option<Vec<Value>> {
        None
    }

    /// See `Ready::guide`.
    fn guide(&self, _picture: usize, _watch: &Watch) -> Option<Linear> {
        None
    }

    /// See `Ready::lacks`; paths are relative to the surface.
    fn lacks(&self) -> Option<Problem> {
        None
    }

    /// See `Ready::laid_px`.
    fn laid_px(&self, _picture: usize) -> Option<(usize, usize)> {
        None
    }

    /// See `Ready::painted`; paths are relative to the layer.
    fn painted(&self, _picture: usize, _share: f64) -> Option<Painted> {
        None
    }

    /// See `Ready::put_round`; paths are relative to the surface.
    ///
    /// # Errors
    /// Why there is nothing to put.
    fn put_round(&self, _picture: usize, _put: Put, _ray: &Ray, _placed: &Placed) -> Result<(String, Value), String> {
        Err("no pictures with cameras lie on it".into())
    }

    /// See `Ready::balanced`; paths are relative to the surface.
    fn balanced(&self) -> Option<Vec<(String, Value)>> {
        None
    }

    /// What explains it on a mesh that is placed so; paths are relative to the layer.
    fn marks(&self, _view: &marks::View, _moment: &Moment, _placed: &Placed) -> Vec<Mark> {
        Vec::new()
    }

    /// Writes its files for other engines, as the surface of a layer of this name, and gives what the manifest says about
    /// them; `None` if it has none.
    ///
    /// # Errors
    /// Those of `to`, or why there can be none.
    fn bundle(&self, _layer: &str, _to: &mut dyn Sink) -> Result<Option<Value>, Error> {
        Ok(None)
    }

    /// The same with nothing that moves.
    fn unmoved(self: Arc<Self>) -> Arc<dyn ReadySurface>;

    /// The same with pictures made smaller.
    fn reduced(self: Arc<Self>, pictures: &mut Reduced) -> Arc<dyn ReadySurface>;

    /// The largest side of any picture that it reads, in pixels.
    fn largest_texture(&self) -> usize {
        0
    }
}

impl dyn ReadySurface {
    /// The surface as its kind's own type, for that kind.
    pub fn downcast<T: ReadySurface>(&self) -> Option<&T> {
        (self as &dyn Any).downcast_ref()
    }
}

/// What the GPU draws of a surface.
#[derive(Debug)]
pub enum Look {
    /// One color under light: linear, premultiplied.
    Color(Rgba),
    /// A picture under light, by the texture coordinates.
    Picture(Bind),
    /// Something else.
    Own(Own),
}

/// Programs that draw a surface.
#[derive(Debug)]
pub struct Own {
    /// What draws it.
    pub program: &'static Program,
    /// The same with what strokes are drawn from, `Facts` in frame.wgsl.
    pub facts: &'static Program,
    /// Values of their `override` constants.
    pub constants: Vec<(&'static str, f64)>,
    /// What they read after what all programs for meshes read.
    pub binds: Vec<Bind>,
}

/// A surface at one time.
pub trait StillSurface: Sync {
    /// What tells its color at one place after the other, before light falls on it: linear light, premultiplied.
    fn reader(&self) -> Reader<'_>;

    /// Whether light falls on it; if not, its light is in its colors.
    fn is_lit(&self) -> bool {
        true
    }

    /// What there is to say of a place.
    fn told(&self, _place: &SurfacePoint) -> Option<Entry> {
        None
    }

    /// What tells what a pass of its kind has at one place after the other; `None` for all other passes.
    fn pass(&self, _pass: &Pass) -> Option<Reader<'_>> {
        None
    }
}

/// Tells the color of a surface at a place.
pub type Reader<'a> = Box<dyn FnMut(&SurfacePoint) -> Rgba + 'a>;

/// A place on a surface as a pixel shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The triangle, and where on it.
    pub hit: Hit,
    /// The place in the world.
    pub position: DVec3,
    /// The texture coordinates.
    pub uv: DVec2,
}
