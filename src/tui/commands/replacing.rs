//! Replaces a part of names and texts, or a number, wherever it is written. What would change is listed first.

use serde_json::Value;

use super::command::{Call, Command, Done, command};
use crate::base::number;
use crate::base::pointer::Pointer;
use crate::base::text::counted;
use crate::files::{clips, paths};
use crate::layers::parts::materials::List;
use crate::scene::field::{self, Kind};
use crate::scene::{Document, Edit};
use crate::tui::document::choice::{Choice, Then};
use crate::tui::document::places;
use crate::tui::state::{Mode, State};
use crate::tui::text::said::{one_word, words};
use crate::tui::text::{numbers, plain};

pub const COMMANDS: &[Command] = &[
    command(
        "replace",
        "FROM TO [PATH]",
        "Replace a part of names and texts, or a number, in the scene or below a path; what would change is listed first",
        preview,
    )
    .inside(),
    command("replace!", "FROM TO [PATH]", "Replace it at once", replace).change(),
];

/// What all the places are called in the list.
const ALL: &str = "all";

/// A place where something is replaced.
struct Replacement {
    pointer: String,
    address: String,
    old: String,
    new: New,
}

/// What is there then.
enum New {
    /// Another value.
    Value(Value, String),
    /// The entry of a list of the scene has another name, everywhere.
    Name(List, String),
}

impl Replacement {
    fn told(&self) -> String {
        let (New::Value(_, new) | New::Name(_, new)) = &self.new;
        plain(&format!("{} → {new}", self.old))
    }
}

fn preview(state: &mut State, call: &Call) -> Done {
    state.scene.writable()?;
    let found = found(state, &words(call.text)?)?;
    let all = (ALL.to_owned(), format!("Replace in {}", counted(found.len(), "place")));
    let each = found.iter().map(|one| (one.address.clone(), one.told()));
    let options = std::iter::once(all).chain(each).collect();
    let then = Then::Replace(call.text.to_owned());
    state.typing.mode = Mode::Choice(Choice { title: "replace".into(), options, at: 0, then });
    Ok(())
}

/// Replaces in all places that were listed, or in the chosen one.
pub fn taken(state: &mut State, call: &Call, asked: &str, word: &str) -> Done {
    state.typing.mode = Mode::Normal;
    if word == ALL {
        return call.obey(state, &format!("replace! {asked}"));
    }
    let from_to: Vec<String> = words(asked)?.iter().take(2).map(|word| one_word(word)).collect();
    call.obey(state, &format!("replace! {} {}", from_to.join(" "), one_word(word)))
}

fn replace(state: &mut State, call: &Call) -> Done {
    let document = state.document();
    let found = found(state, &words(call.text)?)?;
    let edit = |one: &Replacement| match &one.new {
        New::Value(value, _) => Edit::set(document, &one.pointer, value.clone()),
        New::Name(list, to) => Edit::rename(document, *list, &one.old, to),
    };
    // Entries move when they are renamed, so that comes last.
    let (values, names): (Vec<&Replacement>, Vec<&Replacement>) =
        found.iter().partition(|one| matches!(one.new, New::Value(..)));
    let edit = Edit::all(values.into_iter().chain(names).map(edit));
    state.edit(edit, false)?;
    state.say(format!("replaced in {}", counted(found.len(), "place")));
    Ok(())
}

/// The places, in order.
fn found(state: &State, words: &[String]) -> Result<Vec<Replacement>, String> {
    let document = state.document();
    let (from, to, within) = match words {
        [from, to] => (from, to, String::new()),
        [from, to, path] => (from, to, state.resolve(path)?),
        _ => return Err("replace takes FROM and TO, those with spaces in double quotes".into()),
    };
    if from.is_empty() {
        return Err("replace needs something to look for".into());
    }
    let number = |text: &str| text.parse::<f64>().ok().filter(|number| number.is_finite());
    let both = number(from).zip(number(to));
    let (mut all, mut missing, mut words) = (Vec::new(), None, None);
    for place in places::list(document) {
        if !Pointer(&place.pointer).is_within(&within) {
            continue;
        }
        let Some(value) = document.json().pointer(&place.pointer) else { continue };
        let (pointer, address) = (&place.pointer, &place.address);
        let mut add = |old: String, new| {
            all.push(Replacement { pointer: pointer.clone(), address: address.clone(), old, new });
        };
        if let Some((list, name)) = List::entry(pointer).filter(|(_, name)| name.contains(from.as_str())) {
            let new = name.replace(from.as_str(), to);
            add(name, New::Name(list, new));
        }
        match (value, both) {
            (Value::String(text), _) if text.contains(from.as_str()) => {
                let new = text.replace(from.as_str(), to);
                match kind_of(document, pointer) {
                    // A path has to lead somewhere.
                    Some(Kind::Text) if is_path(pointer) && !is_file(state, &new) => {
                        missing = Some((address.clone(), new))
                    }
                    Some(Kind::Text) => add(text.clone(), New::Value(new.clone().into(), new)),
                    Some(Kind::Choice(_)) => words = Some((address.clone(), text.clone())),
                    _ => {}
                }
            }
            (Value::Number(_) | Value::Array(_), Some(change)) if !place.node => {
                let new = renumbered(value, change);
                if new != *value {
                    add(shown(value), New::Value(new.clone(), shown(&new)));
                }
            }
            _ => {}
        }
    }
    match (missing, words) {
        _ if !all.is_empty() => Ok(all),
        (Some((address, path)), _) => {
            Err(plain(&format!("{address} stays: there is no file {path} (rename it first)")))
        }
        (_, Some((address, word))) => Err(plain(&format!(
            "{address} is {word}, one of several words, which :set and Enter change: only names, texts and numbers are replaced"
        ))),
        _ => Err(format!("nothing here has {from} in it")),
    }
}

fn kind_of(document: &Document, pointer: &str) -> Option<Kind> {
    field::field(document, pointer).map(|field| field.kind)
}

/// Whether a path of the scene leads to something; that of a clip has a pattern in it, that of a model a number after it.
fn is_file(state: &State, path: &str) -> bool {
    let place = paths::beside(state.scene.path(), path);
    place.exists() || path.contains('%') && clips::find(&place).is_ok()
}

/// Whether a value is the path of a file.
fn is_path(pointer: &str) -> bool {
    Pointer(pointer).split().is_some_and(|(_, name)| name == "path")
}

/// A number, or the numbers of a vector, with one of them replaced.
fn renumbered(value: &Value, (from, to): (f64, f64)) -> Value {
    match value {
        Value::Array(items) => items.iter().map(|item| renumbered(item, (from, to))).collect(),
        value if value.as_f64().is_some_and(|own| number::tidy(own) == from) => number::json(to),
        value => value.clone(),
    }
}

fn shown(value: &Value) -> String {
    match value {
        Value::Array(items) => items.iter().map(shown).collect::<Vec<_>>().join(", "),
        value => value.as_f64().map(numbers::shown).unwrap_or_default(),
    }
}
