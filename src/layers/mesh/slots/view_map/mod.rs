//! View maps (Grimm and Kowalski 2002): pictures laid on the surface, each with its camera. Some make up the base coat,
//! some are seen only near where they were taken from. They are mixed once, on the surface, in cells of several sizes.

pub mod again;
pub mod arrays;
pub mod atlas;
pub mod balance;
pub mod blend;
pub mod bundle;
pub mod camera;
pub mod cells;
pub mod check;
pub mod coat;
pub mod compare;
pub mod entries;
pub mod frames;
pub mod gauge;
pub mod id;
pub mod lay;
pub mod lists;
pub mod looked;
pub mod map;
pub mod marks;
pub mod mix;
pub mod mixer;
pub mod model;
pub mod paint;
pub mod painted;
pub mod passes;
pub mod plan;
pub mod probe;
pub mod ready;
pub mod report;
pub mod round;
pub mod sample;
pub mod slot;
#[cfg(test)]
mod tests;
pub mod told;
pub mod upload;
pub mod view;
pub mod wanted;
pub mod warnings;
