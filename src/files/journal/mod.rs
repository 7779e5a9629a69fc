//! The journal beside a scene: every edit, undo, redo and save, on the disk some milliseconds after it was made. It is
//! locked while somebody edits, survives save and quit (this gives undo after reopening), and drops its oldest part
//! when it grows too large.

use std::fs::{File, Permissions};
use std::io::{self, Read};
use std::os::unix::fs::{FileExt, MetadataExt, OpenOptionsExt, PermissionsExt};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{self, Sender};
use std::thread::JoinHandle;

mod format;
mod writer;

pub use format::{Contents, Header, Kind, Record, Unreadable, encode, read};

use super::{beside, disk, hash};
use crate::base::system::{self, folders};
use crate::scene::Document;
use writer::{Message, Shared, Writer};

/// By how many bytes a journal grows before its oldest part is dropped.
const COMPACT_EVERY: usize = 8 << 20;
/// A larger file is not one of our journals.
const MOST_BYTES: u64 = 1 << 30;

/// A journal open for writing. Dropping it waits until everything is on the disk; a journal without records is removed.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    messages: Option<Sender<Message>>,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<Writer>>,
    /// The length of the journal once everything that was sent is written.
    length: usize,
    empty: bool,
    /// An offset in the journal, and the document at that point.
    checkpoint: Option<(usize, Document)>,
    compact_every: usize,
}

/// Why there is no journal.
#[derive(Debug)]
pub enum Unopened {
    /// Another process edits the scene.
    Locked {
        /// Its process number, if known.
        pid: Option<u32>,
    },
    /// The journal cannot be written, or must not be touched.
    Failed(io::Error),
}

impl From<io::Error> for Unopened {
    fn from(error: io::Error) -> Self {
        Unopened::Failed(error)
    }
}

/// A journal that was found or created, and locked; what to do with it is not decided yet.
#[derive(Debug)]
pub struct Candidate {
    file: File,
    path: PathBuf,
    bytes: Vec<u8>,
    /// Its contents; `None` if it is new or damaged.
    pub contents: Option<Contents>,
    /// The file that bytes which were not understood were moved to.
    aside: Option<PathBuf>,
}

/// The path of a scene's journal: beside the scene.
pub fn path_beside(scene_path: &Path) -> PathBuf {
    beside::path(scene_path, "journal")
}

/// The path of a scene's journal if its folder cannot be written: in the user's state folder, named by a hash of the
/// scene's path.
pub fn path_in_state(scene_path: &Path) -> Option<PathBuf> {
    let hash = hash::of(scene_path.as_os_str().as_encoded_bytes());
    Some(folders::state()?.join("journals").join(format!("{}.journal", &hash[..32])))
}

/// Finds and locks the journal of a scene, or creates an empty one. `scene_path` is absolute and free of links. If
/// there is one in both places, the one written last counts.
///
/// # Errors
/// If another process has locked it, if it can be neither beside the scene nor in the user's state folder, or if a
/// newer version of the program wrote it.
pub fn find(scene_path: &Path) -> Result<Candidate, Unopened> {
    let beside = lock(&path_beside(scene_path));
    let Some(in_state) = path_in_state(scene_path) else { return beside };
    match beside {
        Ok(beside) if !in_state.exists() => Ok(beside),
        Ok(beside) => {
            let stray = lock(&in_state)?;
            if stray.last_written() <= beside.last_written() {
                return Ok(beside);
            }
            beside.leave();
            Ok(stray)
        }
        Err(Unopened::Failed(error)) if error.kind() != io::ErrorKind::InvalidData => {
            std::fs::create_dir_all(disk::folder_of(&in_state))?;
            lock(&in_state)
        }
        Err(why) => Err(why),
    }
}

/// What the journal of a scene holds, read without a lock and left as it is; `None` if there is none that can be read.
/// `scene_path` is absolute and free of links.
pub fn look(scene_path: &Path) -> Option<Contents> {
    let last = |contents: &Contents| contents.records.last().map_or(0, |(record, _)| record.time);
    let paths = [path_in_state(scene_path), Some(path_beside(scene_path))];
    paths.into_iter().flatten().filter_map(|path| look_at(&path)).max_by_key(last)
}

