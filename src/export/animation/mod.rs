//! Animations: one table of formats, and one way to write any of them. Frames are handed over one after the other and
//! none is kept longer than its format needs, so that length costs no memory.

use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;

use crate::base::error::{Error, Result};
use crate::base::pixels::Frame;
use crate::files::draft::DraftFile;

mod apng;
mod delta;
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

/// Every format of one file. A sequence of files is told by its pattern, see [`begin`].
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

/// Begins to write `show` to `path`: a sequence of PNG files where the file name holds a pattern such as `%04d`, one PNG
/// for a single frame to `.png`, else the format that the extension names.
pub fn begin(path: &Path, show: Show) -> Result<Box<dyn Sink>> {
    if let Some(pattern) = sequence::Pattern::parse(path)? {
        return sequence::begin(pattern, show);
    }
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    let by_extension = |f: &&Format| extension.as_deref().is_some_and(|e| f.extensions.contains(&e));
    if let Some(format) = FORMATS.iter().find(by_extension) {
        return (format.begin)(Out::File(DraftFile::create(path)?), show);
    }
    if extension.as_deref() == Some("png") {
        return match show.frames {
            1 => apng::begin(Out::File(DraftFile::create(path)?), show),
            n => Err(Error::Usage(format!(
                "{}: {n} frames do not fit one PNG (a pattern such as %04d.png numbers them, .apng animates them)",
                path.display()
            ))),
        };
    }
    Err(Error::Usage(format!("{}: the extension names no format; these do:\n{}", path.display(), table())))
}

/// Begins to write `show` to a stream in the format called `name`.
pub fn begin_stream(name: &str, out: Box<dyn Write + Send>, show: Show) -> Result<Box<dyn Sink>> {
    match FORMATS.iter().find(|f| f.name == name) {
        Some(format) if format.streams => (format.begin)(Out::Stream(out), show),
        _ => {
            let streams: Vec<_> = FORMATS.iter().filter(|f| f.streams).map(|f| f.name).collect();
            Err(Error::Usage(format!("--format: {name} is not written to standard output ({})", streams.join(", "))))
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
