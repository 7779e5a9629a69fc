//! A palette of at most 255 colors for many frames.

use std::collections::HashSet;

use rayon::prelude::*;

use crate::base::pixels::Frame;
use crate::base::quantise::{Codes, Histogram, Nearest};

/// At most [`Palette::MOST`] colors.
pub struct Palette {
    colors: Vec<[u8; 3]>,
    nearest: Nearest,
}

impl Palette {
    /// One of the 256 is left for transparency.
    pub const MOST: usize = 255;

    /// The palette for the colors of `frames`, without transparent pixels: the colors themselves if they are few enough.
    pub fn of(frames: &[Frame]) -> Self {
        Palette::from_colors(few(frames).unwrap_or_else(|| {
            let count = |counted: Histogram, frame: &Frame| counted.and(opaque(frame));
            let counted = frames.par_iter().fold(Histogram::default, count);
            counted.reduce(Histogram::default, Histogram::with).palette(Self::MOST)
        }))
    }

    fn from_colors(mut colors: Vec<[u8; 3]>) -> Self {
        if colors.is_empty() {
            colors.push([0; 3]);
        }
        let codes: Vec<Codes> = colors.iter().map(|c| c.map(f64::from)).collect();
        Palette { nearest: Nearest::new(&codes), colors }
    }

    /// The colors.
    pub fn colors(&self) -> &[[u8; 3]] {
        &self.colors
    }

    /// The index that stands for transparency.
    pub fn transparent(&self) -> u8 {
        self.colors.len() as u8
    }

    /// The index of the color nearest to one in 0 to 255.
    pub fn nearest(&self, wanted: Codes) -> u8 {
        self.nearest.of(wanted)
    }

    /// The mean square distance of the opaque colors of `frame` to the nearest of the palette, in codes.
    pub fn error(&self, frame: &Frame) -> f64 {
        let some = frame.cells().iter().step_by(37).filter(|c| is_opaque(**c));
        let errors: Vec<f64> = some.map(|&[r, g, b, _]| self.nearest.error([r, g, b].map(f64::from))).collect();
        errors.iter().sum::<f64>() / errors.len().max(1) as f64
    }
}

/// Every color of the frames, ascending; `None` if they are too many.
fn few(frames: &[Frame]) -> Option<Vec<[u8; 3]>> {
    let mut all = HashSet::new();
    for color in frames.iter().flat_map(opaque) {
        if all.insert(color) && all.len() > Palette::MOST {
            return None;
        }
    }
    let mut colors: Vec<_> = all.into_iter().collect();
    colors.sort_unstable();
    Some(colors)
}

fn opaque(frame: &Frame) -> impl Iterator<Item = [u8; 3]> {
    frame.cells().iter().filter(|c| is_opaque(**c)).map(|&[r, g, b, _]| [r, g, b])
}

/// GIF knows all or nothing.
pub fn is_opaque(color: [u8; 4]) -> bool {
    color[3] >= 128
}
