//! Watches files for changes by other programs. Folders are watched, not files: programs save by renaming a new file
//! over the old one. Changes are reported once a file has been quiet for a moment, so that one written in pieces is
//! read whole.

use std::collections::{BTreeSet, HashMap};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use notify::event::{AccessKind, AccessMode, CreateKind, EventKind, ModifyKind};
use notify::{RecommendedWatcher, RecursiveMode, Watcher};

use super::disk::folder_of;
use crate::base::error::{Error, Result};

/// A change is reported after nothing more has come for this long.
const QUIET: Duration = Duration::from_millis(100);
/// A file that keeps changing is reported this long after its first change.
const PATIENCE: Duration = Duration::from_secs(1);
/// The same for a file that its writer still has open: the writer may have emptied it first, and pause before it writes.
const WRITER: Duration = Duration::from_secs(3);

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
        let mut touched = Touched::default();
        touched.take(event, &lock(files));
        let first = Instant::now();
        while !touched.files.is_empty() && first.elapsed() < touched.patience() {
            match events.recv_timeout(QUIET) {
                Ok(event) => touched.take(event, &lock(files)),
                Err(RecvTimeoutError::Timeout) if touched.open.is_empty() => break,
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
        if !touched.files.is_empty() {
            changed(touched.files.into_iter().collect());
        }
    }
}

/// Watched files that have changed.
#[derive(Debug, Default)]
struct Touched {
    files: BTreeSet<PathBuf>,
    /// Those that somebody still has open for writing.
    open: BTreeSet<PathBuf>,
}

impl Touched {
    /// Takes in what an event tells: all files have changed if the system lost events.
    fn take(&mut self, event: notify::Result<notify::Event>, files: &Files) {
        let Ok(event) = event else { return };
        if event.need_rescan() {
            self.files.extend(files.values().cloned());
            return;
        }
        let writes = match event.kind {
            EventKind::Access(AccessKind::Close(AccessMode::Write)) => false,
            EventKind::Access(_) => return,
            // Only Linux tells when a file is closed.
            EventKind::Create(CreateKind::File) | EventKind::Modify(ModifyKind::Data(_)) => cfg!(target_os = "linux"),
            _ => false,
        };
        for file in event.paths.iter().filter_map(|path| files.get(path)) {
            self.files.insert(file.clone());
            match writes {
                true => self.open.insert(file.clone()),
                false => self.open.remove(file),
            };
        }
    }

    fn patience(&self) -> Duration {
        if self.open.is_empty() { PATIENCE } else { WRITER }
    }
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
    #[cfg(target_os = "linux")]
    fn a_file_is_waited_for_until_it_is_closed() {
        use notify::event::{DataChange, MetadataKind, RemoveKind, RenameMode};
        let closed = EventKind::Access(AccessKind::Close(AccessMode::Write));
        let written = EventKind::Modify(ModifyKind::Data(DataChange::Any));
        let made = EventKind::Create(CreateKind::File);
        for (kinds, touched, open) in [
            (&[made][..], 1, 1),
            (&[made, written, closed], 1, 0),
            (&[written], 1, 1),
            (&[written, closed, written], 1, 1),
            (&[EventKind::Modify(ModifyKind::Name(RenameMode::To))], 1, 0),
            (&[written, EventKind::Remove(RemoveKind::File)], 1, 0),
            (&[EventKind::Modify(ModifyKind::Metadata(MetadataKind::Any))], 1, 0),
            (&[EventKind::Access(AccessKind::Read)], 0, 0),
        ] {
            let files = Files::from([("/a".into(), "a".into())]);
            let mut all = Touched::default();
            for path in ["/a", "/b"] {
                let event = |kind: &EventKind| notify::Event::new(*kind).add_path(path.into());
                kinds.iter().map(event).for_each(|event| all.take(Ok(event), &files));
            }
            assert_eq!((all.files.len(), all.open.len()), (touched, open), "{kinds:?}");
        }
    }

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
