//! Video by the person's own ffmpeg: frames go to its standard input as they are, and it writes a temporary file that is
//! moved into place when it is complete. Video codecs are a world of their own; whoever needs other settings pipes y4m.
//!
//! The files say what their numbers mean: matrix and primaries, the transfer of sRGB, and limited range.

use std::ffi::OsString;
use std::io::{Read, Write};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::atomic::Ordering;
use std::thread::JoinHandle;
use std::time::Duration;

use super::raw::opaque;
use crate::base::error::{Error, Result};
use crate::base::pixels::Frame;
use crate::export::animation::{Show, Sink};
use crate::files::draft;
use crate::files::outputs::{Cleared, Kind};
use crate::files::video;
use crate::files::write::{self, Atomic};

/// How one container is written.
pub struct Codec {
    /// What messages call a file of it, and how one is recognized.
    pub(super) kind: Kind,
    /// What ffmpeg calls the container.
    container: &'static str,
    /// The pixels in it.
    pixels: &'static str,
    /// The encoder and its settings.
    encoder: &'static str,
    /// Whether it keeps alpha.
    alpha: bool,
    /// Whether both sides must be even.
    even: bool,
}

/// H.264.
pub const MP4: Codec = Codec {
    kind: Kind {
        name: "MP4 video",
        is: |found| found.head.get(4..8) == Some(b"ftyp") && found.head.get(8..12) != Some(b"qt  "),
    },
    container: "mp4",
    pixels: "yuv420p",
    encoder: "-c:v libx264 -preset medium -crf 16 -movflags +faststart",
    alpha: false,
    even: true,
};

/// VP9 with alpha.
pub const WEBM: Codec = Codec {
    kind: Kind { name: "WebM video", is: |found| found.head.starts_with(b"\x1a\x45\xdf\xa3") },
    container: "webm",
    pixels: "yuva420p",
    encoder: "-c:v libvpx-vp9 -crf 18 -b:v 0 -row-mt 1",
    alpha: true,
    even: false,
};

/// ProRes 4444.
pub const MOV: Codec = Codec {
    kind: Kind { name: "QuickTime video", is: |found| found.head.get(4..12) == Some(b"ftypqt  ") },
    container: "mov",
    pixels: "yuva444p10le",
    encoder: "-c:v prores_ks -profile:v 4444 -alpha_bits 16 -vendor apl0",
    alpha: true,
    even: false,
};

/// The last bytes of what ffmpeg says.
const MOST_SAID: usize = 4096;

impl Codec {
    /// Width and height of the video.
    fn size(&self, show: &Show) -> (usize, usize) {
        let side = |n: usize| if self.even { n.next_multiple_of(2) } else { n };
        (side(show.width), side(show.height))
    }

    /// The arguments between ffmpeg's name and the output file, for our frames.
    fn arguments(&self, show: &Show) -> Vec<String> {
        let line = format!("{} {}", bare(show, self.size(show)), self.output(show, &convert(show)));
        line.split(' ').map(str::to_owned).collect()
    }

    /// The output settings, after the filter.
    fn output(&self, show: &Show, filter: &str) -> String {
        let (matrix, pixels) = (show.matrix().ffmpeg(), self.pixels);
        let tags = format!("setparams=colorspace={matrix}:color_primaries=bt709:color_trc=iec61966-2-1:range=tv");
        format!(
            "-vf {filter}format={pixels},{tags} -pix_fmt {pixels} -colorspace {matrix} -color_primaries bt709 \
             -color_trc iec61966-2-1 -color_range tv {} -f {}",
            self.encoder, self.container
        )
    }

    /// The command that a person can run instead, where there is an ffmpeg. Formats without alpha get y4m, which is on black.
    fn line(&self, show: &Show) -> String {
        let (size, own) = (self.size(show), (show.width, show.height));
        let pad = if size == own { String::new() } else { format!("pad={}:{},", size.0, size.1) };
        let (format, input, filter) =
            if self.alpha { ("rgba", bare(show, own), convert(show)) } else { ("y4m", "-i pipe:0".into(), pad) };
        format!(
            "{} -o - --format {format} | ffmpeg {input} {} {}",
            show.command,
            self.output(show, &filter),
            show.place
        )
    }
}

/// Bare pixels as ffmpeg reads them.
fn bare(show: &Show, (width, height): (usize, usize)) -> String {
    let (num, den) = (show.rate.num, show.rate.den);
    format!("-f rawvideo -pixel_format rgba -video_size {width}x{height} -framerate {num}/{den} -i pipe:0")
}

/// The filter that converts them to Y'CbCr.
fn convert(show: &Show) -> String {
    format!("scale=out_color_matrix={}:out_range=tv:flags=accurate_rnd+full_chroma_int,", show.matrix().ffmpeg())
}

/// Whether the person has an ffmpeg, asked before work begins.
///
/// # Errors
/// If there is none; the message says what can be done instead.
pub fn find(codec: &Codec, show: &Show) -> Result<PathBuf> {
    video::program().ok_or_else(|| {
        let what = format!("ffmpeg writes .{}, and there is none on the PATH", codec.container);
        Error::at(&show.place, what).cure(format!("install ffmpeg; where there is one: {}", codec.line(show)))
    })
}

