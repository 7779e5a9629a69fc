//! Animated PNG, by the png crate: exact colors and alpha, exact times, only the moving rectangle of each frame.

use std::io::{self, Write};
use std::sync::{Arc, Mutex, PoisonError};

use super::delta::{Rect, moved};
use crate::base::error::Result;
use crate::base::pixels::Frame;
use crate::export::animation::{Out, Show, Sink};
use crate::export::still;

struct Apng {
    show: Show,
    writer: png::Writer<Lent>,
    out: Lent,
    before: Option<Frame>,
}

/// Begins an APNG; a single frame makes a plain PNG.
pub fn begin(out: Out, show: Show) -> Result<Box<dyn Sink>> {
    let out = Lent(Arc::new(Mutex::new(Some(out))));
    let writer = header(out.clone(), &show).map_err(|e| show.unwritten(e))?;
    Ok(Box::new(Apng { show, writer, out, before: None }))
}

/// Bytes that it keeps: the frame before and the part that is written, and pixels filtered and packed.
pub fn memory(show: &Show) -> u64 {
    if show.frames > 1 { 16 * show.pixels() } else { still::memory(show.pixels()) }
}

fn header(out: Lent, show: &Show) -> std::result::Result<png::Writer<Lent>, png::EncodingError> {
    still::srgb(out, (show.width, show.height), |encoder| {
        if show.frames > 1 {
            encoder.set_compression(png::Compression::Balanced); // it is shown as it is, so that its size counts
            encoder.set_animated(show.frames as u32, u32::from(show.once))?;
            encoder.set_frame_delay(show.rate.den as u16, show.rate.num as u16)?;
            encoder.set_blend_op(png::BlendOp::Source)?;
            encoder.set_dispose_op(png::DisposeOp::None)?;
        }
        Ok(())
    })
}

impl Apng {
    fn write(&mut self, rect: Rect, frame: &Frame) -> std::result::Result<(), png::EncodingError> {
        if self.before.is_none() {
            let whole = frame.cells().as_flattened();
            let alone = self.show.frames == 1;
            return if alone { still::put(&mut self.writer, whole) } else { self.writer.write_image_data(whole) };
        }
        self.writer.reset_frame_position()?; // otherwise the new width is checked against the old place
        self.writer.set_frame_dimension(rect.width() as u32, rect.height() as u32)?;
        self.writer.set_frame_position(rect.x0 as u32, rect.y0 as u32)?;
        self.writer.write_image_data(&rect.cut(frame))
    }
}

impl Sink for Apng {
    fn frame(&mut self, _: u64, frame: Frame) -> Result<()> {
        let rect = self.before.as_ref().map_or(Rect::whole(&frame), |before| moved(before, &frame));
        self.write(rect, &frame).map_err(|e| self.show.unwritten(e))?;
        self.before = Some(frame);
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<Vec<String>> {
        let Apng { show, writer, out, .. } = *self;
        writer.finish().map_err(|e| show.unwritten(e))?;
        if let Some(out) = out.take() {
            out.keep(&show)?;
        }
        Ok(Vec::new())
    }
}

/// The output lent to the encoder, which never gives it back.
#[derive(Clone)]
struct Lent(Arc<Mutex<Option<Out>>>);

impl Lent {
    fn take(&self) -> Option<Out> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

impl Write for Lent {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut *self.0.lock().unwrap_or_else(PoisonError::into_inner) {
            Some(out) => out.write(bytes),
            None => Ok(bytes.len()), // what the encoder writes after `finish` (its trailer) is discarded
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
