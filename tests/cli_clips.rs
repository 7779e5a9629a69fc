//! Scenes of clips on the command line: making one, checking it, and what a pixel shows of it.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails, in its helpers too")]

mod binary;

use std::path::Path;

use image::{Rgb, RgbImage};
use serde_json::{Value, json};

/// What a run printed, and its messages.
fn plica(folder: &Path, args: &[&str], succeeds: bool) -> (String, String) {
    let output = binary::plica(folder, args).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    let (out, messages) = (text(output.stdout), text(output.stderr));
    assert_eq!(output.status.success(), succeeds, "{args:?}: {out}{messages}");
    (out, messages)
}

fn get(folder: &Path, scene: &str, path: &str) -> Value {
    serde_json::from_str(&plica(folder, &["get", scene, path], true).0).unwrap()
}

/// Writes frames in which a pattern falls by so many pixels a frame.
fn clip(folder: &Path, numbers: std::ops::Range<u32>, speed: u32) {
    std::fs::create_dir_all(folder).unwrap();
    for number in numbers {
        let shade = |x: u32, y: u32| {
            let (x, y) = (x / 4, (y + 1000 - speed * number) / 4);
            Rgb([(x.wrapping_mul(2_654_435_761).wrapping_add(y.wrapping_mul(2_246_822_519)) >> 13) as u8; 3])
        };
        RgbImage::from_fn(96, 96, shade).save(folder.join(format!("{number:04}.png"))).unwrap();
    }
}

#[test]
fn a_clip_becomes_a_scene_by_its_pattern_and_by_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    clip(&at("falls"), 2..14, 3);
    std::fs::create_dir(at("to")).unwrap();
    for (args, scene, path) in [
        (&["new", "falls/%04d.png", "-o", "a.plica.json"][..], "a.plica.json", "falls/%04d.png"),
        (&["new", "falls"], "falls.plica.json", "falls/%04d.png"),
        (&["new", "falls/%04d.png"], "falls/falls.plica.json", "%04d.png"),
        (&["new", "falls", "-o", "to/a.plica.json"], "to/a.plica.json", "falls/%04d.png"),
    ] {
        assert_eq!(plica(folder.path(), args, true).0, format!("{scene}\n"));
        assert_eq!(get(folder.path(), scene, "clips"), json!({ "falls": { "path": path, "first": 2 } }));
        let layer = json!([{ "kind": "waterfall", "name": "falls", "clip": "falls" }]);
        assert_eq!(get(folder.path(), scene, "layers"), layer);
        assert_eq!(get(folder.path(), scene, "camera"), json!({}));
        plica(folder.path(), &["check", scene], true);
    }
    assert!(at("to/falls/0013.png").is_file() && !at("falls/falls").exists());
    plica(&at("to"), &["set", "a.plica.json", "size=[48, 32]"], true);
    plica(&at("to"), &["render", "a.plica.json", "--frames", "1", "-o", "a.png"], true);
}

#[test]
fn what_is_no_clip_is_refused_with_the_cure() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    clip(&at("gap"), 0..12, 3);
    clip(&at("gap"), 20..21, 3);
    clip(&at("broken"), 0..3, 3);
    std::fs::write(at("broken/0001.png"), "no picture").unwrap();
    std::fs::create_dir(at("none")).unwrap();
    for (args, told, succeeds) in [
        (["new", "none"], "none: holds no numbered pictures (name them as 0001.png", false),
        (["new", "none/%04d.png"], "there is no such file", false),
        (["new", "broken"], "broken: 0001.png", false),
        (
            ["new", "gap"],
            "gap: ends at 0011.png, but 0020.png is there (put 0012.png there, or set the clip's count to 12)",
            true,
        ),
    ] {
        let (_, messages) = plica(folder.path(), &args, succeeds);
        assert!(messages.contains(told), "{args:?}: {messages}");
    }
    assert!(!at("broken.plica.json").exists());
}

#[test]
fn a_short_or_small_clip_gets_a_layer_that_fits_it() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    clip(&at("short"), 0..4, 3);
    clip(&at("two"), 0..2, 3);
    clip(&at("small"), 0..12, 3);
    for number in 0..12 {
        let file = at("small").join(format!("{number:04}.png"));
        image::imageops::crop_imm(&image::open(&file).unwrap(), 8, 8, 40, 88).to_image().save(&file).unwrap();
    }
    for (name, fits, told) in [
        (
            "short",
            json!({ "keys": 4, "step": 1 }),
            "short: has 4 frames of 96 x 96: its layer begins with {\"sprites\":",
        ),
        ("two", json!({ "keys": 2, "step": 1 }), "two: has 2 frames"),
        ("small", json!({ "size": 32 }), "small: has 12 frames of 40 x 88"),
    ] {
        let (_, messages) = plica(folder.path(), &["new", name], true);
        assert!(messages.contains(told), "{name}: {messages}");
        let scene = format!("{name}.plica.json");
        assert_eq!(get(folder.path(), &scene, "layers.0.sprites"), fits);
        plica(folder.path(), &["check", &scene], true);
    }
    std::fs::remove_file(at("two/0001.png")).unwrap();
    let (_, messages) = plica(folder.path(), &["new", "two/%04d.png", "-o", "one.plica.json"], true);
    assert!(
        messages.contains("nothing moves in 0000.png alone (put") && messages.contains("has 1 frame of"),
        "{messages}"
    );
    plica(folder.path(), &["check", "one.plica.json"], true);
}

