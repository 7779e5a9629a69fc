//! The editor without a terminal: keys in, a drawn screen out. The benchmarks press keys through it.

use std::path::Path;

use ratatui::Terminal;
use ratatui::backend::TestBackend;

use crate::base::error::{Error, Result};
use crate::files::session::Mode;
use crate::files::{self};
use crate::tui::commands::update::update;
use crate::tui::document::open_scene::OpenScene;
use crate::tui::events::{Effect, Event, Published};
use crate::tui::panes::marks::Kept;
use crate::tui::panes::view;
use crate::tui::state::State;
use crate::tui::text::color::Depth;

/// A scene that is open on a screen in memory, without synthesis and windows.
pub struct Offscreen {
    state: State,
    terminal: Terminal<TestBackend>,
    kept: Kept,
}

impl Offscreen {
    /// Opens the scene at `path` on a screen of `width` x `height` cells.
    ///
    /// # Errors
    /// The scene cannot be read, or somebody else is editing it.
    pub fn open(path: &Path, (width, height): (u16, u16)) -> Result<Offscreen> {
        let scene = OpenScene::open(path, Mode::Edit, &files::Options::default())?;
        let terminal =
            Terminal::new(TestBackend::new(width, height)).map_err(|error| Error::at("the screen", error))?;
        Ok(Offscreen { state: State::new(scene, (width, height), Depth::True), terminal, kept: Kept::default() })
    }

    /// Presses a key, by its name in the table, and draws the screen.
    ///
    /// # Errors
    /// The screen cannot be drawn.
    pub fn press(&mut self, key: &str) -> Result<()> {
        self.take(key);
        self.draw()
    }

    /// Presses a key without drawing; returns the changes of the scene that are sent to windows.
    pub fn take(&mut self, key: &str) -> Vec<Published> {
        let effects = update(&mut self.state, Event::Key(key.to_owned()));
        let change = |effect| if let Effect::Publish(change) = effect { Some(*change) } else { None };
        effects.into_iter().filter_map(change).collect()
    }

    /// Draws the screen.
    ///
    /// # Errors
    /// The screen cannot be drawn.
    pub fn draw(&mut self) -> Result<()> {
        let Offscreen { state, terminal, kept } = self;
        terminal.draw(|frame| view::draw(frame, state, kept)).map(drop).map_err(|error| Error::at("the screen", error))
    }

    /// The text on the screen, one line per row.
    pub fn text(&self) -> String {
        let buffer = self.terminal.backend().buffer();
        let rows = buffer.content().chunks(usize::from(buffer.area.width).max(1));
        let line = |row: &[ratatui::buffer::Cell]| row.iter().map(|cell| cell.symbol()).collect::<String>();
        rows.map(|row| line(row).trim_end().to_owned() + "\n").collect()
    }
}
