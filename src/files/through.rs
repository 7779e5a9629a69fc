//! Saving a scene whose file has other names (hard links) or is protected. Renaming a new file over one of the names
//! would separate them, so such a file is written in place. A copy of the new text is on the disk before the first byte
//! is written; if the save is cut short, the copy counts instead of the file's own text.

use std::fs::{File, Metadata, OpenOptions};
use std::io::{self, Read};
use std::os::unix::fs::{MetadataExt, OpenOptionsExt, PermissionsExt};
use std::path::{Path, PathBuf};

use super::temporary::Temporary;
use super::{beside, disk, write};
use crate::base::error::{Error, Result};
use crate::base::system;

/// Refuses to replace a file that is write-protected.
///
/// # Errors
/// If it is, for everybody or for this user; or if that cannot be found out.
pub fn refuse_protected(path: &Path) -> Result<()> {
    match found(path)? {
        Some(found) if found.mode() & 0o222 == 0 || system::is_denied_to_write(path) => {
            let user = system::user();
            Err(if user == 0 || found.uid() == user {
                Error::at(path.display(), "is read-only").cure("make it writable first: chmod u+w")
            } else {
                let error = Error::at(path.display(), "is another user's, and read-only for you");
                error.cure("save a copy of it: plica edit, then :w PATH")
            })
        }
        _ => Ok(()),
    }
}

/// Whether the file at `path` has other names.
///
/// # Errors
/// If that cannot be found out: replacing the file could separate it from them.
pub fn has_other_names(path: &Path) -> Result<bool> {
    Ok(found(path)?.is_some_and(|found| found.is_file() && found.nlink() > 1))
}

/// The metadata of `path`; `None` if there is no such file.
fn found(path: &Path) -> Result<Option<Metadata>> {
    match path.metadata() {
        Ok(found) => Ok(Some(found)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(write::cannot_write(path, error)),
    }
}

/// Writes `bytes` into the file at `path`, which keeps its names, owner, mode and attributes.
///
/// # Errors
/// As [`write::write_atomic`]. Then the file has its old content, or the copy beside it counts: see [`left_behind`].
pub fn write_through(path: &Path, bytes: &[u8]) -> Result<()> {
    let failed = |error| write::cannot_write(path, error);
    let old = std::fs::read(path).map_err(failed)?;
    let copy = copy_of(path);
    put_copy(&copy, bytes).map_err(failed)?;
    let mode = path.metadata().map_err(failed)?.permissions();
    let mut file = match open(path) {
        Err(error) if error.kind() == io::ErrorKind::PermissionDenied => {
            let writable = std::fs::Permissions::from_mode(mode.mode() | 0o200);
            std::fs::set_permissions(path, writable).and_then(|()| open(path))
        }
        opened => opened,
    }
    .map_err(|error| {
        let _ = disk::remove(&copy);
        failed(error)
    })?;
    let written = fill(&mut file, bytes);
    // If restoring the mode or removing the copy fails, the next save tries again.
    let _ = file.set_permissions(mode);
    if let Err(error) = written {
        // The old content fits where it was. If not even that can be written, the copy stays.
        if fill(&mut file, &old).is_ok() {
            let _ = disk::remove(&copy);
        }
        return Err(failed(error));
    }
    let _ = disk::remove(&copy);
    Ok(())
}

fn open(path: &Path) -> io::Result<File> {
    OpenOptions::new().write(true).custom_flags(system::no_follow()).open(path)
}

fn fill(file: &mut File, bytes: &[u8]) -> io::Result<()> {
    io::Seek::rewind(file)?;
    disk::write(file, bytes)?;
    disk::truncate(file, bytes.len() as u64)?;
    disk::sync(file)
}

fn put_copy(copy: &Path, bytes: &[u8]) -> io::Result<()> {
    let temporary = Temporary::beside(copy);
    let mut file = disk::create_new(temporary.path(), true)?;
    disk::write(&mut file, bytes)?;
    disk::sync(&file)?;
    temporary.put(copy)?;
    disk::sync_folder_of(copy)
}

fn copy_of(scene_path: &Path) -> PathBuf {
    beside::path(scene_path, "saving")
}

/// The text of a save that was cut short, if there is one.
pub fn left_behind(scene_path: &Path) -> Option<String> {
    let copy = copy_of(&scene_path.canonicalize().ok()?);
    let file = OpenOptions::new().read(true).custom_flags(system::no_follow()).open(copy).ok()?;
    file.metadata().ok().filter(|found| found.is_file() && found.uid() == system::user())?;
    let mut text = String::new();
    { file }.read_to_string(&mut text).ok()?;
    Some(text)
}

/// Completes a save that was cut short: `is_whole` says whether a text is a complete one. To be called with the lock of
/// the scene.
///
/// # Errors
/// If the file cannot be written.
pub fn mend(scene_path: &Path, is_whole: impl Fn(&str) -> bool) -> Result<()> {
    let Some(text) = left_behind(scene_path) else { return Ok(()) };
    let now = std::fs::read(scene_path).unwrap_or_default();
    if is_whole(&text) && !std::str::from_utf8(&now).is_ok_and(&is_whole) {
        return write_through(scene_path, text.as_bytes());
    }
    // A copy that stays is looked at again next time.
    let _ = disk::remove(&copy_of(scene_path));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_keeps_its_names_and_a_save_cut_short_is_ended() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().canonicalize().unwrap();
        let (scene, other) = (folder.join("a.plica.json"), folder.join("b"));
        std::fs::write(&scene, "{\"old\": true}").unwrap();
        assert!(!has_other_names(&scene).unwrap());
        std::fs::hard_link(&scene, &other).unwrap();
        assert!(has_other_names(&scene).unwrap());
        std::fs::set_permissions(&scene, std::fs::Permissions::from_mode(0o444)).unwrap();
        write_through(&scene, b"{}").unwrap();
        assert_eq!(std::fs::read(&other).unwrap(), b"{}");
        assert_eq!((other.metadata().unwrap().nlink(), other.metadata().unwrap().mode() & 0o777), (2, 0o444));
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 2, "the copy is gone");

        let is_whole = |text: &str| text.ends_with('}');
        put_copy(&copy_of(&scene), b"{\"new\": true}").unwrap();
        mend(&scene, is_whole).unwrap();
        assert_eq!(std::fs::read(&other).unwrap(), b"{}", "what is whole is left alone");
        put_copy(&copy_of(&scene), b"{\"new\": true}").unwrap();
        std::fs::set_permissions(&scene, std::fs::Permissions::from_mode(0o644)).unwrap();
        std::fs::write(&scene, "{\"new\": t").unwrap();
        assert_eq!(left_behind(&scene).as_deref(), Some("{\"new\": true}"));
        mend(&scene, is_whole).unwrap();
        assert_eq!(std::fs::read(&other).unwrap(), b"{\"new\": true}");
        assert_eq!(left_behind(&scene), None);
    }

    #[test]
    fn a_protected_file_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        refuse_protected(&path).unwrap();
        std::fs::write(&path, "").unwrap();
        refuse_protected(&path).unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o444)).unwrap();
        assert!(
            refuse_protected(&path)
                .unwrap_err()
                .to_string()
                .ends_with("is read-only (make it writable first: chmod u+w)")
        );
    }
}
