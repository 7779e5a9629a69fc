//! The picture in the terminal: as pixels where the terminal has a protocol for them, else in half-blocks; always within a
//! bound of bytes, so that a slow link stays usable. Everything here runs on the worker thread.

use std::sync::Arc;

use kurbo::Point;
use ratatui::buffer::Buffer;

use super::text::colour::Depth;
use crate::base::pixels::Frame;
use crate::render::Synth;
use crate::render::overlay::{View, overlay};
use crate::render::part::{self, Part};
use crate::scene::Scene;

mod diacritics;
mod encode;
pub use encode::forget;
mod ink;
pub mod probed;
pub mod sight;
mod sixel;

/// How the picture reaches the terminal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Protocol {
    /// Half-blocks: two dots a cell, in any terminal.
    #[default]
    Blocks,
    /// The kitty graphics protocol.
    Kitty,
    /// iTerm2's inline images.
    Iterm2,
    /// Sixel graphics.
    Sixel,
}

impl Protocol {
    /// Every protocol by its name in commands and options; `auto` is none of them.
    pub const NAMES: [(&str, Protocol); 4] = [
        ("kitty", Protocol::Kitty),
        ("iterm2", Protocol::Iterm2),
        ("sixel", Protocol::Sixel),
        ("blocks", Protocol::Blocks),
    ];

    /// The protocol of that name; none for `auto`.
    pub fn named(name: &str) -> Option<Protocol> {
        Protocol::NAMES.iter().find(|(known, _)| *known == name).map(|(_, protocol)| *protocol)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        Protocol::NAMES.iter().find(|(_, one)| *one == self).map_or("", |(name, _)| name)
    }
}

/// What pictures the terminal takes, and what the person wants of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Graphics {
    /// What the person wants; none: what the terminal answered.
    pub forced: Option<Protocol>,
    /// What the terminal answered.
    pub found: Protocol,
    /// Width and height of a cell, in pixels of the screen.
    pub cell: (u16, u16),
    /// Whether tmux stands between, which lets sequences through in an envelope only.
    pub tmux: bool,
    /// The most bytes a frame: while playing, and of a still picture.
    pub bytes: (usize, usize),
}

/// The most bytes a frame, while playing and still, until `:graphics bytes` says otherwise.
const BYTES: (usize, usize) = (64_000, 256_000);

impl Default for Graphics {
    fn default() -> Self {
        Graphics { forced: None, found: Protocol::Blocks, cell: (8, 16), tmux: false, bytes: BYTES }
    }
}

impl Graphics {
    /// The protocol in force. A picture of kitty is named by a colour: there is none without colours.
    pub fn protocol(&self, depth: Depth) -> Protocol {
        match self.forced.unwrap_or(self.found) {
            Protocol::Kitty if depth == Depth::None => Protocol::Blocks,
            protocol => protocol,
        }
    }

    /// Dots of a cell, across and down.
    pub fn dots_a_cell(&self, protocol: Protocol) -> (usize, usize) {
        match protocol {
            Protocol::Blocks => (1, 2),
            _ => (self.cell.0.max(1).into(), self.cell.1.max(1).into()),
        }
    }

    /// Dots of a pane of so many cells. Sixels come in bands of six rows: no band may hang over the pane's edge.
    pub fn dots(&self, protocol: Protocol, (columns, rows): (u16, u16)) -> (usize, usize) {
        let (width, height) = self.dots_a_cell(protocol);
        let tall = usize::from(rows) * height;
        (usize::from(columns) * width, if protocol == Protocol::Sixel { (tall / 6 * 6).max(1) } else { tall })
    }
}

/// A picture that a pane wants to show.
#[derive(Clone, Debug, PartialEq)]
pub struct Wanted {
    /// Which part, on how many dots.
    pub part: Part,
    /// Columns and rows of the pane.
    pub cells: (u16, u16),
    /// How it reaches the terminal.
    pub protocol: Protocol,
    /// Whether tmux stands between.
    pub tmux: bool,
    /// The most bytes.
    pub bytes: usize,
    /// What is drawn into the pixels; half-blocks have their marks over them instead.
    pub marks: Option<Marks>,
}

/// What is drawn over a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Marks {
    /// What of the overlay.
    pub view: View,
    /// The cursor.
    pub cursor: Point,
    /// Where a jump vector that is being set begins.
    pub aim: Option<Point>,
}

