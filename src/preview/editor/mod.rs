//! The editor's side of the link: serves windows and scripts, and keeps the window's process alive.

mod display;
mod events;
pub(super) mod host;
pub(super) mod keeper;
pub(super) mod outbox;
mod preview;
pub mod script;
mod status;

pub use display::{has_display, opens_by_itself, way_home};
pub use events::{Asked, Event, Silent};
pub use preview::Preview;
pub use status::Status;
