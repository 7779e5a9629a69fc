//! The picture of a view: its light, and how much each pixel counts.

use std::sync::Arc;

use crate::base::picture::Picture;
use crate::base::pixels::{Rgba, encode, srgb_from_linear};

/// How far a channel must be from the guide's, in codes, for a pixel to count.
const CHANGED: u8 = 2;

/// What a picture is made of.
#[derive(Clone, Debug)]
pub struct Paint {
    /// The picture; its alpha says how much of a pixel counts.
    pub picture: Arc<Picture>,
    /// What that is multiplied by: the brightest channel times alpha.
    pub mask: Option<Arc<Picture>>,
    /// Only what is not as in this picture counts.
    pub guide: Option<Arc<Picture>>,
    /// How far from the border a pixel counts in full.
    pub feather_px: f64,
    /// What light is multiplied by.
    pub gain: [f64; 3],
}

impl Paint {
    /// Whether both give the same pixels for the same reasons.
    pub fn same(&self, other: &Paint) -> bool {
        let both = |a: &Option<Arc<Picture>>, b: &Option<Arc<Picture>>| match (a, b) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        };
        Arc::ptr_eq(&self.picture, &other.picture)
            && both(&self.mask, &other.mask)
            && both(&self.guide, &other.guide)
            && (self.feather_px, self.gain) == (other.feather_px, other.gain)
    }

    /// All pixels row by row: light, multiplied by how much the pixel counts, and that.
    pub fn pixels(&self) -> Vec<Rgba> {
        let (width, height) = (self.picture.width(), self.picture.height());
        let mut pixels = self.picture.to_linear().into_cells();
        let gain = self.gain.map(|gain| gain as f32);
        for (i, pixel) in pixels.iter_mut().enumerate() {
            let (x, y) = (i % width, i / width);
            let mut counts = 1.0;
            if self.feather_px > 0.0 {
                let inside = x.min(width - 1 - x).min(y.min(height - 1 - y)) as f64 + 0.5;
                counts = (inside / self.feather_px).min(1.0);
            }
            if let Some(mask) = &self.mask {
                counts *= stored(mask, x, y);
            }
            if self.guide.as_ref().is_some_and(|guide| !differs(*pixel, guide.texel(x, y))) {
                counts = 0.0;
            }
            let [r, g, b, a] = *pixel;
            let [red, green, blue] = gain;
            *pixel = [r * red, g * green, b * blue, a].map(|channel| channel * counts as f32);
        }
        pixels
    }
}

/// Whether a pixel counts as changed beside that of a guide.
pub fn differs(pixel: Rgba, guide: Rgba) -> bool {
    let (own, other) = (encode(pixel), encode(guide));
    own.iter().zip(other).any(|(own, other)| own.abs_diff(other) > CHANGED)
}

/// The brightest channel times alpha, as stored: codes from 0 to 1.
fn stored(mask: &Picture, x: usize, y: usize) -> f64 {
    let [r, g, b, a] = mask.texel(x, y).map(f64::from);
    if a > 0.0 { srgb_from_linear(r.max(g).max(b) / a) * a } else { 0.0 }
}
