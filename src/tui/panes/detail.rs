//! Under the form: what the schema says about the cell under the cursor, and what the entry in it comes to.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

use super::write;
use crate::tui::app::{Mode, State};
use crate::tui::{colour, entry, numbers, terminal};

/// Draws it: name, value, unit and range; help; the value of the entry.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let sheet = state.sheet();
    let Some((row, cell)) = sheet.rows.get(state.row).and_then(|row| Some((row, row.cells.get(state.column)?))) else {
        return;
    };
    let number = cell.number(state.document()).filter(|_| cell.is_number());
    let value = number.map_or(cell.text.clone(), numbers::exact);
    let name = if cell.head.is_empty() || cell.head == row.label { String::new() } else { format!(" {}", cell.head) };
    let range = cell.field.range_text().map(|range| format!("   {range}")).unwrap_or_default();
    let unit = cell.field.unit.map(|unit| format!(" {unit}")).unwrap_or_default();
    let set = if row.set { "" } else { "   (default)" };
    let label = terminal::plain(&row.label);
    let mut x = write(buffer, area, 0, 0, &format!("{label}{name}"), colour::strong());
    x = write(buffer, area, x, 0, &format!("   {value}{unit}"), Style::new());
    x = write(buffer, area, x, 0, &range, colour::faint());
    write(buffer, area, x, 0, set, colour::faint());
    write(buffer, area, 0, 1, cell.field.help, Style::new());
    let Mode::Entry(typed) = &state.mode else { return };
    if !cell.is_number() || typed.text.value().trim().is_empty() {
        return;
    }
    let n = entry::cells(state, &sheet).len();
    let (text, style) = match entry::evaluate(state, &sheet, row, cell, (0, n), typed.text.value()) {
        Ok(value) => (format!("= {}", numbers::exact(numbers::tidy(value))), colour::strong()),
        Err(mistake) => (mistake, Style::new().add_modifier(Modifier::ITALIC)),
    };
    write(buffer, area, 0, 2, &text, style);
}
