//! Folding textures (Thorben 2012; Ren, TU Delft 2023): every pixel of a zone owns a sampler that moves along a jump path
//! through the picture as time passes; thresholds along the path let one part slide over another.

pub mod anchors;
pub mod atlas;
pub mod breaks;
pub mod check;
pub mod counts;
pub mod field;
pub mod fold;
pub mod frame;
pub mod interpolation;
pub mod kinds;
pub mod mask;
pub mod model;
pub mod outline;
pub mod position;
pub mod probe;
pub mod reduce;
pub mod regions;
pub mod reread;
pub mod seam;
pub mod starts;
pub mod synth;
pub mod texels;
pub mod tools;

#[cfg(test)]
mod tests;
