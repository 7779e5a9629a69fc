//! `plica completions`: what a shell needs to complete the command line. What only the program knows, the names of demos and of
//! what is in a scene, its script asks for with every Tab.

use std::path::Path;

use clap::CommandFactory;
use clap_complete::Shell;

use super::Context;
use super::command_line::CommandLine;
use crate::base::error::Result;
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

/// Prints the completions.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    if let Some(words) = args.of {
        return names(&words).iter().try_for_each(|name| context.print(name));
    }
    let shell = args.shell.unwrap_or(Shell::Bash);
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut CommandLine::command(), "plica", &mut script);
    let script = String::from_utf8_lossy(&script);
    context.print(format_args!("{}{}", script.trim_end(), own(shell)))
}

/// What follows the script of a shell: it asks the program first.
fn own(shell: Shell) -> &'static str {
    match shell {
        Shell::Bash => {
            r#"
_plica_names() {
    local IFS=$'\n' word="${COMP_WORDS[COMP_CWORD]}"
    local names=($(plica completions --of "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null))
    if ((${#names[@]} == 0)); then
        _plica "$@"
        return
    fi
    COMPREPLY=()
    local name
    for name in "${names[@]}"; do
        COMPREPLY+=("$(printf '%q' "$name")")
    done
    case "${names[0]}" in layers* | images* | *.*) compopt -o nospace ;; esac
}
complete -F _plica_names -o bashdefault -o default plica"#
        }
        Shell::Zsh => {
            r#"
_plica_names() {
    local -a names
    names=(${(f)"$(plica completions --of "${(@)words[2,CURRENT]}" 2>/dev/null)"})
    if (( ${#names} )); then
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

/// The names that the last of these words may become, the subcommand first; empty if the shell knows them itself.
fn names(words: &[String]) -> Vec<String> {
    let [sub, .., last] = words else { return Vec::new() };
    let before = &words[words.len() - 2];
    let of_scene = |find: fn(&Document, &str) -> Vec<String>| {
        let scene = words[1..words.len() - 1].iter().map(Path::new).find(|path| path.is_file());
        let open = |path: &Path| files::scene::open(path, &files::Options::default()).ok();
        scene.and_then(open).map_or(Vec::new(), |document| find(&document, last))
    };
    match (sub.as_str(), before.as_str()) {
        ("demo", "demo") => {
            let names =
                profiles::TABLE.iter().map(|profile| profile.name).filter(|name| name.starts_with(last.as_str()));
            names.map(str::to_owned).collect()
        }
        (_, "--layer") => of_scene(layers),
        (_, "--zone") => of_scene(zones),
        ("set" | "get", _) if words.len() > 2 && !last.starts_with('-') => of_scene(complete::paths),
        _ => Vec::new(),
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
              { "name": "left eye", "outline": { "kind": "rectangle", "x": 0, "y": 0, "width": 9, "height": 9 } }] },
            { "kind": "fill", "name": "ground" }] }"##;
        std::fs::write(&scene, text).unwrap();
        let scene = scene.to_str().unwrap();
        for (words, expected) in [
            (&["demo", "bl"][..], vec!["blink"]),
            (&["set", scene, "lay"], vec!["layers"]),
            (&["get", scene, "layers.face.zones."], vec!["layers.face.zones.\"left eye\""]),
            (&["field", scene, "--zone", "l"], vec!["left eye"]),
            (&["probe", scene, "--layer", ""], vec!["face", "ground"]),
            (&["render", scene, "-o", ""], vec![]),
            (&["set", scene], vec![]),
            (&["set", "no/scene", "lay"], vec![]),
            (&["demo"], vec![]),
            (&[], vec![]),
        ] {
            let words: Vec<String> = words.iter().map(|word| (*word).to_owned()).collect();
            assert_eq!(names(&words), expected, "{words:?}");
        }
    }
}
