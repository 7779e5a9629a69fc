//! Tables as text: rows of numbers from a spreadsheet or another program (`csv.rs` reads them) become items of a list, and
//! rows become CSV. The columns are those that the table shows, read from a new item of the list, so that a new field needs
//! nothing here.

use std::collections::{BTreeMap, BTreeSet};

use csv::Writer;
use kurbo::Vec2;
use serde_json::{Value, json};

use super::cell::{Cell, Part, in_range};
use super::csv::{Record, number, records};
use super::sheet::{Row, Sheet};
use crate::base::number;
use crate::base::pointer::Pointer;
use crate::base::problem::{nearest, quoted};
use crate::base::text::counted;
use crate::scene::field::{self, Kind};
use crate::scene::{Document, Edit};
use crate::tui::text::numbers;

/// Other names of columns, in lower case.
const ALIASES: &[(&str, &[&str])] = &[
    ("in dx", &["dx"]),
    ("in dy", &["dy"]),
    ("|J|", &["j", "r", "length"]),
    ("°", &["a", "angle", "deg", "degrees"]),
    ("τ", &["t", "tau"]),
];

/// Columns that only count the rows.
const COUNTERS: &[&str] = &["#", "", "i", "index", "no"];

/// Rows of a sheet as CSV: a header of the columns' names, numbers with all their decimals.
pub fn write(document: &Document, sheet: &Sheet, rows: &BTreeSet<usize>) -> String {
    let rows: Vec<Row> = rows.iter().filter_map(|&row| sheet.row(row)).collect();
    let mut heads: Vec<&str> = Vec::new();
    for cell in rows.iter().flat_map(|row| &row.cells) {
        if !heads.contains(&cell.head.as_str()) {
            heads.push(&cell.head);
        }
    }
    let mut out = Writer::from_writer(Vec::new());
    let texts = rows.iter().map(|row| {
        let of = |head: &&str| row.cells.iter().find(|cell| cell.head == *head);
        let of = |head: &&str| of(head).map(|cell| exact(document, cell)).unwrap_or_default();
        heads.iter().map(of).collect::<Vec<_>>()
    });
    let header = heads.iter().map(|head| (*head).to_owned()).collect::<Vec<_>>();
    for record in std::iter::once(header).chain(texts) {
        out.write_record(&record).expect("memory takes every record of one length");
    }
    String::from_utf8(out.into_inner().expect("memory is flushed")).expect("text was written")
}

/// Rows in a few characters: `0,2-5`.
pub fn ranges(rows: &BTreeSet<usize>) -> String {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for &row in rows {
        match runs.last_mut() {
            Some((_, last)) if *last + 1 == row => *last = row,
            _ => runs.push((row, row)),
        }
    }
    let told =
        |&(first, last): &(usize, usize)| if first == last { first.to_string() } else { format!("{first}-{last}") };
    runs.iter().map(told).collect::<Vec<_>>().join(",")
}

/// Reverses [`ranges`], for a table of so many rows; `None` if that is not how rows are written, or there are no such rows.
pub fn of_ranges(text: &str, count: usize) -> Option<BTreeSet<usize>> {
    let mut rows = BTreeSet::new();
    for run in text.split(',') {
        let (first, last) = run.split_once('-').unwrap_or((run, run));
        let (first, last) = (first.parse::<usize>().ok()?, last.parse::<usize>().ok().filter(|last| *last < count)?);
        rows.extend(first..=last);
    }
    Some(rows)
}

/// What a cell says as text: a number with all its decimals.
pub fn exact(document: &Document, cell: &Cell) -> String {
    match cell.number(document) {
        Some(number) if cell.is_number() => numbers::exact(number),
        _ => field::value(document, &cell.pointer)
            .and_then(|value| value.as_str().map(str::to_owned))
            .unwrap_or(cell.text.clone()),
    }
}

/// A column of a list's table.
struct Column {
    head: String,
    /// Where its value is in the item.
    path: String,
    cell: Cell,
}

/// What a new item of a list looks like: what must be written of it, and its columns.
struct Specimen {
    item: Value,
    columns: Vec<Column>,
    /// Columns that must be there.
    required: Vec<usize>,
}

