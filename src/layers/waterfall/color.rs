//! Colors of sprites: read between texels, kept within bounds, tinted and blended.

use crate::base::pixels::Rgba;

/// How much of a sprite is before the surface behind it.
pub fn before(surface: f64, depth: f64, soft: f64) -> f64 {
    if soft > 0.0 { ((surface - depth) / soft).clamp(0.0, 1.0) } else { f64::from(u8::from(depth < surface)) }
}

/// A color as read from texels, kept within bounds and tinted.
#[inline(always)]
pub fn shaded(color: Rgba, [r, g, b]: [f32; 3]) -> Rgba {
    let a = within(color[3], 1.0);
    let tinted: Rgba = std::array::from_fn(|c| within(color[c], a) * [r, g, b, 1.0][c]);
    tinted.map(|v| within(v, a))
}

/// A number kept between 0 and `most`; unlike `clamp` it is two instructions for four numbers at once.
#[inline(always)]
fn within(v: f32, most: f32) -> f32 {
    let v = if v > 0.0 { v } else { 0.0 };
    if v < most { v } else { most }
}

/// The bilinear read of texels at a place from -1/2 to 1/2.
#[inline(always)]
pub fn read(texels: &[Rgba], side: usize, [across, along]: [f64; 2]) -> Rgba {
    let ([left, right], u) = neighbors((across + 0.5) * side as f64, side);
    let ([above, below], v) = neighbors((along + 0.5) * side as f64, side);
    let before = mean(texels[above * side + left], texels[below * side + left], v);
    let after = mean(texels[above * side + right], texels[below * side + right], v);
    mean(before, after, u)
}

/// The texels before and after a place, and its share of the way; edges repeat.
#[inline(always)]
pub fn neighbors(place: f64, side: usize) -> ([usize; 2], f32) {
    let at = place - 0.5;
    let first = at.floor();
    let clamp = |i: f64| i.clamp(0.0, (side - 1) as f64) as usize;
    ([clamp(first), clamp(first + 1.0)], (at - first) as f32)
}

/// What is this share of the way from one color to another.
#[inline(always)]
pub fn mean(a: Rgba, b: Rgba, share: f32) -> Rgba {
    std::array::from_fn(|c| a[c] + (b[c] - a[c]) * share)
}

/// Adds light to what is there.
#[inline(always)]
pub fn screen(there: &mut Rgba, color: &Rgba, opacity: f32) {
    let own = color.map(|v| v * opacity);
    *there = std::array::from_fn(|c| own[c] + there[c] * (1.0 - own[c]));
}

/// Covers what is there.
#[inline(always)]
pub fn over(there: &mut Rgba, color: &Rgba, opacity: f32) {
    let own = color.map(|v| v * opacity);
    let rest = 1.0 - own[3];
    *there = std::array::from_fn(|c| own[c] + there[c] * rest);
}
