//! The sockets between editor and windows: one a scene, in a folder that nobody else can enter, named by a hash of the
//! scene's canonical path. Who is at the other end is checked before a word is said, and shaking hands has 2 seconds.

use std::fs::{self, File, Permissions};
use std::io::{self, Read, Write};
use std::net::Shutdown;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{OpenOptionsExt, PermissionsExt};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use sha2::{Digest, Sha256};

use super::message::{self, FromEditor, Role, ToEditor};
use crate::base::error::{Error, Result};
use crate::base::system;
use crate::files::Limits;

/// How long the other end may take to say who it is.
pub const HANDSHAKE: Duration = Duration::from_secs(2);

/// On pipes to another machine something is said at least this often,
pub const ALIVE: Duration = Duration::from_secs(5);
/// and an end that heard nothing for this long counts the other as gone.
pub const SILENCE: Duration = Duration::from_secs(20);

/// What is said where the other end goes instead of an answer.
pub const LEFT: &str = "the editor left at once";

/// How long one write may stand still before the other end counts as gone.
const STUCK: Duration = Duration::from_secs(10);

/// What an editor and a script take at most in one message, in bytes.
pub fn most() -> u64 {
    Limits::default().message
}

/// An open connection: two halves that may live on two threads, and a way to end both.
pub struct Wire {
    /// What the other end says.
    pub reader: Box<dyn Read + Send>,
    /// What it is told.
    pub writer: Box<dyn Write + Send>,
    /// Ends both halves from any thread.
    pub hang_up: HangUp,
}

/// Ends a connection from any thread.
#[derive(Clone)]
pub struct HangUp(Arc<dyn Fn() + Send + Sync>);

impl HangUp {
    /// A connection that is ended by `how`, which may be done more than once.
    pub fn new(how: impl Fn() + Send + Sync + 'static) -> HangUp {
        HangUp(Arc::new(how))
    }

    /// Ends it; the halves see the end of the stream.
    pub fn now(&self) {
        (self.0)();
    }
}

impl Wire {
    /// Over a socket, with both time limits set for work after the handshake.
    fn socket(stream: UnixStream) -> io::Result<Wire> {
        stream.set_read_timeout(None)?;
        stream.set_write_timeout(Some(STUCK))?;
        let (reader, writer) = (stream.try_clone()?, stream.try_clone()?);
        // Already ended is as good.
        let hang_up = HangUp::new(move || drop(stream.shutdown(Shutdown::Both)));
        Ok(Wire { reader: Box::new(reader), writer: Box::new(writer), hang_up })
    }

    /// The same, ended once nothing is heard for so long: for pipes to another machine, which may go without a word.
    pub fn watched(self, most: Duration) -> Wire {
        let heard = Arc::new(Mutex::new(Instant::now()));
        let (seen, hang_up) = (Arc::downgrade(&heard), self.hang_up.clone());
        std::thread::spawn(move || {
            while let Some(heard) = seen.upgrade() {
                let silent = heard.lock().unwrap_or_else(PoisonError::into_inner).elapsed();
                if silent >= most {
                    return hang_up.now();
                }
                drop(heard);
                std::thread::sleep((most - silent).min(most / 4));
            }
        });
        Wire { reader: Box::new(Noted { reader: self.reader, heard }), ..self }
    }
}

/// A reader that notes when it last heard something.
struct Noted {
    reader: Box<dyn Read + Send>,
    heard: Arc<Mutex<Instant>>,
}

impl Read for Noted {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.reader.read(buffer);
        *self.heard.lock().unwrap_or_else(PoisonError::into_inner) = Instant::now();
        read
    }
}

/// Where the socket of a scene lies.
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
    let hash = Sha256::digest(canonical.as_os_str().as_bytes());
    hash[..8].iter().map(|byte| format!("{byte:02x}")).chain([".sock".into()]).collect()
}

/// The editor's end: takes connections.
#[derive(Debug)]
pub struct Listener(UnixListener);

/// Keeps the socket of a [`Listener`] where windows find it. Dropping it takes the socket away and wakes who listens.
#[derive(Debug)]
pub struct Door {
    path: PathBuf,
    /// An editor died here before and left its socket; its windows may still be there and come back.
    pub orphans: bool,
}

impl Listener {
    /// Listens for windows of `scene`. Fails where another editor does already.
    pub fn open(scene: &Path) -> Result<(Listener, Door)> {
        let path = socket_path(scene)?;
        let place = |e| Error::at(path.display(), e);
        // Two editors that start at once must not take each other's fresh socket for a stale one.
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
        // Whether anybody hears or the file is still there makes no difference any more.
        drop(UnixStream::connect(&self.path));
        drop(fs::remove_file(&self.path));
    }
}

