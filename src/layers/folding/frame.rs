//! A frame of a picture layer on the CPU, pixel by pixel: the reference. frame.wgsl has the same names and structure; `tiles.rs`
//! draws the same faster.

use kurbo::{Point, Vec2};

use super::field::Field;
use super::synth::{Synth, ZoneSynth};
use crate::base::picture::Picture;
use crate::base::pixels::{Rgba, over};
use crate::layers::parts::moment::Columns;

/// A picture layer at one time.
pub struct Frame<'a> {
    pub(super) synth: &'a Synth,
    /// The zones, as they are then.
    pub(super) zones: Vec<ZoneAt<'a>>,
}

/// A zone at one time.
pub(super) struct ZoneAt<'a> {
    pub(super) zone: &'a ZoneSynth,
    /// The place along its jump paths.
    pub(super) s: f64,
    /// What its samplers read.
    pub(super) picture: &'a Picture,
}

impl<'a> Frame<'a> {
    /// The layer at scene time `t`.
    pub fn new(synth: &'a Synth, t: f64) -> Self {
        let shown = |zone: &'a ZoneSynth| ZoneAt { zone, s: zone.clock.s(t), picture: zone.source.picture_at(t) };
        Frame { synth, zones: synth.zones.iter().map(shown).collect() }
    }

    /// The zones that meet row `y`, in order.
    fn zones(&self, y: usize) -> impl Iterator<Item = &ZoneAt<'_>> {
        let meets = move |field: &Field| (field.y0..field.y0 + field.inside.height()).contains(&y);
        self.zones.iter().filter(move |shown| meets(&shown.zone.field))
    }

    fn all(&self, y: usize, out: &mut [Rgba]) {
        self.synth.picture.row(0, y, out);
        for shown in self.zones(y) {
            let field = &shown.zone.field;
            // A frame may be smaller than the picture.
            let end = (field.x0 + field.inside.width()).min(out.len());
            let Some(beneath) = out.get_mut(field.x0..end) else { continue };
            beneath.iter_mut().enumerate().for_each(|(column, still)| zone_pixel(shown, (column, y), still));
        }
    }

    fn some(&self, y: usize, columns: &[usize], out: &mut [Rgba]) {
        out.iter_mut().zip(columns).for_each(|(out, &x)| *out = self.synth.picture.texel(x, y));
        for shown in self.zones(y) {
            let field = &shown.zone.field;
            let within = field.x0..field.x0 + field.inside.width();
            let covered = out.iter_mut().zip(columns).filter(|(_, x)| within.contains(*x));
            covered.for_each(|(out, &x)| zone_pixel(shown, (x - field.x0, y), out));
        }
    }

    /// Row `y`: what [`crate::layers::ready::Still::row`] writes.
    pub(super) fn pixels(&self, y: usize, columns: Columns, out: &mut [Rgba]) {
        let (width, height) = (self.synth.picture.width(), self.synth.picture.height());
        match columns {
            _ if y >= height => {}
            Columns::All => {
                let own = width.min(out.len());
                self.all(y, &mut out[..own]);
            }
            Columns::Some(columns) => {
                let own = columns.partition_point(|&x| x < width);
                self.some(y, &columns[..own], &mut out[..own]);
            }
        }
    }
}

/// Draws the pixel in column `column` of the zone's box, row `y` of the picture, over `still`, the color beneath.
pub(super) fn zone_pixel(zone: &ZoneAt, (column, y): (usize, usize), still: &mut Rgba) {
    let field = &*zone.zone.field;
    let i = (y - field.y0) * field.inside.width() + column;
    if field.inside.cells()[i]
        && let Some(e) = effective(field, i, zone.s)
    {
        let q = Point::new((field.x0 + column) as f64 + 0.5, y as f64 + 0.5);
        *still = shown(zone, q, jump(field, i) * e, *still);
    }
}

/// e(s) of pixel `i` of the box; `None` if its sampler is not active.
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

/// The color of pixel `q` when its sampler has `moved` away from it; `still` is the color beneath.
fn shown(zone: &ZoneAt, q: Point, moved: Vec2, still: Rgba) -> Rgba {
    let source = &zone.zone.source;
    let x = q + source.offset + moved;
    let moving = zone.picture.read(x.x, x.y, source.beyond);
    if source.over { over(moving, still) } else { moving }
}
