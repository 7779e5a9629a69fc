//! The link across machines when it is bad: slow, cut in the middle, full of file pieces. The far end and the window's
//! side are in this process, and between them is a wire that counts, delays and cuts.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on fails, and says what it measured"
)]

use std::io::{Read, Write};
use std::net::Shutdown;
use std::os::unix::net::UnixStream;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use plica::files::Options;
use plica::files::cache::Cache;
use plica::preview::editor::Preview;
use plica::preview::follow::Update;
use plica::preview::follow::client::Link;
use plica::preview::remote::address::Address;
use plica::preview::remote::ssh::Way;
use plica::preview::remote::{attach, far, fetch};
use plica::preview::wire::connection::{HangUp, Wire};
use plica::preview::wire::frame::most;
use plica::preview::wire::handshake;
use plica::preview::wire::message::{FromEditor, Role, ToEditor};
use plica::scene::{Document, Edit};
use serde_json::json;

/// How long a test waits for something that must happen before it fails.
const PATIENCE: Duration = Duration::from_secs(60);
/// A piece of a file, with its header.
const PIECE: u64 = (8 << 10) + 200;

struct Stage {
    folder: tempfile::TempDir,
    scene: PathBuf,
    document: Document,
}

fn stage() -> Stage {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("s.plica.json");
    let zone = json!({"name": "z", "outline": {"kind": "rectangle", "x": 0, "y": 0, "width": 2, "height": 2},
        "interpolation": {"method": "modified-shepard", "radius": 60}});
    let layer = json!({"kind": "picture", "name": "l", "image": "cat", "zones": [zone]});
    let text = json!({"plica": 1, "title": "0", "images": {"cat": {"path": "cat.png"}}, "layers": [layer]}).to_string();
    let document = Document::parse(&text).unwrap();
    std::fs::write(&scene, document.to_text()).unwrap();
    let stage = Stage { folder, scene, document };
    stage.paint(2);
    stage
}

/// The wire from the far end to the window: at most `rate` bytes per second, cut after `cut` bytes.
#[derive(Clone, Copy)]
struct Bad {
    rate: f64,
    cut: u64,
}

const GOOD: Bad = Bad { rate: f64::INFINITY, cut: u64::MAX };

impl Stage {
    /// Writes a picture that does not compress.
    fn paint(&self, side: u32) {
        let mut seed = 1u32;
        let noise = image::RgbImage::from_fn(side, side, |_, _| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            image::Rgb([(seed >> 24) as u8, (seed >> 16) as u8, (seed >> 8) as u8])
        });
        let new = self.folder.path().join("new.png");
        noise.save(&new).unwrap();
        std::fs::rename(new, self.folder.path().join("cat.png")).unwrap();
    }

    /// The window's end of a bad link, and how many bytes have come over it.
    fn ends(&self, bad: Bad) -> (UnixStream, Arc<AtomicU64>) {
        let (here, there) = UnixStream::pair().unwrap();
        let (served, serves) = UnixStream::pair().unwrap();
        let scene = self.scene.clone();
        std::thread::spawn(move || drop(attach::serve(&scene, &Options::default(), wire(serves))));
        let count = Arc::new(AtomicU64::new(0));
        carry(there.try_clone().unwrap(), served.try_clone().unwrap(), GOOD, Arc::default());
        carry(served, there, bad, count.clone());
        (here, count)
    }

    /// A window at the end of a bad link.
    fn window(&self, bad: Bad) -> (Link, Arc<AtomicU64>) {
        let (here, count) = self.ends(bad);
        let address = Address { user: None, host: "far".into(), port: None, path: "s".into() };
        let (program, remote_plica) = ("/no/ssh".into(), String::new());
        let way = Way { address, program, remote_plica, options: Options::default() };
        let hello = handshake::shake_hands(&mut &here, &mut &here, Role::Window, most()).unwrap();
        let cache = Cache::at(self.folder.path().join("cache"), 1 << 30).unwrap();
        (far::follow(way, (hello, wire(here)), cache, fetch::Shared::default()).unwrap(), count)
    }

    fn editor(&self) -> Preview {
        Preview::start(&self.scene, &self.document, 0, |_| {})
    }
}

fn wire(stream: UnixStream) -> Wire {
    let (reader, writer) = (stream.try_clone().unwrap(), stream.try_clone().unwrap());
    let hang_up = HangUp::new(move || drop(stream.shutdown(Shutdown::Both)));
    Wire { reader: Box::new(reader), writer: Box::new(writer), hang_up }
}

