//! The document: a scene is a value, and so is an edit.

pub mod address;
pub mod build;
pub mod check;
mod clip;
pub mod compared;
pub mod complete;
mod document;
pub mod edit;
pub mod field;
mod follow;
pub mod grips;
pub mod history;
pub mod insert;
pub mod json;
pub mod json_schema;
pub mod layout;
pub mod merge;
pub mod migrate;
mod model;
mod muted;
pub mod named;
pub mod presets;
mod references;
pub mod schema;
mod shape;
pub mod shots;
pub mod sight;
mod start;
pub mod styles;
pub mod transform;
pub mod words;

pub use clip::Clip;
pub use document::Document;
pub use edit::Edit;
pub use history::History;
pub use model::{FRAME, Image, Mesh, Scene, VERSION};
pub use shape::expected;
pub use start::{Known, Looks, Start};

#[cfg(test)]
mod tests;