/// Bytes that are kept besides what the program itself takes: the frame as it is handed over.
pub fn memory(show: &Show) -> u64 {
    4 * show.pixels()
}

struct Video {
    codec: &'static Codec,
    show: Show,
    child: Child,
    /// `None` once all frames are written.
    frames: Option<ChildStdin>,
    said: Option<JoinHandle<String>>,
    file: Option<Atomic>,
    transparent: bool,
}

/// Begins a video.
pub fn begin(codec: &'static Codec, place: &Cleared, show: Show) -> Result<Box<dyn Sink>> {
    let program = find(codec, &show)?;
    let file = draft::for_program(place)?;
    let mut command = Command::new(program);
    command.args(["-hide_banner", "-loglevel", "error", "-nostdin", "-y"]);
    command.args(codec.arguments(&show)).arg(as_file(file.temporary()));
    command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
    // Ctrl-C is for us: ffmpeg would take it and finish the file.
    let mut child = command.process_group(0).spawn().map_err(|e| show.failed(format!("ffmpeg: {e}")))?;
    let (frames, said) = (child.stdin.take(), child.stderr.take());
    let said = said.map(|mut said| std::thread::spawn(move || listen(&mut said)));
    Ok(Box::new(Video { codec, show, child, frames, said, file: Some(file), transparent: false }))
}

/// A path that ffmpeg cannot mistake for something else.
fn as_file(path: &Path) -> OsString {
    let mut word = OsString::from("file:");
    word.push(path);
    word
}

/// The end of the program's standard error.
fn listen(said: &mut impl Read) -> String {
    let (mut all, mut piece) = (Vec::new(), [0; 1024]);
    while let Ok(n @ 1..) = said.read(&mut piece) {
        all.extend(&piece[..n]);
        all.drain(..all.len().saturating_sub(MOST_SAID));
    }
    String::from_utf8_lossy(&all).into_owned()
}

impl Video {
    /// The frame as the container takes it.
    fn pixels(&mut self, frame: &Frame) -> Vec<u8> {
        let (width, height) = self.codec.size(&self.show);
        let mut bytes = Vec::with_capacity(4 * width * height);
        for y in 0..height {
            let row = frame.row(y.min(frame.height() - 1));
            for x in 0..width {
                let color = row[x.min(frame.width() - 1)];
                self.transparent |= color[3] < 255;
                let [r, g, b] = if self.codec.alpha { [color[0], color[1], color[2]] } else { opaque(color) };
                bytes.extend([r, g, b, if self.codec.alpha { color[3] } else { 255 }]);
            }
        }
        bytes
    }

    /// Waits until ffmpeg has ended; kills it if the work is cancelled.
    fn wait(&mut self) -> Result<ExitStatus> {
        loop {
            if self.show.cancel.load(Ordering::Relaxed) {
                return Err(Error::Interrupted);
            }
            match self.child.try_wait() {
                Ok(Some(status)) => return Ok(status),
                Ok(None) => std::thread::sleep(Duration::from_millis(10)),
                Err(error) => return Err(self.show.failed(format!("ffmpeg: {error}"))),
            }
        }
    }

    /// Why it ended too early, in its own words.
    fn why(&mut self) -> Error {
        self.frames = None;
        if let Err(error) = self.wait() {
            return error;
        }
        let said = self.said.take().and_then(|said| said.join().ok()).unwrap_or_default();
        let first = said.lines().map(str::trim).find(|line| !line.is_empty()).unwrap_or("it ended without a word");
        let other = || format!("another encoder may do: {}", self.codec.line(&self.show));
        let cure = write::cure_in_words(&said).map_or_else(other, str::to_owned);
        Error::at(&self.show.place, format!("ffmpeg: {first}")).cure(cure)
    }

    fn notes(&self) -> Vec<String> {
        let (Show { place, width, height, .. }, size) = (&self.show, self.codec.size(&self.show));
        let container = self.codec.container;
        let lost = format!("{place}: {container} has no alpha; transparent parts lie on black");
        let padded = format!(
            "{place}: {width} x {height} became {} x {}, as H.264 has even sides; the last pixels are repeated",
            size.0, size.1
        );
        let lost = (self.transparent && !self.codec.alpha).then_some(lost);
        lost.into_iter().chain((size != (*width, *height)).then_some(padded)).collect()
    }
}

impl Sink for Video {
    fn frame(&mut self, _: u64, frame: Frame) -> Result<()> {
        let bytes = self.pixels(&frame);
        let written = self.frames.as_mut().map(|frames| frames.write_all(&bytes));
        if matches!(written, Some(Ok(()))) { Ok(()) } else { Err(self.why()) }
    }

    fn finish(mut self: Box<Self>) -> Result<Vec<String>> {
        self.frames = None;
        if !self.wait()?.success() {
            return Err(self.why());
        }
        self.file.take().map_or(Ok(()), Atomic::commit)?;
        Ok(self.notes())
    }
}

/// Whatever happened, no ffmpeg keeps running.
impl Drop for Video {
    fn drop(&mut self) {
        self.frames = None;
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