/// A list that takes rows.
pub struct Target<'a> {
    document: &'a Document,
    list: String,
    /// The field that tells kinds of items apart, and the kinds.
    tag: Option<(&'static str, Vec<&'static str>)>,
    specimen: Specimen,
}

impl<'a> Target<'a> {
    /// The list at `list`; `None` if its items are more than numbers.
    pub fn of(document: &'a Document, list: &str) -> Option<Target<'a>> {
        let Kind::List(item) = field::field(document, list)?.kind else { return None };
        let tag = match item.kind {
            Kind::Tagged { tag, variants } => Some((tag, variants.iter().map(|one| one.name).collect())),
            Kind::Object | Kind::Numbers(_) | Kind::Number { .. } => None,
            Kind::Text | Kind::Bool | Kind::Choice(_) | Kind::List(_) | Kind::Map(_) | Kind::Reference(_) => {
                return None;
            }
        };
        Some(Target { document, list: list.to_owned(), tag, specimen: Specimen::of(document, list, None)? })
    }

    /// The items that `text` has, a row each, or what is wrong with it: the line and the column.
    pub fn items(&self, text: &str, most: u64) -> Result<Vec<Value>, String> {
        let mut records = records(text)?;
        if records.len() as u64 > most {
            return Err(format!("{} rows are too many: {most} at most", records.len()));
        }
        let is_header = |record: &Record| record.fields.iter().all(|field| number(field).is_none());
        let header = (records.first().is_some_and(is_header) && !records.is_empty()).then(|| records.remove(0));
        match header {
            Some(header) if records.is_empty() => Err(self.alone(&header)),
            Some(header) => self.by_heads(&header, &records),
            None => self.by_place(&records),
        }
    }

    /// What is wrong with a line without a number after which nothing comes.
    fn alone(&self, line: &Record) -> String {
        let columns = &self.specimen.columns;
        let known = |head: &&String| columns.iter().any(|column| same(head, &column.head));
        match line.fields.iter().find(|head| !known(head)) {
            None => "there is a header but no rows".into(),
            Some(other) => {
                let (line, other, wanted) = (line.line, quoted(other), self.wanted());
                format!("line {line}: {other} is neither a number nor a column: a row takes {wanted}")
            }
        }
    }

    /// The columns that are read without a header.
    fn plain(&self) -> Vec<&Column> {
        self.specimen.columns.iter().filter(|column| column.cell.is_number() && !follows(column.cell.part)).collect()
    }

    fn wanted(&self) -> String {
        self.plain().iter().map(|column| column.head.as_str()).collect::<Vec<_>>().join(" ")
    }

    /// Without a header the numbers of a row are x, y and so on, as the table shows them.
    fn by_place(&self, records: &[Record]) -> Result<Vec<Value>, String> {
        let all = &self.specimen.columns;
        let plain = self.plain();
        let count = records.first().map_or(0, |record| record.fields.len());
        let enough = self.specimen.required.iter().all(|&i| plain.iter().take(count).any(|c| c.head == all[i].head));
        if count > plain.len() || !enough {
            let line = records.first().map_or(1, |record| record.line);
            return Err(format!("line {line} has {}, but a row takes {}", counted(count, "value"), self.wanted()));
        }
        let item = |record: &Record| {
            let cells = plain.iter().copied().zip(&record.fields).enumerate();
            self.specimen.item(cells.map(|(i, (column, field))| (i + 1, column, field.as_str())), record.line)
        };
        records.iter().map(item).collect()
    }

    /// With a header columns may come in any order and be left out.
    fn by_heads(&self, header: &Record, records: &[Record]) -> Result<Vec<Value>, String> {
        let mut kinds = BTreeMap::new();
        let tagged = self.tag.as_ref().and_then(|(tag, _)| header.fields.iter().position(|head| same(head, tag)));
        let mut items = Vec::with_capacity(records.len());
        for record in records {
            let word = tagged.and_then(|i| record.fields.get(i)).filter(|word| !word.is_empty());
            let specimen = match word {
                None => &self.specimen,
                Some(word) => {
                    if !kinds.contains_key(word.as_str()) {
                        let at = format!("line {}, column {}", record.line, tagged.unwrap_or(0) + 1);
                        kinds.insert(word.clone(), self.kind(word).map_err(|why| format!("{at}: {why}"))?);
                    }
                    &kinds[word.as_str()]
                }
            };
            items.push(self.row(specimen, header, record)?);
        }
        Ok(items)
    }

    /// A specimen of another kind of item.
    fn kind(&self, word: &str) -> Result<Specimen, String> {
        let (tag, words) = self.tag.as_ref().ok_or("there are no kinds here")?;
        if !words.contains(&word) {
            let near = nearest(word, words.iter().copied()).unwrap_or_default();
            return Err(format!("there is no {tag} {}: {near}", quoted(word)));
        }
        let specimen = Specimen::of(self.document, &self.list, Some((tag, word)));
        specimen.ok_or(format!("a {word} is more than numbers: paste it as JSON"))
    }

    fn row(&self, specimen: &Specimen, header: &Record, record: &Record) -> Result<Value, String> {
        let mut cells = Vec::new();
        for (i, head) in header.fields.iter().enumerate() {
            let field = record.fields.get(i).map_or("", String::as_str);
            match specimen.columns.iter().find(|column| same(head, &column.head)) {
                Some(column) if !field.is_empty() => cells.push((i + 1, column, field)),
                None if !COUNTERS.contains(&head.to_lowercase().as_str())
                    && (!field.is_empty() || self.tag.is_none()) =>
                {
                    let known = specimen.columns.iter().map(|column| column.head.as_str());
                    let (line, column) = (header.line, i + 1);
                    let near = nearest(head, known).unwrap_or_default();
                    return Err(format!(
                        "line {line}, column {column}: there is no column {} here: {near}",
                        quoted(head)
                    ));
                }
                _ => {}
            }
        }
        specimen.item(cells.into_iter(), record.line)
    }
}

impl Specimen {
    /// Of the first kind of item, or of another one; `None` if it is more than numbers.
    fn of(document: &Document, list: &str, kind: Option<(&str, &str)>) -> Option<Specimen> {
        let (edit, path) = Edit::insert_new(document, list, 0)?;
        let mut with = document.apply(&edit).ok()?;
        if let Some((tag, word)) = kind {
            with = with.apply(&Edit::set(&with, &Pointer(&path).join(tag), word.into())).ok()?;
        }
        let mut item = with.json().pointer(&path)?.clone();
        let children = field::children(&with, &path);
        let tag = field::field(&with, &path)?.kind.tag().map(|(tag, _)| tag);
        let name = |child: &field::Child| Pointer(&child.pointer).split().map(|(_, name)| name).unwrap_or_default();
        let mut musts = vec![path.clone()];
        for child in &children {
            let number = matches!(child.field.kind, Kind::Number { .. } | Kind::Numbers(_));
            match (child.field.optional, number, tag == Some(name(child).as_str())) {
                (true, ..) => drop(item.as_object_mut().and_then(|map| map.shift_remove(&name(child)))),
                (false, true, _) => musts.push(child.pointer.clone()),
                (false, false, true) => {}
                (false, false, false) => return None,
            }
        }
        let sheet = Sheet::of(&with, list);
        let row = sheet.row(sheet.position(&path)?)?;
        let column = |cell: Cell| Column { head: cell.head.clone(), path: cell.pointer[path.len()..].to_owned(), cell };
        let columns: Vec<Column> = row.cells.into_iter().map(column).collect();
        let must = |column: &Column| {
            column.cell.is_number() && !follows(column.cell.part) && musts.contains(&column.cell.pointer)
        };
        let required = (0..columns.len()).filter(|&i| must(&columns[i])).collect();
        Some(Specimen { item, columns, required })
    }

