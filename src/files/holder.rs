//! Who edits a scene: a small file beside it for others to read. The lock itself is on the journal and ends with its
//! process, on every machine that shares the lock; this file only says who holds it, and replaces it where the lock
//! cannot be seen: with another user's journal, or in a folder that machines share without sharing locks.

use std::fmt;
use std::fs::OpenOptions;
use std::io::{Read, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{beside, disk, journal};
use crate::base::system;
use crate::base::text::ago;

/// A longer file, in bytes, is not one of ours.
const MOST_BYTES: u64 = 4096;

/// A process that edits a scene.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Holder {
    /// Its process number on its machine.
    pub pid: u32,
    /// The user who runs it; empty if not known.
    pub user: String,
    /// The machine; empty if not known.
    pub host: String,
    /// Since when, in milliseconds since the epoch; 0 if not known.
    pub since_ms: u64,
    /// Whether it is known to be alive, because it holds the lock.
    #[serde(skip)]
    pub certain: bool,
}

/// `ann on box (process 123, opened 12 min ago)`.
impl fmt::Display for Holder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.user.as_str(), self.host.as_str()) {
            ("", _) if self.pid == 0 => return write!(f, "another process"),
            ("", _) => return write!(f, "process {}", self.pid),
            (user, "") => write!(f, "{user}")?,
            (user, host) => write!(f, "{user} on {host}")?,
        }
        write!(f, " (process {}", self.pid)?;
        match self.since_ms {
            0 => write!(f, ")"),
            since => write!(f, ", opened {})", ago(super::now_ms().saturating_sub(since))),
        }
    }
}

impl Holder {
    /// The message to others who open the scene.
    pub fn in_words(&self) -> String {
        if self.certain {
            format!("is being edited by {self}")
        } else {
            format!("may be edited by {self}, whose lock cannot be seen from here")
        }
    }

    /// Whether it is known to have been editing for more than `ms` milliseconds.
    pub fn has_been_there(&self, ms: u64) -> bool {
        self.since_ms > 0 && super::now_ms().saturating_sub(self.since_ms) > ms
    }

    fn of_this_process() -> Holder {
        let (user, host) = (system::user_name(), system::host_name());
        Holder { pid: std::process::id(), user, host, since_ms: super::now_ms(), certain: true }
    }

    /// Who holds the lock of `scene`: what the file says, if it is about process `pid`.
    pub fn of_lock(scene: &Path, pid: Option<u32>) -> Holder {
        let nobody =
            Holder { pid: pid.unwrap_or(0), user: String::new(), host: String::new(), since_ms: 0, certain: true };
        let told = read(scene).filter(|told| pid.is_none_or(|pid| pid == told.pid));
        told.map_or(nobody, |told| Holder { certain: true, ..told })
    }

    /// Who may be editing `scene` although its journal at `journal` could be locked: somebody on another machine, if
    /// the folder may be shared without locks, or another user, whose journal is elsewhere.
    pub fn unseen(scene: &Path, journal: &Path) -> Option<Holder> {
        let told = read(scene)?;
        let here = told.host == system::host_name();
        let elsewhere = journal != journal::path_beside(scene);
        let lives =
            if here { elsewhere && system::process_lives(told.pid) } else { system::is_shared(disk::folder_of(scene)) };
        (lives && !(here && told.pid == std::process::id())).then_some(told)
    }
}

/// The path of the file.
pub fn path_beside(scene: &Path) -> PathBuf {
    beside::path(scene, "editor")
}

fn read(scene: &Path) -> Option<Holder> {
    let mut bytes = Vec::new();
    let flags = system::no_follow() | system::no_wait();
    let file = OpenOptions::new().read(true).custom_flags(flags).open(path_beside(scene)).ok()?;
    disk::regular(file).ok()?.take(MOST_BYTES).read_to_end(&mut bytes).ok()?;
    serde_json::from_slice(&bytes).ok()
}

/// The file that this process wrote; dropping it removes the file.
#[derive(Debug)]
pub struct Sign(PathBuf);

impl Sign {
    /// Tells others who edits `scene`; to be called only with its lock. `None` if the file cannot be written: others
    /// then see less.
    pub fn put_up(scene: &Path) -> Option<Sign> {
        let path = path_beside(scene);
        // A killed editor may have left one behind; it may belong to another user.
        let _ = std::fs::remove_file(&path);
        let text = serde_json::to_vec(&Holder::of_this_process()).ok()?;
        let file = OpenOptions::new().write(true).create_new(true).custom_flags(system::no_follow()).open(&path);
        file.and_then(|mut file| file.write_all(&text)).ok()?;
        Some(Sign(path))
    }
}

impl Drop for Sign {
    fn drop(&mut self) {
        // A file that stays does no harm: the lock is what counts.
        let _ = std::fs::remove_file(&self.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sign_tells_who_and_goes_with_its_editor() {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("cat.plica.json");
        assert_eq!(read(&scene), None);
        let sign = Sign::put_up(&scene).unwrap();
        let told = Holder::of_lock(&scene, Some(std::process::id()));
        assert_eq!((told.pid, told.host.as_str()), (std::process::id(), system::host_name().as_str()));
        assert!(told.to_string().ends_with(", opened just now)"), "{told}");
        assert_eq!(Holder::of_lock(&scene, Some(1)).to_string(), "process 1");
        drop(sign);
        assert_eq!(read(&scene), None);
    }

    #[test]
    fn a_sign_without_a_lock_counts_only_where_a_lock_could_not_be_seen() {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("cat.plica.json");
        let (beside, elsewhere) = (journal::path_beside(&scene), folder.path().join("state"));
        let (here, dead) = (system::host_name(), u32::MAX);
        for (pid, host, journal, counts) in [
            (1, here.as_str(), &beside, false),
            (1, here.as_str(), &elsewhere, true),
            (dead, here.as_str(), &elsewhere, false),
            (std::process::id(), here.as_str(), &elsewhere, false),
            // The folder of this test is not on a network.
            (1, "far", &beside, false),
        ] {
            let told = Holder { pid, user: "ann".into(), host: host.into(), since_ms: 1, certain: false };
            std::fs::write(path_beside(&scene), serde_json::to_string(&told).unwrap()).unwrap();
            assert_eq!(Holder::unseen(&scene, journal), counts.then_some(told), "{pid} {host}");
        }
        std::fs::write(path_beside(&scene), "no JSON").unwrap();
        assert_eq!(Holder::unseen(&scene, &elsewhere), None);
    }
}
