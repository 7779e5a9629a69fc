//! What rows of the frame read of a turned sprite.

use std::ops::Range;

use super::cells::{Covering, inside};
use super::splat::Splat;
use crate::base::simd::{LANES, Lanes};

/// What eight columns read.
#[derive(Clone, Copy, Default)]
pub struct Corners {
    /// The numbers of the texels to the left and above.
    pub first: [u16; LANES],
    /// The weights of these, of those to the right, below, and both.
    pub weights: [[f32; LANES]; 4],
}

/// The columns that a turned sprite covers, row by row.
pub struct Spans<'a> {
    drawn: &'a Covering<'a>,
    /// The places of the columns that it may cover, and how many there are in a pixel.
    places: &'a [f64],
    density: f64,
    /// Of both pairs of its sides: where their middle is for each pixel below its own, and how far they are from there.
    sides: [[f64; 2]; 2],
}

impl<'a> Spans<'a> {
    /// The columns of a sprite, of columns at these places.
    #[inline(always)]
    pub fn new(drawn: &'a Covering, places: &'a [f64]) -> Self {
        let Splat { size_px, turn, .. } = drawn.splat;
        // |a dx + b dy| < half, along each of its axes.
        let axes = [(turn.x, turn.y, size_px.x / 2.0), (-turn.y, turn.x, size_px.y / 2.0)];
        let mut sides = [[0.0, f64::INFINITY]; 2];
        for (sides, (a, b, half)) in sides.iter_mut().zip(axes) {
            if a.abs() > 1e-9 {
                *sides = [-b / a, half / a.abs()];
            }
        }
        let places = &places[drawn.columns.clone()];
        let wide = places[places.len() - 1] - places[0];
        let density = if wide > 0.0 { (places.len() - 1) as f64 / wide } else { 0.0 };
        Spans { drawn, places, density, sides }
    }

    /// The columns in the row at `y`.
    #[inline(always)]
    pub fn at(&self, y: f64) -> Range<usize> {
        let Splat { middle, .. } = self.drawn.splat;
        let [[one, first], [other, second]] = self.sides;
        let (one, other) = (middle.x + one * (y - middle.y), middle.x + other * (y - middle.y));
        let low = (one - first).max(other - second);
        let high = (one + first).min(other + second);
        // A little too far out, and then put right.
        let (mut from, mut to) = (self.first_from(low - 1e-3), self.first_from(high + 1e-3));
        while from < to && inside(self.drawn.splat, self.places[from], y).is_none() {
            from += 1;
        }
        while from < to && inside(self.drawn.splat, self.places[to - 1], y).is_none() {
            to -= 1;
        }
        let first = self.drawn.columns.start;
        first + from..first + to.max(from)
    }

    /// The number of the first place that is not less than `at`: guessed, as places are mostly evenly far apart, and put
    /// right.
    #[inline(always)]
    fn first_from(&self, at: f64) -> usize {
        let guess = (at - self.places[0]) * self.density;
        let mut from = (guess.max(0.0) as usize).min(self.places.len());
        while from > 0 && self.places[from - 1] >= at {
            from -= 1;
        }
        while from < self.places.len() && self.places[from] < at {
            from += 1;
        }
        from
    }
}

/// Which texels a row of the frame reads of a turned sprite: single precision, so that they are found fast.
pub struct Map {
    /// Across and along the sprite: at its middle, and for each pixel beside it, in texels.
    axes: [[f32; 2]; 2],
    side: f32,
    made_from: f32,
}

/// Whole numbers have a spacing of 1 here: what is added to this is rounded.
const WHOLE: f32 = 12_582_912.0;

impl Map {
    /// Which texels the row of the frame at `y` reads, of texels of which so many make a side, from row `made_from` on.
    #[inline(always)]
    pub fn new(splat: &Splat, y: f64, side: usize, made_from: usize) -> Map {
        let Splat { middle, size_px, turn, .. } = splat;
        let axis = |at: f64, each: f64, size: f64| {
            let scale = side as f64 / size;
            [(at * scale + (side - 1) as f64 / 2.0) as f32, (each * scale) as f32]
        };
        let (dy, sense) = (y - middle.y, if splat.mirrored { -1.0 } else { 1.0 });
        let across = axis(sense * turn.y * dy, sense * turn.x, size_px.x);
        let along = axis(turn.x * dy, -turn.y, size_px.y);
        Map { axes: [across, along], side: side as f32, made_from: made_from as f32 }
    }

    /// What columns this far beside the middle read; edges repeat.
    #[inline(always)]
    pub fn at(&self, dx: Lanes) -> Corners {
        let ((x, u), (y, v)) = (self.place(self.axes[0], dx), self.place(self.axes[1], dx));
        let number = (y - Lanes::all(self.made_from)) * Lanes::all(self.side) + x + Lanes::all(WHOLE);
        let mut first = [0; LANES];
        for (first, number) in first.iter_mut().zip(number.0) {
            *first = number.to_bits().wrapping_sub(WHOLE.to_bits()) as u16;
        }
        let (before, above) = (Lanes::all(1.0) - u, Lanes::all(1.0) - v);
        Corners { first, weights: [(before * above).0, (u * above).0, (before * v).0, (u * v).0] }
    }

    /// The texels before places along an axis, and the shares of the ways to the next ones.
    #[inline(always)]
    fn place(&self, [middle, each]: [f32; 2], dx: Lanes) -> (Lanes, Lanes) {
        let at = Lanes::all(middle) + dx * Lanes::all(each);
        let at = at.max(Lanes::all(0.0)).min(Lanes::all(self.side - 1.0));
        let (half, whole) = (Lanes::all(0.5), Lanes::all(WHOLE));
        let before = (at - half + whole - whole).min(Lanes::all(self.side - 2.0));
        (before, at - before)
    }
}
