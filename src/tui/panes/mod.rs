//! The panes. Each draws one part of the state into its area, and returns the place of the terminal's cursor if it is there.

use crate::tui::text::plain;
use crate::tui::text::wrap::{clipped, width};
use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Position, Rect};
use ratatui::style::Style;
use ratatui::widgets::{Block, Clear, Widget};

use super::text::color;
use super::text::input::Text;
use crate::base::maths;

mod braille;
mod columns;
pub mod detail;
pub mod field;
mod hints;
pub mod lesson;
pub mod line;
pub mod marks;
pub mod palette;
pub mod picture;
pub mod popup;
pub mod position;
pub mod probe;
pub mod sketch;
pub mod status;
pub mod table;
pub mod tree;
pub mod view;

/// Writes `text` at column `x` of a row of `area`, which may be left of it or beyond, and clips it. Returns the column after
/// the text.
pub fn write(buffer: &mut Buffer, area: Rect, x: i32, y: u16, text: &str, style: Style) -> i32 {
    let end = x + i32::from(width(text));
    if y >= area.height || x >= i32::from(area.width) || end <= 0 {
        return end;
    }
    let skipped: String = text.chars().skip((-x).max(0) as usize).collect();
    let from = x.max(0) as u16;
    let room = usize::from(area.width - from);
    buffer.set_stringn(area.x + from, area.y + y, clipped(&skipped, room), room, style);
    end
}

/// Writes a text that is being typed so that its cursor is visible, with marks where it is cut; returns the cursor's place.
pub fn typed(buffer: &mut Buffer, area: Rect, text: &Text, style: Style) -> Position {
    let shown = plain(text.value());
    let (column, room) = (text.column(), usize::from(area.width));
    let hidden = (column + 1).saturating_sub(room);
    if hidden == 0 && usize::from(width(&shown)) <= room {
        write(buffer, area, 0, 0, &shown, style);
    } else {
        let mut at = 0;
        let within = shown.chars().filter(|c| {
            let from = at;
            at += usize::from(width(c.encode_utf8(&mut [0; 4])));
            from >= hidden
        });
        buffer.set_stringn(area.x, area.y, within.collect::<String>(), room, style);
        if hidden > 0 && column > hidden {
            write(buffer, area, 0, 0, "<", color::faint());
        }
        if usize::from(width(&shown)).saturating_sub(hidden) > room && column + 1 < hidden + room {
            write(buffer, area, room as i32 - 1, 0, ">", color::faint());
        }
    }
    Position::new(area.x + column.saturating_sub(hidden) as u16, area.y)
}

/// The nearest of eight arrows for the direction of a vector.
pub fn arrow(vector: kurbo::Vec2) -> &'static str {
    const ARROWS: [&str; 8] = ["→", "↗", "↑", "↖", "←", "↙", "↓", "↘"];
    let degrees = maths::atan2(0.0 - vector.y, vector.x).to_degrees();
    ARROWS[(degrees / 45.0).round().rem_euclid(8.0) as usize]
}

/// Clears a rectangle in the middle of the screen and frames it.
pub fn window(screen: Rect, width: u16, height: u16, title: &str, buffer: &mut Buffer) -> Rect {
    let area =
        screen.centered(Constraint::Length(width.min(screen.width)), Constraint::Length(height.min(screen.height)));
    Clear.render(area, buffer);
    let block = Block::bordered().title(format!(" {title} "));
    let inner = block.inner(area);
    block.render(area, buffer);
    inner
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_clipped_on_both_sides() {
        let area = Rect::new(1, 0, 4, 1);
        let mut buffer = Buffer::empty(Rect::new(0, 0, 8, 1));
        assert_eq!(write(&mut buffer, area, -2, 0, "abcdefgh", Style::new()), 6);
        write(&mut buffer, area, 0, 5, "below", Style::new());
        let text: String = buffer.content().iter().map(|cell| cell.symbol()).collect();
        assert_eq!(text, " cde…   ");
    }
}
