//! Shepard's inverse distance weighting and its modified forms (equations 4.1 to 4.3).

use super::kernel::{Apart, Fate, Kernel, Pair, TOLERANCE_PX, gap2};
use crate::base::maths;

/// The share of [`TOLERANCE_PX`] that interpolated weights may take.
const SHARE: f64 = 0.25;

/// Weights of d^-2.
pub struct InverseSquare {
    gap2: f64,
    is_single: bool,
}

impl InverseSquare {
    /// The longest jump vectors, in pixels along x and y, that are summed in single precision. A weight is rounded three
    /// times, a term once and a sum at most [`super::kernel::GROUP`] times; all of that together moves a jump vector by at
    /// most 9e-7 of the longest, and what is summed at nodes by 5.2 times as much. Where all are the same they stay exact.
    const LONGEST_SINGLE: f64 = 100.0;

    /// For jump vectors that differ by at most `spread`, the `longest` of which is so long along x or y; `None` if the spread is
    /// too much for interpolated weights.
    pub fn new(spread: f64, longest: f64) -> Option<Self> {
        let gap2 = gap2(SHARE * TOLERANCE_PX / spread, |d2| 1.0 / d2)?;
        Some(InverseSquare { gap2, is_single: spread > 0.0 && longest <= Self::LONGEST_SINGLE })
    }
}

impl Kernel<3> for InverseSquare {
    const SINGLE: bool = true;

    #[inline(always)]
    fn weight(&self, d2: f64) -> f64 {
        maths::reciprocal_in_loops(d2)
    }

    fn is_single(&self) -> bool {
        self.is_single
    }

    #[inline(always)]
    fn weight_single(&self, d2: f32) -> f32 {
        1.0 / d2
    }

    fn fate(&self, apart: &Apart) -> Fate {
        far_or_near(apart, self.gap2)
    }

    #[inline(always)]
    fn jumps<const N: usize>(&self, sums: &[[f64; N]; 3], _xs: &[f64; N], _y: f64) -> [[f64; N]; 2] {
        means(sums)
    }
}

/// Weights of d^-power for small powers.
pub struct Power {
    half: f64,
    gap2: f64,
}

impl Power {
    /// The largest power: weights neither overflow nor underflow.
    const MOST: f64 = 30.0;

    /// For jump vectors that differ by at most `spread`; `None` if power or spread are too much for interpolated weights.
    pub fn new(power: f64, spread: f64) -> Option<Self> {
        let half = power / 2.0;
        let gap2 = |()| gap2(SHARE * TOLERANCE_PX / spread, |d2| maths::pow(d2, -half));
        Some(Power { half, gap2: (power <= Self::MOST).then_some(()).and_then(gap2)? })
    }
}

impl Kernel<3> for Power {
    #[inline(always)]
    fn weight(&self, d2: f64) -> f64 {
        maths::exp_in_loops(-self.half * maths::ln_in_loops(d2))
    }

    fn fate(&self, apart: &Apart) -> Fate {
        far_or_near(apart, self.gap2)
    }

    #[inline(always)]
    fn jumps<const N: usize>(&self, sums: &[[f64; N]; 3], _xs: &[f64; N], _y: f64) -> [[f64; N]; 2] {
        means(sums)
    }
}

/// Weights of d^-power, relative to that of the nearest anchor: no power overflows or underflows. For large powers, as
/// most anchors have no weight worth mentioning.
pub struct Steep {
    half: f64,
    /// Anchors farther than the nearest one by this factor, squared, do not count.
    beyond2: f64,
}

impl Steep {
    /// For `count` anchors with jump vectors that differ by at most `spread`.
    pub fn new(power: f64, spread: f64, count: usize) -> Self {
        let half = power / 2.0;
        let all = count as f64 * spread / (SHARE * TOLERANCE_PX);
        Steep { half, beyond2: maths::pow(all.max(1.0), 1.0 / half) }
    }
}

impl Kernel<3> for Steep {
    const RELATIVE: bool = true;

    #[inline(always)]
    fn weight(&self, d2: f64) -> f64 {
        d2
    }

    #[inline(always)]
    fn weight_near(&self, pair: Pair) -> f64 {
        maths::exp_in_loops(self.half * maths::ln_in_loops(pair.nearest2 / pair.d2))
    }

    fn fate(&self, apart: &Apart) -> Fate {
        if apart.nearest2 > self.beyond2 * apart.closest2 { Fate::Dropped } else { Fate::Near }
    }

    #[inline(always)]
    fn jumps<const N: usize>(&self, sums: &[[f64; N]; 3], _xs: &[f64; N], _y: f64) -> [[f64; N]; 2] {
        means(sums)
    }
}

