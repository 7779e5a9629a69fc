//! Moving least squares by rigid motions (Schaefer, McPhail and Warren 2006), weights d^-2.

use super::kernel::{Apart, Fate, Kernel, TOLERANCE_PX, gap2};
use crate::base::maths;
use crate::layers::folding::anchor::Anchor;

/// If the sum that determines the rotation is no larger than this (in square pixels), the rotation is undefined.
const UNDEFINED_PX2: f64 = 1e-20;

/// The share of [`super::kernel::TOLERANCE_PX`] that interpolated weights may take.
const SHARE: f64 = 1.0 / 32.0;

/// The method: sums of w, w p, w u, w p·(p + u) and w p×u over anchors (p, u).
pub struct Rigid {
    /// Places are relative to this one.
    origin: [f64; 2],
    gap2: f64,
}

impl Rigid {
    /// For anchors with jump vectors that differ by at most `spread`; there is at least one.
    pub fn new(anchors: &[Anchor], spread: f64) -> Self {
        let places = anchors.iter().map(|anchor| [anchor.at.x, anchor.at.y]);
        let extent = super::kernel::spread(places.clone());
        let origin = [0, 1].map(|k| places.clone().map(|place| place[k]).sum::<f64>() / anchors.len() as f64);
        let gap2 = gap2(SHARE * TOLERANCE_PX / (extent + spread), |d2| 1.0 / d2);
        Rigid { origin, gap2: gap2.unwrap_or(f64::INFINITY) }
    }

    /// What is summed for an anchor.
    pub fn terms(&self, anchor: &Anchor) -> [f64; 7] {
        let [x, y] = [anchor.at.x - self.origin[0], anchor.at.y - self.origin[1]];
        let (u, v) = (anchor.jump.x, anchor.jump.y);
        [1.0, x, y, u, v, x * (x + u) + y * (y + v), x * v - y * u]
    }
}

impl Kernel<7> for Rigid {
    #[inline(always)]
    fn weight(&self, d2: f64) -> f64 {
        maths::reciprocal_in_loops(d2)
    }

    fn fate(&self, apart: &Apart) -> Fate {
        if apart.nearest2 >= self.gap2 * apart.half2 { Fate::Far } else { Fate::Near }
    }

    #[inline(always)]
    fn jumps<const N: usize>(&self, sums: &[[f64; N]; 7], xs: &[f64; N], y: f64) -> [[f64; N]; 2] {
        let [weight, px, py, ux, uy, dot, cross] = sums;
        let mut jumps = [[0.0; N]; 2];
        for k in 0..N {
            let one = 1.0 / weight[k];
            // The weighted centers of the anchors and of where they go, and the rotation as a complex number: the sum of
            // w conj(p - p*) (p + u - q*).
            let (cx, cy) = (px[k] * one, py[k] * one);
            let (mx, my) = (ux[k] * one, uy[k] * one);
            let re = dot[k] * one - (cx * (cx + mx) + cy * (cy + my));
            let im = cross[k] * one - (cx * my - cy * mx);
            let size = (re * re + im * im).sqrt();
            let turns = size > UNDEFINED_PX2;
            let (cos, sin) = if turns { (re / size, im / size) } else { (1.0, 0.0) };
            let (fx, fy) = (cx + self.origin[0] - xs[k], cy + self.origin[1] - y);
            jumps[0][k] = fx + mx - (cos * fx - sin * fy);
            jumps[1][k] = fy + my - (sin * fx + cos * fy);
        }
        jumps
    }
}
