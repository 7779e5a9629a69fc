//! The sockets between editor and windows: one for each scene, in a folder that nobody else can enter, named by a hash of the
//! scene's canonical path.

use std::fs::{self, File, Permissions};
use std::io;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{OpenOptionsExt, PermissionsExt};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};

use crate::base::error::{Error, Result};
use crate::base::system;
use crate::files::hash;

/// The path of a scene's socket.
pub fn socket_path(scene: &Path) -> Result<PathBuf> {
    let folder = system::folders::runtime();
    let folder = folder.map_err(|e| Error::at("folder for sockets", e).cure("set XDG_RUNTIME_DIR to one of yours"))?;
    Ok(folder.join(socket_name(&canonical(scene)?)))
}

/// The canonical path, also of a scene that is not written yet.
fn canonical(scene: &Path) -> Result<PathBuf> {
    let folder = scene.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let path = scene.canonicalize().or_else(|_| Ok(folder.canonicalize()?.join(scene.file_name().unwrap_or_default())));
    path.map_err(|e: io::Error| Error::at(scene.display(), e))
}

fn socket_name(canonical: &Path) -> String {
    format!("{}.sock", &hash::of(canonical.as_os_str().as_bytes())[..16])
}

/// The editor's end: takes connections.
#[derive(Debug)]
pub struct Listener(UnixListener);

/// Keeps the socket of a [`Listener`] in its folder. Dropping it removes the socket and wakes the listener.
#[derive(Debug)]
pub struct Door {
    path: PathBuf,
    /// An editor died and left its socket behind; its windows may still be there and come back.
    pub orphans: bool,
}

impl Listener {
    /// Listens for windows of `scene`. Fails if another editor already does.
    pub fn open(scene: &Path) -> Result<(Listener, Door)> {
        let path = socket_path(scene)?;
        let place = |e| Error::at(path.display(), e);
        // Two editors that start at once must not mistake each other's new socket for a stale one.
        let _turn = turn(&path.with_file_name("lock")).map_err(place)?;
        let orphans = remove_stale(&path)?;
        let socket = UnixListener::bind(&path).map_err(place)?;
        fs::set_permissions(&path, Permissions::from_mode(0o600)).map_err(place)?;
        Ok((Listener(socket), Door { path, orphans }))
    }

    /// Waits for the next connection.
    pub fn accept(&self) -> io::Result<Caller> {
        self.0.accept().map(|(stream, _)| Caller(stream))
    }
}

impl Drop for Door {
    fn drop(&mut self) {
        // The listener or the file may be gone already.
        drop(UnixStream::connect(&self.path));
        drop(fs::remove_file(&self.path));
    }
}

/// Waits for the lock between starting editors; dropping the file releases it.
fn turn(path: &Path) -> io::Result<File> {
    let file = File::options()
        .write(true)
        .create(true)
        .truncate(false)
        .mode(0o600)
        .custom_flags(system::no_wait())
        .open(path)?;
    file.lock()?;
    Ok(file)
}

/// Removes a socket that does not answer; returns whether there was one.
fn remove_stale(path: &Path) -> Result<bool> {
    match UnixStream::connect(path) {
        Ok(_) => Err(Error::at("link", "another editor has this scene open").cure("edit there, or close it")),
        Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(e) if e.kind() == io::ErrorKind::ConnectionRefused => {
            fs::remove_file(path).map_err(|e| Error::at(path.display(), e))?;
            Ok(true)
        }
        Err(e) => Err(Error::at(path.display(), e)),
    }
}

/// A connection before its handshake.
pub struct Caller(pub(super) UnixStream);
