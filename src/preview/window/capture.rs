//! One round of what the window shows, overlays and all, as a moving picture beside the scene. Its frames are drawn one after the
//! other, however long each takes, and encoded by a thread of their own, through the doors of `plica render`.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;

use super::options::PLACE;
use super::transport::{Part, Playhead};
use crate::base::error::{Error, Result};
use crate::base::pixels::Frame;
use crate::export::animation::rate::Rate;
use crate::export::animation::{Show, Target};
use crate::files::outputs::Guard;
use crate::layers::timeline::{Timeline, Wrap};

/// Which frames are captured, and how far that is.
#[derive(Clone, Debug, PartialEq)]
pub struct Round {
    /// The extension of the file, which names its format.
    pub extension: String,
    /// The first frame.
    first: u64,
    /// How many there are.
    frames: u64,
    /// How many have been taken.
    taken: u64,
    /// Frames a second.
    rate: Rate,
    /// Whether it is played once.
    once: bool,
}

impl Round {
    /// All that is played, at the speed at which it is.
    pub fn new(extension: &str, playhead: &Playhead, timeline: &Timeline) -> Round {
        let (first, last) = match playhead.part {
            Part::Between(first, last) => (first as u64, last as u64),
            Part::All | Part::From(_) => (0, timeline.frames() - 1),
        };
        let rate = Rate::from_fps(timeline.fps * playhead.speed);
        let (frames, once) = (last + 1 - first, timeline.wrap == Wrap::Once);
        Round { extension: extension.to_owned(), first, frames, taken: 0, rate, once }
    }

    /// Where the animation stands in the next frame; `None` once all have been taken.
    pub fn next(&self, playhead: &Playhead, timeline: &Timeline) -> Option<Playhead> {
        let mut next = playhead.clone();
        next.go_to((self.first + self.taken) as f64, timeline);
        (self.taken < self.frames).then_some(next)
    }

    /// A frame was taken.
    pub fn took_one(&mut self) {
        self.taken += 1;
    }

    /// How far it is.
    pub fn words(&self) -> String {
        match self.taken < self.frames {
            true => format!("captured: frame {} of {} (Esc gives it up)", self.taken, self.frames),
            false => format!("captured: all {} frames, which are being encoded", self.frames),
        }
    }
}

