//! The bytes of a journal: 8 bytes magic, version and the writer's process number as u32, then frames of {length u32,
//! crc32c u32 of length and payload, payload}, little-endian. The first frame is the header, the others are records;
//! payloads are JSON. The process number is overwritten by each writer and is not covered by a checksum.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::scene::Edit;

const MAGIC: &[u8; 8] = b"PLICAJNL";
const VERSION: u32 = 1;

/// Where the first frame begins.
const FRAMES: usize = 16;
/// The offset of the process number.
pub(super) const PID_AT: usize = 12;
/// Length and checksum of a frame.
const FRAME_HEAD: usize = 8;

/// The state that a journal starts from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// SHA-256 of the scene file as it was last read or saved before the first record.
    pub file: String,
    /// The document before the first record.
    pub document: Value,
    /// Whether that document was in the file.
    #[serde(default)]
    pub is_file: bool,
}

/// One change of a document, or that it was saved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// The history's revision after this record.
    pub revision: u64,
    /// Milliseconds since the epoch.
    pub time: u64,
    /// Edits with the same step are undone together; numbers are never reused in a journal.
    pub step: u64,
    /// What was done.
    pub kind: Kind,
    /// The change of the document; empty for a save.
    #[serde(default, skip_serializing_if = "Edit::is_empty")]
    pub patch: Edit,
    /// The inverse of `patch`.
    #[serde(default, skip_serializing_if = "Edit::is_empty")]
    pub inverse: Edit,
}

/// What a [`Record`] records.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// An edit.
    Edit,
    /// The last step was undone.
    Undo,
    /// The step that was undone last was redone.
    Redo,
    /// The document was written to its file, whose SHA-256 this is.
    Saved(String),
}

/// What could be read of a journal.
#[derive(Clone, Debug, PartialEq)]
pub struct Contents {
    /// The state that it starts from.
    pub header: Header,
    /// The complete records, each with the offset of its end.
    pub records: Vec<(Record, usize)>,
    /// Where the header ends.
    pub header_end: usize,
}

impl Contents {
    /// Where the longest valid prefix ends.
    pub fn end(&self) -> usize {
        self.records.last().map_or(self.header_end, |(_, end)| *end)
    }
}

/// Why a journal has no contents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unreadable {
    /// Its header is incomplete: nothing was ever acknowledged, or it is no journal.
    Damaged,
    /// A newer program wrote it.
    Newer(u32),
}

/// The longest valid prefix of a journal's bytes.
pub fn read(bytes: &[u8]) -> Result<Contents, Unreadable> {
    if !bytes.starts_with(MAGIC) || bytes.len() < FRAMES {
        return Err(Unreadable::Damaged);
    }
    match number(bytes, MAGIC.len()) {
        Some(VERSION) => {}
        Some(version) if version > VERSION => return Err(Unreadable::Newer(version)),
        _ => return Err(Unreadable::Damaged),
    }
    let (header, header_end) = frame(bytes, FRAMES).ok_or(Unreadable::Damaged)?;
    let mut records = Vec::new();
    let mut at = header_end;
    while let Some((record, end)) = frame(bytes, at) {
        records.push((record, end));
        at = end;
    }
    Ok(Contents { header, records, header_end })
}

/// The bytes of a journal of this process, without records.
pub fn start(header: &Header) -> Vec<u8> {
    let mut bytes = MAGIC.to_vec();
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(std::process::id().to_le_bytes());
    bytes.extend(encode(header));
    bytes
}

/// The frame of a header or a record.
pub fn encode(value: &impl Serialize) -> Vec<u8> {
    let payload = serde_json::to_vec(value).expect("edits and headers are JSON through and through");
    let length = (payload.len() as u32).to_le_bytes();
    let mut bytes = length.to_vec();
    bytes.extend(checksum(length, &payload).to_le_bytes());
    bytes.extend(payload);
    bytes
}

/// The process that writes the journal, according to its first bytes.
pub fn writer(bytes: &[u8]) -> Option<u32> {
    bytes.starts_with(MAGIC).then(|| number(bytes, PID_AT))?
}

