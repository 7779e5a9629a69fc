//! How anchors spread to the pixels between them (docs/folding.md, section 4). A new method needs one variant here and one
//! file beside this one.
//!
//! Fields are evaluated in runs of neighboring pixels in a row: the outer loop is over anchors, the inner one over
//! pixels, which the compiler vectorises without changing the order of any pixel's sum.

use kurbo::Vec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::anchor::Anchor;
use crate::base::problem::Problem;
use crate::layers::parts::materials::Materials;
use inverse_distance::{Modified, Shepard};
use rigid::Rigid;
use thin_plate::{NoPlate, Plate};

mod inverse_distance;
mod rigid;
mod thin_plate;

/// How the jump vectors of a zone's anchors spread over its pixels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "method", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Interpolation {
    /// Every anchor counts, by a power of its inverse distance.
    #[schemars(extend("formula" = "J = Σ w u / Σ w, w = d^-power, d the distance to the anchor of vector u"))]
    Shepard {
        /// The power; larger makes flat plateaus around the anchors.
        #[serde(default = "two")]
        #[schemars(range(min = 0.01, max = 100.0), extend("unit" = "1"))]
        power: f64,
    },
    /// Only anchors within a radius count.
    #[schemars(extend("formula" = "J = Σ w u / Σ w, w = (max(0, R - d) / (R d))², R the radius, d the distance"))]
    ModifiedShepard {
        /// Anchors farther than this do not count.
        #[schemars(range(min = 0.001, max = 1000000.0), extend("unit" = "px"))]
        radius: f64,
    },
    /// As modified-shepard, but in an outer ring each anchor counts or not at random, pixel by pixel.
    #[schemars(extend("formula" = "as modified-shepard; where R - ring < d < R an anchor counts or not by a hash of pixel, anchor, seed"))]
    ModifiedShepardRandom {
        /// Anchors farther than this do not count.
        #[schemars(range(min = 0.001, max = 1000000.0), extend("unit" = "px"))]
        radius: f64,
        /// Width of the ring inside the radius in which anchors count at random.
        #[schemars(range(min = 0.0, max = 1000000.0), extend("unit" = "px"))]
        ring: f64,
        /// Another seed is another random choice.
        #[serde(default)]
        #[schemars(extend("unit" = "1"))]
        seed: u32,
    },
    /// A thin plate bent through the anchors: smooth everywhere, and beyond them.
    #[schemars(extend("formula" = "J = affine part + Σ c d² ln d, through the anchors; smoothing stands on the diagonal"))]
    ThinPlate {
        /// 0 passes through every anchor; larger is stiffer.
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 1e12), extend("unit" = "1"))]
        smoothing: f64,
    },
    /// Moving least squares by rigid motions (Schaefer et al. 2006): it turns without changing sizes.
    #[schemars(extend("formula" = "J = the rigid motion that fits the anchors best by weights d^-2, less the pixel's own place"))]
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

/// Pixels in the longest [`Run`].
pub const RUN: usize = 64;

/// A pixel closer to an anchor than this, in pixels, takes that anchor's vector.
const AT_ANCHOR_PX: f64 = 1e-6;

/// A run of neighboring pixels in a row, and the place in each pixel at which the field is evaluated.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// Column and row of the first pixel.
    pub pixel: (u32, u32),
    /// The place in each pixel, from its top-left corner; (0.5, 0.5) is the centre.
    pub place: Vec2,
    /// Number of pixels, at most [`RUN`].
    pub len: usize,
}

impl Run {
    /// Image coordinate x of place `k`.
    pub fn x(&self, k: usize) -> f64 {
        f64::from(self.pixel.0) + k as f64 + self.place.x
    }

    /// Image coordinates x of all places, and of those that would follow up to [`RUN`].
    fn xs(&self) -> [f64; RUN] {
        std::array::from_fn(|k| self.x(k))
    }

    /// Image coordinate y of all places.
    pub fn y(&self) -> f64 {
        f64::from(self.pixel.1) + self.place.y
    }

    /// Squared distance from `anchor` to the nearest place of the run.
    fn reach2(&self, anchor: &Anchor) -> f64 {
        let dx = (self.x(0) - anchor.at.x).max(anchor.at.x - self.x(self.len - 1)).max(0.0);
        let dy = self.y() - anchor.at.y;
        dx * dx + dy * dy
    }
}

