//! Frames of a video, decoded by the person's own ffmpeg. They come through a pipe as PPM pictures, which say their size, and
//! are kept like that in the user's cache: a video is decoded once.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::SystemTime;

use super::cache::Cache;
use super::limits::within;
use super::write::Atomic;
use super::{Limits, hash, paths, sources};
use crate::base::budget::{Budget, Share};
use crate::base::error::{Error, Result};
use crate::base::picture::{Channels, Picture, SRGB_8, Samples};
use crate::base::system::folders;

/// The last line of a file in the cache: without it, it is not whole.
const END: &[u8] = b"END\n";

/// What ffmpeg may read: containers whose one file is the whole video, no lists of other files.
const CONTAINERS: &str = "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,avi,gif,apng,mpeg,mpegts,mpegvideo,ogg,flv,ivf,\
                          yuv4mpegpipe,asf,h264,hevc,m4v,mxf,nut,dv";

/// What to do about a video that ffmpeg cannot read.
const OTHERWISE: &str = "copy it again from where it came, or name numbered pictures: falls/%04d.jpg";

/// The most bytes of what ffmpeg says.
const MOST_SAID: usize = 4096;

/// Which frames are wanted: the number of the first in the video, and how many; all others without.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// The number of the first, from 0.
    pub first: u32,
    /// How many.
    pub count: Option<u32>,
}

/// What decoding may consume, and the flag that cancels it.
#[derive(Clone, Copy)]
pub struct Allowed<'a> {
    /// How many frames and pixels.
    pub limits: &'a Limits,
    /// How much memory.
    pub budget: &'a Budget,
    /// Cancels it.
    pub stop: Option<&'a AtomicBool>,
}

/// The person's ffmpeg: the first on the PATH.
pub fn program() -> Option<PathBuf> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).map(|folder| folder.join("ffmpeg")).find(|file| file.is_file())
}

/// The frames of the video in an open file, and the memory that they take; `place` is its name in messages.
///
/// # Errors
/// If it is a picture or a mesh; if there is no ffmpeg, or it cannot read the file; if there are fewer frames than wanted, or
/// more than the limits allow.
pub fn decode(mut file: File, place: &str, wanted: Wanted, allowed: Allowed) -> Result<(Vec<Arc<Picture>>, Share)> {
    let failed = |error| Error::at(place, error);
    sources::expect_video(&file, place)?;
    let content = hash::contents(&mut file).map_err(failed)?.hash;
    let name = hash::of(format!("{content} {} {:?}", wanted.first, wanted.count).as_bytes());
    // Without a cache it is decoded each time.
    let cache = folders::cache().map(|folder| folder.join("clips"));
    let cache = cache.and_then(|folder| Some((Cache::at(folder.clone(), allowed.limits.cache).ok()?, folder)));
    let mut frames = Frames { place, allowed, all: Vec::new(), share: Share::default() };
    if let Some((_, folder)) = &cache
        && let Some(kept) = kept(&folder.join(&name), &mut frames)?
    {
        return Ok(kept);
    }
    frames = Frames { place, allowed, all: Vec::new(), share: Share::default() };
    let mut copy = cache.as_ref().and_then(|(_, folder)| Atomic::create(&folder.join(&name)).ok());
    frames.decode(file, wanted, &mut copy)?;
    if let (Some((cache, _)), Some(mut copy)) = (cache, copy)
        && frames.share_bytes() <= allowed.limits.cache
        && copy.write_all(END).is_ok()
        && copy.commit().is_ok()
    {
        cache.trim(&BTreeSet::from([name]));
    }
    Ok((frames.all, frames.share))
}

