//! The picture in the terminal: as pixels where the terminal has a protocol for them, else in half-blocks; always within a
//! bound of bytes, so that a slow link stays usable. Everything here runs on the worker thread.

mod diacritics;
mod encode;
mod ink;
pub mod probed;
mod protocol;
mod shown;
pub mod sight;
mod sixel;

pub use encode::forget;
pub use protocol::{Graphics, Marks, Protocol, Wanted};
pub use shown::Shown;
