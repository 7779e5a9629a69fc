//! The terminal editor. State is a value and `update` a function (app.rs); drawing changes nothing (view.rs); one table of
//! keys and one of commands (keys/table.rs, commands/); whatever is slow or outside happens in runner.rs and worker.rs.

mod app;
mod choice;
mod clipboard;
mod colour;
mod commands;
mod door;
mod effects;
mod entry;
mod finding;
mod graphics;
mod image_editor;
mod input;
mod keys;
mod life;
mod line;
mod lines;
mod numbers;
mod offscreen;
mod pace;
mod palette;
mod panes;
mod place;
mod places;
mod recorder;
mod rows;
mod runner;
mod script;
mod seeing;
mod sheet;
mod sight;
mod terminal;
mod text;
mod transport;
mod tree;
mod tutor;
mod update;
mod view;
mod worker;

pub use keys::{Keymap, manual};
pub use offscreen::Offscreen;
pub use runner::{Options, run};
pub use update::Change;

#[cfg(test)]
mod tests;