/// Jump vectors of a run, x and y separately.
pub struct Jumps {
    /// x in pixels.
    pub x: [f64; RUN],
    /// y in pixels.
    pub y: [f64; RUN],
}

impl Default for Jumps {
    fn default() -> Self {
        Jumps { x: [0.0; RUN], y: [0.0; RUN] }
    }
}

/// A method, prepared for the anchors of a zone.
trait Method: Send + Sync {
    /// Writes the interpolated jump vectors of `run` to the beginning of `out`; there is always at least one anchor.
    fn run(&self, anchors: &[Anchor], run: &Run, out: &mut Jumps);

    /// Whether a pixel at an anchor takes the anchor's vector, whatever [`Method::run`] writes there.
    fn passes_anchors(&self) -> bool {
        true
    }
}

/// The anchors of a zone, prepared for interpolation.
pub struct Interpolator {
    anchors: Vec<Anchor>,
    method: Box<dyn Method>,
}

impl Interpolation {
    /// Bytes of memory that preparing `count` anchors takes, besides the anchors.
    pub fn bytes(&self, count: u64) -> u64 {
        match self {
            Interpolation::ThinPlate { .. } => thin_plate::bytes(count),
            Interpolation::Shepard { .. }
            | Interpolation::ModifiedShepard { .. }
            | Interpolation::ModifiedShepardRandom { .. }
            | Interpolation::Rigid {} => 0,
        }
    }
}

impl Interpolator {
    /// Prepares `anchors`; for a thin plate this solves its equations, within the memory that is left and until
    /// cancelled.
    ///
    /// # Errors
    /// If they need too much memory, or the synthesis is cancelled; the problem's path is relative to the zone.
    pub fn new(
        interpolation: &Interpolation,
        mut anchors: Vec<Anchor>,
        materials: &Materials,
    ) -> Result<Self, Problem> {
        let bytes = interpolation.bytes(anchors.len() as u64);
        let _share = materials.budget.try_take(bytes).map_err(|short| short.problem("/interpolation"))?;
        let method: Box<dyn Method> = match *interpolation {
            Interpolation::Shepard { power } => Box::new(Shepard { power }),
            Interpolation::ModifiedShepard { radius } => Box::new(Modified { radius, ring: None }),
            Interpolation::ModifiedShepardRandom { radius, ring, seed } => {
                Box::new(Modified { radius, ring: Some((ring, seed)) })
            }
            Interpolation::ThinPlate { smoothing } => {
                anchors = thin_plate::distinct(&anchors);
                match Plate::solve(&anchors, smoothing, &|| materials.stopped()) {
                    Ok(plate) => Box::new(plate),
                    Err(NoPlate::Flat) => Box::new(Shepard { power: two() }),
                    Err(NoPlate::Stopped) => return Err(Problem::error("/interpolation", "stopped")),
                }
            }
            Interpolation::Rigid {} => Box::new(Rigid),
        };
        Ok(Interpolator { anchors, method })
    }

    /// Writes the interpolated jump vectors of `run` to the beginning of `out`; (0, 0) without anchors.
    pub fn run(&self, run: &Run, out: &mut Jumps) {
        if self.anchors.is_empty() {
            *out = Jumps::default();
            return;
        }
        self.method.run(&self.anchors, run, out);
        if self.method.passes_anchors() {
            self.take_anchors_at(run, out);
        }
    }

    /// Gives pixels at an anchor its vector; the first anchor there counts.
    fn take_anchors_at(&self, run: &Run, out: &mut Jumps) {
        for anchor in self.anchors.iter().rev() {
            let dy = run.y() - anchor.at.y;
            let k = (anchor.at.x - run.x(0)).round();
            if dy.abs() < AT_ANCHOR_PX && k >= 0.0 && k < run.len as f64 {
                let k = k as usize;
                let dx = run.x(k) - anchor.at.x;
                if dx * dx + dy * dy < AT_ANCHOR_PX * AT_ANCHOR_PX {
                    (out.x[k], out.y[k]) = (anchor.jump.x, anchor.jump.y);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
