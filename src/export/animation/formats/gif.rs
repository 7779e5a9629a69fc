//! GIF, by the gif crate: 256 colors, no partial alpha, times in hundredths of a second. The last resort.
//!
//! The first frames wait, up to a bound, so that one palette can serve them all; later frames use it too unless it fails
//! them. Each frame is written one late: what it leaves behind depends on the next.

use gif::{DisposalMethod, Encoder, Repeat};

use super::delta::{Rect, around};
use super::dither::Dither;
use super::palette::{Palette, is_opaque};
use crate::base::error::{Error, Result};
use crate::base::pixels::Frame;
use crate::export::animation::{Out, Show, Sink};
use crate::files::outputs::Kind;

/// What messages call a file of it, and how one is recognized.
pub const KIND: Kind =
    Kind { name: "GIF", is: |found| found.head.starts_with(b"GIF87a") || found.head.starts_with(b"GIF89a") };

/// The longest side.
const MOST: usize = 65535;
/// Times are counted in hundredths of a second.
const UNITS: u64 = 100;
/// Pixels that may wait for the palette.
const WAITING: usize = 1 << 26;
/// A frame whose colors err more than this many times what the palette was made for gets its own.
const FAILS: f64 = 4.0;
/// The largest mean square error, in codes, that is invisible.
const UNSEEN: f64 = 6.0;

/// Begins a GIF.
pub fn begin(out: Out, show: Show) -> Result<Box<dyn Sink>> {
    if show.width > MOST || show.height > MOST {
        let what = format!("GIF holds at most {MOST} x {MOST} pixels, not {} x {}", show.width, show.height);
        return Err(Error::at(&show.place, what).cure("--size makes frames smaller"));
    }
    Ok(Box::new(Gif { show, state: State::Waiting(out, Vec::new()), partial: false }))
}

/// Bytes that it keeps: frames that wait for the palette; the frame before as it was given, as it was shown with the errors
/// that it passes on, and packed; the next one.
pub fn memory(show: &Show) -> u64 {
    const OF_TWO: u64 = 36;
    let waiting = (WAITING as u64 / show.pixels().max(1) + 1).min(show.frames);
    show.pixels() * (OF_TWO + 4 * waiting)
}

struct Gif {
    show: Show,
    state: State,
    /// Whether partial alpha was met.
    partial: bool,
}

enum State {
    Waiting(Out, Vec<Frame>),
    Writing(Box<Writer>),
    /// Between the two, and after an error.
    Broken,
}

impl Sink for Gif {
    fn frame(&mut self, _: u64, frame: Frame) -> Result<()> {
        self.partial |= frame.cells().iter().any(|c| (1..255).contains(&c[3]));
        match &mut self.state {
            State::Waiting(_, frames) => {
                frames.push(frame);
                let pixels = frames.len() * self.show.width * self.show.height;
                if pixels > WAITING { self.flush() } else { Ok(()) }
            }
            State::Writing(writer) => writer.frame(frame),
            State::Broken => Ok(()),
        }
    }

    fn finish(mut self: Box<Self>) -> Result<Vec<String>> {
        self.flush()?;
        if let State::Writing(writer) = self.state {
            writer.finish()?;
        }
        let place = &self.show.place;
        let partial = format!("{place}: GIF has no partial alpha; pixels are shown from half opaque on");
        let fast =
            format!("{place}: many viewers slow a GIF down above 50 frames a second (--frames 0-N:2 takes half)");
        let is_fast = self.show.frames > 1 && self.show.rate.num > 50 * self.show.rate.den;
        Ok([self.partial.then_some(partial), is_fast.then_some(fast)].into_iter().flatten().collect())
    }
}

impl Gif {
    /// Makes the palette of the frames that waited, and writes them.
    fn flush(&mut self) -> Result<()> {
        match std::mem::replace(&mut self.state, State::Broken) {
            State::Waiting(out, frames) => {
                let mut writer = Box::new(Writer::new(out, &self.show, &frames)?);
                frames.into_iter().try_for_each(|frame| writer.frame(frame))?;
                self.state = State::Writing(writer);
            }
            other => self.state = other,
        }
        Ok(())
    }
}

struct Writer {
    show: Show,
    encoder: Encoder<Out>,
    palette: Palette,
    dither: Dither,
    /// The error that the palette was made for.
    error: f64,
    count: u64,
    /// The frame to be written next, as it will be seen.
    pending: Option<Pending>,
}

/// A frame in the colors it will have.
struct Pending {
    shown: Frame,
    /// What of it must be written.
    rect: Rect,
    indices: Vec<u8>,
    /// Whether pixels that have not changed may be left transparent: nothing is cleared between the two frames.
    same: Option<Vec<bool>>,
    /// Its own colors, where it has some.
    own: Option<Vec<[u8; 3]>>,
    transparent: u8,
}

