//! The middle column: a node as a form or as a table. In a table, cells are in columns below their names; in a form each
//! number is beside its name.

use crate::tui::text::plain;
use std::collections::BTreeSet;
use std::ops::Range;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Modifier, Style};

use super::columns::{Columns, GAP, Placed, VisibleCells};
use super::{typed, write};
use crate::scene::address;
use crate::tui::document::cell::Cell;
use crate::tui::document::sheet::Row;
use crate::tui::layout::first_row;
use crate::tui::state::{Mode, Pane, State, entry};
use crate::tui::text::wrap::{clipped, width};
use crate::tui::text::{color, numbers};

/// The node's address.
pub fn title(state: &State) -> String {
    let address = address::address(state.document(), &state.cursor.node);
    plain(if address.is_empty() { "scene" } else { &address })
}

/// Draws the node; the cursor is on the focused cell, or in what is typed into it.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let sheet = state.sheet();
    if sheet.is_empty() {
        write(buffer, area, 1, 0, if sheet.table { "empty: o adds an item" } else { "nothing here" }, color::faint());
        return (state.cursor.focus == Pane::Table).then(|| area.as_position());
    }
    let height = area.height - u16::from(sheet.table);
    let first = first_row(state.cursor.row, sheet.len(), height);
    let near = neighbors(first, height);
    let rows = sheet.rows(near.clone());
    let labels = rows.iter().map(|row| label(row).1 + i32::from(width(&label(row).0))).max().unwrap_or(0);
    let labels = labels.min(i32::from(area.width) / 2) + GAP;
    let room = (i32::from(area.width) - labels).max(0);
    let columns = Columns::of(&rows, sheet.table, room);
    let shown = &rows[first - near.start..rows.len().min(first - near.start + usize::from(height))];
    let laid: Vec<Vec<Placed>> = shown.iter().map(|row| columns.lay(row)).collect();
    let sights = sights(state, shown, &laid, state.cursor.row - first, room);
    let below = u16::from(!columns.heads.is_empty());
    let cells = Rect { x: area.x + labels as u16, width: room as u16, ..area };
    if below > 0 {
        draw_heads(&columns.heads, &laid, &sights, cells, buffer);
    }
    let body = Rect { y: area.y + below, height: area.height - below, ..area };
    let cells = Rect { y: body.y, height: body.height, ..cells };
    let mut cursor = None;
    let selection = if state.cursor.selects() { state.cursor.rows() } else { BTreeSet::new() };
    for (y, (row, placed)) in shown.iter().zip(&laid).enumerate() {
        let i = first + y;
        let selected = selection.contains(&i);
        draw_label(row, selected, body, y as u16, buffer);
        let end = draw_marks(placed, sights[y], cells, y as u16, buffer);
        let limit = room - if sights[y].goes_on(placed) { GAP } else { 0 };
        for (c, placed, shift) in sights[y].cells(placed) {
            let here = i == state.cursor.row && c == state.cursor.column && state.cursor.focus == Pane::Table;
            let style = style(placed.cell, here, selected && c == state.cursor.column);
            if let Some(head) = placed.head {
                write(buffer, cells, head - shift, y as u16, &placed.cell.head, color::faint());
            }
            let at = placed.at - shift;
            write(buffer, cells, at, y as u16, &text(placed, limit - at), style);
            if here {
                let column = at.clamp(0, (room - 1).max(0));
                cursor = Some((Position::new(cells.x + column as u16, cells.y + y as u16), end));
            }
        }
    }
    match (&state.typing.mode, cursor) {
        (Mode::Entry(typed), Some((at, end))) => {
            let (cursor, typed) = draw_entry(&typed.text, at, cells, buffer);
            draw_hint(state, end.max(typed) + GAP, at.y - cells.y, cells, buffer);
            Some(cursor)
        }
        _ => cursor.map(|(at, _)| at),
    }
}

/// Which cells of each row are visible: rows with the same cells show the same ones, and the cell under the cursor is visible.
fn sights(state: &State, rows: &[Row], laid: &[Vec<Placed>], at: usize, room: i32) -> Vec<VisibleCells> {
    let Some(own) = rows.get(at) else { return vec![VisibleCells::default(); rows.len()] };
    let stay = if own.item { state.memory.columns.frozen(&state.cursor.node) } else { 0 };
    let here = VisibleCells::of(&laid[at], stay, state.cursor.column, room);
    let like = |row: &Row| {
        let heads = |row: &Row| row.cells.iter().map(|cell| cell.head.clone()).collect::<Vec<_>>();
        row.item == own.item && heads(row) == heads(own)
    };
    let visible = |(i, row): (usize, &Row)| match row {
        _ if i == at => here,
        row if row.item && like(row) => here,
        row if row.item => VisibleCells::beside(&laid[i], here, room),
        _ => VisibleCells::of(&laid[i], 0, 0, room),
    };
    rows.iter().enumerate().map(visible).collect()
}

