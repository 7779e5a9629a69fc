//! The binary in a fresh folder: what it renders, writes and plots, what it says, and what it leaves.

#![allow(clippy::unwrap_used, reason = "a failing test says so by a panic, in its helpers too")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

const SCENE: &str = r#"{
  "plica": 1, "timeline": { "duration": 0.5, "fps": 12, "loop": "repeat" },
  "images": { "cat": { "path": "cat.png" } },
  "layers": [{ "kind": "picture", "name": "face", "image": "cat", "zones": [{
    "name": "left eye", "outline": { "kind": "ellipse", "center": [16, 12], "radii": [10, 8] },
    "motion": [{ "tool": "point", "at": [16, 12], "jump": [5, -3] }, { "tool": "still-border", "spacing": 4 }],
    "fold": { "rule": "cover", "regions": [{ "kind": "rectangle", "x": 18, "y": 0, "width": 5, "height": 24 }] } }] }]
}"#;

/// A folder with a scene of 6 frames, 33 x 25.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let shade = |x, y| image::Rgba([(x * 7) as u8, (y * 9) as u8, ((x * y) % 256) as u8, 255]);
    image::RgbaImage::from_fn(33, 25, shade).save(folder.path().join("cat.png")).unwrap();
    fs::write(folder.path().join("s.plica.json"), SCENE).unwrap();
    folder
}

fn plica(folder: &Path, line: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_plica"));
    command.args(line.split_whitespace()).current_dir(folder).env("XDG_STATE_HOME", folder.join("state"));
    command.stdin(Stdio::null());
    command
}

fn run(folder: &Path, line: &str) -> Output {
    plica(folder, line).output().unwrap()
}

/// Runs what must go well and returns standard output.
fn good(folder: &Path, line: &str) -> Vec<u8> {
    let Output { status, stdout, stderr } = run(folder, line);
    assert!(status.success(), "{line}: {}", String::from_utf8_lossy(&stderr));
    stdout
}

/// Files in the folder besides the scene, its picture and the log.
fn made(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = names.filter(|n| !["s.plica.json", "cat.png", "state"].contains(&n.as_str())).collect();
    names.sort();
    names
}

fn pixels(path: &Path) -> (u32, u32, Vec<u8>) {
    let image = image::open(path).unwrap().to_rgba8();
    (image.width(), image.height(), image.into_raw())
}

#[test]
fn every_output_shows_the_same_frames() {
    let folder = folder();
    let dir = folder.path();
    good(dir, "render s.plica.json -o f-%03d.png");
    assert_eq!(made(dir), (0..6).map(|k| format!("f-{k:03}.png")).collect::<Vec<_>>());
    let frames: Vec<u8> = (0..6).flat_map(|k| pixels(&dir.join(format!("f-{k:03}.png"))).2).collect();
    assert!(good(dir, "render s.plica.json -o - --format rgba") == frames);
    let y4m = good(dir, "render s.plica.json -o - --format y4m");
    assert!(y4m.starts_with(b"YUV4MPEG2 W33 H25 F12:1 "));
    for name in ["a.apng", "a.webp", "a.gif", "a.rgba", "a.y4m"] {
        good(dir, &format!("render s.plica.json -o {name}"));
    }
    assert!(fs::read(dir.join("a.y4m")).unwrap() == y4m && fs::read(dir.join("a.rgba")).unwrap() == frames);
    assert_eq!(pixels(&dir.join("a.webp")).2, frames[..33 * 25 * 4], "the first frame of the WebP");
}

#[test]
fn frames_are_chosen_scaled_and_numbered() {
    let folder = folder();
    let dir = folder.path();
    good(dir, "render s.plica.json -o %d.png --frames 0,2-4:2 --size 66x0 --samples 2");
    assert_eq!(made(dir), ["0.png", "2.png", "4.png"]);
    assert_eq!((pixels(&dir.join("2.png")).0, pixels(&dir.join("2.png")).1), (66, 50));
    good(dir, "render s.plica.json -o still.png --frames 5");
    assert!(made(dir).contains(&"still.png".to_owned()));
}