fn carry(mut from: UnixStream, mut to: UnixStream, bad: Bad, count: Arc<AtomicU64>) {
    std::thread::spawn(move || {
        let mut bytes = [0; 512];
        // When the wire is free again.
        let mut free = Instant::now();
        while let Ok(n @ 1..) = from.read(&mut bytes) {
            let before = count.fetch_add(n as u64, Ordering::SeqCst);
            let left = bad.cut.saturating_sub(before).min(n as u64) as usize;
            free = free.max(Instant::now()) + Duration::from_secs_f64(n as f64 / bad.rate);
            std::thread::sleep(free.saturating_duration_since(Instant::now()));
            if to.write_all(&bytes[..left]).is_err() || left < n {
                break;
            }
        }
        drop((from.shutdown(Shutdown::Both), to.shutdown(Shutdown::Both)));
    });
}

fn next<T>(link: &Link, wanted: impl Fn(&Update) -> Option<T>) -> T {
    loop {
        let update = link.updates.recv_timeout(PATIENCE).expect("an update");
        if let Update::Scene { revision, .. } = update {
            // As a window does.
            drop(link.replies.send(ToEditor::Ack { revision, synth_ms: 1.0 }));
        }
        if let Some(found) = wanted(&update) {
            return found;
        }
    }
}

fn shows(link: &Link, wanted: u64) {
    next(link, |update| matches!(update, Update::Scene { revision, .. } if *revision == wanted).then_some(()));
}

fn notice(link: &Link, part: &str) {
    next(link, |update| matches!(update, Update::Said(FromEditor::Notice(line)) if line.contains(part)).then_some(()));
}

/// Sends one message after another until the link has carried enough bytes to be cut.
fn until_lost(link: &Link, editor: &Preview) {
    for _ in 0..1200 {
        match link.updates.recv_timeout(PATIENCE / 1200) {
            Ok(Update::Said(FromEditor::Notice(line))) if line.contains("reconnecting: the connection was lost") => {
                return;
            }
            Ok(_) => {}
            Err(_) => editor.view("view-grid"),
        }
    }
    panic!("the link is not lost");
}

/// One more edit of a number, as by a key.
fn step(editor: &Preview, document: &mut Document, revision: u64) {
    let radius =
        json!([{"op": "replace", "path": "/layers/0/zones/0/interpolation/radius", "value": 60.0 + revision as f64}]);
    let edit: Edit = serde_json::from_value(radius).unwrap();
    *document = document.apply(&edit).unwrap();
    editor.publish(document, revision, &edit);
}

#[test]
fn an_edit_is_small_and_a_thousand_are_joined() {
    let stage = stage();
    let editor = stage.editor();
    let (link, count) = stage.window(Bad { rate: 20e3, ..GOOD });
    shows(&link, 0);
    notice(&link, "joined the editor");
    let mut document = stage.document.clone();
    let before = count.load(Ordering::SeqCst);
    step(&editor, &mut document, 1);
    shows(&link, 1);
    let one = count.load(Ordering::SeqCst) - before;
    println!("an edit: {one} bytes");
    assert!(one < 1000, "{one} bytes for an edit");
    (2..=1000).for_each(|revision| step(&editor, &mut document, revision));
    shows(&link, 1000);
    let all = count.load(Ordering::SeqCst) - before;
    assert!(all < 200_000, "{all} bytes for a thousand edits");
}

#[test]
fn an_edit_goes_before_a_picture_on_a_slow_link() {
    let stage = stage();
    let editor = stage.editor();
    let (link, count) = stage.window(Bad { rate: 20e3, ..GOOD });
    shows(&link, 0);
    stage.paint(600);
    next(&link, |update| matches!(update, Update::Progress(line) if line.contains("fetching cat.png")).then_some(()));
    let mut document = stage.document.clone();
    for revision in 1..=5 {
        let before = count.load(Ordering::SeqCst);
        step(&editor, &mut document, revision);
        shows(&link, revision);
        let waited = count.load(Ordering::SeqCst) - before;
        println!("an edit behind a picture: {waited} bytes");
        assert!(waited < 4 * PIECE, "{waited} bytes went before an edit");
    }
}

#[test]
fn a_link_cut_anywhere_is_told_and_ends_nothing_else() {
    let stage = stage();
    let editor = stage.editor();
    // The first fetches the picture; the second shows how many bytes a link carries without that.
    shows(&stage.window(GOOD).0, 0);
    let (link, count) = stage.window(GOOD);
    shows(&link, 0);
    notice(&link, "joined the editor");
    let whole = count.load(Ordering::SeqCst);
    drop(link);
    for before_the_end in [1, 5, 11, 12, 13, 60, 100, 150, 200, 250] {
        let (link, _) = stage.window(Bad { cut: whole - before_the_end, ..GOOD });
        until_lost(&link, &editor);
    }
    for cut in [0, 1, 11, 12, 100] {
        let (here, _) = stage.ends(Bad { cut, ..GOOD });
        let error = handshake::shake_hands(&mut &here, &mut &here, Role::Window, most()).unwrap_err().to_string();
        assert!(error.contains("in the middle") || error.contains("left at once"), "{cut}: {error}");
    }
    let (link, _) = stage.window(GOOD);
    shows(&link, 0);
    assert!(editor.status().to_string().contains("connected"));
}
