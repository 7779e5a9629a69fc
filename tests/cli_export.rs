//! The binary in a fresh folder: what it renders, writes and plots, what it prints, and what it leaves behind.

#![allow(clippy::unwrap_used, reason = "a failing test says so by a panic, in its helpers too")]

mod binary;

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

/// A folder with a scene of 6 frames, 33 x 25 pixels.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let shade = |x, y| image::Rgba([(x * 7) as u8, (y * 9) as u8, ((x * y) % 256) as u8, 255]);
    image::RgbaImage::from_fn(33, 25, shade).save(folder.path().join("cat.png")).unwrap();
    fs::write(folder.path().join("s.plica.json"), SCENE).unwrap();
    folder
}

fn plica(folder: &Path, line: &str) -> Command {
    binary::plica(folder, line.split_whitespace())
}

fn run(folder: &Path, line: &str) -> Output {
    plica(folder, line).output().unwrap()
}

/// Runs a command that must succeed and returns its standard output.
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
        ("render s.plica.json -o a.avi", "names no format"),
        ("render s.plica.json -o a.gif --start-number 1", "numbered files"),
        ("render s.plica.json -o a.gif --skip-existing", "numbered files"),
        ("render s.plica.json -o a.gif --matrix bt601", "y4m and video"),
        ("render s.plica.json -o a.y4m --matrix bt2020", "bt709"),
        (
            "render s.plica.json -o a.png",
            "6 frames do not fit one PNG (--frames 0 renders the first, a pattern such as %04d.png numbers them, .apng animates",
        ),
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
        ("synth s.plica.json -o -", "-o -: this goes to files"),
        ("demo cat -o -", "-o -: this goes to files"),
        ("render s.plica.json --size 0x0 -o a.exr", "--size is not for OpenEXR: it has the numbers"),
    ] {
        let Output { status, stderr, .. } = run(folder.path(), line);
        let said = String::from_utf8(stderr).unwrap();
        assert!(status.code() == Some(2) && said.contains(what), "{line}: {status} {said}");
    }
    let Output { status, stderr, .. } = run(folder.path(), "render s.plica.json -o none/a.gif");
    assert!(status.code() == Some(1) && String::from_utf8(stderr).unwrap().contains("folder first"));
    assert!(made(folder.path()).is_empty(), "{:?}", made(folder.path()));
}

/// Makes the scene so long that a command is interrupted long before it is done.
fn make_long(dir: &Path) {
    fs::write(dir.join("s.plica.json"), SCENE.replace("\"duration\": 0.5", "\"duration\": 5000")).unwrap();
}

