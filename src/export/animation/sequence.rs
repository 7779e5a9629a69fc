//! One PNG file per frame, numbered by a pattern such as `%04d.png`. Each file appears, whole, as soon as it can: what is
//! done stays if the work is ended. As many frames as there are threads are compressed at once, so that memory stays bounded.

use std::collections::{BTreeMap, VecDeque};
use std::io::Write;
use std::thread::JoinHandle;

use super::{Show, Sink};
use crate::base::error::Result;
use crate::base::pixels::Frame;
use crate::export::numbered::Pattern;
use crate::export::still;
use crate::files::draft::DraftFile;
use crate::files::outputs::{self, Cleared, Guard};
use crate::files::write;

/// The files of a sequence, by their numbers.
pub struct Places(BTreeMap<u64, Cleared>);

impl Places {
    /// The files for frames of these numbers.
    ///
    /// # Errors
    /// The folder does not exist, or the guard refuses a file.
    pub fn new(pattern: &Pattern, numbers: &[u64], guard: &mut Guard) -> Result<Places> {
        let names: Vec<String> = numbers.iter().map(|&number| pattern.name(number)).collect();
        let places = guard.files(pattern.folder()?, &names, outputs::PNG)?;
        Ok(Places(numbers.iter().copied().zip(places).collect()))
    }

    /// Every file, by number.
    pub fn all(&self) -> Vec<Cleared> {
        self.0.values().cloned().collect()
    }

    /// Whether the file of this number is a whole PNG of this size.
    pub fn has(&self, number: u64, size: (usize, usize)) -> bool {
        let ends = self.0.get(&number).and_then(|place| outputs::ends(place.path(), HEAD, END.len()).ok());
        ends.is_some_and(|(head, end)| end == END && size_of(&head) == Some(size))
    }
}

/// Signature and header of a PNG up to its height.
const HEAD: usize = 24;
/// How every whole PNG ends.
const END: &[u8] = b"\0\0\0\0IEND\xae\x42\x60\x82";

fn size_of(head: &[u8]) -> Option<(usize, usize)> {
    let number = |at: usize| Some(u32::from_be_bytes(head.get(at..at + 4)?.try_into().ok()?) as usize);
    let is_png = head.get(12..16) == Some(b"IHDR");
    is_png.then(|| Some((number(16)?, number(20)?)))?
}

/// Begins a sequence.
pub fn begin(places: Places, show: Show) -> Result<Box<dyn Sink>> {
    Ok(Box::new(Sequence { places, show, writing: VecDeque::new() }))
}

/// Bytes that it keeps: one frame a core that is being packed.
pub fn memory(show: &Show) -> u64 {
    let at_once = (rayon::current_num_threads() as u64).min(show.frames);
    at_once * (8 * show.pixels() + still::memory(show.pixels()))
}

struct Sequence {
    places: Places,
    show: Show,
    writing: VecDeque<JoinHandle<Result<()>>>,
}

impl Sequence {
    /// Waits for the oldest file that is being written.
    fn wait(&mut self) -> Result<()> {
        let written = self.writing.pop_front().map_or(Ok(Ok(())), JoinHandle::join);
        written.unwrap_or_else(|_| Err(self.show.failed("a frame could not be compressed")))
    }
}

fn put(place: &Cleared, frame: &Frame) -> Result<()> {
    let failed = |error: &(dyn std::error::Error + 'static)| write::failed(place.path().display(), error);
    let bytes = still::frame(frame).map_err(|e| failed(&e))?;
    let mut draft = DraftFile::create(place)?;
    draft.write_all(&bytes).map_err(|e| failed(&e))?;
    draft.keep()
}

impl Sink for Sequence {
    fn frame(&mut self, number: u64, frame: Frame) -> Result<()> {
        let Some(place) = self.places.0.get(&number).cloned() else {
            return Err(self.show.failed(format!("frame {number} has no place")));
        };
        if self.writing.len() >= rayon::current_num_threads() {
            self.wait()?;
        }
        self.writing.push_back(std::thread::spawn(move || put(&place, &frame)));
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> Result<Vec<String>> {
        while !self.writing.is_empty() {
            self.wait()?;
        }
        Ok(Vec::new())
    }
}

/// What is finished stays, and so does what is being written at the moment.
impl Drop for Sequence {
    fn drop(&mut self) {
        while !self.writing.is_empty() {
            // An error that ends the work has been reported.
            let _ = self.wait();
        }
    }
}
