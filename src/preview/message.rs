//! The protocol between editor and window: a header of fixed size, then JSON. The header carries magic, version, kind and
//! length, and is checked before a byte of the rest is read or a byte of memory taken for it. It runs over any pair of
//! `Read` and `Write`: a socket here, the pipes of an ssh elsewhere.

use std::io::{self, Read, Write};

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::Value;

use crate::base::error::{Error, Result};
use crate::base::problem::Problem;
use crate::scene::edit::Edit;

/// Version of the protocol; both ends must have the same.
pub const VERSION: u16 = 1;

const MAGIC: [u8; 4] = *b"PLCA";
const HEADER: usize = 12;
/// The only kind so far. Pieces of pictures, for a window on another machine, will be another.
const KIND_JSON: u16 = 1;
const STEP: usize = 64 << 10;

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
    /// Whether the animation runs, and the scene time in seconds.
    Transport {
        /// Runs on from `time`.
        playing: bool,
        /// In seconds.
        time: f64,
    },
    /// An overlay or zoom command, by name.
    View(String),
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
    /// A request by command name.
    Command(String),
    /// A change asked for by a script.
    Edit {
        /// The revision that the patch was made for.
        revision: u64,
        /// The change.
        patch: Edit,
    },
}

/// Writes one message. How long it may be is the reader's to say; fails where the other end is gone.
pub fn write(to: &mut impl Write, message: &impl Serialize) -> Result<()> {
    let body = serde_json::to_vec(message).map_err(|e| Error::at("link", e))?;
    let len = u32::try_from(body.len()).map_err(|_| too_long(body.len() as u64, u32::MAX.into()))?;
    let sent = to.write_all(&header(len)).and_then(|()| to.write_all(&body)).and_then(|()| to.flush());
    sent.map_err(|e| broken(&e))
}

/// Reads one message of at most `most` bytes ([`Limits::message`](crate::files::Limits::message)); `None` where the other
/// end left between messages.
pub fn read<T: DeserializeOwned>(from: &mut impl Read, most: u64) -> Result<Option<T>> {
    let Some(len) = read_header(from, most)? else { return Ok(None) };
    let body = read_body(from, len as usize)?;
    let message = serde_json::from_slice(&body);
    message.map(Some).map_err(|e| Error::at("link", format!("a message that cannot be understood: {e}")))
}

fn header(len: u32) -> [u8; HEADER] {
    let mut header = [0; HEADER];
    header[..4].copy_from_slice(&MAGIC);
    header[4..6].copy_from_slice(&VERSION.to_le_bytes());
    header[6..8].copy_from_slice(&KIND_JSON.to_le_bytes());
    header[8..].copy_from_slice(&len.to_le_bytes());
    header
}

