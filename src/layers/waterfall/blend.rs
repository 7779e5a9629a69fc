//! How colors are laid on what is there, two of them at a time: plain loops over plain numbers, as vectors of eight hold
//! two colors just as they are in memory.

use std::hint::black_box;

use glam::Vec4;

use super::color::before;
use super::model::Mixing;
use super::splat::Splat;
use super::synth::Synth;
use crate::base::pixels::Rgba;
use crate::base::simd::{LANES, Lanes};

/// Colors in a vector.
pub const PAIR: usize = 2;

/// Two colors, one after the other.
#[inline(always)]
pub fn pair(first: Vec4, second: Vec4) -> Lanes {
    let mut pair = Lanes::default();
    pair.0[..4].copy_from_slice(&first.to_array());
    pair.0[4..].copy_from_slice(&second.to_array());
    pair
}

/// Rows of colors.
#[derive(Default)]
pub struct Sheet {
    /// Colors of a row: a pair that begins in the last column fits in.
    pitch: usize,
    colors: Vec<Rgba>,
}

impl Sheet {
    /// Takes rows of this width from what is shown.
    #[inline(always)]
    pub fn take(&mut self, width: usize, shown: &[Rgba]) {
        self.pitch = width + PAIR - 1;
        self.colors.clear();
        self.colors.resize(shown.len() / width * self.pitch, [0.0; 4]);
        for (row, shown) in self.colors.chunks_exact_mut(self.pitch).zip(shown.chunks_exact(width)) {
            row[..width].copy_from_slice(shown);
        }
    }

    /// Writes what is shown.
    #[inline(always)]
    pub fn give(&self, width: usize, out: &mut [Rgba]) {
        for (row, out) in self.colors.chunks_exact(self.pitch).zip(out.chunks_exact_mut(width)) {
            out.copy_from_slice(&row[..width]);
        }
    }

    /// So many pairs of a row from a column on.
    #[inline(always)]
    pub fn row(&mut self, y: usize, x: usize, pairs: usize) -> &mut [[f32; LANES]] {
        self.colors[self.pitch * y + x..][..PAIR * pairs].as_flattened_mut().as_chunks_mut().0
    }
}

/// 1 in the first of two colors, and 0 in the other.
const FIRST: Lanes = Lanes([1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0]);

/// How a sprite is blended with what is there.
pub struct Blend {
    mixing: Mixing,
    /// Whether all surfaces are too far behind to matter.
    clear: bool,
    opacity: f32,
    /// The tint of two colors; `None` if it changes nothing.
    tint: Option<Lanes>,
    depth: f64,
    soft: f64,
}

impl Blend {
    /// How a sprite is blended.
    #[inline(always)]
    pub fn new(synth: &Synth, splat: &Splat, clear: bool) -> Blend {
        Blend {
            mixing: synth.blend,
            clear,
            opacity: splat.opacity as f32,
            tint: (splat.tint != Vec4::ONE).then(|| pair(splat.tint, splat.tint)),
            depth: splat.depth,
            soft: synth.values.soft,
        }
    }

    /// Lays colors as read from texels, pair by pair, on what is there, in as many columns as there are depths of surfaces.
    #[inline(always)]
    pub fn lay(&self, color: impl Fn(usize) -> Lanes, depth: &[f64], out: &mut [[f32; LANES]]) {
        match (self.mixing, self.tint) {
            (Mixing::Screen, None) => self.all(Laid::<false, false, _>::new(color, self.tint), depth, out),
            (Mixing::Screen, Some(_)) => self.all(Laid::<false, true, _>::new(color, self.tint), depth, out),
            (Mixing::Over, None) => self.all(Laid::<true, false, _>::new(color, self.tint), depth, out),
            (Mixing::Over, Some(_)) => self.all(Laid::<true, true, _>::new(color, self.tint), depth, out),
        }
    }

    #[inline(always)]
    fn all<const OVER: bool, const TINTED: bool, C: Fn(usize) -> Lanes>(
        &self,
        laid: Laid<OVER, TINTED, C>,
        depth: &[f64],
        out: &mut [[f32; LANES]],
    ) {
        let opacity = Lanes::all(self.opacity);
        if self.clear {
            let Some((last, others)) = out.split_last_mut() else { return };
            for (i, out) in others.iter_mut().enumerate() {
                *out = laid.on(Lanes(*out), i, opacity).0;
            }
            let share = if depth.len().is_multiple_of(PAIR) { opacity } else { opacity * FIRST };
            *last = laid.on(Lanes(*last), others.len(), share).0;
            return;
        }
        for (i, (out, depth)) in out.iter_mut().zip(depth.chunks(PAIR)).enumerate() {
            // What is beyond the last column is not there.
            let mut shares = [0.0; PAIR];
            for (share, behind) in shares.iter_mut().zip(depth) {
                *share = before(*behind, self.depth, self.soft) as f32;
            }
            let shares = pair(Vec4::splat(shares[0]), Vec4::splat(shares[1]));
            *out = laid.on(Lanes(*out), i, opacity * shares).0;
        }
    }
}

/// Colors that are laid on others, of which they hide their alpha if they lie `OVER` them, otherwise as much as they are
/// themselves.
struct Laid<const OVER: bool, const TINTED: bool, C> {
    color: C,
    tint: Lanes,
}

impl<const OVER: bool, const TINTED: bool, C: Fn(usize) -> Lanes> Laid<OVER, TINTED, C> {
    #[inline(always)]
    fn new(color: C, tint: Option<Lanes>) -> Self {
        Laid { color, tint: tint.unwrap_or_default() }
    }

    /// Pair `i`, of which a share is there, on `others`.
    #[inline(always)]
    fn on(&self, others: Lanes, i: usize, share: Lanes) -> Lanes {
        // Nothing, but the compiler leaves loops over pairs as they are: those over single channels take half as long again.
        black_box(());
        let (zero, one) = (Lanes::all(0.0), Lanes::all(1.0));
        let color = (self.color)(i).max(zero);
        let mut own = color.min(one).min(alphas(color));
        if TINTED {
            own = (own * self.tint).min(alphas(own));
        }
        let own = own * share;
        let hidden = if OVER { alphas(own) } else { own };
        others.times(one - hidden, own)
    }
}

/// The alphas of two colors, each in all lanes of its color.
#[inline(always)]
fn alphas(Lanes([_, _, _, a, _, _, _, b]): Lanes) -> Lanes {
    Lanes([a, a, a, a, b, b, b, b])
}
