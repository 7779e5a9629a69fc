//! The journal's thread: everything queued is written and synced together, so that a burst of edits costs one sync and
//! nobody waits for the disk. The whole journal is kept in memory (its size is bounded): after a failure a new file is
//! written from that; the failed one is never written again.

use std::fs::File;
use std::io;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::files::disk;
use crate::files::temporary::Temporary;

/// How long after a failure a new file is tried.
const TRY_AGAIN: Duration = Duration::from_secs(1);

/// What the thread is asked to do.
pub(super) enum Message {
    /// Append a frame; the revision is safe once the frame is.
    Append(Vec<u8>, u64),
    /// Replace this many first bytes with this start.
    Compact(Vec<u8>, usize),
    /// Answer once everything before is on the disk, or say why it is not.
    Flush(Sender<Result<(), String>>),
}

/// State that both threads see.
#[derive(Debug, Default)]
pub(super) struct Shared {
    pub acknowledged: AtomicU64,
    pub failing: Mutex<Option<String>>,
}

impl Shared {
    pub fn failing(&self) -> Option<String> {
        self.failing.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    pub fn set_failing(&self, reason: Option<String>) {
        *self.failing.lock().unwrap_or_else(PoisonError::into_inner) = reason;
    }
}

/// A journal being written.
pub(super) struct Writer {
    /// Locked, and positioned at its end.
    pub file: File,
    pub path: PathBuf,
    /// Everything that should be in the file.
    pub contents: Vec<u8>,
    /// How many bytes of it are on the disk.
    pub synced: usize,
    pub shared: Arc<Shared>,
    /// The revision that is safe once all contents are on the disk.
    pub revision: u64,
    /// When the file failed: it must not be written any more.
    pub failed: Option<Instant>,
}

impl Writer {
    /// Writes what is received until all senders are gone; returns the writer.
    pub fn run(mut self, messages: Receiver<Message>) -> Writer {
        loop {
            let first = match self.failed {
                None => messages.recv().map_err(|_| RecvTimeoutError::Disconnected),
                Some(_) => messages.recv_timeout(TRY_AGAIN),
            };
            if matches!(first, Err(RecvTimeoutError::Disconnected)) {
                // A last attempt at what failed before.
                if self.synced < self.contents.len() {
                    self.commit(true);
                }
                return self;
            }
            let mut waiting = Vec::new();
            let mut anew = false;
            for message in first.into_iter().chain(messages.try_iter()) {
                match message {
                    Message::Append(frame, revision) => {
                        self.contents.extend(frame);
                        self.revision = revision;
                    }
                    Message::Compact(start, dropped) => {
                        self.contents.splice(..dropped, start);
                        anew = true;
                    }
                    Message::Flush(reply) => waiting.push(reply),
                }
            }
            let due = self.failed.is_none_or(|at| at.elapsed() >= TRY_AGAIN) || !waiting.is_empty();
            if due {
                self.commit(anew);
            }
            let outcome = self.shared.failing().map_or(Ok(()), Err);
            for reply in waiting {
                // The requester may be gone.
                let _ = reply.send(outcome.clone());
            }
        }
    }

    fn commit(&mut self, anew: bool) {
        let outcome = if anew || self.failed.is_some() { self.write_anew() } else { self.write_more() };
        match outcome {
            Ok(()) => {
                self.synced = self.contents.len();
                self.shared.acknowledged.store(self.revision, Ordering::Release);
                if self.failed.take().is_some() {
                    self.shared.set_failing(None);
                }
            }
            Err(error) => {
                tracing::warn!("{}: {error}", self.path.display());
                self.failed = Some(Instant::now());
                self.shared.set_failing(Some(error.to_string()));
            }
        }
    }

    fn write_more(&mut self) -> io::Result<()> {
        if self.synced < self.contents.len() {
            disk::write(&mut self.file, &self.contents[self.synced..])?;
            disk::sync_data(&self.file)?;
        }
        Ok(())
    }

    fn write_anew(&mut self) -> io::Result<()> {
        let temporary = Temporary::beside(&self.path);
        let mut file = disk::create_new(temporary.path(), true)?;
        file.try_lock()?;
        disk::write(&mut file, &self.contents)?;
        disk::sync(&file)?;
        temporary.put(&self.path)?;
        self.file = file;
        disk::sync_folder_of(&self.path)
    }
}