fn frame<T: for<'a> Deserialize<'a>>(bytes: &[u8], at: usize) -> Option<(T, usize)> {
    let length = number(bytes, at)?;
    let end = at.checked_add(FRAME_HEAD)?.checked_add(length as usize)?;
    let payload = bytes.get(at + FRAME_HEAD..end)?;
    let whole = number(bytes, at + 4)? == checksum(length.to_le_bytes(), payload);
    let value = whole.then(|| serde_json::from_slice(payload).ok())??;
    Some((value, end))
}

/// The checksum also covers the length, so that a run of zeros is not a valid frame.
fn checksum(length: [u8; 4], payload: &[u8]) -> u32 {
    crc32c::crc32c_append(crc32c::crc32c(&length), payload)
}

fn number(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(bytes.get(at..at.checked_add(4)?)?.try_into().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn header() -> Header {
        Header { file: "00".into(), document: json!({"plica": 1, "title": "ü"}), is_file: true }
    }

    fn records() -> Vec<Record> {
        let edit = |text: &str| Edit(serde_json::from_str(text).unwrap());
        let patch = edit(r#"[{"op": "add", "path": "/title", "value": "a"}]"#);
        let inverse = edit(r#"[{"op": "remove", "path": "/title"}]"#);
        [Kind::Edit, Kind::Undo, Kind::Redo, Kind::Saved("ab".into())]
            .into_iter()
            .zip(1..)
            .map(|(kind, n)| match kind {
                Kind::Saved(_) => {
                    Record { revision: n, time: 9, step: n, kind, patch: Edit::default(), inverse: Edit::default() }
                }
                _ => Record { revision: n, time: 9, step: n, kind, patch: patch.clone(), inverse: inverse.clone() },
            })
            .collect()
    }

    fn journal() -> Vec<u8> {
        let mut bytes = start(&header());
        records().iter().for_each(|record| bytes.extend(encode(record)));
        bytes
    }

    #[test]
    fn a_journal_cut_anywhere_gives_its_longest_prefix() {
        let bytes = journal();
        let whole = read(&bytes).unwrap();
        assert_eq!(whole.header, header());
        assert_eq!(whole.records.iter().map(|(r, _)| r.clone()).collect::<Vec<_>>(), records());
        assert_eq!(whole.end(), bytes.len());
        assert_eq!(writer(&bytes), Some(std::process::id()));
        for cut in 0..bytes.len() {
            let expected = whole.records.iter().filter(|(_, end)| *end <= cut).count();
            match read(&bytes[..cut]) {
                Ok(contents) => {
                    assert!(cut >= whole.header_end);
                    assert_eq!(contents.records, whole.records[..expected], "cut at {cut}");
                }
                Err(why) => assert_eq!((why, cut < whole.header_end), (Unreadable::Damaged, true)),
            }
        }
    }

    #[test]
    fn no_damaged_byte_goes_unseen() {
        let bytes = journal();
        let whole = read(&bytes).unwrap();
        for at in (0..bytes.len()).filter(|at| !(PID_AT..FRAMES).contains(at)) {
            for flip in [1, 0x80, 0xff] {
                let mut damaged = bytes.clone();
                damaged[at] ^= flip;
                let untouched = whole.records.iter().filter(|(_, end)| *end <= at).count();
                match read(&damaged) {
                    Ok(contents) => assert_eq!(contents.records, whole.records[..untouched], "byte {at}"),
                    Err(_) => assert!(at < whole.header_end, "byte {at}"),
                }
            }
        }
    }

    #[test]
    fn what_follows_the_records_is_not_taken() {
        let whole = read(&journal()).unwrap();
        for tail in [&[0; 64][..], &[0xff; 64], b"{\"revision\": 9}", &encode(&json!({"kind": "edit"}))] {
            let contents = read(&[&journal(), tail].concat()).unwrap();
            assert_eq!(contents, whole);
        }
    }

    #[test]
    fn what_is_no_journal_of_ours_is_told() {
        let mut newer = journal();
        newer[8] = 2;
        assert_eq!(read(&newer), Err(Unreadable::Newer(2)));
        for bytes in [&b""[..], b"{}", &[0; 100]] {
            assert_eq!(read(bytes), Err(Unreadable::Damaged));
            assert_eq!(writer(bytes), None);
        }
    }
}
