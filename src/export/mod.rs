//! What leaves the program: animations, textures for engines, plots. Codecs live here and in `files`.

pub mod album;
pub mod animation;
pub mod field;
mod floats;
mod icc;
pub mod numbered;
pub mod passes;
pub mod still;
pub mod textures;
