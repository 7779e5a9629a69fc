//! A surface of one color.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::base::color;
use crate::base::mesh::Mesh;
use crate::base::pixels::{Rgba, decode};
use crate::base::problem::Problem;
use crate::base::reduce::Reduced;
use crate::layers::check;
use crate::layers::mesh::pose::Placed;
use crate::layers::mesh::surface::{Before, Look, Reader, ReadySurface, StillSurface, SurfaceSlot};
use crate::layers::parts::moment::Moment;
use crate::layers::ready::Making;

/// One color.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Plain {
    /// sRGB with straight alpha: #rrggbb or #rrggbbaa.
    pub color: String,
}

impl Default for Plain {
    fn default() -> Self {
        Plain { color: "#c8b8a0".into() }
    }
}

impl SurfaceSlot for Plain {
    fn check(&self) -> Vec<Problem> {
        check::color(&self.color, "/color").into_iter().collect()
    }

    fn synth(&self, _mesh: &Arc<Mesh>, _making: &Making, _before: Before) -> Result<Arc<dyn ReadySurface>, Problem> {
        Ok(Arc::new(Paint(color::parse(&self.color).map_or([0.0; 4], decode))))
    }
}

/// A color, in linear light, premultiplied.
#[derive(Clone, Copy, Debug)]
struct Paint(Rgba);

impl ReadySurface for Paint {
    fn at<'a>(&'a self, _moment: &'a Moment, _placed: &Placed) -> Box<dyn StillSurface + 'a> {
        Box::new(*self)
    }

    fn plan(&self, _moment: &Moment, _placed: &Placed) -> Look {
        Look::Color(self.0)
    }

    fn unmoved(self: Arc<Self>) -> Arc<dyn ReadySurface> {
        self
    }

    fn reduced(self: Arc<Self>, _pictures: &mut Reduced) -> Arc<dyn ReadySurface> {
        self
    }
}

impl StillSurface for Paint {
    fn reader(&self) -> Reader<'_> {
        Box::new(|_| self.0)
    }
}
