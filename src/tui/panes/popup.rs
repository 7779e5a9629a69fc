//! What lies over the panes: lists to choose from, pages of text, hints after the first key of several.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use ratatui::widgets::{Block, Clear, Widget};

use super::{first_row, width, write};
use crate::tui::app::{Mode, Pages, State};
use crate::tui::choice::{Choice, Then};
use crate::tui::{colour, terminal, view};

/// Draws what there is; the cursor is in the list.
pub fn draw(state: &State, screen: Rect, buffer: &mut Buffer) -> Option<Position> {
    match &state.mode {
        Mode::Choice(choice) => Some(draw_choice(choice, screen, buffer)),
        Mode::Pages(pages) => Some(draw_pages(pages, screen, buffer)),
        _ if !state.pressed.is_empty() => {
            draw_hints(state, screen, buffer);
            None
        }
        _ => None,
    }
}

fn draw_choice(choice: &Choice, screen: Rect, buffer: &mut Buffer) -> Position {
    let text: &[String] = if let Then::Answer(question) = &choice.then { &question.text } else { &[] };
    let words = choice.options.iter().map(|(word, _)| width(word)).max().unwrap_or(0);
    let help = choice.options.iter().map(|(_, help)| width(help)).max().unwrap_or(0);
    let title = terminal::plain(&choice.title);
    let above = text.iter().map(|line| width(line)).max().unwrap_or(0).max(width(&title));
    let wide = (words + help + 6).max(above + 4).clamp(30, screen.width - 8);
    let tall = (choice.options.len() as u16 + text.len() as u16 + 2).min(screen.height - 4);
    let area = view::window(screen, wide, tall, &title, buffer);
    for (y, line) in text.iter().enumerate() {
        write(buffer, area, 1, y as u16, line, Style::new());
    }
    let area = below(area, text.len() as u16);
    let first = first_row(choice.at, choice.options.len(), area.height);
    for (y, (i, (word, help))) in
        choice.options.iter().enumerate().skip(first).take(usize::from(area.height)).enumerate()
    {
        let style = if i == choice.at { colour::focus() } else { Style::new() };
        write(buffer, area, 1, y as u16, &terminal::plain(word), style);
        write(buffer, area, i32::from(words) + 3, y as u16, help, colour::faint());
    }
    Position::new(area.x + 1, area.y + (choice.at - first) as u16)
}

/// What is left of an area below its first rows.
fn below(area: Rect, rows: u16) -> Rect {
    let rows = rows.min(area.height);
    Rect { y: area.y + rows, height: area.height - rows, ..area }
}

fn draw_pages(pages: &Pages, screen: Rect, buffer: &mut Buffer) -> Position {
    let title = format!("{} (j k scroll, q closes)", pages.title);
    let widest = pages.lines.iter().map(|line| width(line)).max().unwrap_or(0).max(width(&title));
    let wide = (widest + 6).clamp(40, screen.width - 6);
    let tall = (pages.lines.len().min(1000) as u16 + 2).clamp(5, screen.height - 4);
    let area = view::window(screen, wide, tall, &title, buffer);
    let last = pages.lines.len().saturating_sub(usize::from(area.height));
    for (y, line) in pages.lines.iter().skip(pages.scroll.min(last)).take(usize::from(area.height)).enumerate() {
        let style = if line.starts_with("--") { colour::strong() } else { Style::new() };
        write(buffer, area, 1, y as u16, line, style);
    }
    area.as_position()
}

/// The keys that may follow, above the status line.
fn draw_hints(state: &State, screen: Rect, buffer: &mut Buffer) {
    let contexts = state.contexts();
    let rows: Vec<_> = state.keymap.continuations(&contexts, &state.pressed).collect();
    let tall = rows.len() as u16 + 2;
    let column =
        rows.iter().map(|row| width(&row.key) + 1).max().unwrap_or(0).saturating_sub(width(&state.pressed)).max(4);
    let wide = rows.iter().map(|row| width(&row.help)).max().unwrap_or(0) + column + 8;
    let area = Rect {
        x: screen.right().saturating_sub(wide + 1),
        y: screen.bottom().saturating_sub(tall + 2),
        width: wide.min(screen.width),
        height: tall.min(screen.height),
    };
    Clear.render(area, buffer);
    let block = Block::bordered().title(format!(" {} ", state.pressed));
    let inner = block.inner(area);
    block.render(area, buffer);
    for (y, row) in rows.iter().enumerate() {
        let key = row.key.strip_prefix(&state.pressed).unwrap_or(&row.key);
        write(buffer, inner, 0, y as u16, key, colour::strong());
        write(buffer, inner, i32::from(column), y as u16, &row.help, Style::new());
    }
}
