//! The line mode of the real binary: commands on standard input, plain answers on standard output, errors on standard
//! error, and an exit status that a script can rely on.
#![cfg(feature = "tui")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod binary;

use std::io::Write;
use std::path::Path;
use std::process::{Output, Stdio};

const SCENE: &str = r#"{
  "plica": 1,
  "timeline": { "duration": 1, "fps": 4 },
  "images": { "cat": { "path": "cat.png" } },
  "layers": [
    {
      "kind": "picture", "name": "face", "image": "cat",
      "zones": [{ "name": "eye", "outline": { "kind": "rectangle", "x": 8, "y": 8, "width": 32, "height": 24 } }]
    }
  ]
}
"#;

/// A folder with a scene and a picture in it.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    image::RgbImage::new(64, 48).save(folder.path().join("cat.png")).unwrap();
    std::fs::write(folder.path().join("cat.plica.json"), SCENE).unwrap();
    folder
}

fn run(folder: &Path, arguments: &[&str], lines: &str) -> Output {
    edit(folder, "cat.plica.json", arguments, lines)
}

fn edit(folder: &Path, path: &str, arguments: &[&str], lines: &str) -> Output {
    let mut command = binary::plica(folder, ["edit", path]);
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    // A process that refuses to start reads nothing.
    let _ = child.stdin.take().unwrap().write_all(lines.as_bytes());
    child.wait_with_output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn saved(folder: &Path) -> String {
    std::fs::read_to_string(folder.join("cat.plica.json")).unwrap()
}

#[test]
fn lines_edit_answer_and_fail_by_their_numbers() {
    let speed = "layers.face.zones.eye.speed";
    // Lines; standard output and standard error; whether it succeeds; whether the speed is saved.
    for (lines, out, error, succeeds, kept) in [
        (format!("set {speed}=2\nget {speed}\nw\n"), "\n2\n", "", true, true),
        (format!(":set {speed}=2\n# a remark\n\nwq\nget {speed}"), "is saved", "", true, true),
        (format!("set {speed}=2\n"), "is set", "standard input: the edits are not saved", false, false),
        (format!("set {speed}=2\nq!\n"), "is set", "", true, false),
        (format!("set {speed}=2\nq\nq!\nget {speed}"), "is set", "line 2: there are unsaved edits", false, false),
        (format!("set {speed}=-x\nset {speed}=2\nw"), "", "line 1: ", false, false),
        (format!("set {speed}=2\nsett\nw"), "is set", "line 2 was refused, and nothing after it was run", false, false),
        (format!("set {speed}=2\nw\nsett\nset {speed}=3\nw"), "is saved", "line 3 was refused", false, true),
        ("sett a=1\nmove\nq".into(), "", "line 1: there is no command \"sett\"", false, false),
        ("?\nq".into(), "set PATH=VALUE", "", true, false),
        ("help undo\nq".into(), ":undo", "", true, false),
        ("go layers.face.zones.eye.interpolation.method\nenter\nthin-plate\nget layers.face.zones.eye.interpolation.method\nq!\n".into(), "\"thin-plate\"", "", true, false),
        ("probe 20,20".into(), "eye", "", true, false),
        (format!("set {speed}=2\nundo\nq"), "is set", "", true, false),
        ("render -o no/such/a.gif".into(), "", "line 1: ", false, false),
    ] {
        let folder = folder();
        let output = run(folder.path(), &[], &lines);
        let (said, complained) = (text(&output.stdout), text(&output.stderr));
        let case = format!("{lines}\n-- out\n{said}\n-- error\n{complained}");
        assert!(said.contains(out) && complained.contains(error), "{case}");
        assert_eq!(output.status.code(), Some(if succeeds { 0 } else { 1 }), "{case}");
        assert_eq!(saved(folder.path()).contains("\"speed\": 2"), kept, "{case}");
        assert!(!said.contains('\u{1b}') && !complained.contains('\u{1b}'), "{case}");
    }
}

#[test]
fn a_copy_is_written_where_it_is_asked_for_and_nowhere_else() {
    // Lines; what is said; whether the scene has the edit, whether the copy has it; whether it succeeds.
    for (lines, said, scene, copy, succeeds) in [
        ("w copy.json\nq!", "is there already (choose another name, or replace it with :w! PATH)", false, false, false),
        ("w! copy.json\nq!", "copy.json is written", false, true, true),
        ("write! \"copy.json\"\nq!", "copy.json is written", false, true, true),
        ("wq new.json", "new.json is written", false, false, true),
        ("x copy.json\nq!", "is there already", false, false, false),
        ("w! cat.png\nq!", "is read by", false, false, false),
        ("w! .cat.journal\nq!", "belongs to the journal", false, false, false),
        ("set images.cat.path=\"dog.png\"\nw! cat.png\nq!", "is read by", false, false, false),
        ("w! ./cat.plica.json", "cat.plica.json is saved", true, false, true),
        ("w cat.plica.json", "cat.plica.json is saved", true, false, true),
        ("w! link.json\nq!", "is the scene itself", false, false, false),
        ("w! sub\nq!", "is not a regular file", false, false, false),
        ("q! now\nq!", "q! takes no argument, not \"now\"", false, false, false),
    ] {
        let folder = folder();
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("copy.json"), "a letter").unwrap();
        std::fs::create_dir(at("sub")).unwrap();
        std::os::unix::fs::symlink("cat.plica.json", at("link.json")).unwrap();
        let output = run(folder.path(), &[], &format!("set title=EXPERIMENT\n{lines}\n"));
        let told = text(&output.stdout) + &text(&output.stderr);
        assert!(told.contains(said), "{lines}: {told}");
        let has = |name: &str| std::fs::read_to_string(at(name)).is_ok_and(|text| text.contains("EXPERIMENT"));
        assert_eq!((has("cat.plica.json"), has("copy.json")), (scene, copy), "{lines}: {told}");
        assert_eq!(output.status.success(), succeeds, "{lines}: {told}");
        assert_eq!(has("new.json"), lines.contains("new.json"), "{lines}");
        let again = run(folder.path(), &[], "get title\n");
        // A refused line leaves what precedes it to the next session.
        assert!(!succeeds || !text(&again.stderr).contains("left behind"), "{lines}: {}", text(&again.stderr));
    }
}

