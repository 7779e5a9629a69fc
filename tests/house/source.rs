//! Reads the sources as far as the rules need: which paths a file names, where they lead, and which files lead to each
//! other. Tests are not part of the program.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// A technique's folder: deleting it must break `layers/mod.rs` and no other slice.
pub const SLICES: &str = "layers/";

/// The data that slices and the rest exchange.
pub const SHARED: &str = "parts";

pub struct Source {
    /// Relative to `src`, with `/`.
    pub path: String,
    pub text: String,
}

impl Source {
    pub fn room(&self) -> &str {
        self.path.split(['/', '.']).next().unwrap_or_default()
    }

    pub fn slice(&self) -> Option<&str> {
        let slice = self.path.strip_prefix(SLICES)?.split_once('/').map(|(slice, _)| slice);
        slice.filter(|slice| *slice != SHARED)
    }

    /// Whether it belongs to the program: not a test, nor a shader.
    pub fn is_program(&self) -> bool {
        let tests = self.path.ends_with("tests.rs") || self.path.contains("/tests/");
        self.path.ends_with(".rs") && !tests
    }

    /// Every path that the program (not its tests) names, with its line.
    pub fn paths(&self) -> Vec<(usize, String)> {
        if self.is_program() { paths(&self.text) } else { Vec::new() }
    }
}

pub fn sources() -> Vec<Source> {
    sources_in("src")
}

pub fn sources_in(folder: &str) -> Vec<Source> {
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

pub fn files(folder: &Path, found: &mut Vec<PathBuf>) {
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
pub struct Named {
    pub line: usize,
    pub path: String,
    /// Whether it stands in a `use`, which gives it a name in the file.
    pub used: bool,
    /// Whether that name is for others too.
    pub public: bool,
}

/// The paths in `text` without its tests. Braces in `use` are expanded.
pub fn named(text: &str) -> Vec<Named> {
    let mut found = Vec::new();
    let mut lines = program(text).into_iter();
    while let Some((at, line)) = lines.next() {
        let code = uncommented(line);
        let public = code.trim_start().starts_with("pub");
        let mut words =
            code.split_whitespace().skip_while(|word| word.starts_with("pub") || *word == "in" || word.ends_with(')'));
        if words.next() != Some("use") {
            // Who may see it is not named by it: `pub(in a::b)`.
            let seen = code.split_once("pub(in ").and_then(|(_, rest)| rest.split_once(')'));
            let spoken = spoken(seen.map_or(code, |(_, rest)| rest)).into_iter();
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
pub fn paths(text: &str) -> Vec<(usize, String)> {
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
pub fn program(text: &str) -> Vec<(usize, &str)> {
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
pub fn literals(text: &str) -> Vec<(usize, &str)> {
    let lines = program(text).into_iter().map(|(at, line)| (at + 1, uncommented(line)));
    lines.flat_map(|(at, line)| line.split('"').skip(1).step_by(2).map(move |literal| (at, literal))).collect()
}

/// Skips the item after the attribute `line`, as rustfmt lays it out: one line, or all up to the first line at the same
/// indentation that closes it.
pub fn skip_item<'a>(line: &str, lines: &mut impl Iterator<Item = (usize, &'a str)>) {
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

/// The paths that a file passes on by `pub use`.
pub fn passed_by(source: &Source) -> Vec<String> {
    let public = named(&source.text).into_iter().filter(|named| named.public);
    public.map(|named| bound(&named.path).0.to_owned()).collect()
}

/// What modules pass on of others by `pub use`: module and name, and the path that this stands for.
pub fn passed_on(sources: &[Source]) -> BTreeMap<Vec<String>, Vec<String>> {
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
pub fn bound(path: &str) -> (&str, &str) {
    let (path, name) = path.split_once(" as ").unwrap_or((path, ""));
    let path = path.strip_suffix("::self").unwrap_or(path);
    (path, if name.is_empty() { path.rsplit("::").next().unwrap_or_default() } else { name })
}

/// The path from the root of the program that `path` means in the module `own`.
pub fn absolute(own: &[&str], path: &str) -> Vec<String> {
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
pub fn functions(text: &str) -> Vec<(usize, &str, usize)> {
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

pub fn uncommented(line: &str) -> &str {
    line.split("//").next().unwrap_or_default()
}

/// Paths of at least two parts in an ordinary line.
pub fn spoken(code: &str) -> Vec<String> {
    let words = code.split(|c: char| !c.is_alphanumeric() && c != '_' && c != ':');
    words.filter(|word| word.contains("::")).map(|word| word.trim_matches(':').to_owned()).collect()
}

/// The paths in a `use` tree: `a::{b, c::{d, e}}` is `a::b`, `a::c::d`, `a::c::e`.
pub fn spread(prefix: &str, tree: &str, found: &mut Vec<String>) {
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
pub fn module(file: &str) -> Vec<&str> {
    let stem = file.trim_end_matches(".rs");
    stem.strip_suffix("/mod").unwrap_or(stem).split('/').collect()
}

/// Where paths lead.
pub struct Map<'a> {
    /// The files of all modules.
    files: BTreeMap<Vec<String>, &'a str>,
    /// See [`passed_on`].
    passed: BTreeMap<Vec<String>, Vec<String>>,
}

impl<'a> Map<'a> {
    pub fn new(sources: &'a [Source]) -> Self {
        let program = sources.iter().filter(|source| source.path.ends_with(".rs"));
        let files = program.map(|source| (absolute(&[], &module(&source.path).join("::")), source.path.as_str()));
        Map { files: files.collect(), passed: passed_on(sources) }
    }

    /// The file that a path in a file leads to, past modules that only pass it on; `None` if it leads out of the program.
    pub fn leads_to(&self, file: &str, path: &str) -> Option<&'a str> {
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
pub fn circles(arrows: &BTreeMap<&str, BTreeSet<&str>>) -> Vec<Vec<String>> {
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
pub fn within(path: &str, name: &str) -> bool {
    path.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with("::") || rest.starts_with(' '))
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
    let table: [(&str, &[&str]); 13] = [
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
        ("    pub(in crate::files) fn f(a: b::C) {}", &["b::C"]),
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
