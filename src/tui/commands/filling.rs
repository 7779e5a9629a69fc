//! Pastes a table over the selected rows, or over rows that are named. Its columns are matched by its header, or start at the column under the cursor;
//! other columns stay as they are.

use std::collections::{BTreeMap, BTreeSet};

use kurbo::Vec2;
use serde_json::Value;

use super::command::{Call, Command, Done, command};
use super::yanking::too_many;
use crate::base::number;
use crate::base::problem::quoted;
use crate::base::text::counted;
use crate::scene::{Document, Edit, field};
use crate::tui::document::cell::{Cell, Part};
use crate::tui::document::csv;
use crate::tui::document::rows::{self, follows};
use crate::tui::document::sheet::{Row, Sheet};
use crate::tui::state::State;
use crate::tui::text::numbers;
use crate::tui::text::said::words;

pub const COMMANDS: &[Command] = &[command(
    "fill",
    "[PATH ROWS] JSON",
    "Set the selected rows, or rows of a list as 0,2-5, to a list of rows, or all to one row; a header may come first",
    fill,
)
.change()];

/// The first row, if it contains no number.
fn header(table: &[Vec<String>]) -> Option<&Vec<String>> {
    table.first().filter(|first| first.iter().all(|field| csv::number(field).is_none()))
}

fn fill(state: &mut State, call: &Call) -> Done {
    let (place, json) = match call.text.split_once(" [[") {
        Some((place, _)) if !call.text.starts_with('[') => (Some(place), &call.text[place.len() + 1..]),
        _ => (None, call.text),
    };
    let table: Vec<Vec<String>> = serde_json::from_str(json)
        .map_err(|_| "fill takes a JSON list of rows, each a list of texts: [[\"dx\", \"dy\"], [\"1\", \"2\"]]")?;
    let (sheet, selected) = match place {
        Some(place) => named(state, place)?,
        None => (state.sheet(), state.cursor.rows()),
    };
    let selected: Vec<usize> = selected.into_iter().collect();
    let header = header(&table);
    let values = &table[usize::from(header.is_some())..];
    if values.len() != 1 && values.len() != selected.len() {
        return Err(too_many(values.len(), selected.len()));
    }
    let document = state.document();
    let mut filled = Filled { document, values: BTreeMap::new() };
    let mut refused = Vec::new();
    for (i, row) in selected.iter().filter_map(|&at| sheet.row(at)).enumerate() {
        let texts = if values.len() == 1 { &values[0] } else { &values[i] };
        let filled = filled.row(&row, (header, state.cursor.column), texts);
        refused.extend(filled.err().map(|why| format!("row {}{why}", row.label)));
    }
    match refused.as_slice() {
        [] => {}
        [one] => return Err(one.clone()),
        several => {
            let more = several.len().saturating_sub(MOST_NAMED);
            let more = if more > 0 { format!("; and {more} more") } else { String::new() };
            let named = several[..several.len().min(MOST_NAMED)].join("; ");
            return Err(format!("{} refused, and nothing changed: {named}{more}", counted(several.len(), "row")));
        }
    }
    let count = selected.len();
    let edits = filled.values.into_iter().map(|(pointer, value)| Edit::set(document, &pointer, value));
    let edit = Edit::all(edits.collect::<Vec<_>>());
    state.edit(edit, false)?;
    state.say(format!("pasted over {}", counted(count, "row")));
    Ok(())
}

/// The rows of `PATH ROWS`.
fn named(state: &State, place: &str) -> Result<(Sheet, BTreeSet<usize>), String> {
    let words = words(place)?;
    let [path, rows] = words.as_slice() else { return Err("fill takes PATH ROWS before its rows, as 0,2-5".into()) };
    let node = state.resolve(path)?;
    let sheet = Sheet::of(state.document(), &node);
    let selected = rows::of_ranges(rows, sheet.len());
    let selected =
        selected.ok_or_else(|| format!("{path} has {}, 0 the first: not {rows}", counted(sheet.len(), "row")))?;
    Ok((sheet, selected))
}

