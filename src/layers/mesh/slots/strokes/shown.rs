//! What a frame shows of a layer: what kernels cover is compared with it.

use std::sync::OnceLock;
use std::sync::atomic::AtomicBool;

use super::bins::TILE;
use super::curves::LANES;
use super::level::Level;
use crate::base::simd::vectorised;

/// What the frame shows of a layer.
pub struct InFrame<'a> {
    /// Width and height, in pixels.
    pub size_px: (usize, usize),
    /// Distance of the picture plane, in pixels.
    pub focal_px: f64,
    /// 1 / the depth of what each pixel shows; 0 where that is nothing.
    pub inverse: &'a [f64],
    /// The triangle of the layer that each pixel shows, `u32::MAX` where it shows none.
    pub triangle: &'a [u32],
    /// Once it is set, the sum counts no more.
    pub stop: Option<&'a AtomicBool>,
    /// The level of each of its tiles, row after row, once it is needed; `None` where the layer is not seen.
    levels: Vec<OnceLock<Option<Level>>>,
}

impl<'a> InFrame<'a> {
    /// A frame of this size, with the picture plane at this distance.
    pub fn new(
        (size_px, focal_px): ((usize, usize), f64),
        inverse: &'a [f64],
        triangle: &'a [u32],
        stop: Option<&'a AtomicBool>,
    ) -> InFrame<'a> {
        let levels = vec![OnceLock::new(); size_px.0.div_ceil(TILE) * size_px.1.div_ceil(TILE)];
        InFrame { size_px, focal_px, inverse, triangle, stop, levels }
    }

    /// What some pixels of a row have, from this one on; what is beyond the end is not to be used.
    #[inline(always)]
    pub fn lanes<T: Copy + Default>(&self, of: &[T], (x, y): (usize, usize)) -> [T; LANES] {
        let rest = &of[y * self.size_px.0 + x..];
        rest.first_chunk().copied().unwrap_or_else(|| {
            let mut lanes = [T::default(); LANES];
            lanes[..rest.len()].copy_from_slice(rest);
            lanes
        })
    }

    /// The level of the tile in this column and row.
    #[inline(always)]
    pub fn level(&self, (x, y): (usize, usize)) -> Option<&Level> {
        let (width, height) = self.size_px;
        // Whoever needs it first makes it, alone: no thread waits for others meanwhile.
        let level = self.levels[y * width.div_ceil(TILE) + x].get_or_init(|| {
            let (columns, rows) = (x * TILE..width.min((x + 1) * TILE), y * TILE..height.min((y + 1) * TILE));
            vectorised(
                #[inline(always)]
                || Level::new((width, self.inverse, self.triangle), &columns, &rows),
            )
        });
        level.as_ref()
    }
}
