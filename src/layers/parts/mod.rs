//! The data that techniques and the rest of the program exchange. Names no technique, and nothing of what shows or
//! draws.

pub mod album;
pub mod bundle;
pub mod derived;
pub mod goal;
pub mod marks;
pub mod materials;
pub mod measures;
pub mod moment;
pub mod moving;
pub mod pass;
pub mod picking;
pub mod plan;
pub mod readout;
pub mod repeat;
pub mod shots;
pub mod sketch;
pub mod twin;
pub mod vectors;
