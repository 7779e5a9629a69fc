//! How anchors spread to the pixels between them (docs/folding.md, section 4). A new method needs one variant here and one
//! file beside this one.
//!
//! A method is a `kernel`: how the weight of an anchor depends on its distance, and what follows from the weighted sums.
//! [`cells`] makes the sums, for every method in the same way.

use kurbo::{Point, Rect, Vec2};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::anchor::Anchor;
use super::neat::neat;
use crate::base::problem::Problem;
use crate::layers::parts::materials::Materials;
use area::{Area, Stretch};
use cells::Cells;
use inverse_distance::{InverseSquare, Modified, Power, Steep};
use kernel::{Kernel, Source, sources, spread};
pub use method::Cell;
use method::{Method, Wanted};
use rigid::Rigid;
use thin_plate::{NoPlate, Plate};

pub mod area;
pub mod cells;
mod chebyshev;
mod inverse_distance;
mod kernel;
mod method;
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

/// The anchors of a zone, prepared for interpolation.
pub struct Interpolator(Box<dyn Method>);

/// The initial value of a field of a method in a zone with this box; `None` if zeros will do.
pub fn fresh(method: &str, field: &str, bounds: Rect) -> Option<Value> {
    let side = bounds.width().max(bounds.height());
    match (method, field) {
        ("modified-shepard" | "modified-shepard-random", "radius") => Some(json!(neat((side / 2.0).max(1.0)))),
        ("modified-shepard-random", "ring") => Some(json!(neat((side / 8.0).max(0.25)))),
        _ => None,
    }
}

impl Interpolation {
    /// Checks fields that depend on each other.
    pub fn check(&self) -> Option<Problem> {
        match *self {
            Interpolation::ModifiedShepardRandom { radius, ring, .. } => (ring > radius).then(|| {
                let message = format!("the ring of {ring} px is wider than the radius of {radius} px");
                Problem::warning("/ring", message).hint("make the ring narrower than the radius")
            }),
            Interpolation::Shepard { .. }
            | Interpolation::ModifiedShepard { .. }
            | Interpolation::ThinPlate { .. }
            | Interpolation::Rigid { .. } => None,
        }
    }

    /// Where the jump vectors of one list of anchors may differ from those of another: only within a distance, in pixels, of
    /// some places; `None` if anywhere.
    pub fn changed(&self, before: &[Anchor], now: &[Anchor]) -> Option<(Vec<Point>, f64)> {
        let differ = |(a, b): &(&Anchor, &Anchor)| a.at != b.at || a.jump != b.jump;
        let places: Vec<Point> = before.iter().zip(now).filter(differ).flat_map(|(a, b)| [a.at, b.at]).collect();
        match *self {
            _ if before.len() != now.len() => None,
            _ if places.is_empty() => Some((places, 0.0)),
            // How far is far enough for sums at nodes depends on the spread.
            Interpolation::ModifiedShepard { radius } | Interpolation::ModifiedShepardRandom { radius, .. } => {
                (spread_of(before) == spread_of(now)).then_some((places, radius))
            }
            Interpolation::Shepard { .. } | Interpolation::ThinPlate { .. } | Interpolation::Rigid {} => None,
        }
    }

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
    /// Prepares `anchors` for a picture of `size` and the `place` in each pixel that is evaluated, from its top-left
    /// corner. For a thin plate this solves its equations, within the memory that is left and until cancelled.
    ///
    /// # Errors
    /// If they need too much memory, or the synthesis is cancelled; the problem's path is relative to the zone.
    pub fn new(
        interpolation: &Interpolation,
        anchors: &[Anchor],
        size: [u32; 2],
        place: Vec2,
        materials: &Materials,
    ) -> Result<Self, Problem> {
        let bytes = interpolation.bytes(anchors.len() as u64);
        let _share = materials.budget.try_take(bytes).map_err(|short| short.problem("/interpolation"))?;
        let over = Over { anchors, size, place: [place.x, place.y] };
        let spread = spread_of(anchors);
        Ok(Interpolator(match *interpolation {
            Interpolation::Shepard { power } => over.shepard(power, spread),
            Interpolation::ModifiedShepard { radius } => over.means(Modified::<false>::new(radius, 0.0, 0, spread)),
            Interpolation::ModifiedShepardRandom { radius, ring, seed } => {
                over.means(Modified::<true>::new(radius, ring, seed, spread))
            }
            Interpolation::ThinPlate { smoothing } => {
                let distinct = thin_plate::distinct(anchors);
                let over = Over { anchors: &distinct, ..over };
                match Plate::solve(&distinct, smoothing, &|| materials.stopped()) {
                    Ok(plate) => over.sums(sources(&distinct, |index, _| plate.terms(index)), plate),
                    Err(NoPlate::Flat) => over.shepard(two(), spread),
                    Err(NoPlate::Stopped) => return Err(Problem::error("/interpolation", "stopped")),
                }
            }
            Interpolation::Rigid {} if anchors.is_empty() => over.shepard(two(), spread),
            Interpolation::Rigid {} => {
                let rigid = Rigid::new(anchors, spread);
                over.sums(sources(anchors, |_, anchor| rigid.terms(anchor)), rigid)
            }
        }))
    }

    /// The cells that `area` touches, from left to right and down, without those that are not `wanted`; `None` once
    /// `stopped`.
    pub fn cells(&self, area: &Area, wanted: Wanted, stopped: &(dyn Fn() -> bool + Sync)) -> Option<Vec<Cell>> {
        self.0.cells(area, wanted, stopped)
    }

    /// Tells the jump vectors of the pixels that are in `area` and in `cell`, one of [`Interpolator::cells`], a stretch at
    /// a time, without parts that are not `wanted`.
    pub fn fill(&self, cell: &Cell, area: &Area, wanted: &dyn Fn(&Area) -> bool, tell: &mut dyn FnMut(Stretch)) {
        self.0.fill(cell, area, wanted, tell);
    }
}

fn spread_of(anchors: &[Anchor]) -> f64 {
    spread(anchors.iter().map(|anchor| [anchor.jump.x, anchor.jump.y]))
}

/// Anchors over a picture.
#[derive(Clone, Copy)]
struct Over<'a> {
    anchors: &'a [Anchor],
    size: [u32; 2],
    place: [f64; 2],
}

impl Over<'_> {
    fn sums<const C: usize>(self, sources: Vec<Source<C>>, kernel: impl Kernel<C> + 'static) -> Box<dyn Method> {
        Box::new(Cells::new(kernel, sources, self.size, self.place))
    }

    /// Weighted means of the jump vectors.
    fn means(self, kernel: impl Kernel<3> + 'static) -> Box<dyn Method> {
        self.sums(sources(self.anchors, |_, anchor| [1.0, anchor.jump.x, anchor.jump.y]), kernel)
    }

    fn shepard(self, power: f64, spread: f64) -> Box<dyn Method> {
        let steep = || Steep::new(power, spread, self.anchors.len());
        let lengths = self.anchors.iter().map(|anchor| anchor.jump.x.abs().max(anchor.jump.y.abs()));
        let longest = lengths.fold(0.0, f64::max);
        if power == two() {
            InverseSquare::new(spread, longest).map_or_else(|| self.means(steep()), |kernel| self.means(kernel))
        } else {
            Power::new(power, spread).map_or_else(|| self.means(steep()), |kernel| self.means(kernel))
        }
    }
}

#[cfg(test)]
mod tests;
