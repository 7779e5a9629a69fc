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
    /// The least difference of 1 / the layer's depth to it.
    pub least: f64,
    /// The greatest.
    pub most: f64,
}

impl Level {
    /// That of a tile of a frame of this width: of 1 / the depth and the triangle of each pixel. `None` if the layer is not
    /// seen in it.
    #[inline(always)]
    pub fn new(
        (width, inverse, triangle): (usize, &[f64], &[u32]),
        columns: &Range<usize>,
        rows: &Range<usize>,
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
        let (mut least, mut most) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
        for y in rows.clone() {
            let own = y * width + columns.start..y * width + columns.end;
            let down = plane.x * (columns.start as f64 + 0.5) + plane.y * (y as f64 + 0.5) + plane.z;
            let lumps = inverse[own.clone()].chunks(LANES).zip(triangle[own].chunks(LANES));
            for (lump, (inverse, triangle)) in lumps.enumerate() {
                let down = plane.x * (lump * LANES) as f64 + down;
                for (k, (inverse, triangle)) in inverse.iter().zip(triangle).enumerate() {
                    let (away, own) = (inverse - (plane.x * k as f64 + down), *triangle != u32::MAX);
                    least[k] = if own && away < least[k] { away } else { least[k] };
                    most[k] = if own && away > most[k] { away } else { most[k] };
                }
            }
        }
        let (least, most) =
            (least.into_iter().fold(f64::INFINITY, f64::min), most.into_iter().fold(f64::NEG_INFINITY, f64::max));
        (least <= most).then_some(Level { plane, least, most })
    }
}
