//! Below the form: what the schema says about the cell under the cursor, and the value of what is being typed into it.

use crate::tui::text::plain;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

use super::write;
use crate::tui::document::cell;
use crate::tui::document::cell::{Cell, Part};
use crate::tui::document::derived;
use crate::tui::state::{State, entry};
use crate::tui::text::wrap::wrapped;
use crate::tui::text::{color, numbers};

/// Draws name, value, unit and range; help; the value of the entry.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let Some(row) = state.row() else { return };
    let Some(cell) = state.cursor.cell(&row) else { return };
    let number = cell.number(state.document()).filter(|_| cell.is_number());
    let value = number.map_or(cell.text.clone(), numbers::exact);
    let name = if cell.head.is_empty() || cell.head == row.label { String::new() } else { format!(" {}", cell.head) };
    let polar = matches!(cell.part, Part::Length | Part::Degrees);
    let range = cell::told_range(&cell.field).filter(|_| !polar).map(|range| format!("   {range}")).unwrap_or_default();
    let unit = if cell.part == Part::Degrees { Some("degrees counter-clockwise") } else { cell.field.unit };
    let unit = unit.map(|unit| format!(" {unit}")).unwrap_or_default();
    let set = match derived::automatic(state.document(), &cell.pointer) {
        _ if cell.set => "",
        Some(_) => "   (automatic)",
        None => "   (default)",
    };
    let label = plain(&row.label);
    let mut x = write(buffer, area, 0, 0, &format!("{label}{name}"), color::strong());
    x = write(buffer, area, x, 0, &format!("   {value}{unit}"), Style::new());
    x = write(buffer, area, x, 0, &range, color::faint());
    write(buffer, area, x, 0, set, color::faint());
    let hint = entry::hint(state);
    let lines = if hint.is_some() { 1 } else { 2 };
    for (y, line) in wrapped(help(cell), area.width).iter().take(lines).enumerate() {
        write(buffer, area, 0, 1 + y as u16, line, Style::new());
    }
    match hint {
        Some(Ok(values)) => drop(write(buffer, area, 0, 2, &values, color::strong())),
        Some(Err(why)) => drop(write(buffer, area, 0, 2, &why, Style::new().add_modifier(Modifier::ITALIC))),
        None => {}
    }
}

/// The help for a cell: if it is a choice, for its present word.
fn help(cell: &Cell) -> &'static str {
    let word = cell.field.kind.words().iter().find(|one| one.name == cell.text && !one.help.is_empty());
    word.map_or(cell.field.help, |one| one.help)
}