#[test]
fn a_scene_without_a_camera_is_given_one() {
    let folder = tempfile::tempdir().unwrap();
    clip(&folder.path().join("falls"), 0..12, 3);
    plica(folder.path(), &["new", "falls"], true);
    plica(folder.path(), &["set", "falls.plica.json", "camera=null"], true);
    let told = "the scene has no camera (set camera={}, or in the editor :camera fit, which sees everything)";
    for args in [&["check", "falls.plica.json"][..], &["render", "falls.plica.json", "--frames", "0", "-o", "a.png"]] {
        let (out, messages) = plica(folder.path(), args, false);
        assert!(format!("{out}{messages}").contains(told), "{args:?}: {out}{messages}");
    }
    plica(folder.path(), &["set", "falls.plica.json", "camera={}"], true);
    plica(folder.path(), &["check", "falls.plica.json"], true);
}

#[test]
fn what_cannot_be_changed_or_is_not_there_is_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    clip(&folder.path().join("falls"), 0..12, 3);
    plica(folder.path(), &["new", "falls"], true);
    let scene = "falls.plica.json";
    let input = "what is changed has to be a file: - is standard input, which is only read";
    let unknown = "there is no layer \"nope\" (there is \"falls\")";
    for (args, told) in [
        (&["sprites", "-", "--take"][..], input),
        (&["profile", "apply", "smoke", "-"], input),
        (&["set", "-", "title=x"], input),
        (&["sprites", scene, "-o", "falls"], "falls: holds a clip of falls.plica.json: no output may replace it"),
        (&["sprites", scene, "-o", "out", "--layer", "nope"], unknown),
        (&["lines", scene, "--layer", "nope"], unknown),
        (&["probe", scene, "--at", "1,1", "--layer", "nope"], unknown),
        (&["profile", "apply", "smoke", scene, "--layer", "nope"], unknown),
    ] {
        let (out, messages) = plica(folder.path(), args, false);
        assert!(out.is_empty() && messages.contains(told), "{args:?}: {messages}");
        assert_eq!(messages.trim_end().lines().count(), 1, "{args:?}: {messages}");
    }
}

#[test]
fn a_script_waits_for_the_clip_and_its_log_replays() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    clip(&at("falls"), 0..12, 3);
    plica(folder.path(), &["new", "falls"], true);
    let start = std::fs::read(at("falls.plica.json")).unwrap();
    let picks = "go layers.falls.sprites\nclip show\ncursor at 0 40\npick add\nclip last\npick foam\nw\n";
    let edited = |lines: &str, by_script: bool| {
        std::fs::write(at("falls.plica.json"), &start).unwrap();
        std::fs::write(at("lines"), lines).unwrap();
        let mut command = binary::plica(folder.path(), ["edit", "falls.plica.json"]);
        if by_script {
            command.args(["--script", "lines"]);
        } else {
            command.stdin(std::fs::File::open(at("lines")).unwrap());
        }
        let output = command.output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        get(folder.path(), "falls.plica.json", "layers.0.sprites.picks")
    };
    let first = json!([
        { "frame": 0, "at": [32, 40], "kind": "water" },
        { "frame": 11, "at": [32, 40], "kind": "foam", "track": false }
    ]);
    assert_eq!(edited(picks, false), first);
    assert_eq!(edited(picks, true), first);
    assert!(edited("sprites take\nw\n", false).as_array().is_some_and(|picks| picks.len() > 1));
}

#[test]
fn a_check_finds_a_clip_in_which_nothing_moves() {
    let folder = tempfile::tempdir().unwrap();
    clip(&folder.path().join("ice"), 0..12, 0);
    let (_, messages) = plica(folder.path(), &["new", "ice"], true);
    assert!(messages.contains("its layer begins with {\"sprites\":{\"picks\":[{\"frame\":0"), "{messages}");
    plica(folder.path(), &["check", "ice.plica.json"], true);
    plica(folder.path(), &["set", "ice.plica.json", "layers.ice.sprites=null"], true);
    let (out, _) = plica(folder.path(), &["check", "ice.plica.json"], false);
    let told = "layers.ice.clip: nothing moves in the clip \"ice\": pick sprites by hand (sprites.picks)";
    assert!(out.contains(told), "{out}");
}

#[test]
fn a_probe_tells_of_every_layer_of_sprites() {
    let folder = tempfile::tempdir().unwrap();
    clip(&folder.path().join("falls"), 0..14, 3);
    plica(folder.path(), &["new", "falls"], true);
    let second = json!({ "kind": "waterfall", "name": "mist", "clip": "falls" });
    let size = json!([64, 64]);
    let layers = json!([get(folder.path(), "falls.plica.json", "layers.falls"), second]);
    let settings = [format!("layers={layers}"), format!("size={size}")];
    plica(folder.path(), &["set", "falls.plica.json", &settings[0], &settings[1]], true);
    let probe =
        |more: &[&str]| plica(folder.path(), &[&["probe", "falls.plica.json", "--at", "32,32"], more].concat(), true).0;
    let told: Value = serde_json::from_str(&probe(&["--json"])).unwrap();
    let other = &told["others"][0];
    for (layer, name) in [(&told, "falls"), (other, "mist")] {
        let sprites = layer["sprites"].as_array().unwrap();
        assert_eq!((&layer["layer"], sprites.len()), (&json!(name), 8));
        assert!(layer["count"].as_u64().unwrap() > 8 && layer["listed"] == 8, "{layer}");
        assert!(sprites.iter().all(|sprite| sprite["layer"] == name && sprite["width_px"].is_number()), "{layer}");
    }
    let words = probe(&[]);
    assert!(words.contains("\nalso: layer \"mist\"\n  sprites "), "{words}");
    let one: Value = serde_json::from_str(&probe(&["--json", "--layer", "mist"])).unwrap();
    assert_eq!((&one["sprites"], one.get("others")), (&other["sprites"], None));
}