    /// An item of the fields of a line, each with its number in the line and its column.
    fn item<'a>(&self, cells: impl Iterator<Item = (usize, &'a Column, &'a str)>, line: u64) -> Result<Value, String> {
        let mut item = self.item.clone();
        let mut given = Vec::new();
        let mut polar: BTreeMap<&str, (Option<f64>, Option<f64>)> = BTreeMap::new();
        for (at, column, text) in cells {
            let read = read(&column.cell, text);
            let read = read.map_err(|why| format!("line {line}, column {at}: {why}"))?;
            given.push((column.path.as_str(), column.cell.part));
            match (column.cell.part, read.as_f64()) {
                (Part::Length, length) => polar.entry(&column.path).or_default().0 = length,
                (Part::Degrees, degrees) => polar.entry(&column.path).or_default().1 = degrees,
                (Part::Number(i), _) => set_number(&mut item, &column.path, i, &column.cell, read),
                (Part::Whole, _) => set_whole(&mut item, &column.path, read),
                (Part::Derived(_), _) => {}
            }
        }
        for (path, (length, degrees)) in polar {
            let cartesian = |i| given.contains(&(path, Part::Number(i)));
            if cartesian(0) || cartesian(1) {
                continue;
            }
            let length = length.ok_or_else(|| format!("line {line}: ° needs |J| beside it"))?;
            let Vec2 { x, y } = numbers::cartesian(length, degrees.unwrap_or(0.0));
            given.extend([(path, Part::Number(0)), (path, Part::Number(1))]);
            set_whole(&mut item, path, json!([number::json(x), number::json(y)]));
        }
        let given_of = |path: &str, of: fn(Part) -> bool| given.iter().any(|(one, part)| *one == path && of(*part));
        let is_alone = |column: &&Column| {
            given.contains(&(&column.path, column.cell.part))
                && matches!(column.cell.part, Part::Derived(_))
                && !given_of(&column.path, |part| matches!(part, Part::Number(_)))
        };
        if let Some(column) = self.columns.iter().find(is_alone) {
            return Err(format!("line {line}: {} follows from {}, which is missing", column.head, &column.path[1..]));
        }
        let missing = self.required.iter().map(|&i| &self.columns[i]);
        match missing.into_iter().find(|column| !given.contains(&(column.path.as_str(), column.cell.part))) {
            Some(column) => Err(format!("line {line}: {} is missing", column.head)),
            None => Ok(item),
        }
    }
}

