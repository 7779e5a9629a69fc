//! What leaves the program: animations, textures for engines, plots. Codecs live here and in `files`.

pub mod animation;
pub mod field;
mod icc;
pub mod still;
pub mod textures;
