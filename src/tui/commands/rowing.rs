//! Rows made anew from those that are there: fewer of them, evenly spaced ones, and nodes with other handles.

use std::collections::BTreeSet;

use serde_json::{Map, Value};

use super::command::{Call, Command, Done, command};
use super::items::{alike, owned};
use crate::base::pointer::Pointer;
use crate::base::text::counted;
use crate::base::{maths, number};
use crate::layers::shapes::handles::{Handles, ends_kept, handled, resampled};
use crate::scene::insert::is_closed;
use crate::scene::{Edit, field};
use crate::tui::document::pointers::item_of;
use crate::tui::state::{Pane, State, place};

pub const COMMANDS: &[Command] = &[
    command("thin", "N", "Keep every Nth of the selected rows, or of all", thin).change(),
    command(
        "resample",
        "COUNT",
        "Replace the selected rows, or all, by so many evenly along the way through them",
        resample,
    )
    .change(),
    command(
        "handles",
        "smooth|mirrored|none",
        "Make the handles of the selected nodes, or of all, anew: a smooth path, both alike, or straight sides",
        handles,
    )
    .change(),
];

/// A list of rows and those of its items that a command is about.
struct Rows {
    list: String,
    items: Vec<Value>,
    chosen: BTreeSet<usize>,
    /// Whether they are selected, and not all that there are.
    part: bool,
}

fn rows(state: &State) -> Result<Rows, String> {
    let selects = state.cursor.selects() && state.cursor.focus != Pane::Tree;
    let rows = match selects {
        true => state.cursor.rows(),
        false => alike(state).map(|(first, last)| (first..=last).collect()).unwrap_or_default(),
    };
    let sheet = state.sheet();
    let places = rows.iter().map(|&row| item_of(state.document(), &sheet.pointer(row)?).map(owned));
    let places: Vec<(String, usize)> = places.collect::<Option<_>>().unwrap_or_default();
    let list = places.first().map(|(list, _)| list.clone()).ok_or("only rows of a list: go to one")?;
    if places.iter().any(|(other, _)| *other != list) {
        return Err("only rows of one list together".into());
    }
    let items = field::value(state.document(), &list).and_then(|items| items.as_array().cloned()).unwrap_or_default();
    let chosen: BTreeSet<usize> = places.into_iter().map(|(_, index)| index).collect();
    Ok(Rows { part: chosen.len() < items.len(), list, items, chosen })
}

/// Replaces a list, with the cursor on one of its rows.
fn replace(state: &mut State, list: &str, items: Vec<Value>, row: usize) -> Done {
    let edit = Edit::set(state.document(), list, items.into());
    state.edit(edit, false)?;
    state.cursor.unselect();
    if let Some(row) = state.sheet().position(&Pointer(list).join(row)) {
        state.cursor.row = row;
    }
    state.settle();
    Ok(())
}

fn count(call: &Call, what: &str) -> Result<usize, String> {
    const MOST: usize = 100_000;
    let count = call.text.parse().ok().filter(|count| (2..=MOST).contains(count));
    count.ok_or_else(|| format!("{what}, 2 to {MOST}"))
}

fn thin(state: &mut State, call: &Call) -> Done {
    let every = count(call, "thin takes which rows to keep: 2 for every second")?;
    let Rows { list, items, chosen, part } = rows(state)?;
    let kept: BTreeSet<usize> = chosen.iter().copied().step_by(every).collect();
    if !part && kept.len() < 2 && chosen.len() > 1 {
        return Err(format!(
            "one of {} would be left: thin {} keeps the first and the last",
            chosen.len(),
            chosen.len() - 1
        ));
    }
    let gone = chosen.len() - kept.len();
    let first = chosen.first().copied().unwrap_or(0);
    let rest = items.into_iter().enumerate().filter(|(i, _)| !chosen.contains(i) || kept.contains(i));
    let rest = rest.map(|(_, item)| item).collect();
    replace(state, &list, rest, first)?;
    state.say(format!("{} of {} kept", kept.len(), counted(kept.len() + gone, "row")));
    Ok(())
}

