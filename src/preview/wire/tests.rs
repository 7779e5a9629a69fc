//! The protocol without a window: every message there and back, and what is wrong refused with a reason.

use std::fmt::Debug;
use std::io::{self, Read};

use proptest::prelude::*;
use serde_json::json;

use super::frame::{self, *};
use super::message::*;
use crate::base::error::Result;
use crate::base::problem::Problem;
use crate::files::Limits;
use crate::files::originals::{Contents, Original};
use crate::preview::Transport;
use crate::scene::edit::Edit;

const MAX: u32 = 64 << 20;

fn read<T: Message>(from: &mut impl Read) -> Result<Option<T>> {
    frame::read(from, Limits::default().message)
}

fn bytes(message: &impl Message) -> Vec<u8> {
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
        FromEditor::Cursor(Some((12.5, 0.25))),
        FromEditor::Cursor(None),
        FromEditor::Transport(Transport { playing: true, time: 1.25, speed: 0.5 }),
        FromEditor::View("view-field".into()),
        FromEditor::Views(vec!["view-field".into(), "zoom-in".into()]),
        FromEditor::Images(vec![
            Original { path: "é.png".into(), file: Ok(Contents { hash: "00ff".into(), bytes: u64::MAX }) },
            Original { path: "x".into(), file: Err("no such file".into()) },
        ]),
        FromEditor::Piece { hash: "00ff".into(), offset: 8192, bytes: b"\n{\0\xff".to_vec() },
        FromEditor::Piece { hash: "00ff".into(), offset: 0, bytes: Vec::new() },
        FromEditor::Notice(text.clone()),
        FromEditor::Problems(vec![Problem::error("/a", "no"), Problem::warning("", "hm").hint("so")]),
        FromEditor::Alive,
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
        Gesture::Pointer { x: -1.5, y: 2.0 }.into(),
        Gesture::Command(text).into(),
        ToEditor::Want { hash: "00ff".into(), offset: 1 << 40 },
        ToEditor::Answer(3),
        ToEditor::Alive,
        ToEditor::Edit { revision: 1, patch: patch() },
    ];
    come_back(&from_editor);
    come_back(&to_editor);
}

fn come_back<T: Message + PartialEq + Debug>(messages: &[T]) {
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
    let with_bytes = |body: &[u8]| [&header(KIND_BYTES, body.len() as u32)[..], body].concat();
    let table: [(&str, Vec<u8>, &str); 12] = [
        ("garbage", b"GET / HTTP/1.1\r\n\r\n".to_vec(), "not plica"),
        ("a short piece of garbage", b"hi".to_vec(), "not plica"),
        ("an older version", changed(4, &[0, 0]), "speaks version 0"),
        ("a newer version", changed(4, &[3, 0]), "use the same plica"),
        ("newer scenes", changed(4, &[2, 1]), "has scenes of version 2, this one of version 1"),
        ("an unknown kind", changed(6, &[9, 0]), "unknown kind 9"),
        ("a huge length", changed(8, &[0xff; 4]), "4294967295 bytes"),
        ("one byte too many", changed(8, &(MAX + 1).to_le_bytes()), "67108864 is the most"),
        ("unknown JSON", [&header(KIND_JSON, 7)[..], br#"{"a":1}"#].concat(), "unknown variant"),
        ("bytes after a message that has none", with_bytes(b"\"want_scene\"\nx"), "does not fit"),
        ("JSON without its end", with_bytes(b"\"want_scene\""), "has no end"),
        ("broken JSON", [&header(KIND_JSON, 3)[..], b"\"wa"].concat(), "cannot be understood"),
    ];
    for (name, bytes, reason) in table {
        let error = read::<ToEditor>(&mut bytes.as_slice()).expect_err(name).to_string();
        assert!(error.starts_with("link: ") && error.contains(reason), "{name}: {error}");
    }
}

#[test]
fn a_message_cut_anywhere_is_an_error_and_never_a_message() {
    let whole = bytes(&ToEditor::from(Gesture::Pointer { x: 1.0, y: 2.0 }));
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
    let bytes = header(KIND_JSON, MAX);
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
        let mut bytes = header(kind, len).to_vec();
        bytes[4..6].copy_from_slice(&version.to_le_bytes());
        bytes[6..8].copy_from_slice(&kind.to_le_bytes());
        bytes.extend(body.as_bytes());
        let answer = read::<ToEditor>(&mut bytes.as_slice());
        prop_assert!(answer.is_err() || len as usize <= body.len());
    }
}

/// What an edit costs on the wire: the goal is 1 kB.
#[test]
fn an_edit_costs_less_than_a_kilobyte() {
    let number = |path: &str| serde_json::json!([{"op": "replace", "path": path, "value": 59.123456789012345}]);
    let patch = serde_json::from_value(number("/layers/10/zones/100/interpolation/radius")).unwrap();
    let length = bytes(&FromEditor::Patch { from_revision: 1 << 40, to_revision: u64::MAX, patch }).len();
    assert!(length < 300, "{length} bytes");
}
