//! Colors of sprites one at a time: read between texels, kept within bounds and tinted.

use glam::Vec4;

use crate::base::pixels::Rgba;

/// How much of a sprite is before the surface behind it.
#[inline(always)]
pub fn before(surface: f64, depth: f64, soft: f64) -> f64 {
    if soft > 0.0 { ((surface - depth) / soft).clamp(0.0, 1.0) } else { f64::from(u8::from(depth < surface)) }
}

/// A color as read from texels, kept within bounds and tinted; the tint is 0 or more, and its last number 1.
#[inline(always)]
pub fn shaded(color: Vec4, tint: Vec4) -> Vec4 {
    let color = color.max(Vec4::ZERO);
    let most = Vec4::splat(color.w).min(Vec4::ONE);
    (color.min(most) * tint).min(most)
}

/// The bilinear read of texels at a place from -1/2 to 1/2.
#[inline(always)]
pub fn read(texels: &[Rgba], side: usize, [across, along]: [f64; 2]) -> Vec4 {
    let ([left, right], u) = neighbors((across + 0.5) * side as f64, side);
    let ([above, below], v) = neighbors((along + 0.5) * side as f64, side);
    let texel = |x: usize, y: usize| Vec4::from(texels[y * side + x]);
    let before = mean(texel(left, above), texel(left, below), v);
    let after = mean(texel(right, above), texel(right, below), v);
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
pub fn mean(a: Vec4, b: Vec4, share: f32) -> Vec4 {
    a + (b - a) * share
}
