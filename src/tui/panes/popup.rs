//! What covers the panes: lists to choose from, pages of text, hints after the first key of several.

use crate::tui::commands::contexts::contexts;
use crate::tui::panes::window;
use crate::tui::text::plain;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use ratatui::widgets::{Block, Clear, Widget};

use super::write;
use crate::tui::document::choice::{Choice, Then};
use crate::tui::layout::first_row;
use crate::tui::state::{Mode, Pages, State};
use crate::tui::text::color;
use crate::tui::text::wrap::{hanging, width, wrapped_lines};

/// Draws what is open; returns the place of the cursor.
pub fn draw(state: &State, screen: Rect, buffer: &mut Buffer) -> Option<Position> {
    match &state.typing.mode {
        Mode::Choice(choice) => Some(draw_choice(choice, screen, buffer)),
        Mode::Pages(pages) => Some(draw_pages(pages, &state.memory.sought_in_pages, screen, buffer)),
        Mode::Line(line) => {
            // What is searched in stays in sight.
            match state.memory.under.last() {
                Some(Mode::Pages(pages)) => _ = draw_pages(pages, &state.memory.sought_in_pages, screen, buffer),
                Some(Mode::Choice(choice)) => {
                    let narrowed = choice.narrowed(line.text.value().trim());
                    draw_choice(narrowed.as_ref().unwrap_or(choice), screen, buffer);
                }
                Some(Mode::Normal | Mode::Entry(_) | Mode::Line(_) | Mode::Palette(_) | Mode::Aim) | None => {}
            }
            None
        }
        Mode::Palette(palette) => Some(super::palette::draw(state, palette, screen, buffer)),
        Mode::Normal | Mode::Entry(_) | Mode::Aim => {
            if !state.typing.pressed.is_empty() {
                draw_hints(state, screen, buffer);
            }
            None
        }
    }
}

fn draw_choice(choice: &Choice, screen: Rect, buffer: &mut Buffer) -> Position {
    let text: &[String] = if let Then::Answer(question) = &choice.then { &question.text } else { &[] };
    let text = text.join("\n");
    let words = choice.options.iter().map(|(word, _)| width(word)).max().unwrap_or(0);
    let help = choice.options.iter().map(|(_, help)| width(help)).max().unwrap_or(0);
    let title = plain(&choice.title);
    let above = text.lines().map(width).max().unwrap_or(0).max(width(&title));
    let wide = (words + help + 6).max(above + 4).clamp(30, screen.width - 8);
    let text = wrapped_lines(&text, wide - 4);
    // Help that does not fit is shown in full below the list, for the row under the cursor.
    let room = wide.saturating_sub(words + 6);
    let told = choice.options.iter().map(|(_, help)| width(help)).filter(|&help| help > room);
    let longest = told.max().map_or(0, |help| help.div_ceil((wide - 4).max(1)) + 2);
    let below_ = longest.min(screen.height / 3);
    let tall = (choice.options.len() as u16 + text.len() as u16 + 2 + below_).min(screen.height - 4);
    let area = window(screen, wide, tall, &title, buffer);
    let (area, foot) = (Rect { height: area.height - below_.min(area.height), ..area }, area);
    if let Some((_, help)) = choice.options.get(choice.at).filter(|_| below_ > 0) {
        for (y, line) in
            wrapped_lines(help, foot.width.saturating_sub(2)).iter().take(usize::from(below_) - 1).enumerate()
        {
            write(buffer, foot, 1, area.height + 1 + y as u16, line, Style::new());
        }
    }
    for (y, line) in text.iter().enumerate() {
        write(buffer, area, 1, y as u16, line, Style::new());
    }
    let area = below(area, text.len() as u16);
    let first = first_row(choice.at, choice.options.len(), area.height);
    for (y, (i, (word, help))) in
        choice.options.iter().enumerate().skip(first).take(usize::from(area.height)).enumerate()
    {
        let style = if i == choice.at { color::focus() } else { Style::new() };
        write(buffer, area, 1, y as u16, &plain(word), style);
        write(buffer, area, i32::from(words) + 3, y as u16, &shortened(help, room), color::faint());
    }
    Position::new(area.x + 1, area.y + (choice.at - first) as u16)
}

