//! Atomic writes: a temporary file in the same folder, synced, renamed over the old one, and the folder synced. Readers
//! see the complete old file or the complete new one, whatever happens in between.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::os::unix::fs::{MetadataExt, fchown};
use std::path::{Component, Path, PathBuf};

use super::temporary::{self, Temporary};
use super::{disk, paths};
use crate::base::error::{Error, Result};
use crate::base::system::{self, beneath};

/// Writes `bytes` to `path` atomically. An existing file's mode and extended attributes are kept; a link is followed.
///
/// # Errors
/// If anything fails up to and including the sync of the folder: the data is not safe on the disk then, and the caller
/// must not claim it is. The old file stays, unless only that last sync failed.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<()> {
    let mut file = Atomic::create(path)?;
    file.write_all(bytes).map_err(|error| cannot_write(path, error))?;
    file.commit()
}

/// Writes `bytes` to a new file, atomically; an existing file is left alone.
///
/// # Errors
/// If something of that name exists, or as [`write_atomic`].
pub fn write_new(path: &Path, bytes: &[u8]) -> Result<()> {
    if path.symlink_metadata().is_ok() {
        return Err(Error::at(path.display(), "is there already").cure("choose another name, or move it away"));
    }
    write_atomic(path, bytes)
}

/// Copies a file to a new one, atomically; an existing file with the same content is accepted.
///
/// # Errors
/// If something else of that name exists, or as [`write_atomic`].
pub fn copy_new(from: &Path, to: &Path) -> Result<()> {
    let mut bytes = Vec::new();
    paths::open_named(from)?.read_to_end(&mut bytes).map_err(|error| Error::at(from.display(), error))?;
    if to.symlink_metadata().is_ok() && !holds(to, &bytes) {
        let what = format!("is there already, and is another file than {}, which is copied there", from.display());
        return Err(Error::at(to.display(), what).cure("rename one of the two, or make the scene where that is"));
    }
    put_new(to, &bytes)
}

/// As [`write_new`]; an existing file with the same content is accepted.
fn put_new(to: &Path, bytes: &[u8]) -> Result<()> {
    if holds(to, bytes) { Ok(()) } else { write_new(to, bytes) }
}

/// Whether these bytes are what is in a file.
fn holds(path: &Path, bytes: &[u8]) -> bool {
    paths::read(path, bytes.len() as u64).is_ok_and(|there| there == bytes)
}

/// Copies a file into the folder `to` under this name, as [`copy_new`]; folders in its name are made there.
///
/// # Errors
/// If the name leads out of the folder, or as [`copy_new`].
pub fn copy_into(source: &Path, to: &Path, name: &str) -> Result<()> {
    if !is_below(name) {
        let error = Error::at(source.display(), "is not in the folder of what names it, and cannot be copied with it");
        return Err(error.cure("make the scene where that is"));
    }
    copy_new(source, &made_within(to, name)?)
}

/// Writes a new file of this name into the folder `to`, as [`write_new`]; folders in its name are made there. An existing file
/// with the same content is accepted.
///
/// # Errors
/// If the name leads out of the folder, or as [`write_new`].
pub fn put_into(to: &Path, name: &str, bytes: &[u8]) -> Result<()> {
    put_new(&made_within(to, name)?, bytes)
}

/// Writes a file of this name into the folder `to`, as [`write_atomic`]; folders in its name are made there.
///
/// # Errors
/// If the name leads out of the folder, or as [`write_atomic`].
pub fn replace_into(to: &Path, name: &str, bytes: &[u8]) -> Result<()> {
    write_atomic(&made_within(to, name)?, bytes)
}

/// Whether a name means a file of a folder or below.
pub fn is_below(name: &str) -> bool {
    Path::new(name).components().all(|part| matches!(part, Component::Normal(_)))
}

/// The path of a file in the folder `to`; folders in its name are made.
fn made_within(to: &Path, name: &str) -> Result<PathBuf> {
    if !is_below(name) {
        return Err(Error::at(name, format!("is not below {}", to.display())).cure("name a file below it"));
    }
    let target = to.join(name);
    if let Some(folder) = target.parent().filter(|folder| *folder != to) {
        std::fs::create_dir_all(folder).map_err(|error| cannot_write(folder, error))?;
    }
    Ok(target)
}

/// A file being written, moved into place by [`Atomic::commit`]. If dropped before that, it leaves nothing behind.
#[derive(Debug)]
pub struct Atomic {
    file: File,
    temporary: Temporary,
    target: PathBuf,
}