impl Pending {
    /// The frame with its pixels compressed; those that are the `same` as before stay transparent.
    fn encode(&self, delay: u16, dispose: DisposalMethod, same: Option<&Vec<bool>>) -> gif::Frame<'static> {
        let Pending { rect, indices, transparent, .. } = self;
        let index = |i: usize| if same.is_some_and(|same| same[i]) { *transparent } else { indices[i] };
        let row = |y: usize| (rect.x0..rect.x1).map(move |x| y * self.shown.width() + x);
        let mut frame = gif::Frame {
            delay,
            dispose,
            transparent: Some(*transparent),
            left: rect.x0 as u16,
            top: rect.y0 as u16,
            width: rect.width() as u16,
            height: rect.height() as u16,
            palette: self.own.as_ref().map(|colors| table(colors)),
            buffer: (rect.y0..rect.y1).flat_map(row).map(index).collect(),
            ..Default::default()
        };
        frame.make_lzw_pre_encoded();
        frame
    }
}

impl Writer {
    fn new(out: Out, show: &Show, frames: &[Frame]) -> Result<Self> {
        let palette = Palette::of(frames);
        let error = frames.iter().map(|f| palette.error(f)).fold(UNSEEN, f64::max);
        let (width, height) = (show.width as u16, show.height as u16);
        let colors = table(palette.colors());
        let mut encoder = Encoder::new(out, width, height, &colors).map_err(|e| show.unwritten(e))?;
        if !show.once && show.frames > 1 {
            encoder.set_repeat(Repeat::Infinite).map_err(|e| show.unwritten(e))?;
        }
        let dither = Dither::default();
        Ok(Writer { show: show.clone(), encoder, palette, dither, error, count: 0, pending: None })
    }

    fn frame(&mut self, frame: Frame) -> Result<()> {
        let mut next = self.quantise(&frame);
        if let Some(mut before) = self.pending.take() {
            let cleared = around(&before.shown, &next.shown, |a, b| is_opaque(a) && !is_opaque(b));
            let dispose = match cleared {
                Some(rect) => {
                    // Only disposal makes pixels transparent again: it must reach them, and the next frame fill the rest.
                    before.rect = before.rect.union(rect);
                    DisposalMethod::Background
                }
                None => DisposalMethod::Keep,
            };
            let moved = around(&before.shown, &next.shown, |a, b| a != b);
            next.rect = match (moved, cleared) {
                (Some(moved), Some(_)) => moved.union(before.rect),
                (Some(moved), None) => moved,
                (None, _) => Rect { x0: 0, y0: 0, x1: 1, y1: 1 },
            };
            let same = || before.shown.cells().iter().zip(next.shown.cells()).map(|(a, b)| a == b).collect();
            next.same = cleared.is_none().then(same);
            self.write(&before, dispose)?;
        }
        self.pending = Some(next);
        Ok(())
    }

    fn quantise(&mut self, frame: &Frame) -> Pending {
        let own = (self.palette.error(frame) > FAILS * self.error).then(|| Palette::of(std::slice::from_ref(frame)));
        if own.is_some() {
            self.dither = Dither::default();
        }
        let palette = own.as_ref().unwrap_or(&self.palette);
        let indices = self.dither.indices(frame, palette);
        let transparent = palette.transparent();
        let color = |&index: &u8| match palette.colors().get(usize::from(index)) {
            Some(&[r, g, b]) => [r, g, b, 255],
            None => [0; 4],
        };
        let shown = Frame::from_cells(frame.width(), frame.height(), indices.iter().map(color).collect());
        let own = own.map(|palette| palette.colors().to_vec());
        if own.is_some() {
            self.dither = Dither::default();
        }
        Pending { rect: Rect::whole(frame), shown, indices, same: None, own, transparent }
    }

    /// Writes a frame, with unchanged pixels transparent or not, whichever is smaller.
    fn write(&mut self, pending: &Pending, dispose: DisposalMethod) -> Result<()> {
        let delay = self.show.rate.delay(self.count, UNITS).min(65535) as u16;
        let whole = pending.encode(delay, dispose, None);
        let spared = pending.same.as_ref().map(|same| pending.encode(delay, dispose, Some(same)));
        let smaller = spared.filter(|spared| spared.buffer.len() < whole.buffer.len()).unwrap_or(whole);
        self.count += 1;
        self.encoder.write_lzw_pre_encoded_frame(&smaller).map_err(|e| self.show.unwritten(e))
    }

    fn finish(mut self) -> Result<()> {
        if let Some(last) = self.pending.take() {
            self.write(&last, DisposalMethod::Keep)?;
        }
        let out = self.encoder.into_inner().map_err(|e| self.show.unwritten(e))?;
        out.keep(&self.show)
    }
}

/// The colors and a place for the transparent one, as bytes.
fn table(colors: &[[u8; 3]]) -> Vec<u8> {
    colors.as_flattened().iter().copied().chain([0; 3]).collect()
}
