//! Enforces the rules of docs/architecture.md: which module may name which, one door per outside crate, no cycles,
//! sizes.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::collections::{BTreeMap, BTreeSet};

use source::{
    Map, SLICES, Source, circles, functions, literals, passed_by, paths, sources, sources_in, uncommented, within,
};

mod source;

/// A room names only what stands to its left.
const ORDER: [&str; 11] =
    ["base", "layers", "scene", "files", "render", "export", "preview", "ops", "tui", "cli", "main"];

/// Outside crates and where each may be named. Tests may use any.
const DOORS: &[(&[&str], &[&str])] = &[
    (&["wgpu"], &["render/gpu", "preview/window"]),
    (&["winit", "raw_window_handle", "x11rb", "x11_dl", "xkbcommon_dl"], &["preview/window"]),
    (&["cosmic_text", "dejavu"], &["preview/window/text"]),
    (&["ratatui", "crossterm", "terminput", "tui_input", "nucleo_matcher"], &["tui/"]),
    (&["toml", "csv"], &["tui/"]),
    (&["base64"], &["export/field/svg", "files/mesh", "tui/"]),
    (&["clap", "clap_complete", "clap_mangen"], &["ops/", "cli/"]),
    // The link handles the file of its socket; `base/system` creates the user's folders.
    (&["std::fs"], &["files/", "base/system", "preview/wire/socket"]),
    (&["std::net", "std::os::unix::net"], &["preview/wire/"]),
    (&["rustix", "signal_hook"], &["base/system"]),
    (&["image", "png", "gif", "webp"], &["files/", "export/"]),
    (&["moxcms", "tiff", "zune_core", "zune_jpeg"], &["files/picture"]),
    (&["exr"], &["files/picture", "export/floats"]),
    (&["tiny_skia"], &["export/field"]),
    (&["glob"], &["ops/"]),
];

/// The only list of them.
const LIST: &str = "layers/mod.rs";

/// Tests and benches of one technique, which go with it.
const OF_ONE_TECHNIQUE: &[&str] = &[
    "benches/frames.rs",
    "benches/keys.rs",
    "benches/scenes/mod.rs",
    "benches/synthesis.rs",
    "benches/waterfall.rs",
    "benches/work.rs",
    "tests/display/mod.rs",
    "tests/gpu/main.rs",
    "tests/player.rs",
    "tests/profiles.rs",
    "tests/properties.rs",
    "tests/show/mod.rs",
    "tests/view_maps.rs",
    "tests/waterfall.rs",
    "tests/window.rs",
];

/// The slots of a technique: each file or folder in one of these is named by the folder's `mod.rs` alone.
const SLOTS: &[&str] = &["layers/mesh/slots/"];

/// The rungs of `tui/`: a file names only what stands in its own or to its left.
const ORDER_TUI: [&str; 11] =
    ["text", "graphics", "events", "keys", "document", "state", "tutor", "layout", "commands", "panes", "outside"];

const MOST_LINES: usize = 500;

const MOST_LINES_OF_A_FUNCTION: usize = 60;

/// The part of `path` after `prefix`.
fn after<'a>(path: &'a str, prefix: &str) -> Option<&'a str> {
    path.strip_prefix(prefix)?.split("::").next()
}

fn report(rule: &str, broken: &[String]) {
    assert!(broken.is_empty(), "{rule}:\n  {}", broken.join("\n  "));
}

#[test]
fn a_room_names_only_what_stands_to_its_left() {
    let place = |room: &str| ORDER.iter().position(|&r| r == room);
    let mut broken = Vec::new();
    for source in sources().iter().filter(|source| source.path != "lib.rs") {
        let Some(own) = place(source.room()) else {
            broken.push(format!("src/{}: the room {} has no place in the order", source.path, source.room()));
            continue;
        };
        for (line, path) in source.paths() {
            let right = after(&path, "crate::").filter(|room| place(room).is_some_and(|there| there > own));
            broken.extend(right.map(|room| format!("src/{}:{line} names {room}", source.path)));
        }
    }
    report(&ORDER.join(" < "), &broken);
}

#[test]
fn a_rung_of_the_editor_names_only_what_stands_to_its_left() {
    let sources = sources();
    let map = Map::new(&sources);
    let rung = |path: &str| {
        let name = path.strip_prefix("tui/")?.split(['/', '.']).next()?;
        ORDER_TUI.iter().position(|rung| *rung == name)
    };
    let (mut seen, mut broken) = (0, Vec::new());
    for source in sources.iter().filter(|source| source.room() == "tui" && source.path != "tui/mod.rs") {
        for (line, path) in source.paths() {
            let other = map.leads_to(&source.path, &path).filter(|other| other.starts_with("tui/"));
            let Some(other) = other.filter(|other| !other.contains("/tests/")) else { continue };
            seen += 1;
            if rung(&source.path).is_none() || rung(other) > rung(&source.path) || rung(other).is_none() {
                broken.push(format!("src/{}:{line} names {other}", source.path));
            }
        }
    }
    report(&ORDER_TUI.join(" < "), &broken);
    assert!(seen > 200, "only {seen} seen");
}

