//! Draws sprites into a frame. Every pixel meets them in the same order, whatever the number of threads: the frame is cut
//! into strips, and each strip draws all its sprites one after the other.

use std::cmp::Reverse;

use rayon::prelude::*;

use super::cells::{Covering, covered};
use super::model::Mixing;
use super::splat::Splat;
use super::strip::{Scratch, Strip};
use super::synth::Synth;
use crate::base::pixels::Rgba;
use crate::base::simd::vectorised;

/// Rows of a strip: few enough that what is drawn on stays close to the processor, and that all threads have work.
const ROWS: usize = 64;

/// Where a frame is looked at, and what is there already.
pub struct Canvas<'a> {
    /// The places of columns, and of rows, in pixels of the frame: ascending.
    pub places: [Vec<f64>; 2],
    /// How far away the surface is at each place, row by row, in meters; infinite where there is none.
    pub depth: &'a [f64],
    /// What is there, linear light, premultiplied.
    pub out: &'a mut [Rgba],
}

/// The sprites that are seen, in the order in which they are drawn.
pub fn in_order(blend: Mixing, splats: &[Splat]) -> Vec<&Splat> {
    let mut order: Vec<&Splat> = splats.iter().filter(|splat| splat.opacity > 0.0).collect();
    if blend == Mixing::Over {
        order.sort_by_key(|splat| Reverse((1024.0 * splat.depth + 0.5).floor() as i64));
    }
    order
}

/// The sprites that cover cells, in the order in which they are drawn.
pub fn drawn<'a>(blend: Mixing, splats: &'a [Splat], places: &[Vec<f64>; 2]) -> Vec<Covering<'a>> {
    let cells = |splat: &'a Splat| {
        let [columns, rows] = covered(splat, places)?;
        Some(Covering { splat, columns, rows })
    };
    in_order(blend, splats).into_par_iter().filter_map(cells).collect()
}

/// For each strip of so many rows, the numbers of the sprites that it draws.
pub fn bins(drawn: &[Covering], rows: usize) -> Vec<Vec<u32>> {
    let mut bins = vec![Vec::new(); rows.div_ceil(ROWS)];
    for (i, drawn) in drawn.iter().enumerate() {
        let strips = drawn.rows.start / ROWS..drawn.rows.end.div_ceil(ROWS);
        bins[strips].iter_mut().for_each(|bin| bin.push(i as u32));
    }
    bins
}

