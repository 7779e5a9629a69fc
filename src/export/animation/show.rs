//! What encoders get and give: the show, where its file goes, and the animation being written.

use std::io::{self, Seek, SeekFrom, Write};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::matrix::Matrix;
use super::rate::Rate;
use crate::base::error::{Error, Result};
use crate::base::pixels::Frame;
use crate::files::draft::DraftFile;
use crate::files::write;

/// What an encoder knows before the first frame.
#[derive(Clone, Debug)]
pub struct Show {
    /// What messages call the output.
    pub place: String,
    /// Width of every frame, in pixels.
    pub width: usize,
    /// Height of every frame, in pixels.
    pub height: usize,
    /// How many frames will be handed over; at least 1.
    pub frames: u64,
    /// Frames a second.
    pub rate: Rate,
    /// Whether it plays once and then holds its last frame, or for ever.
    pub once: bool,
    /// The matrix that was asked for; `None` is the one that players assume.
    pub matrix: Option<Matrix>,
    /// The command line without its output, for messages that suggest another way.
    pub command: String,
    /// Cancellation flag, for what waits for another program.
    pub cancel: Arc<AtomicBool>,
}

/// An animation being written. Dropped before [`Sink::finish`], it leaves nothing.
pub trait Sink {
    /// Takes the next frame, of the show's size; `number` is its number in the scene.
    fn frame(&mut self, number: u64, frame: Frame) -> Result<()>;
    /// Puts the whole of it in its place. Returns what a person should know about it, one item per line.
    fn finish(self: Box<Self>) -> Result<Vec<String>>;
}

/// Where one file goes.
pub enum Out {
    /// A file, put in its place when whole.
    File(DraftFile),
    /// Standard output; it cannot be sought in.
    Stream(Box<dyn Write + Send>),
}

impl Out {
    /// Puts it in its place.
    pub(super) fn keep(self, show: &Show) -> Result<()> {
        match self {
            Out::File(draft) => draft.keep(),
            Out::Stream(mut stream) => stream.flush().map_err(|e| show.unwritten(e)),
        }
    }
}

impl Write for Out {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Out::File(draft) => draft.write(bytes),
            Out::Stream(stream) => stream.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Out::File(draft) => draft.flush(),
            Out::Stream(stream) => stream.flush(),
        }
    }
}

impl Seek for Out {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match self {
            Out::File(draft) => draft.seek(to),
            Out::Stream(_) => Err(io::ErrorKind::NotSeekable.into()),
        }
    }
}

impl Show {
    /// Pixels of a frame.
    pub(super) fn pixels(&self) -> u64 {
        self.width as u64 * self.height as u64
    }

    /// The matrix of its Y'CbCr.
    pub(super) fn matrix(&self) -> Matrix {
        self.matrix.unwrap_or(Matrix::expected(self.height))
    }

    /// An encoder's error or a write error, at the output, with its cure.
    pub(super) fn unwritten(&self, error: impl std::error::Error + 'static) -> Error {
        write::failed(&self.place, &error)
    }

    /// What went wrong, at the output.
    pub(super) fn failed(&self, error: impl std::fmt::Display) -> Error {
        Error::at(&self.place, error)
    }
}
