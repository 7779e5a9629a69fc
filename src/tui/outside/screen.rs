//! The loop of the editor on a screen: events in, a drawing out.

use super::editor::Editor;
use super::pace;
use crate::base::error::{Error, Result};
use crate::preview::editor::Status;
use crate::tui::events::Event;
use crate::tui::graphics::{self, Protocol};
use crate::tui::layout::picture;
use crate::tui::panes::view;
use crate::tui::state::play::Stopwatch;
use std::io::Write;
use std::path::PathBuf;
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// How soon to check whether a terminal that did not read does so again: after as long as it has not, within these.
const BEHIND: [Duration; 2] = [Duration::from_millis(1), Duration::from_millis(20)];

impl Editor {
    /// Edits until the person leaves; returns the folder of the tutor, if it was open.
    ///
    /// # Errors
    /// The terminal cannot be drawn on, or a signal ended it.
    pub fn run_on_screen(mut self, events: &mpsc::Receiver<Event>) -> Result<Option<PathBuf>> {
        let mut watch = Stopwatch::default();
        while !self.leaving {
            self.throttle.request(&self.state).into_iter().for_each(|request| self.worker.ask(request));
            self.draw()?;
            self.wait(events, &mut watch);
        }
        if let (Protocol::Kitty, Some(screen)) = (picture::protocol(&self.state), &mut self.screen) {
            // A terminal that has gone away has nothing to forget.
            let _ = screen.backend_mut().write_all(graphics::forget().as_bytes());
        }
        self.drain();
        self.end();
        self.ended()?;
        Ok(self.options.tutor)
    }

    fn draw(&mut self) -> Result<()> {
        let (state, kept, Some(screen)) = (&self.state, &mut self.kept, &mut self.screen) else { return Ok(()) };
        let failed = |e| Error::at("the terminal", e);
        if pace::is_behind() {
            Write::flush(screen.backend_mut()).map_err(failed)?;
            if pace::is_behind() {
                return Ok(());
            }
        }
        if let Some(begun) = self.drawn.take() {
            self.throttle.wrote(state, begun.elapsed(), pace::given());
        }
        let begun = Instant::now();
        screen.draw(|frame| view::draw(frame, state, kept)).map_err(failed)?;
        self.state.drawn();
        let state = &self.state;
        match pace::is_behind() {
            true => self.drawn = Some(begun),
            false => self.throttle.wrote(state, begun.elapsed(), pace::given()),
        }
        Ok(())
    }

    /// Waits for an event and handles all that have arrived, so that many of them cost only one drawing.
    fn wait(&mut self, events: &mpsc::Receiver<Event>, watch: &mut Stopwatch) {
        let script_goes_on = self.scripts_go_on();
        let patience = match self.state.play.playing {
            _ if script_goes_on => Duration::ZERO,
            _ if pace::is_behind() => self.drawn.map_or(BEHIND[1], |begun| begun.elapsed().clamp(BEHIND[0], BEHIND[1])),
            true => Duration::from_millis(33),
            false => self.throttle.patience(self.state.scene.patience()),
        };
        self.state.scene.tend();
        let first = events.recv_timeout(patience).ok();
        for event in first.into_iter().chain(events.try_iter()) {
            self.take(event);
        }
        self.run_scripts();
        self.see_window();
        let passed = watch.lap(self.state.play.playing, Instant::now());
        if self.state.play.playing {
            self.take(Event::Tick(passed));
        }
    }

    /// Updates the window's state in the status line. If there is no window, a message says why, once.
    fn see_window(&mut self) {
        let seen = match self.preview.status() {
            // Windows belong to the editor that edits the scene.
            _ if self.state.scene.held_by().is_some() => String::new(),
            Status::Off => String::new(),
            status => format!("window: {status}"),
        };
        if seen != self.window_told {
            // Remove the last message about the window, which is outdated.
            self.state.message.take_if(|message| message.text == self.window_told);
            self.window_told.clone_from(&seen);
            if !matches!(self.preview.status(), Status::Connected { .. }) {
                // The window that it is of has gone.
                self.state.outside.camera = None;
            }
            let off = matches!(self.preview.status(), Status::OffBecause(_));
            if off {
                self.state.complain(seen.clone());
            }
            self.state.outside.window = if off { "window: off".into() } else { seen };
        }
    }
}
