//! Video by ffmpeg, inspected with ffprobe and read back. Skipped, with the reason, if there is no ffmpeg.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on fails, and says what it leaves out"
)]

mod binary;

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

/// A scene of half a second at 12 frames per second; only a spot of the picture moves.
const SCENE: &str = r#"{
  "plica": 1, "timeline": { "duration": 0.5, "fps": 12, "loop": "repeat" },
  "images": { "cat": { "path": "cat.png" } },
  "layers": [{ "kind": "picture", "name": "face", "image": "cat", "zones": [{
    "name": "z", "outline": { "kind": "rectangle", "x": 0, "y": 0, "width": 4, "height": 4 },
    "motion": [{ "tool": "point", "at": [2, 2], "jump": [1, 0] }] }] }]
}"#;

/// Red, green, a skin color and half transparent blue, in four columns.
const COLORS: [[u8; 4]; 4] = [[255, 0, 0, 255], [0, 255, 0, 255], [200, 60, 60, 255], [0, 0, 255, 128]];

fn folder((width, height): (u32, u32)) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let color = |x: u32, _| image::Rgba(COLORS[(x * 4 / width) as usize]);
    image::RgbaImage::from_fn(width, height, color).save(folder.path().join("cat.png")).unwrap();
    fs::write(folder.path().join("s.plica.json"), SCENE).unwrap();
    folder
}

fn plica(folder: &Path, line: &str) -> Command {
    binary::plica(folder, line.split_whitespace())
}

fn has_ffmpeg(encoder: &str) -> bool {
    let listed = Command::new("ffmpeg").args(["-hide_banner", "-encoders"]).stdin(Stdio::null()).output();
    let has = listed.is_ok_and(|listed| String::from_utf8_lossy(&listed.stdout).contains(encoder))
        && Command::new("ffprobe").arg("-version").output().is_ok();
    if !has {
        println!("left out: there is no ffmpeg with {encoder} here");
    }
    has
}

fn probed(path: &Path, what: &str) -> String {
    let mut command = Command::new("ffprobe");
    command.args(["-v", "error", "-of", "default=nw=1", "-show_entries", what]).arg(path);
    String::from_utf8(command.output().unwrap().stdout).unwrap()
}

/// The pixels of the first frame, read with the matrix of that name.
fn first_frame(path: &Path, decoder: &[&str], matrix: &str) -> Vec<u8> {
    let mut command = Command::new("ffmpeg");
    command.args(["-v", "error", "-nostdin"]).args(decoder).arg("-i").arg(path);
    let filter = format!("scale=in_color_matrix={matrix}:in_range=tv:flags=accurate_rnd+full_chroma_int,format=rgba");
    command.args(["-vf", &filter, "-frames:v", "1", "-f", "rawvideo", "-"]);
    command.output().unwrap().stdout
}

#[test]
fn videos_say_what_their_numbers_mean_and_are_what_was_seen() {
    const TAGS: &str =
        "stream=width,height,nb_read_frames,r_frame_rate,color_space,color_primaries,color_transfer,color_range";
    for (name, encoder, decoder, alpha, (width, height), matrix) in [
        ("a.mp4", "libx264", &[][..], false, (64, 48), "smpte170m"),
        ("a.mp4", "libx264", &[], false, (80, 720), "bt709"),
        ("a.webm", "libvpx-vp9", &["-c:v", "libvpx-vp9"], true, (64, 48), "smpte170m"),
        ("a.mov", "prores_ks", &[], true, (80, 720), "bt709"),
    ] {
        if !has_ffmpeg(encoder) {
            continue;
        }
        let folder = folder((width, height));
        let path = folder.path().join(name);
        let Output { status, stderr, .. } =
            plica(folder.path(), &format!("render s.plica.json -o {name}")).output().unwrap();
        let said = String::from_utf8(stderr).unwrap();
        assert!(status.success() && said.contains(&format!("done: {name}, ")), "{name}: {said}");
        assert_eq!(said.contains("no alpha"), !alpha, "{name}: {said}");
        let told = probed(&path, TAGS);
        for wanted in [
            format!("width={width}"),
            format!("height={height}"),
            "r_frame_rate=12/1".into(),
            format!("color_space={matrix}"),
            "color_primaries=bt709".into(),
            "color_transfer=iec61966-2-1".into(),
            "color_range=tv".into(),
        ] {
            assert!(told.lines().any(|line| line == wanted), "{name}: {wanted} is not in\n{told}");
        }
        let pixels = first_frame(&path, decoder, matrix);
        assert_eq!(pixels.len(), (4 * width * height) as usize, "{name}");
        for (column, color) in COLORS.iter().enumerate() {
            // In the middle of the column, which subsampled chroma of a neighbor does not reach.
            let at = 4 * ((height / 2 * width) as usize + width as usize * (2 * column + 1) / 8);
            // Without alpha: half of blue, in linear light, on black.
            let wanted = if alpha || color[3] == 255 { *color } else { [0, 0, 188, 255] };
            let wanted = if alpha { wanted } else { [wanted[0], wanted[1], wanted[2], 255] };
            let near = pixels[at..at + 4].iter().zip(wanted).all(|(a, b)| a.abs_diff(b) <= 6);
            assert!(near, "{name}, column {column}: {:?} for {wanted:?}", &pixels[at..at + 4]);
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3 + usize::from(folder.path().join("state").exists()));
    }
}

