//! Unlimited undo and redo: what was ever done to a document (`past.rs`), the tree of its states, and both rebuilt from a
//! journal.

mod past;
mod replay;
mod tree;

pub use past::{Applied, Aside, History, Way};
pub use replay::{Remade, Replay};
pub use tree::{Route, Stamp, Step};
