//! Outside: terminal, threads, files and windows.

pub mod ask;
pub mod effects;
pub mod image_editor;
pub mod input;
pub mod lines;
pub mod offscreen;
pub mod pace;
pub mod runner;
pub mod script;
pub mod terminal;
pub mod throttle;
pub mod worker;
