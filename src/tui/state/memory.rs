//! What the editor remembers: messages, lines, yanked values, marks.

use std::collections::VecDeque;

use serde_json::Value;

use super::finding::Finding;
use super::recorder::Recorder;
use super::typing::Mode;

/// The most messages that are remembered.
const MOST_SAID: usize = 200;

/// What the editor remembers of what was done and said before.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    /// Messages, the newest last.
    pub said: VecDeque<Message>,
    /// Lines typed after `:`, the newest last.
    pub lines: Vec<String>,
    /// The log, macros and the last change.
    pub recorder: Recorder,
    /// What was yanked last.
    pub yanked: Option<Yanked>,
    /// What comes back when the help or the command line is closed that was opened over it: an entry, or aiming.
    pub under: Option<Mode>,
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

/// A message to the person.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// Its text.
    pub text: String,
    /// Whether it says that something could not be done.
    pub bad: bool,
}

/// What `p` pastes.
#[derive(Clone, Debug, PartialEq)]
pub struct Yanked {
    /// A value, or several as a list.
    pub value: Value,
    /// Its name, if it was an entry of a map.
    pub name: Option<String>,
}
