//! `plica completions`: what a shell needs to complete the command line. What only the program knows, the names of demos and of
//! what is in a scene, its script asks for with every Tab.

use std::path::Path;

use clap_complete::Shell;

use super::Context;
use crate::base::error::{Error, Result};
use crate::files::{self, profiles};
use crate::scene::{Document, complete};

/// Print a completion script for a shell
#[derive(clap::Args)]
pub struct Args {
    /// The shell
    #[arg(required_unless_present = "of")]
    shell: Option<Shell>,
    /// The words so far, for which the names that only the program knows are printed
    #[arg(long, hide = true, num_args = 0.., allow_hyphen_values = true)]
    of: Option<Vec<String>>,
}

/// Prints the completions of the whole command line.
pub fn run(args: Args, mut whole: clap::Command, context: &mut Context) -> Result<()> {
    if let Some(words) = args.of {
        let words: Vec<String> = words.iter().map(|word| unquoted(word)).collect();
        let names = names(&words).ok_or_else(|| Error::Usage("the shell itself completes this".into()))?;
        return nearest(names, words.last().map_or("", String::as_str)).iter().try_for_each(|name| context.print(name));
    }
    let shell = args.shell.unwrap_or(Shell::Bash);
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut whole, "plica", &mut script);
    let script = String::from_utf8_lossy(&script);
    context.print(format_args!("{}{}", script.trim_end(), own(shell)))
}

/// What follows the script of a shell: it asks the program first.
fn own(shell: Shell) -> &'static str {
    match shell {
        Shell::Bash => {
            r#"
_plica_names() {
    local IFS=$'\n'
    local all name
    if ! all=$(plica completions --of "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null); then
        _plica "$@"
        return
    fi
    COMPREPLY=()
    for name in $all; do
        COMPREPLY+=("$(printf '%q' "$name")")
    done
    case "${COMPREPLY[0]}" in layers* | images* | *.*) compopt -o nospace ;; esac
}
complete -F _plica_names -o bashdefault -o default plica"#
        }
        Shell::Zsh => {
            r#"
_plica_names() {
    local all
    local -a names
    if all=$(plica completions --of "${(@)words[2,CURRENT]}" 2>/dev/null); then
        names=(${(f)all})
        compadd -S '' -a names
    else
        _plica "$@"
    fi
}
compdef _plica_names plica"#
        }
        Shell::Fish => {
            r#"
complete -c plica -a '(plica completions --of (commandline -opc)[2..] (commandline -ct) 2>/dev/null)'"#
        }
        _ => "",
    }
}

/// A word as a shell has it, without the quotes and backslashes around its characters.
fn unquoted(word: &str) -> String {
    let mut plain = String::new();
    let mut chars = word.chars();
    while let Some(c) = chars.next() {
        match c {
            '\\' => plain.extend(chars.next()),
            '"' | '\'' => {}
            c => plain.push(c),
        }
    }
    plain
}

/// The names that go on as was typed, if there are any: a shell takes back what is not common to all.
fn nearest(names: Vec<String>, typed: &str) -> Vec<String> {
    let goes_on = |name: &&String| name.starts_with(typed);
    let going_on: Vec<String> = names.iter().filter(goes_on).cloned().collect();
    if going_on.is_empty() { names } else { going_on }
}

/// The names that the last of these words may become, the subcommand first; `None` if the shell knows them itself.
fn names(words: &[String]) -> Option<Vec<String>> {
    let [sub, .., last] = words else { return None };
    let before = &words[words.len() - 2];
    let of_scene = |find: fn(&Document, &str) -> Vec<String>, typed: &str| {
        let scene = words[1..words.len() - 1].iter().map(Path::new).find(|path| path.is_file())?;
        let document = files::scene::open(scene, &files::Options::default()).ok()?;
        Some(find(&document, typed))
    };
    match (sub.as_str(), before.as_str()) {
        ("demo", "demo") => {
            let names =
                profiles::TABLE.iter().map(|profile| profile.name).filter(|name| name.starts_with(last.as_str()));
            Some(names.map(str::to_owned).collect())
        }
        (_, "--layer") => of_scene(layers, last),
        (_, "--zone") => of_scene(zones, last),
        // bash makes three words of PATH=VALUE.
        ("set", path) if last == "=" => of_scene(complete::values, &format!("{path}=")),
        ("set", "=") => of_scene(complete::values, &format!("{}={last}", words[words.len() - 3])),
        ("set", path) if last.contains('=') && path != "=" => {
            let (address, _) = last.split_once('=')?;
            let values = of_scene(complete::values, last)?.into_iter();
            Some(values.map(|value| format!("{address}={value}")).collect())
        }
        ("set" | "get", _) if words.len() > 2 && !last.starts_with('-') => of_scene(complete::paths, last),
        _ => None,
    }
}

