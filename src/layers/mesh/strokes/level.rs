//! A plane that is close to what a tile shows: it tells which kernels reach all of it, and which none.

use std::ops::Range;

use glam::{DMat3, DVec2, DVec3};

use super::curves::LANES;

/// Every so many pixels of a tile are looked at for its plane.
const SPARSE: usize = 4;

/// A plane that is close to what a tile shows of the layer.
pub struct Level {
    /// 1 / its depth, as the `plane` of an impulse.
    pub plane: DVec3,
    /// What 1 / the layer's depth is more than that in each pixel, in rows of a stride; not a number where the layer is not seen.
    pub away: Vec<f32>,
    /// The least of that.
    pub least: f64,
    /// The greatest.
    pub most: f64,
}

impl Level {
    /// That of a tile of a frame of this width: of 1 / the depth and the triangle of each pixel. `None` if the layer is not
    /// seen in it. `stride` is a multiple of the lanes.
    #[inline(always)]
    pub fn new(
        (width, inverse, triangle): (usize, &[f64], &[u32]),
        columns: &Range<usize>,
        rows: &Range<usize>,
        stride: usize,
    ) -> Option<Level> {
        let own = |x: usize, y: usize| {
            let i = y * width + x;
            (triangle[i] != u32::MAX).then(|| inverse[i])
        };
        // Relative to the corner: the sums stay exact enough.
        let corner = DVec2::new(columns.start as f64 + 0.5, rows.start as f64 + 0.5);
        let (mut squares, mut sums) = (DMat3::ZERO, DVec3::ZERO);
        for y in rows.clone().step_by(SPARSE) {
            for x in columns.clone().step_by(SPARSE) {
                if let Some(inverse) = own(x, y) {
                    let at = DVec3::new((x - columns.start) as f64, (y - rows.start) as f64, 1.0);
                    squares += DMat3::from_cols(at * at.x, at * at.y, at);
                    sums += at * inverse;
                }
            }
        }
        // Any plane serves; a close one tells more.
        let fit = if squares.determinant() > 1.0 { squares.inverse() * sums } else { DVec3::ZERO };
        let plane = fit.with_z(fit.z - fit.x * corner.x - fit.y * corner.y);
        let mut away = vec![f32::NAN; stride * rows.len()];
        for (away, y) in away.chunks_exact_mut(stride).zip(rows.clone()) {
            let own = y * width + columns.start..y * width + columns.end;
            let first = plane.x * (columns.start as f64 + 0.5) + plane.y * (y as f64 + 0.5) + plane.z;
            let pixels = inverse[own.clone()].iter().zip(&triangle[own]);
            for (x, (away, (inverse, triangle))) in away.iter_mut().zip(pixels).enumerate() {
                let found = (inverse - (plane.x * x as f64 + first)) as f32;
                *away = if *triangle != u32::MAX { found } else { f32::NAN };
            }
        }
        let (mut least, mut most) = ([f32::INFINITY; LANES], [f32::NEG_INFINITY; LANES]);
        for lump in away.as_chunks::<LANES>().0 {
            for (k, away) in lump.iter().enumerate() {
                // What is not a number is neither.
                least[k] = if *away < least[k] { *away } else { least[k] };
                most[k] = if *away > most[k] { *away } else { most[k] };
            }
        }
        let least = f64::from(least.into_iter().fold(f32::INFINITY, f32::min));
        let most = f64::from(most.into_iter().fold(f32::NEG_INFINITY, f32::max));
        (least <= most).then_some(Level { plane, away, least, most })
    }
}