/// Waits for this process's turn; it ends when the file is dropped.
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

/// Removes a socket at which nobody answers; tells whether there was one.
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

/// Somebody who connected and has not said hello.
pub struct Caller(UnixStream);

impl Caller {
    /// The editor's part of shaking hands: who is it, and in time. The answer, a [`FromEditor::Hello`], is still to be sent.
    pub fn greet(self) -> Result<(Role, Wire)> {
        check_peer(&self.0)?;
        let hello = message::read(&mut Timed { stream: &self.0, until: Instant::now() + HANDSHAKE }, most());
        let reason = match hello {
            Ok(Some(ToEditor::Hello { role, .. })) => {
                return Ok((role, Wire::socket(self.0).map_err(|e| Error::at("link", e))?));
            }
            Ok(Some(_)) => Error::at("link", "the other end did not say hello"),
            Ok(None) => return Err(Error::at("link", "the other end left at once")),
            Err(error) => error,
        };
        drop(self.0.set_write_timeout(Some(HANDSHAKE)));
        // A courtesy: who does not understand it is refused all the same.
        drop(message::write(&mut &self.0, &FromEditor::Bye(reason.to_string())));
        Err(reason)
    }
}

/// The other part: joins the editor that has `scene` open and returns its hello, of `most` bytes. `None` where nobody has,
/// or nobody can have for want of a folder for sockets.
pub fn join(scene: &Path, role: Role, most: u64) -> Result<Option<(FromEditor, Wire)>> {
    let Ok(path) = socket_path(scene) else { return Ok(None) };
    let Ok(stream) = UnixStream::connect(path) else { return Ok(None) };
    check_peer(&stream)?;
    let limits = stream.set_read_timeout(Some(HANDSHAKE)).and_then(|()| stream.set_write_timeout(Some(HANDSHAKE)));
    limits.map_err(|e| Error::at("link", e))?;
    let hello = shake_hands(&mut &stream, &mut &stream, role, most)?;
    let wire = Wire::socket(stream).map_err(|e| Error::at("link", e))?;
    Ok(Some((hello, wire)))
}

/// Says hello and returns the answer, a [`FromEditor::Hello`] of at most `most` bytes. Where hello cannot be written, what
/// the other end has said before it left tells more than the broken pipe does.
pub fn shake_hands(to: &mut impl Write, from: &mut impl Read, role: Role, most: u64) -> Result<FromEditor> {
    let written = message::write(to, &ToEditor::Hello { program: env!("CARGO_PKG_VERSION").into(), role });
    let answer = message::read(from, most)?;
    if answer.is_some() {
        written?;
    }
    match answer {
        Some(hello @ FromEditor::Hello { .. }) => Ok(hello),
        Some(FromEditor::Bye(reason)) => Err(Error::at("editor", reason)),
        Some(_) => Err(Error::at("link", "the editor did not say hello")),
        None => Err(Error::at("link", LEFT)),
    }
}

fn check_peer(stream: &UnixStream) -> Result<()> {
    match system::peer_user(stream) {
        Ok(user) if user == system::user() => Ok(()),
        Ok(user) => Err(Error::at("link", format!("the other end belongs to user {user}"))),
        Err(e) => Err(Error::at("link", format!("cannot tell whose the other end is: {e}"))),
    }
}

/// Reads that all together end by one time, so that a peer cannot stretch them byte by byte.
struct Timed<'a> {
    stream: &'a UnixStream,
    until: Instant,
}

impl Read for Timed<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let left = self.until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(io::ErrorKind::TimedOut.into());
        }
        self.stream.set_read_timeout(Some(left))?;
        self.stream.read(buffer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_silent_end_counts_as_gone_and_a_speaking_one_does_not() {
        let (here, mut there) = UnixStream::pair().unwrap();
        let most = Duration::from_millis(200);
        let Wire { mut reader, .. } = Wire::socket(here).unwrap().watched(most);
        let began = Instant::now();
        let speaking = std::thread::spawn(move || {
            for _ in 0..6 {
                std::thread::sleep(most / 4);
                there.write_all(b"x").unwrap();
            }
            there
        });
        let mut heard = Vec::new();
        // Ends because it was hung up: the other end is still there.
        reader.read_to_end(&mut heard).unwrap();
        assert_eq!(heard.len(), 6);
        assert!(began.elapsed() > most, "{:?}", began.elapsed());
        drop(speaking.join());
    }
}
