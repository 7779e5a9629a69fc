//! Plica animates still pictures from the keyboard: folding textures, meshes, strokes, view maps and
//! waterfalls, edited as numbers in a terminal.
//!
//! # Code map
//!
//! A module names only what stands to its left (tests/house/ enforces the rule):
//!
//! base < layers < scene < files < render < export < preview < ops < tui < cli < main

pub mod base;
pub mod cli;
pub mod export;
pub mod files;
pub mod layers;
pub mod ops;
pub mod preview;
pub mod render;
pub mod scene;
#[cfg(feature = "tui")]
pub mod tui;
