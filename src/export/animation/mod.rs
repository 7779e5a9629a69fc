//! Animations: one table of formats, and one way to write any of them. Frames are handed over one after the other and
//! none is kept longer than its format needs, so that length costs no memory.

use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::base::error::{Error, Result};
use crate::base::pixels::Frame;
use crate::files::draft::DraftFile;

mod apng;
mod delta;
mod dither;
mod gif;
mod palette;
pub mod range;
pub mod rate;
mod raw;
pub mod scale;
mod sequence;
mod webp;

use rate::Rate;

/// What is told about an animation before its first frame.
#[derive(Clone, Debug, PartialEq)]
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
}

/// An animation being written. Dropped before [`Sink::finish`], it leaves nothing.
pub trait Sink {
    /// Takes the next frame, of the show's size; `number` is its number in the scene.
    fn frame(&mut self, number: u64, frame: Frame) -> Result<()>;
    /// Puts the whole of it in its place. Returns what a person should know about it, a line each.
    fn finish(self: Box<Self>) -> Result<Vec<String>>;
}

/// One row of the table of formats.
pub struct Format {
    /// How `--format` calls it.
    pub name: &'static str,
    /// File name extensions that mean it, lower case.
    pub extensions: &'static [&'static str],
    /// What it is good for, one line.
    pub help: &'static str,
    /// Whether it can be written to standard output.
    pub streams: bool,
    begin: fn(Out, Show) -> Result<Box<dyn Sink>>,
}

/// Every format of one file. A sequence of files is told by its pattern, see [`Target::file`].
pub const FORMATS: &[Format] = &[
    Format {
        name: "apng",
        extensions: &["apng"],
        help: "exact colours and alpha, exact times; browsers and most viewers play it",
        streams: false,
        begin: apng::begin,
    },
    Format {
        name: "webp",
        extensions: &["webp"],
        help: "exact colours and alpha, smaller than APNG",
        streams: false,
        begin: webp::begin,
    },
    Format {
        name: "gif",
        extensions: &["gif"],
        help: "plays everywhere, 256 colours, no partial alpha",
        streams: false,
        begin: gif::begin,
    },
    Format {
        name: "y4m",
        extensions: &["y4m"],
        help: "uncompressed video for ffmpeg and other encoders, no alpha",
        streams: true,
        begin: raw::y4m,
    },
    Format {
        name: "rgba",
        extensions: &["rgba"],
        help: "bare pixels, 8-bit sRGB with straight alpha, row after row, frame after frame",
        streams: true,
        begin: raw::rgba,
    },
];

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
            Out::Stream(mut stream) => stream.flush().map_err(|e| show.failed(e)),
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
pub struct Target(Kind);

enum Kind {
    Sequence(sequence::Pattern),
    File(PathBuf, fn(Out, Show) -> Result<Box<dyn Sink>>),
    Stream(Box<dyn Write + Send>, fn(Out, Show) -> Result<Box<dyn Sink>>),
}

impl Target {
    /// `frames` frames to `path`: a sequence of PNG files where the file name holds a pattern such as `%04d`, one PNG for
    /// a single frame to `.png`, else the format that the extension names.
    ///
    /// # Errors
    /// A wrong command line; an unknown extension lists the table.
    pub fn file(path: &Path, frames: u64) -> Result<Self> {
        if let Some(pattern) = sequence::Pattern::parse(path)? {
            return Ok(Target(Kind::Sequence(pattern)));
        }
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        let extension = extension.as_deref().unwrap_or_default();
        if let Some(format) = FORMATS.iter().find(|f| f.extensions.contains(&extension)) {
            return Ok(Target(Kind::File(path.to_path_buf(), format.begin)));
        }
        let place = path.display();
        match (extension, frames) {
            ("png", 1) => Ok(Target(Kind::File(path.to_path_buf(), apng::begin))),
            ("png", n) => Err(Error::Usage(format!(
                "{place}: {n} frames do not fit one PNG (a pattern such as %04d.png numbers them, .apng animates them)"
            ))),
            _ => Err(Error::Usage(format!("{place}: the extension names no format; these do:\n{}", table()))),
        }
    }

    /// To a stream, in the format called `name`.
    ///
    /// # Errors
    /// A wrong command line: the format needs a file.
    pub fn stream(name: &str, out: Box<dyn Write + Send>) -> Result<Self> {
        match FORMATS.iter().find(|f| f.name == name) {
            Some(format) if format.streams => Ok(Target(Kind::Stream(out, format.begin))),
            _ => {
                let streams: Vec<_> = FORMATS.iter().filter(|f| f.streams).map(|f| f.name).collect();
                Err(Error::Usage(format!("--format {name}: standard output takes {}", streams.join(" or "))))
            }
        }
    }

    /// Begins to write.
    ///
    /// # Errors
    /// The place cannot be written, or the format cannot hold the show.
    pub fn begin(self, show: Show) -> Result<Box<dyn Sink>> {
        match self.0 {
            Kind::Sequence(pattern) => sequence::begin(pattern, show),
            Kind::File(path, begin) => begin(Out::File(DraftFile::create(&path)?), show),
            Kind::Stream(out, begin) => begin(Out::Stream(out), show),
        }
    }
}

/// The formats as lines for people.
pub fn table() -> String {
    let files = FORMATS.iter().map(|f| (format!(".{}", f.extensions.join(" .")), f.help));
    let sequence = ("%04d.png".to_string(), "a PNG file a frame, numbered; exact colours and alpha");
    let still = (".png".to_string(), "a single frame");
    let rows = std::iter::once(sequence).chain(std::iter::once(still)).chain(files);
    rows.map(|(what, help)| format!("  {what:<9} {help}")).collect::<Vec<_>>().join("\n")
}

impl Show {
    /// An encoder's error or a write error, at the output.
    fn failed(&self, error: impl std::fmt::Display) -> Error {
        Error::at(&self.place, error)
    }
}

#[cfg(test)]
mod tests;
