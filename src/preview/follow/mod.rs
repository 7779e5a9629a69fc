//! Following a scene as a window does: in the editor that has it open, else in its file. Needs no window and no display.

pub mod client;
pub(super) mod news;
pub(super) mod talk;

pub use news::Update;
