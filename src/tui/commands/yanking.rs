//! Yanks a node or rows as JSON, or rows as CSV, and pastes them where they fit.

use crate::base::pointer::Pointer;
use crate::base::text::counted;
use crate::tui::commands::adding::stem;
use crate::tui::document::pointers::{is_item, item_of};
use crate::tui::text::plain;
use serde_json::{Map, Value};
use std::collections::BTreeSet;

use super::command::{Call, Command, Done, command};
use super::finding::letter;
use super::items::{bearable, go_to, insert_entries, rows as rows_of, target, targets};
use crate::base::problem::quoted;
use crate::scene::field::{self, Field, Kind};
use crate::scene::insert::misfit;
use crate::scene::{Document, Edit, address, json};
use crate::tui::document::rows;
use crate::tui::document::sheet::Sheet;
use crate::tui::events::Effect;
use crate::tui::state::memory::Yanked;
use crate::tui::state::{Pane, State, entry};
use crate::tui::text::clipboard::MOST_BYTES;
use crate::tui::text::numbers;

pub const COMMANDS: &[Command] = &[
    command("yank", "[json|csv]", "Yank the row, the selection or the node", yank).counted(),
    command(
        "register",
        "a..z [JSON]",
        "Let the next yank or paste be about this register; with a value, have that in it",
        register,
    ),
    command("paste", "[JSON]", "Paste what was yanked, or a value, after the cursor or into the list", paste)
        .change()
        .counted(),
];

fn yank(state: &mut State, call: &Call) -> Done {
    let into = state.memory.register.map(|letter| format!(" into register {letter}")).unwrap_or_default();
    let (text, said) = match call.text {
        "csv" => {
            let (sheet, rows) = table(state, call)?;
            let pointers: Vec<String> = rows.iter().filter_map(|&i| sheet.pointer(i)).collect();
            let text = rows::write(state.document(), &sheet, &rows);
            // `p` pastes the whole items, including fields without a column.
            let yanked = values(state, &pointers);
            state.memory.yank(yanked);
            (text, format!("{} as CSV", counted(rows.len(), "row")))
        }
        "" | "json" => {
            let (yanked, said) = yanked(state, call)?;
            let text = json::to_text(&yanked.value).trim_end().to_owned();
            state.memory.yank(yanked);
            (text, said)
        }
        other => return Err(format!("yank takes json or csv, not {}", quoted(other))),
    };
    if text.len() > MOST_BYTES {
        let size = text.len().div_ceil(1000);
        let most = MOST_BYTES / 1000;
        state.complain(format!(
            "{said} yanked{into}, but {size} kB are too much for the terminal's clipboard ({most} kB); p pastes it here"
        ));
        return Ok(());
    }
    state.ask(Effect::Copy(text));
    state.say(format!("{said} yanked{into}"));
    Ok(())
}

/// Names a register, or fills it. What an earlier session has left in it comes into the log, which has to lead here alone.
fn register(state: &mut State, call: &Call) -> Done {
    let (name, value) = call.text.split_once(' ').unwrap_or((call.text, ""));
    let name = letter(name, "a register")?;
    if !value.is_empty() {
        let yanked = serde_json::from_str(value)
            .map_err(|_| "register takes a letter: \"a y yanks into a, \"a p pastes from it")?;
        state.memory.registers.insert(name, yanked);
        return Ok(());
    }
    if let Some(yanked) = state.memory.recalled.remove(&name).filter(|_| !state.memory.registers.contains_key(&name)) {
        let value = serde_json::to_string(&yanked).unwrap_or_default();
        state.memory.recorder.note(format!("register {name} {value}"));
        state.memory.registers.insert(name, yanked);
    }
    state.memory.register = Some(name);
    Ok(())
}

/// The message if the number of rows is neither one nor that of the selection.
pub fn too_many(rows: usize, selected: usize) -> String {
    format!("{} over {selected} selected: paste one or {selected}, or end the selection (Esc)", counted(rows, "row"))
}