/// Runs a command until `begun` accepts the files made so far, then sends it a signal.
fn ended_by(dir: &Path, signal: &str, line: &str, begun: impl Fn(&[String]) -> bool) -> Output {
    let mut child = plica(dir, line).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    while !begun(&made(dir)) {
        assert!(child.try_wait().unwrap().is_none(), "{line}: ended by itself");
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
    child.wait_with_output().unwrap()
}

fn is_hidden(name: impl AsRef<str>) -> bool {
    name.as_ref().starts_with('.')
}

#[test]
fn an_interrupt_leaves_what_was_there() {
    let folder = folder();
    let dir = folder.path();
    good(dir, "render s.plica.json -o a.webp");
    let old = fs::read(dir.join("a.webp")).unwrap();
    make_long(dir);
    for output in ["a.webp", "b.gif"] {
        // The hidden temporary file shows that it is at work.
        let line = format!("render s.plica.json -o {output}");
        let status = ended_by(dir, "-INT", &line, |made| made.iter().any(is_hidden)).status;
        assert_eq!(status.code(), Some(130), "{output}");
        assert_eq!(made(dir), ["a.webp"], "{output}");
    }
    assert!(fs::read(dir.join("a.webp")).unwrap() == old);
}

#[test]
fn finished_frames_stay_and_the_rest_is_made_later() {
    let folder = folder();
    let dir = folder.path();
    make_long(dir);
    let line = "render s.plica.json -o %05d.png";
    let Output { status, stderr, .. } = ended_by(dir, "-INT", line, |made| made.contains(&"00002.png".to_owned()));
    let said = String::from_utf8(stderr).unwrap();
    assert!(status.code() == Some(130) && said.contains("--skip-existing"), "{said}");
    let frames = made(dir);
    assert!(frames.len() >= 3 && !frames.iter().any(is_hidden), "{frames:?}");
    frames.iter().for_each(|name| assert_eq!(pixels(&dir.join(name)).0, 33, "{name}"));

    // The first is left as it is; a truncated one and one of another size are made again; the next is made.
    let first = fs::read(dir.join(&frames[0])).unwrap();
    let time = || dir.join("00000.png").metadata().unwrap().modified().unwrap();
    let before = time();
    fs::write(dir.join("00001.png"), &first[..first.len() - 4]).unwrap();
    image::RgbaImage::new(3, 3).save(dir.join("00002.png")).unwrap();
    let last = frames.len();
    let said = run(dir, &format!("render s.plica.json -o %05d.png --frames 0-{last} --skip-existing")).stderr;
    let said = String::from_utf8(said).unwrap();
    assert!(said.contains("done: %05d.png, 3 frames") && said.contains("were there already"), "{said}");
    assert!(time() == before);
    (0..=last).for_each(|k| assert_eq!(pixels(&dir.join(format!("{k:05}.png"))).0, 33, "{k}"));
    good(dir, &format!("render s.plica.json -o %05d.png --frames 0-{last} --skip-existing"));
}

#[test]
fn what_a_killed_run_left_is_told_and_cleared() {
    let folder = folder();
    let dir = folder.path();
    make_long(dir);
    ended_by(dir, "-KILL", "render s.plica.json -o a.webp", |made| made.iter().any(is_hidden));
    assert!(made(dir).iter().any(is_hidden));
    let said = run(dir, "render s.plica.json -o one.png --frames 0").stderr;
    let said = String::from_utf8(said).unwrap();
    assert!(said.contains("cleared an unfinished output"), "{said}");
    assert_eq!(made(dir), ["one.png"]);
}

#[test]
fn files_are_numbered_as_asked_and_frames_may_descend() {
    let folder = folder();
    let dir = folder.path();
    good(dir, "render s.plica.json -o f-%d.png");
    good(dir, "render s.plica.json -o g-%04d.png --frames 5-1:2 --start-number 1001");
    let frame = |name: String| pixels(&dir.join(name)).2;
    for (k, of) in [5, 3, 1].into_iter().enumerate() {
        assert!(frame(format!("g-{}.png", 1001 + k)) == frame(format!("f-{of}.png")), "{k}");
    }
    assert_eq!(made(dir).len(), 9);
    let back = good(dir, "render s.plica.json -o - --format rgba --frames 5-0");
    let frames: Vec<u8> = (0..6).rev().flat_map(|k| frame(format!("f-{k}.png"))).collect();
    assert!(back == frames);
}

#[test]
fn no_output_replaces_what_the_scene_reads() {
    let folder = folder();
    let dir = folder.path();
    fs::create_dir(dir.join("sub")).unwrap();
    std::os::unix::fs::symlink("cat.png", dir.join("link.png")).unwrap();
    std::os::unix::fs::symlink("../cat.png", dir.join("sub/colour.png")).unwrap();
    fs::hard_link(dir.join("cat.png"), dir.join("0003.png")).unwrap();
    fs::hard_link(dir.join("s.plica.json"), dir.join("hard.csv")).unwrap();
    let (picture, scene) = (fs::read(dir.join("cat.png")).unwrap(), fs::read(dir.join("s.plica.json")).unwrap());
    for line in [
        "render s.plica.json --frames 1 -o cat.png",
        "render s.plica.json --frames 1 -o cat.png --force",
        "render s.plica.json --frames 1 -o ./sub/../cat.png --force",
        "render s.plica.json --frames 1 -o link.png --force",
        "render s.plica.json -o %04d.png --force",
        "render s.plica.json -o %04d.png --frames 0 --start-number 3 --force",
        "render s.plica.json --frames 0-3 -o %04d.png --skip-existing --force",
        "field s.plica.json -o cat.png --force",
        "field s.plica.json -o link.png --force",
        "field s.plica.json -o hard.csv --force",
        "synth s.plica.json -o sub --force",
        "synth s.plica.json -o cat.png --force",
        "--log cat.png check s.plica.json",
        "--log s.plica.json check s.plica.json",
        "new cat.png -o cat.png",
        "new cat.png -o sub/cat.png",
    ] {
        let Output { status, stderr, .. } = run(dir, line);
        let said = String::from_utf8(stderr).unwrap();
        assert!(status.code() == Some(1) && !said.contains("done"), "{line}: {status} {said}");
        assert!(fs::read(dir.join("cat.png")).unwrap() == picture, "{line}");
        assert!(fs::read(dir.join("s.plica.json")).unwrap() == scene, "{line}");
        assert_eq!(made(dir), ["0003.png", "hard.csv", "link.png", "sub"], "{line}");
    }
}

#[test]
fn nor_does_the_editor_replace_what_its_scene_reads() {
    let folder = folder();
    let dir = folder.path();
    let picture = fs::read(dir.join("cat.png")).unwrap();
    image::RgbaImage::new(33, 25).save(dir.join("dog.png")).unwrap();
    let dog = fs::read(dir.join("dog.png")).unwrap();
    fs::create_dir(dir.join("home")).unwrap();
    for (lines, refused) in [
        ("render --frames 0 -o cat.png --force", true),
        ("render --frames 0 -o ./cat.png", true),
        ("field -o cat.png --force", true),
        ("log cat.png", true),
        ("w cat.png", true),
        ("w .s.journal", true),
        // A picture that is only in the unsaved scene, and one that is only in its file.
        ("set images.cat.path=dog.png\nrender --frames 0 -o dog.png --force\nq!", true),
        ("set images.cat.path=dog.png\nrender --frames 0 -o cat.png --force\nq!", true),
        ("render --frames 0 -o ~/one.png", false),
        ("synth --output=~/out", false),
        ("w ~/copy.plica.json", false),
    ] {
        fs::write(dir.join("lines"), lines).unwrap();
        let output = plica(dir, "edit s.plica.json --script lines --after-recovery drop")
            .env("HOME", dir.join("home"))
            .output()
            .unwrap();
        let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        let told = ["no output may replace", "is there already", "journal"].iter().any(|part| said.contains(part));
        assert_eq!((told, output.status.success()), (refused, !refused), "{lines}: {said}");
        assert!(fs::read(dir.join("cat.png")).unwrap() == picture, "{lines}");
        assert!(fs::read(dir.join("dog.png")).unwrap() == dog, "{lines}");
    }
    for name in ["one.png", "out/manifest.json", "copy.plica.json"] {
        assert!(dir.join("home").join(name).is_file(), "{name}");
    }
}

#[test]
fn other_files_are_replaced_by_their_kind_or_by_force() {
    let folder = folder();
    let dir = folder.path();
    for (output, more) in [
        ("a.gif", " --frames 0"),
        ("a.webp", ""),
        ("a.apng", ""),
        ("a.png", " --frames 0"),
        ("a.y4m", ""),
        ("a.rgba", ""),
    ] {
        fs::write(dir.join(output), "my only words").unwrap();
        let line = format!("render s.plica.json -o {output}{more}");
        let Output { status, stderr, .. } = run(dir, &line);
        let said = String::from_utf8(stderr).unwrap();
        assert!(status.code() == Some(1) && said.contains("--force"), "{line}: {said}");
        assert_eq!(fs::read(dir.join(output)).unwrap(), b"my only words");
        good(dir, &format!("{line} --force"));
        good(dir, &line); // over its own kind
    }
    for output in ["f.csv", "f.svg", "f.png"] {
        fs::write(dir.join(output), "my only words").unwrap();
        assert_eq!(run(dir, &format!("field s.plica.json -o {output}")).status.code(), Some(1));
        good(dir, &format!("field s.plica.json -o {output} --force"));
        good(dir, &format!("field s.plica.json -o {output}"));
    }
}

#[test]
fn textures_of_an_earlier_run_go_and_others_stay() {
    let folder = folder();
    let dir = folder.path();
    good(dir, "synth s.plica.json -o out");
    fs::write(dir.join("out/mine.txt"), "mine").unwrap();
    fs::write(dir.join("s.plica.json"), SCENE.replace("left eye", "nose")).unwrap();
    let done = String::from_utf8(run(dir, "synth s.plica.json -o out --depth 16").stderr).unwrap();
    assert!(done.contains("done: out, 6 files, "), "{done}");
    let names = |folder: &str| {
        let names = fs::read_dir(dir.join(folder)).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<_> = names.collect();
        names.sort();
        names
    };
    let wanted = [
        "colour.png",
        "function.png",
        "manifest.json",
        "mine.txt",
        "nose-init.png",
        "nose-jump.png",
        "nose-thresholds.png",
    ];
    assert_eq!(names("out"), wanted);
    // A person's own file with such a name.
    fs::create_dir(dir.join("other")).unwrap();
    for name in ["colour.png", "nose-init.exr", "nose-2-jump.exr", "manifest.json"] {
        fs::write(dir.join("other").join(name), "mine").unwrap();
        let Output { status, stderr, .. } = run(dir, "synth s.plica.json -o other");
        let said = String::from_utf8(stderr).unwrap();
        assert!(status.code() == Some(1) && said.contains(name) && said.contains("--force"), "{name}: {said}");
        assert_eq!(names("other"), [name]);
        fs::remove_file(dir.join("other").join(name)).unwrap();
    }
    fs::write(dir.join("other/colour.png"), "mine").unwrap();
    good(dir, "synth s.plica.json -o other --force");
    assert_eq!(names("other").len(), 6);
}

#[test]
fn textures_have_names_that_every_file_system_takes() {
    let folder = folder();
    let dir = folder.path();
    let mut scene: serde_json::Value = serde_json::from_str(SCENE).unwrap();
    let zone = scene["layers"][0]["zones"][0].clone();
    let names = ["left eye".to_owned(), "Left Eye".into(), "LEFT-eye".into(), "猫".repeat(90), "猫".repeat(91)];
    let zones = names.iter().map(|name| {
        let mut zone = zone.clone();
        zone["name"] = name.as_str().into();
        zone
    });
    scene["layers"][0]["zones"] = zones.collect();
    fs::write(dir.join("s.plica.json"), scene.to_string()).unwrap();
    for _ in 0..2 {
        good(dir, "synth s.plica.json -o out");
        let files = fs::read_dir(dir.join("out")).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
        let files: Vec<String> = files.map(|name| name.to_lowercase()).collect();
        assert_eq!(files.iter().collect::<std::collections::BTreeSet<_>>().len(), 3 * names.len() + 3, "{files:?}");
        assert!(files.iter().all(|name| name.len() < 230), "{files:?}");
    }
    let manifest = fs::read_to_string(dir.join("out/manifest.json")).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&manifest).unwrap();
    let zones = manifest["layers"][0]["zones"].as_array().unwrap();
    assert!(zones.iter().zip(&names).all(|(zone, name)| zone["name"] == name.as_str()), "{zones:?}");
}