/// The frames in a file of the cache; `None` if it is not there or not whole.
fn kept(path: &Path, frames: &mut Frames) -> Result<Option<(Vec<Arc<Picture>>, Share)>> {
    let Ok(file) = paths::open_named(path) else { return Ok(None) };
    let mut source = BufReader::new(file);
    loop {
        match frames.next(&mut source, &mut None)? {
            Next::Frame => {}
            Next::End => break,
            Next::Nothing => return Ok(None),
        }
    }
    // The modification time is when it was last used.
    drop(File::options().write(true).open(path).and_then(|file| file.set_modified(SystemTime::now())));
    Ok(Some((std::mem::take(&mut frames.all), std::mem::take(&mut frames.share))))
}

/// Frames that were read, within the limits.
struct Frames<'a> {
    place: &'a str,
    allowed: Allowed<'a>,
    all: Vec<Arc<Picture>>,
    share: Share,
}

/// What was read.
enum Next {
    Frame,
    /// The last line of a whole file.
    End,
    /// Nothing, or a part of a frame.
    Nothing,
}

impl Frames<'_> {
    /// The bytes of all frames.
    fn share_bytes(&self) -> u64 {
        self.all.iter().map(|frame| frame.bytes()).sum()
    }

    /// Reads a frame, within the limits, and copies it.
    fn next(&mut self, source: &mut impl BufRead, copy: &mut Option<Atomic>) -> Result<Next> {
        if self.allowed.stop.is_some_and(|stop| stop.load(Ordering::Relaxed)) {
            return Err(Error::Interrupted);
        }
        let mut head = Vec::new();
        for _ in 0..3 {
            // A line of a header is short.
            let read = source.by_ref().take(32).read_until(b'\n', &mut head);
            if read.is_err() || head == END {
                break;
            }
        }
        if head == END {
            return Ok(Next::End);
        }
        let Some((width, height)) = size(&head) else { return Ok(Next::Nothing) };
        let share = self.fits(width, height)?;
        let mut codes = vec![0; width * height * 3];
        if source.read_exact(&mut codes).is_err() {
            return Ok(Next::Nothing);
        }
        // What cannot be kept is decoded again next time.
        if copy.as_mut().is_some_and(|file| file.write_all(&head).and_then(|()| file.write_all(&codes)).is_err()) {
            *copy = None;
        }
        let picture = Picture::new(width, height, Channels::Rgb, Samples::Bytes(codes, SRGB_8.clone()));
        self.all.push(Arc::new(picture));
        self.share = std::mem::take(&mut self.share).and(share);
        Ok(Next::Frame)
    }

    /// The memory for one more frame of this size.
    fn fits(&self, width: usize, height: usize) -> Result<Share> {
        let (place, limits) = (self.place, self.allowed.limits);
        let (count, pixels) = (self.all.len() as u64 + 1, width as u64 * height as u64);
        within(place, "its frames have", "pixels", "pixels", pixels, limits.pixels)?;
        within(place, "it has", "frames or more", "frames", count, limits.frames)?;
        within(place, "its frames have", "pixels or more together", "clip", pixels.saturating_mul(count), limits.clip)?;
        self.allowed.budget.take(pixels.saturating_mul(3), place)
    }

    fn decode(&mut self, file: File, wanted: Wanted, copy: &mut Option<Atomic>) -> Result<()> {
        let place = self.place;
        let program = program().ok_or_else(|| {
            let cure = "install ffmpeg, or name numbered pictures: falls/%04d.jpg";
            Error::at(place, "ffmpeg reads videos, and there is none on the PATH").cure(cure)
        })?;
        let mut ffmpeg = Ffmpeg::start(&program, file, wanted).map_err(|e| Error::at(place, format!("ffmpeg: {e}")))?;
        if let Some(output) = ffmpeg.child.stdout.take() {
            let mut source = BufReader::new(output);
            while matches!(self.next(&mut source, copy)?, Next::Frame) {}
        }
        let said = ffmpeg.end().map_err(|what| Error::at(place, format!("ffmpeg: {what}")).cure(OTHERWISE))?;
        match (self.all.len() as u64, wanted.count.map(u64::from)) {
            (0, _) if said.is_empty() => {
                Err(Error::at(place, format!("has no frame {}", wanted.first)).cure("lower first"))
            }
            (0, _) => Err(Error::at(place, format!("ffmpeg: {said}")).cure(OTHERWISE)),
            (found, Some(count)) if found < count => {
                let what = format!("has {found} frames from number {} on, and {count} are wanted", wanted.first);
                Err(Error::at(place, what).cure("lower count, or leave it out"))
            }
            _ => Ok(()),
        }
    }
}

