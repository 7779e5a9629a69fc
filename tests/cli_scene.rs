//! The commands that make, read and change scenes: the real program in a fresh folder.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails, in its helpers too")]

mod binary;

use std::path::Path;
use std::process::Output;

use image::RgbaImage;
use plica::files::Options;
use plica::files::session::{Mode, Session};
use plica::scene::Edit;

/// The result of one run.
#[derive(Debug, PartialEq)]
struct Ran {
    status: i32,
    out: String,
    messages: String,
}

fn plica(folder: &Path, args: &[&str]) -> Ran {
    let Output { status, stdout, stderr } = binary::plica(folder, args).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    Ran { status: status.code().unwrap(), out: text(stdout), messages: text(stderr) }
}

/// A folder with a picture of 8 x 6 pixels.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    RgbaImage::new(8, 6).save(folder.path().join("cat.png")).unwrap();
    folder
}

fn ok(ran: Ran) -> String {
    assert_eq!(ran.status, 0, "{ran:?}");
    ran.out
}

#[test]
fn nothing_is_the_short_help() {
    let folder = folder();
    let help = ok(plica(folder.path(), &[]));
    assert!(help.contains("Usage: plica") && help.contains("Examples:"), "{help}");
    assert_eq!(plica(folder.path(), &["frobnicate"]).status, 2);
}

const BY_HAND: &str = concat!(
    "{ \"title\" : \"by hand\", \"plica\": 1,\r\n\t\"timeline\": { \"fps\": 1e1, \"duration\": 2.50 },\r\n",
    "  \"images\": {\"cat\":{\"path\":\"cat.png\"}}}"
);

/// A folder with a scene that somebody wrote by hand.
fn by_hand() -> tempfile::TempDir {
    let folder = folder();
    std::fs::write(folder.path().join("cat.plica.json"), BY_HAND).unwrap();
    folder
}

fn saved(folder: &tempfile::TempDir) -> String {
    std::fs::read_to_string(folder.path().join("cat.plica.json")).unwrap()
}

#[test]
fn set_changes_what_it_sets_and_nothing_else() {
    let folder = by_hand();
    ok(plica(folder.path(), &["set", "cat.plica.json", "timeline.fps=12"]));
    assert_eq!(saved(&folder), BY_HAND.replace("1e1", "12"));
    ok(plica(folder.path(), &["set", "cat.plica.json", "title=other", "timeline.fps=12.5"]));
    assert_eq!(saved(&folder), BY_HAND.replace("1e1", "12.5").replace("by hand", "other"));
    let refused = plica(folder.path(), &["set", "cat.plica.json", "plica=2"]);
    assert_eq!((refused.status, refused.messages.contains("cannot be edited")), (1, true), "{refused:?}");
    assert_eq!(saved(&folder), BY_HAND.replace("1e1", "12.5").replace("by hand", "other"));
}

#[test]
fn set_leaves_protected_files_alone_and_hard_links_together() {
    use std::os::unix::fs::{MetadataExt, PermissionsExt};
    let folder = by_hand();
    let (scene, other) = (folder.path().join("cat.plica.json"), folder.path().join("other"));
    std::fs::hard_link(&scene, &other).unwrap();
    ok(plica(folder.path(), &["set", "cat.plica.json", "title=x"]));
    assert_eq!((scene.metadata().unwrap().nlink(), std::fs::read_to_string(&other).unwrap()), (2, saved(&folder)));
    std::fs::set_permissions(&scene, std::fs::Permissions::from_mode(0o444)).unwrap();
    let before = saved(&folder);
    let refused = plica(folder.path(), &["set", "cat.plica.json", "title=y"]);
    assert_eq!((refused.status, refused.messages.contains("is read-only")), (1, true), "{refused:?}");
    assert_eq!(saved(&folder), before);
    let session = Session::open(&scene, &Options::default(), Mode::Edit).unwrap();
    assert_eq!(session.recovery(), None, "nothing is left behind");
}

#[test]
fn many_sets_at_once_wait_for_each_other() {
    let folder = by_hand();
    std::thread::scope(|scope| {
        for name in ["a", "b", "c", "d", "e", "f"] {
            let folder = folder.path();
            let setting = format!("images.{name}={{\"path\": \"cat.png\"}}");
            scope.spawn(move || ok(plica(folder, &["set", "cat.plica.json", &setting])));
        }
    });
    let images = ok(plica(folder.path(), &["get", "cat.plica.json", "images"]));
    let images: serde_json::Value = serde_json::from_str(&images).unwrap();
    assert_eq!(images.as_object().unwrap().len(), 7, "{images}");
}

