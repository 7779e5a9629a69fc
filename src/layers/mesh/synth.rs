//! A mesh layer ready for any time.

use std::sync::Arc;

use kurbo::Vec2;

use super::model::{Light, MeshLayer, Sides};
use super::pose::Pose;
use super::surface::ReadySurface;
use crate::base::mesh::Mesh;
use crate::base::problem::Problem;
use crate::layers::parts::moment::Moment;
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
    /// Whether the pose stands still as it is at the beginning.
    pub still: bool,
}

impl Synth {
    /// A layer made ready.
    ///
    /// # Errors
    /// If the mesh, or what its surface names, is not there; the problem's path is relative to the layer.
    pub fn new(layer: &MeshLayer, making: &Making) -> Result<Synth, Problem> {
        let mesh = making.materials.mesh(&layer.mesh, "/mesh")?;
        let surface = layer.surface.slot().synth(making).map_err(|problem| problem.under("/surface"))?;
        Ok(Synth {
            mesh,
            sides: layer.sides,
            pose: layer.pose.clone(),
            light: layer.light.clone(),
            surface,
            place: making.place,
            still: false,
        })
    }

    /// The scene time that the pose is at.
    pub fn time(&self, moment: &Moment) -> f64 {
        if self.still { 0.0 } else { moment.t }
    }
}
