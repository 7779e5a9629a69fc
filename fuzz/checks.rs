//! What holds for any bytes, reader by reader: no panic, no endless work, and what is read once reads the same again. The
//! fuzz targets beside this file call these with bytes that are bred, `tests/fuzz.rs` with a few at random.

use std::fs::File;
use std::io::{Cursor, Seek, Write};

use plica::base::budget::Budget;
use plica::base::error::Error;
use plica::base::expression::{Variables, evaluate};
use plica::files::journal::{self, Contents};
use plica::files::{Limits, Options, cameras, fields, mesh, picture, recovery, styles};
use plica::preview::wire::frame;
use plica::preview::wire::message::{FromEditor, Message, ToEditor};
use plica::scene::Document;

/// A check, by the name of what it reads.
pub const CHECKS: &[(&str, fn(&[u8]))] = &[
    ("scene", scene),
    ("journal", journal),
    ("message", message),
    ("picture", picture),
    ("flo", flo),
    ("mesh", mesh),
    ("cameras", cameras),
    ("colmap", colmap),
    ("style", style),
    ("expression", expression),
    #[cfg(feature = "tui")]
    ("keymap", keymap),
    #[cfg(feature = "tui")]
    ("script", script),
];

/// A scene that is read is written, and that reads as the same.
pub fn scene(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(document) = Document::parse(text) else { return };
    let written = document.to_text();
    let again = Document::parse(&written).unwrap_or_else(|problems| panic!("{written}\n{problems:?}"));
    assert_eq!(document.scene(), again.scene(), "{written}");
    assert_eq!(written, again.to_text());
}

/// As the bytes of a journal, and as its header and records in JSON, a line each, whose checksums are right.
pub fn journal(bytes: &[u8]) {
    if let Ok(contents) = journal::read(bytes) {
        assert!(contents.end() <= bytes.len());
        assert_eq!(journal::read(&bytes[..contents.end()]).as_ref(), Ok(&contents), "only what is whole counts");
        recovery::replay(&contents);
    }
    let mut lines = bytes.split(|&byte| byte == b'\n');
    let Some(Ok(header)) = lines.next().map(serde_json::from_slice) else { return };
    let records = lines.map_while(|line| serde_json::from_slice(line).ok()).zip(1..).collect();
    recovery::replay(&Contents { header, records, header_end: 0 });
}

/// As the bytes of a message, and as its JSON: it is sent and comes out the same.
pub fn message(bytes: &[u8]) {
    fn one<T: Message + PartialEq + std::fmt::Debug + serde::de::DeserializeOwned>(bytes: &[u8]) {
        let most = Limits::default().message;
        let _ = frame::read::<T>(&mut Cursor::new(bytes), most);
        let Ok(said) = serde_json::from_slice::<T>(bytes) else { return };
        let mut sent = Vec::new();
        frame::write(&mut sent, &said).expect("memory takes it");
        let heard = frame::read::<T>(&mut Cursor::new(&sent), most);
        assert_eq!(heard.expect("what was sent").as_ref(), Some(&said));
    }
    one::<FromEditor>(bytes);
    one::<ToEditor>(bytes);
}

/// A picture has the size that its header tells.
pub fn picture(bytes: &[u8]) {
    let limits = Limits { pixels: 1 << 16, side: 1 << 10, memory: 64 << 20, ..Limits::default() };
    let header = picture::header(file(bytes), "a picture", &limits);
    if let Ok((found, share)) = picture::decode(file(bytes), "a picture", &limits, &limits.budget()) {
        let size = (found.picture.width(), found.picture.height());
        assert_eq!(header.expect("a picture that can be read has a size"), size);
        drop(share);
    }
}

/// A vector field has finite vectors.
pub fn flo(bytes: &[u8]) {
    let limits = Limits { pixels: 1 << 16, side: 1 << 10, memory: 64 << 20, ..Limits::default() };
    if let Ok((field, _)) = fields::decode(file(bytes), "a field", &limits, &Budget::new(limits.memory)) {
        assert!(field.cells().iter().flatten().all(|value| value.is_finite()));
    }
}

