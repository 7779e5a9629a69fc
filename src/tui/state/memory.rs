//! What is kept from what was done before.

use serde_json::Value;

use crate::tui::document::entry::Entry;

/// What is kept from what was done before.
#[derive(Clone, Debug, Default)]
pub struct Kept {
    /// What was yanked last.
    pub yanked: Option<Yanked>,
    /// What was being typed when the help was opened over it.
    pub entry: Option<Entry>,
    /// The selection that ended last: its node, where it began, where the cursor was.
    pub selection: Option<(String, usize, usize)>,
}

/// What `p` pastes.
#[derive(Clone, Debug, PartialEq)]
pub struct Yanked {
    /// A value, or several as a list.
    pub value: Value,
    /// The name that it had in a map.
    pub name: Option<String>,
}