#[test]
fn set_asks_what_becomes_of_unsaved_edits_and_keeps_them_until_then() {
    for (answer, title) in [("keep", "precious"), ("drop", "by hand")] {
        let folder = by_hand();
        let path = folder.path().join("cat.plica.json");
        let open = || Session::open(&path, &Options::default(), Mode::Edit).unwrap();
        let mut session = open();
        let patch = serde_json::json!([{ "op": "replace", "path": "/title", "value": "precious" }]);
        session.apply(Edit(serde_json::from_value(patch).unwrap()), false).unwrap();
        drop(session);
        let refused = plica(folder.path(), &["set", "cat.plica.json", "timeline.fps=5"]);
        assert_eq!(refused.status, 1);
        assert!(refused.messages.contains("1 unsaved change was left behind"), "{refused:?}");
        assert!(refused.messages.contains("--after-recovery"), "{refused:?}");
        assert_eq!((open().recovery().map(|offer| offer.changes), saved(&folder).as_str()), (Some(1), BY_HAND));
        ok(plica(folder.path(), &["set", "cat.plica.json", "timeline.fps=5", "--after-recovery", answer]));
        assert_eq!(saved(&folder), BY_HAND.replace("1e1", "5").replace("by hand", title));
        assert_eq!(open().recovery(), None);
    }
}

#[test]
fn profiles_are_listed_shown_and_applied() {
    let folder = folder();
    let list = ok(plica(folder.path(), &["profile", "list"]));
    assert!(list.lines().any(|line| line.starts_with("waterfall   smoke       smoke that rises")), "{list}");
    let shown = plica(folder.path(), &["profile", "show", "cloud"]);
    assert_eq!(shown.messages, "cloud wants a timeline of 12 s (timeline.duration=12)\n");
    let patch: serde_json::Value = serde_json::from_str(&shown.out).unwrap();
    assert_eq!(patch["foam"]["lines"], 0);
    let layer = |name| serde_json::json!({ "kind": "waterfall", "name": name, "clip": "c" });
    let layers = [serde_json::json!({ "kind": "fill", "name": "sky" }), layer("a"), layer("b")];
    let clips = serde_json::json!({ "c": { "path": "%d.png" } });
    let scene = serde_json::json!({ "plica": 1, "camera": {}, "clips": clips, "layers": layers });
    std::fs::write(folder.path().join("s.json"), scene.to_string()).unwrap();
    let apply = |more: &[&str]| plica(folder.path(), &[&["profile", "apply"], more].concat());
    let applied = apply(&["cloud", "s.json", "--layer", "b"]);
    let told = "cloud is applied to b; it wants a timeline of 12 s (timeline.duration=12)\n";
    assert_eq!((applied.status, applied.messages.as_str()), (0, told));
    assert_eq!(ok(plica(folder.path(), &["get", "s.json", "layers.b.life"])), "12\n");
    assert_ne!(ok(plica(folder.path(), &["get", "s.json", "layers.a.gravity"])), "0\n");
    ok(apply(&["smoke", "s.json"]));
    assert_eq!(ok(plica(folder.path(), &["get", "s.json", "layers.a.gravity"])), "-1.2\n");
    for (args, told) in [
        (&["smok", "s.json"][..], "did you mean \"smoke\"?"),
        (&["smoke", "s.json", "--layer", "c"], "s.json: there is no layer \"c\""),
        (&["smoke", "s.json", "--layer", "sky"], "s.json: smoke is for layers of kind waterfall; sky is of kind fill"),
    ] {
        let refused = apply(args);
        assert!(refused.status != 0 && refused.messages.contains(told), "{refused:?}");
    }
}

#[test]
fn new_makes_a_scene_and_never_overwrites() {
    let folder = folder();
    assert_eq!(ok(plica(folder.path(), &["new", "cat.png"])), "cat.plica.json\n");
    let outline = "layers.cat.zones.all.outline";
    let outline = ok(plica(folder.path(), &["get", "cat.plica.json", outline]));
    let outline: serde_json::Value = serde_json::from_str(&outline).unwrap();
    assert_eq!(outline, serde_json::json!({ "kind": "rectangle", "x": 0, "y": 0, "width": 8, "height": 6 }));
    let again = plica(folder.path(), &["new", "cat.png"]);
    assert_eq!(again.status, 1);
    assert!(again.messages.contains("is there already"), "{again:?}");
    // Nothing moves yet, which a check reports.
    let strict = plica(folder.path(), &["check", "cat.plica.json"]);
    assert!(strict.status == 1 && strict.out.contains("nothing moves"), "{strict:?}");
    assert!(ok(plica(folder.path(), &["check", "--lenient", "cat.plica.json"])).contains("nothing moves"));
}

