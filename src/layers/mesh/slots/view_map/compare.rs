//! The views of a map drawn again, each from its own camera: how near that comes to their pictures.

use rayon::prelude::*;

use super::again::Again as Looking;
use super::looked::Filled;
use super::sample::Reader;
use crate::base::maths::ln;
use crate::base::pixels::{Rgba, encode};
use crate::base::progress::Watch;

/// The least cosine between the normal and the way to the camera.
const LEAST_NORMAL: f64 = 0.2;

/// How a view comes back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Again {
    /// The peak signal-to-noise ratio in dB, infinite if there is no difference at all.
    pub psnr: f64,
    /// The share that it has itself in what is seen from its camera, from 0 to 1.
    pub share: f64,
}

/// How each active view comes back; `None` if nothing of it is seen, or it was stopped.
pub fn compare(filled: Filled, watch: &Watch) -> Vec<Option<Again>> {
    let one = |view| {
        let again = one(filled, view, watch);
        (watch.done)(view);
        again
    };
    (0..filled.0.wanted.views.len()).map(one).collect()
}

fn one((map, arrays): Filled, view: usize, watch: &Watch) -> Option<Again> {
    if (watch.stopped)() {
        return None;
    }
    let own = &map.wanted.views[view];
    let (looking, (width, height), pixels) = (Looking::new(map, own), own.camera.size_px, own.paint.pixels());
    let rows = (0..height).into_par_iter().map(|y| {
        let (mut sum, mut count, mut share, mut reader) = (0_u64, 0_u64, 0.0, Reader::new(map, arrays));
        if (watch.stopped)() {
            return (sum, count, share);
        }
        looking.row(y, |x, normal, spot| {
            let picture = pixels[y * width + x];
            if picture[3] < 1.0 || normal < LEAST_NORMAL {
                return;
            }
            let [r, g, b] = reader.at(spot, None).over.map(|light| light as f32);
            sum += squares([r, g, b, 1.0], picture);
            count += 1;
            reader.everyone(spot, |one, has| share += if one == view { has } else { 0.0 });
        });
        (sum, count, share)
    });
    // Row by row, so that the sum of shares does not depend on the threads.
    let rows: Vec<(u64, u64, f64)> = rows.collect();
    let (sum, count, share) = rows.iter().fold((0, 0, 0.0), |sum, row| (sum.0 + row.0, sum.1 + row.1, sum.2 + row.2));
    (count > 0).then(|| Again {
        psnr: 10.0 / std::f64::consts::LN_10 * ln(255.0 * 255.0 * 3.0 * count as f64 / sum as f64),
        share: share / count as f64,
    })
}

/// The squares of the differences between codes.
fn squares(own: Rgba, picture: Rgba) -> u64 {
    let (own, picture) = (encode(own), encode(picture));
    own.iter().zip(picture).map(|(own, picture)| u64::from(own.abs_diff(picture)).pow(2)).sum()
}
