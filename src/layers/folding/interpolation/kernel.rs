//! What the sums over anchors are made of: the weight of an anchor by its distance, where that may be interpolated, and
//! what follows from the sums.

use super::chebyshev::Chebyshev;
use crate::layers::folding::anchor::Anchor;

/// How far a jump vector may be from that of the exact sums, in pixels.
pub const TOLERANCE_PX: f64 = 1e-3;

/// So many anchors are summed in single precision before their sums are added to those in double precision.
pub const GROUP: usize = 4;

/// Gaps between an anchor and a cell, in half sides of the cell, from which on its weight may be interpolated.
pub const GAPS: [f64; 12] = [1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 6.0, 8.0, 10.0, 14.0];

/// An anchor, and the numbers that are summed.
#[derive(Clone, Copy, Debug)]
pub struct Source<const C: usize> {
    /// Image coordinates.
    pub at: [f64; 2],
    /// Its jump vector in pixels.
    pub jump: [f64; 2],
    /// What is multiplied by the weight, and summed.
    pub terms: [f64; C],
    /// Its index among the anchors of the zone.
    pub index: u32,
}

/// What becomes of an anchor in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// It has no weight anywhere in the cell.
    Dropped,
    /// It is summed at the nodes.
    Far,
    /// It is looked at again in the quarters of the cell, at last pixel by pixel.
    Near,
}

/// How far an anchor is from a cell; squared distances in pixels.
#[derive(Clone, Copy, Debug)]
pub struct Apart {
    /// From the nearest place of the cell.
    pub nearest2: f64,
    /// From the farthest place of the cell.
    pub farthest2: f64,
    /// Half the side of the cell, squared.
    pub half2: f64,
    /// The least `farthest2` of all anchors, if the kernel is [`Kernel::RELATIVE`].
    pub closest2: f64,
}

/// One pixel and one anchor.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    /// Squared distance.
    pub d2: f64,
    /// Squared distance of the pixel from the nearest anchor, if the kernel is [`Kernel::RELATIVE`].
    pub nearest2: f64,
    /// Column and row of the pixel.
    pub pixel: [u32; 2],
    /// Index of the anchor.
    pub index: u32,
}

/// How the weight of an anchor depends on its distance, and what follows from `C` weighted sums.
pub trait Kernel<const C: usize>: Send + Sync {
    /// Whether weights depend on the distance of the nearest anchor.
    const RELATIVE: bool = false;

    /// Whether a pixel at an anchor takes the anchor's vector, whatever follows from the sums.
    const PASSES_ANCHORS: bool = true;

    /// Whether weights may be made in single precision.
    const SINGLE: bool = false;

    /// The weight at a squared distance; that of far anchors is interpolated.
    fn weight(&self, d2: f64) -> f64;

    /// The weight of a near anchor at a pixel.
    #[inline(always)]
    fn weight_near(&self, pair: Pair) -> f64 {
        self.weight(pair.d2)
    }

    /// Whether [`Kernel::weight_single`] will do for these jump vectors, if it does for any.
    fn is_single(&self) -> bool {
        Self::SINGLE
    }

    /// The weight in single precision, rounded a few times.
    #[inline(always)]
    fn weight_single(&self, d2: f32) -> f32 {
        self.weight(f64::from(d2)) as f32
    }

    /// What becomes of an anchor in a cell.
    fn fate(&self, apart: &Apart) -> Fate;

    /// How much a far anchor may add to the error of the first sum, as a multiple of what [`TOLERANCE_PX`] allows where
    /// that sum is 1.
    fn doubt(&self, _apart: &Apart) -> f64 {
        0.0
    }

    /// The jump vectors, x and y, that follow from the sums in a row of places.
    fn jumps<const N: usize>(&self, sums: &[[f64; N]; C], xs: &[f64; N], y: f64) -> [[f64; N]; 2];
}

/// The square of the first of [`GAPS`] with which `weight` is interpolated to within `error`, as a share of itself; `None`
/// if none is wide enough. Weights are powers of the distance, so that this does not depend on the size of the cell.
pub fn gap2(error: f64, weight: impl Fn(f64) -> f64) -> Option<f64> {
    let chebyshev = Chebyshev::new();
    let gap = GAPS.into_iter().find(|gap| chebyshev.error(*gap, &weight, |weight| weight) <= error)?;
    Some(gap * gap)
}

/// The length of the diagonal of the box around some vectors; 0 without any.
pub fn spread(vectors: impl Iterator<Item = [f64; 2]> + Clone) -> f64 {
    let side = |k: usize| {
        let ends = vectors.clone().map(|vector| vector[k]);
        (ends.clone().fold(f64::NEG_INFINITY, f64::max) - ends.fold(f64::INFINITY, f64::min)).max(0.0)
    };
    let [x, y] = [side(0), side(1)];
    (x * x + y * y).sqrt()
}

/// The anchors as sources of `terms`.
pub fn sources<const C: usize>(anchors: &[Anchor], terms: impl Fn(usize, &Anchor) -> [f64; C]) -> Vec<Source<C>> {
    let source = |(index, anchor): (usize, &Anchor)| Source {
        at: [anchor.at.x, anchor.at.y],
        jump: [anchor.jump.x, anchor.jump.y],
        terms: terms(index, anchor),
        index: index as u32,
    };
    anchors.iter().enumerate().map(source).collect()
}
