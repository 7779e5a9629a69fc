//! Plain loops for the widest vectors that the processor has.

use std::ops::{Add, Mul, Sub};

/// Runs `work`, compiled for AVX2 where the processor has it. The bits are those that it gives elsewhere: the compiler
/// never fuses a product and a sum by itself. What `work` calls is compiled for the same vectors only if it is inlined.
#[inline(always)]
pub fn vectorised<R>(work: impl FnOnce() -> R) -> R {
    pulp::Arch::new().dispatch(work)
}

/// a b + c, rounded once: one instruction within [`vectorised`], a call elsewhere, with the same bits.
#[expect(
    clippy::disallowed_methods,
    reason = "the one door: the bits are the same everywhere, but the call is slow outside of `vectorised`"
)]
#[inline(always)]
pub fn fused(a: f32, b: f32, c: f32) -> f32 {
    a.mul_add(b, c)
}

/// [`fused`] in double precision.
#[expect(
    clippy::disallowed_methods,
    reason = "the one door: the bits are the same everywhere, but the call is slow outside of `vectorised`"
)]
#[inline(always)]
pub fn fused_doubles(a: f64, b: f64, c: f64) -> f64 {
    a.mul_add(b, c)
}

/// Eight numbers. In code without branches they become one vector where the processor has such wide ones, of which none in
/// memory crosses a line of the cache.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(32))]
pub struct Lanes(pub [f32; LANES]);

/// How many numbers there are in [`Lanes`].
pub const LANES: usize = 8;

impl Lanes {
    /// The same number in each lane.
    #[inline(always)]
    pub fn all(number: f32) -> Lanes {
        Lanes([number; LANES])
    }

    /// The lesser number in each lane; `other`'s where one is not a number.
    #[inline(always)]
    pub fn min(self, other: Lanes) -> Lanes {
        self.with(
            other,
            #[inline(always)]
            |a, b| if a < b { a } else { b },
        )
    }

    /// The larger number in each lane; `other`'s where one is not a number.
    #[inline(always)]
    pub fn max(self, other: Lanes) -> Lanes {
        self.with(
            other,
            #[inline(always)]
            |a, b| if a > b { a } else { b },
        )
    }

    /// These times `by`, plus `more`, rounded once: see [`fused`].
    #[inline(always)]
    pub fn times(mut self, by: Lanes, more: Lanes) -> Lanes {
        for ((own, by), more) in self.0.iter_mut().zip(by.0).zip(more.0) {
            *own = fused(*own, by, more);
        }
        self
    }

    #[inline(always)]
    fn with(mut self, other: Lanes, of: impl Fn(f32, f32) -> f32) -> Lanes {
        for (own, other) in self.0.iter_mut().zip(other.0) {
            *own = of(*own, other);
        }
        self
    }
}

impl Add for Lanes {
    type Output = Lanes;

    #[inline(always)]
    fn add(self, other: Lanes) -> Lanes {
        self.with(other, |a, b| a + b)
    }
}

impl Sub for Lanes {
    type Output = Lanes;

    #[inline(always)]
    fn sub(self, other: Lanes) -> Lanes {
        self.with(other, |a, b| a - b)
    }
}

impl Mul for Lanes {
    type Output = Lanes;

    #[inline(always)]
    fn mul(self, other: Lanes) -> Lanes {
        self.with(other, |a, b| a * b)
    }
}
