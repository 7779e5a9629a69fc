//! Scripts without a screen, with the real binary: lines in, answers out; the log of one session is a script that makes
//! the same scene elsewhere.
#![cfg(feature = "tui")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod binary;

use std::path::Path;
use std::process::Output;

const SCENE: &str = r#"{
  "plica": 1,
  "images": { "cat": { "path": "cat.png" } },
  "layers": [
    {
      "kind": "picture", "name": "face", "image": "cat",
      "zones": [
        {
          "name": "eye",
          "outline": { "kind": "rectangle", "x": 8, "y": 8, "width": 32, "height": 24 },
          "motion": [{ "tool": "point", "at": [20, 20], "jump": [0, -4] }]
        }
      ]
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

fn run(folder: &Path, script: &str) -> Output {
    std::fs::write(folder.join("script"), script).unwrap();
    binary::plica(folder, ["edit", "cat.plica.json", "--script", "script"]).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn a_script_edits_answers_and_saves() {
    let folder = folder();
    let script = "# an eye\n\nset layers.face.zones.eye.speed=2\nget layers.face.zones.eye.speed\nprobe 20,20\nw\n";
    let output = run(folder.path(), script);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let said = text(&output.stdout);
    assert!(said.contains("\n2\n") && said.contains("zone") && said.contains("is saved"), "{said}");
    let saved = std::fs::read_to_string(folder.path().join("cat.plica.json")).unwrap();
    assert!(saved.contains("\"speed\": 2"), "{saved}");
}

#[test]
fn a_script_that_ends_with_unsaved_edits_has_failed() {
    let folder = folder();
    let output = run(folder.path(), "set title=x\n");
    let said = text(&output.stderr);
    assert!(said.contains("the edits are not saved; the next `plica edit` offers them"), "{said}");
    assert_eq!(output.status.code(), Some(1));
    let folder = self::folder();
    let output = run(folder.path(), "set title=x\nq!\n");
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(text(&run(folder.path(), "get title").stdout), "\"\"\n", "nothing is asked");
}

#[test]
fn a_mistake_ends_it_with_its_line() {
    for (script, place, part) in [
        ("w\n# a\nmove down\nsett a=1\nwq", "script:4", "did you mean \"set\""),
        ("set layers.face.zones.eye.speeed=1\nw", "script:1", "speed"),
        ("source other\nw", "script:1", "other"),
        ("source script\nw", "script:1", "inside one another"),
        ("render -o no/such/a.gif\nset layers.face.zones.eye.speed=2\nw", "script:1", "a.gif"),
        ("go layers.face.zones.eye.speed\nput 1/0\nw", "script:2", "finite"),
    ] {
        let folder = folder();
        let output = run(folder.path(), script);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{script}: {said}");
        assert!(said.contains(place) && said.contains(part) && said.contains("nothing after it was run"), "{said}");
        let kept = std::fs::read_to_string(folder.path().join("cat.plica.json")).unwrap();
        assert!(!kept.contains("speed"), "{script}");
    }
}

#[test]
fn the_log_of_a_session_makes_the_same_scene_elsewhere() {
    let (first, second) = (folder(), folder());
    let script = "go layers.face.zones.eye.motion\nmove right\nput *1.5\nadd\n3 step 1\nundo\nput \"30\"\nwq\n";
    let output = run(first.path(), script);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let logs: Vec<_> = std::fs::read_dir(first.path().join("state/plica/sessions")).unwrap().flatten().collect();
    assert_eq!(logs.len(), 1);
    let log = std::fs::read_to_string(logs[0].path()).unwrap();
    assert!(log.starts_with("# plica ") && log.contains("cat.plica.json\n# terminal"), "{log}");
    assert!(log.ends_with("undo\nput \"30\"\nwq\n"), "{log}");
    let output = run(second.path(), &log);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let scene = |folder: &Path| std::fs::read_to_string(folder.join("cat.plica.json")).unwrap();
    assert_eq!(scene(first.path()), scene(second.path()));
    assert_ne!(scene(first.path()), SCENE);
}

#[test]
fn own_keys_are_shown_with_their_mistakes() {
    let folder = folder();
    std::fs::create_dir_all(folder.path().join("config/plica")).unwrap();
    let keys = "[everywhere]\n\"Ctrl-s\" = \"w\"\n\"g\" = \"undo\"\n\"x\" = \"unod\"\n";
    std::fs::write(folder.path().join("config/plica/keys.toml"), keys).unwrap();
    let output = run(folder.path(), "keys");
    let said = text(&output.stdout);
    assert!(output.status.success() && said.contains("Ctrl-s"), "{said}");
    assert!(said.contains("keys.toml:3: ") && said.contains("keys.toml:4: "), "{said}");
}