#[test]
fn new_takes_a_layer_of_a_picture_and_names_its_cures() {
    use exr::prelude::*;
    let folder = folder();
    let channel = |name: &&str| AnyChannel::new(*name, FlatSamples::F32(vec![0.5]));
    let channels = AnyChannels::sort(["near.u", "near.v", "far.u", "far.v"].iter().map(channel).collect());
    Image::from_channels((1, 1), channels).write().to_file(folder.path().join("f.exr")).unwrap();
    let run = |name: &str| plica(folder.path(), &["new", name]);
    assert!(run("f.exr").messages.contains("has several layers: far, near (name one, as f.exr#far)"));
    assert_eq!(ok(run("f.exr#far")), "f.plica.json\n");
    assert_eq!(ok(plica(folder.path(), &["get", "f.plica.json", "images"])).matches("f.exr#far").count(), 1);
    assert!(ok(plica(folder.path(), &["check", "f.plica.json", "--lenient"])).contains("nothing moves"));
    ok(plica(folder.path(), &["new", "f.exr#far", "f.exr#near", "-o", "both.plica.json"]));
    assert!(ok(plica(folder.path(), &["get", "both.plica.json", "images.f-near.path"])).contains("f.exr#near"));
    std::fs::create_dir(folder.path().join("other")).unwrap();
    ok(plica(folder.path(), &["new", "f.exr#near", "-o", "other/copy.plica.json"]));
    assert!(folder.path().join("other/f.exr").exists());
    let long = format!("{}.png", "x".repeat(245));
    let red = "red\u{1b}[31m.png";
    for name in [long.as_str(), red] {
        std::fs::copy(folder.path().join("cat.png"), folder.path().join(name)).unwrap();
    }
    for (name, wanted) in [
        (
            "cat.png#x",
            "cat.png#x: there is no such file, and only an OpenEXR has layers to name after a # (leave #x out)",
        ),
        ("f.exr#", "f.exr#: has no name of a layer after the # (name the layer, or leave the # out)"),
        ("no.exr#x", "no.exr#x: there is no such file"),
        ("f.exr#middle", "has no layer middle"),
        (&long, "is too long a name for a file (name the scene with -o)"),
        (red, "has control characters in its name (rename it)"),
    ] {
        let fresh = ["new", name, "-o", "fresh.plica.json"];
        let refused = plica(folder.path(), if name == long { &fresh[..2] } else { &fresh });
        assert_eq!((refused.status, refused.messages.lines().count()), (1, 1), "{refused:?}");
        assert!(refused.messages.contains(wanted), "{refused:?}");
    }
    ok(plica(folder.path(), &["new", &long, "-o", "long.plica.json"]));
}

#[test]
fn new_copies_pictures_of_other_folders() {
    let folder = folder();
    let scenes = folder.path().join("scenes");
    std::fs::create_dir(&scenes).unwrap();
    ok(plica(folder.path(), &["new", "cat.png", "-o", "scenes/a.plica.json"]));
    assert_eq!(std::fs::read(scenes.join("cat.png")).unwrap(), std::fs::read(folder.path().join("cat.png")).unwrap());
    assert_eq!(ok(plica(&scenes, &["get", "a.plica.json", "images.cat.path"])), "\"cat.png\"\n");
    // The same picture may be there already; a different one with its name is not touched.
    ok(plica(folder.path(), &["new", "cat.png", "-o", "scenes/b.plica.json"]));
    std::fs::write(scenes.join("cat.png"), "other").unwrap();
    let refused = plica(folder.path(), &["new", "cat.png", "-o", "scenes/c.plica.json"]);
    assert_eq!((refused.status, std::fs::read(scenes.join("cat.png")).unwrap()), (1, b"other".to_vec()));
    let told =
        "cat.png: is there already, and is another file than ./cat.png, which is copied there (rename one of the two";
    assert!(refused.messages.contains(told), "{refused:?}");
    assert!(!scenes.join("c.plica.json").exists());
    std::fs::write(folder.path().join("no.png"), "no picture").unwrap();
    assert_eq!(plica(folder.path(), &["new", "no.png"]).status, 1);
    assert!(!folder.path().join("no.plica.json").exists());
    for (place, told) in [
        ("none/a.plica.json", "none/a.plica.json: there is no folder none (make it first)"),
        ("a.png", "a.png: is what a picture, a model or a video is called (call the scene NAME.plica.json with -o)"),
        ("a.GLB", "a.GLB: is what a picture, a model or a video is called"),
    ] {
        let refused = plica(folder.path(), &["new", "cat.png", "-o", place]);
        assert!(refused.status == 1 && refused.messages.starts_with(&format!("plica: {told}")), "{refused:?}");
    }
}

