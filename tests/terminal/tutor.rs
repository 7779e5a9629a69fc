//! The whole tutor in the real binary, by the keys that it shows, up to the rendered file.

use std::time::Duration;

use crate::support::{Editor, folder};

/// The keys that the lesson on the screen names, as the terminal sends them.
fn shown(screen: &str) -> Vec<String> {
    let line = screen.lines().find(|line| line.starts_with("│ press")).unwrap_or_else(|| panic!("no keys:\n{screen}"));
    let labels = line.trim_matches('│').trim().trim_start_matches("press").split("  ");
    let labels = labels.map(str::trim).filter(|label| !label.is_empty());
    let sent = |key: &str| match key {
        "Enter" => "\r".to_owned(),
        "Esc" => "\u{1b}".to_owned(),
        "Tab" => "\t".to_owned(),
        "Space" => " ".to_owned(),
        key => key.to_owned(),
    };
    let keys = |label: &str| match label.strip_prefix('"').and_then(|text| text.strip_suffix('"')) {
        Some(text) => text.to_owned(),
        None => label.split(' ').map(sent).collect(),
    };
    labels.map(keys).collect()
}

#[test]
fn the_tutor_leads_to_a_rendered_animation() {
    let folder = folder();
    let mut editor = Editor::run(folder.path(), &["tutor"]);
    editor.wait_for("lesson 1 of ");
    let screen = editor.screen();
    let count: usize = screen.split("lesson 1 of ").nth(1).unwrap().split(':').next().unwrap().parse().unwrap();
    assert!((14..=18).contains(&count));
    for lesson in 1..count {
        editor.wait_for(&format!("lesson {lesson} of "));
        for keys in shown(&editor.settled_screen()) {
            editor.press(&keys);
            if keys == "\u{1b}" {
                // Esc and a letter that arrive together are Alt and the letter.
                std::thread::sleep(Duration::from_millis(500));
            }
        }
        editor.wait_for(&format!("lesson {} of ", lesson + 1));
    }
    for keys in shown(&editor.settled_screen()) {
        editor.press(&keys);
    }
    assert_eq!(editor.end(), 0);
    editor.assert_restored();
    editor.wait_for("your files from the tutor are in");
    let made: Vec<_> = std::fs::read_dir(folder.path().join("tmp")).unwrap().flatten().collect();
    let gif = std::fs::read(made[0].path().join("first.gif")).unwrap();
    assert!(gif.starts_with(b"GIF89a"));
    assert!(made[0].path().join("tutor.plica.json").exists());
}
