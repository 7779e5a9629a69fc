//! Messages as bytes: a header of fixed size, then JSON, and for a piece of a file a line end and its bytes. The header carries
//! magic, version, kind and length, and is checked before a byte of the rest is read or memory is taken for it. Runs over any
//! pair of `Read` and `Write`: a socket here, the pipes of an ssh elsewhere.

use std::io::{self, Read, Write};

use super::message::Message;
use crate::base::error::{Error, Result};
use crate::files::Limits;
use crate::scene::{self, json};

/// Version of the protocol.
const PROTOCOL: u8 = 2;
/// What must be equal at both ends: the version of the protocol, and in the upper byte how much newer than the first the format
/// of scenes is, since documents and patches go over the link as they are.
pub const VERSION: u16 = u16::from_le_bytes([PROTOCOL, scene::VERSION as u8 - 1]);

const MAGIC: [u8; 4] = *b"PLCA";
const HEADER: usize = 12;
/// The most bytes of memory that a message may take once it is read.
const MOST_MEMORY: u64 = 1 << 30;
pub(super) const KIND_JSON: u16 = 1;
/// JSON, a line end, and bytes that belong to it.
pub(super) const KIND_BYTES: u16 = 2;
pub(super) const STEP: usize = 64 << 10;

/// The error if something else speaks, as a shell's start-up files may.
pub const NOT_PLICA: &str = "the other end is not plica";

/// The most bytes that an editor and a script accept in one message.
pub fn most() -> u64 {
    Limits::default().message
}

/// Writes one message, in one go. Its length is limited by the reader alone.
///
/// # Errors
/// The other end is gone.
pub fn write(to: &mut impl Write, message: &impl Message) -> Result<()> {
    let mut whole = vec![0; HEADER];
    serde_json::to_writer(&mut whole, message).map_err(|e| Error::at("link", e))?;
    let kind = if let Some(bytes) = message.bytes() {
        whole.push(b'\n');
        whole.extend_from_slice(bytes);
        KIND_BYTES
    } else {
        KIND_JSON
    };
    let length = whole.len() - HEADER;
    let length = u32::try_from(length).map_err(|_| too_long(length as u64, u32::MAX.into()))?;
    whole[..HEADER].copy_from_slice(&header(kind, length));
    to.write_all(&whole).and_then(|()| to.flush()).map_err(|e| broken(&e))
}

/// Reads one message of at most `most` bytes ([`Limits::message`](crate::files::Limits::message)); `None` if the
/// other end left between messages.
pub fn read<T: Message>(from: &mut impl Read, most: u64) -> Result<Option<T>> {
    let Some((kind, length)) = read_header(from, most)? else { return Ok(None) };
    let mut body = read_body(from, length as usize)?;
    // JSON on one line has no line end in it.
    let json = if kind == KIND_BYTES { body.iter().position(|&byte| byte == b'\n') } else { Some(body.len()) };
    let json = json.ok_or_else(|| not_understood("it has no end"))?;
    if json::bytes_of_text(&body[..json]) > MOST_MEMORY {
        return Err(not_understood("it would take too much memory"));
    }
    let mut message: T = serde_json::from_slice(&body[..json]).map_err(not_understood)?;
    match (message.bytes_mut(), kind) {
        (Some(bytes), KIND_BYTES) => {
            body.drain(..=json);
            *bytes = body;
        }
        (None, KIND_JSON) => {}
        _ => return Err(not_understood("its kind does not fit")),
    }
    Ok(Some(message))
}

pub(super) fn header(kind: u16, length: u32) -> [u8; HEADER] {
    let mut header = [0; HEADER];
    header[..4].copy_from_slice(&MAGIC);
    header[4..6].copy_from_slice(&VERSION.to_le_bytes());
    header[6..8].copy_from_slice(&kind.to_le_bytes());
    header[8..].copy_from_slice(&length.to_le_bytes());
    header
}

/// The kind and the checked length of the message that follows.
fn read_header(from: &mut impl Read, most: u64) -> Result<Option<(u16, u32)>> {
    let mut header = [0; HEADER];
    let got = fill(from, &mut header)?;
    if got == 0 {
        return Ok(None);
    }
    if !header[..got.min(4)].eq(&MAGIC[..got.min(4)]) {
        return Err(Error::at("link", NOT_PLICA));
    }
    if got < HEADER {
        return Err(cut());
    }
    let [_, _, _, _, v0, v1, k0, k1, l0, l1, l2, l3] = header;
    let (version, kind) = (u16::from_le_bytes([v0, v1]), u16::from_le_bytes([k0, k1]));
    let length = u32::from_le_bytes([l0, l1, l2, l3]);
    if version != VERSION {
        let (ours, theirs) = (VERSION.to_le_bytes(), version.to_le_bytes());
        let what = if ours[1] == theirs[1] {
            format!("the other end speaks version {} of the protocol, this one version {}", theirs[0], ours[0])
        } else {
            let theirs = u32::from(theirs[1]) + 1;
            format!("the other end has scenes of version {theirs}, this one of version {}", scene::VERSION)
        };
        return Err(Error::at("link", what).cure("use the same plica at both ends"));
    }
    if ![KIND_JSON, KIND_BYTES].contains(&kind) {
        return Err(Error::at("link", format!("a message of unknown kind {kind}")));
    }
    if u64::from(length) > most { Err(too_long(length.into(), most)) } else { Ok(Some((kind, length))) }
}

/// Reads in steps, so that memory is taken for what arrived, never for what was announced.
fn read_body(from: &mut impl Read, len: usize) -> Result<Vec<u8>> {
    let mut body = Vec::new();
    while body.len() < len {
        let start = body.len();
        body.resize(len.min(start + STEP), 0);
        if fill(from, &mut body[start..])? < body.len() - start {
            return Err(cut());
        }
    }
    Ok(body)
}

/// Reads until `buffer` is full or the other end closes; returns how much came.
fn fill(from: &mut impl Read, buffer: &mut [u8]) -> Result<usize> {
    let mut got = 0;
    while got < buffer.len() {
        match from.read(&mut buffer[got..]) {
            Ok(0) => break,
            Ok(n) => got += n,
            Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
            Err(e) => return Err(broken(&e)),
        }
    }
    Ok(got)
}

fn not_understood(why: impl std::fmt::Display) -> Error {
    Error::at("link", format!("a message that cannot be understood: {why}"))
}

fn cut() -> Error {
    Error::at("link", "the other end went away in the middle of a message")
}

fn broken(error: &io::Error) -> Error {
    match error.kind() {
        io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut => Error::at("link", "the other end does not answer"),
        _ => Error::at("link", error),
    }
}

fn too_long(len: u64, most: u64) -> Error {
    Error::at("link", format!("a message of {len} bytes, {most} is the most")).cure("give --limit message=BYTES")
}
