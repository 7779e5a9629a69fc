//! Colors channel by channel, and how a row of them is laid on what is there: plain loops over plain numbers, as many at a
//! time as the processor takes.

use glam::{Mat4, Vec4};

use super::color::before;
use super::model::Mixing;
use super::splat::Splat;
use super::synth::Synth;
use crate::base::pixels::Rgba;
use crate::base::simd::{LANES, Lanes};

/// Eight colors, channel by channel.
pub type Block = [Lanes; 4];

/// Eight colors, as found for numbers from 0 to 7.
#[inline(always)]
pub fn block(color: impl Fn(usize) -> Vec4) -> Block {
    let mut block = Block::default();
    for half in [0, 4] {
        let four = Mat4::from_cols(color(half), color(half + 1), color(half + 2), color(half + 3)).transpose();
        let channels = [four.x_axis, four.y_axis, four.z_axis, four.w_axis];
        for (block, channel) in block.iter_mut().zip(channels) {
            block.0[half..half + 4].copy_from_slice(&channel.to_array());
        }
    }
    block
}

/// Rows of colors, the channels of each one after the other.
#[derive(Default)]
pub struct Planes {
    /// Numbers of a channel of a row: blocks that begin in the last column fit in.
    pitch: usize,
    numbers: Vec<f32>,
}

impl Planes {
    /// Takes rows of this width from what is shown.
    #[inline(always)]
    pub fn take(&mut self, width: usize, shown: &[Rgba]) {
        self.pitch = width.next_multiple_of(LANES) + LANES;
        self.numbers.clear();
        self.numbers.resize(shown.len() / width * 4 * self.pitch, 0.0);
        for (row, shown) in self.numbers.chunks_exact_mut(4 * self.pitch).zip(shown.chunks_exact(width)) {
            for (x, color) in shown.iter().enumerate() {
                for c in 0..4 {
                    row[c * self.pitch + x] = color[c];
                }
            }
        }
    }

    /// Writes what is shown.
    #[inline(always)]
    pub fn give(&self, width: usize, out: &mut [Rgba]) {
        for (row, out) in self.numbers.chunks_exact(4 * self.pitch).zip(out.chunks_exact_mut(width)) {
            for (x, color) in out.iter_mut().enumerate() {
                for c in 0..4 {
                    color[c] = row[c * self.pitch + x];
                }
            }
        }
    }

    /// The channels of a row from a column on, so many blocks.
    #[inline(always)]
    pub fn row(&mut self, y: usize, x: usize, blocks: usize) -> [&mut [[f32; LANES]]; 4] {
        let row = &mut self.numbers[4 * self.pitch * y..][..4 * self.pitch];
        let (front, back) = row.split_at_mut(2 * self.pitch);
        let ((r, g), (b, a)) = (front.split_at_mut(self.pitch), back.split_at_mut(self.pitch));
        [part(r, x, blocks), part(g, x, blocks), part(b, x, blocks), part(a, x, blocks)]
    }
}

/// So many blocks from a column on.
#[inline(always)]
fn part(channel: &mut [f32], x: usize, blocks: usize) -> &mut [[f32; LANES]] {
    channel[x..][..blocks * LANES].as_chunks_mut().0
}

/// 1 in so many of the first lanes.
const FIRST: [[f32; LANES]; LANES + 1] = {
    let mut first = [[0.0; LANES]; LANES + 1];
    let mut k = 0;
    while k < LANES * LANES {
        first[k / LANES + 1][k % LANES] = if k % LANES <= k / LANES { 1.0 } else { 0.0 };
        k += 1;
    }
    first
};

/// How a sprite is blended with what is there.
pub struct Blend {
    mixing: Mixing,
    /// Whether all surfaces are too far behind to matter.
    clear: bool,
    opacity: f32,
    tint: [f32; 4],
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
            tint: splat.tint.to_array(),
            depth: splat.depth,
            soft: synth.values.soft,
        }
    }

    /// Lays colors as read from texels, block by block, on what is there, in as many columns as there are depths of
    /// surfaces.
    #[inline(always)]
    pub fn lay(&self, color: impl Fn(usize) -> Block, depth: &[f64], out: [&mut [[f32; LANES]]; 4]) {
        let opacity = Lanes::all(self.opacity);
        if self.clear {
            // Only the last block has lanes that there are too many.
            let last = depth.len().saturating_sub(1) / LANES;
            let shares = [opacity, opacity * Lanes(FIRST[depth.len() - last * LANES])];
            self.all(
                color,
                #[inline(always)]
                |i| shares[usize::from(i == last)],
                out,
            );
        } else {
            self.all(
                color,
                #[inline(always)]
                |i| {
                    let mut share = Lanes::default();
                    for (share, behind) in share.0.iter_mut().zip(&depth[i * LANES..]) {
                        *share = before(*behind, self.depth, self.soft) as f32;
                    }
                    opacity * share
                },
                out,
            );
        }
    }

    /// Lays colors, of which a share is there, on what is there.
    #[inline(always)]
    fn all(&self, color: impl Fn(usize) -> Block, share: impl Fn(usize) -> Lanes, out: [&mut [[f32; LANES]]; 4]) {
        match self.mixing {
            Mixing::Screen => self.mixed(
                color,
                share,
                #[inline(always)]
                |own, _| own,
                out,
            ),
            Mixing::Over => self.mixed(
                color,
                share,
                #[inline(always)]
                |_, alpha| alpha,
                out,
            ),
        }
    }

    /// The same; `hides` gives, from a number and the alpha, the share of the background that is hidden.
    #[inline(always)]
    fn mixed(
        &self,
        color: impl Fn(usize) -> Block,
        share: impl Fn(usize) -> Lanes,
        hides: impl Fn(Lanes, Lanes) -> Lanes,
        [r, g, b, a]: [&mut [[f32; LANES]]; 4],
    ) {
        let (zero, one) = (Lanes::all(0.0), Lanes::all(1.0));
        let tint = [Lanes::all(self.tint[0]), Lanes::all(self.tint[1]), Lanes::all(self.tint[2])];
        for (i, (((r, g), b), a)) in r.iter_mut().zip(g).zip(b).zip(a).enumerate() {
            let (color, share) = (color(i), share(i));
            let most = color[3].max(zero).min(one);
            let alpha = most * share;
            for (c, out) in [r, g, b].into_iter().enumerate() {
                let own = (color[c].max(zero).min(most) * tint[c]).min(most) * share;
                *out = (own + Lanes(*out) * (one - hides(own, alpha))).0;
            }
            *a = (alpha + Lanes(*a) * (one - alpha)).0;
        }
    }
}