impl Atomic {
    /// Begins a file for `path`.
    ///
    /// # Errors
    /// If the folder cannot be written, or `path` exists and is no regular file.
    pub fn create(path: &Path) -> Result<Self> {
        let target = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let old = target.metadata().ok();
        if old.as_ref().is_some_and(|old| !old.is_file()) {
            return Err(Error::at(path.display(), "is not a regular file").cure("name a file"));
        }
        let temporary = Temporary::beside(&target);
        let file = disk::create_new(temporary.path(), false).map_err(|error| cannot_write(path, error))?;
        temporary::hold(&file);
        if let Some(old) = old {
            // Only root can give a file back to its old owner; the mode matters for everybody.
            let _ = fchown(&file, Some(old.uid()), Some(old.gid()));
            file.set_permissions(old.permissions()).map_err(|error| cannot_write(path, error))?;
            if let Ok(old) = File::open(&target) {
                system::copy_attributes(&old, &file);
            }
        }
        Ok(Atomic { file, temporary, target })
    }

    /// Where it is until it is committed.
    pub fn temporary(&self) -> &Path {
        self.temporary.path()
    }

    /// Flushes the file to the disk and moves it into place.
    ///
    /// # Errors
    /// As [`write_atomic`]. A failed file cannot be retried: begin a new one.
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

/// What mends an I/O error of an output, by its kind, and how the system calls it.
const CURES: &[(io::ErrorKind, &str, &str)] = &[
    (io::ErrorKind::NotFound, "No such file or directory", "make the folder first"),
    (io::ErrorKind::NotADirectory, "Not a directory", "name a folder where one is meant"),
    (io::ErrorKind::IsADirectory, "Is a directory", "name a file"),
    (io::ErrorKind::PermissionDenied, "Permission denied", "choose a folder that you may write to"),
    (io::ErrorKind::ReadOnlyFilesystem, "Read-only file system", "choose a folder that you may write to"),
    (io::ErrorKind::StorageFull, "No space left on device", "make room, then try again"),
    (io::ErrorKind::QuotaExceeded, "Disk quota exceeded", "make room, then try again"),
    (io::ErrorKind::FileTooLarge, "File too large", "choose a disk that takes files of this size, or write less"),
    (io::ErrorKind::InvalidFilename, "File name too long", "choose a shorter name"),
    (io::ErrorKind::ExecutableFileBusy, "Text file busy", "end the program that runs from it, or name another file"),
    (io::ErrorKind::WriteZero, "write zero bytes", "make room, then try again"),
];

/// The cure of a failed output in the words of another program, which quotes the system.
pub fn cure_in_words(said: &str) -> Option<&'static str> {
    CURES.iter().find(|(_, words, _)| said.contains(words)).map(|(.., cure)| *cure)
}

/// That an output failed: with the cure, if it is an I/O error or was caused by one.
pub fn failed(place: impl std::fmt::Display, error: &(dyn std::error::Error + 'static)) -> Error {
    let Some(io) = cause(error) else { return Error::at(place, error) };
    let failed = Error::at(place, format!("cannot be written: {io}"));
    match CURES.iter().find(|(kind, ..)| *kind == io.kind()) {
        Some((.., cure)) => failed.cure(*cure),
        None if beneath::is_loop(io) => failed.cure("mend the link"),
        None => failed,
    }
}

fn cause<'a>(error: &'a (dyn std::error::Error + 'static)) -> Option<&'a io::Error> {
    // This one does not tell what caused it in the way that all others do.
    if let Some(png::EncodingError::IoError(io)) = error.downcast_ref() {
        return Some(io);
    }
    error.downcast_ref().or_else(|| error.source().and_then(cause))
}

pub(super) fn cannot_write(path: &Path, error: io::Error) -> Error {
    failed(path.display(), &error)
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
    fn a_failed_output_has_the_cure_of_its_cause() {
        let full = || io::Error::from_raw_os_error(28);
        let errors: [Box<dyn std::error::Error>; 4] = [
            Box::new(full()),
            Box::new(png::EncodingError::IoError(full())),
            Box::new(gif::EncodingError::Io(full())),
            Box::new(io::Error::new(io::ErrorKind::StorageFull, "No space left on device")),
        ];
        for error in errors {
            let said = failed("a.gif", &*error).to_string();
            let wanted = "a.gif: cannot be written: No space left on device";
            assert!(said.starts_with(wanted) && said.ends_with("(make room, then try again)"), "{said}");
        }
        // What the system says of each number is what the table has for it.
        for (number, cure) in [
            (2, "make the folder first"),
            (13, "choose a folder that you may write to"),
            (30, "choose a folder that you may write to"),
            (20, "name a folder where one is meant"),
            (21, "name a file"),
            (27, "choose a disk that takes files of this size, or write less"),
            (28, "make room, then try again"),
            (36, "choose a shorter name"),
        ] {
            let error = io::Error::from_raw_os_error(number);
            assert_eq!(cure_in_words(&format!("ffmpeg: x: {error}")), Some(cure), "{error}");
            assert!(failed("x", &error).to_string().ends_with(&format!("({cure})")), "{error}");
        }
        assert!(!failed("x", &io::Error::from_raw_os_error(5)).to_string().ends_with("system)"));
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
        symlink("round", folder.path().join("round")).unwrap();
        assert!(
            write_new(&folder.path().join("round/new"), b"y").unwrap_err().to_string().ends_with("(mend the link)")
        );
    }
}
