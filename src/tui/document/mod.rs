//! Views of a document: its nodes as rows and as a tree, its places, tables as text, and the open scene with its file.

pub mod cell;
pub mod choice;
pub mod csv;
pub mod derived;
pub mod entry;
pub mod open_scene;
pub mod palette;
pub mod places;
pub mod pointers;
pub mod rows;
pub mod sheet;
pub mod tree;