/// Draws sprites.
pub fn draw(synth: &Synth, splats: &[Splat], canvas: Canvas) {
    let Canvas { places, depth, out } = canvas;
    let width = places[0].len();
    if width == 0 || out.is_empty() {
        return;
    }
    let drawn = drawn(synth.blend, splats, &places);
    let bins = bins(&drawn, places[1].len());
    let cells = ROWS * width;
    let strips = out.chunks_mut(cells).zip(depth.chunks(cells)).zip(bins).enumerate();
    let mut strips: Vec<_> = strips.filter(|(_, (_, bin))| !bin.is_empty()).collect();
    // Those with most to do first, each to the thread that has nothing to do: none waits long for the last one.
    strips.sort_by_key(|(_, (_, bin))| Reverse(bin.len()));
    strips.into_iter().par_bridge().for_each_init(Scratch::default, |scratch, (i, ((out, depth), bin))| {
        vectorised(
            #[inline(always)]
            || {
                let mut strip = Strip::new(synth, &places, i * ROWS, (depth, out), scratch);
                for i in bin {
                    strip.lay(&drawn[i as usize]);
                }
                strip.finish(out);
            },
        );
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::picture::Picture;
    use crate::layers::parts::materials::Materials;
    use crate::layers::ready::Making;
    use crate::layers::timeline::Wrap;
    use crate::layers::waterfall::between::{Mix, texels};
    use crate::layers::waterfall::births::Alive;
    use crate::layers::waterfall::cells::inside;
    use crate::layers::waterfall::color::{before, read, shaded};
    use crate::layers::waterfall::hash::Random;
    use glam::{DVec2, DVec3, Vec4};
    use std::sync::Arc;

    const SIDE: usize = 16;
    const SIZE: (usize, usize) = (70, 67);

    /// Sprites of two keys with edges that cover.
    fn synth() -> Synth {
        let texel = |i: u32| Random(7).of(i, 0, 0).map(|v| v as f32);
        let cells =
            (0..2 * SIDE as u32 * SIDE as u32).map(texel).map(|[r, g, b, a]| [r * a, g * a, b * a, a]).collect();
        let image = Arc::new(Picture::from_cells(2 * SIDE, SIDE, cells));
        let materials = Materials { pictures: [("s".to_owned(), image)].into(), ..Materials::default() };
        let layer = r#"{"name": "f", "sprites": {"size": 16, "sheets": [{"image": "s", "columns": 2}]}}"#;
        Synth::new(&serde_json::from_str(layer).unwrap(), &Making::plain(Wrap::Repeat, &materials), None).unwrap()
    }

    fn splat(i: u32) -> Splat {
        let ([x, y, wide, long], [angle, depth, u, mirrored]) = (Random(2).of(i, 0, 0), Random(2).of(i, 1, 0));
        let angle = if i.is_multiple_of(3) { 0.0 } else { 360.0 * angle - 180.0 };
        let mut mix = Mix::of(&[((0, 0), 1.0 - u as f32), ((0, 1), u as f32)]);
        if !i.is_multiple_of(4) {
            (mix.slopes, mix.residue) = ([[0.7, -0.4], [-0.2, 0.9]], Some((0, 0, 0.1)));
        }
        Splat {
            line: 0,
            foam: false,
            alive: Alive { birth: i, born: 0.0, age: 0.0, own: [0.0; 4] },
            life: 1.0,
            at: DVec3::ZERO,
            middle: DVec2::new(80.0 * x - 5.0, 80.0 * y - 5.0),
            depth: 4.0 + 2.0 * depth,
            size_px: DVec2::new(2.0 + 28.0 * wide, 2.0 + 40.0 * long),
            angle,
            turn: if angle == 0.0 { DVec2::X } else { DVec2::from_angle(angle.to_radians()) },
            mirrored: mirrored < 0.5,
            opacity: 0.1 + 0.5 * wide,
            tint: if i.is_multiple_of(5) { Vec4::ONE } else { Vec4::new(0.5, 1.0, 3.0, 1.0) },
            level: if i.is_multiple_of(2) { 0 } else { 1 },
            key: (0, u),
            mix,
        }
    }

    /// Pixel by pixel, each with all sprites.
    fn plainly(synth: &Synth, splats: &[Splat], canvas: Canvas) {
        let Canvas { places: [columns, rows], depth, out } = canvas;
        for splat in in_order(synth.blend, splats) {
            let (side, mut own) = (SIDE >> splat.level, Vec::new());
            texels((&synth.pictures, &synth.residues), &splat.mix, splat.level, 0..side, &mut own);
            for (i, out) in out.iter_mut().enumerate() {
                let at = inside(splat, columns[i % columns.len()], rows[i / columns.len()]);
                let Some(place) = at else { continue };
                let share = splat.opacity * before(depth[i], splat.depth, synth.values.soft);
                let own = shaded(read(&own, side, place), splat.tint) * share as f32;
                let hidden = if synth.blend == Mixing::Over { Vec4::splat(own.w) } else { own };
                *out = (own + Vec4::from(*out) * (Vec4::ONE - hidden)).to_array();
            }
        }
    }

    #[test]
    fn sprites_are_drawn_as_pixel_by_pixel() {
        let (mut synth, splats) = (synth(), (0..60).map(splat).collect::<Vec<_>>());
        let every = |step: usize, size: usize| (0..size).step_by(step).map(|i| i as f64 + 0.5).collect::<Vec<_>>();
        for (blend, soft, step) in
            [(Mixing::Screen, 0.5, 1), (Mixing::Over, 0.5, 1), (Mixing::Screen, 0.0, 3), (Mixing::Over, 0.0, 1)]
        {
            (synth.blend, synth.values.soft) = (blend, soft);
            let places = [every(step, SIZE.0), every(1, SIZE.1)];
            let count = places[0].len() * places[1].len();
            // A surface in the middle of the sprites on the right, and none on the left.
            let depth: Vec<f64> = (0..count).map(|i| if i % 61 < 30 { f64::INFINITY } else { 5.0 }).collect();
            let [fast, plain] = [draw, plainly].map(|draw| {
                let mut out = vec![[0.2, 0.1, 0.0, 1.0]; count];
                draw(&synth, &splats, Canvas { places: places.clone(), depth: &depth, out: &mut out });
                out
            });
            let far = fast.as_flattened().iter().zip(plain.as_flattened()).map(|(a, b)| (a - b).abs());
            let far = far.fold(0.0, f32::max);
            assert!(far < 1e-5, "{blend:?}, soft {soft}, every {step}: {far}");
        }
    }
}
