//! What a text typed into a cell means: an expression over the columns of the row, evaluated for each selected row. All
//! values are set in one edit.

use std::collections::{BTreeMap, BTreeSet};

use crate::base::expression;
use crate::base::pointer::{Pointer, index};
use crate::base::text::counted;
use crate::tui::document::cell::in_range;
use crate::tui::document::csv;
use crate::tui::document::entry::Entry;
use kurbo::Point;
use serde_json::Value;

use super::{Mode, State, place};
use crate::base::expression::{Mistake, Variables};
use crate::scene::field::{Field, Kind};
use crate::scene::{Document, Edit};
use crate::tui::document::cell::{Cell, Part};
use crate::tui::document::sheet::{Row, Sheet};
use crate::tui::text::input::Text;
use crate::tui::text::numbers;

/// The cells that an edit applies to, with their rows: in each selected row the one that corresponds to the cell under the
/// cursor.
pub fn cells(state: &State, sheet: &Sheet) -> Vec<(usize, Cell)> {
    let document = state.document();
    let Some(row) = sheet.row(state.cursor.row) else { return Vec::new() };
    let Some(model) = state.cursor.cell(&row) else { return Vec::new() };
    let like =
        |cell: &&Cell| cell.head == model.head && cell.part == model.part && cell.is_number() == model.is_number();
    let list = Pointer(&row.pointer).parent().filter(|_| row.item);
    let inner = Pointer(&model.pointer).below(&row.pointer).unwrap_or_default();
    let of_row = |i: usize| {
        let pointer = sheet.pointer(i)?;
        // Items of the same kind have the same cells, so the row need not be made.
        let alike = list.is_some()
            && Pointer(&pointer).parent() == list
            && kind_of(document, &row.field, &pointer) == kind_of(document, &row.field, &row.pointer);
        let cell = match alike {
            true => Cell { pointer: pointer + inner, ..model.clone() },
            // In other rows the column may be at another place; in a form, cells without a head correspond.
            false if model.head.is_empty() => sheet.row(i)?.cells.get(state.cursor.column).filter(like)?.clone(),
            false => sheet.row(i)?.cells.iter().find(like)?.clone(),
        };
        Some((i, cell))
    };
    state.cursor.rows().into_iter().filter_map(of_row).collect()
}

/// The most rows of which a column is summed up with every drawing.
const MOST_SUMMED: usize = 2000;

/// The column under the cursor in a few words, over the selected rows: sum and mean of numbers, else how often each word
/// occurs. `None` if nothing is selected.
pub fn summed(state: &State) -> Option<String> {
    if !state.cursor.selects() {
        return None;
    }
    let rows = state.cursor.rows().len();
    let cells = if rows > MOST_SUMMED { Vec::new() } else { cells(state, &state.sheet()) };
    let numbers: Vec<f64> = cells.iter().filter_map(|(_, cell)| cell.number(state.document())).collect();
    let all = counted(rows, "row");
    if cells.first().is_some_and(|(_, cell)| cell.is_number()) && !numbers.is_empty() {
        let sum: f64 = numbers.iter().sum();
        let mean = sum / numbers.len() as f64;
        return Some(format!("{all}  sum {}  mean {}", numbers::short(sum), numbers::short(mean)));
    }
    let sheet = state.sheet();
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for (i, _) in &cells {
        // The text of a cell of another row is in that row.
        let row = sheet.row(*i);
        let word = row.as_ref().and_then(|row| state.cursor.cell(row)).map(|cell| cell.text.clone());
        *counts.entry(word.unwrap_or_default()).or_default() += 1;
    }
    let mut counts: Vec<(String, usize)> = counts.into_iter().collect();
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let words = counts.iter().take(MOST_WORDS).map(|(word, count)| format!("  {word} {count}"));
    Some(words.fold(all, |all, word| all + &word))
}

/// The most words whose frequency is told.
const MOST_WORDS: usize = 3;

fn sheet_head(state: &State) -> String {
    let row = state.row();
    let head = row.as_ref().and_then(|row| state.cursor.cell(row)).map(|cell| cell.head.clone());
    head.filter(|head| !head.is_empty()).unwrap_or_else(|| "that".into())
}

/// A message that says how many of the selected rows have the column under the cursor; `None` if all have it.
pub fn skipped(state: &State) -> Option<String> {
    let all = state.cursor.rows().len();
    let some = cells(state, &state.sheet()).len();
    let head = sheet_head(state);
    (some < all).then(|| format!("{some} of {all} rows have {head}"))
}

/// The kind of the item at a place; `None` if there are no kinds.
fn kind_of<'a>(document: &'a Document, field: &Field, pointer: &str) -> Option<&'a str> {
    let Kind::Tagged { tag, .. } = field.kind else { return None };
    document.json().pointer(pointer)?.get(tag)?.as_str()
}

