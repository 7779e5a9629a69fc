//! Search in names and values, marks, the jump list, and going to the same place of the next item.

use super::command::{Call, Command, Done, command};
use crate::base::pointer::{self, Pointer};
use crate::scene::schema::{Body, Place};
use crate::scene::{address, field};
use crate::tui::document::cell::{Part, is_node, summary};
use crate::tui::document::choice::{Choice, Then};
use crate::tui::document::places::Sought;
use crate::tui::events::Effect;
use crate::tui::state::{Mode, Pane, State};
use crate::tui::text::plain;
use crate::tui::text::said::unquoted;

pub const COMMANDS: &[Command] = &[
    command("search", "next|previous|TEXT", "Go to the next place with that name or value", search).counted(),
    command(
        "go",
        "PATH",
        "Go to the node or the field at a path, .NAME to the nearest around the cursor; without one, to the scene",
        go,
    ),
    command("mark", "a..z", "Set a mark here", mark),
    command("jump-mark", "a..z", "Go to a mark", jump_mark),
    command("jumps", "[older|newer]", "Go back and forward along the jumps, or list them", jumps)
        .counted_with(&["older", "newer"]),
    command("sibling", "next|previous", "Go to the same place of the next item like this one", sibling).counted(),
];

/// The letter that a command takes.
///
/// # Errors
/// It is none.
pub fn letter(text: &str, what: &str) -> Result<char, String> {
    let mut letters = text.chars();
    match (letters.next(), letters.next()) {
        (Some(letter), None) if letter.is_ascii_lowercase() => Ok(letter),
        _ => Err(format!("{what} is a letter from a to z")),
    }
}

fn mark(state: &mut State, call: &Call) -> Done {
    let (letter, spot) = (letter(call.text, "a mark")?, state.spot());
    state.memory.finding.mark(letter, spot);
    state.say(format!("mark {letter} is set: '{letter} goes back to it"));
    Ok(())
}

fn jump_mark(state: &mut State, call: &Call) -> Done {
    let letter = letter(call.text, "a mark")?;
    let spot = state
        .memory
        .finding
        .marked(letter)
        .cloned()
        .ok_or_else(|| format!("mark {letter} is not set: m{letter} sets it"))?;
    leave(state);
    state.return_to(&spot);
    Ok(())
}

fn jumps(state: &mut State, call: &Call) -> Done {
    if call.text.is_empty() {
        return list_jumps(state);
    }
    let way = if call.text == "newer" { "newer" } else { "older" };
    for done in 0..call.times() {
        let here = state.spot();
        match state.memory.finding.back(way == "older", here) {
            Some(spot) => state.return_to(&spot),
            None if done > 0 => break,
            None => return Err(format!("there is no {way} jump")),
        }
    }
    Ok(())
}

/// Lists the places that jumps have left, the latest first.
fn list_jumps(state: &mut State) -> Done {
    let document = state.document();
    let mut options: Vec<(String, String)> = Vec::new();
    for place in state.memory.finding.jumps().filter(|place| field::is_there(document, place)) {
        let address = match address::told(document, place) {
            whole if whole.is_empty() => "scene".to_owned(),
            address => address,
        };
        let value = field::field(document, place).zip(field::value(document, place));
        let says = value.map(|(field, value)| summary(&field, &value)).unwrap_or_default();
        if options.iter().all(|(known, _)| *known != address) {
            options.push((address, says));
        }
    }
    if options.is_empty() {
        return Err("there are no jumps yet".into());
    }
    state.typing.mode = Mode::Choice(Choice { title: "jumps".into(), options, at: 0, then: Then::Go });
    Ok(())
}

/// Remembers this place before a jump.
pub fn leave(state: &mut State) {
    let spot = state.spot();
    state.memory.finding.left(spot);
}

fn go(state: &mut State, call: &Call) -> Done {
    let pointer = match call.text {
        "" => String::new(),
        path => state.resolve(path)?,
    };
    let before = state.spot();
    reveal(state, &pointer);
    // For a list, go to its rows.
    if state.cursor.focus == Pane::Tree && state.sheet().table {
        state.cursor.focus = Pane::Table;
    }
    if before.node != state.cursor.node {
        state.memory.finding.left(before);
    }
    Ok(())
}