/// Only anchors within a radius count; in the outer ring, at random.
pub struct Modified<const RANDOM: bool> {
    inverse_radius: f64,
    radius2: f64,
    /// Beyond this the ring begins.
    within2: f64,
    seed: u32,
    gap2: f64,
}

impl<const RANDOM: bool> Modified<RANDOM> {
    /// The share of [`TOLERANCE_PX`] that interpolated weights may take where they are d^-2, as they are near the anchor.
    /// Near the radius they are less; there [`Kernel::doubt`] finds places where the error is too large.
    const SHARE: f64 = 1.0 / 32.0;

    /// For jump vectors that differ by at most `spread`. `ring` is the width of the outer ring, 0 unless it is random.
    pub fn new(radius: f64, ring: f64, seed: u32, spread: f64) -> Self {
        let within = (radius - ring).max(0.0);
        Modified {
            inverse_radius: 1.0 / radius,
            radius2: radius * radius,
            within2: within * within,
            seed: seed.wrapping_mul(0x9E37_79B9),
            gap2: gap2(Self::SHARE * TOLERANCE_PX / spread, |d2| 1.0 / d2).unwrap_or(f64::INFINITY),
        }
    }
}

impl<const RANDOM: bool> Kernel<3> for Modified<RANDOM> {
    #[inline(always)]
    fn weight(&self, d2: f64) -> f64 {
        let w = maths::reciprocal_root_in_loops(d2) - self.inverse_radius;
        let w = if d2 < self.radius2 { w } else { 0.0 };
        w * w
    }

    #[inline(always)]
    fn weight_near(&self, pair: Pair) -> f64 {
        // Without a branch, which would keep the compiler from using vectors.
        let weight = self.weight(pair.d2);
        let in_ring = if RANDOM { weight * self.counts(pair) } else { weight };
        if pair.d2 > self.within2 { in_ring } else { weight }
    }

    fn fate(&self, apart: &Apart) -> Fate {
        if apart.nearest2 >= self.radius2 {
            Fate::Dropped
        } else if apart.farthest2 <= self.within2 {
            far_or_near(apart, self.gap2)
        } else {
            Fate::Near
        }
    }

    /// The error of (1/d - 1/R)² is at most that of 1/d² + 2/(d R), each to within a share of itself, and d <= R.
    fn doubt(&self, apart: &Apart) -> f64 {
        3.0 * Self::SHARE / apart.nearest2
    }

    #[inline(always)]
    fn jumps<const N: usize>(&self, sums: &[[f64; N]; 3], _xs: &[f64; N], _y: f64) -> [[f64; N]; 2] {
        means(sums)
    }
}

impl<const RANDOM: bool> Modified<RANDOM> {
    /// Whether an anchor counts for a pixel in the ring: k in equation 4.3, 0 or 1.
    #[inline(always)]
    fn counts(&self, pair: Pair) -> f64 {
        f64::from(pcg3d(pair.pixel[0], pair.pixel[1], pair.index.wrapping_add(self.seed))[0] >> 31)
    }
}

#[inline(always)]
fn far_or_near(apart: &Apart, gap2: f64) -> Fate {
    if apart.nearest2 >= gap2 * apart.half2 { Fate::Far } else { Fate::Near }
}

/// The weighted means; (0, 0) where all weights are 0.
#[inline(always)]
fn means<const N: usize>([weight, x, y]: &[[f64; N]; 3]) -> [[f64; N]; 2] {
    let mut means = [*x, *y];
    for k in 0..N {
        let one = if weight[k] > 0.0 { 1.0 / weight[k] } else { 0.0 };
        means[0][k] *= one;
        means[1][k] *= one;
    }
    means
}

/// The hash of Jarzynski and Olano 2020, "Hash Functions for GPU Rendering".
#[inline(always)]
pub fn pcg3d(x: u32, y: u32, z: u32) -> [u32; 3] {
    #[inline(always)]
    fn next(v: u32) -> u32 {
        v.wrapping_mul(1_664_525).wrapping_add(1_013_904_223)
    }
    #[inline(always)]
    fn mix([x, y, z]: [u32; 3]) -> [u32; 3] {
        let x = x.wrapping_add(y.wrapping_mul(z));
        let y = y.wrapping_add(z.wrapping_mul(x));
        [x, y, z.wrapping_add(x.wrapping_mul(y))]
    }
    let [x, y, z] = mix([next(x), next(y), next(z)]);
    mix([x ^ (x >> 16), y ^ (y >> 16), z ^ (z >> 16)])
}
