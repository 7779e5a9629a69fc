//! The disk operations that durability is built from, one function each. A test can make the n-th of them fail, or kill
//! the process there, where no tracer can do it from outside (tests/durability.rs).

use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::os::unix::fs::{FileTypeExt, OpenOptionsExt};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use crate::base::system;

/// What happens at the operation that a test chose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The operation fails.
    Error,
    /// The process is killed there; a write is half done.
    Kill,
}

static DONE: AtomicU64 = AtomicU64::new(0);
static FAULTY: AtomicU64 = AtomicU64::new(u64::MAX);
static KILLS: AtomicBool = AtomicBool::new(false);

/// For tests: the `n`-th operation from now, counted from 0, meets `fault`.
pub fn inject(n: u64, fault: Fault) {
    KILLS.store(fault == Fault::Kill, Ordering::SeqCst);
    FAULTY.store(operations() + n, Ordering::SeqCst);
}

/// For tests: how many operations this process has begun.
pub fn operations() -> u64 {
    DONE.load(Ordering::SeqCst)
}

/// Creates a file that must not exist yet, readable for its owner alone if `private`, otherwise by the process's umask.
pub fn create_new(path: &Path, private: bool) -> io::Result<File> {
    operation(None)?;
    let mode = if private { 0o600 } else { 0o666 };
    OpenOptions::new().read(true).write(true).create_new(true).mode(mode).open(path)
}

/// Opens a file of ours to read and write, created with mode 0600 if missing. A link, and anything but a regular file,
/// is refused; opening a FIFO never blocks.
pub fn open_private(path: &Path) -> io::Result<File> {
    operation(None)?;
    let mut options = OpenOptions::new();
    let flags = system::no_follow() | system::no_wait();
    options.read(true).write(true).create(true).truncate(false).mode(0o600).custom_flags(flags);
    regular(options.open(path)?)
}

/// The file, if it is a regular file.
///
/// # Errors
/// `InvalidInput` if it is a folder, a FIFO, a device or a socket; the message says which.
pub fn regular(file: File) -> io::Result<File> {
    let kind = file.metadata()?.file_type();
    let kinds = [
        (kind.is_dir(), "a folder"),
        (kind.is_fifo(), "a FIFO"),
        (kind.is_char_device() || kind.is_block_device(), "a device"),
        (kind.is_socket(), "a socket"),
    ];
    match kinds.iter().find(|(is, _)| *is) {
        None => Ok(file),
        Some((_, name)) => Err(io::Error::new(io::ErrorKind::InvalidInput, format!("is {name}, not a file"))),
    }
}

/// Writes all of `bytes` at the file's current position.
pub fn write(file: &mut File, bytes: &[u8]) -> io::Result<()> {
    operation(Some((file, bytes)))?;
    file.write_all(bytes)
}

/// Truncates the file to `length` bytes.
pub fn truncate(file: &File, length: u64) -> io::Result<()> {
    operation(None)?;
    file.set_len(length)
}

/// Flushes the file and its attributes to the disk. After a failure its pages may be lost for good: write a new file.
pub fn sync(file: &File) -> io::Result<()> {
    operation(None)?;
    #[cfg(test)]
    if IS_FULL.get() {
        return Err(io::ErrorKind::StorageFull.into());
    }
    file.sync_all()
}

/// Flushes the file's content to the disk, as [`sync`] does.
pub fn sync_data(file: &File) -> io::Result<()> {
    operation(None)?;
    file.sync_data()
}

/// Atomically replaces `to` with `from`.
pub fn rename(from: &Path, to: &Path) -> io::Result<()> {
    operation(None)?;
    std::fs::rename(from, to)
}

/// Flushes the names in the folder of `path` to the disk.
pub fn sync_folder_of(path: &Path) -> io::Result<()> {
    operation(None)?;
    File::open(folder_of(path))?.sync_all()
}

/// Removes the file.
pub fn remove(path: &Path) -> io::Result<()> {
    operation(None)?;
    std::fs::remove_file(path)
}

/// The folder that contains `path`.
pub fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

#[cfg(test)]
thread_local! {
    /// Whether the disk counts as full for this thread.
    pub static IS_FULL: std::cell::Cell<bool> = const { std::cell::Cell::new(false) };
}

fn operation(written: Option<(&mut File, &[u8])>) -> io::Result<()> {
    if DONE.fetch_add(1, Ordering::SeqCst) != FAULTY.load(Ordering::SeqCst) {
        return Ok(());
    }
    if KILLS.load(Ordering::SeqCst) {
        // A slow disk: a caller that does not wait for it has time to report success too early.
        std::thread::sleep(Duration::from_millis(20));
        if let Some((file, bytes)) = written {
            file.write_all(&bytes[..bytes.len() / 2])?;
        }
        std::process::abort();
    }
    Err(io::Error::other("injected fault"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_of_ours_is_a_regular_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        rustix::fs::mknodat(rustix::fs::CWD, path("fifo"), rustix::fs::FileType::Fifo, rustix::fs::Mode::RWXU, 0)
            .unwrap();
        std::os::unix::fs::symlink("file", path("link")).unwrap();
        open_private(&path("file")).unwrap();
        assert_eq!(open_private(&path("fifo")).unwrap_err().to_string(), "is a FIFO, not a file");
        assert!(open_private(&path("link")).is_err());
    }
}