#[test]
fn wrong_command_lines_are_told_and_leave_nothing() {
    let folder = folder();
    for (line, what) in [
        ("render s.plica.json -o a.mov", "names no format"),
        ("render s.plica.json -o a.png", "6 frames do not fit one PNG"),
        ("render s.plica.json -o %d.jpg", "end in .png"),
        ("render s.plica.json -o -", "--format"),
        ("render s.plica.json -o - --format gif", "y4m or rgba"),
        ("render s.plica.json -o a.gif --format y4m", "extension"),
        ("render s.plica.json -o a.gif --frames 3-9", "frames 0 to 5"),
        ("render s.plica.json -o a.gif --size big", "640x480"),
        ("render s.plica.json -o a.gif --samples 0", "1..=16"),
        ("field s.plica.json -o a.txt", ".svg, .png or .csv"),
        ("field s.plica.json -o a.svg --zone nose", "only left eye"),
        ("synth s.plica.json -o out --depth 12", "8"),
    ] {
        let Output { status, stderr, .. } = run(folder.path(), line);
        let said = String::from_utf8(stderr).unwrap();
        assert!(status.code() == Some(2) && said.contains(what), "{line}: {status} {said}");
    }
    let Output { status, stderr, .. } = run(folder.path(), "render s.plica.json -o none/a.gif");
    assert!(status.code() == Some(1) && String::from_utf8(stderr).unwrap().contains("folder first"));
    assert!(made(folder.path()).is_empty(), "{:?}", made(folder.path()));
}

#[test]
fn an_interrupt_leaves_what_was_there() {
    let folder = folder();
    let dir = folder.path();
    // Long enough that it is never done before the signal.
    let long = SCENE.replace("\"duration\": 0.5", "\"duration\": 5000");
    fs::write(dir.join("s.plica.json"), long).unwrap();
    fs::write(dir.join("a.webp"), "old").unwrap();
    for output in ["a.webp", "%d.png", "b.gif"] {
        let line = format!("render s.plica.json -o {output}");
        let mut child = plica(dir, &line).stderr(Stdio::null()).spawn().unwrap();
        // The hidden temporary tells that it is at work.
        while !made(dir).iter().any(|name| name.starts_with('.')) {
            assert!(child.try_wait().unwrap().is_none(), "{output}: ended by itself");
            std::thread::sleep(Duration::from_millis(5));
        }
        let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
        assert!(kill.unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(130), "{output}");
        assert_eq!(made(dir), ["a.webp"], "{output}");
    }
    assert_eq!(fs::read(dir.join("a.webp")).unwrap(), b"old");
}

#[test]
fn textures_and_plots_are_written() {
    let folder = folder();
    let dir = folder.path();
    for depth in ["32", "16", "8"] {
        good(dir, &format!("synth s.plica.json -o out{depth} --depth {depth}"));
        let manifest = fs::read_to_string(dir.join(format!("out{depth}/manifest.json"))).unwrap();
        assert!(manifest.contains("\"plica_textures\": 1") && manifest.contains("left-eye-thresholds"));
    }
    good(dir, "synth s.plica.json -o out16"); // again, over what is there
    good(dir, "field s.plica.json -o f.csv --step 4");
    good(dir, "field s.plica.json -o f.svg --no-picture");
    fs::write(dir.join("f.png"), "old").unwrap();
    good(dir, "field s.plica.json -o f.png");
    assert!(pixels(&dir.join("f.png")).0 > 300);
    let csv = fs::read_to_string(dir.join("f.csv")).unwrap();
    assert_eq!(good(dir, "field s.plica.json -o - --step 4"), csv.as_bytes());
    assert!(csv.starts_with("x,y,dx,dy,length,degrees\n") && csv.lines().count() > 10);
    assert_eq!(made(dir), ["f.csv", "f.png", "f.svg", "out16", "out32", "out8"]);
}

#[test]
#[cfg(not(feature = "window"))]
fn without_the_gpu_it_says_so() {
    let folder = folder();
    let Output { status, stderr, .. } = run(folder.path(), "render s.plica.json -o a.gif --gpu");
    assert!(status.code() == Some(1) && String::from_utf8(stderr).unwrap().contains("built without the GPU"));
}
