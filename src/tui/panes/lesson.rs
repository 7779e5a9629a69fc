//! The lesson of the tutor, below everything else. It is always visible, even on the smallest terminal.

use crate::tui::layout::lesson;
use crate::tui::layout::lesson::LABELS;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::widgets::{Block, Clear, Widget};

use super::write;
use crate::tui::keys::Keymap;
use crate::tui::state::tutor::Tutor;
use crate::tui::text::color;
use crate::tui::text::wrap::width;
use crate::tui::tutor::lessons::LESSONS;

/// Draws the lesson.
pub fn draw(tutor: &Tutor, keymap: &Keymap, screen: Rect, buffer: &mut Buffer) {
    let rows = lesson::rows(tutor, keymap, screen);
    let area = Rect { y: screen.bottom() - rows, height: rows, ..screen };
    Clear.render(area, buffer);
    let on = crate::tui::tutor::lesson(tutor);
    let title = format!(" lesson {} of {}: {} ", tutor.at + 1, LESSONS.len(), on.title);
    let block = Block::bordered().title(title).title_bottom(" :tutor next | back | quit ").title_style(color::strong());
    let inner = block.inner(area);
    block.render(area, buffer);
    for (y, line) in lesson::text(tutor, screen.width).iter().enumerate() {
        write(buffer, inner, 1, y as u16, line, Style::new());
    }
    let keys = lesson::keys(tutor, keymap, screen.width);
    let top = inner.height.saturating_sub(keys.len() as u16);
    write(buffer, inner, 1, top, "press", color::faint());
    for (y, row) in keys.iter().enumerate() {
        let mut x = i32::from(LABELS);
        for label in row {
            write(buffer, inner, x, top + y as u16, label, color::strong());
            x += i32::from(width(label)) + 2;
        }
    }
}