/// Goes to the next place that matches, in the order of the document, continuing at its other end.
fn search(state: &mut State, call: &Call) -> Done {
    let before = state.memory.finding.sought.clone();
    let again = matches!(call.text, "next" | "previous");
    if !again {
        state.memory.finding.sought = unquoted(call.text);
    }
    if state.memory.finding.sought.is_empty() {
        return Err("there was no search yet: / searches".into());
    }
    let steps = if call.text == "previous" { -call.times() } else { call.times() };
    let Some(found) = find(state, steps, !again) else {
        // A failed search changes nothing: n repeats the one before.
        let sought = std::mem::replace(&mut state.memory.finding.sought, before);
        return Err(format!("no name or value matches {sought}"));
    };
    leave(state);
    reveal_part(state, &found.pointer, found.part);
    state.say(format!("{} of {}   {}", found.index + 1, found.count, plain(&found.address)));
    Ok(())
}

/// A match of a search.
struct Match {
    pointer: String,
    address: String,
    part: usize,
    index: usize,
    count: usize,
}

/// The match so many steps from the cursor; if `whole`, of those that are called just so, if there are any.
fn find(state: &mut State, steps: i64, whole: bool) -> Option<Match> {
    let document = state.document().clone();
    let listed = state.memory.finding.listed(&document);
    let sought_text = state.memory.finding.sought.clone();
    let sought = Sought::new(&sought_text);
    let matches = listed.iter().enumerate().filter_map(|(i, one)| Some((i, one.matched(&sought)?)));
    let all: Vec<(usize, usize)> = matches.collect();
    let is_called =
        |(i, _): &&(usize, usize)| Pointer(&listed[*i].pointer).split().is_some_and(|(_, name)| name == sought_text);
    let called: Vec<(usize, usize)> = all.iter().filter(is_called).copied().collect();
    let matches = if whole && !called.is_empty() { &called } else { &all };
    let count = matches.len();
    let here = state.here();
    let at = listed.iter().position(|one| one.pointer == here);
    // The first match after the cursor, or the last one before it.
    let after = matches.partition_point(|&(i, _)| at.is_some_and(|at| i <= at));
    let before = matches.partition_point(|&(i, _)| at.is_some_and(|at| i < at));
    let index = if steps > 0 { after as i64 + steps - 1 } else { before as i64 + steps };
    let index = usize::try_from(index.checked_rem_euclid(count as i64)?).ok()?;
    let (i, part) = matches[index];
    let one = &listed[i];
    let index = all.partition_point(|(other, _)| *other < i);
    Some(Match { pointer: one.pointer.clone(), address: one.address.clone(), part, index, count: all.len() })
}

/// While a search is being typed, moves the cursor to the first match.
pub fn search_typed(state: &mut State, typed: &str) {
    let Some(origin) = state.memory.finding.origin.clone() else { return };
    state.return_to_origin(&origin);
    let before = std::mem::replace(&mut state.memory.finding.sought, typed.to_owned());
    let found = if typed.is_empty() { None } else { find(state, 1, true) };
    state.memory.finding.sought = before;
    if let Some(found) = found {
        let mode = std::mem::replace(&mut state.typing.mode, Mode::Normal);
        reveal_part(state, &found.pointer, found.part);
        state.typing.mode = mode;
    }
}

/// When a search is no longer being typed, moves the cursor back.
pub fn search_left(state: &mut State) {
    if let Some(origin) = state.memory.finding.origin.take() {
        state.return_to_origin(&origin);
    }
}

/// Shows the node or the field at `pointer`.
pub fn reveal(state: &mut State, pointer: &str) {
    reveal_part(state, pointer, 0);
}

