//! Files of lines that the editor runs: scripts, and the logs of its sessions, which are scripts too. A log is written
//! by a separate thread, so that no key waits for a disk; the file is created with the first line, and only the newest
//! are kept, up to a size.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Write};
use std::os::unix::fs::{FileTypeExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread::JoinHandle;
use std::time::SystemTime;

use super::paths;
use crate::base::error::{Error, Result};
use crate::base::system::folders;

/// The logs are kept as long as all of them together take no more bytes than this, the newest in any case.
const KEPT_BYTES: u64 = 32 << 20;
/// What the smallest takes on a disk.
const LEAST_BYTES: u64 = 4 << 10;
/// The most characters of a scene's name in a log's name: with four bytes each they still fit beside the rest.
const LONGEST_STEM: usize = 50;
/// How a log's name ends.
const SUFFIX: &str = "plica";
/// A longer file is not a script.
const MOST_BYTES: u64 = 16 << 20;

/// Reads a script.
///
/// # Errors
/// If there is no such file, it is no text, or it is far too long for a script.
pub fn read(path: &Path) -> Result<String> {
    whole(paths::open_named(path)?, path)
}

/// As [`read`], also from a pipe, as `<(...)` of a shell is one: waits until whoever writes into it has ended.
///
/// # Errors
/// As [`read`].
pub fn read_piped(path: &Path) -> Result<String> {
    let kind = path.metadata().map(|found| found.file_type());
    // A device too, as /dev/null for no lines.
    let opened = if kind.is_ok_and(|kind| kind.is_fifo() || kind.is_char_device()) {
        File::open(path).map_err(|error| Error::at(path.display(), error))
    } else {
        paths::open_named(path)
    };
    whole(opened?, path)
}

fn whole(file: File, path: &Path) -> Result<String> {
    let mut bytes = Vec::new();
    let read = file.take(MOST_BYTES + 1).read_to_end(&mut bytes);
    read.map_err(|error| Error::at(path.display(), error))?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(Error::at(path.display(), "is longer than 16 MiB").cure("name a file of lines"));
    }
    String::from_utf8(bytes).map_err(|_| Error::at(path.display(), "is not UTF-8 text").cure("name a file of lines"))
}

/// The log of one session.
pub struct Log {
    path: PathBuf,
    lines: Option<Sender<String>>,
    thread: Option<JoinHandle<()>>,
}

impl Log {
    /// A log in the user's state folder, named after the scene; `header` is written before its first line. If it cannot
    /// be written, `failed` is called once. `None` if there is no such folder.
    pub fn begin(scene: &Path, header: Vec<String>, failed: impl FnOnce(String) + Send + 'static) -> Option<Log> {
        Some(Log::begin_in(&folders::state()?.join("sessions"), scene, header, failed))
    }

    fn begin_in(folder: &Path, scene: &Path, header: Vec<String>, failed: impl FnOnce(String) + Send + 'static) -> Log {
        let seconds = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).map_or(0, |since| since.as_secs());
        let name = scene.file_name().unwrap_or_default().to_string_lossy();
        let stem: String = name.split('.').next().unwrap_or_default().chars().take(LONGEST_STEM).collect();
        let path = folder.join(format!("{seconds}-{stem}-{}.{SUFFIX}", std::process::id()));
        let (sender, lines) = mpsc::channel();
        let to = path.clone();
        let thread = std::thread::spawn(move || {
            if let Err(error) = write(&to, &header, &lines) {
                failed(super::write::failed(to.display(), &error).to_string());
            }
        });
        Log { path, lines: Some(sender), thread: Some(thread) }
    }

    /// Its path, even before it has a first line.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Queues a line to be written.
    pub fn write(&self, line: String) {
        // A thread that could not write has reported it and ended.
        self.lines.iter().for_each(|lines| drop(lines.send(line.clone())));
    }
}

impl Drop for Log {
    /// Waits until everything is written.
    fn drop(&mut self) {
        self.lines = None;
        // The thread does not panic; if it did, only the log would be lost.
        self.thread.take().into_iter().for_each(|thread| drop(thread.join()));
    }
}

fn write(path: &Path, header: &[String], lines: &Receiver<String>) -> io::Result<()> {
    let Ok(mut line) = lines.recv() else { return Ok(()) };
    let mut file = create(path)?;
    let mut text: String = header.iter().map(|line| format!("# {line}\n")).collect();
    loop {
        text.push_str(&line);
        text.push('\n');
        text.extend(lines.try_iter().map(|line| line + "\n"));
        file.write_all(text.as_bytes())?;
        text.clear();
        match lines.recv() {
            Ok(next) => line = next,
            Err(_) => return Ok(()),
        }
    }
}

