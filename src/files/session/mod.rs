//! A scene being edited: all edits at run time go through here. Document, history, journal and file change together, no
//! matter where the edit comes from: a key, a command, a script, `plica set`.

mod journaling;
mod keeping;
mod open;
mod outside;
#[cfg(test)]
mod tests;

pub use journaling::left_behind;
pub use open::{Mode, Overwrite, Recovery, Safety, Session};
pub use outside::Taken;
