//! What the next key means: the mode, and what has been pressed so far.

use crate::tui::document::choice::Choice;
use crate::tui::document::entry::Entry;
use crate::tui::document::palette::Palette;
use crate::tui::text::line::Line;

/// What the next key means.
#[derive(Debug)]
pub struct Typing {
    /// What is going on.
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

/// What is going on.
#[derive(Clone, Debug)]
pub enum Mode {
    /// Keys are commands.
    Normal,
    /// A value is being typed into a cell.
    Entry(Entry),
    /// A command or a search is being typed.
    Line(Line),
    /// Something is being chosen from a list.
    Choice(Choice),
    /// A text is shown: the help, or what a command printed.
    Pages(Pages),
    /// Something is looked for among everything that can be run or gone to.
    Palette(Palette),
    /// The picture's cursor sets a jump vector.
    Aim,
}

impl Mode {
    /// Whether something is being typed or chosen: a line that answers follows.
    pub fn asks(&self) -> bool {
        matches!(self, Mode::Entry(_) | Mode::Choice(_) | Mode::Line(_))
    }
}

/// A text that is longer than a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pages {
    /// What it is.
    pub title: String,
    /// Its lines.
    pub lines: Vec<String>,
    /// The first line shown.
    pub scroll: usize,
}
