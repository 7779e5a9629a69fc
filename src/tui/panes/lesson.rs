//! The lesson that is on, below everything else: always in sight, also on the least terminal.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::widgets::{Block, Clear, Widget};

use super::{width, wrapped, write};
use crate::tui::keys::Keymap;
use crate::tui::state::State;
use crate::tui::text::colour;
use crate::tui::tutor::Tutor;
use crate::tui::tutor::lessons::LESSONS;

/// Columns that the lines of a lesson have at most as they are; on less they are wrapped.
const WIDE: u16 = 76;
/// Rows of the text where it is not wrapped, so that nothing moves from lesson to lesson.
const ROWS: usize = 3;

/// What is left of the screen for everything else.
pub fn above(state: &State, screen: Rect) -> Rect {
    let rows = state.tutor.as_ref().map_or(0, |tutor| rows(tutor, &state.keymap, screen));
    Rect { height: screen.height - rows, ..screen }
}

/// Rows that a lesson takes: its text, its keys and the frame.
fn rows(tutor: &Tutor, keymap: &Keymap, screen: Rect) -> u16 {
    let lines = text(tutor, screen.width).len() + keys(tutor, keymap, screen.width).len() + 2;
    (lines as u16).min(screen.height)
}

/// The lines of the lesson.
fn text(tutor: &Tutor, width: u16) -> Vec<String> {
    let room = width.saturating_sub(4);
    let lines = tutor.lesson().text.iter();
    if room >= WIDE {
        let mut lines: Vec<String> = lines.map(|line| (*line).to_owned()).collect();
        lines.resize(ROWS.max(lines.len()), String::new());
        return lines;
    }
    wrapped(&lines.copied().collect::<Vec<_>>().join(" "), room)
}

/// The keys of the lesson in rows that fit.
fn keys(tutor: &Tutor, keymap: &Keymap, wide: u16) -> Vec<Vec<String>> {
    let mut rows = vec![Vec::new()];
    let mut x = LABELS;
    for label in tutor.lesson().keys.iter().map(|press| press.label(keymap)) {
        if x + width(&label) > wide.saturating_sub(2) && x > LABELS {
            rows.push(Vec::new());
            x = LABELS;
        }
        x += width(&label) + 2;
        rows.last_mut().into_iter().for_each(|row| row.push(label.clone()));
    }
    rows
}

/// Where the keys begin.
const LABELS: u16 = 8;

/// Draws it.
pub fn draw(tutor: &Tutor, keymap: &Keymap, screen: Rect, buffer: &mut Buffer) {
    let rows = rows(tutor, keymap, screen);
    let area = Rect { y: screen.bottom() - rows, height: rows, ..screen };
    Clear.render(area, buffer);
    let lesson = tutor.lesson();
    let title = format!(" lesson {} of {}: {} ", tutor.at + 1, LESSONS.len(), lesson.title);
    let block =
        Block::bordered().title(title).title_bottom(" :tutor next | back | quit ").title_style(colour::strong());
    let inner = block.inner(area);
    block.render(area, buffer);
    for (y, line) in text(tutor, screen.width).iter().enumerate() {
        write(buffer, inner, 1, y as u16, line, Style::new());
    }
    let keys = keys(tutor, keymap, screen.width);
    let top = inner.height.saturating_sub(keys.len() as u16);
    write(buffer, inner, 1, top, "press", colour::faint());
    for (y, row) in keys.iter().enumerate() {
        let mut x = i32::from(LABELS);
        for label in row {
            write(buffer, inner, x, top + y as u16, label, colour::strong());
            x += i32::from(width(label)) + 2;
        }
    }
}
