//! The middle: a node as a form or as a table. In a table the cells of like rows stand in columns under their names;
//! elsewhere each number stands beside its name.

use std::ops::Range;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Modifier, Style};

use super::{first_row, width, write};
use crate::scene::address;
use crate::scene::field::Kind;
use crate::tui::app::{Mode, Pane, State};
use crate::tui::sheet::{Cell, Row};
use crate::tui::{colour, entry, terminal};

/// Columns between two cells.
const GAP: i32 = 2;

/// The node's address.
pub fn title(state: &State) -> String {
    let address = address::address(state.document(), &state.node);
    terminal::plain(if address.is_empty() { "scene" } else { &address })
}

/// Where a cell stands in its row, right of the label.
struct Placed<'a> {
    cell: &'a Cell,
    /// Where its own name begins, where it is shown.
    head: Option<i32>,
    /// Where its text begins, and how wide it is.
    at: i32,
    width: i32,
}

/// Draws it; the cursor is on the focused cell, or on the entry in it.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let sheet = state.sheet();
    if sheet.is_empty() {
        write(buffer, area, 1, 0, if sheet.table { "empty: o adds an item" } else { "nothing here" }, colour::faint());
        return (state.focus == Pane::Table).then(|| area.as_position());
    }
    let height = area.height - u16::from(sheet.table);
    let first = first_row(state.row, sheet.len(), height);
    let near = neighbours(first, height);
    let rows = sheet.rows(near.clone());
    let labels = rows.iter().map(|row| label(row).1 + i32::from(width(&label(row).0))).max().unwrap_or(0);
    let labels = labels.min(i32::from(area.width) / 2) + GAP;
    let columns = Columns::of(&rows, sheet.table);
    let shown = &rows[first - near.start..rows.len().min(first - near.start + usize::from(height))];
    let laid: Vec<Vec<Placed>> = shown.iter().map(|row| columns.lay(row)).collect();
    let room = i32::from(area.width) - labels;
    let focused = laid.get(state.row - first).and_then(|row| row.get(state.column));
    let shift = focused.map_or(0, |p| (p.at + p.width + 1 - room).max(0));
    let cells = Rect { x: area.x + labels as u16, width: room.max(0) as u16, ..area };
    let below = u16::from(!columns.heads.is_empty());
    if below > 0 {
        draw_heads(&columns.heads, &laid, cells, shift, buffer);
    }
    let body = Rect { y: area.y + below, height: area.height - below, ..area };
    let cells = Rect { y: body.y, height: body.height, ..cells };
    let mut cursor = None;
    for (y, (row, placed)) in shown.iter().zip(&laid).enumerate() {
        let (y, i) = (y as u16, first + y);
        let selected = state.selected_from.is_some() && entry::rows(state).contains(&i);
        let shift = if sheet.table || i == state.row { shift } else { 0 };
        draw_label(row, selected, body, y, buffer);
        for (c, placed) in placed.iter().enumerate() {
            let here = i == state.row && c == state.column && state.focus == Pane::Table;
            let style = style(row, here, selected && c == state.column);
            if let Some(head) = placed.head {
                write(buffer, cells, head - shift, y, &placed.cell.head, colour::faint());
            }
            write(buffer, cells, placed.at - shift, y, &placed.cell.text, style);
            if here {
                let column = (placed.at - shift).clamp(0, (room - 1).max(0));
                cursor = Some(Position::new(cells.x + column as u16, cells.y + y));
            }
        }
    }
    match (&state.mode, cursor) {
        (Mode::Entry(typed), Some(at)) => {
            let end =
                laid.get(state.row - first).and_then(|row| row.last()).map_or(0, |last| last.at + last.width - shift);
            let (cursor, typed) = draw_entry(&typed.text, at, cells, buffer);
            draw_hint(state, end.max(typed) + GAP, at.y - cells.y, cells, buffer);
            Some(cursor)
        }
        _ => cursor,
    }
}

fn style(row: &Row, here: bool, selected: bool) -> Style {
    match (here, selected) {
        (true, _) => colour::focus(),
        (_, true) => Style::new().add_modifier(Modifier::REVERSED | Modifier::DIM),
        _ if row.set => Style::new(),
        _ => colour::faint(),
    }
}

/// A row's label and its indent: items inside a form stand under the name of their list.
fn label(row: &Row) -> (String, i32) {
    (terminal::plain(&row.label), if row.item { 1 } else { 0 })
}

fn draw_label(row: &Row, selected: bool, area: Rect, y: u16, buffer: &mut Buffer) {
    let (text, indent) = label(row);
    let style = if row.item { colour::faint() } else { Style::new() };
    write(buffer, area, indent, y, &text, style);
    if selected {
        write(buffer, area, 0, y, "*", colour::strong());
    }
}