/// A field of a line as the cell of its column wants it.
pub fn read(cell: &Cell, text: &str) -> Result<Value, String> {
    let Cell { field, part, .. } = cell;
    if cell.is_number() {
        let value = number(text).ok_or_else(|| format!("{} is not a number", quoted(text)))?;
        return in_range(field, *part, value).map(|()| number::json(value));
    }
    match &field.kind {
        Kind::Text | Kind::Reference(_) => Ok(text.into()),
        Kind::Choice(words) if words.iter().any(|word| word.name == text) => Ok(text.into()),
        Kind::Choice(words) => Err(nearest(text, words.iter().map(|word| word.name)).unwrap_or_default()),
        Kind::Tagged { tag, .. } => Ok(json!({ *tag: text })),
        Kind::Bool if ["yes", "true", "1"].contains(&text) => Ok(true.into()),
        Kind::Bool => Ok(false.into()),
        Kind::Number { .. } | Kind::Numbers(_) | Kind::List(_) | Kind::Map(_) | Kind::Object => {
            Err(format!("{} cannot be pasted as text: paste the item as JSON", field.name))
        }
    }
}

/// Writes one of the numbers of a list, the others 0 or their defaults.
fn set_number(item: &mut Value, path: &str, index: usize, cell: &Cell, number: Value) {
    if item.pointer(path).is_none_or(|there| !there.is_array()) {
        let count = if let Kind::Numbers(names) = &cell.field.kind { names.len() } else { index + 1 };
        let default = cell.field.default.clone().filter(Value::is_array);
        set_whole(item, path, default.unwrap_or_else(|| Value::from(vec![0; count])));
    }
    if let Some(place) = item.pointer_mut(path).and_then(|numbers| numbers.get_mut(index)) {
        *place = number;
    }
}

/// Writes a field of an item, or all of it.
fn set_whole(item: &mut Value, path: &str, value: Value) {
    match (Pointer(path).split(), item) {
        (Some((_, name)), Value::Object(map)) => drop(map.insert(name, value)),
        (_, item) => *item = value,
    }
}

/// Whether a part of a value follows from its numbers, which go before it.
pub fn follows(part: Part) -> bool {
    !matches!(part, Part::Whole | Part::Number(_))
}

/// Whether the head of a pasted column means this column.
pub fn same(pasted: &str, head: &str) -> bool {
    let pasted = pasted.to_lowercase();
    let also = ALIASES.iter().find(|(own, _)| *own == head).map_or(&[] as &[_], |(_, also)| also);
    pasted == head.to_lowercase() || also.contains(&pasted.as_str())
}
