//! Where things stand on the screen.

pub mod seeing;
