//! Enforces the rules of docs/architecture.md: which module may name which, one door per outside crate, no cycles,
//! sizes.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

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
    (&["moxcms", "exr", "tiff", "zune_core", "zune_jpeg"], &["files/picture"]),
    (&["tiny_skia"], &["export/field"]),
];

/// A technique's folder: deleting it must break `layers/mod.rs` and no other slice.
const SLICES: &str = "layers/";

/// The data that slices and the rest exchange.
const SHARED: &str = "parts";

/// The only list of them.
const LIST: &str = "layers/mod.rs";

/// Tests and benches of one technique, which go with it.
const OF_ONE_TECHNIQUE: &[&str] = &[
    "benches/frames.rs",
    "benches/keys.rs",
    "benches/scenes/mod.rs",
    "benches/synthesis.rs",
    "tests/display/mod.rs",
    "tests/gpu.rs",
    "tests/profiles.rs",
    "tests/properties.rs",
    "tests/show/mod.rs",
    "tests/window.rs",
];

/// The slots of a technique: each file or folder in one of these is named by the folder's `mod.rs` alone.
const SLOTS: &[&str] = &["layers/mesh/surface/"];

/// The rungs of `tui/`: a file names only what stands in its own or to its left.
const ORDER_TUI: [&str; 11] =
    ["text", "graphics", "events", "keys", "document", "state", "tutor", "layout", "commands", "panes", "outside"];

const MOST_LINES: usize = 500;

const MOST_LINES_OF_A_FUNCTION: usize = 60;

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

    /// Whether it belongs to the program: not a test, nor a shader.
    fn is_program(&self) -> bool {
        let tests = self.path.ends_with("tests.rs") || self.path.contains("/tests/");
        self.path.ends_with(".rs") && !tests
    }

    /// Every path that the program (not its tests) names, with its line.
    fn paths(&self) -> Vec<(usize, String)> {
        if self.is_program() { paths(&self.text) } else { Vec::new() }
    }
}

fn sources() -> Vec<Source> {
    sources_in("src")
}

fn sources_in(folder: &str) -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
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

/// A path in a text.
struct Named {
    line: usize,
    path: String,
    /// Whether it stands in a `use`, which gives it a name in the file.
    used: bool,
    /// Whether that name is for others too.
    public: bool,
}

/// The paths in `text` without its tests. Braces in `use` are expanded.
fn named(text: &str) -> Vec<Named> {
    let mut found = Vec::new();
    let mut lines = program(text).into_iter();
    while let Some((at, line)) = lines.next() {
        let code = uncommented(line);
        let public = code.trim_start().starts_with("pub");
        let mut words =
            code.split_whitespace().skip_while(|word| word.starts_with("pub") || *word == "in" || word.ends_with(')'));
        if words.next() != Some("use") {
            let spoken = spoken(code).into_iter();
            found.extend(spoken.map(|path| Named { line: at + 1, path, used: false, public: false }));
            continue;
        }
        let mut tree = code.split_once("use").map_or(String::new(), |(_, tree)| tree.to_owned());
        while !tree.contains(';') {
            let Some((_, line)) = lines.next() else { break };
            tree.push_str(uncommented(line));
        }
        let mut paths = Vec::new();
        spread("", tree.trim().trim_end_matches(';'), &mut paths);
        found.extend(paths.into_iter().map(|path| Named { line: at + 1, path, used: true, public }));
    }
    found
}

/// The paths in `text`, each with its line, written out: what begins with a name that a `use` in it gives is the path of
/// that `use` and the rest.
fn paths(text: &str) -> Vec<(usize, String)> {
    let all = named(text);
    let uses = all.iter().filter(|named| named.used).map(|named| bound(&named.path));
    let names: BTreeMap<&str, &str> = uses.map(|(path, name)| (name, path)).collect();
    let whole = |path: &str| {
        let mut path = path.to_owned();
        // Names of names; not forever, since `use a::a` gives `a` itself.
        for _ in 0..3 {
            let head = path.split("::").next().unwrap_or_default();
            match names.get(head).filter(|to| to.split("::").next() != Some(head)) {
                Some(to) => path = format!("{to}{}", &path[head.len()..]),
                None => break,
            }
        }
        path
    };
    all.iter().map(|named| (named.line, whole(bound(&named.path).0))).collect()
}

/// The lines of `text` without its tests.
fn program(text: &str) -> Vec<(usize, &str)> {
    let mut lines = text.lines().enumerate();
    let mut found = Vec::new();
    while let Some((at, line)) = lines.next() {
        match line.trim() {
            "#[cfg(test)]" => skip_item(line, &mut lines),
            _ => found.push((at, line)),
        }
    }
    found
}

