//! A mesh layer ready for any time.

use std::sync::Arc;

use kurbo::Vec2;

use super::frame::Seen;
use super::model::{Light, MeshLayer, Sides};
use super::plan;
use super::pose::Pose;
use super::surface::ReadySurface;
use crate::base::mesh::Mesh;
use crate::base::problem::Problem;
use crate::base::reduce::Reduced;
use crate::layers::parts::moment::Moment;
use crate::layers::parts::plan::Plan;
use crate::layers::ready::{Making, Ready, Still};

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

impl Ready for Synth {
    fn at<'a>(&'a self, moment: &'a Moment) -> Box<dyn Still + 'a> {
        Box::new(Seen::new(self, moment))
    }

    fn plan(&self, moment: &Moment) -> Plan {
        plan::plan(self, moment)
    }

    fn unmoved(self: Arc<Self>) -> Arc<dyn Ready> {
        Arc::new(Synth { still: true, surface: self.surface.clone().unmoved(), ..(*self).clone() })
    }

    fn reduced(&self, pictures: &mut Reduced) -> Arc<dyn Ready> {
        Arc::new(Synth { surface: self.surface.clone().reduced(pictures), ..self.clone() })
    }

    fn largest_texture(&self) -> usize {
        self.surface.largest_texture()
    }
}