#[test]
fn a_scene_that_has_nothing_to_write_says_so() {
    let folder = folder();
    let dir = folder.path();
    fs::write(dir.join("s.plica.json"), r#"{"plica": 1, "layers": [{"kind": "fill", "name": "ground"}]}"#).unwrap();
    for (line, said) in [
        ("field s.plica.json -o a.svg", "no layer has a vector field"),
        ("field s.plica.json -o a.svg --zone x", "the scene has no zones"),
        ("synth s.plica.json -o out", "no layer has textures"),
        ("synth s.plica.json -o out", "out, 1 file"),
        ("synth s.plica.json -o out --bake 64", "--bake: no layer shows a view map (leave it out)"),
    ] {
        let stderr = String::from_utf8(run(dir, line).stderr).unwrap();
        assert!(stderr.contains(said) && !stderr.contains("1 files"), "{line}: {stderr}");
    }
}

#[test]
fn what_cannot_be_written_has_its_cure() {
    let folder = folder();
    let dir = folder.path();
    for name in ["full.gif", "full.webp", "full.apng", "full.rgba", "full.csv", "f3.png"] {
        std::os::unix::fs::symlink("/dev/full", dir.join(name)).unwrap();
    }
    let fifo = |name: &str| {
        rustix::fs::mknodat(rustix::fs::CWD, dir.join(name), rustix::fs::FileType::Fifo, rustix::fs::Mode::RWXU, 0)
            .unwrap();
    };
    ["p.png", "p.gif", "p.csv", "q0.png"].into_iter().for_each(fifo);
    let (room, fifo) =
        ("cannot be written: No space left on device", "is a FIFO that nobody reads (let another program");
    for (line, place, wanted, cure) in [
        ("render s.plica.json -o full.gif", "full.gif", room, "(make room, then try again)"),
        ("render s.plica.json -o full.webp", "full.webp", room, "(make room, then try again)"),
        ("render s.plica.json -o full.apng", "full.apng", room, "(make room, then try again)"),
        ("render s.plica.json -o full.rgba", "full.rgba", room, "(make room, then try again)"),
        ("render s.plica.json -o f%d.png", "f3.png", room, "(make room, then try again)"),
        ("field s.plica.json -o full.csv", "full.csv", room, "(make room, then try again)"),
        ("render s.plica.json --frames 0 -o p.png", "p.png", fifo, "or name a file)"),
        ("render s.plica.json -o p.gif", "p.gif", fifo, "or name a file)"),
        ("render s.plica.json -o q%d.png --skip-existing", "q0.png", fifo, "or name a file)"),
        ("field s.plica.json -o p.csv", "p.csv", fifo, "or name a file)"),
        ("synth s.plica.json -o no/out", "no/out", "cannot be written", "(make the folder first)"),
    ] {
        let Output { status, stderr, .. } = run(dir, line);
        let said = String::from_utf8(stderr).unwrap();
        let told = said.lines().any(|line| line.contains(&format!("{place}: {wanted}")) && line.ends_with(cure));
        assert!(status.code() == Some(1) && told, "{line}: {said}");
    }
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let said = plica(dir, "render s.plica.json -o - --format rgba").stdout(full).output().unwrap().stderr;
    let said = String::from_utf8(said).unwrap();
    assert!(said.contains(room) && said.contains("(make room, then try again)"), "{said}");
}

#[test]
fn the_limit_on_memory_counts_all_that_a_render_keeps() {
    let folder = folder();
    let dir = folder.path();
    let shade = |x, y| image::Rgba([(x % 256) as u8, (y % 256) as u8, 9, 255]);
    image::RgbaImage::from_fn(600, 400, shade).save(dir.join("cat.png")).unwrap();
    let pixels: u64 = 600 * 400;
    // The picture; the frame as colors and as light; the frame that is packed, or those that wait for their palette.
    let (picture, frame, packed, waiting) = (4 * pixels, 20 * pixels, 8 * pixels, 60 * pixels);
    for (line, memory, refused) in [
        (
            "render s.plica.json --frames 0 -o a.png",
            picture + frame - 1,
            Some("frames: needs 4.6 MiB of memory besides"),
        ),
        (
            "render s.plica.json --frames 0 -o a.png",
            picture + frame + packed - 1,
            Some("a.png: needs 1.8 MiB of memory besides"),
        ),
        ("render s.plica.json --frames 0 -o a.png", picture + frame + packed + (64 << 10), None),
        ("render s.plica.json -o a.gif", picture + frame + waiting - 1, Some("a.gif: needs 14 MiB of memory besides")),
    ] {
        let Output { status, stderr, .. } = run(dir, &format!("{line} --limit memory={memory}"));
        let said = String::from_utf8(stderr).unwrap();
        assert_eq!(status.success(), refused.is_none(), "{line}: {said}");
        assert!(
            refused.is_none_or(|words| said.contains(words) && said.contains("(make it smaller, or")),
            "{line}: {said}"
        );
    }
    assert_eq!(made(dir), ["a.png"]);
}

#[test]
fn what_is_done_is_told_with_its_size_and_time() {
    let folder = folder();
    let dir = folder.path();
    for (line, what) in [
        ("render s.plica.json -o a.webp", "done: a.webp, "),
        ("render s.plica.json -o - --format rgba", "done: standard output, 6 frames, 19.8 kB, "),
        ("render s.plica.json -o %d.png", "done: %d.png, 6 frames, "),
        ("synth s.plica.json -o out", "done: out, 6 files, "),
        ("field s.plica.json -o f.csv", "done: f.csv, "),
    ] {
        let Output { status, stderr, .. } = run(dir, line);
        let said = String::from_utf8(stderr).unwrap();
        assert!(
            status.success() && said.lines().any(|line| line.starts_with(what)) && said.ends_with(" s\n"),
            "{line}: {said}"
        );
    }
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