/// The text of a cell as far as it fits into the rest of the row.
fn text(placed: &Placed, room: i32) -> String {
    let room = usize::try_from(room).unwrap_or(0);
    if placed.cell.is_number() { numbers::fitted(&placed.text, room) } else { clipped(&placed.text, room) }
}

/// Marks where cells are left out; returns where the last visible cell ends.
fn draw_marks(row: &[Placed], visible: VisibleCells, cells: Rect, y: u16, buffer: &mut Buffer) -> i32 {
    if let Some(x) = visible.before(row) {
        write(buffer, cells, x, y, "<", color::faint());
    }
    if visible.goes_on(row) {
        write(buffer, cells, i32::from(cells.width) - 1, y, ">", color::faint());
        return i32::from(cells.width);
    }
    visible.cells(row).last().map_or(0, |(_, placed, shift)| placed.end - shift)
}

fn style(cell: &Cell, here: bool, selected: bool) -> Style {
    match (here, selected) {
        (true, _) => color::focus(),
        (_, true) => Style::new().add_modifier(Modifier::REVERSED | Modifier::DIM),
        _ if cell.set => Style::new(),
        _ => color::faint(),
    }
}

/// A row's label and its indent: items inside a form are indented below the name of their list.
fn label(row: &Row) -> (String, i32) {
    (plain(&row.label), if row.item { 1 } else { 0 })
}

fn draw_label(row: &Row, selected: bool, area: Rect, y: u16, buffer: &mut Buffer) {
    let (text, indent) = label(row);
    let style = if row.item { color::faint() } else { Style::new() };
    write(buffer, area, indent, y, &text, style);
    if selected {
        write(buffer, area, 0, y, "*", color::strong());
    }
}

fn draw_heads(heads: &[&str], laid: &[Vec<Placed>], sights: &[VisibleCells], cells: Rect, buffer: &mut Buffer) {
    let under = |row: &Vec<Placed>| row.len() == heads.len() && row.iter().all(|placed| placed.head.is_none());
    let Some(at) = laid.iter().position(under) else { return };
    draw_marks(&laid[at], sights[at], cells, 0, buffer);
    for (c, placed, shift) in sights[at].cells(&laid[at]) {
        // Names are right-aligned above numbers and left-aligned above words.
        let number = placed.cell.is_number();
        let edge = if number { placed.end - i32::from(width(heads[c])) } else { placed.at };
        write(buffer, cells, edge - shift, 0, heads[c], color::strong());
    }
}

/// The rows whose columns are laid out together: the visible ones and some around them, up to round numbers, so that the
/// columns stay in place while the table scrolls.
fn neighbors(first: usize, height: u16) -> Range<usize> {
    const ROUND: usize = 64;
    first / ROUND * ROUND..(first + usize::from(height)).next_multiple_of(ROUND)
}

/// The value of the entry, beside it if there is room; it is always shown in full below the table.
fn draw_hint(state: &State, x: i32, y: u16, cells: Rect, buffer: &mut Buffer) {
    let (text, style) = match entry::hint(state) {
        Some(Ok(values)) => (values, color::faint()),
        Some(Err(why)) => (format!("? {why}"), color::faint().add_modifier(Modifier::ITALIC)),
        None => return,
    };
    if x + i32::from(width(&text)) <= i32::from(cells.width) {
        write(buffer, cells, x, y, &text, style);
    }
}

/// Draws the entry at the place of its cell, further left if it would not fit. Returns the cursor and the column after it.
fn draw_entry(text: &crate::tui::text::input::Text, at: Position, cells: Rect, buffer: &mut Buffer) -> (Position, i32) {
    let wide = width(&plain(text.value())).max(8) + 1;
    let x = at.x.min((cells.x + cells.width).saturating_sub(wide)).max(cells.x);
    let style = if text.is_fresh() { color::focus() } else { Style::new().add_modifier(Modifier::UNDERLINED) };
    let line = Rect { x, y: at.y, width: cells.right().saturating_sub(x).min(wide), height: 1 };
    write(buffer, line, 0, 0, &" ".repeat(usize::from(line.width)), Style::new().add_modifier(Modifier::UNDERLINED));
    let cursor = typed(buffer, line, text, style);
    (cursor, i32::from(line.right()) - i32::from(cells.x))
}
