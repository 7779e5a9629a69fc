//! Animations: one way to write any of the [`formats`]. Frames are handed over one after the other and none is kept longer
//! than its format needs, so that length costs no memory.

use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::base::error::{Error, Result};
use crate::base::pixels::Frame;
use crate::export::numbered::Pattern;
use crate::files::draft::DraftFile;
use crate::files::outputs::{Guard, Place};
use crate::files::write;

pub mod formats;
pub mod matrix;
pub mod range;
pub mod rate;
pub mod scale;
mod sequence;

use formats::{Begin, FORMATS, Format, Writer, ffmpeg};
use matrix::Matrix;
use rate::Rate;

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
    fn keep(self, show: &Show) -> Result<()> {
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

/// Where an animation goes and in which format, checked before any frame is made.
pub struct Target(Goal);

enum Goal {
    Sequence(sequence::Places),
    File(Place, &'static Format),
    Stream(Box<dyn Write + Send>, &'static Format, Begin),
}

impl Target {
    /// Frames of these numbers to `path`: a sequence of PNG files where the file name holds a pattern such as `%04d`, one
    /// PNG for a single frame to `.png`, else the format that the extension names. `guard` looks at every file.
    ///
    /// # Errors
    /// A wrong command line (for an unknown extension with the table of formats), or a file that the guard refuses.
    pub fn file(path: &Path, numbers: &[u64], guard: &mut Guard) -> Result<Self> {
        if let Some(pattern) = Pattern::parse(path, &[".png"], "numbered frames are PNG files")? {
            return Ok(Target(Goal::Sequence(sequence::Places::new(&pattern, numbers, guard)?)));
        }
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        let extension = extension.as_deref().unwrap_or_default();
        let place = path.display();
        // An animation of one frame is a plain PNG.
        let named = if extension == "png" && numbers.len() == 1 { "apng" } else { extension };
        match (FORMATS.iter().find(|f| f.extensions.contains(&named)), numbers.len()) {
            (Some(format), _) => Ok(Target(Goal::File(guard.file(path, format.kind)?, format))),
            (None, n) if extension == "png" => Err(Error::Usage(format!(
                "{place}: {n} frames do not fit one PNG (--frames 0 renders the first, a pattern such as %04d.png numbers them, .apng \
                 animates them)"
            ))),
            _ => {
                let what = format!("{place}: the extension names no format; these do:\n{}", formats::table());
                Err(Error::Usage(what))
            }
        }
    }

    /// To a stream, in the format called `name`.
    ///
    /// # Errors
    /// A wrong command line: the format needs a file.
    pub fn stream(name: &str, out: Box<dyn Write + Send>) -> Result<Self> {
        match FORMATS.iter().find(|f| f.name == name) {
            Some(format @ Format { streams: true, writer: Writer::Own(begin), .. }) => {
                Ok(Target(Goal::Stream(out, format, *begin)))
            }
            _ => {
                let streams: Vec<_> = FORMATS.iter().filter(|f| f.streams).map(|f| f.name).collect();
                Err(Error::Usage(format!("--format {name}: standard output takes {}", streams.join(" or "))))
            }
        }
    }

    /// Whether it is a sequence of numbered files.
    pub fn is_sequence(&self) -> bool {
        matches!(self.0, Goal::Sequence(_))
    }

    /// Whether it is Y'CbCr, which has a matrix.
    pub fn has_matrix(&self) -> bool {
        matches!(&self.0, Goal::File(_, format) | Goal::Stream(_, format, _) if format.matrix)
    }

    /// Whether the numbered file is there already, whole and of this size.
    pub fn has(&self, number: u64, size: (usize, usize)) -> bool {
        matches!(&self.0, Goal::Sequence(places) if places.has(number, size))
    }

    /// The files that it makes.
    pub fn files(&self) -> Vec<Place> {
        match &self.0 {
            Goal::Sequence(places) => places.all(),
            Goal::File(place, _) => vec![place.clone()],
            Goal::Stream(..) => Vec::new(),
        }
    }

    /// Whether the show can be written at all; to be asked before its first frame is made.
    ///
    /// # Errors
    /// If a program is missing; the message says what can be done instead.
    pub fn ready(&self, show: &Show) -> Result<()> {
        match &self.0 {
            Goal::File(_, Format { writer: Writer::Ffmpeg(codec), .. }) => ffmpeg::find(codec, show).map(drop),
            _ => Ok(()),
        }
    }

    /// Bytes that the output keeps at the most, besides the frame that it is given.
    pub fn memory(&self, show: &Show) -> u64 {
        match &self.0 {
            Goal::Sequence(_) => sequence::memory(show),
            Goal::File(_, format) | Goal::Stream(_, format, _) => (format.memory)(show),
        }
    }

    /// Begins to write.
    ///
    /// # Errors
    /// The place cannot be written, or the format cannot hold the show.
    pub fn begin(self, show: Show) -> Result<Box<dyn Sink>> {
        match self.0 {
            Goal::Sequence(places) => sequence::begin(places, show),
            Goal::File(place, format) => match format.writer {
                Writer::Own(begin) => begin(Out::File(DraftFile::create(&place)?), show),
                Writer::Ffmpeg(codec) => ffmpeg::begin(codec, &place, show),
            },
            Goal::Stream(out, _, begin) => begin(Out::Stream(out), show),
        }
    }
}

impl Show {
    /// Pixels of a frame.
    fn pixels(&self) -> u64 {
        self.width as u64 * self.height as u64
    }

    /// The matrix of its Y'CbCr.
    fn matrix(&self) -> Matrix {
        self.matrix.unwrap_or(Matrix::expected(self.height))
    }

    /// An encoder's error or a write error, at the output, with its cure.
    fn unwritten(&self, error: impl std::error::Error + 'static) -> Error {
        write::failed(&self.place, &error)
    }

    /// What went wrong, at the output.
    fn failed(&self, error: impl std::fmt::Display) -> Error {
        Error::at(&self.place, error)
    }
}

#[cfg(test)]
mod tests;