/// The string literals in `text` without its tests, each with its line; those with escapes or over several lines are left
/// out.
fn literals(text: &str) -> Vec<(usize, &str)> {
    let lines = program(text).into_iter().map(|(at, line)| (at + 1, uncommented(line)));
    lines.flat_map(|(at, line)| line.split('"').skip(1).step_by(2).map(move |literal| (at, literal))).collect()
}

/// Skips the item after the attribute `line`, as rustfmt lays it out: one line, or all up to the first line at the same
/// indentation that closes it.
fn skip_item<'a>(line: &str, lines: &mut impl Iterator<Item = (usize, &'a str)>) {
    let indent = &line[..line.len() - line.trim_start().len()];
    let mut open = false;
    for (_, line) in lines {
        let code = line.strip_prefix(indent).unwrap_or_default();
        let is_attribute = !open && (code.starts_with("#[") || code.starts_with("//"));
        let starts_here = code.starts_with(|c: char| !c.is_whitespace());
        if is_attribute || !starts_here && !line.is_empty() {
            open |= starts_here && !is_attribute;
            continue;
        }
        // `fn f(` and `) -> T {` go on; `}`, `};`, `mod tests;` and `fn f() {}` end.
        if code.ends_with('}') || code.ends_with(';') {
            return;
        }
        open = true;
    }
}

/// What modules pass on of others by `pub use`: module and name, and the path that this stands for.
fn passed_on(sources: &[Source]) -> BTreeMap<Vec<String>, Vec<String>> {
    let mut all = BTreeMap::new();
    for source in sources.iter().filter(|source| source.is_program()) {
        let own = module(&source.path);
        for Named { path, .. } in named(&source.text).into_iter().filter(|named| named.public) {
            let (path, name) = bound(&path);
            let key = own.iter().copied().chain([name]).map(str::to_owned).collect();
            all.insert(key, absolute(&own, path));
        }
    }
    all
}

/// The path of an item of a `use`, and the name that it gets.
fn bound(path: &str) -> (&str, &str) {
    let (path, name) = path.split_once(" as ").unwrap_or((path, ""));
    let path = path.strip_suffix("::self").unwrap_or(path);
    (path, if name.is_empty() { path.rsplit("::").next().unwrap_or_default() } else { name })
}

/// The path from the root of the program that `path` means in the module `own`.
fn absolute(own: &[&str], path: &str) -> Vec<String> {
    let mut at: Vec<&str> = own.to_vec();
    for part in path.split("::") {
        match part {
            "crate" => at.clear(),
            "self" => {}
            "super" => drop(at.pop()),
            part => at.push(part),
        }
    }
    at.into_iter().map(str::to_owned).collect()
}

/// The functions in `text`, as rustfmt lays them out: first line, name, number of lines.
fn functions(text: &str) -> Vec<(usize, &str, usize)> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        let code = line.trim_start();
        let indent = &line[..line.len() - code.len()];
        let mut words = code.split(' ').skip_while(|word| word.starts_with("pub") || ["const", "async"].contains(word));
        let (Some("fn"), Some(name)) = (words.next(), words.next()) else { continue };
        if line.ends_with(';') {
            continue;
        }
        // It ends with the first line at its own indentation: the brace, or the end of a declaration without a body.
        let back = |line: &str| {
            line.strip_prefix(indent).is_some_and(|rest| rest.starts_with(['}', ')']) && !rest.ends_with('{'))
        };
        let length =
            if line.ends_with('}') { 1 } else { lines[i..].iter().position(|line| back(line)).unwrap_or(0) + 1 };
        if !lines[i + length - 1].ends_with(';') {
            found.push((i + 1, name.split(['(', '<']).next().unwrap_or_default(), length));
        }
    }
    found
}

fn uncommented(line: &str) -> &str {
    line.split("//").next().unwrap_or_default()
}

/// Paths of at least two parts in an ordinary line.
fn spoken(code: &str) -> Vec<String> {
    let words = code.split(|c: char| !c.is_alphanumeric() && c != '_' && c != ':');
    words.filter(|word| word.contains("::")).map(|word| word.trim_matches(':').to_owned()).collect()
}

/// The paths in a `use` tree: `a::{b, c::{d, e}}` is `a::b`, `a::c::d`, `a::c::e`.
fn spread(prefix: &str, tree: &str, found: &mut Vec<String>) {
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
            Some((head, rest)) => spread(&format!("{prefix}{head}"), rest.strip_suffix('}').unwrap_or(rest), found),
            None => found.push(format!("{prefix}{part}")),
        }
    }
}

