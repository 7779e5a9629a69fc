//! The picture layer and its zones as in the document. The doc comments become the help texts of forms and schema.

use kurbo::{Affine, Vec2};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::anchor::Anchor;
use super::anchors::{anchors, given, transform};
use super::clock::Clock;
use super::position::Position;
use super::{fold::Fold, interpolation::Interpolation, outline::Outline, tools::Tool};
use crate::base::geometry::Xy;
use crate::layers::timeline::Wrap;

/// A still picture whose motion zones fold over time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PictureLayer {
    /// Unique among the layers.
    #[schemars(length(min = 1))]
    pub name: String,
    /// Name of the picture, one of the scene's images.
    #[schemars(extend("reference" = "images"))]
    pub image: String,
    /// Motion zones, shown in this order: later over earlier.
    #[serde(default)]
    pub zones: Vec<Zone>,
}

/// A part of the picture that moves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Zone {
    /// Unique among the layer's zones.
    #[schemars(length(min = 1))]
    pub name: String,
    /// The pixels that move: those whose center is inside.
    pub outline: Outline,
    /// What gives the jump vectors: anchors and dense transforms, in this order.
    #[serde(default)]
    pub motion: Vec<Tool>,
    /// How anchors spread to the pixels between them.
    #[serde(default)]
    pub interpolation: Interpolation,
    /// Where along its jump path a sampler is at each local time.
    #[serde(default)]
    pub position: Position,
    /// Where one part slides over another; none: every sampler is active.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fold: Option<Fold>,
    /// The picture or the clip that samplers read; none: the layer's own picture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sampler: Option<Sampler>,
    /// Passes in one timeline; negative runs backwards.
    #[serde(default = "one")]
    #[schemars(extend("unit" = "passes"))]
    pub speed: f64,
    /// Temporal shift: how far the zone is ahead.
    #[serde(default)]
    #[schemars(extend("unit" = "timelines"))]
    pub shift: f64,
    /// Width of the rim inside the outline over which jump vectors fade to zero.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000000.0), extend("unit" = "px"))]
    pub feather: f64,
}

impl Zone {
    /// The clip that its samplers read.
    pub fn clip(&self) -> Option<&str> {
        self.sampler.as_ref()?.clip.as_deref()
    }

    /// Whether nothing in it can move: no tool gives a jump vector, and it shows no clip.
    pub fn is_still(&self) -> bool {
        !self.motion.iter().any(|tool| tool.facts().moves) && self.clip().is_none()
    }

    /// Whether what it shows changes while the time runs, as far as the document tells.
    pub fn moves(&self) -> bool {
        self.clip().is_some() || self.motion.iter().any(|tool| self.moves_by(tool)) && self.runs()
    }

    fn moves_by(&self, tool: &Tool) -> bool {
        let leads_away = |map: Affine| map != Affine::IDENTITY;
        let jumps = || given(tool, &self.outline).iter().any(|(_, jump)| *jump != Vec2::ZERO);
        tool.facts().file.is_some() || transform(tool).is_some_and(leads_away) || jumps()
    }

    /// Whether its s changes.
    fn runs(&self) -> bool {
        const MOMENTS: u32 = 256;
        let clock = self.clock(Wrap::Repeat);
        (1..=MOMENTS).any(|k| clock.s(f64::from(k) / f64::from(MOMENTS)) != clock.s(0.0))
    }

    /// All its anchors, tools in list order.
    pub fn anchors(&self) -> Vec<Anchor> {
        anchors(&self.motion, &self.outline)
    }

    /// The clock of its samplers.
    pub fn clock(&self, wrap: Wrap) -> Clock {
        Clock { position: self.position.clone(), speed: self.speed, shift: self.shift, wrap }
    }
}

/// The picture or the clip that samplers read instead of the layer's own picture; transparent beyond its edge.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("either" = ["image", "clip"]))]
pub struct Sampler {
    /// Name of the picture, one of the scene's images.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("reference" = "images"))]
    pub image: Option<String>,
    /// Name of the clip, one of the scene's clips, in place of a picture: its frame at the scene time is read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("reference" = "clips"))]
    pub clip: Option<String>,
    /// Added to where every sampler reads.
    #[serde(default)]
    #[schemars(extend("unit" = "px", "relative" = true))]
    pub offset: Xy,
}

fn one() -> f64 {
    1.0
}