/// A picture as it can be shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// What it was made for.
    pub wanted: Wanted,
    /// The dots, fewer by `by` each way; transparent beyond the picture.
    pub frame: Frame,
    /// How many times fewer dots it has than the pane, to stay within the bound of bytes.
    pub by: usize,
    /// The cells of the pane with the picture in them, where the terminal takes pixels.
    pub cells: Option<Buffer>,
    /// Bytes that it takes to the terminal (of half-blocks: at most).
    pub bytes: usize,
}

/// No picture is reduced further than this, whatever the bound.
const MOST_REDUCED: usize = 64;

impl Shown {
    /// The picture at `time`, reduced until it fits its bound of bytes. `before` is the picture that was shown last: its
    /// size is the first guess.
    pub fn new(synth: &Synth, scene: &Scene, time: f64, wanted: Wanted, before: Option<&Shown>) -> Arc<Shown> {
        let mut by = before.map_or(1, |before| guess(before, &wanted));
        loop {
            let shown = Shown::reduced(synth, scene, time, &wanted, by);
            if shown.bytes <= wanted.bytes || by >= MOST_REDUCED {
                return Arc::new(shown);
            }
            by = (guess(&shown, &wanted)).max(by + 1);
        }
    }

    fn reduced(synth: &Synth, scene: &Scene, time: f64, wanted: &Wanted, by: usize) -> Shown {
        let part = wanted.part.reduced(by);
        let mut frame = part::frame(synth, time, &part);
        ground(&mut frame, synth.size, &part);
        if let Some(marks) = &wanted.marks {
            let mut ink = ink::Ink { frame: &mut frame, part: &part, by };
            ink.draw(&overlay(scene, Some(synth), &marks.view));
            marks.aim.iter().for_each(|&from| ink.aim(from, marks.cursor));
            ink.cross(marks.cursor);
        }
        let (cells, bytes) = encode::encode(&frame, by, wanted);
        Shown { wanted: wanted.clone(), frame, by, cells, bytes }
    }

    /// The colour that a place of the picture has in it; none beyond the picture, or where it was not in sight.
    pub fn colour_at(&self, place: Point) -> Option<[u8; 3]> {
        let dot = self.wanted.part.reduced(self.by).dot_of(place);
        let within =
            dot.x >= 0.0 && dot.y >= 0.0 && dot.x < self.frame.width() as f64 && dot.y < self.frame.height() as f64;
        let [r, g, b, a] = within.then(|| *self.frame.get(dot.x as usize, dot.y as usize))?;
        (a > 0).then_some([r, g, b])
    }
}

/// How many times a picture must be reduced, after how many bytes one like it took.
fn guess(before: &Shown, wanted: &Wanted) -> usize {
    let (old, new) = (&before.wanted, wanted);
    // Once playing has ended a picture becomes as sharp as it can be.
    if (old.protocol, old.part.dots, old.bytes) != (new.protocol, new.part.dots, new.bytes) {
        return 1;
    }
    let more = (before.bytes as f64 / wanted.bytes.max(1) as f64).sqrt();
    // Nine tenths: a picture that would just fit is not made twice.
    ((before.by as f64 * more / 0.9).ceil() as usize).clamp(1, MOST_REDUCED)
}

/// Lays what is transparent on a checkerboard of the picture's pixels, as the window does; what lies beyond the picture
/// stays transparent.
fn ground(frame: &mut Frame, (w, h): (usize, usize), part: &Part) {
    let width = frame.width();
    for (i, cell) in frame.cells_mut().iter_mut().enumerate().filter(|(_, cell)| cell[3] < 255) {
        let at = part.place_of(Point::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5));
        if at.x >= 0.0 && at.y >= 0.0 && at.x < w as f64 && at.y < h as f64 {
            let ground = if (at.x as usize / 8 + at.y as usize / 8).is_multiple_of(2) { 96 } else { 160 };
            let alpha = u32::from(cell[3]);
            let laid = |code: u8| ((u32::from(code) * alpha + ground * (255 - alpha)) / 255) as u8;
            *cell = [laid(cell[0]), laid(cell[1]), laid(cell[2]), 255];
        }
    }
}
