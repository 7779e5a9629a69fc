//! Passes of scenes in space by the real binary. The numbers are read back by an EXR reader that is not ours: ffmpeg's;
//! if there is none the reason is printed, and in CI that is a failure.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod binary;

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// A square of 2 m in two triangles that faces +z; its right half is cut into triangles 2 and 3.
const SQUARE: &str = "v -1 -1 0\nv 0 -1 0\nv 1 -1 0\nv -1 1 0\nv 0 1 0\nv 1 1 0\n\
    vt 0 0\nvt 0.5 0\nvt 1 0\nvt 0 1\nvt 0.5 1\nvt 1 1\n\
    f 1/1 2/2 5/5 4/4\nf 2/2 3/3 6/6 5/5\n";

/// The camera is 2 m away and sees 2 m of height at depth 2, in 32 pixels.
const SCENE: &str = r##"{
  "plica": 1, "size": [48, 32], "background": "#0000ff", "timeline": { "duration": 1, "fps": 2 },
  "camera": { "position": [0, 0, 2], "target": [0, 0, 0], "fov": 53.13010235415598 },
  "meshes": { "square": { "path": "square.obj" } },
  "layers": [
    { "kind": "mesh", "name": "far", "mesh": "square", "light": { "ambient": 1 }, "surface": { "kind": "plain", "color": "#ff000080" } },
    { "kind": "mesh", "name": "near", "mesh": "square", "pose": { "position": [0, 0, 0.5], "scale": 0.375 }, "light": { "ambient": 1 } },
    { "kind": "fill", "name": "veil", "color": "#00000000" }
  ]
}"##;

fn run(folder: &Path, line: &str) -> Output {
    binary::plica(folder, line.split_whitespace()).output().unwrap()
}

fn good(folder: &Path, line: &str) {
    let Output { status, stderr, .. } = run(folder, line);
    assert!(status.success(), "{line}: {}", String::from_utf8_lossy(&stderr));
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("square.obj"), SQUARE).unwrap();
    fs::write(folder.path().join("s.plica.json"), SCENE).unwrap();
    folder
}

