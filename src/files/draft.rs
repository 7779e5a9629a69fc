//! Output that appears complete or not at all: it is written to a hidden temporary file beside its place and renamed
//! when complete. A draft that is dropped before (after an error or an interrupt) leaves nothing behind.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::PathBuf;

use super::outputs::{Cleared, ClearedFolder};
use super::temporary::{self, Temporary};
use super::write::{self, Atomic};
use crate::base::error::{Error, Result};
use crate::base::system;

/// A file being written, buffered. A file that is already in its place stays until [`DraftFile::keep`].
#[derive(Debug)]
pub enum DraftFile {
    /// A regular file.
    Whole(BufWriter<Atomic>, PathBuf),
    /// A pipe or a device, which is written directly.
    Special(BufWriter<File>, PathBuf),
}

impl DraftFile {
    /// Begins a file for `place`. A link is followed; the folder must exist.
    pub fn create(place: &Cleared) -> Result<Self> {
        let path = place.path();
        if !fs::metadata(path).is_ok_and(|m| !m.is_file() && !m.is_dir()) {
            return Ok(DraftFile::Whole(BufWriter::with_capacity(1 << 16, Atomic::create(path)?), path.to_path_buf()));
        }
        let file = system::open_special(path).map_err(|error| match error.kind() {
            io::ErrorKind::WouldBlock => Error::at(path.display(), "is a FIFO that nobody reads")
                .cure("let another program begin to read it first, or name a file"),
            _ => write::failed(path.display(), &error),
        })?;
        Ok(DraftFile::Special(BufWriter::new(file), path.to_path_buf()))
    }

