//! The handshake: who is at the other end is checked before a word is said, and both hellos must come within 2 seconds.

use std::io::{self, Read, Write};
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::time::{Duration, Instant};

use super::connection::Wire;
use super::frame::{self, most};
use super::message::{FromEditor, Role, ToEditor};
use super::socket::{Caller, socket_path};
use crate::base::error::{Error, Result};
use crate::base::system;

/// How long the other end may take to say who it is.
pub const HANDSHAKE: Duration = Duration::from_secs(2);

/// The error if the other end leaves without an answer.
pub const LEFT: &str = "the editor left at once";

impl Caller {
    /// The editor's part of the handshake: finds out in time who connects. The answer, a [`FromEditor::Hello`], is still to be
    /// sent.
    pub fn greet(self) -> Result<(Role, Wire)> {
        check_peer(&self.0)?;
        let hello = frame::read(&mut Timed { stream: &self.0, until: Instant::now() + HANDSHAKE }, most());
        let reason = match hello {
            Ok(Some(ToEditor::Hello { role, .. })) => {
                return Ok((role, Wire::socket(self.0).map_err(|e| Error::at("link", e))?));
            }
            Ok(Some(_)) => Error::at("link", "the other end did not say hello"),
            Ok(None) => return Err(Error::at("link", "the other end left at once")),
            Err(error) => error,
        };
        drop(self.0.set_write_timeout(Some(HANDSHAKE)));
        // A courtesy: an end that does not understand it is refused all the same.
        drop(frame::write(&mut &self.0, &FromEditor::Bye(reason.to_string())));
        Err(reason)
    }
}

/// The other part: joins the editor that has `scene` open and returns its hello, of at most `most` bytes. `None` if no editor
/// has it open, or if there is no folder for sockets.
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

/// Says hello and returns the answer, a [`FromEditor::Hello`] of at most `most` bytes. If hello cannot be written, what the
/// other end said before it left is a better error than the broken pipe.
pub fn shake_hands(to: &mut impl Write, from: &mut impl Read, role: Role, most: u64) -> Result<FromEditor> {
    let written = frame::write(to, &ToEditor::Hello { program: env!("CARGO_PKG_VERSION").into(), role });
    let answer = frame::read(from, most)?;
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
        Err(e) => Err(Error::at("link", format!("cannot determine which user is at the other end: {e}"))),
    }
}

/// Reads with one deadline for all of them, so that a peer cannot stretch them byte by byte.
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