/// Shows the node or the field at `pointer`, with the cursor on one of its numbers. Fields of unnamed items are shown in the
/// table of these items.
fn reveal_part(state: &mut State, at: &str, part: usize) {
    let at = &*field::by_name(state.document(), at);
    let kind = field::field(state.document(), at).map(|field| field.kind);
    let node = field::is_there(state.document(), at) && kind.is_some_and(|kind| is_node(&kind));
    let parent = || Pointer(at).split().map_or("", |(parent, _)| parent);
    let in_table = if node { None } else { cell_in_table(state, parent(), at, part) };
    let (shown, row, column) = match in_table {
        Some((list, row, column)) => (list, Some(row), column),
        None => (if node { at } else { parent() }.to_owned(), None, 0),
    };
    state.typing.mode = Mode::Normal;
    state.cursor.expand_to(&shown);
    state.cursor.unselect();
    state.show(shown);
    state.cursor.row = row.or_else(|| state.sheet().position(at)).unwrap_or(state.cursor.row);
    state.cursor.focus = if node { Pane::Tree } else { Pane::Table };
    state.cursor.column = if node { state.cursor.column } else { column };
    if !node && row.is_none() {
        state.cursor.column = state.row().map_or(0, |row| column_of(&row, at, part).unwrap_or(0));
    }
    state.settle();
    state.ask(Effect::Show);
}

/// The list, the row and the column that show a field of an item, if the item has no name and its row has such a column.
fn cell_in_table(state: &State, item: &str, at: &str, part: usize) -> Option<(String, usize, usize)> {
    let (list, index) = Pointer(item).split()?;
    let index = pointer::index(&index)?;
    let sheet = crate::tui::document::sheet::Sheet::of(state.document(), list);
    let row = sheet.row(index).filter(|row| sheet.table && row.pointer == item)?;
    let named = field::is_there(state.document(), &Pointer(item).join("name"));
    Some((list.to_owned(), index, column_of(&row, at, part).filter(|_| !named)?))
}

fn column_of(row: &crate::tui::document::sheet::Row, at: &str, part: usize) -> Option<usize> {
    let is = |wanted: Part| row.cells.iter().position(|cell| cell.pointer == at && cell.part == wanted);
    is(Part::Number(part)).or_else(|| is(Part::Whole))
}

/// Goes to the same place in the next item of the same kind as the innermost item around the node.
fn sibling(state: &mut State, call: &Call) -> Done {
    let next = call.text != "previous";
    let (mut node, row, column) = (state.cursor.node.clone(), state.cursor.row, state.cursor.column);
    for _ in 0..call.times() {
        let end = if next { "last" } else { "first" };
        node = beside(state, &node, next)?.ok_or_else(|| format!("this is the {end} of its kind"))?;
    }
    leave(state);
    state.cursor.expand_to(&node);
    state.show(node);
    (state.cursor.row, state.cursor.column) = (row, column);
    state.settle();
    Ok(())
}

/// The same place in the next or previous item of the same kind; `None` if there is no other.
fn beside(state: &State, node: &str, next: bool) -> Result<Option<String>, String> {
    let json = state.document().json();
    let mut item = node;
    loop {
        let (list, last) = Pointer(item).split().ok_or("this is not in a list: go to an item of one")?;
        if let (Some(index), Some(items)) = (pointer::index(&last), json.pointer(list).and_then(|list| list.as_array()))
        {
            let tag = match Place::of(json, item).map(|place| place.shape.body()) {
                Some(Body::Tagged(tag)) => tag,
                _ => "",
            };
            let kind = |i: usize| items.get(i).and_then(|item| item.get(tag));
            let alike = |i: &usize| kind(*i) == kind(index);
            let there = if next { (index + 1..items.len()).find(alike) } else { (0..index).rev().find(alike) };
            let rest = &node[item.len()..];
            let place = there.map(|i| format!("{}{rest}", Pointer(list).join(i)));
            return Ok(place.map(|place| nearest(state, place)));
        }
        item = list;
    }
}

/// The place, or its nearest ancestor that exists.
fn nearest(state: &State, mut place: String) -> String {
    while !field::is_there(state.document(), &place) {
        place.truncate(Pointer(&place).parent().map_or(0, str::len));
    }
    place
}
