//! Columns in the table of a list that follow from the fields of each item, and can be typed all the same: one of the
//! fields is then solved for.

/// A column that follows from the fields of an item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Derived {
    /// Its name in the table.
    pub name: &'static str,
    /// The field of the item that changes when it is typed.
    pub of: &'static str,
    /// The unit of its numbers.
    pub unit: &'static str,
    /// What it is, and what typing it keeps.
    pub help: &'static str,
}