/// Red, green, blue and, if it has one, alpha of each pixel of an EXR file, as ffmpeg reads it. `None` without ffmpeg.
fn read(path: &Path, alpha: bool) -> Option<Vec<[f32; 4]>> {
    // Its own format: ffmpeg would convert to another one by whole numbers.
    let (format, planes) = if alpha { ("gbrapf32le", 4) } else { ("gbrpf32le", 3) };
    let mut command = Command::new("ffmpeg");
    command.args(["-v", "error", "-nostdin", "-i"]).arg(path).args(["-pix_fmt", format, "-f", "rawvideo", "-"]);
    let Ok(output) = command.stdin(Stdio::null()).output() else {
        assert!(std::env::var_os("CI").is_none(), "in CI there has to be an ffmpeg");
        let _ = writeln!(std::io::stderr(), "not run: there is no ffmpeg here to read OpenEXR files");
        return None;
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let floats: Vec<f32> = output.stdout.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
    let count = floats.len() / planes;
    let plane = |k: usize, i: usize| if k < planes { floats[k * count + i] } else { 0.0 };
    Some((0..count).map(|i| [2, 0, 1, 3].map(|k| plane(k, i))).collect())
}

#[test]
fn passes_have_the_numbers_of_the_nearest_surface() {
    let folder = folder();
    // The near square is 0.75 m high at depth 1.5: 16 pixels.
    let (corner, left, near) = ((2, 16), (10, 16), (20, 12));
    for (line, file, places) in [
        ("--pass depth", "depth", vec![(corner, [0.0; 3]), (left, [2.0; 3]), (near, [1.5; 3])]),
        ("--pass normal", "normal", vec![(corner, [0.0; 3]), (left, [0.0, 0.0, 1.0]), (near, [0.0, 0.0, 1.0])]),
        ("--pass object", "object", vec![(corner, [0.0; 3]), (left, [1.0; 3]), (near, [2.0; 3])]),
        ("--pass object:far", "far", vec![(corner, [0.0; 3]), (left, [1.0; 3]), (near, [1.0; 3])]),
        ("--pass depth:veil", "veil", vec![(left, [0.0; 3]), (near, [0.0; 3])]),
        (
            "--pass uv",
            "uv",
            vec![
                (corner, [0.0; 3]),
                (left, [2.5 / 32.0, 15.5 / 32.0, 2.0]),
                ((38, 15), [30.5 / 32.0, 16.5 / 32.0, 3.0]),
                ((38, 2), [30.5 / 32.0, 29.5 / 32.0, 4.0]),
            ],
        ),
    ] {
        good(folder.path(), &format!("render s.plica.json --frames 0 {line} -o {file}.exr"));
        let Some(cells) = read(&folder.path().join(format!("{file}.exr")), false) else { return };
        for ((x, y), expected) in places {
            let cell: [f32; 4] = cells[y * 48 + x];
            let far = (0..3).map(|i| (cell[i] - expected[i]).abs()).fold(0.0, f32::max);
            assert!(far < 1e-5, "{line} at {x},{y}: {cell:?} {expected:?}");
        }
    }
}

#[test]
fn color_is_light_that_lies_over_what_is_beneath() {
    let folder = folder();
    good(folder.path(), "render s.plica.json -o c-%02d.exr");
    let Some(cells) = read(&folder.path().join("c-01.exr"), true) else { return };
    let alpha = 128.0 / 255.0;
    let at = |x: usize, y: usize| cells[y * 48 + x];
    let close = |cell: [f32; 4], expected: [f32; 4]| (0..4).all(|i| (cell[i] - expected[i]).abs() < 1e-5);
    assert!(close(at(2, 2), [0.0, 0.0, 1.0, 1.0]), "{:?}", at(2, 2));
    assert!(close(at(10, 16), [alpha, 0.0, 1.0 - alpha, 1.0]), "{:?}", at(10, 16));
    // What is nearer hides what is farther, whatever its alpha.
    good(folder.path(), "render s.plica.json --frames 0 --pass color:far -o far.exr");
    let far = read(&folder.path().join("far.exr"), true).unwrap()[16 * 48 + 10];
    assert!(close(far, [alpha, 0.0, 0.0, alpha]), "{far:?}");
    let numbers = || fs::read(folder.path().join("c-00.exr")).unwrap();
    let first = numbers();
    good(folder.path(), "render s.plica.json --frames 0 -o c-%02d.exr");
    assert_eq!(numbers(), first, "the same bytes again");
}

#[test]
fn what_is_no_pass_says_what_there_is() {
    let folder = folder();
    for (line, what) in [
        ("--pass dept -o a.exr", "there is no pass \"dept\" (did you mean \"depth\"?)"),
        ("--pass depth:fra -o a.exr", "there is no layer \"fra\" (did you mean \"far\"?)"),
        ("--pass depth -o a.gif", "a pass is written as .exr or, to look at, .png (as -o a-%04d.exr)"),
        ("--pass depth --frames 0,1 -o a.exr", "2 frames do not fit one file"),
        ("--pass depth --gpu -o a-%d.exr", "--gpu is not for passes"),
        ("--pass depth -o -", "-o -: this goes to files"),
        ("--pass depth -o a-%d.jpg", "a pass is written as .exr or, to look at, .png"),
    ] {
        let Output { status, stderr, .. } = run(folder.path(), &format!("render s.plica.json {line}"));
        let said = String::from_utf8_lossy(&stderr);
        assert!(status.code() == Some(2) && said.contains(what), "{line}: {said}");
    }
    // Nothing moves: all that there is is one picture.
    for line in ["render s.plica.json --pass depth -o still.exr", "render s.plica.json -o still.png"] {
        let Output { status, stderr, .. } = run(folder.path(), line);
        let said = String::from_utf8_lossy(&stderr);
        assert!(status.success() && said.contains("nothing moves in the scene"), "{line}: {said}");
    }
    let failed = run(folder.path(), "render s.plica.json -o none/still.png");
    assert!(!String::from_utf8_lossy(&failed.stderr).contains("nothing moves"), "{failed:?}");
    good(folder.path(), "render s.plica.json --pass normal -o n-%d.png");
    assert_eq!(
        image::open(folder.path().join("n-1.png")).unwrap().to_rgba8().get_pixel(10, 16).0,
        [128, 128, 255, 255]
    );
}

#[test]
fn a_probe_is_of_what_is_seen() {
    let folder = folder();
    let probed = |line: &str| {
        let Output { status, stdout, stderr } = run(folder.path(), &format!("probe s.plica.json --json {line}"));
        assert!(status.success(), "{line}: {}", String::from_utf8_lossy(&stderr));
        serde_json::from_slice::<serde_json::Value>(&stdout).unwrap()
    };
    let near = probed("--at 20.5,12.5");
    assert_eq!((&near["layer"], &near["front"]), (&"near".into(), &true.into()));
    let close = |value: &serde_json::Value, expected: &[f64]| {
        let found: Vec<f64> = value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
        assert!(
            found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9),
            "{found:?}"
        );
    };
    close(&near["depth"], &[1.5]);
    close(&near["normal"], &[0.0, 0.0, 1.0]);
    close(&near["position"], &[-3.5 * 1.5 / 32.0, 3.5 * 1.5 / 32.0, 0.5]);
    let far = probed("--at 20.5,12.5 --layer far");
    assert_eq!((&far["layer"], &far["triangle"]), (&"far".into(), &0.into()));
    assert_eq!(probed("--at 2,2")["layer"], serde_json::Value::Null);
    // One that is outside does not keep the others from being answered, in order.
    let Output { status, stdout, stderr } =
        run(folder.path(), "probe s.plica.json --json --at 20,12 --at 48,0 --at 2,2");
    let told: Vec<serde_json::Value> =
        String::from_utf8_lossy(&stdout).lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let [first, outside, last] = told.as_slice() else { panic!("{told:?}") };
    let why = "--at 48,0: outside the picture of 48 x 32 pixels (from 0,0 to less than 48,32)";
    assert_eq!(
        (&first["layer"], outside, &last["layer"]),
        (&"near".into(), &serde_json::json!({ "error": why }), &serde_json::Value::Null)
    );
    assert!(status.code() == Some(1) && String::from_utf8_lossy(&stderr).contains(why));
    let plain = run(folder.path(), "probe s.plica.json --at 20,12 --at 48,0 --at 2,2").stdout;
    let plain = String::from_utf8_lossy(&plain).into_owned();
    assert!(plain.find("near") < plain.find(why) && plain.contains(&format!("{why}\n")), "{plain}");
}