/// Creates the file and its folder, and removes the oldest of the other logs.
fn create(path: &Path) -> io::Result<File> {
    let folder = super::disk::folder_of(path);
    std::fs::create_dir_all(folder)?;
    let file = OpenOptions::new().append(true).create_new(true).mode(0o600).open(path)?;
    prune(folder, path, KEPT_BYTES)?;
    Ok(file)
}

/// Removes the oldest logs but this one, so that the others take no more than so many bytes.
fn prune(folder: &Path, own: &Path, most: u64) -> io::Result<()> {
    let mut all: Vec<(SystemTime, PathBuf, u64)> = std::fs::read_dir(folder)?
        .flatten()
        .filter(|entry| entry.path().extension().is_some_and(|suffix| suffix == SUFFIX) && entry.path() != own)
        .filter_map(|entry| entry.metadata().ok().map(|known| (entry.path(), known)))
        .filter_map(|(path, known)| Some((known.modified().ok()?, path, known.len().max(LEAST_BYTES))))
        .collect();
    all.sort();
    let mut taken = 0;
    for (_, old, bytes) in all.iter().rev() {
        taken += bytes;
        if taken > most {
            // One log too many does no harm.
            let _ = std::fs::remove_file(old);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_comes_with_its_first_line() {
        let folder = tempfile::tempdir().unwrap();
        let inside = folder.path().join("sessions");
        let begin = |scene: &str| Log::begin_in(&inside, Path::new(scene), vec!["plica".into()], |why| panic!("{why}"));
        drop(begin("/a/nothing.plica.json"));
        assert!(!inside.exists());
        std::fs::create_dir(&inside).unwrap();
        let log = begin("/a/cat.plica.json");
        log.write("move down".into());
        log.write("put 5".into());
        let path = log.path().to_owned();
        drop(log);
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "# plica\nmove down\nput 5\n");
        assert!(path.to_str().unwrap().contains("-cat-"));
    }

    #[test]
    fn the_newest_logs_stay_up_to_a_size() {
        let folder = tempfile::tempdir().unwrap();
        let begun = SystemTime::UNIX_EPOCH;
        // One of them is larger than the others together.
        for (i, name) in ["a.plica", "b.plica", "large.plica", "d.plica", "own.plica", "mine.txt"].iter().enumerate() {
            let path = folder.path().join(name);
            std::fs::write(&path, vec![b'#'; if *name == "large.plica" { 9000 } else { 10 }]).unwrap();
            let file = File::options().append(true).open(&path).unwrap();
            file.set_modified(begun + std::time::Duration::from_secs(1000 + i as u64)).unwrap();
        }
        let left = |most| {
            prune(folder.path(), &folder.path().join("own.plica"), most).unwrap();
            let names = std::fs::read_dir(folder.path()).unwrap();
            let mut names: Vec<String> = names.map(|one| one.unwrap().file_name().into_string().unwrap()).collect();
            names.sort();
            names
        };
        assert_eq!(left(20_000), ["b.plica", "d.plica", "large.plica", "mine.txt", "own.plica"]);
        assert_eq!(left(5000), ["d.plica", "mine.txt", "own.plica"]);
        assert_eq!(left(0), ["mine.txt", "own.plica"]);
    }

    #[test]
    fn a_log_that_cannot_be_written_says_so_once() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("sessions"), "a file").unwrap();
        let (sender, said) = mpsc::channel();
        let failed = move |why: String| sender.send(why).unwrap();
        let log = Log::begin_in(&folder.path().join("sessions"), Path::new("a"), Vec::new(), failed);
        log.write("move down".into());
        drop(log);
        assert_eq!(said.iter().map(|why| why.contains("cannot be written")).collect::<Vec<_>>(), [true]);
    }

    #[test]
    fn only_text_is_a_script() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("script");
        std::fs::write(&path, "move down\n").unwrap();
        assert_eq!(read(&path).unwrap(), "move down\n");
        std::fs::write(&path, [0xff, 0xfe]).unwrap();
        assert!(read(&path).unwrap_err().to_string().contains("UTF-8"));
        assert!(read(&folder.path().join("no")).is_err() && read_piped(&folder.path().join("no")).is_err());
        let pipe = folder.path().join("pipe");
        let mode = rustix::fs::Mode::RUSR | rustix::fs::Mode::WUSR;
        rustix::fs::mknodat(rustix::fs::CWD, &pipe, rustix::fs::FileType::Fifo, mode, 0).unwrap();
        assert!(read(&pipe).unwrap_err().to_string().contains("is a FIFO"));
        let to = pipe.clone();
        let writer = std::thread::spawn(move || std::fs::write(to, "move up\n").unwrap());
        assert_eq!(read_piped(&pipe).unwrap(), "move up\n");
        writer.join().unwrap();
        assert_eq!(read_piped(Path::new("/dev/null")).unwrap(), "");
        assert!(read_piped(Path::new("/dev/zero")).unwrap_err().to_string().contains("is longer than"));
    }
}
