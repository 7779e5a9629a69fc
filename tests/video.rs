//! Video by ffmpeg, inspected with ffprobe and read back. Skipped, with the reason, if there is no ffmpeg.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod binary;

use std::fs;
use std::io::Write;
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
        let _ = writeln!(std::io::stderr(), "not run: there is no ffmpeg with {encoder} here");
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

/// Frames of a clip fill the whole picture, one a frame.
fn of_clip(clip: &str) -> String {
    format!(
        r#"{{ "plica": 1, "timeline": {{ "duration": 0.6, "fps": 10 }}, "images": {{ "cat": {{ "path": "cat.png" }} }},
        "clips": {{ "v": {clip} }}, "layers": [{{ "kind": "picture", "name": "l", "image": "cat", "zones": [{{ "name": "z",
        "outline": {{ "kind": "rectangle", "x": 0, "y": 0, "width": 32, "height": 16 }}, "sampler": {{ "clip": "v" }} }}] }}] }}"#
    )
}

/// Clips, and the frames of the video that are shown of each.
const SHOWN: [(&str, [usize; 6]); 3] = [
    (r#"{ "path": "v.mkv", "fps": 10 }"#, [0, 1, 2, 3, 4, 5]),
    (r#"{ "path": "v.mkv", "fps": 10, "first": 2, "count": 3 }"#, [2, 3, 4, 2, 3, 4]),
    (r#"{ "path": "v.mkv", "fps": 5, "first": 4 }"#, [4, 4, 5, 5, 4, 4]),
];

/// Clips of which frames cannot be shown, where programs are found, and what is said.
const TOLD: [(&str, Option<&str>, &str); 8] = [
    (r#"{ "path": "v.mkv" }"#, Some(""), "v.mkv: ffmpeg reads videos, and there is none on the PATH (install ffmpeg"),
    (r#"{ "path": "no.mp4" }"#, None, "no.mp4: ffmpeg: "),
    (r#"{ "path": "list.mp4" }"#, None, "list.mp4: ffmpeg: it is no video that is in one file (copy it again"),
    (r#"{ "path": "cat.png" }"#, Some(""), "cat.png: is a PNG picture, not a video (a clip is made of numbered"),
    (r#"{ "path": "gone.mp4" }"#, None, "gone.mp4: there is no such file"),
    (r#"{ "path": "v.mkv", "first": 6 }"#, None, "v.mkv: has no frame 6 (lower first)"),
    (r#"{ "path": "v.mkv", "first": 4, "count": 3 }"#, None, "v.mkv: has 2 frames from number 4 on, and 3 are wanted"),
    (r#"{ "path": "v.mkv" } "#, None, "v.mkv: its frames have 2048 pixels or more together, at most 2000 are"),
];

#[test]
fn a_video_is_a_clip_and_is_decoded_once() {
    if !has_ffmpeg("ffv1") {
        return;
    }
    let folder = folder((32, 16));
    let ffmpeg = |line: &str| {
        let mut command = Command::new("ffmpeg");
        command.args(["-v", "error", "-nostdin"]).args(line.split_whitespace()).current_dir(folder.path());
        command.output().unwrap()
    };
    let made = ffmpeg("-f lavfi -i testsrc2=size=32x16:rate=10 -frames:v 6 -c:v ffv1 v.mkv");
    assert!(made.status.success(), "{made:?}");
    let all = ffmpeg("-i v.mkv -f rawvideo -pix_fmt rgb24 -").stdout;
    let wanted: Vec<&[u8]> = all.chunks(32 * 16 * 3).collect();
    assert_eq!(wanted.len(), 6);
    fs::write(folder.path().join("no.mp4"), "no video").unwrap();
    // A list of other files is no video, whatever it is called.
    fs::write(folder.path().join("list.mp4"), "ffconcat version 1.0\nfile v.mkv\n").unwrap();
    let run = |line: &str, path: Option<&str>, cache: &str| {
        let mut command = plica(folder.path(), line);
        command.env("XDG_CACHE_HOME", folder.path().join(cache));
        path.map(|path| command.env("PATH", path));
        command.output().unwrap()
    };
    let write = |clip: &str| fs::write(folder.path().join("s.plica.json"), of_clip(clip)).unwrap();
    for (clip, frames) in SHOWN {
        write(clip);
        // The second time, there is no ffmpeg to decode it again.
        for path in [None, Some("")] {
            let done = run("render s.plica.json -o %d.png", path, "cache");
            assert!(done.status.success(), "{clip}: {done:?}");
            for (k, frame) in frames.into_iter().enumerate() {
                let shown = image::open(folder.path().join(format!("{k}.png"))).unwrap().to_rgb8();
                assert!(shown.as_raw() == wanted[frame], "{clip}: frame {k} is not {frame}");
            }
        }
    }
    for (clip, path, said) in TOLD {
        write(clip);
        let limit = if clip.ends_with(' ') { " --limit clip=2000" } else { "" };
        let line = if limit.is_empty() {
            "check s.plica.json".to_owned()
        } else {
            format!("render s.plica.json --frames 0{limit} -o x.png")
        };
        let told = run(&line, path, "other");
        let told = String::from_utf8([told.stdout, told.stderr].concat()).unwrap();
        assert!(told.contains(said) && !told.contains("@ 0x"), "{clip}: {told}");
    }
    let kept = fs::read_dir(folder.path().join("cache/plica/clips")).unwrap().count();
    assert_eq!(kept, 3, "nothing half done stays");
}