/// The thread that encodes. Dropped before it has ended by itself, it leaves no file but numbered ones.
pub struct Capture {
    /// Width and height of a frame.
    size: (usize, usize),
    frames: Option<SyncSender<Frame>>,
    cancel: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Capture {
    /// Begins a file whose name begins like `beside`. Once it is there, or cannot be, `told` is told.
    ///
    /// # Errors
    /// There is no such format, or what it needs.
    pub fn begin(
        beside: &Path,
        round: &Round,
        size: (usize, usize),
        told: impl FnOnce(String) + Send + 'static,
    ) -> Result<Capture> {
        let (path, target) = place(beside, round)?;
        let cancel = Arc::new(AtomicBool::new(false));
        let show = Show {
            place: path.display().to_string(),
            width: size.0,
            height: size.1,
            frames: round.frames,
            rate: round.rate,
            once: round.once,
            matrix: None,
            command: "plica render SCENE".to_owned(),
            cancel: cancel.clone(),
        };
        target.ready(&show)?;
        let (sender, frames) = sync_channel(1);
        let first = round.first;
        let thread = std::thread::spawn(move || {
            if let Some(ended) = encode(target, show, first, &frames).transpose() {
                told(ended.unwrap_or_else(|error| error.to_string()));
            }
        });
        Ok(Capture { size, frames: Some(sender), cancel, thread: Some(thread) })
    }

    /// Takes the next frame, as soon as there is room for it.
    ///
    /// # Errors
    /// It has another size than those before.
    pub fn take(&mut self, frame: Frame) -> Result<()> {
        if (frame.width(), frame.height()) != self.size {
            let error = Error::at(PLACE, "it has another size than when the capture began");
            return Err(error.cure("nothing is saved: capture it again"));
        }
        // Nobody takes it if the file cannot be written; that is told then.
        self.frames.iter().for_each(|frames| drop(frames.send(frame.clone())));
        Ok(())
    }
}

impl Drop for Capture {
    fn drop(&mut self) {
        self.cancel.store(true, Ordering::Relaxed);
        self.frames = None;
        // A fault of the thread has been told.
        self.thread.take().into_iter().for_each(|thread| drop(thread.join()));
    }
}

/// Encodes the frames as they come. What is to be said of the file; `None` if they end too early.
fn encode(target: Target, show: Show, first: u64, frames: &Receiver<Frame>) -> Result<Option<String>> {
    let (place, count, cancel) = (show.place.clone(), show.frames, show.cancel.clone());
    let mut sink = target.begin(show)?;
    for number in 0..count {
        let Ok(frame) = frames.recv() else { return Ok(None) };
        sink.frame(first + number, frame)?;
    }
    if cancel.load(Ordering::Relaxed) {
        return Ok(None);
    }
    let notes = sink.finish()?;
    Ok(Some([vec![format!("captured as {place}")], notes].concat().join("; ")))
}

/// Where a round goes: the first name that is free, with numbers in it where each frame has a file.
fn place(beside: &Path, round: &Round) -> Result<(PathBuf, Target)> {
    let stem = free(beside, "capture", |stem| match round.extension.as_str() {
        "png" => format!("{stem}.{:04}.png", round.first),
        extension => format!("{stem}.{extension}"),
    })?;
    let dots = if round.extension == "png" { ".%04d." } else { "." };
    let path = beside.with_file_name(format!("{stem}{dots}{}", round.extension));
    let numbers: Vec<u64> = (round.first..round.first + round.frames).collect();
    let target = Target::file(&path, &numbers, &mut Guard::default())?;
    Ok((path, target))
}

/// The first of the names `beside-WHAT-1`, `beside-WHAT-2` and so on for which no such file is there.
///
/// # Errors
/// All are taken.
pub fn free(beside: &Path, what: &str, file: impl Fn(&str) -> String) -> Result<String> {
    let name = beside.file_name().unwrap_or_default().to_string_lossy();
    let stems = (1u32..).map(|n| format!("{name}-{what}-{n}"));
    let is_free = |stem: &String| beside.with_file_name(file(stem)).symlink_metadata().is_err();
    let found = stems.into_iter().find(is_free);
    found.ok_or_else(|| Error::at(PLACE, "all names are taken").cure("move some of these files away"))
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;

    use super::*;

    fn round(extension: &str, part: Part) -> Round {
        let timeline = Timeline { duration: 1.0, fps: 6.0, wrap: Wrap::Repeat };
        Round::new(extension, &Playhead { part, speed: 0.5, ..Playhead::default() }, &timeline)
    }

    #[test]
    fn a_round_goes_through_what_is_played() {
        let timeline = Timeline { duration: 1.0, fps: 6.0, wrap: Wrap::Repeat };
        let playing = Playhead { playing: true, frame: 3.5, ..Playhead::default() };
        for (part, shown) in [(Part::All, 0..6), (Part::From(4.0), 0..6), (Part::Between(2.0, 4.0), 2..5)] {
            let mut round = round("gif", part);
            for frame in shown {
                let next = round.next(&playing, &timeline).unwrap();
                assert_eq!((next.frame, next.playing), (f64::from(frame), false), "{part:?}");
                round.took_one();
            }
            assert_eq!(round.next(&playing, &timeline), None);
            assert_eq!(round.rate, Rate::from_fps(3.0));
        }
    }

    #[test]
    fn a_round_becomes_a_file_under_a_free_name() {
        let folder = tempfile::tempdir().unwrap();
        let beside = folder.path().join("sea.v2");
        for (extension, files) in [
            ("gif", &["sea.v2-capture-1.gif"][..]),
            ("gif", &["sea.v2-capture-2.gif"]),
            ("png", &["sea.v2-capture-1.0002.png", "sea.v2-capture-1.0003.png"]),
        ] {
            let round = round(extension, Part::Between(2.0, 3.0));
            let (told, heard) = channel();
            let mut capture = Capture::begin(&beside, &round, (4, 3), move |said| told.send(said).unwrap()).unwrap();
            for code in [10, 200] {
                capture.take(Frame::filled(4, 3, [code, 0, 0, 255])).unwrap();
            }
            let said = heard.recv().unwrap();
            assert!(said.starts_with("captured as "), "{said}");
            let is_there =
                |file: &&str| std::fs::metadata(folder.path().join(file)).is_ok_and(|found| found.len() > 40);
            assert!(files.iter().all(is_there), "{files:?}");
        }
    }

    #[test]
    fn what_is_given_up_leaves_no_file() {
        let folder = tempfile::tempdir().unwrap();
        let beside = folder.path().join("sea");
        let mut capture = Capture::begin(&beside, &round("apng", Part::All), (4, 3), drop).unwrap();
        capture.take(Frame::filled(4, 3, [0, 0, 0, 255])).unwrap();
        assert!(capture.take(Frame::filled(5, 3, [0, 0, 0, 255])).is_err(), "another size");
        drop(capture);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        assert!(Capture::begin(&beside, &round("avi", Part::All), (4, 3), drop).is_err());
    }
}
