//! Holds the rules of the house (docs/architecture.md): who may name whom, one door an outside crate, sizes.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::fs;
use std::path::{Path, PathBuf};

/// A room names only what stands to its left.
const ORDER: [&str; 11] =
    ["base", "layers", "scene", "files", "render", "export", "preview", "ops", "tui", "cli", "main"];

/// Outside crates and where each may be named. Tests may use what they like.
const DOORS: &[(&[&str], &[&str])] = &[
    (&["wgpu"], &["render/gpu", "preview/window"]),
    (&["winit", "raw_window_handle", "x11rb", "x11_dl", "xkbcommon_dl"], &["preview/window"]),
    (&["cosmic_text", "dejavu"], &["preview/window/text"]),
    (&["ratatui", "crossterm", "terminput", "tui_input", "nucleo_matcher"], &["tui/"]),
    (&["toml", "base64", "csv"], &["tui/"]),
    (&["clap", "clap_complete", "clap_mangen"], &["ops/", "cli/"]),
    // The link keeps the file of its socket; `base/system` makes the user's folders.
    (&["std::fs"], &["files/", "base/system", "preview/wire/socket"]),
    (&["std::net", "std::os::unix::net"], &["preview/wire/"]),
    (&["rustix", "signal_hook"], &["base/system"]),
    (&["naga"], &["render/wgsl"]),
    (&["image", "png", "gif", "webp"], &["files/", "export/"]),
    (&["moxcms", "exr", "tiff", "zune_core", "zune_jpeg"], &["files/picture"]),
    (&["tiny_skia"], &["export/field"]),
];

/// A technique's folder: deleting it must break `layers/mod.rs` and no other slice.
const SLICES: &str = "layers/";

/// What slices and the rest give one another.
const SHARED: &str = "parts";

const MOST_LINES: usize = 500;

struct Source {
    /// Relative to `src`, with `/`.
    path: String,
    text: String,
}

impl Source {
    fn room(&self) -> &str {
        self.path.split(['/', '.']).next().unwrap_or_default()
    }

    fn slice(&self) -> Option<&str> {
        let slice = self.path.strip_prefix(SLICES)?.split_once('/').map(|(slice, _)| slice);
        slice.filter(|slice| *slice != SHARED)
    }

    /// Every path that the program (not its tests) names, with its line.
    fn paths(&self) -> Vec<(usize, String)> {
        let tests = self.path.ends_with("tests.rs") || self.path.contains("/tests/") || !self.path.ends_with(".rs");
        if tests { Vec::new() } else { paths(&self.text) }
    }
}

fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = Vec::new();
    files(&root, &mut found);
    found.sort();
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).unwrap();
        Source { path: path.strip_prefix(&root).unwrap().to_str().unwrap().to_owned(), text }
    };
    found.into_iter().map(read).collect()
}

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs" || e == "wgsl") {
            found.push(path);
        }
    }
}

/// The paths in `text` up to its tests, which come last in a file. Braces of `use` are spread out.
fn paths(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let mut lines = text.lines().enumerate().take_while(|(_, line)| line.trim() != "#[cfg(test)]");
    while let Some((at, line)) = lines.next() {
        let code = uncommented(line);
        let mut words = code.split_whitespace().skip_while(|word| word.starts_with("pub"));
        if words.next() != Some("use") {
            found.extend(spoken(code).into_iter().map(|path| (at + 1, path)));
            continue;
        }
        let mut tree = code.split_once("use").map_or(String::new(), |(_, tree)| tree.to_owned());
        while !tree.contains(';') {
            let Some((_, line)) = lines.next() else { break };
            tree.push_str(uncommented(line));
        }
        spread("", tree.trim().trim_end_matches(';'), at + 1, &mut found);
    }
    found
}

fn uncommented(line: &str) -> &str {
    line.split("//").next().unwrap_or_default()
}

/// Paths of two parts and more in an ordinary line.
fn spoken(code: &str) -> Vec<String> {
    let words = code.split(|c: char| !c.is_alphanumeric() && c != '_' && c != ':');
    words.filter(|word| word.contains("::")).map(|word| word.trim_matches(':').to_owned()).collect()
}

/// The paths of a tree of `use`: `a::{b, c::{d, e}}` is `a::b`, `a::c::d`, `a::c::e`.
fn spread(prefix: &str, tree: &str, line: usize, found: &mut Vec<(usize, String)>) {
    let (mut depth, mut start, mut parts) = (0, 0, Vec::new());
    for (at, c) in tree.char_indices().chain([(tree.len(), ',')]) {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(tree[start..at].trim());
                start = at + 1;
            }
            _ => {}
        }
    }
    for part in parts.into_iter().filter(|part| !part.is_empty()) {
        match part.split_once('{') {
            Some((head, rest)) => {
                spread(&format!("{prefix}{head}"), rest.strip_suffix('}').unwrap_or(rest), line, found)
            }
            None => found.push((line, format!("{prefix}{part}"))),
        }
    }
}

/// Whether `path` is `name` or something in it.
fn within(path: &str, name: &str) -> bool {
    path.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with("::") || rest.starts_with(' '))
}

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

#[test]
fn slices_never_name_one_another() {
    let sources = sources();
    // `parts` holds what all of them share, and names none of them.
    let slices: Vec<&str> = sources.iter().filter_map(Source::slice).filter(|&slice| slice != "parts").collect();
    let mut broken = Vec::new();
    for source in &sources {
        let Some(own) = source.slice() else { continue };
        for (line, path) in source.paths() {
            let other = after(&path, "crate::layers::").filter(|name| *name != own && slices.contains(name));
            broken.extend(other.map(|other| format!("src/{}:{line} names {other}", source.path)));
        }
    }
    report("slices never name one another", &broken);
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
fn the_scanner_sees_what_it_should() {
    let table: [(&str, &[&str]); 8] = [
        ("use crate::base::error;", &["crate::base::error"]),
        (
            "pub(super) use crate::{base::{error, maths}, scene};",
            &["crate::base::error", "crate::base::maths", "crate::scene"],
        ),
        ("use std::{\n    fs, // files\n    io::{self, Read},\n};", &["std::fs", "std::io::self", "std::io::Read"]),
        ("let a = std::fs::read(wgpu::x(b));", &["std::fs::read", "wgpu::x"]),
        ("// crate::tui\n/// [`crate::cli`]", &[]),
        ("let image = image.width();", &[]),
        ("use winit;", &["winit"]),
        ("fn f() {}\n#[cfg(test)]\nmod tests { use crate::tui::x; }", &[]),
    ];
    for (text, expected) in table {
        let found: Vec<String> = paths(text).into_iter().map(|(_, path)| path).collect();
        assert_eq!(found, expected, "{text}");
    }
    for (path, name, expected) in [
        ("wgpu", "wgpu", true),
        ("wgpu::Device as D", "wgpu", true),
        ("wgpux::a", "wgpu", false),
        ("a::wgpu", "wgpu", false),
    ] {
        assert_eq!(within(path, name), expected, "{path}");
    }
    for room in ["base", "layers", "scene", "cli"] {
        let seen = sources().iter().any(|source| source.room() == room && !source.paths().is_empty());
        assert!(seen, "nothing seen in {room}");
    }
    assert!(sources().iter().any(|source| source.slice() == Some("folding")));
}
