//! The tree of the scene.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Modifier, Style};

use super::write;
use crate::tui::document::tree;
use crate::tui::layout::first_row;
use crate::tui::state::{Pane, State};
use crate::tui::text::color;
use crate::tui::text::wrap::{clipped, width};

/// Draws the tree; the cursor is on the node that is shown, if the tree has the focus.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let rows = tree::rows(state.document(), &state.cursor.collapsed);
    let at = tree::row_of(&rows, &state.cursor.node);
    let first = first_row(at, rows.len(), area.height);
    let mut cursor = None;
    for (y, (i, row)) in rows.iter().enumerate().skip(first).take(usize::from(area.height)).enumerate() {
        let y = y as u16;
        let mark = row.collapsed.map_or("  ", |collapsed| if collapsed { "▸ " } else { "▾ " });
        let style = match i == at {
            true if state.cursor.focus == Pane::Tree => color::focus(),
            true => Style::new().add_modifier(Modifier::BOLD | Modifier::UNDERLINED),
            false => Style::new(),
        };
        let indent = (row.depth as i32 * 2).min(i32::from(area.width) / 2);
        let x = write(buffer, area, indent, y, mark, Style::new());
        // A count is always shown whole. It clips the name, and the name clips other notes.
        let apart = state.apart.told(&row.pointer);
        let note = if apart.is_empty() { &row.note } else { &apart };
        let count = if note.starts_with('(') || !apart.is_empty() { i32::from(width(note)) + 1 } else { 0 };
        let label = clipped(&row.label, (i32::from(area.width) - x - count).max(0) as usize);
        let end = write(buffer, area, x, y, &label, style);
        let room = i32::from(area.width) - i32::from(width(note));
        write(buffer, area, (end + 1).max(room.min(end + 2)), y, note, color::faint());
        if i == at && state.cursor.focus == Pane::Tree {
            cursor = Some(Position::new(area.x + (x as u16).min(area.width.saturating_sub(1)), area.y + y));
        }
    }
    cursor
}
