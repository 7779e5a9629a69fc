//! How anchors spread to the pixels between them (folding.md, section 4).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the jump vectors of a zone's anchors spread over its pixels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "method", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Interpolation {
    /// Every anchor counts, by a power of its inverse distance (equation 4.1).
    Shepard {
        /// The power; larger makes flat plateaus around the anchors.
        #[serde(default = "two")]
        #[schemars(range(min = 0.01, max = 100.0))]
        power: f64,
    },
    /// Only anchors within a radius count (equation 4.2).
    ModifiedShepard {
        /// Anchors farther than this do not count.
        #[schemars(range(min = 0.001, max = 1000000.0), extend("unit" = "px"))]
        radius: f64,
    },
    /// As modified-shepard, but in an outer ring each anchor counts or not at random, pixel by pixel (equation 4.3).
    ModifiedShepardRandom {
        /// Anchors farther than this do not count.
        #[schemars(range(min = 0.001, max = 1000000.0), extend("unit" = "px"))]
        radius: f64,
        /// Width of the ring inside the radius in which anchors count at random.
        #[schemars(range(min = 0.0, max = 1000000.0), extend("unit" = "px"))]
        ring: f64,
        /// Another seed is another random choice.
        #[serde(default)]
        seed: u32,
    },
    /// A thin plate bent through the anchors: smooth everywhere, and beyond them.
    ThinPlate {
        /// 0 passes through every anchor; larger is stiffer.
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 1e12))]
        smoothing: f64,
    },
    /// Moving least squares by rigid motions (Schaefer et al. 2006): turns, and keeps sizes.
    Rigid {},
}

impl Default for Interpolation {
    fn default() -> Self {
        Interpolation::Shepard { power: two() }
    }
}

fn two() -> f64 {
    2.0
}