fn look_at(path: &Path) -> Option<Contents> {
    let flags = system::no_follow() | system::no_wait();
    let mut file = File::options().read(true).custom_flags(flags).open(path).ok()?;
    let found = file.metadata().ok().filter(|found| found.is_file() && found.uid() == system::user())?;
    if found.len() > MOST_BYTES {
        return None;
    }
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).ok()?;
    read(&bytes).ok()
}

fn lock(path: &Path) -> Result<Candidate, Unopened> {
    loop {
        let mut file = disk::open_private(path)?;
        keep_private(&file)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(std::fs::TryLockError::WouldBlock) => {
                let mut bytes = [0; 16];
                let pid = file.read_exact_at(&mut bytes, 0).ok().and_then(|()| format::writer(&bytes));
                return Err(Unopened::Locked { pid });
            }
            Err(std::fs::TryLockError::Error(error)) => return Err(error.into()),
        }
        // The previous holder may have replaced or removed the file after we opened it.
        let (ours, there) = (file.metadata()?, std::fs::metadata(path));
        if !there.is_ok_and(|there| (there.dev(), there.ino()) == (ours.dev(), ours.ino())) {
            continue;
        }
        if ours.len() > MOST_BYTES {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "is too large for a journal").into());
        }
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)?;
        let contents = match read(&bytes) {
            Ok(contents) => Some(contents),
            Err(Unreadable::Damaged) => None,
            Err(Unreadable::Newer(version)) => {
                let what = format!("was written by a newer plica (version {version})");
                return Err(io::Error::new(io::ErrorKind::InvalidData, what).into());
            }
        };
        return Ok(Candidate { file, path: path.to_owned(), bytes, contents, aside: None });
    }
}

/// Refuses a journal that another user put there or that has another hard link, since edits are not meant for them.
/// Makes a journal that others may read private.
fn keep_private(file: &File) -> io::Result<()> {
    let found = file.metadata()?;
    let refused = |what: &str| Err(io::Error::new(io::ErrorKind::PermissionDenied, what));
    if !found.is_file() {
        return refused("is not a regular file");
    } else if found.uid() != system::user() {
        return refused("belongs to another user");
    } else if found.nlink() > 1 {
        return refused("has another name (a hard link)");
    } else if found.mode() & 0o077 != 0 {
        file.set_permissions(Permissions::from_mode(0o600))?;
    }
    Ok(())
}

impl Candidate {
    /// Its path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// When its last record was made; 0 without records.
    fn last_written(&self) -> u64 {
        let last = self.contents.as_ref().and_then(|contents| contents.records.last());
        last.map_or(0, |(record, _)| record.time)
    }

    /// Gives it up unused.
    pub fn leave(self) {
        if self.bytes.is_empty() {
            // An empty file that stays does no harm.
            let _ = disk::remove(&self.path);
        }
    }

    /// Continues after the first `records` records; the bytes after them are moved to a separate file. Without contents
    /// it starts anew from `header`. `revision` is that of the replayed history.
    ///
    /// # Errors
    /// If it cannot be written. The journal that was found is still there then, and locked: this may be tried again.
    pub fn open(&mut self, header: &Header, records: usize, revision: u64) -> io::Result<OpenJournal> {
        let end = match &self.contents {
            None => 0,
            Some(contents) if records == 0 => contents.header_end,
            Some(contents) => contents.records[records - 1].1,
        };
        if end < self.bytes.len() {
            if self.aside.is_none() {
                self.aside = Some(self.keep_aside(end)?);
            }
            disk::truncate(&self.file, end as u64)?;
            self.bytes.truncate(end);
        }
        io::Seek::seek(&mut self.file, io::SeekFrom::Start(end as u64))?;
        let bytes = if self.contents.is_none() {
            // What an earlier attempt wrote is overwritten completely.
            let start = format::start(header);
            disk::write(&mut self.file, &start)?;
            self.file.set_len(start.len() as u64)?;
            start
        } else {
            let pid = std::process::id().to_le_bytes();
            self.file.write_all_at(&pid, format::PID_AT as u64)?;
            self.bytes[format::PID_AT..][..4].copy_from_slice(&pid);
            self.bytes.clone()
        };
        disk::sync(&self.file)?;
        disk::sync_folder_of(&self.path)?;
        let empty = records == 0;
        Ok(OpenJournal { journal: self.start(bytes, revision, empty)?, aside: self.aside.clone() })
    }