/// The rows that become CSV: the selected ones, or in the tree all rows of the list.
pub fn table(state: &State, call: &Call) -> Result<(Sheet, BTreeSet<usize>), String> {
    let sheet = state.sheet();
    let rows = match state.cursor.focus {
        Pane::Table => rows_of(state, call)?,
        _ => (0..call.count.unwrap_or(usize::MAX).clamp(1, sheet.len().max(1))).collect(),
    };
    if sheet.is_empty() || !sheet.table && !rows.iter().all(|&i| sheet.row(i).is_some_and(|row| row.item)) {
        return Err("only rows of a list are yanked as CSV; y yanks this as JSON".into());
    }
    Ok((sheet, rows))
}

/// What `y` yanks, and its name for the message.
fn yanked(state: &State, call: &Call) -> Result<(Yanked, String), String> {
    let several = call.count.is_some() || state.cursor.focus == Pane::Table && state.cursor.selects();
    let pointers = if several { targets(state, call)? } else { Vec::new() };
    let one = match pointers.as_slice() {
        [] => target(state)?,
        [one] => one.clone(),
        several => return Ok((values(state, several), counted(several.len(), "row"))),
    };
    let value = there(state, &one).ok_or("there is nothing to yank here")?;
    let name = in_map(state.document(), &one).then(|| Pointer(&one).split().map(|(_, last)| last)).flatten();
    let said = field::field(state.document(), &one).map(|field| field.name).filter(|name| !name.is_empty());
    let said = said.map_or("the scene".into(), |name| match name.parse::<usize>() {
        Ok(_) => counted(1, "row"),
        Err(_) => plain(&name),
    });
    Ok((Yanked { value, name }, said))
}

fn there(state: &State, pointer: &str) -> Option<Value> {
    field::value(state.document(), pointer).filter(|value| !value.is_null())
}

/// The values of several rows: as a list if they are items, else as an object by their names.
fn values(state: &State, rows: &[String]) -> Yanked {
    let mut values = rows.iter().filter_map(|path| Some((Pointer(path).split()?.1, there(state, path)?)));
    let value = match rows {
        [one] if !in_map(state.document(), one) => values.next().map(|(_, value)| value).unwrap_or_default(),
        [first, ..] if is_item(state.document(), first) => values.map(|(_, value)| value).collect(),
        _ => values.collect::<Map<_, _>>().into(),
    };
    Yanked { value, name: None }
}

fn in_map(document: &Document, path: &str) -> bool {
    let holder = Pointer(path).split().and_then(|(holder, _)| field::field(document, holder));
    holder.is_some_and(|field| matches!(field.kind, Kind::Map(_)))
}

fn paste(state: &mut State, call: &Call) -> Done {
    let yanked = match call.text {
        "" => state.memory.taken()?,
        text => {
            let value = json::parse(text).map_err(|problem| format!("what was pasted is not JSON: {problem}"))?;
            Yanked { value, name: None }
        }
    };
    let times = call.times_of("paste")?;
    bearable(state, json::bytes(&yanked.value).saturating_mul(times as u64))?;
    match state.cursor.focus == Pane::Table && state.cursor.selects() {
        true => over_selection(state, &yanked.value, call),
        false => paste_value(state, &yanked, times),
    }
}

/// Pastes over the selection: into the cell of each row, or over the rows, one value for all or one for each.
fn over_selection(state: &mut State, value: &Value, call: &Call) -> Done {
    let count = rows_of(state, call)?.len();
    let (document, sheet) = (state.document(), state.sheet());
    let takes = |path: &String, value: &Value| misfit(document, path, value).is_none();
    let rows: Vec<String> = state.cursor.rows().into_iter().filter_map(|i| sheet.pointer(i)).collect();
    let cells: Vec<String> = entry::cells(state, &sheet).into_iter().map(|(_, cell)| cell.pointer).collect();
    let set = |paths: &[String], values: &[Value]| {
        let edits =
            paths.iter().zip(values.iter().cycle()).map(|(path, value)| Edit::set(document, path, value.clone()));
        Some(Edit::all(edits))
    };
    let items = rows.iter().all(|path| is_item(document, path));
    let one = std::slice::from_ref(value);
    let edit = match value {
        value if !cells.is_empty() && cells.iter().all(|path| takes(path, value)) => set(&cells, one),
        value if items && rows.iter().all(|path| takes(path, value)) => set(&rows, one),
        Value::Array(values) if items && values.first().is_some_and(|value| takes(&rows[0], value)) => {
            if values.len() != 1 && values.len() != rows.len() {
                return Err(too_many(values.len(), rows.len()));
            }
            set(&rows, values)
        }
        _ => over_cells(state, value).map(|way| way.edit),
    };
    let edit = edit.ok_or_else(|| format!("{}; {count} rows are selected", refusal(state, value)))?;
    state.edit(edit, false)?;
    state.say(format!("pasted over {}", counted(count, "row")));
    Ok(())
}