#[test]
fn an_outside_crate_has_one_door() {
    let mut broken = Vec::new();
    for source in sources() {
        for (crates, doors) in DOORS {
            if doors.iter().any(|door| source.path.starts_with(door)) {
                continue;
            }
            for (line, path) in source.paths() {
                let named = crates.iter().find(|name| within(&path, name));
                broken
                    .extend(named.map(|name| format!("src/{}:{line} names {name}: {}", source.path, doors.join(", "))));
            }
        }
    }
    report("one door an outside crate", &broken);
}

/// The folders that hold a technique.
fn techniques(sources: &[Source]) -> Vec<&str> {
    let holds = |source: &&Source| source.path.ends_with("/mod.rs") && source.text.contains("pub static KIND: Kind");
    sources.iter().filter(holds).filter_map(Source::slice).collect()
}

#[test]
fn techniques_name_neither_one_another_nor_their_list() {
    let sources = sources();
    let techniques = techniques(&sources);
    assert!(techniques.len() > 1, "{techniques:?}");
    let map = Map::new(&sources);
    let mut broken = Vec::new();
    for source in &sources {
        // `parts` and what else stands beside them names none of them.
        if !source.path.starts_with(SLICES) || source.path == LIST {
            continue;
        }
        let own = source.slice().filter(|slice| techniques.contains(slice));
        for (line, path) in source.paths() {
            let Some(file) = map.leads_to(&source.path, &path) else { continue };
            let to = file.strip_prefix(SLICES).and_then(|rest| rest.split_once('/')).map(|(slice, _)| slice);
            let other = to.is_some_and(|to| techniques.contains(&to) && Some(to) != own);
            if other || (own.is_some() && file == LIST) {
                broken.push(format!("src/{}:{line} names {file}", source.path));
            }
        }
    }
    report("deleting a technique's folder breaks its list and nothing else of layers/", &broken);
}

/// How the list calls the layers of the techniques: `Layer::Picture`.
fn variants(sources: &[Source]) -> Vec<String> {
    let techniques = techniques(sources);
    let list = sources.iter().find(|source| source.path == LIST).map_or("", |source| &source.text);
    // `    Picture(folding::model::PictureLayer),`
    let variant = |line: &str| {
        let (name, rest) = line.trim().split_once('(')?;
        let known = techniques.iter().any(|technique| rest.starts_with(&format!("{technique}::")));
        (known && rest.ends_with("),")).then(|| format!("Layer::{name}"))
    };
    let variants: Vec<String> = list.lines().filter_map(variant).collect();
    assert_eq!(variants.len(), techniques.len(), "{variants:?}");
    variants
}

/// Where a file names a technique: its folder, or its variant.
fn names_of_techniques(source: &Source, techniques: &[&str], variants: &[String]) -> Vec<(usize, String)> {
    let named = |(_, path): &(usize, String)| {
        let folder = |technique: &&str| path.split_once("layers::").is_some_and(|(_, rest)| within(rest, technique));
        techniques.iter().any(folder) || variants.iter().any(|variant| path.ends_with(variant.as_str()))
    };
    paths(&source.text).into_iter().filter(named).collect()
}

#[test]
fn nobody_outside_names_a_technique() {
    let sources = sources();
    let (techniques, variants) = (techniques(&sources), variants(&sources));
    let mut broken = Vec::new();
    let own = |source: &Source| source.slice().is_some_and(|slice| techniques.contains(&slice));
    let map = Map::new(&sources);
    let inside = |file: &str| techniques.iter().any(|technique| file.starts_with(&format!("{SLICES}{technique}/")));
    for source in sources.iter().filter(|source| source.is_program() && source.path != LIST && !own(source)) {
        let mut named = names_of_techniques(source, &techniques, &variants);
        // Also by another name, that some module passes it on under.
        named.extend(
            source.paths().into_iter().filter(|(_, path)| map.leads_to(&source.path, path).is_some_and(inside)),
        );
        broken.extend(named.into_iter().map(|(line, path)| format!("src/{}:{line} names {path}", source.path)));
    }
    report("only layers/mod.rs names a technique", &broken);
}

#[test]
fn a_technique_is_two_lines_of_the_list_and_its_help() {
    let sources = sources();
    let list = sources.iter().find(|source| source.path == LIST).unwrap();
    let map = Map::new(&sources);
    for technique in techniques(&sources) {
        let word = |line: &&str| line.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == technique);
        let lines: Vec<&str> = list.text.lines().map(uncommented).filter(word).map(str::trim).collect();
        assert!(
            matches!(lines[..], [module, layer] if module == format!("pub mod {technique};") && layer.ends_with("),")),
            "{lines:?}"
        );
        let inside =
            |path: &str| map.leads_to(LIST, path).is_some_and(|to| to.starts_with(&format!("{SLICES}{technique}/")));
        let passed: Vec<String> = passed_by(list).into_iter().filter(|path| inside(path)).collect();
        report("the list passes nothing on", &passed);
    }
}

