//! Where the cursor can be.

/// A pane that can have the focus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pane {
    /// The tree of the scene.
    Tree,
    /// The form or table.
    Table,
    /// The picture.
    Picture,
}