#[test]
fn the_file_that_is_named_is_the_one_that_is_edited() {
    let titled = |title: &str| SCENE.replacen("\"plica\": 1", &format!("\"plica\": 1, \"title\": \"{title}\""), 1);
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    for (name, title) in [("q", "file q"), ("q.plica.json", "beside q"), ("s.png", "a scene"), ("bom", "bom")] {
        std::fs::write(at(name), titled(title)).unwrap();
    }
    std::fs::write(at("bom"), format!("\u{feff}  {}", titled("bom"))).unwrap();
    for (from, to) in [("cat.png", "dog.png"), ("cat.png", "pic.json"), ("cat.png", "q.png")] {
        std::fs::copy(at(from), at(to)).unwrap();
    }
    image::RgbImage::new(9, 9).save(at("cat.jpg")).unwrap();
    std::os::unix::fs::symlink("cat.png", at("cat.gif")).unwrap();
    // What is named, what comes of it, whether it goes well.
    for (path, said, succeeds) in [
        ("q", "\"file q\"", true),
        ("s.png", "\"a scene\"", true),
        ("bom", "\"bom\"", true),
        (
            "q.png",
            "is not read by the scene beside it, q.plica.json (edit that one, or make another: plica new q.png -o",
            false,
        ),
        ("cat.png", "\"\"", true),
        ("cat.gif", "\"\"", true),
        ("cat.jpg", "is not read by the scene beside it, cat.plica.json", false),
        ("dog.png", "\"\"", true),
        ("pic.json", "\"\"", true),
        ("no", "no: there is no such file", false),
        ("cat.png#x", "only an OpenEXR has layers", false),
    ] {
        let output = edit(folder.path(), path, &[], "get title\n");
        let told = text(&output.stdout) + &text(&output.stderr);
        assert!(told.contains(said) && output.status.success() == succeeds, "{path}: {told}");
    }
    assert!(at("dog.plica.json").exists() && at("pic.plica.json").exists());
    assert!(edit(folder.path(), "q", &[], "set title=edited\nwq\n").status.success());
    let read = |name: &str| std::fs::read_to_string(at(name)).unwrap();
    assert!(read("q").contains("edited") && read("q.plica.json").contains("beside q"));
    // A picture that is gone leaves its scene to be edited.
    std::fs::remove_file(at("dog.png")).unwrap();
    assert!(edit(folder.path(), "dog.png", &[], "get title\n").status.success());
}

