//! The picture in the terminal: as pixels if the terminal has a protocol for them, else in half-blocks, and always within a
//! limit of bytes, so that a slow link stays usable. Everything here runs on the worker thread.

pub mod clip;
pub mod counts;
mod diacritics;
mod encode;
mod ink;
mod picture;
pub mod probed;
mod protocol;
pub mod request;
mod sixel;
pub mod viewport;

pub use encode::forget;
pub use picture::TerminalPicture;
pub use protocol::{Graphics, Marks, Protocol, Wanted};
