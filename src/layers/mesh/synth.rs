//! A mesh layer ready for any time.

use std::sync::Arc;

use kurbo::Vec2;

use super::drawing::ReadyDrawing;
use super::model::{Light, MeshLayer, Sides};
use super::pose::Pose;
use super::surface::ReadySurface;
use crate::base::mesh::Mesh;
use crate::base::problem::Problem;
use crate::layers::parts::moment::{CENTER, Moment};
use crate::layers::ready::Making;

/// A mesh with its surface.
#[derive(Clone, Debug)]
pub struct Synth {
    /// The mesh.
    pub mesh: Arc<Mesh>,
    /// Which sides are seen.
    pub sides: Sides,
    /// Where it is.
    pub pose: Pose,
    /// The light on it.
    pub light: Light,
    /// What it shows.
    pub surface: Arc<dyn ReadySurface>,
    /// The place in each pixel that is looked at.
    pub place: Vec2,
    /// The strokes that it is drawn with.
    pub strokes: Option<Arc<dyn ReadyDrawing>>,
    /// Whether the pose stands still as it is at the beginning.
    pub still: bool,
}

impl Synth {
    /// A layer made ready. What it has in common with `previous` is reused.
    ///
    /// # Errors
    /// If the mesh, or what its surface or its strokes name, is not there; the problem's path is relative to the layer.
    pub fn new(layer: &MeshLayer, making: &Making, previous: Option<&Synth>) -> Result<Synth, Problem> {
        let mesh = making.materials.mesh(&layer.mesh, "/mesh")?;
        let before = previous.filter(|previous| Arc::ptr_eq(&previous.mesh, &mesh));
        let shown = layer.surface.slot().synth(&mesh, making, before.map(|previous| &*previous.surface));
        let surface = shown.map_err(|problem| problem.under("/surface"))?;
        let before = before.and_then(|previous| previous.strokes.as_deref());
        let drawn = layer.drawing().map(|own| own.synth(&mesh, making, before));
        let strokes = drawn.transpose().map_err(|problem| problem.under("/strokes"))?;
        Ok(Synth {
            strokes,
            mesh,
            sides: layer.sides,
            pose: layer.pose.clone(),
            light: layer.light.clone(),
            surface,
            place: making.place,
            still: false,
        })
    }

    /// The place in each pixel that is looked at then: samples have pixels of their own in a frame that is magnified.
    pub fn place(&self, moment: &Moment) -> Vec2 {
        if moment.magnified > 1 { CENTER } else { self.place }
    }

    /// The scene time that the pose is at.
    pub fn time(&self, moment: &Moment) -> f64 {
        if self.still { 0.0 } else { moment.t }
    }
}