/// The module of a file: `layers/folding/mod.rs` is `layers::folding`.
fn module(file: &str) -> Vec<&str> {
    let stem = file.trim_end_matches(".rs");
    stem.strip_suffix("/mod").unwrap_or(stem).split('/').collect()
}

/// Where paths lead.
struct Map<'a> {
    /// The files of all modules.
    files: BTreeMap<Vec<String>, &'a str>,
    /// See [`passed_on`].
    passed: BTreeMap<Vec<String>, Vec<String>>,
}

impl<'a> Map<'a> {
    fn new(sources: &'a [Source]) -> Self {
        let program = sources.iter().filter(|source| source.path.ends_with(".rs"));
        let files = program.map(|source| (absolute(&[], &module(&source.path).join("::")), source.path.as_str()));
        Map { files: files.collect(), passed: passed_on(sources) }
    }

    /// The file that a path in a file leads to, past modules that only pass it on; `None` if it leads out of the program.
    fn leads_to(&self, file: &str, path: &str) -> Option<&'a str> {
        let (own, head) = (module(file), path.split("::").next()?);
        let mut at = absolute(&own, path);
        // Otherwise a module inside this one, or what it passes on.
        let begin = &at[..at.len().min(own.len() + 1)];
        if !["crate", "self", "super"].contains(&head)
            && !self.files.contains_key(begin)
            && !self.passed.contains_key(begin)
        {
            return None;
        }
        for _ in 0..8 {
            let known = |n: &usize| !self.files.contains_key(&at[..*n]) && self.passed.contains_key(&at[..*n]);
            let Some(n) = (1..=at.len()).find(known) else { break };
            at = [&self.passed[&at[..n]][..], &at[n..]].concat();
        }
        // What is not a module is something in one.
        while !at.is_empty() && !self.files.contains_key(&at) {
            at.pop();
        }
        self.files.get(&at).copied().filter(|&found| found != file)
    }
}

/// Groups of files that all lead to each other, directly or through others in the group (strongly connected components,
/// Tarjan 1972).
fn circles(arrows: &BTreeMap<&str, BTreeSet<&str>>) -> Vec<Vec<String>> {
    #[derive(Default)]
    struct Walk<'a> {
        number: BTreeMap<&'a str, usize>,
        low: BTreeMap<&'a str, usize>,
        path: Vec<&'a str>,
        found: Vec<Vec<String>>,
    }
    fn visit<'a>(at: &'a str, arrows: &BTreeMap<&'a str, BTreeSet<&'a str>>, walk: &mut Walk<'a>) {
        let number = walk.number.len();
        walk.number.insert(at, number);
        walk.low.insert(at, number);
        walk.path.push(at);
        for &to in arrows.get(at).into_iter().flatten() {
            if !walk.number.contains_key(to) {
                visit(to, arrows, walk);
            }
            // A file that is no longer on the path belongs to a group that was found already.
            if walk.path.contains(&to) {
                let low = walk.low[at].min(walk.low[to]);
                walk.low.insert(at, low);
            }
        }
        if walk.low[at] == number {
            let from = walk.path.iter().position(|&file| file == at).unwrap_or_default();
            let group: Vec<String> = walk.path.drain(from..).map(str::to_owned).collect();
            if group.len() > 1 {
                walk.found.push(group);
            }
        }
    }
    let mut walk = Walk::default();
    for &file in arrows.keys() {
        if !walk.number.contains_key(file) {
            visit(file, arrows, &mut walk);
        }
    }
    walk.found
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
    for source in sources.iter().filter(|source| source.is_program() && source.path != LIST && !own(source)) {
        let named = names_of_techniques(source, &techniques, &variants);
        broken.extend(named.into_iter().map(|(line, path)| format!("src/{}:{line} names {path}", source.path)));
    }
    report("only layers/mod.rs names a technique", &broken);
}

#[test]
fn few_tests_and_benches_name_a_technique() {
    let sources = sources();
    let (techniques, variants) = (techniques(&sources), variants(&sources));
    let mut found = BTreeSet::new();
    for folder in ["tests", "benches"] {
        // The names in this file are examples.
        for source in sources_in(folder).into_iter().filter(|source| source.path != "house.rs") {
            if !names_of_techniques(&source, &techniques, &variants).is_empty() {
                found.insert(format!("{folder}/{}", source.path));
            }
        }
    }
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
        // A folder's files are part of its `mod.rs`: they may use what it declares.
        let above = |file: &&str| file.strip_suffix("mod.rs").is_some_and(|folder| source.path.starts_with(folder));
        arrows.insert(&source.path, to.filter(|file| !above(file)).collect());
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
    let sources = sources();
    for source in sources.iter().filter(|source| source.is_program()) {
        let text = source.text.split("\n#[cfg(test)]\nmod tests {").next().unwrap_or_default();
        let long = functions(text).into_iter().filter(|&(.., lines)| lines > MOST_LINES_OF_A_FUNCTION);
        broken.extend(long.map(|(at, name, lines)| format!("src/{}:{at} {name}: {lines} lines", source.path)));
    }
    report(&format!("{MOST_LINES_OF_A_FUNCTION} lines a function"), &broken);
}