    /// Moves the file into place, replacing what was there.
    pub fn keep(self) -> Result<()> {
        match self {
            DraftFile::Whole(file, path) => {
                file.into_inner().map_err(|e| write::failed(path.display(), e.error()))?.commit()
            }
            DraftFile::Special(mut file, path) => file.flush().map_err(|e| write::failed(path.display(), &e)),
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

/// A file for another program to write: the program overwrites the temporary file, and [`Atomic::commit`] moves it into
/// place.
///
/// # Errors
/// As [`Atomic::create`].
pub fn for_program(place: &Cleared) -> Result<Atomic> {
    Atomic::create(place.path())
}

/// A set of files being written to one folder. Files that are already there stay until [`DraftFolder::keep`]; those of
/// an earlier set that are not in the new one are removed then, and files with other names stay for good.
#[derive(Debug)]
pub struct DraftFolder {
    target: PathBuf,
    temporary: Temporary,
    earlier: BTreeSet<String>,
    /// Tells others that the temporary folder is being written.
    _held: Option<File>,
}

impl DraftFolder {
    /// Begins a set of files for the folder at `place`, which need not exist; its parent must.
    pub fn create(place: &ClearedFolder) -> Result<Self> {
        let path = place.path();
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
        if target.exists() && !target.is_dir() {
            return Err(Error::at(path.display(), "is a file, not a folder").cure("name a folder"));
        }
        // In the folder if it exists, otherwise beside it: renaming works only within one file system.
        let temporary =
            if target.is_dir() { Temporary::beside(&target.join("file")) } else { Temporary::beside(&target) };
        fs::create_dir(temporary.path()).map_err(|e| write::failed(path.display(), &e))?;
        let held = File::open(temporary.path()).ok();
        held.iter().for_each(temporary::hold);
        Ok(DraftFolder { target, temporary, earlier: place.earlier.clone(), _held: held })
    }

    /// Writes one file of the set. May be called from many threads at once.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<()> {
        let written = File::create(self.temporary.path().join(name)).and_then(|mut file| {
            file.write_all(bytes)?;
            file.sync_all()
        });
        written.map_err(|e| write::failed(self.target.join(name).display(), &e))
    }

    /// Moves the files into place, in the order of `names`: the last one should be the one that lists the others. What
    /// is left of the earlier set is removed just before it.
    pub fn keep(self, names: &[String]) -> Result<()> {
        if !self.target.exists() {
            return self.temporary.put(&self.target).map_err(|e| write::failed(self.target.display(), &e));
        }
        let (others, last) = names.split_at(names.len().saturating_sub(1));
        others.iter().try_for_each(|name| self.put(name))?;
        for name in self.earlier.iter().filter(|name| !names.contains(name)) {
            // One that cannot be removed is only untidy.
            let _ = fs::remove_file(self.target.join(name));
        }
        last.iter().try_for_each(|name| self.put(name))
    }

    fn put(&self, name: &str) -> Result<()> {
        let target = self.target.join(name);
        fs::rename(self.temporary.path().join(name), &target).map_err(|e| write::failed(target.display(), &e))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    use crate::files::outputs::{self, Guard};

    fn begin(path: &Path) -> Result<DraftFile> {
        DraftFile::create(&Guard::new(true).file(path, outputs::PNG)?)
    }

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
        let mut draft = begin(&path).unwrap();
        draft.write_all(b"half").unwrap();
        drop(draft);
        assert_eq!((names(folder.path()), fs::read(&path).unwrap()), (vec!["a.gif".into()], b"old".to_vec()));
        let mut draft = begin(&path).unwrap();
        draft.write_all(b"new").unwrap();
        draft.keep().unwrap();
        assert_eq!((names(folder.path()), fs::read(&path).unwrap()), (vec!["a.gif".into()], b"new".to_vec()));
    }

    #[test]
    fn a_missing_folder_is_named_with_the_cure() {
        let folder = tempfile::tempdir().unwrap();
        let error = begin(&folder.path().join("none/a.gif")).unwrap_err().to_string();
        assert!(error.contains("none/a.gif") && error.contains("make the folder first"), "{error}");
    }

    #[test]
    fn a_folder_is_whole_or_untouched() {
        let folder = tempfile::tempdir().unwrap();
        let set = folder.path().join("set");
        let begin = |earlier: &[&str]| {
            let earlier = earlier.iter().map(|name| (*name).to_owned()).collect();
            DraftFolder::create(&Guard::new(false).folder(&set, &|_| false, earlier).unwrap()).unwrap()
        };
        let draft = begin(&[]);
        draft.write("a", b"1").unwrap();
        drop(draft);
        assert!(names(folder.path()).is_empty());
        // The new set, the earlier set, the files there afterwards.
        for (content, earlier, there) in [
            (&["a", "old", "m"][..], &[][..], &["a", "m", "old"][..]),
            (&["a", "m"], &["a", "old", "m"], &["a", "m", "mine"]),
        ] {
            let draft = begin(earlier);
            content.iter().for_each(|name| draft.write(name, content.len().to_string().as_bytes()).unwrap());
            let all: Vec<_> = content.iter().map(|name| (*name).to_owned()).collect();
            draft.keep(&all).unwrap();
            assert_eq!(names(&set), there);
            assert_eq!(fs::read_to_string(set.join("a")).unwrap(), content.len().to_string());
            fs::write(set.join("mine"), "mine").unwrap();
        }
        assert_eq!(names(folder.path()), ["set"]);
    }

    #[test]
    fn a_fifo_is_written_where_somebody_reads_and_makes_nobody_wait() {
        use std::io::Read;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.gif");
        rustix::fs::mknodat(rustix::fs::CWD, &path, rustix::fs::FileType::Fifo, rustix::fs::Mode::RWXU, 0).unwrap();
        let refused = begin(&path).unwrap_err().to_string();
        assert!(refused.contains("is a FIFO that nobody reads (let another program"), "{refused}");
        let reader = {
            let path = path.clone();
            std::thread::spawn(move || {
                let mut all = Vec::new();
                File::open(path).unwrap().read_to_end(&mut all).unwrap();
                all
            })
        };
        let mut draft = (0..1000).find_map(|_| {
            std::thread::sleep(std::time::Duration::from_millis(5));
            begin(&path).ok()
        });
        let draft = draft.as_mut().unwrap();
        // More than a pipe holds: it waits for its reader then, as any program does.
        draft.write_all(&[7; 300_000]).unwrap();
        draft.flush().unwrap();
        if let DraftFile::Special(file, _) = draft {
            *file = BufWriter::new(File::create("/dev/null").unwrap());
        }
        assert_eq!(reader.join().unwrap(), [7; 300_000]);
    }

    #[test]
    fn a_device_is_written_as_it_is() {
        let mut draft = begin(Path::new("/dev/null")).unwrap();
        draft.write_all(b"gone").unwrap();
        draft.keep().unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }
}
