//! Text: numbers, colors, lines being typed; nothing of a scene.

pub mod clipboard;
pub mod colour;
pub mod input;
pub mod line;
pub mod numbers;
