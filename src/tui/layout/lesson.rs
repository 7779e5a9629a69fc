//! Lays out the current lesson of the tutor: its lines, its keys, and how many rows it takes.

use crate::tui::tutor;
use ratatui::layout::Rect;

use crate::tui::keys::Keymap;
use crate::tui::state::State;
use crate::tui::state::tutor::Tutor;
use crate::tui::text::wrap::{width, wrapped};

/// Lines of a lesson are at most this wide as written; on a narrower screen they are wrapped.
const WIDE: u16 = 76;

/// Rows of the text if it is not wrapped, so that nothing moves from lesson to lesson.
const ROWS: usize = 3;

/// The column where the keys begin.
pub const LABELS: u16 = 8;

/// What is left of the screen for everything else.
pub fn above(state: &State, screen: Rect) -> Rect {
    let rows = state.tutor.as_ref().map_or(0, |tutor| rows(tutor, &state.keymap, screen));
    Rect { height: screen.height - rows, ..screen }
}

/// Rows that a lesson takes: its text, its keys and the frame.
pub fn rows(tutor: &Tutor, keymap: &Keymap, screen: Rect) -> u16 {
    let lines = text(tutor, screen.width).len() + keys(tutor, keymap, screen.width).len() + 2;
    (lines as u16).min(screen.height)
}

/// The lines of the lesson.
pub fn text(tutor: &Tutor, width: u16) -> Vec<String> {
    let room = width.saturating_sub(4);
    let lines = tutor::lesson(tutor).text.iter();
    if room >= WIDE {
        let mut lines: Vec<String> = lines.map(|line| (*line).to_owned()).collect();
        lines.resize(ROWS.max(lines.len()), String::new());
        return lines;
    }
    wrapped(&lines.copied().collect::<Vec<_>>().join(" "), room)
}

/// The keys of the lesson in rows that fit.
pub fn keys(tutor: &Tutor, keymap: &Keymap, wide: u16) -> Vec<Vec<String>> {
    let mut rows = vec![Vec::new()];
    let mut x = LABELS;
    for label in tutor::lesson(tutor).keys.iter().map(|press| press.label(keymap)) {
        if x + width(&label) > wide.saturating_sub(2) && x > LABELS {
            rows.push(Vec::new());
            x = LABELS;
        }
        x += width(&label) + 2;
        rows.last_mut().into_iter().for_each(|row| row.push(label.clone()));
    }
    rows
}
