//! Text: numbers, colors, lines being typed. Nothing here knows of a scene.

pub mod clipboard;
pub mod color;
pub mod input;
mod plain;
pub mod said;
pub mod wrap;
pub use plain::plain;
pub mod line;
pub mod numbers;