/// A mesh has vertices for all corners, and they are as a renderer expects them; what it kept on the way is given back.
pub fn mesh(bytes: &[u8]) {
    let limits = Limits { triangles: 1 << 16, mesh: 1 << 20, memory: 64 << 20, ..Limits::default() };
    let (budget, options) = (limits.budget(), Options { limits: limits.clone(), ..Options::default() });
    let none = |path: &str| Err(Error::at(path, "is not there"));
    let _ = mesh::pictures(file(bytes), "a.glb", &options);
    let _ = picture::header(file(bytes), "a.glb#0", &limits);
    let Ok((mesh, _, share)) = mesh::decode(file(bytes), "a.obj", &options, &budget, &none) else {
        assert_eq!(budget.taken(), 0);
        return;
    };
    assert_eq!(budget.taken(), mesh.bytes());
    drop(share);
    assert!(mesh.triangles.iter().flatten().all(|&corner| (corner as usize) < mesh.vertices.len()));
    for vertex in &mesh.vertices {
        assert!(vertex.position.is_finite() && vertex.uv.is_finite(), "{vertex:?}");
        assert!((vertex.normal.length() - 1.0).abs() < 1e-9, "{vertex:?}");
    }
    assert!((1..=1 << 16).contains(&mesh.triangles.len()) && mesh.bounds().is_some());
}

/// `cameras.json` and `transforms.json`.
pub fn cameras(bytes: &[u8]) {
    shots("cameras.json", &[("cameras.json", bytes)]);
}

/// Both files of a COLMAP text model; the second begins with a line of `#` of its own.
pub fn colmap(bytes: &[u8]) {
    let at = bytes.windows(3).position(|three| three == b"\n#\n").map_or(bytes.len(), |at| at + 1);
    let (cameras, images) = bytes.split_at(at);
    shots("images.txt", &[("cameras.txt", cameras), ("images.txt", images)]);
}

/// Cameras that are read have finite numbers, and their pictures a size.
fn shots(name: &str, files: &[(&str, &[u8])]) {
    let folder = tempfile::tempdir().expect("a folder");
    files.iter().for_each(|(name, bytes)| std::fs::write(folder.path().join(name), bytes).expect("a file"));
    let limits = Limits { scene: 1 << 20, ..Limits::default() };
    let reading = cameras::Reading { images: None, all: true, limits: &limits };
    let Ok(found) = cameras::read(&folder.path().join(name), &reading) else { return };
    for (_, shot) in found.shots {
        assert!(shot.turn.is_finite() && shot.shift.is_finite(), "{shot:?}");
        assert!(shot.focal_px.iter().all(|px| px.is_finite() && *px > 0.0), "{shot:?}");
        assert!(shot.center_px.iter().flatten().all(|px| px.is_finite()), "{shot:?}");
        assert!(shot.size_px.iter().flatten().all(|px| *px > 0), "{shot:?}");
    }
}

/// A style is a table.
pub fn style(bytes: &[u8]) {
    let mut file = tempfile::NamedTempFile::new().expect("a file");
    file.write_all(bytes).expect("it takes a few bytes");
    if let Ok(table) = styles::read(file.path(), &Limits::default()) {
        assert!(table.is_object());
    }
}

/// A value is finite, and the same each time.
pub fn expression(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let value =
        || evaluate(text, &Variables { numbers: &[("v", 2.5), ("w", 640.0), ("i", 3.0)], words: &[("tool", "point")] });
    if let Ok(found) = value() {
        assert!(found.is_finite(), "{text} is {found}");
    }
    assert_eq!(value().map(f64::to_bits), value().map(f64::to_bits), "{text}");
}

/// The keys of a person's own file: what is wrong is told with its line.
#[cfg(feature = "tui")]
pub fn keymap(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let keymap = plica::tui::keymap("keys.toml", text);
    assert!(keymap.mistakes().iter().all(|mistake| mistake.starts_with("keys.toml:")), "{:?}", keymap.mistakes());
    assert!(!keymap.rows().is_empty());
}

/// Lines of a script, typed in the editor: they are done or refused, and the screen is drawn.
#[cfg(feature = "tui")]
pub fn script(bytes: &[u8]) {
    const SCENE: &str = include_str!("seeds/scene/zone.json");
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let folder = tempfile::tempdir().expect("a folder for the scene");
    let path = folder.path().join("a.plica.json");
    std::fs::write(&path, SCENE).expect("a scene");
    let mut editor = plica::tui::Offscreen::open(&path, (100, 30)).expect("an editor");
    // Nothing is to be written but the scene: no line names another file.
    let allowed = |line: &&str| !line.contains(['/', '~']) && !line.trim_start_matches([':', ' ']).starts_with('w');
    for line in text.lines().filter(allowed).take(20) {
        editor.take(":");
        line.chars().for_each(|c| drop(editor.take(&if c == ' ' { "Space".to_owned() } else { c.to_string() })));
        editor.press("Enter").expect("a screen");
        editor.take("Esc");
    }
}

fn file(bytes: &[u8]) -> File {
    let mut file = tempfile::tempfile().expect("a file without a name");
    file.write_all(bytes).and_then(|()| file.rewind()).expect("it takes a few bytes");
    file
}