/// A text cut to this width, with an ellipsis.
fn shortened(text: &str, room: u16) -> String {
    if width(text) <= room {
        return text.to_owned();
    }
    let mut short = String::new();
    for c in text.chars() {
        if width(&short) + 2 > room {
            break;
        }
        short.push(c);
    }
    short + "…"
}

/// An area without its first rows.
fn below(area: Rect, rows: u16) -> Rect {
    let rows = rows.min(area.height);
    Rect { y: area.y + rows, height: area.height - rows, ..area }
}

fn draw_pages(pages: &Pages, sought: &str, screen: Rect, buffer: &mut Buffer) -> Position {
    let title = format!("{} (j k scroll, / searches, q closes)", pages.title);
    let widest = pages.lines.iter().map(|line| width(line)).max().unwrap_or(0).max(width(&title));
    let wide = (widest + 6).clamp(40, screen.width - 6);
    let rows = |line: &String| hanging(line, wide - 3);
    let most = usize::from(screen.height - 4);
    let all: usize = pages.lines.iter().take(most).map(|line| rows(line).len()).sum();
    let area = window(screen, wide, (all + 2).clamp(5, most) as u16, &title, buffer);
    // Scrolling ends when the last lines fill the page.
    let mut room = usize::from(area.height);
    let fits = |line: &&String| {
        let left = room.checked_sub(rows(line).len());
        room = left.unwrap_or(0);
        left.is_some()
    };
    let last = pages.lines.len().saturating_sub(pages.lines.iter().rev().take_while(fits).count().max(1));
    let shown = pages.lines.iter().skip(pages.scroll.min(last)).flat_map(|line| {
        let style = match line.starts_with("--") {
            _ if !sought.is_empty() && line.to_lowercase().contains(sought) => color::focus(),
            true => color::strong(),
            false => Style::new(),
        };
        rows(line).into_iter().map(move |row| (row, style))
    });
    for (y, (row, style)) in shown.take(usize::from(area.height)).enumerate() {
        write(buffer, area, 1, y as u16, &row, style);
    }
    area.as_position()
}

/// The names of the menus behind first keys.
const MENUS: &[(&str, &str)] = &[
    ("Space", "leader"),
    ("g", "go"),
    ("z", "view"),
    ("m", "set a mark"),
    ("\"", "a register"),
    ("'", "go to a mark"),
];

/// Draws the keys that may follow, above the status line, in as many columns as they need.
fn draw_hints(state: &State, screen: Rect, buffer: &mut Buffer) {
    let contexts = contexts(state);
    let rest = |key: &str| key.strip_prefix(&state.typing.pressed).unwrap_or(key).trim().to_owned();
    let rows: Vec<_> = state.keymap.continuations(&contexts, &state.typing.pressed).collect();
    let keys = rows.iter().map(|row| width(&rest(&row.key))).max().unwrap_or(0);
    let wide = keys + rows.iter().map(|row| width(&row.help)).max().unwrap_or(0) + 4;
    let most = usize::from(screen.height.saturating_sub(6)).max(1);
    let columns = rows.len().div_ceil(most).max(1);
    let tall = rows.len().div_ceil(columns);
    let whole = (wide * columns as u16 + 2).min(screen.width);
    let area = Rect {
        x: screen.right().saturating_sub(whole + 1),
        y: screen.bottom().saturating_sub(tall as u16 + 4),
        width: whole,
        height: (tall as u16 + 2).min(screen.height),
    };
    Clear.render(area, buffer);
    let menu = MENUS.iter().find(|(key, _)| *key == state.typing.pressed).map(|(_, name)| format!(": {name}"));
    let block = Block::bordered().title(format!(" {}{} ", state.typing.pressed, menu.unwrap_or_default()));
    let inner = block.inner(area);
    block.render(area, buffer);
    let each = inner.width / columns as u16;
    for (i, row) in rows.iter().enumerate() {
        let column = Rect { x: inner.x + each * (i / tall) as u16, width: each, ..inner };
        let y = (i % tall) as u16;
        write(buffer, column, 1, y, &rest(&row.key), color::strong());
        write(buffer, column, i32::from(keys) + 3, y, &row.help, Style::new());
    }
}
