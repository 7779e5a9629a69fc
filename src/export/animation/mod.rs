//! Animations: one way to write any of the [`formats`]. Frames are handed over one after the other and none is kept longer
//! than its format needs, so that length costs no memory.

use std::io::Write;
use std::path::Path;

use crate::base::error::{Error, Result};
use crate::export::numbered::{PICTURES, Pattern};
use crate::files::draft::DraftFile;
use crate::files::outputs::{Cleared, Guard};

pub mod formats;
pub mod matrix;
pub mod range;
pub mod rate;
pub mod scale;
mod sequence;
mod show;

pub use show::{Out, Show, Sink};

use formats::{Begin, FORMATS, Format, Writer, ffmpeg};

/// Where an animation goes and in which format, checked before any frame is made.
pub struct Target(Goal);

enum Goal {
    Sequence(sequence::Places),
    File(Cleared, &'static Format),
    Stream(Box<dyn Write + Send>, &'static Format, Begin),
}

impl Target {
    /// Frames of these numbers to `path`: a sequence of PNG files where the file name holds a pattern such as `%04d`, one
    /// PNG for a single frame to `.png`, else the format that the extension names. `guard` looks at every file.
    ///
    /// # Errors
    /// A wrong command line (for an unknown extension with the table of formats), or a file that the guard refuses.
    pub fn file(path: &Path, numbers: &[u64], guard: &mut Guard) -> Result<Self> {
        if let Some(pattern) = Pattern::parse(path, &PICTURES, "numbered frames are pictures")? {
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
    pub fn files(&self) -> Vec<Cleared> {
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

#[cfg(test)]
mod tests;
