//! The protocol between editor and window: a header of fixed size, then JSON, and for a piece of a file a line end and its
//! bytes. The header carries magic, version, kind and length, and is checked before a byte of the rest is read or a byte of
//! memory taken for it. It runs over any pair of `Read` and `Write`: a socket here, the pipes of an ssh elsewhere.

use std::io::{self, Read, Write};

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::Value;

use crate::base::error::{Error, Result};
use crate::base::problem::Problem;
use crate::files::originals::Original;
use crate::preview::Transport;
use crate::scene::{self, edit::Edit, json};

/// Version of the protocol.
const PROTOCOL: u8 = 2;
/// What both ends must have the same: the protocol, and above it how much newer than the first the format of scenes is, since
/// documents and patches go over the link as they are.
pub const VERSION: u16 = u16::from_le_bytes([PROTOCOL, scene::VERSION as u8 - 1]);

const MAGIC: [u8; 4] = *b"PLCA";
const HEADER: usize = 12;
/// Bytes of memory that a message may take once it is read.
const MOST_MEMORY: u64 = 1 << 30;
pub(super) const KIND_JSON: u16 = 1;
/// JSON, a line end, and bytes that belong to it.
pub(super) const KIND_BYTES: u16 = 2;
pub(super) const STEP: usize = 64 << 10;

/// What is wrong where something else speaks, as a shell's start-up files may.
pub const NOT_PLICA: &str = "the other end is not plica";

/// What the editor says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum FromEditor {
    /// Answers a [`ToEditor::Hello`] with the whole state.
    Hello {
        /// Version of the program, for people.
        program: String,
        /// The scene's path on the editor's machine.
        scene: String,
        /// Revision of `document`.
        revision: u64,
        /// The document.
        document: Value,
    },
    /// The document changed from one revision to another, perhaps over several edits.
    Patch {
        /// The revision that the patch is applied to.
        from_revision: u64,
        /// The revision that comes out.
        to_revision: u64,
        /// The edits, joined.
        patch: Edit,
    },
    /// The whole document, where a patch would be longer or does not fit.
    Scene {
        /// Revision of `document`.
        revision: u64,
        /// The document.
        document: Value,
    },
    /// JSON pointer of what is selected.
    Selection(Option<String>),
    /// Whether the animation runs, and where it is.
    Transport(Transport),
    /// An overlay or zoom command, by name.
    View(String),
    /// The overlay and zoom commands in force, for a window that was not there when they were given.
    Views(Vec<String>),
    /// What the scene names, for a window on another machine, which asks for what it has not got.
    Images(Vec<Original>),
    /// Answers a [`ToEditor::Want`]: the bytes from there on, at most [`PIECE`](crate::files::originals::PIECE).
    Piece {
        /// SHA-256 of the file, in hexadecimal.
        hash: String,
        /// Where the bytes stand in the file.
        offset: u64,
        /// The bytes; `None` if the file is not there any more.
        #[serde(skip)]
        bytes: Vec<u8>,
    },
    /// One line for the person at a window on another machine.
    Notice(String),
    /// All that is wrong with what is followed there.
    Problems(Vec<Problem>),
    /// Nothing happened, and the other end is still there.
    Alive,
    /// Answers a [`ToEditor::Edit`]: no problems means done.
    Edited(Vec<Problem>),
    /// The editor leaves, or will not talk to this peer; the reason, for people.
    Bye(String),
}

/// Who joins an editor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// A window: wants the state and every change of it.
    Window,
    /// A script (`plica set`, `plica get`): wants the state once, may send one edit.
    Script,
}

/// What a window or a script says to the editor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ToEditor {
    /// The first message.
    Hello {
        /// Version of the program, for people.
        program: String,
        /// Window or script.
        role: Role,
    },
    /// The document of this revision is synthesised and shown.
    Ack {
        /// The revision shown.
        revision: u64,
        /// What the synthesis took, in milliseconds.
        synth_ms: f64,
    },
    /// The patch did not fit: send the whole document.
    WantScene,
    /// How the window is doing.
    Report {
        /// Frames a second.
        fps: f64,
        /// Name of the graphics adapter.
        adapter: String,
        /// One line for the editor's status, empty where all is well.
        notice: String,
    },
    /// The pointer, in pixels of the picture.
    Pointer {
        /// From the left edge.
        x: f64,
        /// From the top edge.
        y: f64,
    },
    /// The animation was started or stopped in the window, or moved.
    Transport(Transport),
    /// A request by command name.
    Command(String),
    /// A window on another machine asks for a piece of a file that [`FromEditor::Images`] told of.
    Want {
        /// SHA-256 of the file, in hexadecimal.
        hash: String,
        /// Where the piece begins.
        offset: u64,
    },
    /// Nothing happened, and the window is still there.
    Alive,
    /// A change asked for by a script.
    Edit {
        /// The revision that the patch was made for.
        revision: u64,
        /// The change.
        patch: Edit,
    },
}

/// What goes over the wire: JSON, and bytes where a message has some.
pub trait Message: Serialize + DeserializeOwned {
    /// The bytes that go after its JSON.
    fn bytes(&self) -> Option<&[u8]> {
        None
    }

    /// Where the bytes that came after its JSON go; nowhere in most messages.
    fn bytes_mut(&mut self) -> Option<&mut Vec<u8>> {
        None
    }
}

impl Message for ToEditor {}

impl Message for FromEditor {
    fn bytes(&self) -> Option<&[u8]> {
        if let FromEditor::Piece { bytes, .. } = self { Some(bytes) } else { None }
    }

    fn bytes_mut(&mut self) -> Option<&mut Vec<u8>> {
        if let FromEditor::Piece { bytes, .. } = self { Some(bytes) } else { None }
    }
}

/// Writes one message, in one go. How long it may be is the reader's to say; fails where the other end is gone.
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

/// Reads one message of at most `most` bytes ([`Limits::message`](crate::files::Limits::message)); `None` where the other
/// end left between messages.
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

/// Reads in steps, so that memory is taken for what came and never for what was announced.
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
