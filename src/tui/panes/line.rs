//! The last line: what is being typed after `:` or `/`, else the message. A message that is longer than the line covers the
//! panes with as many rows as it needs, until the next key.

use crate::tui::text::plain;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::widgets::{Clear, Widget};

use super::{hints, typed, write};
use crate::scene::address;
use crate::tui::state::{Mode, State};
use crate::tui::text::color;
use crate::tui::text::wrap::{width, wrapped_lines};

/// Draws the line; the cursor is in what is being typed.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    if let Mode::Line(line) = &state.typing.mode {
        write(buffer, area, 0, 0, &line.kind.to_string(), Style::new());
        let cursor = typed(
            buffer,
            Rect { x: area.x + 1, width: area.width.saturating_sub(1), ..area },
            &line.text,
            Style::new(),
        );
        let end = 1 + i32::from(width(&plain(line.text.value())));
        if let Some((offered, at)) = line.offered() {
            draw_offered(offered, at, area, end + 2, buffer);
        }
        return Some(cursor);
    }
    let Some(message) = &state.message else {
        if let Some(problem) = &state.outside.problem {
            let problem = plain(&address::of_problem(state.document(), problem).to_string());
            let more = if width(&problem) + 2 > area.width { " … (:problems) " } else { "" };
            write(buffer, area, 1, 0, &problem, color::faint());
            write(buffer, area, i32::from(area.width) - i32::from(width(more)), 0, more, color::faint());
        } else {
            hints::draw(state, area, buffer);
        }
        return None;
    };
    let style = match message.bad {
        true => state.depth.ink(Style::new().add_modifier(Modifier::BOLD), Color::Red),
        false => Style::new(),
    };
    let lines = wrapped_lines(&message.text, area.width.saturating_sub(2));
    let rows = (lines.len() as u16).min(area.bottom() / 2).max(1);
    let area = Rect { y: area.bottom().saturating_sub(rows), height: rows, ..area };
    if rows > 1 {
        Clear.render(area, buffer);
    }
    for (y, line) in lines.iter().take(usize::from(rows)).enumerate() {
        write(buffer, area, 1, y as u16, line, style);
    }
    if lines.len() > usize::from(rows) {
        let more = " … (:messages) ";
        write(buffer, area, i32::from(area.width) - i32::from(width(more)), rows - 1, more, color::faint());
    }
    None
}

fn draw_offered(offered: &[String], at: usize, area: Rect, mut x: i32, buffer: &mut Buffer) {
    if offered.is_empty() {
        write(buffer, area, x, 0, "(nothing to complete)", color::faint());
    }
    for (i, word) in offered.iter().enumerate().skip(at.saturating_sub(2)) {
        if x + i32::from(width(word)) > i32::from(area.width) {
            break;
        }
        let style = if i == at { color::focus() } else { color::faint() };
        x = write(buffer, area, x, 0, &plain(word), style) + 2;
    }
}
