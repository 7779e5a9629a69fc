//! How what several views tell one cell becomes one color.

use super::entries::Entry;

/// How much steeper the distance in depth grows beyond a layer for what was seen from farther away: that comes last.
const MAGNIFIED: f64 = 8.0;
/// The least distance in depth over which one view hides another.
const LEAST_STEP: f64 = 0.25;

/// A view at a cell.
#[derive(Clone, Copy, Debug, Default)]
pub struct Part {
    /// Its place in the list that it comes from.
    pub entry: usize,
    /// The view.
    pub view: usize,
    /// Its share in the color, once it is mixed.
    pub share: f64,
    factor: f64,
    mask: f64,
    /// The product of all three: how much it can hide.
    counts: f64,
    /// How far its depth is from the layer of the cell.
    far: f64,
    /// By how much what is farther is hidden, for each layer that it is farther.
    hides: f64,
}

impl Part {
    /// What a view tells a cell of a layer; `factor` is how far it counts by its direction.
    #[inline]
    pub fn new(entry: usize, view: usize, told: &Entry, factor: f64, layer: usize) -> Part {
        let (mask, facing, far) = (f64::from(told.mask), f64::from(told.facing), far(told.depth.into(), layer as f64));
        let hides = 1.0 / (1.0 - far).max(LEAST_STEP);
        Part { entry, view, share: 0.0, factor, mask, counts: factor * mask * facing, far, hides }
    }
}

/// How far a depth is from a layer.
#[inline]
fn far(depth: f64, layer: f64) -> f64 {
    if depth < layer - 1.0 { MAGNIFIED * (layer - depth) - (MAGNIFIED - 1.0) } else { (depth - layer).abs() }
}

/// Gives each part its share. Returns how opaque they are together.
#[inline]
pub fn mix(parts: &mut [Part]) -> f64 {
    let (mut masks, mut counted) = (0.0, 0.0);
    for k in 0..parts.len() {
        let own = parts[k];
        let left = parts.iter().fold(1.0, |left, other| {
            left * (1.0 - other.counts * ((own.far - other.far) * other.hides).clamp(0.0, 1.0))
        });
        masks += own.factor * left * own.mask;
        let counts = own.counts * left;
        counted += counts;
        parts[k].share = counts;
    }
    let opacity = masks.min(1.0);
    let scale = if counted > 0.0 { opacity / counted } else { 0.0 };
    parts.iter_mut().for_each(|part| part.share *= scale);
    opacity
}