/// The checked length of the message that follows.
fn read_header(from: &mut impl Read, most: u64) -> Result<Option<u32>> {
    let mut header = [0; HEADER];
    let got = fill(from, &mut header)?;
    if got == 0 {
        return Ok(None);
    }
    if !header[..got.min(4)].eq(&MAGIC[..got.min(4)]) {
        return Err(Error::at("link", "the other end is not plica"));
    }
    if got < HEADER {
        return Err(cut());
    }
    let [_, _, _, _, v0, v1, k0, k1, l0, l1, l2, l3] = header;
    let (version, kind) = (u16::from_le_bytes([v0, v1]), u16::from_le_bytes([k0, k1]));
    let len = u32::from_le_bytes([l0, l1, l2, l3]);
    if version != VERSION {
        let what = format!("the other end speaks version {version} of the protocol, this one version {VERSION}");
        return Err(Error::at("link", what).cure("use the same plica at both ends"));
    }
    if kind != KIND_JSON {
        return Err(Error::at("link", format!("a message of unknown kind {kind}")));
    }
    if u64::from(len) > most { Err(too_long(len.into(), most)) } else { Ok(Some(len)) }
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

#[cfg(test)]
mod tests {
    use std::fmt::Debug;

    use proptest::prelude::*;
    use serde_json::json;

    use super::*;
    use crate::files::Limits;

    const MAX: u32 = 64 << 20;

    fn read<T: DeserializeOwned>(from: &mut impl Read) -> Result<Option<T>> {
        super::read(from, Limits::default().message)
    }

    fn bytes(message: &impl Serialize) -> Vec<u8> {
        let mut bytes = Vec::new();
        write(&mut bytes, message).unwrap();
        bytes
    }

    fn patch() -> Edit {
        serde_json::from_value(json!([{"op": "replace", "path": "/layers/0/name", "value": "é\u{1}"}])).unwrap()
    }

    #[test]
    fn every_message_comes_back_as_it_was_sent() {
        let document = json!({"plica": 1, "z": 0.1, "a": [1e-300, -0.0, 0.30000000000000004]});
        let text = String::from("a line");
        let from_editor = [
            FromEditor::Hello { program: text.clone(), scene: "/é/s".into(), revision: 3, document: document.clone() },
            FromEditor::Patch { from_revision: 3, to_revision: u64::MAX, patch: patch() },
            FromEditor::Scene { revision: 0, document },
            FromEditor::Selection(Some("/layers/0".into())),
            FromEditor::Selection(None),
            FromEditor::Transport { playing: true, time: 1.25 },
            FromEditor::View("view-field".into()),
            FromEditor::Edited(vec![Problem::error("/a", "no").hint("so")]),
            FromEditor::Edited(vec![]),
            FromEditor::Bye(text.clone()),
        ];
        let to_editor = [
            ToEditor::Hello { program: text.clone(), role: Role::Window },
            ToEditor::Hello { program: text.clone(), role: Role::Script },
            ToEditor::Ack { revision: 9, synth_ms: 0.1 },
            ToEditor::WantScene,
            ToEditor::Report { fps: 59.94, adapter: "llvmpipe".into(), notice: text.clone() },
            ToEditor::Pointer { x: -1.5, y: 2.0 },
            ToEditor::Command(text),
            ToEditor::Edit { revision: 1, patch: patch() },
        ];
        come_back(&from_editor);
        come_back(&to_editor);
    }

    fn come_back<T: Serialize + DeserializeOwned + PartialEq + Debug>(messages: &[T]) {
        let stream: Vec<u8> = messages.iter().flat_map(bytes).collect();
        let mut from = stream.as_slice();
        for message in messages {
            assert_eq!(read::<T>(&mut from).unwrap().as_ref(), Some(message));
        }
        assert_eq!(read::<T>(&mut from).unwrap(), None);
    }

    #[test]
    fn what_is_wrong_is_refused_with_a_reason() {
        let good = bytes(&ToEditor::WantScene);
        let changed = |at: usize, to: &[u8]| [&good[..at], to, &good[at + to.len()..]].concat();
        let table: [(&str, Vec<u8>, &str); 9] = [
            ("garbage", b"GET / HTTP/1.1\r\n\r\n".to_vec(), "not plica"),
            ("a short piece of garbage", b"hi".to_vec(), "not plica"),
            ("an older version", changed(4, &[0, 0]), "speaks version 0"),
            ("a newer version", changed(4, &[2, 0]), "use the same plica"),
            ("an unknown kind", changed(6, &[9, 0]), "unknown kind 9"),
            ("a huge length", changed(8, &[0xff; 4]), "4294967295 bytes"),
            ("one byte too many", changed(8, &(MAX + 1).to_le_bytes()), "67108864 is the most"),
            ("unknown JSON", [&header(7)[..], br#"{"a":1}"#].concat(), "unknown variant"),
            ("broken JSON", [&header(3)[..], b"\"wa"].concat(), "cannot be understood"),
        ];
        for (name, bytes, reason) in table {
            let error = read::<ToEditor>(&mut bytes.as_slice()).expect_err(name).to_string();
            assert!(error.starts_with("link: ") && error.contains(reason), "{name}: {error}");
        }
    }

    #[test]
    fn a_message_cut_anywhere_is_an_error_and_never_a_message() {
        let whole = bytes(&ToEditor::Pointer { x: 1.0, y: 2.0 });
        for len in 1..whole.len() {
            let error = read::<ToEditor>(&mut &whole[..len]).expect_err("cut").to_string();
            assert!(error.contains("in the middle"), "{len}: {error}");
        }
    }

    #[test]
    fn no_memory_is_taken_for_an_announced_length() {
        struct Watched<'a>(&'a [u8], usize);
        impl Read for Watched<'_> {
            fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
                self.1 = self.1.max(buffer.len());
                self.0.read(buffer)
            }
        }
        let bytes = header(MAX);
        let mut from = Watched(&bytes, 0);
        assert!(read::<ToEditor>(&mut from).is_err());
        assert_eq!(from.1, STEP);
    }

    proptest! {
        #[test]
        fn any_bytes_end_in_an_answer(bytes in proptest::collection::vec(any::<u8>(), 0..64)) {
            drop(read::<ToEditor>(&mut bytes.as_slice()));
        }

        #[test]
        fn any_header_and_body_end_in_an_answer(version in 0..3u16, kind in 0..3u16, len: u32, body in "\\PC{0,40}") {
            let mut bytes = header(len).to_vec();
            bytes[4..6].copy_from_slice(&version.to_le_bytes());
            bytes[6..8].copy_from_slice(&kind.to_le_bytes());
            bytes.extend(body.as_bytes());
            let answer = read::<ToEditor>(&mut bytes.as_slice());
            prop_assert!(answer.is_err() || len as usize <= body.len());
        }
    }
}
