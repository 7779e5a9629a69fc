//! A frame of a picture layer on the CPU: the reference. frame.wgsl has the same names and shape.

use kurbo::{Point, Vec2};

use super::field::Field;
use super::synth::{Source, Synth, ZoneSynth};
use crate::base::pixels::{Rgba, over};

/// Writes row `y` of the layer at scene time `time` to `out`.
pub fn row(synth: &Synth, time: f64, y: usize, out: &mut [Rgba]) {
    synth.picture.row(0, y, out);
    for zone in &synth.zones {
        let field = &*zone.field;
        if (field.y0..field.y0 + field.inside.height()).contains(&y) {
            zone_row(zone, zone.clock.s(time), y, &mut out[field.x0..field.x0 + field.inside.width()]);
        }
    }
}

/// As [`row`] for some of its columns only, each within the picture: equal to what [`row`] writes there.
pub fn columns(synth: &Synth, time: f64, y: usize, columns: &[usize], out: &mut [Rgba]) {
    out.iter_mut().zip(columns).for_each(|(out, &x)| *out = synth.picture.texel(x, y));
    for zone in &synth.zones {
        let field = &*zone.field;
        if (field.y0..field.y0 + field.inside.height()).contains(&y) {
            let s = zone.clock.s(time);
            let within = field.x0..field.x0 + field.inside.width();
            let covered = out.iter_mut().zip(columns).filter(|(_, x)| within.contains(*x));
            covered.for_each(|(out, &x)| zone_pixel(zone, s, (x - field.x0, y), out));
        }
    }
}

/// Shows one zone over what lies beneath, in the part of row `y` that its box covers.
fn zone_row(zone: &ZoneSynth, s: f64, y: usize, beneath: &mut [Rgba]) {
    beneath.iter_mut().enumerate().for_each(|(column, still)| zone_pixel(zone, s, (column, y), still));
}

/// Shows the pixel in column `column` of the zone's box, row `y` of the picture, over what lies beneath.
fn zone_pixel(zone: &ZoneSynth, s: f64, (column, y): (usize, usize), still: &mut Rgba) {
    let field = &*zone.field;
    let i = (y - field.y0) * field.inside.width() + column;
    if field.inside.cells()[i]
        && let Some(e) = effective(field, i, s)
    {
        let q = Point::new((field.x0 + column) as f64 + 0.5, y as f64 + 0.5);
        *still = shown(&zone.source, q, jump(field, i) * e, *still);
    }
}

/// e(s) of pixel `i` of the box, `None` if its sampler is not active.
pub fn effective(field: &Field, i: usize, s: f64) -> Option<f64> {
    match &field.folds {
        None => Some(s),
        Some(folds) => folds.effective(i, s),
    }
}

/// The jump vector of pixel `i` of the box, in pixels.
fn jump(field: &Field, i: usize) -> Vec2 {
    let [x, y] = field.jumps.cells()[i];
    Vec2::new(x.into(), y.into())
}

/// What pixel `q` shows when its sampler is `moved` away from it.
fn shown(source: &Source, q: Point, moved: Vec2, still: Rgba) -> Rgba {
    let x = q + source.offset + moved;
    let moving = source.picture.read(x.x, x.y, source.beyond);
    if source.over { over(moving, still) } else { moving }
}
