//! From a key pressed in the editor to pixels in the window, and what that costs on the link: `cargo bench --bench window`. A
//! 512 x 512 zone in a real window on a display of its own (Xvfb); the key steps the radius, its screen is drawn too.
#![allow(clippy::print_stdout, reason = "a benchmark prints what it measured")]

mod scenes;

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use plica::preview::editor::{Event, Preview};
use plica::preview::wire::frame;
use plica::preview::wire::message::{FromEditor, ToEditor};
use plica::scene::Document;
use plica::tui::{Offscreen, Published};

const SIDE: usize = 512;
const EDITS: u64 = 40;
const PATIENCE: Duration = Duration::from_secs(60);

/// Ends with the value.
struct Process(Child);

impl Drop for Process {
    fn drop(&mut self) {
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = tempfile::tempdir()?;
    let scene = folder.path().join("s.plica.json");
    let document = Document::parse(&text()).map_err(|problems| format!("{problems:?}"))?;
    std::fs::write(&scene, document.to_text())?;
    picture(&folder.path().join("a.png"))?;
    let mut keys = Offscreen::open(&scene, (160, 48))?;
    ["/", "r", "a", "d", "i", "u", "s", "Enter"].iter().try_for_each(|key| keys.press(key))?;
    let (sender, replies) = channel();
    let editor = Preview::start(&scene, &document, 0, move |event| {
        if let Event::Said(reply) = event {
            drop(sender.send(reply));
        }
    });
    let (_server, display) = display()?;
    let mut view = Command::new(env!("CARGO_BIN_EXE_plica"));
    let _view = Process(view.arg("view").arg(&scene).env("DISPLAY", display).env_remove("WAYLAND_DISPLAY").spawn()?);
    shown(&replies, 0)?;
    let (mut times, mut synths, mut bytes) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..EDITS {
        let began = Instant::now();
        let [Published { document, revision, edit }] = &keys.take("+")[..] else {
            return Err("the key changes nothing".into());
        };
        editor.publish(document, *revision, edit);
        keys.draw()?;
        synths.push(shown(&replies, *revision)?);
        times.push(began.elapsed().as_secs_f64() * 1000.0);
        let (from_revision, to_revision, patch) = (revision - 1, *revision, edit.clone());
        let mut sent = Vec::new();
        frame::write(&mut sent, &FromEditor::Patch { from_revision, to_revision, patch })?;
        bytes.push(sent.len() as f64);
    }
    println!("key to pixels, {SIDE} x {SIDE} zone: median {:.1} ms, worst {:.1} ms", median(&mut times), worst(&times));
    println!("of which loading and synthesis: median {:.1} ms", median(&mut synths));
    println!("bytes on the link an edit: {}", worst(&bytes));
    Ok(())
}

/// Waits until the window has put this revision on the screen; gives what loading and synthesis took, in milliseconds.
fn shown(replies: &Receiver<ToEditor>, wanted: u64) -> Result<f64, Box<dyn std::error::Error>> {
    loop {
        match replies.recv_timeout(PATIENCE)? {
            ToEditor::Ack { revision, synth_ms } if revision == wanted => return Ok(synth_ms),
            _ => {}
        }
    }
}

fn display() -> Result<(Process, String), Box<dyn std::error::Error>> {
    let mut server = Command::new("Xvfb")
        .args(["-displayfd", "1", "-screen", "0", "1000x800x24", "-nolisten", "tcp"])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()?;
    let mut number = String::new();
    BufReader::new(server.stdout.take().ok_or("Xvfb says nothing")?).read_line(&mut number)?;
    Ok((Process(server), format!(":{}", number.trim())))
}

fn text() -> String {
    let zone = scenes::zone((SIDE, SIDE), 94, r#"{"method":"modified-shepard","radius":300}"#);
    let layer = serde_json::json!({"kind": "picture", "name": "all", "image": "a", "zones": [zone]});
    serde_json::json!({"plica": 1, "images": {"a": {"path": "a.png"}}, "layers": [layer]}).to_string()
}

fn picture(path: &std::path::Path) -> image::ImageResult<()> {
    image::RgbImage::from_fn(SIDE as u32, SIDE as u32, |x, y| image::Rgb([x as u8, y as u8, 90])).save(path)
}

fn median(numbers: &mut [f64]) -> f64 {
    numbers.sort_unstable_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

fn worst(numbers: &[f64]) -> f64 {
    numbers.iter().copied().fold(0.0, f64::max)
}