    /// Copies the bytes from `end` on to a separate file.
    fn keep_aside(&self, end: usize) -> io::Result<PathBuf> {
        let name = self.path.file_name().unwrap_or_default().to_string_lossy();
        let free = |path: &PathBuf| path.symlink_metadata().is_err();
        let names = (1..).map(|n| if n == 1 { format!("{name}.rest") } else { format!("{name}.rest-{n}") });
        let path = names.map(|name| self.path.with_file_name(name)).find(free).expect("some number is free");
        let mut file = disk::create_new(&path, true)?;
        let written = disk::write(&mut file, &self.bytes[end..]).and_then(|()| disk::sync(&file));
        // Half a copy is useless, and the next attempt makes another.
        written.inspect_err(|_| drop(disk::remove(&path))).map(|()| path)
    }

    fn start(&self, bytes: Vec<u8>, revision: u64, empty: bool) -> io::Result<Journal> {
        let shared = Arc::new(Shared::default());
        shared.acknowledged.store(revision, Ordering::Release);
        let (length, path) = (bytes.len(), self.path.clone());
        let writer = Writer {
            // The clone shares the lock.
            file: self.file.try_clone()?,
            path: self.path.clone(),
            synced: length,
            contents: bytes,
            shared: shared.clone(),
            revision,
            failed: None,
        };
        let (messages, receiver) = mpsc::channel();
        let thread = std::thread::Builder::new().name("journal".into()).spawn(move || writer.run(receiver))?;
        Ok(Journal {
            path,
            messages: Some(messages),
            shared,
            thread: Some(thread),
            length,
            empty,
            checkpoint: None,
            compact_every: COMPACT_EVERY,
        })
    }
}

/// A journal ready to be written.
#[derive(Debug)]
pub struct OpenJournal {
    /// The journal.
    pub journal: Journal,
    /// The file that bytes which were not understood were moved to.
    pub aside: Option<PathBuf>,
}

impl Journal {
    /// Queues a record, without waiting. `document` is the document after it, `file` the hash of the scene file.
    pub fn append(&mut self, record: &Record, document: &Document, file: &str) {
        let frame = encode(record);
        self.length += frame.len();
        self.empty = false;
        self.send(Message::Append(frame, record.revision));
        match &self.checkpoint {
            Some((at, _)) if self.length - at < self.compact_every => {}
            _ => {
                let now = (self.length, document.clone());
                if let Some((dropped, document)) = self.checkpoint.replace(now) {
                    let header = Header { file: file.to_owned(), document: document.json().clone(), is_file: false };
                    self.drop_oldest(dropped, format::start(&header));
                }
            }
        }
    }

    fn drop_oldest(&mut self, dropped: usize, start: Vec<u8>) {
        let shift = |at: usize| at - dropped + start.len();
        self.length = shift(self.length);
        self.checkpoint = self.checkpoint.take().map(|(at, document)| (shift(at), document));
        self.send(Message::Compact(start, dropped));
    }

    /// For tests: sets by how many bytes the journal grows before its oldest part is dropped.
    #[cfg(test)]
    pub fn compact_every(&mut self, bytes: usize) {
        self.compact_every = bytes;
    }

    /// The newest revision that is safe on the disk.
    pub fn acknowledged(&self) -> u64 {
        self.shared.acknowledged.load(Ordering::Acquire)
    }

    /// Why writing fails at present; `None` if it does not.
    pub fn failing(&self) -> Option<String> {
        self.shared.failing()
    }

    /// Waits until everything queued is on the disk.
    ///
    /// # Errors
    /// Why it is not.
    pub fn flush(&self) -> Result<(), String> {
        let (reply, answer) = mpsc::channel();
        self.send(Message::Flush(reply));
        answer.recv().unwrap_or_else(|_| Err("its writer has ended".into()))
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    fn send(&self, message: Message) {
        if self.messages.as_ref().is_none_or(|messages| messages.send(message).is_err()) {
            self.shared.set_failing(Some("its writer has ended".into()));
        }
    }
}

impl Drop for Journal {
    fn drop(&mut self) {
        self.messages = None;
        let writer = self.thread.take().map(JoinHandle::join);
        if let (true, Some(Ok(writer))) = (self.empty, writer) {
            // The writer still has the lock. An empty journal that stays does no harm.
            let _ = disk::remove(&writer.path);
        }
    }
}
