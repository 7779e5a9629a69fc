//! Animated lossless WebP. libwebp (the webp crate) compresses one image at a time; the container around the images is
//! written here, so that only the moving rectangle of each frame is written, and as many frames as there are threads are
//! compressed at once and no more wait in memory.
//!
//! Container: <https://developers.google.com/speed/webp/docs/riff_container>.

use std::io::{Seek, SeekFrom, Write};

use rayon::prelude::*;

use super::delta::{Rect, moved};
use crate::base::error::{Error, Result};
use crate::base::pixels::Frame;
use crate::export::animation::{Out, Show, Sink};
use crate::export::icc;
use crate::files::outputs::Kind;

/// What messages call a file of it, and how one is recognized.
pub const KIND: Kind =
    Kind { name: "WebP", is: |found| found.head.starts_with(b"RIFF") && found.head.get(8..12) == Some(b"WEBP") };

/// The longest side of a WebP image.
const MOST: usize = 16383;
/// Times are counted in milliseconds.
const UNITS: u64 = 1000;
/// The flags of VP8X: a color profile and alpha; an animation.
const WITH_PROFILE_AND_ALPHA: u8 = 0x30;
const ANIMATED: u8 = 0x02;
/// The flags of ANMF: replace what is there, leave it there.
const REPLACE: u8 = 0x02;

struct WebP {
    out: Out,
    show: Show,
    /// Frames written and bytes written.
    count: u64,
    length: u64,
    before: Option<Frame>,
    /// Rectangles to be compressed, and their pixels.
    waiting: Vec<(Rect, Vec<u8>)>,
}

/// Bytes that it keeps: the frame before, and one a core that is compressed.
pub fn memory(show: &Show) -> u64 {
    /// What the library takes for each pixel of a frame that it compresses.
    const COMPRESSED: u64 = 40;
    let at_once = (rayon::current_num_threads() as u64).min(show.frames);
    show.pixels() * (4 + at_once * COMPRESSED)
}

/// Begins a WebP; a single frame makes a still one.
pub fn begin(out: Out, show: Show) -> Result<Box<dyn Sink>> {
    if show.width > MOST || show.height > MOST {
        let what = format!("WebP holds at most {MOST} x {MOST} pixels, not {} x {}", show.width, show.height);
        return Err(Error::at(&show.place, what).cure("--size makes frames smaller"));
    }
    let mut webp = WebP { out, show, count: 0, length: 0, before: None, waiting: Vec::new() };
    webp.write(b"RIFF\0\0\0\0WEBP")?; // the length is known at the end
    let is_animated = webp.show.frames > 1;
    let mut canvas = vec![WITH_PROFILE_AND_ALPHA | if is_animated { ANIMATED } else { 0 }, 0, 0, 0];
    canvas.extend(u24(webp.show.width - 1));
    canvas.extend(u24(webp.show.height - 1));
    webp.chunk(b"VP8X", &canvas)?;
    webp.chunk(b"ICCP", &icc::srgb())?;
    if is_animated {
        webp.chunk(b"ANIM", &[0, 0, 0, 0, u8::from(webp.show.once), 0])?;
    }
    Ok(Box::new(webp))
}

impl WebP {
    fn write(&mut self, bytes: &[u8]) -> Result<()> {
        self.length += bytes.len() as u64;
        self.out.write_all(bytes).map_err(|e| self.show.unwritten(e))
    }

    fn chunk(&mut self, name: &[u8; 4], payload: &[u8]) -> Result<()> {
        self.write(name)?;
        self.write(&(payload.len() as u32).to_le_bytes())?;
        self.write(payload)?;
        self.write(&[0][..payload.len() % 2])
    }

    /// Compresses and writes the frames that wait.
    fn flush(&mut self) -> Result<()> {
        let waiting = std::mem::take(&mut self.waiting);
        let images: Vec<_> = waiting.par_iter().map(|(rect, pixels)| compress(*rect, pixels)).collect();
        for ((rect, _), image) in waiting.into_iter().zip(images) {
            let image = image.map_err(|what| self.show.failed(what))?;
            if self.show.frames > 1 { self.animated(rect, &image) } else { self.write(&image) }?;
            self.count += 1;
        }
        Ok(())
    }

    fn animated(&mut self, rect: Rect, image: &[u8]) -> Result<()> {
        let mut frame = Vec::with_capacity(image.len() + 16);
        for number in [rect.x0 / 2, rect.y0 / 2, rect.width() - 1, rect.height() - 1] {
            frame.extend(u24(number));
        }
        frame.extend(u24(self.show.rate.delay(self.count, UNITS).min(0xFF_FFFF) as usize));
        frame.push(REPLACE);
        frame.extend(image);
        self.chunk(b"ANMF", &frame)
    }
}

impl Sink for WebP {
    fn frame(&mut self, _: u64, frame: Frame) -> Result<()> {
        let mut rect = self.before.as_ref().map_or(Rect::whole(&frame), |before| moved(before, &frame));
        (rect.x0, rect.y0) = (rect.x0 & !1, rect.y0 & !1); // places are even
        self.waiting.push((rect, rect.cut(&frame)));
        self.before = Some(frame);
        if self.waiting.len() >= rayon::current_num_threads() { self.flush() } else { Ok(()) }
    }

    fn finish(mut self: Box<Self>) -> Result<Vec<String>> {
        self.flush()?;
        let length = u32::try_from(self.length - 8).map_err(|_| self.show.failed("a WebP holds at most 4 GiB"))?;
        let put = |out: &mut Out| out.seek(SeekFrom::Start(4)).and_then(|_| out.write_all(&length.to_le_bytes()));
        put(&mut self.out).map_err(|e| self.show.unwritten(e))?;
        self.out.keep(&self.show)?;
        Ok(Vec::new())
    }
}

/// The chunk of one losslessly compressed image, its header included.
fn compress(rect: Rect, pixels: &[u8]) -> std::result::Result<Vec<u8>, String> {
    let mut config = webp::WebPConfig::new().map_err(|()| "libwebp has another version")?;
    config.lossless = 1;
    config.exact = 1; // colors under alpha 0 too
    config.quality = 75.0; // effort
    let encoder = webp::Encoder::from_rgba(pixels, rect.width() as u32, rect.height() as u32);
    let file = encoder.encode_advanced(&config).map_err(|e| format!("{e:?}"))?;
    Ok(file[12..].to_vec()) // behind "RIFF", length, "WEBP"
}

/// The lowest 24 bits, little-endian.
fn u24(number: usize) -> [u8; 3] {
    let [a, b, c, ..] = (number as u32).to_le_bytes();
    [a, b, c]
}
