//! Names of unfinished files. They say which process writes the file (machine, boot, PID namespace, PID, start time),
//! so that a later process can remove what a killed one left behind, but never what a living one is still writing, not
//! even in another container or on another machine that shares the folder.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime};

use super::disk;
use crate::base::system::process::{self, Identity};

const PREFIX: &str = ".plica-";
const SUFFIX: &str = ".tmp";

/// After this time, a living process of another namespace has locked its file.
const LOCKED_WITHIN: Duration = Duration::from_secs(60);
/// After this time without a change, nobody is writing the file any more.
const FORGOTTEN: Duration = Duration::from_secs(24 * 3600);

/// The name of an unfinished file or folder, beside its final place. The file is removed when this is dropped.
#[derive(Debug)]
pub struct Temporary(PathBuf);

/// The files that [`remove_unfinished`] removes.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

impl Temporary {
    /// A unique name beside `path`, short enough for any file system. Nothing is created.
    pub fn beside(path: &Path) -> Self {
        static MADE: AtomicU64 = AtomicU64::new(0);
        let name = name(Identity::own(), MADE.fetch_add(1, Ordering::Relaxed));
        let path = disk::folder_of(path).join(name);
        unfinished().push(path.clone());
        Temporary(path)
    }

    /// Where to create the file.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Moves the finished file into place, atomically.
    ///
    /// # Errors
    /// If it cannot be renamed; it is removed then.
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

/// Shows processes that cannot see this one that the file or folder is being written, for as long as `file` is open.
/// Where there are no locks, they have to go by its age.
pub fn hold(file: &File) {
    let _ = file.try_lock();
}

fn name(of: &Identity, number: u64) -> String {
    let Identity { host, boot, namespace, pid, start } = of;
    format!("{PREFIX}{host}-{boot}-{namespace}-{pid}-{start}-{number}{SUFFIX}")
}

/// The process in a name; `None` if it is not such a name.
fn maker(name: &str) -> Option<Identity> {
    let middle = name.strip_prefix(PREFIX)?.strip_suffix(SUFFIX)?;
    let parts: Vec<&str> = middle.rsplitn(6, '-').collect();
    let [number, start, pid, namespace, boot, host] = parts[..] else { return None };
    number.parse::<u64>().ok()?;
    let (host, boot) = (host.to_owned(), boot.to_owned());
    Some(Identity {
        host,
        boot,
        namespace: namespace.parse().ok()?,
        pid: pid.parse().ok()?,
        start: start.parse().ok()?,
    })
}

fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes this process's unfinished files; for a process that must end at once.
pub fn remove_unfinished() {
    unfinished().drain(..).for_each(|path| {
        remove(&path);
    });
}

/// Removes unfinished files and folders that killed processes left in `folder`; returns how many there were.
pub fn remove_stale(folder: &Path) -> usize {
    let Ok(entries) = std::fs::read_dir(folder) else { return 0 };
    let stale = entries.flatten().filter(|entry| {
        let maker = entry.file_name().to_str().and_then(maker);
        maker.is_some_and(|maker| is_stale(&entry.path(), &maker))
    });
    stale.filter(|entry| remove(&entry.path())).count()
}

fn is_stale(path: &Path, maker: &Identity) -> bool {
    if let Some(runs) = maker.runs() {
        return !runs;
    }
    let Ok(touched) = path.symlink_metadata().and_then(|found| found.modified()) else { return false };
    let idle = SystemTime::now().duration_since(touched).unwrap_or_default();
    if maker.same_boot() {
        // In another container on this machine: its lock can be seen from here, once it has had time to take it.
        return idle > LOCKED_WITHIN && File::open(path).is_ok_and(|file| file.try_lock().is_ok());
    }
    let before_boot = maker.host == Identity::own().host && process::boot_time().is_some_and(|boot| touched < boot);
    before_boot || idle > FORGOTTEN
}

/// Removes a file or a folder, and says whether it did: its process may have moved it into place and ended meanwhile.
/// What cannot be removed now will be removed as stale later.
fn remove(path: &Path) -> bool {
    match path.symlink_metadata() {
        Ok(found) if found.is_dir() => std::fs::remove_dir_all(path).is_ok(),
        Ok(_) => disk::remove(path).is_ok(),
        Err(_) => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Another machine's boot.
    const FAR: &str = "0123456789abcdef0123456789abcdef";

    #[test]
    fn names_say_who_makes_them() {
        let own = Identity::own();
        let dashed = Identity { host: "a-b-c".into(), ..own.clone() };
        for who in [own, &dashed] {
            assert_eq!(maker(&name(who, 7)).as_ref(), Some(who));
        }
        for other in ["cat.png", ".plica-x.tmp", ".plica-12-0.tmp", ".plica-a-b-c-d-e-f.tmp", ".plica-.tmp"] {
            assert_eq!(maker(other), None, "{other}");
        }
        assert!(name(&Identity { host: "h".repeat(40), ..own.clone() }, u64::MAX).len() < 200);
    }

    #[test]
    fn only_what_the_dead_left_is_cleared() {
        let mut child = std::process::Command::new("true").spawn().unwrap();
        let (own, pid) = (Identity::own(), child.id());
        child.wait().unwrap();
        let minutes = |n: u64| Duration::from_secs(60 * n);
        let dead = Identity { pid, ..own.clone() };
        let reused = Identity { start: own.start + 1, ..own.clone() };
        let container = Identity { namespace: 1, pid: 1, ..own.clone() };
        let rebooted = Identity { boot: FAR.into(), ..own.clone() };
        let far = Identity { host: "far".into(), ..rebooted.clone() };
        let since_boot = process::boot_time().and_then(|boot| SystemTime::now().duration_since(boot).ok());
        // Owner, age, whether it is locked, whether it is removed.
        let mut cases = vec![
            (own, minutes(9999), false, false),
            (&dead, minutes(0), false, true),
            (&reused, minutes(0), false, cfg!(target_os = "linux")),
            (&container, minutes(0), false, false),
            (&container, minutes(2), true, false),
            (&container, minutes(2), false, cfg!(target_os = "linux")),
            (&rebooted, minutes(0), false, false),
            (&far, minutes(60), false, false),
            (&far, minutes(25 * 60), false, true),
        ];
        cases.extend(since_boot.map(|since| (&rebooted, since + minutes(1), false, true)));
        for (number, (who, idle, locked, goes)) in cases.into_iter().enumerate() {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join(name(who, number as u64));
            let file = File::create(&path).unwrap();
            file.set_modified(SystemTime::now() - idle).unwrap();
            if locked {
                hold(&file);
            } else {
                drop(file);
            }
            assert_eq!(remove_stale(folder.path()), usize::from(goes), "{who:?}, idle for {idle:?}, locked {locked}");
            assert_eq!(path.exists(), !goes);
        }
    }

    #[test]
    fn what_is_in_its_place_meanwhile_is_not_counted() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("half");
        File::create(&path).unwrap();
        assert!(remove(&path));
        assert!(!remove(&path));
    }

    #[test]
    fn folders_are_cleared_and_locked_as_files_are() {
        let outer = tempfile::tempdir().unwrap();
        let container = Identity { namespace: 1, pid: 1, ..Identity::own().clone() };
        let folder = outer.path().join(name(&container, 0));
        std::fs::create_dir(&folder).unwrap();
        std::fs::write(folder.join("half.png"), "half").unwrap();
        let held = File::open(&folder).unwrap();
        hold(&held);
        held.set_modified(SystemTime::now() - Duration::from_secs(600)).unwrap();
        assert_eq!(remove_stale(outer.path()), 0);
        drop(held);
        if cfg!(target_os = "linux") {
            assert_eq!(remove_stale(outer.path()), 1);
            assert!(!folder.exists());
        }
    }
}
