//! The terminal editor, in rungs: each folder names only what stands above it in this list (tests/house/ enforces it).
//! The state is a value and `update` a function of it (commands/update.rs); drawing changes nothing (panes/view.rs). There is
//! one table of keys and one of commands (keys/table.rs, commands/). Whatever is slow or touches the system is in outside/.

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
pub use events::Published;
pub use keys::Keymap;
pub use outside::offscreen::Offscreen;
pub use outside::options::Options;
pub use outside::runner::run;

#[cfg(test)]
mod tests;
