//! Shepard's inverse distance weighting and its modified forms (equations 4.1 to 4.3).

use super::{Jumps, Method, RUN, Run};
use crate::base::maths;
use crate::layers::folding::anchor::Anchor;

/// Weighted sums over the places of a run.
struct Sums {
    /// Image coordinates of the places.
    xs: [f64; RUN],
    at_y: f64,
    weight: [f64; RUN],
    x: [f64; RUN],
    y: [f64; RUN],
}

impl Sums {
    fn new(run: &Run) -> Self {
        Sums { xs: run.xs(), at_y: run.y(), weight: [0.0; RUN], x: [0.0; RUN], y: [0.0; RUN] }
    }

    /// Adds `anchor`; `weight` gives its weight from the index of a place and its squared distance.
    #[inline(always)]
    fn add(&mut self, anchor: &Anchor, weight: impl Fn(usize, f64) -> f64) {
        let dy = self.at_y - anchor.at.y;
        let dy2 = dy * dy;
        for k in 0..RUN {
            let dx = self.xs[k] - anchor.at.x;
            let w = weight(k, dx * dx + dy2);
            self.weight[k] += w;
            self.x[k] += w * anchor.jump.x;
            self.y[k] += w * anchor.jump.y;
        }
    }

    /// Writes the weighted means; (0, 0) where all weights are 0.
    fn write(&self, out: &mut Jumps) {
        for k in 0..RUN {
            let any = self.weight[k] > 0.0;
            out.x[k] = if any { self.x[k] / self.weight[k] } else { 0.0 };
            out.y[k] = if any { self.y[k] / self.weight[k] } else { 0.0 };
        }
    }
}

/// Every anchor counts with weight d^-power.
pub struct Shepard {
    /// The power.
    pub power: f64,
}

impl Method for Shepard {
    /// Places exactly at an anchor get undefined values.
    fn run(&self, anchors: &[Anchor], run: &Run, out: &mut Jumps) {
        let mut sums = Sums::new(run);
        if self.power == 2.0 {
            anchors.iter().for_each(|anchor| sums.add(anchor, |_, d2| 1.0 / d2));
        } else {
            // Relative to the nearest anchor, so that no power overflows or underflows.
            let mut nearest2 = [f64::INFINITY; RUN];
            for anchor in anchors {
                let dy = run.y() - anchor.at.y;
                for (nearest, x) in nearest2.iter_mut().zip(sums.xs) {
                    let dx = x - anchor.at.x;
                    *nearest = nearest.min(dx * dx + dy * dy);
                }
            }
            let half = self.power / 2.0;
            anchors.iter().for_each(|anchor| {
                sums.add(
                    anchor,
                    |k, d2| if k < run.len && d2 > 0.0 { maths::pow(nearest2[k] / d2, half) } else { 0.0 },
                );
            });
        }
        sums.write(out);
    }
}

/// Only anchors within `radius` pixels count; in the outer ring, at random.
pub struct Modified {
    /// Anchors farther than this do not count, in pixels.
    pub radius: f64,
    /// Width of the outer ring in pixels, and the seed.
    pub ring: Option<(f64, u32)>,
}

impl Method for Modified {
    /// Uses only the anchors that reach the run. Places exactly at an anchor get undefined values.
    fn run(&self, anchors: &[Anchor], run: &Run, out: &mut Jumps) {
        let mut sums = Sums::new(run);
        let radius2 = self.radius * self.radius;
        for (index, anchor) in anchors.iter().enumerate().filter(|(_, anchor)| run.reach2(anchor) < radius2) {
            match self.ring {
                None => sums.add(anchor, |_, d2| self.weight(d2)),
                Some((ring, seed)) => sums.add(anchor, |k, d2| {
                    let d = d2.sqrt();
                    let in_ring = self.radius - ring < d && d < self.radius;
                    if in_ring && !counts(run, k, index, seed) { 0.0 } else { self.weight(d2) }
                }),
            }
        }
        sums.write(out);
    }
}

impl Modified {
    fn weight(&self, d2: f64) -> f64 {
        let d = d2.sqrt();
        let w = (self.radius - d).max(0.0) / (self.radius * d);
        w * w
    }
}

/// Whether an anchor counts for a pixel in the ring: k = 1 in equation 4.3.
fn counts(run: &Run, k: usize, anchor: usize, seed: u32) -> bool {
    let (i, j) = run.pixel;
    pcg3d(i.wrapping_add(k as u32), j, (anchor as u32).wrapping_add(seed.wrapping_mul(0x9E37_79B9)))[0] >> 31 == 1
}

/// The hash of Jarzynski and Olano 2020, "Hash Functions for GPU Rendering".
pub fn pcg3d(x: u32, y: u32, z: u32) -> [u32; 3] {
    let mix = |[x, y, z]: [u32; 3]| {
        let x = x.wrapping_add(y.wrapping_mul(z));
        let y = y.wrapping_add(z.wrapping_mul(x));
        [x, y, z.wrapping_add(x.wrapping_mul(y))]
    };
    let v = mix([x, y, z].map(|v| v.wrapping_mul(1_664_525).wrapping_add(1_013_904_223)));
    mix(v.map(|v| v ^ (v >> 16)))
}
