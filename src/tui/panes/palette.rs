//! The palette: what is typed, and the rows that match it with their keys, values and help.

use crate::tui::panes::window;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Modifier, Style};

use super::{typed, write};
use crate::scene::field;
use crate::tui::document::cell;
use crate::tui::document::palette::{Palette, Row};
use crate::tui::layout::first_row;
use crate::tui::state::State;
use crate::tui::text::color;
use crate::tui::text::wrap::{clipped, width};

/// Width of the column that says what a row is.
const SORT: i32 = 9;

/// Draws the palette; the cursor is in what is typed.
pub fn draw(state: &State, palette: &Palette, screen: Rect, buffer: &mut Buffer) -> Position {
    let title = format!("palette: {} found (Enter takes, Esc closes)", palette.len());
    let area = window(screen, (screen.width - 8).min(110), (screen.height - 4).min(30), &title, buffer);
    write(buffer, area, 0, 0, ">", color::strong());
    let line = Rect { x: area.x + 2, width: area.width.saturating_sub(2), ..area };
    let cursor = typed(buffer, line, &palette.text, Style::new());
    let body = Rect { y: area.y + 1, height: area.height.saturating_sub(3), ..area };
    let first = first_row(palette.at, palette.len(), body.height);
    for y in 0..body.height {
        let index = first + usize::from(y);
        let Some(row) = palette.row(index) else { break };
        draw_row(state, palette, &row, index == palette.at, body, y, buffer);
    }
    if let Some(row) = palette.row(palette.at) {
        let place = field::field(state.document(), &row.pointer).filter(|_| row.sort != "command");
        let help =
            place.map_or_else(|| format!(":{}", row.line.trim_start_matches("line :")), |field| field.help.into());
        write(buffer, area, 0, area.height.saturating_sub(1), &help, color::faint());
    }
    cursor
}

fn draw_row(state: &State, palette: &Palette, row: &Row, here: bool, area: Rect, y: u16, buffer: &mut Buffer) {
    let style = if here { color::focus() } else { Style::new() };
    let end = match row.sort {
        "command" => row.key.clone(),
        _ => value(state, &row.pointer),
    };
    let room = i32::from(area.width) - i32::from(width(&end)) - 1;
    let text = Rect { x: area.x + SORT as u16, width: (room - SORT - 1).max(0) as u16, ..area };
    write(buffer, area, 0, y, row.sort, color::faint());
    let matched = palette.matched(&row.text);
    let mut x = 0;
    for (i, c) in row.text.chars().enumerate() {
        let hit = matched.binary_search(&(i as u32)).is_ok();
        let style = if hit { style.add_modifier(Modifier::BOLD | Modifier::UNDERLINED) } else { style };
        x = write(buffer, text, x, y, c.encode_utf8(&mut [0; 4]), style);
    }
    write(buffer, area, room.max(0), y, &end, color::faint());
}

/// The value of a field or a node, in short.
fn value(state: &State, pointer: &str) -> String {
    let place = field::field(state.document(), pointer).zip(field::value(state.document(), pointer));
    let text = place.map(|(field, value)| cell::summary(&field, &value)).unwrap_or_default();
    clipped(&text, 24)
}
