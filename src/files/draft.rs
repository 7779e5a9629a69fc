//! Output that appears whole or not at all: it is written to a hidden temporary beside its place and renamed when it is
//! complete. A draft that is dropped before (an error, an interrupt) leaves nothing.

use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::write::{Atomic, Temporary};
use crate::base::error::{Error, Result};

/// A file being written, buffered. What already stands in its place stays until [`DraftFile::keep`].
#[derive(Debug)]
pub enum DraftFile {
    /// A regular file.
    Whole(BufWriter<Atomic>, PathBuf),
    /// A pipe or a device, which is written as it goes.
    Special(BufWriter<File>, PathBuf),
}

impl DraftFile {
    /// Begins a file that shall stand at `path`. A link is followed; the folder must be there.
    pub fn create(path: &Path) -> Result<Self> {
        if !fs::metadata(path).is_ok_and(|m| !m.is_file() && !m.is_dir()) {
            return Ok(DraftFile::Whole(BufWriter::with_capacity(1 << 16, Atomic::create(path)?), path.to_path_buf()));
        }
        let file = File::options().write(true).open(path).map_err(|e| Error::at(path.display(), e))?;
        Ok(DraftFile::Special(BufWriter::new(file), path.to_path_buf()))
    }

    /// Puts the file in its place, replacing what stood there.
    pub fn keep(self) -> Result<()> {
        match self {
            DraftFile::Whole(file, path) => {
                file.into_inner().map_err(|e| Error::at(path.display(), e.into_error()))?.commit()
            }
            DraftFile::Special(mut file, path) => file.flush().map_err(|e| Error::at(path.display(), e)),
        }
    }
}

impl Write for DraftFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            DraftFile::Whole(file, _) => file.write(bytes),
            DraftFile::Special(file, _) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            DraftFile::Whole(file, _) => file.flush(),
            DraftFile::Special(file, _) => file.flush(),
        }
    }
}

impl Seek for DraftFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match self {
            DraftFile::Whole(file, _) => file.seek(to),
            DraftFile::Special(file, _) => file.seek(to),
        }
    }
}

/// A set of files being written, to stand in one folder. Files that already stand there stay until [`DraftFolder::keep`],
/// and those of other names stay for good.
#[derive(Debug)]
pub struct DraftFolder {
    target: PathBuf,
    temporary: Temporary,
}

impl DraftFolder {
    /// Begins a set of files for the folder at `path`, which need not be there; the folder around it must.
    pub fn create(path: &Path) -> Result<Self> {
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
        if target.exists() && !target.is_dir() {
            return Err(Error::at(path.display(), "is a file, not a folder"));
        }
        // Within a folder that is there, else beside it: renaming needs one file system.
        let temporary =
            if target.is_dir() { Temporary::beside(&target.join("file")) } else { Temporary::beside(&target) };
        fs::create_dir(temporary.path()).map_err(|e| at_folder_of(path, &e))?;
        Ok(DraftFolder { target, temporary })
    }

    /// Writes one file of the set. May be called from many threads at once.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<()> {
        fs::write(self.temporary.path().join(name), bytes).map_err(|e| Error::at(self.target.join(name).display(), e))
    }

    /// Puts the files in their place, in the order of `names`.
    pub fn keep(self, names: &[String]) -> Result<()> {
        if !self.target.exists() {
            return self.temporary.put(&self.target).map_err(|e| Error::at(self.target.display(), e));
        }
        for name in names {
            let target = self.target.join(name);
            fs::rename(self.temporary.path().join(name), &target).map_err(|e| Error::at(target.display(), e))?;
        }
        Ok(())
    }
}

fn at_folder_of(path: &Path, error: &io::Error) -> Error {
    let made = Error::at(path.display(), error);
    if error.kind() == io::ErrorKind::NotFound { made.cure("make the folder first") } else { made }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_replaces_the_old_one_only_when_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.gif");
        fs::write(&path, "old").unwrap();
        let mut draft = DraftFile::create(&path).unwrap();
        draft.write_all(b"half").unwrap();
        drop(draft);
        assert_eq!((names(folder.path()), fs::read(&path).unwrap()), (vec!["a.gif".into()], b"old".to_vec()));
        let mut draft = DraftFile::create(&path).unwrap();
        draft.write_all(b"new").unwrap();
        draft.keep().unwrap();
        assert_eq!((names(folder.path()), fs::read(&path).unwrap()), (vec!["a.gif".into()], b"new".to_vec()));
    }

    #[test]
    fn a_missing_folder_is_named_with_the_cure() {
        let folder = tempfile::tempdir().unwrap();
        let error = DraftFile::create(&folder.path().join("none/a.gif")).unwrap_err().to_string();
        assert!(error.contains("none/a.gif") && error.contains("make the folder first"), "{error}");
    }

    #[test]
    fn a_folder_is_whole_or_untouched() {
        let folder = tempfile::tempdir().unwrap();
        let set = folder.path().join("set");
        let draft = DraftFolder::create(&set).unwrap();
        draft.write("a", b"1").unwrap();
        drop(draft);
        assert!(names(folder.path()).is_empty());
        for (content, others) in [("1", &["a"][..]), ("2", &["a", "mine"])] {
            let draft = DraftFolder::create(&set).unwrap();
            draft.write("a", content.as_bytes()).unwrap();
            draft.keep(&["a".into()]).unwrap();
            assert_eq!((names(&set), fs::read_to_string(set.join("a")).unwrap()), (others_of(others), content.into()));
            fs::write(set.join("mine"), "mine").unwrap();
        }
        assert_eq!(names(folder.path()), ["set"]);
    }

    fn others_of(names: &[&str]) -> Vec<String> {
        names.iter().map(|n| n.to_string()).collect()
    }

    #[test]
    fn a_device_is_written_as_it_is() {
        let mut draft = DraftFile::create(Path::new("/dev/null")).unwrap();
        draft.write_all(b"gone").unwrap();
        draft.keep().unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }
}