#[test]
fn few_tests_and_benches_name_a_technique() {
    let sources = sources();
    let (techniques, variants) = (techniques(&sources), variants(&sources));
    let mut found = BTreeSet::new();
    for folder in ["tests", "benches"] {
        // The names in this test are examples.
        for source in sources_in(folder).into_iter().filter(|source| !source.path.starts_with("house/")) {
            if !names_of_techniques(&source, &techniques, &variants).is_empty() {
                found.insert(format!("{folder}/{}", source.path));
            }
        }
    }
    // Tests within the program go with their own technique.
    let own = |source: &&Source| source.slice().is_some_and(|slice| techniques.contains(&slice));
    let others = sources.iter().filter(|source| source.path.ends_with(".rs") && !source.is_program() && !own(source));
    let named = others.filter(|source| !names_of_techniques(source, &techniques, &variants).is_empty());
    found.extend(named.map(|source| format!("src/{}", source.path)));
    let excepted: BTreeSet<String> = OF_ONE_TECHNIQUE.iter().map(|&file| file.to_owned()).collect();
    assert_eq!(found, excepted, "OF_ONE_TECHNIQUE lists the files that break if a technique is deleted");
}

#[test]
fn nobody_outside_writes_what_a_technique_calls_its_own() {
    let sources = sources();
    let techniques = techniques(&sources);
    let own = |source: &&Source| source.slice().is_some_and(|slice| techniques.contains(&slice));
    // Overlays and programs by their form, looks by where they are made; single words ("normal") mean other things too.
    let mut names = BTreeSet::new();
    for source in sources.iter().filter(own).filter(|source| source.is_program()) {
        let overlays = literals(&source.text).into_iter().map(|(_, literal)| literal);
        names.extend(overlays.filter(|name| name.starts_with("view-") || name.ends_with(".wgsl")));
        let looks = source.text.split("Look::new(").skip(1);
        let looks = looks.filter_map(|rest| rest.trim_start().strip_prefix('"')?.split('"').next());
        names.extend(looks.filter(|name| name.contains(' ')));
    }
    assert!(["view-outlines", "frame.wgsl", "fold region"].iter().all(|name| names.contains(name)), "{names:?}");
    let mut broken = Vec::new();
    for source in sources.iter().filter(|source| source.is_program() && !own(source)) {
        let named = literals(&source.text).into_iter().filter(|(_, literal)| names.contains(literal));
        broken.extend(named.map(|(line, name)| format!("src/{}:{line} writes \"{name}\"", source.path)));
    }
    report("the names of overlays, looks and programs stay with their technique", &broken);
}

#[test]
fn only_its_list_names_what_is_in_a_slot() {
    let sources = sources();
    let map = Map::new(&sources);
    let mut broken = Vec::new();
    for slot in SLOTS {
        let part = |file: &str| {
            let name = file.strip_prefix(slot)?.split(['/', '.']).next()?.to_owned();
            Some(name).filter(|name| name != "mod")
        };
        assert!(sources.iter().filter_map(|source| part(&source.path)).count() > 1, "{slot}");
        for source in sources.iter().filter(|source| source.path != format!("{slot}mod.rs")) {
            let own = part(&source.path);
            for (line, path) in source.paths() {
                let Some(to) = map.leads_to(&source.path, &path) else { continue };
                if part(to).is_some_and(|to| own.as_ref() != Some(&to)) {
                    broken.push(format!("src/{}:{line} names {path}", source.path));
                }
            }
        }
    }
    report("deleting what is in a slot breaks its list and nothing else", &broken);
}

#[test]
fn no_file_names_one_that_names_it() {
    let sources = sources();
    let map = Map::new(&sources);
    let mut arrows: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for source in &sources {
        let to = source.paths().into_iter().filter_map(|(_, path)| map.leads_to(&source.path, &path));
        arrows.insert(&source.path, to.collect());
    }
    let broken: Vec<String> = circles(&arrows).iter().map(|circle| circle.join(" <- ")).collect();
    report("no circle of files", &broken);
}

#[test]
fn files_stay_short_and_say_what_they_are() {
    let mut broken = Vec::new();
    for Source { path, text } in sources() {
        let lines = text.lines().count();
        if lines > MOST_LINES {
            broken.push(format!("src/{path}: {lines} lines, {MOST_LINES} at most"));
        }
        if !text.starts_with("//") {
            broken.push(format!("src/{path}: opens without a comment that says what it is"));
        }
    }
    report("files", &broken);
}

#[test]
fn functions_stay_short() {
    let mut broken = Vec::new();
    for folder in ["src", "tests", "benches", "profiles", "fuzz"] {
        for source in sources_in(folder).iter().filter(|source| source.path.ends_with(".rs")) {
            let long = functions(&source.text).into_iter().filter(|&(.., lines)| lines > MOST_LINES_OF_A_FUNCTION);
            broken.extend(long.map(|(at, name, lines)| format!("{folder}/{}:{at} {name}: {lines} lines", source.path)));
        }
    }
    report(&format!("{MOST_LINES_OF_A_FUNCTION} lines a function, of tests too"), &broken);
}
