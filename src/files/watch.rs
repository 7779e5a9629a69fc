//! Watches files for changes by other programs. Folders are watched, not files: programs save by renaming a new file
//! over the old one. Changes are reported once a file has been quiet for a moment, so that one written in pieces is
//! read whole.

use std::collections::{BTreeSet, HashMap};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use notify::event::{AccessKind, AccessMode, EventKind};
use notify::{RecommendedWatcher, RecursiveMode, Watcher};

use super::disk::folder_of;
use crate::base::error::{Error, Result};

/// A change is reported after nothing more has come for this long.
const QUIET: Duration = Duration::from_millis(100);
/// A file that is written without a pause is reported this long after its first change.
const PATIENCE: Duration = Duration::from_secs(1);

/// Files being watched. Whether a change is somebody else's shows in the file's hash: see
/// [`super::session::Session::take_in`].
#[derive(Debug)]
pub struct Watch {
    watcher: RecommendedWatcher,
    folders: BTreeSet<PathBuf>,
    files: Arc<Mutex<Files>>,
}

/// From the watcher's name of a file to our caller's name of it.
type Files = HashMap<PathBuf, PathBuf>;

impl Watch {
    /// Watches nothing yet. `changed` is called on a separate thread, with the files that changed.
    ///
    /// # Errors
    /// If the system cannot watch files.
    pub fn new(changed: impl Fn(Vec<PathBuf>) + Send + 'static) -> Result<Watch> {
        let (sender, events) = mpsc::channel();
        let watcher = notify::recommended_watcher(sender).map_err(cannot_watch)?;
        let files = Arc::new(Mutex::new(Files::new()));
        let seen = Arc::clone(&files);
        std::thread::Builder::new()
            .name("watch".into())
            .spawn(move || debounce(&events, &seen, changed))
            .map_err(|error| Error::at("the thread that watches files", error))?;
        Ok(Watch { watcher, folders: BTreeSet::new(), files })
    }

    /// Watches these files from now on, and no others. They need not exist.
    ///
    /// # Errors
    /// If a folder cannot be watched: the first such folder; all others are watched.
    pub fn set(&mut self, files: &[PathBuf]) -> Result<()> {
        let named: Files =
            files.iter().flat_map(|file| places(file).into_iter().map(|place| (place, file.clone()))).collect();
        let folders: BTreeSet<PathBuf> = named.keys().map(|file| folder_of(file).to_owned()).collect();
        *lock(&self.files) = named;
        for gone in self.folders.difference(&folders) {
            // The folder may have been removed, and its watch with it.
            let _ = self.watcher.unwatch(gone);
        }
        let mut outcome = Ok(());
        for new in folders.difference(&self.folders) {
            let watched = self.watcher.watch(new, RecursiveMode::NonRecursive);
            outcome = outcome.and(watched.map_err(cannot_watch));
        }
        self.folders = folders;
        outcome
    }
}

/// Where changes of a file show: in its folder, and for a link, also in the folder of its target.
fn places(file: &Path) -> Vec<PathBuf> {
    let name = file.file_name().unwrap_or(OsStr::new(""));
    let folder = std::fs::canonicalize(folder_of(file)).unwrap_or_else(|_| folder_of(file).to_owned());
    let mut places = vec![folder.join(name)];
    places.extend(std::fs::canonicalize(file).ok().filter(|target| *target != places[0]));
    places
}

fn debounce(events: &Receiver<notify::Result<notify::Event>>, files: &Mutex<Files>, changed: impl Fn(Vec<PathBuf>)) {
    while let Ok(event) = events.recv() {
        let mut touched = concerned(event, &lock(files));
        let first = Instant::now();
        while !touched.is_empty() && first.elapsed() < PATIENCE {
            match events.recv_timeout(QUIET) {
                Ok(event) => touched.extend(concerned(event, &lock(files))),
                Err(RecvTimeoutError::Timeout) => break,
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
        if !touched.is_empty() {
            changed(touched.into_iter().collect());
        }
    }
}

/// The watched files that an event is about; all of them if the system lost events.
fn concerned(event: notify::Result<notify::Event>, files: &Files) -> BTreeSet<PathBuf> {
    let Ok(event) = event else { return BTreeSet::new() };
    if event.need_rescan() {
        return files.values().cloned().collect();
    }
    match event.kind {
        EventKind::Access(AccessKind::Close(AccessMode::Write)) => {}
        EventKind::Access(_) => return BTreeSet::new(),
        _ => {}
    }
    event.paths.iter().filter_map(|path| files.get(path).cloned()).collect()
}

fn lock(files: &Mutex<Files>) -> MutexGuard<'_, Files> {
    files.lock().unwrap_or_else(PoisonError::into_inner)
}

fn cannot_watch(error: notify::Error) -> Error {
    let place = error.paths.first().map_or("files".to_owned(), |path| path.display().to_string());
    Error::at(place, format!("cannot be watched for changes: {error}")).cure("reload by hand")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Long enough on any machine; a reported change ends the wait.
    const LONG: Duration = Duration::from_secs(60);

    #[test]
    fn changes_of_every_kind_are_told() {
        let folder = tempfile::tempdir().unwrap();
        let (scene, elsewhere) = (folder.path().join("scene"), folder.path().join("sub"));
        std::fs::create_dir(&elsewhere).unwrap();
        std::fs::write(elsewhere.join("target"), "1").unwrap();
        std::os::unix::fs::symlink("sub/target", folder.path().join("link")).unwrap();
        let (sender, told) = mpsc::channel();
        let mut watch = Watch::new(move |files| sender.send(files).unwrap()).unwrap();
        let link = folder.path().join("link");
        watch.set(&[scene.clone(), link.clone()]).unwrap();
        std::fs::write(folder.path().join("other"), "not watched").unwrap();
        std::fs::write(&scene, "made").unwrap();
        assert_eq!(told.recv_timeout(LONG).unwrap(), std::slice::from_ref(&scene));
        std::fs::write(folder.path().join("new"), "renamed").unwrap();
        std::fs::rename(folder.path().join("new"), &scene).unwrap();
        assert_eq!(told.recv_timeout(LONG).unwrap(), std::slice::from_ref(&scene));
        std::fs::write(elsewhere.join("target"), "2").unwrap();
        assert_eq!(told.recv_timeout(LONG).unwrap(), [link]);
        let mut chunks = std::fs::File::create(&scene).unwrap();
        for _ in 0..50 {
            std::io::Write::write_all(&mut chunks, b"piece").unwrap();
        }
        drop(chunks);
        assert_eq!(told.recv_timeout(LONG).unwrap(), std::slice::from_ref(&scene));
        assert_eq!(std::fs::read(&scene).unwrap().len(), 250);
        std::fs::remove_file(&scene).unwrap();
        assert_eq!(told.recv_timeout(LONG).unwrap(), [scene]);
    }
}
