//! What is outside the editor's state: terminal, threads, files and windows.

pub mod ask;
pub mod editor;
pub mod effects;
pub mod image_editor;
pub mod input;
pub mod job;
pub mod lines;
pub mod offscreen;
pub mod options;
pub mod pace;
mod paint;
mod pipe;
pub mod runner;
pub mod screen;
pub mod script;
pub mod scripts;
pub mod terminal;
pub mod throttle;
pub mod worker;