#[test]
fn set_takes_all_or_nothing() {
    let folder = folder();
    let at = folder.path();
    ok(plica(at, &["new", "cat.png"]));
    let zone = "layers.cat.zones.all";
    let set = |settings: &[&str]| {
        let settings: Vec<_> = settings.iter().map(|one| one.replace('Z', zone)).collect();
        let args: Vec<_> = ["set", "cat.plica.json"].into_iter().chain(settings.iter().map(String::as_str)).collect();
        plica(at, &args)
    };
    ok(set(&[
        "Z.motion=[{\"tool\": \"point\", \"at\": [4, 3], \"jump\": [0, -2]}]",
        "Z.interpolation.method=rigid",
        "title=2024",
    ]));
    assert_eq!(ok(plica(at, &["get", "cat.plica.json", "/layers/0/zones/0/motion/0/jump"])), "[0, -2]\n");
    assert_eq!(ok(plica(at, &["get", "cat.plica.json", "title"])), "\"2024\"\n");
    assert_eq!(ok(plica(at, &["get", "cat.plica.json", "timeline.fps"])), "30\n");
    let before = std::fs::read_to_string(at.join("cat.plica.json")).unwrap();
    for (settings, status, part) in [
        (&["title=Dog", "Z.feather=-1"][..], 1, "-1 is too small: 0 to 1000000 px"),
        (&["title=Dog", "Z.feathr=1"], 1, "did you mean \"feather\"?"),
        (&["Z.feather=1e999"], 1, "is too large a number"),
        (&["Z.feather"], 2, "PATH=VALUE"),
        (&["Z.feather 4"], 2, "feather 4: write it as"),
    ] {
        let ran = set(settings);
        assert_eq!(ran.status, status, "{ran:?}");
        assert!(ran.messages.contains(part), "{ran:?}");
        assert_eq!(std::fs::read_to_string(at.join("cat.plica.json")).unwrap(), before);
    }
    assert_eq!(plica(at, &["check", "cat.plica.json"]).messages, "no problems\n");
}

#[test]
fn check_reads_all_of_every_file() {
    let folder = folder();
    ok(plica(folder.path(), &["new", "cat.png"]));
    let whole = std::fs::read(folder.path().join("cat.png")).unwrap();
    std::fs::write(folder.path().join("cat.png"), &whole[..whole.len() - 20]).unwrap();
    let ran = plica(folder.path(), &["check", "cat.plica.json"]);
    assert!(ran.status == 1 && ran.out.starts_with("images.cat.path: "), "{ran:?}");
}

#[test]
fn check_lists_every_problem() {
    let folder = folder();
    let scene = r#"{ "plica": 1, "images": { "cat": { "path": "cat.png" }, "dog": { "path": "dog.png" } }, "layers": [
        { "kind": "picture", "name": "face", "image": "cat", "zones": [
            { "name": "far", "outline": { "kind": "rectangle", "x": 100, "y": 0, "width": 5, "height": 5 } } ] } ] }"#;
    std::fs::write(folder.path().join("a.plica.json"), scene).unwrap();
    let ran = plica(folder.path(), &["check", "a.plica.json"]);
    let lines: Vec<_> = ran.out.lines().collect();
    assert_eq!((ran.status, lines.len()), (1, 3), "{ran:?}");
    assert!(lines[0].starts_with("images.dog"), "{lines:?}");
    assert!(ran.messages.contains("1 error, 2 warnings"), "{ran:?}");
    let json = plica(folder.path(), &["check", "--json", "a.plica.json"]);
    let list: Vec<serde_json::Value> = serde_json::from_str(&json.out).unwrap();
    assert_eq!((json.status, list.len(), &list[0]["severity"]), (1, 3, &"error".into()));
    let broken = scene.replace("\"zones\"", "\"zonse\"");
    std::fs::write(folder.path().join("a.plica.json"), broken).unwrap();
    let ran = plica(folder.path(), &["check", "a.plica.json"]);
    // What is wrong with the files is told beside what is wrong with the text.
    let lines: Vec<_> = ran.out.lines().collect();
    assert_eq!(lines[0], "layers.face.zonse: unknown field \"zonse\" (did you mean \"zones\"?)");
    assert!(lines.len() == 2 && lines[1].starts_with("images.dog.path: dog.png: there is no such file"), "{ran:?}");
    assert_eq!(plica(folder.path(), &["check", "none.plica.json"]).status, 1);
}

