//! Completion as a person meets it: in a real bash, with Tab.

use super::support::{Editor, folder};

#[test]
fn bash_completes_demos_paths_of_the_scene_and_zones() {
    let folder = folder();
    let scene = r#"{ "plica": 1, "images": { "photo": { "path": "photo.png" } }, "layers": [{ "kind": "picture",
      "name": "face", "image": "photo", "zones": [
        { "name": "left eye", "outline": { "kind": "rectangle", "x": 0, "y": 0, "width": 9, "height": 9 } },
        { "name": "mouth", "outline": { "kind": "rectangle", "x": 0, "y": 0, "width": 9, "height": 9 } }] }] }"#;
    std::fs::write(folder.path().join("s.plica.json"), scene).unwrap();
    let mut shell = Editor::bash(folder.path());
    shell.wait_for(">");
    shell.press("source <(plica completions bash); echo rea\"\"dy\r");
    shell.wait_for("ready");
    for (typed, completed) in [
        ("plica demo wav\t", "plica demo waves"),
        ("plica get s.plica.json layers.face.zones.mou\t", "layers.face.zones.mouth"),
        ("plica field s.plica.json --zone le\t", r"--zone left\ eye"),
        ("plica set s.plica.json layers.face.zones.mouth.outline.kind=po\t", "outline.kind=polygon"),
    ] {
        shell.press(typed);
        shell.wait_for(completed);
        // The next on an empty line.
        shell.press("\u{15}");
    }
    shell.press("exit\r");
    assert_eq!(shell.end(), 0);
}
