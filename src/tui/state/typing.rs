//! What the next key means: the mode, and what has been pressed so far.

use crate::tui::document::choice::Choice;
use crate::tui::document::entry::Entry;
use crate::tui::document::palette::Palette;
use crate::tui::text::line::Line;

/// What the next key means.
#[derive(Debug)]
pub struct Typing {
    /// The mode.
    pub mode: Mode,
    /// The count typed so far.
    pub count: Option<usize>,
    /// The keys of an unfinished binding.
    pub pressed: String,
    /// The power of ten that `+` and `-` step by.
    pub step: i32,
}

impl Default for Typing {
    fn default() -> Self {
        Typing { mode: Mode::Normal, count: None, pressed: String::new(), step: 0 }
    }
}

/// The mode.
#[derive(Clone, Debug)]
pub enum Mode {
    /// Keys run commands.
    Normal,
    /// A value is being typed into a cell.
    Entry(Entry),
    /// A command or a search is being typed.
    Line(Line),
    /// Something is being chosen from a list.
    Choice(Choice),
    /// A text is shown: the help, or what a command printed.
    Pages(Pages),
    /// The palette is open.
    Palette(Palette),
    /// The picture's cursor sets a jump vector.
    Aim,
}

impl Mode {
    /// Whether something is being typed or chosen, so that a line with the answer will follow.
    pub fn asks(&self) -> bool {
        matches!(self, Mode::Entry(_) | Mode::Choice(_) | Mode::Line(_))
    }
}

/// A text of several lines.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pages {
    /// Its title.
    pub title: String,
    /// Its lines.
    pub lines: Vec<String>,
    /// The first line shown.
    pub scroll: usize,
}
