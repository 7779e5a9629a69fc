//! Facts about numbers and pictures. Knows no scene.

pub mod error;
pub mod geometry;
pub mod maths;
pub mod pixels;
pub mod problem;
