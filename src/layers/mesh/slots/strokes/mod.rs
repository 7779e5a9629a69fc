//! Strokes that a mesh is drawn with (after Benard, Lagae et al. 2010, "A Dynamic Noise Primitive for Coherent
//! Stylization"): a sum of many small waves whose centers are fixed to the surface while their size, spacing and direction
//! are those of the screen; and what is drawn from that noise and the tones of the surface. What the mesh layer shows comes from
//! it and goes back drawn (`slot.rs`).

pub mod aim;
pub mod bins;
pub mod check;
pub mod curvature;
pub mod curves;
pub mod draw;
pub mod emit;
pub mod even;
pub mod explain;
pub mod flat;
pub mod force;
pub mod grid;
pub mod impulse;
pub mod ink;
pub mod level;
pub mod marks;
pub mod measure;
pub mod model;
pub mod noise;
pub mod overlays;
pub mod passes;
pub mod pieces;
pub mod plan;
pub mod restyle;
pub mod rim;
pub mod shown;
pub mod sketch;
pub mod slot;
pub mod styles;
pub mod sum;
pub mod surface;
pub mod synth;
#[cfg(test)]
mod tests;
pub mod tone;
pub mod upload;
pub mod visible;
