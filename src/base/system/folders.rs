//! The user's folders for settings, state, caches and sockets (XDG base directories, with their defaults).

use std::io;
use std::path::{Path, PathBuf};

use rustix::fs::{FileType, Mode};
use rustix::io::Errno;

/// Settings: `$XDG_CONFIG_HOME/plica`, else `~/.config/plica`. `None` without a home.
pub fn config() -> Option<PathBuf> {
    home_folder("XDG_CONFIG_HOME", ".config")
}

/// What is kept between runs, logs and stray journals: `$XDG_STATE_HOME/plica`, else `~/.local/state/plica`.
pub fn state() -> Option<PathBuf> {
    home_folder("XDG_STATE_HOME", ".local/state")
}

/// What can be made again: `$XDG_CACHE_HOME/plica`, else `~/.cache/plica`.
pub fn cache() -> Option<PathBuf> {
    home_folder("XDG_CACHE_HOME", ".cache")
}

/// Sockets: `$XDG_RUNTIME_DIR/plica`, else `plica-UID` under the folder for temporary files. It is made with mode 0700
/// where missing, and refused where it is not a folder of our own that nobody else can enter.
pub fn runtime() -> io::Result<PathBuf> {
    let folder = match absolute("XDG_RUNTIME_DIR").filter(|folder| folder.is_dir()) {
        Some(folder) => folder.join("plica"),
        None => std::env::temp_dir().join(format!("plica-{}", super::user())),
    };
    private_folder(&folder)?;
    Ok(folder)
}

/// Makes `folder` with mode 0700, or checks the one that is there: a real folder, ours, closed to others.
pub fn private_folder(folder: &Path) -> io::Result<()> {
    match rustix::fs::mkdir(folder, Mode::RWXU) {
        Err(error) if error != Errno::EXIST => return Err(error.into()),
        _ => {}
    }
    let found = rustix::fs::lstat(folder)?;
    let is_folder = FileType::from_raw_mode(found.st_mode) == FileType::Directory;
    if is_folder && found.st_uid == super::user() && found.st_mode & 0o077 == 0 {
        return Ok(());
    }
    Err(io::Error::new(io::ErrorKind::PermissionDenied, "is not a folder of yours with mode 0700"))
}

fn home_folder(variable: &str, below_home: &str) -> Option<PathBuf> {
    let base = absolute(variable).or_else(|| Some(absolute("HOME")?.join(below_home)))?;
    Some(base.join("plica"))
}

/// A variable that holds an absolute path; others are to be ignored, says the standard.
fn absolute(variable: &str) -> Option<PathBuf> {
    std::env::var_os(variable).map(PathBuf::from).filter(|path| path.is_absolute())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};

    #[test]
    fn only_a_closed_folder_of_ours_is_private() {
        let outer = tempfile::tempdir().unwrap();
        let folder = outer.path().join("plica");
        private_folder(&folder).unwrap();
        assert_eq!(std::fs::metadata(&folder).unwrap().mode() & 0o777, 0o700);
        private_folder(&folder).unwrap();
        symlink(&folder, outer.path().join("link")).unwrap();
        std::fs::write(outer.path().join("file"), "").unwrap();
        for name in ["link", "file", "missing/below"] {
            assert!(private_folder(&outer.path().join(name)).is_err(), "{name}");
        }
        std::fs::set_permissions(&folder, std::fs::Permissions::from_mode(0o755)).unwrap();
        assert!(private_folder(&folder).is_err());
    }
}