fn draw_heads(heads: &[&str], laid: &[Vec<Placed>], cells: Rect, shift: i32, buffer: &mut Buffer) {
    let Some(row) = laid.iter().find(|row| row.len() == heads.len() && row.iter().all(|p| p.head.is_none())) else {
        return;
    };
    for (head, placed) in heads.iter().zip(row) {
        // Names stand over the ends of numbers and over the beginnings of words.
        let edge = if placed.cell.is_number() {
            placed.at + i32::from(width(&placed.cell.text)) - i32::from(width(head))
        } else {
            placed.at
        };
        write(buffer, cells, edge - shift, 0, head, colour::strong());
    }
}

/// The rows whose columns are laid out together: those in sight and their neighbours up to round numbers, so that
/// columns keep their places while the table scrolls.
fn neighbours(first: usize, height: u16) -> Range<usize> {
    const ROUND: usize = 64;
    first / ROUND * ROUND..(first + usize::from(height)).next_multiple_of(ROUND)
}

/// How wide the columns are: of the rows with the same cells, together.
struct Columns<'a> {
    /// The names over the table: those of its longest row; none over a form.
    heads: Vec<&'a str>,
    table: bool,
    groups: Vec<(Vec<&'a str>, Vec<i32>)>,
}

impl<'a> Columns<'a> {
    fn of(rows: &'a [Row], table: bool) -> Self {
        let heads = |row: &'a Row| row.cells.iter().map(|cell| cell.head.as_str());
        let mut groups: Vec<(Vec<&str>, Vec<i32>)> = Vec::new();
        for row in rows.iter().filter(|row| row.item) {
            let known = groups.iter().position(|(group, _)| heads(row).eq(group.iter().copied()));
            let known = known.unwrap_or_else(|| {
                groups.push((heads(row).collect(), vec![0; row.cells.len()]));
                groups.len() - 1
            });
            for (widest, cell) in groups[known].1.iter_mut().zip(&row.cells) {
                *widest = i32::from(width(&cell.text)).max(*widest);
            }
        }
        // The first of the longest, so that equal ones do not change places.
        let longest = groups.iter().rev().max_by_key(|(group, _)| group.len()).filter(|_| table);
        Columns { heads: longest.map(|(group, _)| group.clone()).unwrap_or_default(), table, groups }
    }

    /// Lays the cells of a row out: in the columns of all rows like it, each with its name where no heading says it.
    fn lay(&self, row: &'a Row) -> Vec<Placed<'a>> {
        let heads = || row.cells.iter().map(|cell| cell.head.as_str());
        let group = self.groups.iter().filter(|_| row.item).find(|(group, _)| heads().eq(group.iter().copied()));
        let under_heads = row.item && heads().eq(self.heads.iter().copied());
        let mut x = 0;
        let place = |(c, cell): (usize, &'a Cell)| {
            // What an item is says itself.
            let says_itself = c == 0 && matches!(cell.field.kind, Kind::Choice(_));
            let own = i32::from(width(&cell.text));
            let widest = group.map_or(own, |(_, widths)| widths[c]);
            let named = !under_heads && !says_itself && !cell.head.is_empty() && (row.cells.len() > 1 || self.table);
            let head = named.then_some(x);
            let name = i32::from(width(&cell.head));
            let wide = if under_heads { widest.max(name) } else { widest };
            let start = x + if named { name + 1 } else { 0 };
            let at = if cell.is_number() { start + wide - own } else { start };
            x = start + wide + GAP;
            Placed { cell, head, at, width: own }
        };
        row.cells.iter().enumerate().map(place).collect()
    }
}

/// What the entry comes to stands beside it, where the row leaves room; under the table it stands in full.
fn draw_hint(state: &State, x: i32, y: u16, cells: Rect, buffer: &mut Buffer) {
    let (text, style) = match entry::hint(state) {
        Some(Ok(values)) => (values, colour::faint()),
        Some(Err(why)) => (format!("? {why}"), colour::faint().add_modifier(Modifier::ITALIC)),
        None => return,
    };
    if x + i32::from(width(&text)) <= i32::from(cells.width) {
        write(buffer, cells, x, y, &text, style);
    }
}

/// The entry stands where its cell does, and moves left where it would not fit. Gives the cursor and the column after it.
fn draw_entry(text: &crate::tui::text::Text, at: Position, cells: Rect, buffer: &mut Buffer) -> (Position, i32) {
    let shown = terminal::plain(text.value());
    let wide = width(&shown).max(8) + 1;
    let x = at.x.min((cells.x + cells.width).saturating_sub(wide)).max(cells.x);
    let style = if text.is_fresh() { colour::focus() } else { Style::new().add_modifier(Modifier::UNDERLINED) };
    let room = cells.right().saturating_sub(x);
    let hidden = (text.column() as u16 + 1).saturating_sub(room);
    let line = Rect { x, y: at.y, width: room.min(wide), height: 1 };
    write(buffer, line, 0, 0, &" ".repeat(usize::from(wide)), Style::new().add_modifier(Modifier::UNDERLINED));
    write(buffer, line, -i32::from(hidden), 0, &shown, style);
    let end = i32::from(x + room.min(wide)) - i32::from(cells.x);
    (Position::new(x + (text.column() as u16).saturating_sub(hidden), at.y), end)
}
