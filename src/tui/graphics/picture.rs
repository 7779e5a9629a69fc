//! A picture for the terminal, reduced to fit its limit of bytes.

use std::sync::Arc;

use kurbo::Point;
use ratatui::buffer::Buffer;

use super::clip::square;
use super::protocol::Wanted;
use super::{encode, ink};
use crate::base::pixels::Frame;
use crate::layers::parts::marks::Mark;
use crate::layers::parts::vectors::Reach;
use crate::render::Synth;
use crate::render::overlay::{overlay, overlays, reach};
use crate::render::part::{self, Part};
use crate::render::sight::Visible;
use crate::scene::Scene;

/// A picture ready to be written to the terminal.
#[derive(Clone, Debug, PartialEq)]
pub struct TerminalPicture {
    /// The request that it answers.
    pub wanted: Wanted,
    /// The dots, reduced by `by` in each direction; transparent beyond the picture.
    pub frame: Frame,
    /// How many times fewer dots than the pane it has, in each direction, to stay within the limit of bytes.
    pub by: usize,
    /// The marks of [`Wanted::over`].
    pub over: Vec<Mark>,
    /// What is drawn among them as the longest arrow and in the fullest color.
    pub reach: Reach,
    /// The cells of the pane with the picture in them; `None` for half-blocks.
    pub cells: Option<Buffer>,
    /// How many bytes are written to the terminal; for half-blocks, at most.
    pub bytes: usize,
}

/// No picture is reduced further than this, whatever the limit.
const MOST_REDUCED: usize = 64;
/// A difference of codes that one hardly sees while a picture plays.
const HARDLY: u8 = 4;

impl TerminalPicture {
    /// The picture at `time`, reduced until it fits its limit of bytes. The first guess comes from `before`, the last picture.
    pub fn new(
        synth: &Synth,
        scene: &Scene,
        time: f64,
        wanted: Wanted,
        before: Option<&TerminalPicture>,
    ) -> Arc<TerminalPicture> {
        let sent = |shown, wanted, over| Arc::new(TerminalPicture::sent(shown, time, wanted, over, before));
        if let Some((synth, over, side)) = wanted.clip.as_ref().and_then(|clip| clip.seen(synth)) {
            let square = wanted.marks.iter().map(|marks| square(marks.cursor, side));
            let over = over.into_iter().chain(square).collect();
            return sent((&synth, None), wanted, over);
        }
        let sight = wanted.sight.as_ref().and_then(|sight| sight.of(synth));
        let synth = match sight {
            Some(Visible { synth, marks: Some(over) }) => {
                return sent((&synth, None), wanted, over);
            }
            Some(Visible { synth, marks: None }) => &synth.clone(),
            None => synth,
        };
        let over = if wanted.over.shown.is_empty() { Vec::new() } else { overlay(scene, Some(synth), &wanted.over) };
        let has_legend = overlays().any(|overlay| overlay.legend.is_some() && wanted.over.shows(overlay.name));
        let reach = if has_legend { reach(synth, &wanted.over.vectors) } else { Reach::default() };
        let made = TerminalPicture::sent((synth, Some(scene)), time, wanted, over, before);
        Arc::new(TerminalPicture { reach, ..made })
    }

    /// Without a scene, nothing of it is drawn over the picture.
    fn sent(
        shown: (&Synth, Option<&Scene>),
        time: f64,
        wanted: Wanted,
        over: Vec<Mark>,
        before: Option<&TerminalPicture>,
    ) -> TerminalPicture {
        let mut by = before.map_or(1, |before| guess(before, &wanted));
        loop {
            let made = TerminalPicture::reduced(shown, time, &wanted, (&over, by));
            if made.bytes <= wanted.bytes || by >= MOST_REDUCED {
                let mut made = TerminalPicture { over, ..made };
                before.filter(|_| made.wanted.calm).into_iter().for_each(|before| made.keep(before));
                return made;
            }
            by = (guess(&made, &wanted)).max(by + 1);
        }
    }

