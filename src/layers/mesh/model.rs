//! The mesh layer as in the document. The doc comments become the help texts of forms and schema.

use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::drawing::DrawingSlot;
use super::pose::Pose;
use super::slots::{Strokes, Surface};
use crate::base::geometry::Xyz;
use crate::base::problem::Problem;

/// A mesh in space, seen by the scene's camera.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshLayer {
    /// Unique among the layers.
    #[schemars(length(min = 1))]
    pub name: String,
    /// The mesh, by its name in the scene's meshes.
    #[schemars(extend("reference" = "meshes"))]
    pub mesh: String,
    /// Which sides of triangles are seen.
    #[serde(default)]
    pub sides: Sides,
    /// Where the mesh is, and how it moves.
    #[serde(default)]
    pub pose: Pose,
    /// The light on it.
    #[serde(default)]
    pub light: Light,
    /// What its surface shows.
    #[serde(default)]
    pub surface: Surface,
    /// The strokes that it is drawn with, if it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strokes: Option<Strokes>,
}

/// Which sides of triangles are seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Sides {
    /// Front sides: triangles whose corners run counter-clockwise as seen.
    #[default]
    Front,
    /// Both; the normals of back sides are turned to the camera.
    Both,
}

/// Light from one direction, and some from everywhere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Light {
    /// Where the light goes, in the world.
    #[schemars(extend("unit" = "1"))]
    pub direction: Xyz,
    /// The share of the light that comes from everywhere.
    #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1"))]
    pub ambient: f64,
}

impl Default for Light {
    fn default() -> Self {
        Light { direction: [-0.4, -0.8, -0.4], ambient: 0.35 }
    }
}

impl Light {
    /// Where it comes from, in the world: of length 1.
    pub fn toward(&self) -> DVec3 {
        -DVec3::from(self.direction).normalize_or_zero()
    }
}

impl MeshLayer {
    /// The checks beyond shape.
    pub fn check(&self) -> Vec<Problem> {
        let mut problems = self.pose.check();
        if DVec3::from(self.light.direction).try_normalize().is_none() {
            let problem = Problem::error("/light/direction", "the light has no direction");
            problems.push(problem.hint("make it [0, -1, 0] for light from above"));
        }
        problems.extend(self.surface.slot().check().into_iter().map(|problem| problem.under("/surface")));
        let drawn = self.drawing().into_iter().flat_map(DrawingSlot::check);
        problems.extend(drawn.map(|problem| problem.under("/strokes")));
        problems
    }

    /// What is drawn on it, if something is.
    pub fn drawing(&self) -> Option<&dyn DrawingSlot> {
        self.strokes.as_ref().map(Strokes::slot)
    }
}
