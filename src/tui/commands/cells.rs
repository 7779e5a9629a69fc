//! The cell under the cursor and the selected rows: entries, choices, steps.

use serde_json::Value;

use super::command::{Call, Command, Done, command};
use super::items::add_here;
use super::{conflicts, messages, profiles, replacing, styles};
use crate::base::maths::ten_to;
use crate::base::problem;
use crate::scene::Edit;
use crate::scene::field::{self, Kind};
use crate::scene::styles::renamed as restyled;
use crate::tui::document::cell::Cell;
use crate::tui::document::choice;
use crate::tui::document::choice::{Choice, Then};
use crate::tui::document::entry::Entry;
use crate::tui::document::sheet::Row;
use crate::tui::state::{Mode, State, entry};
use crate::tui::text::numbers;
use crate::tui::text::said::{quoted, unquoted};

pub const COMMANDS: &[Command] = &[
    command("enter", "[clear]", "Edit the cell, or go into the node", enter),
    command("put", "EXPRESSION", "Put a value into the cell, or into every selected row", put).change(),
    command("commit", "[next]", "Enter the value being typed", commit).inside(),
    command("digit", "BY", "Step the digit under the cursor", digit).inside().counted(),
    command(
        "choice",
        "next|previous|to LETTER|take",
        "Move in the list of choices, also to the next word that begins with a letter, or take one",
        choice,
    )
    .inside()
    .counted_with(&["next", "previous", "to"]),
    command("choose", "WORD", "Take a word of the list of choices", choose).answer(),
    command("step", "BY", "Step the number by the step", step).change().counted(),
    command(
        "step-size",
        "smaller|larger|POWER",
        "Make the step ten times smaller or larger, or a power of ten",
        step_size,
    )
    .counted_with(&["smaller", "larger"]),
];

pub fn current(state: &State) -> Option<(Row, Cell)> {
    let row = state.row()?;
    let cell = state.cursor.cell(&row)?.clone();
    Some((row, cell))
}

fn enter(state: &mut State, call: &Call) -> Done {
    let (row, cell) = current(state).ok_or("there is nothing to edit here: o adds an item")?;
    let missing = !field::is_there(state.document(), &cell.pointer);
    if cell.is_node() && missing {
        state.scene.writable()?;
        return add_here(state, 1);
    }
    // On the kind of an item that has nodes inside, go into the item; its kind can be changed in its form.
    let into = row.item && state.cursor.column == 0 && row.cells.iter().any(Cell::is_node);
    if cell.is_node() || into {
        state.show(if into { row.pointer } else { cell.pointer });
        return Ok(());
    }
    state.scene.writable()?;
    let sheet = state.sheet();
    let others = entry::cells(state, &sheet).iter().map(|(_, cell)| cell.pointer.clone()).collect();
    if is_typed(&cell) {
        state.typing.mode = Mode::Entry(Entry::new(state.document(), &cell, call.text == "clear"));
    } else if let Some(choice) = choice::of_cell(state.document(), &cell, others) {
        state.typing.mode = Mode::Choice(choice);
    } else {
        return Err(format!("{} cannot be edited here", row.label));
    }
    Ok(())
}

/// Sets the cell under the cursor, and the corresponding ones of the selection, to what the text means: a value, an
/// expression over the row, or one of the words that the cell can have.
fn put(state: &mut State, call: &Call) -> Done {
    let text = unquoted(call.text);
    let (row, cell) = current(state).ok_or("there is nothing to put it into: o adds an item")?;
    let skipped = entry::skipped(state);
    if is_typed(&cell) {
        let edit = entry::edit(state, &text)?;
        state.edit(edit, false)?;
        skipped.into_iter().for_each(|some| state.say(some));
    } else {
        let sheet = state.sheet();
        let others = entry::cells(state, &sheet).iter().map(|(_, cell)| cell.pointer.clone()).collect();
        let choice = choice::of_cell(state.document(), &cell, others).filter(|_| !cell.is_node());
        let choice = choice.ok_or_else(|| format!("{} takes no value: go into it", row.label))?;
        let word = word_of(&choice, &text)?;
        take(state, call, choice, &word)?;
    }
    state.typing.mode = Mode::Normal;
    Ok(())
}

/// Whether the value of the cell is typed. Otherwise it is chosen from a list, or the cell is a node.
fn is_typed(cell: &Cell) -> bool {
    cell.is_number() || matches!(cell.field.kind, Kind::Text)
}

/// Enters what was typed. If that is refused, the entry stays open.
fn commit(state: &mut State, call: &Call) -> Done {
    let Mode::Entry(typed) = &state.typing.mode else { return Ok(()) };
    let text = quoted(typed.text.value());
    call.obey(state, &format!("put {text}"))?;
    if call.text == "next" {
        call.obey(state, "move next")?;
        if current(state).is_some_and(|(_, cell)| is_typed(&cell)) {
            return call.obey(state, "enter");
        }
    }
    Ok(())
}

fn digit(state: &mut State, call: &Call) -> Done {
    let by = number(call, "digit")?.saturating_mul(call.times());
    let Mode::Entry(entry) = &mut state.typing.mode else { return Ok(()) };
    if entry.text.step_digit(by) { Ok(()) } else { Err("there is no digit under the cursor".into()) }
}

