//! What crosses the border of a technique: plain data. Names no technique and nothing of what shows or draws.

pub mod bundle;
pub mod marks;
pub mod materials;
pub mod moment;
pub mod passes;
pub mod readout;
pub mod repeat;
