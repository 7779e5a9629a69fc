//! The log: what happened, for those who fix faults. It goes to a file only; the terminal belongs to the user. The file
//! is created with the first line.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use super::write;
use crate::base::error::{Error, Result};
use crate::base::system::{self, folders};

/// A longer log, in bytes, is started anew; one old log is kept.
const MOST_BYTES: u64 = 1 << 20;

/// Starts the log in `file`, otherwise in the user's state folder, and returns its path. `None` if there is no such
/// folder.
///
/// # Errors
/// If `file` is given and cannot be written.
pub fn start(file: Option<&Path>) -> Result<Option<PathBuf>> {
    let path = match file {
        Some(file) => file.to_owned(),
        None => match folders::state() {
            Some(folder) => folder.join("plica.log"),
            None => return Ok(None),
        },
    };
    let mut log = Log { path: path.clone(), makes_folder: file.is_none(), file: None };
    if file.is_some_and(|file| !may_be_log(file)) {
        let error = Error::at(path.display(), "is there already and is no log");
        return Err(error.cure("name another file for the log"));
    }
    if file.is_some() {
        log.open().map_err(|error| write::failed(path.display(), &error))?;
    }
    let subscriber = tracing_subscriber::fmt().with_ansi(false).with_writer(Mutex::new(log)).finish();
    // In a program that uses the library, a subscriber of its own stays.
    let _ = tracing::subscriber::set_global_default(subscriber);
    Ok(Some(path))
}

/// Whether a log may be written to this file: it is new, empty, or begins with a time, as every log does.
fn may_be_log(path: &Path) -> bool {
    let mut head = Vec::new();
    match path.metadata() {
        Ok(found) if found.is_file() && found.len() > 0 => {
            let read = File::open(path).and_then(|file| file.take(20).read_to_end(&mut head));
            let digits = |at: usize| head.get(at..at + 2).is_some_and(|two| two.iter().all(u8::is_ascii_digit));
            read.is_ok() && [0, 2, 5, 8, 11, 14, 17].into_iter().all(digits) && head[10] == b'T'
        }
        _ => true,
    }
}

struct Log {
    path: PathBuf,
    makes_folder: bool,
    file: Option<File>,
}

impl Log {
    fn open(&mut self) -> io::Result<&mut File> {
        if self.file.is_none() {
            if let Some(folder) = self.path.parent().filter(|_| self.makes_folder) {
                std::fs::create_dir_all(folder)?;
            }
            if self.path.metadata().is_ok_and(|found| found.is_file() && found.len() > MOST_BYTES) {
                std::fs::rename(&self.path, self.path.with_extension("log.old"))?;
            }
            let mut options = OpenOptions::new();
            // A FIFO that nobody reads is no place for a log, and opening it must not block.
            options.append(true).create(true).mode(0o600).custom_flags(system::no_wait());
            self.file = Some(options.open(&self.path)?);
        }
        self.file.as_mut().ok_or_else(|| io::ErrorKind::NotFound.into())
    }
}

/// A log that cannot be written must not stop anything.
impl Write for Log {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if let Ok(file) = self.open() {
            let _ = file.write_all(bytes);
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_log_is_written_on() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        assert!(may_be_log(&path));
        for (text, is) in [
            ("", true),
            ("2026-11-28T23:40:56.123456Z  WARN plica: x", true),
            ("2026-11-28 23:40", false),
            ("\u{89}PNG", false),
            ("{\"plica\": 1}", false),
        ] {
            std::fs::write(&path, text).unwrap();
            assert_eq!(may_be_log(&path), is, "{text}");
        }
    }
}