/// Pastes a value where it fits: over the cell, after the item under the cursor or one around it, into a list, or over a
/// field. The first of these that gives a valid scene is used. Into a list the value is pasted `times` times.
fn paste_value(state: &mut State, yanked: &Yanked, times: usize) -> Done {
    let mut why = None;
    for fit in fits(state) {
        let way = way(state, yanked, &fit, times)?.filter(|way| !way.edit.is_empty());
        let Some(Way { edit, pointer, count }) = way else { continue };
        match state.edit(edit, false) {
            Ok(()) => {
                go_to_pasted(state, &pointer, count);
                return Ok(());
            }
            Err(reason) => drop(why.get_or_insert(reason)),
        }
    }
    Err(why.unwrap_or_else(|| refusal(state, &yanked.value)))
}

fn go_to_pasted(state: &mut State, pointer: &str, count: usize) {
    let name = field::field(state.document(), pointer).map(|field| field.name).unwrap_or_default();
    if is_item(state.document(), pointer) || in_map(state.document(), pointer) {
        go_to(state, pointer);
    }
    let named = count == 1 && !name.is_empty() && name.parse::<usize>().is_err();
    let what = if named { plain(&name) } else { counted(count, "row") };
    state.say(format!("{what} pasted"));
}

/// A way in which a value fits: the edit, the place of its first part, and the number of its parts.
struct Way {
    edit: Edit,
    pointer: String,
    count: usize,
}

/// A place where a value may fit.
enum Fit {
    /// The cell under the cursor, and the corresponding ones of the selection.
    Cells,
    /// A list, before the item at an index.
    List(String, usize),
    /// A map.
    Map(String),
    /// A place, replacing its value.
    Over(String),
    /// The fields of the form that is shown.
    Fields,
}

/// The places where a value may fit, the most likely first: from the cursor outward, then inward.
fn fits(state: &State) -> Vec<Fit> {
    let document = state.document();
    let mut fits = vec![Fit::Cells];
    let into = |fits: &mut Vec<Fit>, path: &str, field: &Field| match field.kind {
        Kind::List(_) => {
            let end = document.json().pointer(path).and_then(Value::as_array).map_or(0, Vec::len);
            fits.push(Fit::List(path.to_owned(), end));
        }
        Kind::Map(_) => fits.push(Fit::Map(path.to_owned())),
        Kind::Number { .. } | Kind::Text | Kind::Bool | Kind::Choice(_) | Kind::Numbers(_) => {}
        Kind::Object | Kind::Tagged { .. } | Kind::Reference(_) => {}
    };
    for path in Pointer(&state.here()).upward() {
        let item = item_of(document, path);
        fits.extend(item.map(|(list, index)| Fit::List(list.to_owned(), index + 1)));
        let Some(field) = field::field(document, path) else { continue };
        into(&mut fits, path, &field);
        // A list of fixed length, such as a matrix, has no room for another row.
        let loose = matches!(field.kind, Kind::Numbers(_)) || item.is_none() && !in_map(document, path);
        fits.extend(loose.then(|| Fit::Over(path.to_owned())));
    }
    fits.push(Fit::Fields);
    for child in field::children(document, &state.cursor.node) {
        into(&mut fits, &child.pointer, &child.field);
    }
    fits
}

