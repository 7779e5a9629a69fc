//! Atomic writes: a temporary file in the same folder, synced, renamed over the old one, and the folder synced. Whoever
//! looks sees the old file or the new one, whole, whatever happens in between.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::os::unix::fs::{MetadataExt, fchown};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::{disk, paths};
use crate::base::error::{Error, Result};
use crate::base::system;

const TEMPORARY_PREFIX: &str = ".plica-";
const TEMPORARY_SUFFIX: &str = ".tmp";

/// Writes `bytes` to `path` atomically. An existing file's mode is kept; a link is followed.
///
/// # Errors
/// When anything fails up to and including the sync of the folder: the data is not safe on the disk then, and the
/// caller must not say so. The old file stays, except where that last sync is what failed.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<()> {
    let mut file = Atomic::create(path)?;
    file.write_all(bytes).map_err(|error| cannot_write(path, error))?;
    file.commit()
}

/// Writes `bytes` to a new file, atomically; a file that is there is left alone.
///
/// # Errors
/// When something of that name is there, or as [`write_atomic`].
pub fn write_new(path: &Path, bytes: &[u8]) -> Result<()> {
    if path.symlink_metadata().is_ok() {
        return Err(Error::at(path.display(), "is there already").cure("choose another name, or move it away"));
    }
    write_atomic(path, bytes)
}

/// Copies a file to a new one, atomically; a file of the same content that is there already will do.
///
/// # Errors
/// When something else of that name is there, or as [`write_atomic`].
pub fn copy_new(from: &Path, to: &Path) -> Result<()> {
    let mut bytes = Vec::new();
    paths::open_named(from)?.read_to_end(&mut bytes).map_err(|error| Error::at(from.display(), error))?;
    if std::fs::read(to).is_ok_and(|there| there == bytes) { Ok(()) } else { write_new(to, &bytes) }
}

/// A file being written, to take its place on [`Atomic::commit`]. Dropped before that, it leaves nothing behind.
#[derive(Debug)]
pub struct Atomic {
    file: File,
    temporary: Temporary,
    target: PathBuf,
}

impl Atomic {
    /// Begins a file that will stand at `path`.
    ///
    /// # Errors
    /// When the folder cannot be written, or `path` is there and no regular file.
    pub fn create(path: &Path) -> Result<Self> {
        let target = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let old = target.metadata().ok();
        if old.as_ref().is_some_and(|old| !old.is_file()) {
            return Err(Error::at(path.display(), "is not a regular file").cure("name a file"));
        }
        let temporary = Temporary::beside(&target);
        let file = disk::create_new(temporary.path(), false).map_err(|error| cannot_write(path, error))?;
        if let Some(old) = old {
            // Giving a file to its old owner is for root alone; the mode matters to everybody.
            let _ = fchown(&file, Some(old.uid()), Some(old.gid()));
            file.set_permissions(old.permissions()).map_err(|error| cannot_write(path, error))?;
        }
        Ok(Atomic { file, temporary, target })
    }

    /// Brings the file to the disk and puts it in its place.
    ///
    /// # Errors
    /// As [`write_atomic`]. The failed file is never tried again: begin a new one.
    pub fn commit(self) -> Result<()> {
        let Atomic { file, temporary, target } = self;
        disk::sync(&file).and_then(|()| temporary.put(&target)).map_err(|error| cannot_write(&target, error))?;
        disk::sync_folder_of(&target).map_err(|error| {
            Error::at(target.display(), format!("was written, but may not survive a power cut: {error}"))
                .cure("write it again, or to another disk")
        })
    }
}

impl Write for Atomic {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        disk::write(&mut self.file, bytes)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Atomic {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

/// A name for a file or folder being made, beside its place. What stands there is removed when this is dropped.
#[derive(Debug)]
pub struct Temporary(PathBuf);

/// What [`remove_unfinished`] removes.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

impl Temporary {
    /// A name of our own beside `path`, short so that it is never too long where `path` is not. Nothing is made.
    pub fn beside(path: &Path) -> Self {
        static MADE: AtomicU64 = AtomicU64::new(0);
        let number = MADE.fetch_add(1, Ordering::Relaxed);
        let name = format!("{TEMPORARY_PREFIX}{}-{number}{TEMPORARY_SUFFIX}", std::process::id());
        let path = disk::folder_of(path).join(name);
        unfinished().push(path.clone());
        Temporary(path)
    }

