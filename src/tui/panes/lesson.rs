//! The lesson that is on, below everything else: always in sight, also on the least terminal.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::widgets::{Block, Clear, Widget};

use super::{width, write};
use crate::tui::app::State;
use crate::tui::colour;
use crate::tui::keys::Keymap;
use crate::tui::tutor::Tutor;
use crate::tui::tutor::lessons::LESSONS;

/// Rows that a lesson takes, its frame included: three lines of text and the keys.
const ROWS: u16 = 6;

/// What is left of the screen for everything else.
pub fn above(state: &State, screen: Rect) -> Rect {
    let rows = if state.tutor.is_some() { ROWS.min(screen.height) } else { 0 };
    Rect { height: screen.height - rows, ..screen }
}

/// Draws it.
pub fn draw(tutor: &Tutor, keymap: &Keymap, screen: Rect, buffer: &mut Buffer) {
    let rows = ROWS.min(screen.height);
    let area = Rect { y: screen.bottom() - rows, height: rows, ..screen };
    Clear.render(area, buffer);
    let lesson = tutor.lesson();
    let title = format!(" lesson {} of {}: {} ", tutor.at + 1, LESSONS.len(), lesson.title);
    let block =
        Block::bordered().title(title).title_bottom(" :tutor next | back | quit ").title_style(colour::strong());
    let inner = block.inner(area);
    block.render(area, buffer);
    for (y, line) in lesson.text.iter().enumerate() {
        write(buffer, inner, 1, y as u16, line, Style::new());
    }
    let mut x = 1;
    let y = inner.height.saturating_sub(1);
    write(buffer, inner, x, y, "press", colour::faint());
    x += 7;
    for label in lesson.keys.iter().map(|press| press.label(keymap)) {
        write(buffer, inner, x, y, &label, colour::strong());
        x += i32::from(width(&label)) + 2;
    }
}