#[test]
fn what_tools_ask_for() {
    let folder = folder();
    let schema: serde_json::Value = serde_json::from_str(&ok(plica(folder.path(), &["schema"]))).unwrap();
    assert!(schema["$defs"]["Zone"]["properties"]["feather"]["description"].is_string());
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(ok(plica(folder.path(), &["completions", shell])).contains("plica"), "{shell}");
    }
    let manual = ok(plica(folder.path(), &["man"]));
    for command in ["NEW", "SET", "GET", "CHECK", "SCHEMA", "COMPLETIONS", "MAN"] {
        assert!(manual.contains(&format!(".SH \"PLICA {command}\"")), "{command}");
    }
}

#[test]
fn styles_are_listed_shown_applied_and_saved() {
    let folder = folder();
    let list = ok(plica(folder.path(), &["style", "list"]));
    assert!(list.contains("\nfelt-tip        broad pens in") && list.ends_with("takes it away\n"), "{list}");
    let shown = ok(plica(folder.path(), &["style", "show", "charcoal"]));
    let line = ok(plica(folder.path(), &["style", "show", "charcoal", "--json"]));
    let table: serde_json::Value = serde_json::from_str(&shown).unwrap();
    assert_eq!(table["noises"]["broad"]["spacing"], 18);
    assert!(line.lines().count() == 1 && serde_json::from_str::<serde_json::Value>(&line).unwrap() == table);
    let meshes = serde_json::json!({ "m": { "path": "m.obj" } });
    let layers = [serde_json::json!({ "kind": "mesh", "name": "a", "mesh": "m", "strokes": { "ink": "#102030" } })];
    let scene = serde_json::json!({ "plica": 1, "camera": {}, "meshes": meshes, "layers": layers });
    std::fs::write(folder.path().join("s.json"), scene.to_string()).unwrap();
    let apply = |more: &[&str]| plica(folder.path(), &[&["style", "apply"], more].concat());
    let get = |what: &str| ok(plica(folder.path(), &["get", "s.json", what]));
    assert_eq!(apply(&["charcoal", "s.json", "--layer", "a"]).messages, "charcoal is applied to a\n");
    let strokes: serde_json::Value = serde_json::from_str(&get("layers.a.strokes")).unwrap();
    assert_eq!(strokes, serde_json::json!({ "style": "charcoal", "ink": "#102030" }));
    let saved = plica(folder.path(), &["style", "save", "s.json", "-o", "mine.json"]);
    assert!(saved.status == 0 && saved.messages.starts_with("done: mine.json"), "{saved:?}");
    // Its own kind of file is replaced, the scene is not.
    assert_eq!(plica(folder.path(), &["style", "save", "s.json", "-o", "mine.json"]).status, 0);
    assert_ne!(plica(folder.path(), &["style", "save", "s.json", "-o", "s.json"]).status, 0);
    ok(apply(&["hatching", "s.json"]));
    ok(apply(&["mine.json", "s.json"]));
    assert_eq!(
        (get("layers.a.strokes.style"), get("layers.a.strokes.noises.broad.spacing")),
        ("\"none\"\n".into(), "18\n".into())
    );
    let own = folder.path().join("config/plica/styles");
    std::fs::create_dir_all(&own).unwrap();
    std::fs::copy(folder.path().join("mine.json"), own.join("sooty.json")).unwrap();
    assert!(ok(plica(folder.path(), &["style", "list"])).contains("\nsooty           your own: "));
    assert!(apply(&["sooty", "s.json"]).messages.ends_with("sooty.json changes nothing in a\n"));
    ok(apply(&["stipple", "s.json", "--whole"]));
    assert_eq!(
        (get("layers.a.strokes.style"), get("layers.a.strokes.marks.dots.opacity")),
        ("\"none\"\n".into(), "1\n".into())
    );
    assert_eq!(apply(&["none", "s.json"]).messages, "a is drawn in no style\n");
    assert!(!std::fs::read_to_string(folder.path().join("s.json")).unwrap().contains("strokes"));
    for (args, told) in [
        (&["stiple", "s.json"][..], "did you mean \"stipple\"?), and no such file"),
        (&["s.json", "s.json"], "s.json: is no style"),
        (&["stipple", "s.json", "--layer", "b"], "s.json: there is no layer \"b\""),
    ] {
        let refused = apply(args);
        assert!(refused.status != 0 && refused.messages.contains(told), "{refused:?}");
    }
}