/// The edit that sets the cell under the cursor, and the corresponding ones of the selection, to what `text` means.
pub fn edit(state: &State, text: &str) -> Result<Edit, String> {
    let sheet = state.sheet();
    if of_number(state) {
        return each(state, |row, cell, place| evaluate(state, &sheet, row, cell, place, text));
    }
    let cells = cells(state, &sheet).into_iter();
    Ok(Edit::all(cells.map(|(_, cell)| Edit::set(state.document(), &cell.pointer, Value::from(text)))))
}

/// The edit that sets every number of the selection to a value computed from its row, its cell and its index among them.
/// When vectors are turned, those without a length stay as they are.
pub fn each(
    state: &State,
    value: impl Fn(usize, &Cell, (usize, usize)) -> Result<f64, String>,
) -> Result<Edit, String> {
    let document = state.document();
    let cells = cells(state, &state.sheet());
    let (n, sheet) = (cells.len(), state.sheet());
    let turns = |cell: &Cell| cell.part != Part::Degrees || length(document, cell) > 0.0;
    let some = cells.iter().any(|(_, cell)| turns(cell));
    let each = cells.iter().enumerate().filter(|(_, (_, cell))| turns(cell) || !some);
    let edits = each.map(|(i, (row, cell))| {
        let edit = value(*row, cell, (i, n)).and_then(|value| number(document, cell, value));
        edit.map_err(|why| if n > 1 { format!("{}: {why}", told_row(&sheet, *row)) } else { why })
    });
    Ok(Edit::all(edits.collect::<Result<Vec<_>, _>>()?))
}

/// A row as its table calls it: by its number, a field by its name.
pub fn told_row(sheet: &Sheet, row: usize) -> String {
    let token = sheet.pointer(row).and_then(|pointer| Some(Pointer(&pointer).split()?.1)).unwrap_or_default();
    if index(&token).is_some() { format!("row {token}") } else { token }
}

/// The values that the text being typed has in the first selected rows, or what is wrong with it. `None` if no number is
/// being typed.
pub fn hint(state: &State) -> Option<Result<String, String>> {
    const SHOWN: usize = 3;
    let Mode::Entry(Entry { text }) = &state.typing.mode else { return None };
    let sheet = state.sheet();
    let cells = cells(state, &sheet);
    let n = cells.len();
    if text.value().trim().is_empty() || !cells.first()?.1.is_number() {
        return None;
    }
    let values = cells.iter().take(SHOWN).enumerate().map(|(i, (row, cell))| {
        let value = evaluate(state, &sheet, *row, cell, (i, n), text.value())?;
        in_range(&cell.field, cell.part, value).map(|()| numbers::exact(value))
    });
    let shown = values.collect::<Result<Vec<_>, _>>().map(|values| {
        let more = if n > SHOWN { " …" } else { "" };
        let all = state.cursor.rows().len();
        let counted = match n {
            n if n < all => format!(" ({n} of {all} rows)"),
            n if n > SHOWN => format!(" ({n} rows)"),
            _ => String::new(),
        };
        format!("= {}{more}{counted}", values.join(", "))
    });
    Some(shown)
}

/// The value of `text` for one cell, the `i`th of `n`: what is computed without the noise of floating point, what is written
/// out to its last digit.
fn evaluate(
    state: &State,
    sheet: &Sheet,
    row: usize,
    cell: &Cell,
    (i, n): (usize, usize),
    text: &str,
) -> Result<f64, String> {
    // Without letters no variable can occur, so the row is not needed.
    let row = text.contains(char::is_alphabetic).then(|| sheet.whole().row(row)).flatten();
    let value = variables(state, sheet, row.as_ref(), Some(cell), (i, n)).value(text).map_err(|why| why.to_string())?;
    Ok(if csv::number(text).is_some() { value } else { numbers::tidy(value) })
}

/// The value of `text` for each of these rows, whose column is that under the cursor; `None` for a row that lacks what it
/// names.
///
/// # Errors
/// It has no value in any of them, or one that is not finite in some.
pub fn of_rows(state: &State, rows: &BTreeSet<usize>, text: &str) -> Result<Vec<Option<f64>>, String> {
    let sheet = state.sheet();
    let here = state.row();
    let model = here.as_ref().and_then(|row| state.cursor.cell(row));
    let like = |cell: &&Cell| model.is_some_and(|model| model.head == cell.head && model.part == cell.part);
    let whole = sheet.whole();
    let (mut values, mut why) = (Vec::with_capacity(rows.len()), None);
    for (i, &at) in rows.iter().enumerate() {
        let row = whole.row(at);
        let cell = row.as_ref().and_then(|row| row.cells.iter().find(like));
        let value = variables(state, &sheet, row.as_ref(), cell, (i, rows.len())).value(text);
        values.push(match value {
            Ok(value) => Some(value),
            Err(own) if own.endless => return Err(format!("{}: {own}", told_row(&sheet, at))),
            Err(own) => {
                why.get_or_insert(own.to_string());
                None
            }
        });
    }
    match why {
        Some(why) if values.iter().all(Option::is_none) => Err(why),
        _ => Ok(values),
    }
}

