//! Scenes as files: good ones are read and written back unchanged, bad ones have exactly the problems in the file
//! beside them. `PLICA_UPDATE=1 cargo test --test scenes` rewrites those files.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails, in its helpers too")]

use std::fs;
use std::path::{Path, PathBuf};

use plica::base::problem::Problem;
use plica::scene::{Document, json};

fn files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes").join(folder);
    let mut files: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
    files.sort();
    assert!(!files.is_empty());
    files
}

/// Compares the problems with the file beside the scene, where one line is one problem; no file is no problem.
fn compare(path: &Path, problems: &[Problem]) -> Result<(), String> {
    let found: String = problems.iter().map(|problem| format!("{problem}\n")).collect();
    let beside = path.with_extension("txt");
    if std::env::var_os("PLICA_UPDATE").is_some() {
        let _ = fs::remove_file(&beside);
        if !found.is_empty() {
            fs::write(&beside, &found).unwrap();
        }
    }
    let expected = fs::read_to_string(&beside).unwrap_or_default();
    if found == expected { Ok(()) } else { Err(format!("{}\nexpected:\n{expected}found:\n{found}", path.display())) }
}

#[test]
fn bad_scenes_have_exactly_these_problems() {
    let wrong: Vec<_> = files("bad")
        .iter()
        .filter_map(|path| {
            let problems = Document::parse(&fs::read_to_string(path).unwrap()).err().unwrap_or_default();
            assert!(!problems.is_empty(), "{} has no errors", path.display());
            compare(path, &problems).err()
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn good_scenes_are_read_and_written_back() {
    for path in files("good") {
        let text = fs::read_to_string(&path).unwrap();
        let document = Document::parse(&text).unwrap_or_else(|problems| panic!("{}: {problems:?}", path.display()));
        compare(&path, document.warnings()).unwrap();
        let written = document.to_text();
        let again = Document::parse(&written).unwrap();
        assert!(json::same(document.json(), again.json()), "{}", path.display());
        assert_eq!(again.to_text(), written, "{}", path.display());
        assert_eq!(again.scene(), document.scene(), "{}", path.display());
        let typed = serde_json::to_value(&**document.scene()).unwrap();
        let typed = Document::from_json(typed).unwrap_or_else(|problems| panic!("{}: {problems:?}", path.display()));
        assert_eq!(typed.scene(), document.scene(), "{}: the types and the schema differ", path.display());
    }
}