#[test]
fn a_probe_goes_on_in_the_layer_that_a_surface_shows() {
    let folder = folder();
    let color = |x: u32| image::Rgba(if x < 2 { [255, 0, 0, 255] } else { [0, 255, 0, 255] });
    image::RgbaImage::from_fn(4, 4, |x, _| color(x)).save(folder.path().join("eye.png")).unwrap();
    let mut scene: serde_json::Value = serde_json::from_str(SCENE).unwrap();
    scene["images"] = serde_json::json!({ "eye": { "path": "eye.png" } });
    scene["layers"] = serde_json::json!([
        { "kind": "picture", "name": "eye", "image": "eye", "zones": [{ "name": "lid",
          "outline": { "kind": "rectangle", "x": 2, "y": 0, "width": 2, "height": 4 },
          "motion": [{ "tool": "translate", "by": [1, 0] }] }] },
        { "kind": "mesh", "name": "near", "mesh": "square", "light": { "ambient": 1 },
          "surface": { "kind": "layer", "layer": "eye" } },
    ]);
    fs::write(folder.path().join("s.plica.json"), scene.to_string()).unwrap();
    let probed = |line: &str| {
        let Output { status, stdout, stderr } = run(folder.path(), &format!("probe s.plica.json {line}"));
        assert!(status.success(), "{line}: {}", String::from_utf8_lossy(&stderr));
        String::from_utf8_lossy(&stdout).into_owned()
    };
    let json = |line: &str| serde_json::from_str::<serde_json::Value>(&probed(&format!("--json {line}"))).unwrap();
    // The square covers columns 8 to 40 of the frame.
    let seen = json("--at 36.5,4.5");
    let texel = serde_json::json!({ "layer": "eye", "pixel": [3, 0] });
    assert_eq!(
        (&seen["layer"], &seen["others"][0], &seen["others"][1]["zone"]),
        (&"near".into(), &texel, &"lid".into())
    );
    assert!(probed("--at 36.5,4.5").contains("\nalso: layer \"eye\"\n  pixel 3 0\nalso: zone \"lid\"\n  jump 1.000"));
    // Asked for by itself it is the layer's own pixel.
    let own = json("--at 1,0 --layer eye");
    assert_eq!((&own["zone"], &own["color"]), (&serde_json::Value::Null, &serde_json::json!([255, 0, 0, 255])));
}