#[test]
fn functions_and_circles_are_found() {
    let text = "impl A {\n    pub fn a<T>(\n        b: T,\n    ) -> T {\n        let b = b;\n        b\n    }\n\n    fn c();\n}\nconst fn d() {}\n\
                trait B {\n    fn e(\n        f: u8,\n    ) -> u8;\n}\n";
    assert_eq!(functions(text), [(2, "a", 6), (11, "d", 1)]);
    let arrows = |all: &[(&'static str, &[&'static str])]| -> BTreeMap<&str, BTreeSet<&str>> {
        all.iter().map(|(from, to)| (*from, to.iter().copied().collect())).collect()
    };
    assert!(circles(&arrows(&[("a", &["b", "c"]), ("b", &["c"]), ("c", &[])])).is_empty());
    let found = circles(&arrows(&[("a", &["b"]), ("b", &["c", "d"]), ("c", &["a"]), ("d", &["e"]), ("e", &["d"])]));
    let mut found: Vec<BTreeSet<String>> = found.into_iter().map(|circle| circle.into_iter().collect()).collect();
    found.sort();
    assert_eq!(found, [["a", "b", "c"].map(str::to_owned).into(), ["d", "e"].map(str::to_owned).into()]);
    let files = ["layers/mod.rs", "layers/folding/mod.rs", "layers/folding/frame.rs", "base/maths.rs"];
    let text = |file: &&str| match *file {
        "layers/mod.rs" => "pub use folding::frame::Frame as Picture;\npub(crate) use crate::base::maths::sin;",
        _ => "",
    };
    let sources: Vec<Source> =
        files.iter().map(|file| Source { path: (*file).to_owned(), text: text(file).to_owned() }).collect();
    let map = Map::new(&sources);
    for (file, path, to) in [
        ("layers/folding/frame.rs", "super::super::Layer", Some("layers/mod.rs")),
        ("layers/folding/frame.rs", "super::self", Some("layers/folding/mod.rs")),
        ("layers/folding/mod.rs", "frame::Frame", Some("layers/folding/frame.rs")),
        ("layers/folding/mod.rs", "super::Picture", Some("layers/folding/frame.rs")),
        ("layers/folding/mod.rs", "crate::layers::Picture::new", Some("layers/folding/frame.rs")),
        ("layers/folding/mod.rs", "super::sin", Some("base/maths.rs")),
        ("layers/folding/frame.rs", "crate::base::maths::sin", Some("base/maths.rs")),
        ("layers/folding/frame.rs", "Vec::new", None),
        ("layers/folding/frame.rs", "self::own", None),
    ] {
        assert_eq!(map.leads_to(file, path), to, "{file} {path}");
    }
}

#[test]
fn the_scanner_sees_what_it_should() {
    let table: [(&str, &[&str]); 12] = [
        ("use crate::base::error;", &["crate::base::error"]),
        (
            "pub(super) use crate::{base::{error, maths}, scene};",
            &["crate::base::error", "crate::base::maths", "crate::scene"],
        ),
        ("use std::{\n    fs, // files\n    io::{self, Read},\n};", &["std::fs", "std::io", "std::io::Read"]),
        ("let a = std::fs::read(wgpu::x(b));", &["std::fs::read", "wgpu::x"]),
        ("// crate::tui\n/// [`crate::cli`]", &[]),
        ("let image = image.width();", &[]),
        ("use winit;", &["winit"]),
        (
            "use crate::layers::Layer as L;\nlet a = L::Mesh(b);",
            &["crate::layers::Layer", "crate::layers::Layer::Mesh"],
        ),
        ("use crate::a::Layer;\nuse Layer::Mesh as M;", &["crate::a::Layer", "crate::a::Layer::Mesh"]),
        ("#[cfg(test)]\nuse a::b;\n#[cfg(test)]\nfn c(\n    d: u8,\n) {\n    e::f();\n}\nfn g() { h::i() }", &["h::i"]),
        (
            "impl A {\n    #[cfg(test)]\n    #[inline]\n    fn c() {\n        e::f();\n    }\n\n    fn g() { h::i() }\n}",
            &["h::i"],
        ),
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
