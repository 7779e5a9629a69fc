//! Facts about numbers, pictures and meshes. Knows no scene.

pub mod budget;
pub mod chains;
pub mod change;
pub mod clip;
pub mod color;
pub mod crossings;
pub mod error;
pub mod expression;
pub mod fault;
pub mod geometry;
pub mod keys;
pub mod mask;
pub mod maths;
pub mod mesh;
pub mod number;
pub mod numbered;
pub mod oklab;
pub mod picture;
pub mod pixels;
pub mod pointer;
pub mod problem;
pub mod progress;
pub mod quantise;
pub mod reduce;
pub mod system;
pub mod text;