/// Width and height by the header of a PPM picture.
fn size(head: &[u8]) -> Option<(usize, usize)> {
    let lines = std::str::from_utf8(head).ok()?.strip_prefix("P6\n")?.strip_suffix("\n255\n")?;
    let (width, height) = lines.split_once(' ')?;
    Some((width.parse().ok().filter(|n| *n > 0)?, height.parse().ok().filter(|n| *n > 0)?))
}

/// A running ffmpeg; it is killed when this is dropped.
struct Ffmpeg {
    child: Child,
    /// Hears what it says, so that it never waits for that.
    said: Option<JoinHandle<String>>,
}

impl Ffmpeg {
    fn start(program: &Path, file: File, wanted: Wanted) -> io::Result<Ffmpeg> {
        let mut command = Command::new(program);
        command.args(["-hide_banner", "-loglevel", "error", "-nostdin"]);
        // The file that was opened, not what its path leads to by now.
        command.args(["-protocol_whitelist", "file", "-format_whitelist", CONTAINERS, "-i", "file:/dev/fd/0"]);
        let from = format!("trim=start_frame={},setpts=PTS-STARTPTS", wanted.first);
        command.args(["-map", "0:v:0", "-an", "-sn", "-dn", "-vf", &from]);
        command.args(wanted.count.into_iter().flat_map(|count| ["-frames:v".to_owned(), count.to_string()]));
        command.args(["-f", "image2pipe", "-c:v", "ppm", "-pix_fmt", "rgb24", "pipe:1"]);
        command.stdin(Stdio::from(file)).stdout(Stdio::piped()).stderr(Stdio::piped());
        // Ctrl-C is for us.
        let mut child = command.process_group(0).spawn()?;
        let said = child.stderr.take().map(|output| std::thread::spawn(move || listen(output)));
        Ok(Ffmpeg { child, said })
    }

    /// Waits for its end; what it said first.
    ///
    /// # Errors
    /// What it said, if it failed.
    fn end(&mut self) -> std::result::Result<String, String> {
        let ended = self.child.wait().map_err(|error| error.to_string())?;
        let said = self.said.take().and_then(|said| said.join().ok()).unwrap_or_default();
        let mut lines = said.lines().map(in_words);
        let first = lines.find(|line| !line.is_empty()).map(str::to_owned);
        if ended.success() {
            Ok(first.unwrap_or_default())
        } else {
            Err(first.unwrap_or_else(|| "it ended without a word".into()))
        }
    }
}

/// A line of what it said, without the parts and the addresses of the program.
fn in_words(line: &str) -> &str {
    let line = line.trim();
    let parts = line.strip_prefix('[').and_then(|rest| rest.split_once("] "));
    let rest = parts.filter(|(part, _)| part.contains(" @ 0x")).map(|(_, rest)| rest);
    let line = rest.map_or(line, in_words).trim_start_matches("file:/dev/fd/0: ");
    if line.starts_with("Format not on whitelist") { "it is no video that is in one file" } else { line }
}

/// The beginning of the program's standard error.
fn listen(mut output: impl Read) -> String {
    let (mut all, mut piece) = (Vec::new(), [0; 1024]);
    while let Ok(n @ 1..) = output.read(&mut piece) {
        let left = MOST_SAID.saturating_sub(all.len());
        all.extend(&piece[..n.min(left)]);
    }
    String::from_utf8_lossy(&all).into_owned()
}

impl Drop for Ffmpeg {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
