//! The terminal's events as the editor's own: keys by their names in the table, pastes, clicks, sizes.

use std::sync::mpsc;

use ratatui::crossterm::event::{self, Event as Input, KeyEventKind, MouseEventKind};

use super::keys;
use super::update::Event;

/// Reads the terminal for as long as there is one.
pub fn read(sender: mpsc::Sender<Event>) {
    std::thread::spawn(move || {
        while let Ok(input) = event::read() {
            let events = match input {
                Input::Key(key) if key.kind != KeyEventKind::Release => keys::name(key).map(Event::Key),
                Input::Paste(text) => Some(Event::Paste(text)),
                Input::Resize(width, height) => Some(Event::Resize(width, height)),
                Input::Mouse(mouse) => match mouse.kind {
                    MouseEventKind::ScrollDown => Some(Event::Key("Down".into())),
                    MouseEventKind::ScrollUp => Some(Event::Key("Up".into())),
                    MouseEventKind::Down(_) => Some(Event::Click(mouse.column, mouse.row)),
                    _ => None,
                },
                _ => None,
            };
            if events.is_some_and(|event| sender.send(event).is_err()) {
                return;
            }
        }
        // The terminal is gone; the signal thread usually notices first.
        let _ = sender.send(Event::End);
    });
}
