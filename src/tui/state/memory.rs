//! What is remembered of what was done and said before.

use std::collections::VecDeque;

use serde_json::Value;

use super::finding::Finding;
use super::recorder::Recorder;
use crate::tui::document::entry::Entry;

/// Messages that are remembered.
const MOST_SAID: usize = 200;

/// What is remembered of what was done and said before.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    /// What was said, the newest last.
    pub said: VecDeque<Message>,
    /// Lines typed after `:`, the newest last.
    pub lines: Vec<String>,
    /// Who listens to the lines that are run.
    pub recorder: Recorder,
    /// What was yanked last.
    pub yanked: Option<Yanked>,
    /// What was being typed when the help was opened over it.
    pub entry: Option<Entry>,
    /// Marks, the jump list and the search.
    pub finding: Finding,
}

impl Memory {
    /// Remembers a message, for `:messages`.
    pub fn hear(&mut self, message: Message) {
        if self.said.len() >= MOST_SAID {
            self.said.pop_front();
        }
        self.said.push_back(message);
    }
}

/// A line for the person.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// What is said.
    pub text: String,
    /// Whether something could not be done.
    pub bad: bool,
}

/// What `p` pastes.
#[derive(Clone, Debug, PartialEq)]
pub struct Yanked {
    /// A value, or several as a list.
    pub value: Value,
    /// The name that it had in a map.
    pub name: Option<String>,
}
