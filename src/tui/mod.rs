//! The terminal editor, in rungs: each folder names only what stands above it in this list (tests/house.rs holds that).
//! State is a value and `update` a function (commands/update.rs); drawing changes nothing (panes/view.rs); one table of keys
//! and one of commands (keys/table.rs, commands/); whatever is slow or outside happens in outside/.

mod commands;
mod document;
mod events;
mod graphics;
mod keys;
mod layout;
mod outside;
mod panes;
mod state;
mod text;
mod tutor;

pub use commands::manual::manual;
pub use commands::own_keys::read as keymap;
pub use events::Change;
pub use keys::Keymap;
pub use outside::offscreen::Offscreen;
pub use outside::options::Options;
pub use outside::runner::run;

#[cfg(test)]
mod tests;
