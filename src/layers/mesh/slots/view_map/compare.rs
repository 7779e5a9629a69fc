//! The views of a map drawn again, each from its own camera: how near that comes to their pictures.

use rayon::prelude::*;

use super::again::Again;
use super::looked::Filled;
use super::sample::Reader;
use crate::base::maths::ln;
use crate::base::pixels::{Rgba, encode};

/// The least cosine between the normal and the way to the camera.
const LEAST_NORMAL: f64 = 0.2;

/// The peak signal-to-noise ratio of each active view, in dB; `None` if nothing of it is seen, infinite if there is no
/// difference at all.
pub fn compare(filled: Filled) -> Vec<Option<f64>> {
    (0..filled.0.wanted.views.len()).map(|view| one(filled, view)).collect()
}

fn one((map, arrays): Filled, view: usize) -> Option<f64> {
    let own = &map.wanted.views[view];
    let (again, (width, height), pixels) = (Again::new(map, own), own.camera.size_px, own.paint.pixels());
    let rows = (0..height).into_par_iter().map(|y| {
        let (mut sum, mut count, mut reader) = (0_u64, 0_u64, Reader::new(map, arrays));
        again.row(y, |x, normal, spot| {
            let picture = pixels[y * width + x];
            if picture[3] < 1.0 || normal < LEAST_NORMAL {
                return;
            }
            let [r, g, b] = reader.at(spot, None).over.map(|light| light as f32);
            sum += squares([r, g, b, 1.0], picture);
            count += 3;
        });
        (sum, count)
    });
    let (sum, count) = rows.reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
    (count > 0).then(|| 10.0 / std::f64::consts::LN_10 * ln(255.0 * 255.0 * count as f64 / sum as f64))
}

/// The squares of the differences between codes.
fn squares(own: Rgba, picture: Rgba) -> u64 {
    let (own, picture) = (encode(own), encode(picture));
    own.iter().zip(picture).map(|(own, picture)| u64::from(own.abs_diff(picture)).pow(2)).sum()
}