/// What an expression over a row may name.
#[derive(Default)]
struct Known {
    numbers: Vec<(String, f64)>,
    words: Vec<(String, String)>,
}

impl Known {
    fn value(&self, text: &str) -> Result<f64, Mistake> {
        let numbers: Vec<(&str, f64)> = self.numbers.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        let words: Vec<(&str, &str)> = self.words.iter().map(|(name, word)| (name.as_str(), word.as_str())).collect();
        let known = Variables { numbers: &numbers, words: &words };
        expression::evaluate(text, &known)
    }
}

fn variables(state: &State, sheet: &Sheet, row: Option<&Row>, cell: Option<&Cell>, (i, n): (usize, usize)) -> Known {
    let document = state.document();
    // What follows from other fields may have no value; every other number begins at 0.
    let begins = |cell: &Cell| (cell.is_number() && !matches!(cell.part, Part::Derived(_))).then_some(0.0);
    let old = cell.and_then(|cell| cell.number(document).or(begins(cell)));
    let mut known: Vec<(String, f64)> = old.map(|old| ("v".to_string(), old)).into_iter().collect();
    let mut words = Vec::new();
    let others = if row.is_none_or(|row| row.item) { Vec::new() } else { sheet.fields() };
    for row in row.into_iter().chain(&others) {
        // If a row has several vectors, dx, dy, r and a are those of the one that is edited.
        let (own, others): (Vec<&Cell>, Vec<&Cell>) =
            row.cells.iter().partition(|one| cell.is_some_and(|cell| one.pointer == cell.pointer));
        for cell in own.into_iter().chain(others) {
            let name = match cell.part {
                Part::Length => "r",
                Part::Degrees => "a",
                _ if cell.head.is_empty() => &row.label,
                Part::Number(_) => cell.head.rsplit(' ').next().unwrap_or(&cell.head),
                Part::Whole | Part::Derived(_) => &cell.head,
            };
            // A name of several words is written as one.
            let name = &name.replace(' ', "_");
            if !cell.is_number() && !cell.is_node() {
                words.push((name.clone(), cell.text.clone()));
            }
            if let (Some(value), false) = (cell.number(document), known.iter().any(|(known, _)| known == name)) {
                known.push((name.to_string(), value));
            }
        }
    }
    if let Some((width, height)) = state.picture.size {
        known.extend([("w".to_string(), width as f64), ("h".to_string(), height as f64)]);
    }
    known.extend([("i".to_string(), i as f64), ("n".to_string(), n as f64)]);
    Known { numbers: known, words }
}

/// The edit that sets a cell to this number; refused if that is out of the field's range.
fn number(document: &Document, cell: &Cell, value: f64) -> Result<Edit, String> {
    in_range(&cell.field, cell.part, value)?;
    if cell.part == Part::Degrees && cell.number(document) != Some(value) && length(document, cell) == 0.0 {
        let length = cell.field.symbol.map_or("r".to_owned(), |symbol| format!("|{symbol}|"));
        return Err(format!("a vector without a length has no direction: set {length} first"));
    }
    Ok(Edit::set(document, &cell.pointer, cell.with_number(document, value)?))
}

fn length(document: &Document, cell: &Cell) -> f64 {
    Cell { part: Part::Length, ..cell.clone() }.number(document).unwrap_or(0.0)
}

/// Whether a number is being typed.
pub fn of_number(state: &State) -> bool {
    state.row().is_some_and(|row| state.cursor.cell(&row).is_some_and(Cell::is_number))
}

/// Types the coordinate of `at` that belongs into the field; for a jump, the distance from its point.
///
/// # Errors
/// The field is not a coordinate.
pub fn offer(state: &mut State, at: Point) -> Result<(), String> {
    let row = state.row();
    let cell = row.as_ref().and_then(|row| state.cursor.cell(row));
    let label = row.as_ref().map_or("", |row| &row.label);
    let name = cell.map_or("", |cell| if cell.head.is_empty() { label } else { &cell.head });
    let from = place::selected(state).unwrap_or_default();
    let (x, y) = (numbers::short(at.x), numbers::short(at.y));
    let value = match name {
        "x" => at.x,
        "y" => at.y,
        "dx" => at.x - from.x,
        "dy" => at.y - from.y,
        _ => return Err(format!("the window's pointer is at {x}, {y}: this field is not a coordinate")),
    };
    if let Mode::Entry(entry) = &mut state.typing.mode {
        entry.text = Text::new(numbers::exact(numbers::tidy(value)), true);
    }
    state.say(format!("the window's pointer is at {x}, {y}: Enter takes it"));
    Ok(())
}