#[test]
fn a_message_of_several_lines_keeps_them() {
    let folder = folder();
    let told = text(&run(folder.path(), &[], "render --frames 0 -o cat.plica.json\n").stderr);
    assert!(told.contains("the extension names no format; these do:") && !told.contains('␊'), "{told}");
    assert!(told.lines().count() > 10, "{told}");
}

#[test]
fn long_work_runs_in_the_foreground() {
    let folder = folder();
    let output = run(folder.path(), &[], "render -o out.gif\nset title=after\nw\n");
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(folder.path().join("out.gif").exists() && saved(folder.path()).contains("after"));
}

#[test]
fn what_was_left_behind_is_offered_in_words() {
    let folder = folder();
    let first = run(folder.path(), &[], "set layers.face.zones.eye.speed=2\n");
    assert!(text(&first.stderr).contains("not saved"), "{}", text(&first.stderr));
    let second = run(folder.path(), &[], "keep\nw\n");
    let told = text(&second.stderr);
    assert!(told.contains("1 unsaved change was left behind") && told.contains("eye · speed 1 → 2"), "{told}");
    assert!(saved(folder.path()).contains("\"speed\": 2"));
    run(folder.path(), &[], "set layers.face.zones.eye.speed=5\n");
    let answered = run(folder.path(), &["--after-recovery", "drop"], "w\n");
    let told = text(&answered.stderr);
    assert!(answered.status.success() && !told.contains("left behind"), "answered before: {told}");
    assert!(saved(folder.path()).contains("\"speed\": 2"));
}

#[test]
fn nothing_is_changed_while_unsaved_edits_wait_for_an_answer() {
    let folder = folder();
    run(folder.path(), &[], "set title=precious\n");
    for (arguments, lines, told) in [
        (&[][..], "set title=x\nw\n", "line 1: 1 unsaved change was left behind: :recovery keep"),
        (&["--script", "script"], "", "1 unsaved change was left behind, so the script is not run"),
    ] {
        std::fs::write(folder.path().join("script"), "set title=x\nw\n").unwrap();
        let output = run(folder.path(), arguments, lines);
        let complained = text(&output.stderr);
        assert!(complained.contains(told), "{complained}");
        assert_eq!((output.status.code(), saved(folder.path()).as_str()), (Some(1), SCENE));
    }
    let output = run(folder.path(), &["--after-recovery", "keep"], "get title\nw\n");
    assert!(output.status.success() && text(&output.stdout).contains("precious"), "{}", text(&output.stderr));
    assert!(saved(folder.path()).contains("precious"));
}

#[test]
fn edits_that_no_journal_holds_are_not_promised() {
    let folder = folder();
    // The journal of a newer program must not be touched.
    let mut journal = b"PLICAJNL".to_vec();
    journal.extend([9, 0, 0, 0, 0, 0, 0, 0]);
    std::fs::write(folder.path().join(".cat.journal"), &journal).unwrap();
    let output = run(folder.path(), &[], "set title=x\n");
    let complained = text(&output.stderr);
    assert!(complained.contains("no journal: ") && complained.contains("not saved, and lost"), "{complained}");
    assert!(!complained.contains("offers them"), "{complained}");
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(std::fs::read(folder.path().join(".cat.journal")).unwrap(), journal);
}

#[test]
fn a_scene_that_is_only_read_is_not_changed() {
    let folder = folder();
    let output = run(folder.path(), &["--read-only"], "set title=x\nget title\nw\n");
    let complained = text(&output.stderr);
    assert!(complained.contains("line 1: ") && complained.contains("read-only"), "{complained}");
    assert_eq!((output.status.code(), saved(folder.path()).as_str()), (Some(1), SCENE));
}