    fn reduced(
        (synth, scene): (&Synth, Option<&Scene>),
        time: f64,
        wanted: &Wanted,
        (over, by): (&[Mark], usize),
    ) -> TerminalPicture {
        let part = wanted.part.reduced(by);
        let mut frame = match &wanted.pass {
            Some(pass) => part::pass(synth, time, &part, pass),
            None => part::frame(synth, time, &part),
        };
        ground(&mut frame, synth.size, &part);
        if let Some(marks) = &wanted.marks {
            let mut ink = ink::Ink { frame: &mut frame, part: &part, by };
            ink.draw(over);
            scene.iter().for_each(|scene| ink.draw(&overlay(scene, Some(synth), &marks.view)));
            marks.aim.iter().for_each(|&from| ink.aim(from, marks.cursor));
            ink.cross(marks.cursor);
        }
        let (cells, bytes) = encode::encode(&frame, by, wanted);
        TerminalPicture { wanted: wanted.clone(), frame, by, over: Vec::new(), reach: Reach::default(), cells, bytes }
    }

    /// Keeps the dots of the picture before that differ by less than one sees. As each is compared with what is shown, none is
    /// ever farther from its color than that.
    fn keep(&mut self, before: &TerminalPicture) {
        if (before.by, before.wanted.part) != (self.by, self.wanted.part) {
            return;
        }
        for (dot, shown) in self.frame.cells_mut().iter_mut().zip(before.frame.cells()) {
            if (0..4).all(|c| dot[c].abs_diff(shown[c]) <= HARDLY) {
                *dot = *shown;
            }
        }
    }

    /// The color at a place of the picture; `None` if the place is beyond the picture or was not visible.
    pub fn color_at(&self, place: Point) -> Option<[u8; 3]> {
        let dot = self.wanted.part.reduced(self.by).dot_of(place);
        let within =
            dot.x >= 0.0 && dot.y >= 0.0 && dot.x < self.frame.width() as f64 && dot.y < self.frame.height() as f64;
        let [r, g, b, a] = within.then(|| *self.frame.get(dot.x as usize, dot.y as usize))?;
        (a > 0).then_some([r, g, b])
    }
}

/// How many times a picture must be reduced, judging from the bytes of the one before.
fn guess(before: &TerminalPicture, wanted: &Wanted) -> usize {
    let (old, new) = (&before.wanted, wanted);
    // After playing, start again with full sharpness.
    if (old.protocol, old.part.dots, old.bytes) != (new.protocol, new.part.dots, new.bytes) {
        return 1;
    }
    let more = (before.bytes as f64 / wanted.bytes.max(1) as f64).sqrt();
    // The margin of a tenth saves a second try for pictures that only just fit.
    ((before.by as f64 * more / 0.9).ceil() as usize).clamp(1, MOST_REDUCED)
}

/// Puts a checkerboard under what is transparent within the picture, as the window does.
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

#[cfg(test)]
mod tests {
    use super::super::protocol::Protocol;
    use super::*;
    use crate::layers::parts::marks::View;

    fn shown(codes: [u8; 4], corner: f64) -> TerminalPicture {
        let part = Part { corner: Point::new(corner, 0.0), scale: 1.0, dots: (2, 2) };
        let (clip, sight, over) = (None, None, View::default());
        let (protocol, cells) = (Protocol::Blocks, (2, 1));
        let wanted = Wanted {
            part,
            cells,
            protocol,
            tmux: false,
            bytes: 9,
            calm: true,
            pass: None,
            clip,
            sight,
            over,
            marks: None,
        };
        let frame = Frame::from_cells(2, 2, codes.map(|code| [code, 100, 100, 255]).to_vec());
        TerminalPicture { wanted, frame, by: 1, over: Vec::new(), reach: Reach::default(), cells: None, bytes: 9 }
    }

    #[test]
    fn dots_that_hardly_differ_from_what_is_shown_stay_and_none_drifts() {
        let mut before = shown([10, 20, 30, 40], 0.0);
        for (made, kept) in [
            ([10, 20, 30, 40], [10, 20, 30, 40]),
            ([13, 25, 26, 35], [10, 25, 30, 35]),
            ([16, 22, 26, 31], [16, 25, 30, 35]),
            ([16, 20, 25, 30], [16, 20, 25, 30]),
        ] {
            let mut next = shown(made, 0.0);
            next.keep(&before);
            assert_eq!(next.frame, shown(kept, 0.0).frame);
            before = next;
        }
        let mut elsewhere = shown([17, 20, 25, 30], 1.0);
        elsewhere.keep(&before);
        assert_eq!(elsewhere.frame, shown([17, 20, 25, 30], 1.0).frame);
    }
}
