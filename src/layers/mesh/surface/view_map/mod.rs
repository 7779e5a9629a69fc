//! View maps (Grimm and Kowalski 2002): pictures laid on the surface, each with its camera. Some make up the base coat,
//! some are seen only near where they were taken from. They are mixed once, on the surface, in cells of several sizes.

pub mod check;
pub mod model;