/// At most so many refused rows are named.
const MOST_NAMED: usize = 3;

/// The cell of a row for the `k`th column of the table.
fn cell<'a>(row: &'a Row, header: Option<&Vec<String>>, column: usize, k: usize) -> Result<&'a Cell, String> {
    match header {
        Some(heads) => {
            let head = heads.get(k).ok_or("it has more values than the header")?;
            let found = row.cells.iter().find(|cell| rows::same(head, &cell.head));
            found.ok_or_else(|| format!("it has no column {}", quoted(head)))
        }
        None => row.cells.get(column + k).ok_or_else(|| "there are more values than columns from here on".to_owned()),
    }
}

/// The new values by place, of which several cells may be parts.
struct Filled<'a> {
    document: &'a Document,
    values: BTreeMap<String, Value>,
}

impl Filled<'_> {
    /// Sets the cells of a row to texts, by the header or from a column on.
    fn row(
        &mut self,
        row: &Row,
        (header, column): (Option<&Vec<String>>, usize),
        texts: &[String],
    ) -> Result<(), String> {
        let mut cells = Vec::new();
        for (k, text) in texts.iter().enumerate().filter(|(_, text)| !text.is_empty()) {
            cells.push((k, cell(row, header, column, k).map_err(|why| format!(": {why}"))?, text));
        }
        // A direction turns the given length, so it comes last. What follows from numbers that change too is ignored.
        cells.sort_by_key(|(_, cell, _)| cell.part == Part::Degrees);
        let document = self.document;
        let given = |cell: &Cell| {
            let numbers = cells.iter().filter(|(_, other, _)| matches!(other.part, Part::Number(_)));
            let mut own = numbers.filter(|(_, other, _)| other.pointer == cell.pointer);
            own.any(|(_, other, text)| csv::number(text).is_none_or(|number| other.number(document) != Some(number)))
        };
        for (k, cell, text) in cells.iter().filter(|(_, cell, _)| !(follows(cell.part) && given(cell))) {
            let head = if cell.head.is_empty() { k.to_string() } else { cell.head.clone() };
            self.put(cell, text).map_err(|why| format!(", {head}: {why}"))?;
        }
        Ok(())
    }

    /// Sets a cell to a text, unless it shows that already.
    fn put(&mut self, cell: &Cell, text: &str) -> Result<(), String> {
        let document = self.document;
        if rows::exact(document, cell) == text {
            return Ok(());
        }
        let read = rows::read(cell, text)?;
        let Some(number) = read.as_f64().filter(|_| cell.is_number()) else {
            self.values.insert(cell.pointer.clone(), read);
            return Ok(());
        };
        let is_same = |old: f64| old == number || follows(cell.part) && csv::is_rounded(old, text);
        if cell.number(document).is_some_and(is_same) {
            return Ok(());
        }
        let old = self.values.get(&cell.pointer).cloned().or_else(|| field::value(document, &cell.pointer));
        let vector = || {
            let at = |i: usize| old.as_ref().and_then(|old| old.get(i)).and_then(Value::as_f64).unwrap_or(0.0);
            Vec2::new(at(0), at(1))
        };
        let pair = |v: Vec2| Value::from(vec![number::json(v.x), number::json(v.y)]);
        let value = match cell.part {
            Part::Whole => read,
            Part::Number(i) => {
                let mut all = old.as_ref().and_then(Value::as_array).cloned().unwrap_or_default();
                *all.get_mut(i).ok_or("there is no number here")? = read;
                all.into()
            }
            Part::Length => pair(numbers::with_length(vector(), number)),
            Part::Degrees => pair(numbers::cartesian(numbers::polar(vector()).0, number)),
            Part::Derived(column) => {
                return Err(format!("{} follows from {}: paste that, or type it", column.name, column.of));
            }
        };
        self.values.insert(cell.pointer.clone(), value);
        Ok(())
    }
}