    /// Where it is to be made.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Puts what was made in its place, at once.
    ///
    /// # Errors
    /// When it cannot be renamed; it is removed then.
    pub fn put(self, target: &Path) -> io::Result<()> {
        disk::rename(&self.0, target)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        unfinished().retain(|path| *path != self.0);
        remove(&self.0);
    }
}

fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes what this process has half made; for a process that is to end at once.
pub fn remove_unfinished() {
    unfinished().drain(..).for_each(|path| remove(&path));
}

/// Removes what killed processes left half made in the folder of `path`.
pub fn remove_stale(path: &Path) {
    let Ok(entries) = std::fs::read_dir(disk::folder_of(path)) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let middle = name.to_str().and_then(|n| n.strip_prefix(TEMPORARY_PREFIX)?.strip_suffix(TEMPORARY_SUFFIX));
        let Some((pid, _)) = middle.and_then(|middle| middle.split_once('-')) else { continue };
        if pid.parse().is_ok_and(|pid| !system::process_lives(pid)) {
            remove(&entry.path());
        }
    }
}

/// Removes a file or a folder. It may have got its place meanwhile, or somebody else was first; and what cannot be
/// removed now is removed as stale another day.
fn remove(path: &Path) {
    match path.symlink_metadata() {
        Ok(found) if found.is_dir() => drop(std::fs::remove_dir_all(path)),
        Ok(_) => drop(disk::remove(path)),
        Err(_) => {}
    }
}

fn cannot_write(path: &Path, error: io::Error) -> Error {
    let cure = match error.kind() {
        io::ErrorKind::NotFound => "make the folder first",
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => "choose a folder that you may write to",
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => "make room, then try again",
        _ => return Error::at(path.display(), format!("cannot be written: {error}")),
    };
    Error::at(path.display(), format!("cannot be written: {error}")).cure(cure)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::{PermissionsExt, symlink};

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn the_old_mode_and_the_link_are_kept() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        write_atomic(&file, b"one").unwrap();
        std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o640)).unwrap();
        symlink("file", &link).unwrap();
        write_atomic(&link, b"two").unwrap();
        assert_eq!(std::fs::read(&file).unwrap(), b"two");
        assert_eq!(file.metadata().unwrap().mode() & 0o777, 0o640);
        assert!(link.symlink_metadata().unwrap().is_symlink());
        assert_eq!(names(folder.path()), ["file", "link"]);
    }

    #[test]
    fn what_is_dropped_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        std::fs::write(&path, "old").unwrap();
        let mut file = Atomic::create(&path).unwrap();
        file.write_all(b"half").unwrap();
        assert_eq!(names(folder.path()).len(), 2);
        drop(file);
        assert_eq!(names(folder.path()), ["file"]);
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
    }

    #[test]
    fn only_a_regular_file_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("sub")).unwrap();
        for (path, message) in [
            (Path::new("/dev/null"), "regular"),
            (&folder.path().join("sub"), "regular"),
            (&folder.path().join("no/file"), "folder first"),
        ] {
            let error = write_atomic(path, b"x").unwrap_err().to_string();
            assert!(error.contains(message), "{error}");
        }
        write_new(&folder.path().join("new"), b"x").unwrap();
        assert!(write_new(&folder.path().join("new"), b"y").unwrap_err().to_string().contains("there already"));
    }

    #[test]
    fn only_what_the_dead_left_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let mut dead = std::process::Command::new("true").spawn().unwrap();
        dead.wait().unwrap();
        let ours = Temporary::beside(&folder.path().join("x"));
        let theirs = format!(".plica-{}-0.tmp", dead.id());
        for name in [ours.path().file_name().unwrap().to_str().unwrap(), &theirs, ".plica-x.tmp", "cat.png"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        remove_stale(&folder.path().join("x"));
        let left = names(folder.path());
        assert_eq!(left.len(), 3, "{left:?}");
        assert!(!left.contains(&theirs));
    }
}