fn choice(state: &mut State, call: &Call) -> Done {
    let Mode::Choice(choice) = &mut state.typing.mode else { return Ok(()) };
    match call.text {
        "next" => choice.step(call.times()),
        "previous" => choice.step(-call.times()),
        "take" => match (choice.taken().map(str::to_owned), &choice.then) {
            (Some(word), Then::Answer(_)) => {
                // Only a comment goes into the log: when it is run again, the question is not asked.
                let choice = choice.clone();
                state.typing.mode = Mode::Normal;
                state.memory.recorder.remark(&format!("{}: {word}", choice.title));
                return take(state, call, choice, &word);
            }
            (Some(word), Then::Go) => {
                state.typing.mode = Mode::Normal;
                return messages::go_to(state, call, &word);
            }
            (Some(word), Then::Replace(asked)) => {
                let asked = asked.clone();
                return replacing::taken(state, call, &asked, &word);
            }
            (Some(word), _) => return call.obey(state, &format!("choose {}", quoted(&word))),
            (None, _) => state.typing.mode = Mode::Normal,
        },
        text => {
            let letter = text.strip_prefix("to ").and_then(|text| text.chars().next());
            let letter = letter.ok_or_else(|| unknown(call, "choice takes next, previous, to LETTER or take"))?;
            for _ in call.steps() {
                if !choice.seek(letter) {
                    return Err(format!("nothing here begins with {letter}"));
                }
            }
        }
    }
    Ok(())
}

/// The argument of a command as a whole number.
pub fn number(call: &Call, name: &str) -> Result<i64, String> {
    call.text.parse().map_err(|_| unknown(call, &format!("{name} takes a whole number")))
}

/// A message on what a command takes, and what it was given instead.
fn unknown(call: &Call, takes: &str) -> String {
    format!("{takes}, not {}", problem::quoted(call.text))
}

fn choose(state: &mut State, call: &Call) -> Done {
    let Mode::Choice(choice) = &state.typing.mode else {
        return Err("there is no list to choose from: Enter opens one".into());
    };
    let word = word_of(choice, &unquoted(call.text))?;
    let choice = choice.clone();
    state.typing.mode = Mode::Normal;
    take(state, call, choice, &word)
}

/// The word, if it is in the list.
fn word_of(choice: &Choice, word: &str) -> Result<String, String> {
    let words = choice.options.iter().map(|(word, _)| word.as_str());
    if words.clone().any(|one| one == word) {
        return Ok(word.to_owned());
    }
    let near = problem::nearest(word, words).unwrap_or_default();
    Err(format!("{} cannot be {}: {near}", choice.title, problem::quoted(word)))
}

fn take(state: &mut State, call: &Call, choice: Choice, word: &str) -> Done {
    let document = state.document();
    let (edit, lost) = match &choice.then {
        Then::Set(pointers) => {
            let bool = |pointer: &str| field::field(document, pointer).is_some_and(|field| field.kind == Kind::Bool);
            let value = |pointer: &str| if bool(pointer) { Value::from(word == "true") } else { Value::from(word) };
            let set = |pointer: &String| {
                restyled(document, pointer, word).unwrap_or_else(|| Edit::set(document, pointer, value(pointer)))
            };
            (Edit::all(pointers.iter().map(set)), None)
        }
        Then::Become(pointer) => match field::field(document, pointer).map(|field| field.kind) {
            Some(Kind::Tagged { tag, .. }) => Edit::set_told(document, &format!("{pointer}/{tag}"), word.into()),
            _ => return Err(format!("{pointer} has no kinds")),
        },
        Then::Preset => return profiles::apply(state, word),
        Then::Style => return styles::apply(state, word),
        Then::Go => return messages::go_to(state, call, word),
        Then::Replace(asked) => return replacing::taken(state, call, asked, word),
        Then::Answer(question) => return conflicts::answer(state, question.about, word, choice),
    };
    state.edit(edit, false)?;
    if let Then::Set(_) = &choice.then {
        entry::skipped(state).into_iter().for_each(|some| state.say(some));
    }
    if let Some(lost) = lost {
        state.say(lost);
    }
    Ok(())
}

/// Steps each selected number.
fn step(state: &mut State, call: &Call) -> Done {
    let by = number(call, "step")?.saturating_mul(call.times());
    let (_, cell) = current(state).ok_or("there is nothing to step here")?;
    if !cell.is_number() {
        return Err(format!("{} is not a number: only numbers step (Enter opens it)", cell.field.name));
    }
    let unit = ten_to(state.typing.step);
    let edit = entry::each(state, |_, cell, _| {
        Ok(numbers::tidy(cell.number(state.document()).unwrap_or(0.0) + by as f64 * unit))
    })?;
    state.edit(edit, true)?;
    entry::skipped(state).into_iter().for_each(|some| state.say(some));
    Ok(())
}

fn step_size(state: &mut State, call: &Call) -> Done {
    let times = call.times() as i32;
    let power = match call.text {
        "smaller" => state.typing.step - times,
        "larger" => state.typing.step + times,
        _ => call.text.parse().map_err(|_| unknown(call, "step-size takes smaller, larger or a power of ten"))?,
    };
    state.typing.step = power.clamp(-3, 3);
    state.say(format!("step {}", ten_to(state.typing.step)));
    Ok(())
}