#[test]
fn h264_has_even_sides() {
    if !has_ffmpeg("libx264") {
        return;
    }
    let folder = folder((33, 25));
    let said = plica(folder.path(), "render s.plica.json -o a.mp4").output().unwrap().stderr;
    let said = String::from_utf8(said).unwrap();
    assert!(said.contains("33 x 25 became 34 x 26"), "{said}");
    let told = probed(&folder.path().join("a.mp4"), "stream=width,height");
    assert!(told.contains("width=34") && told.contains("height=26"), "{told}");
}

#[test]
fn an_interrupted_video_leaves_nothing() {
    if !has_ffmpeg("libx264") {
        return;
    }
    let folder = folder((64, 48));
    let dir = folder.path();
    fs::write(dir.join("s.plica.json"), SCENE.replace("\"duration\": 0.5", "\"duration\": 5000")).unwrap();
    let mut child = plica(dir, "render s.plica.json -o a.mp4").stderr(Stdio::null()).spawn().unwrap();
    let hidden = || fs::read_dir(dir).unwrap().flatten().any(|e| e.file_name().to_string_lossy().starts_with(".plica"));
    while !hidden() {
        assert!(child.try_wait().unwrap().is_none(), "ended by itself");
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(!hidden() && !dir.join("a.mp4").exists());
}

#[test]
fn without_ffmpeg_the_line_to_run_is_told() {
    let folder = folder((33, 24));
    for (output, line) in [
        (
            "a.mp4",
            "plica render s.plica.json --frames 0-3 -o - --format y4m | ffmpeg -i pipe:0 -vf pad=34:24,format=yuv420p,",
        ),
        (
            "a.mov",
            "plica render s.plica.json --frames 0-3 -o - --format rgba | ffmpeg -f rawvideo -pixel_format rgba -video_size 33x24",
        ),
    ] {
        let line_of = format!("render s.plica.json --frames 0-3 -o {output}");
        let Output { status, stderr, .. } = plica(folder.path(), &line_of).env("PATH", "/none").output().unwrap();
        let said = String::from_utf8(stderr).unwrap();
        assert!(
            status.code() == Some(1) && said.contains("none on the PATH") && said.contains(line),
            "{output}: {said}"
        );
        assert!(!folder.path().join(output).exists());
    }
}

#[test]
fn what_ffmpeg_says_is_told() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder((16, 16));
    let program = folder.path().join("ffmpeg");
    fs::write(&program, "#!/bin/sh\necho \"Unknown encoder 'libx264'\" >&2\nexit 1\n").unwrap();
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    let run = plica(folder.path(), "render s.plica.json -o a.mp4").env("PATH", folder.path()).output().unwrap();
    let said = String::from_utf8(run.stderr).unwrap();
    assert!(run.status.code() == Some(1) && said.contains("ffmpeg: Unknown encoder 'libx264'"), "{said}");
    assert!(!folder.path().join("a.mp4").exists());
}