fn layers(document: &Document, typed: &str) -> Vec<String> {
    let names = document.scene().layers.iter().map(|layer| layer.technique().name().to_owned());
    names.filter(|name| name.starts_with(typed)).collect()
}

/// The names of the things in layers that have some.
fn zones(document: &Document, typed: &str) -> Vec<String> {
    let layers = document.json().get("layers").and_then(|layers| layers.as_array()).into_iter().flatten();
    let lists = layers.filter_map(|layer| layer.as_object()).flat_map(|layer| layer.values());
    let items = lists.filter_map(|list| list.as_array()).flatten();
    let names = items.filter_map(|item| item.get("name")?.as_str());
    names.filter(|name| name.starts_with(typed)).map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_only_the_program_knows_are_completed() {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("a.plica.json");
        let text = r##"{ "plica": 1, "images": { "a": { "path": "a.png" } }, "layers": [
            { "kind": "picture", "name": "face", "image": "a", "zones": [
              { "name": "left eye", "outline": { "kind": "rectangle", "x": 0, "y": 0, "width": 9, "height": 9 } },
              { "name": "lid", "outline": { "kind": "rectangle", "x": 0, "y": 0, "width": 9, "height": 9 } }] },
            { "kind": "fill", "name": "ground" }] }"##;
        std::fs::write(&scene, text).unwrap();
        let scene = scene.to_str().unwrap();
        let none: Option<Vec<&str>> = None;
        for (words, expected) in [
            (&["demo", "bl"][..], Some(vec!["blink"])),
            (&["set", scene, "lay"], Some(vec!["layers"])),
            (
                &["get", scene, "layers.face.zones."],
                Some(vec!["layers.face.zones.\"left eye\"", "layers.face.zones.lid"]),
            ),
            (&["field", scene, "--zone", "l"], Some(vec!["left eye", "lid"])),
            (&["probe", scene, "--layer", ""], Some(vec!["face", "ground"])),
            (&["set", scene, "layers.face.zones.lid.outline.kind", "=", "po"], Some(vec!["polygon"])),
            (
                &["set", scene, "layers.face.zones.lid.outline.kind", "="],
                Some(vec!["rectangle", "ellipse", "polygon", "path", "shapes"]),
            ),
            (&["set", scene, "timeline.loop=p"], Some(vec!["timeline.loop=ping-pong"])),
            (&["set", scene, "layers.face.name="], Some(vec![])),
            (&["render", scene, "-o", ""], none.clone()),
            (&["set", scene], none.clone()),
            (&["set", "no/scene", "lay"], none.clone()),
            (&["demo"], none.clone()),
            (&[], none),
        ] {
            let words: Vec<String> = words.iter().map(|word| (*word).to_owned()).collect();
            let expected = expected.map(|names| names.into_iter().map(str::to_owned).collect::<Vec<_>>());
            assert_eq!(names(&words), expected, "{words:?}");
        }
    }

    #[test]
    fn what_was_typed_is_read_as_the_shell_does_and_never_taken_back() {
        for (word, plain) in
            [(r"my\ eye.json", "my eye.json"), (r#"zones.\"left"#, "zones.\"left"), ("'a b'", "a b"), ("\\", "")]
        {
            assert_eq!(unquoted(word), plain, "{word}");
        }
        let all = || vec!["a.lid".to_owned(), "a.\"left eye\"".to_owned()];
        assert_eq!(nearest(all(), "a.l"), ["a.lid"]);
        assert_eq!(nearest(all(), "a."), all());
        assert_eq!(nearest(all(), "a.x"), all());
    }
}
