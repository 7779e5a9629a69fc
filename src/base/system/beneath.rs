//! Opens a file beneath a folder and nowhere else: one `openat2` where the kernel has it, name by name elsewhere. Both
//! hold the folder open and never go by a path twice, so that nobody can swap a link in between.

use std::collections::VecDeque;
use std::ffi::OsString;
use std::io;
use std::os::fd::OwnedFd;
use std::os::unix::ffi::OsStringExt;
use std::path::{Component, Path};

use rustix::fs::{Mode, OFlags};
use rustix::io::Errno;

/// A FIFO must not make us wait, nor a terminal become ours.
const FILE: OFlags = OFlags::RDONLY.union(OFlags::NONBLOCK).union(OFlags::NOCTTY).union(OFlags::CLOEXEC);
const FOLDER: OFlags = OFlags::RDONLY.union(OFlags::DIRECTORY).union(OFlags::CLOEXEC);
const MOST_LINKS: usize = 40;

/// Opens `path` for reading beneath `folder`. Links are followed as long as they stay beneath it. `CrossesDevices` says
/// that the path leads out: absolute, through `..`, or by a link.
pub fn open(folder: &Path, path: &Path) -> io::Result<OwnedFd> {
    let root = rustix::fs::open(folder, FOLDER, Mode::empty())?;
    match by_kernel(&root, path) {
        Err(Errno::NOSYS | Errno::PERM | Errno::INVAL | Errno::OPNOTSUPP) => by_name(root, path),
        file => Ok(file?),
    }
}

/// Opens `path` for reading wherever it leads; a FIFO does not make us wait.
pub fn open_anywhere(path: &Path) -> io::Result<OwnedFd> {
    Ok(rustix::fs::open(path, FILE, Mode::empty())?)
}

/// Whether something could not be opened because its links form a loop.
pub fn is_loop(error: &io::Error) -> bool {
    Errno::from_io_error(error) == Some(Errno::LOOP)
}

#[cfg(target_os = "linux")]
fn by_kernel(root: &OwnedFd, path: &Path) -> rustix::io::Result<OwnedFd> {
    use rustix::fs::ResolveFlags;
    let resolve = ResolveFlags::BENEATH | ResolveFlags::NO_MAGICLINKS;
    // AGAIN: something was renamed meanwhile and the kernel could not be sure.
    for _ in 0..16 {
        match rustix::fs::openat2(root, path, FILE, Mode::empty(), resolve) {
            Err(Errno::AGAIN) => {}
            file => return file,
        }
    }
    Err(Errno::NOSYS)
}

#[cfg(not(target_os = "linux"))]
fn by_kernel(_: &OwnedFd, _: &Path) -> rustix::io::Result<OwnedFd> {
    Err(Errno::NOSYS)
}

/// Walks the names one at a time. `above` holds the folders passed through, so that `..` steps back and never out.
fn by_name(root: OwnedFd, path: &Path) -> io::Result<OwnedFd> {
    let mut above = vec![root];
    let mut ahead = VecDeque::new();
    let mut links = 0;
    queue(path, &mut ahead)?;
    while let Some(name) = ahead.pop_front() {
        let here = above.last().expect("the root is never popped");
        if name == ".." {
            if above.len() == 1 {
                return Err(leads_out());
            }
            above.pop();
            continue;
        }
        let flags = if ahead.is_empty() { FILE } else { FOLDER };
        match rustix::fs::openat(here, &name, flags | OFlags::NOFOLLOW, Mode::empty()) {
            Ok(file) if ahead.is_empty() => return Ok(file),
            Ok(folder) => above.push(folder),
            // A link, or no folder: the read of the link tells them apart.
            Err(error @ (Errno::LOOP | Errno::MLINK | Errno::NOTDIR)) => {
                let target = rustix::fs::readlinkat(here, &name, Vec::new()).map_err(|_| io::Error::from(error))?;
                links += 1;
                if links > MOST_LINKS {
                    return Err(Errno::LOOP.into());
                }
                queue(Path::new(&OsString::from_vec(target.into_bytes())), &mut ahead)?;
            }
            Err(error) => return Err(error.into()),
        }
    }
    Err(io::ErrorKind::IsADirectory.into())
}

/// Puts the names of `path` before those still ahead.
fn queue(path: &Path, ahead: &mut VecDeque<OsString>) -> io::Result<()> {
    for component in path.components().rev() {
        match component {
            Component::Normal(_) | Component::ParentDir => ahead.push_front(component.as_os_str().to_owned()),
            Component::CurDir => {}
            Component::RootDir | Component::Prefix(_) => return Err(leads_out()),
        }
    }
    Ok(())
}

fn leads_out() -> io::Error {
    Errno::XDEV.into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    type Opener = fn(&Path, &Path) -> io::Result<OwnedFd>;

    fn by_name_alone(folder: &Path, path: &Path) -> io::Result<OwnedFd> {
        by_name(rustix::fs::open(folder, FOLDER, Mode::empty())?, path)
    }

    #[test]
    fn both_ways_agree_on_what_is_beneath() {
        let outer = tempfile::tempdir().unwrap();
        let root = outer.path().join("root");
        std::fs::create_dir_all(root.join("sub/deep")).unwrap();
        std::fs::write(root.join("sub/cat"), "cat").unwrap();
        std::fs::write(outer.path().join("secret"), "secret").unwrap();
        for (link, target) in [
            ("sub/deep/in", "../cat"),
            ("folder", "sub/deep"),
            ("chain", "folder/in"),
            ("out", "../secret"),
            ("sub/deep/out", "../../../secret"),
            ("absolute", "/etc/passwd"),
            ("loop", "loop"),
            ("up", ".."),
        ] {
            symlink(target, root.join(link)).unwrap();
        }
        let ok = |path| (path, None);
        let no = |path, kind| (path, Some(kind));
        let out = io::ErrorKind::CrossesDevices;
        let cases = [
            ok("sub/cat"),
            ok("./sub/./cat"),
            ok("sub/deep/../cat"),
            ok("sub/deep/in"),
            ok("folder/in"),
            ok("chain"),
            no("../secret", out),
            no("sub/../../secret", out),
            no("out", out),
            no("sub/deep/out", out),
            no("absolute", out),
            no("up/secret", out),
            no("/etc/passwd", out),
            no("missing", io::ErrorKind::NotFound),
            no("sub/cat/more", io::ErrorKind::NotADirectory),
        ];
        for opener in [open as Opener, by_name_alone] {
            for (path, refused) in cases {
                assert_eq!(opener(&root, Path::new(path)).err().map(|e| e.kind()), refused, "{path}");
            }
            assert!(opener(&root, Path::new("loop")).is_err_and(|error| is_loop(&error)));
        }
    }
}