/// How a value fits there, pasted so many times; `None` if it does not.
fn way(state: &State, yanked: &Yanked, fit: &Fit, times: usize) -> Result<Option<Way>, String> {
    let (document, value) = (state.document(), &yanked.value);
    Ok(match fit {
        Fit::Cells => over_cells(state, value),
        Fit::List(list, index) => into_list(document, list, *index, value, times),
        Fit::Map(map) => into_map(state, map, yanked, times)?,
        Fit::Over(path) if misfit(document, path, value).is_some() => None,
        Fit::Over(path) => {
            Some(Way { edit: Edit::set(document, path, value.clone()), pointer: path.clone(), count: 1 })
        }
        Fit::Fields => fields(document, &state.cursor.node, value),
    })
}

/// A number over a number, a text over a text, in every selected row, as if it were typed.
fn over_cells(state: &State, value: &Value) -> Option<Way> {
    let row = state.row()?;
    let cell = state.cursor.cell(&row).filter(|_| state.cursor.focus == Pane::Table)?;
    let text = match value {
        Value::Number(number) if cell.is_number() => numbers::exact(number.as_f64()?),
        Value::String(text) if cell.field.kind == Kind::Text => text.clone(),
        _ => return None,
    };
    Some(Way { edit: entry::edit(state, &text).ok()?, pointer: state.here(), count: 1 })
}

/// A value as one item of a list, or its parts as several.
fn into_list(document: &Document, list: &str, index: usize, value: &Value, times: usize) -> Option<Way> {
    let item = Pointer(list).join("-");
    let fits = |value: &Value| misfit(document, &item, value).is_none();
    let items = match value {
        value if fits(value) => vec![value.clone()],
        // The others are checked together with the scene.
        Value::Array(items) if items.first().is_some_and(fits) => items.clone(),
        _ => return None,
    };
    let count = items.len() * times;
    let items = items.into_iter().cycle().take(count).collect();
    let (edit, pointer) = Edit::insert_all(document, list, index, items)?;
    Some(Way { edit, pointer, count })
}

/// A value as one entry of a map, under its old name or that of its file; or an object of such entries.
fn into_map(state: &State, map: &str, yanked: &Yanked, times: usize) -> Result<Option<Way>, String> {
    let document = state.document();
    let fits = |value: &Value| misfit(document, &Pointer(map).join("new"), value).is_none();
    let entries = match &yanked.value {
        value if fits(value) => {
            let file = || value.get("path").and_then(Value::as_str).map(stem).map(str::to_owned);
            let name = yanked.name.clone().or_else(file).unwrap_or("picture".into());
            Map::from_iter([(name, value.clone())])
        }
        Value::Object(entries) if entries.values().all(fits) => entries.clone(),
        _ => return Ok(None),
    };
    let count = entries.len() * times;
    let inserted = insert_entries(state, map, &entries, times)?;
    Ok(inserted.map(|(edit, pointer)| Way { edit, pointer, count }))
}

/// An object whose keys are all fields of the form.
fn fields(document: &Document, form: &str, value: &Value) -> Option<Way> {
    let object = value.as_object().filter(|object| !object.is_empty())?;
    let known = field::children(document, form);
    let known = |name: &String| {
        known.iter().find(|child| Pointer(&child.pointer).split().is_some_and(|(_, own)| own == **name))
    };
    let edits = object.iter().map(|(name, value)| {
        let child = known(name).filter(|child| misfit(document, &child.pointer, value).is_none())?;
        Some(Edit::set(document, &child.pointer, value.clone()))
    });
    let edit = Edit::all(edits.collect::<Option<Vec<_>>>()?);
    Some(Way { edit, pointer: form.to_owned(), count: object.len() })
}

/// Why the value fits nowhere: what would be needed at the cursor.
fn refusal(state: &State, value: &Value) -> String {
    let document = state.document();
    let here = state.here();
    let list = Pointer(&here).upward().find_map(|path| match field::field(document, path)?.kind.is_list() {
        true => Some(path.to_owned()),
        false => item_of(document, path).map(|(list, _)| list.to_owned()),
    });
    let wanted = list.as_ref().map_or(here.clone(), |list| Pointer(list).join("-"));
    let why = misfit(document, &wanted, value).map(|problem| problem.to_string()).unwrap_or_default();
    let name = address::address(document, list.as_deref().unwrap_or(&here));
    format!(
        "it does not fit into {}: {}",
        if name.is_empty() { "the scene" } else { &name },
        why.trim_start_matches('/')
    )
}