fn resample(state: &mut State, call: &Call) -> Done {
    let count = count(call, "resample takes how many rows there are to be")?;
    let Rows { list, items, chosen, part } = rows(state)?;
    let (from, to) = chosen.first().copied().zip(chosen.last().copied()).unwrap_or_default();
    if to + 1 - from != chosen.len() {
        return Err("only rows next to each other are resampled together".into());
    }
    if chosen.len() < 2 {
        return Err("one row has no way to go through: select two or more".into());
    }
    let closed = !part && is_closed(state.document(), &list);
    let made = match resampled(&items[from..=to], closed, count) {
        Some(nodes) if part => ends_kept(nodes, &items[from], &items[to]),
        Some(nodes) => nodes,
        None => evenly(state, &list, &items[from..=to], (from, closed, count))?,
    };
    let all = [&items[..from], &made, &items[to + 1..]].concat();
    replace(state, &list, all, from)?;
    state.say(format!("{} are {} now, evenly spaced", counted(chosen.len(), "row"), counted(count, "row")));
    Ok(())
}

/// So many rows evenly along the straight way through the places of these, with all their numbers between those of the two
/// next to them.
fn evenly(
    state: &State,
    list: &str,
    items: &[Value],
    (from, closed, count): (usize, bool, usize),
) -> Result<Vec<Value>, String> {
    let at = |i: usize| place::of(state.document(), &Pointer(list).join(from + i));
    let places: Option<Vec<_>> = (0..items.len()).map(at).collect();
    let mut places = places.ok_or("a row here has no place to go through: select those that have one")?;
    let mut items: Vec<&Value> = items.iter().collect();
    if closed {
        places.extend(places.first().copied());
        items.extend(items.first().copied());
    }
    let lengths: Vec<f64> = places.windows(2).map(|ends| ends[0].distance(ends[1])).collect();
    let gaps = if closed { count } else { count - 1 };
    let step = lengths.iter().sum::<f64>() / gaps as f64;
    let made = |k: usize| {
        let (mut along, mut i) = (step * k as f64, 0);
        while i + 1 < lengths.len() && along > lengths[i] {
            along -= lengths[i];
            i += 1;
        }
        let Some(length) = lengths.get(i) else { return items[0].clone() };
        between(items[i], items[i + 1], if *length > 0.0 { (along / length).min(1.0) } else { 0.0 })
    };
    Ok((0..count).map(made).collect())
}

/// Part of the way from one value to another of the same structure, number by number; what is no number is that of the first.
fn between(a: &Value, b: &Value, part: f64) -> Value {
    match (a, b) {
        (Value::Number(x), Value::Number(y)) => {
            let (x, y) = (x.as_f64().unwrap_or(0.0), y.as_f64().unwrap_or(0.0));
            number::json(number::tidy(maths::lerp(x, y, part)))
        }
        (Value::Array(a), Value::Array(b)) => a.iter().zip(b).map(|(a, b)| between(a, b, part)).collect(),
        (Value::Object(a), Value::Object(b)) => {
            let each = a.iter().map(|(key, a)| (key.clone(), b.get(key).map_or(a.clone(), |b| between(a, b, part))));
            Value::Object(each.collect::<Map<_, _>>())
        }
        (a, _) => a.clone(),
    }
}

fn handles(state: &mut State, call: &Call) -> Done {
    let Rows { list, items, chosen, .. } = rows(state)?;
    let how = match call.text {
        "smooth" => Handles::Smooth,
        "mirrored" => Handles::Mirrored,
        _ => Handles::None,
    };
    let made = handled(&items, is_closed(state.document(), &list), &chosen, how);
    let made = made.ok_or("only nodes of paths and curves have handles: go to such rows")?;
    let selection = (state.cursor.selected_from, state.cursor.selected_to, state.cursor.picked.clone());
    let edit = Edit::set(state.document(), &list, made.into());
    state.edit(edit, false)?;
    (state.cursor.selected_from, state.cursor.selected_to, state.cursor.picked) = selection;
    state.say(format!(
        "the handles of {} are {}",
        counted(chosen.len(), "node"),
        if call.text == "none" { "gone" } else { call.text }
    ));
    Ok(())
}
