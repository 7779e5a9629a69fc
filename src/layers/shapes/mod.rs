//! Paths of the scene, which belong to no layer: what they are in the document ([`shape`], [`node`]), and what is made of
//! them for any technique ([`joined`], [`handles`]).

pub mod handles;
pub mod joined;
pub mod node;
pub mod shape;
