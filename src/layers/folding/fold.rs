//! Folding: where along its path a sampler is active, and where it waits (folding.md, section 3).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::outline::Outline;

/// Where one part of the picture slides over another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "rule", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Fold {
    /// An eyelid over an eyeball: inside a region a sampler waits at the edge where it entered; one that never left keeps still.
    Cover {
        /// The regions, which count as their union.
        #[schemars(length(min = 1))]
        regions: Vec<Outline>,
    },
    /// A sampler is still inside a region and active outside (equation 3.4).
    Return {
        /// The regions, which count as their union.
        #[schemars(length(min = 1))]
        regions: Vec<Outline>,
    },
    /// A car past a wall: a sampler is active inside a region and still outside.
    FlyOver {
        /// The regions, which count as their union.
        #[schemars(length(min = 1))]
        regions: Vec<Outline>,
    },
    /// A copy of the picture whose alpha is 0 in the fold regions; samplers read it, laid over what is beneath.
    Mask {
        /// Name of the mask, one of the scene's images, of the picture's size.
        #[schemars(extend("reference" = "images"))]
        image: String,
    },
}

impl Fold {
    /// The fold regions; none under a mask.
    pub fn regions(&self) -> &[Outline] {
        match self {
            Fold::Cover { regions } | Fold::Return { regions } | Fold::FlyOver { regions } => regions,
            Fold::Mask { .. } => &[],
        }
    }
}
