//! A waterfall layer at one time, on the CPU: the reference.

use std::sync::OnceLock;

use super::draw::{Canvas, draw};
use super::passes::{self, Piece};
use super::splat::{Splat, splats};
use super::synth::Synth;
use crate::base::pixels::Rgba;
use crate::layers::parts::moment::{Columns, Moment};
use crate::layers::parts::pass::Pass;
use crate::layers::ready::Still;

/// A layer at one time.
pub struct WaterfallAt<'a> {
    synth: &'a Synth,
    moment: &'a Moment,
    splats: Vec<Splat>,
    /// Its lines, once they are asked for.
    pieces: OnceLock<Vec<Piece>>,
}

impl<'a> WaterfallAt<'a> {
    /// The layer at one time.
    pub fn new(synth: &'a Synth, moment: &'a Moment) -> Self {
        WaterfallAt { synth, moment, splats: splats(synth, moment), pieces: OnceLock::new() }
    }
}

impl Still for WaterfallAt<'_> {
    fn row(&self, y: usize, columns: Columns, out: &mut [Rgba]) {
        self.sprites(&[y], columns, &vec![f64::INFINITY; out.len()], out);
    }

    fn sprites(&self, rows: &[usize], columns: Columns, depth: &[f64], out: &mut [Rgba]) {
        let places = places(self.synth, self.moment, rows, columns);
        draw(self.synth, &self.splats, Canvas { places, depth, out });
    }

    fn pass(&self, pass: &Pass, y: usize, columns: Columns, depth: &mut [f64], out: &mut [Rgba]) {
        let places = places(self.synth, self.moment, &[y], columns);
        if *pass == passes::SPRITES {
            passes::sprites(&self.splats, &places, depth, out);
        } else if *pass == passes::LINES {
            let Some(eye) = &self.moment.eye else { return };
            let pieces = self.pieces.get_or_init(|| passes::pieces(self.synth, eye));
            passes::lines(self.synth, pieces, &places, depth, out);
        }
    }
}

/// The places of columns and rows in the frame, in pixels.
pub fn places(synth: &Synth, moment: &Moment, rows: &[usize], columns: Columns) -> [Vec<f64>; 2] {
    let x = |x: usize| x as f64 + synth.place.x;
    let across = match columns {
        Columns::All => (0..moment.size_px.0).map(x).collect(),
        Columns::Some(wanted) => wanted.iter().map(|&at| x(at)).collect(),
    };
    [across, rows.iter().map(|&y| y as f64 + synth.place.y).collect()]
}
