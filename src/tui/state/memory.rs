//! What the editor remembers: messages, lines, yanked values, marks.

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::finding::Finding;
use super::recorder::Recorder;
use super::typing::Mode;
use crate::base::pointer::{Pointer, index};

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
    /// States of the history that were kept, by their letters.
    pub snapshots: BTreeMap<char, usize>,
    /// The state from which a snapshot was flipped to last.
    pub flipped_from: Option<usize>,
    /// What was yanked last.
    pub yanked: Option<Yanked>,
    /// What was yanked into registers, by their letters.
    pub registers: BTreeMap<char, Yanked>,
    /// The registers of earlier sessions that were not used in this one.
    pub recalled: BTreeMap<char, Yanked>,
    /// The register that the next yank or paste is about.
    pub register: Option<char>,
    /// What comes back when the help or the command line is closed that was opened over it: an entry, aiming, or pages; the
    /// innermost last.
    pub under: Vec<Mode>,
    /// Marks, the jump list and the search.
    pub finding: Finding,
    /// Which columns are shown.
    pub columns: Columns,
    /// What was searched for in pages of text.
    pub sought_in_pages: String,
}

/// Which columns of which tables are shown.
#[derive(Clone, Debug, Default)]
pub struct Columns {
    chosen: BTreeMap<String, Arc<[String]>>,
    frozen: BTreeMap<String, usize>,
}

/// Lists at the same place of different layers and zones have the same columns.
fn alike(node: &str) -> String {
    let step = |token: String| if index(&token).is_some() { "*".to_owned() } else { token };
    Pointer(node).tokens().map(step).collect::<Vec<_>>().join("/")
}

impl Columns {
    /// The columns of the table at `node`, in order; all if there are none.
    pub fn of(&self, node: &str) -> Arc<[String]> {
        if self.chosen.is_empty() { Arc::default() } else { self.chosen.get(&alike(node)).cloned().unwrap_or_default() }
    }

    /// How many columns of the table at `node` stay where they are while the others move.
    pub fn frozen(&self, node: &str) -> usize {
        self.frozen.get(&alike(node)).copied().unwrap_or(1)
    }

    /// Shows these columns of the table at `node`; all if there are none.
    pub fn choose(&mut self, node: &str, columns: Vec<String>) {
        self.chosen.insert(alike(node), columns.into());
    }

    /// Lets so many columns of the table at `node` stay.
    pub fn freeze(&mut self, node: &str, count: usize) {
        self.frozen.insert(alike(node), count);
    }
}

impl Memory {
    /// Remembers what is yanked, in the register that was named, too.
    pub fn yank(&mut self, yanked: Yanked) {
        if let Some(letter) = self.register.take() {
            self.registers.insert(letter, yanked.clone());
        }
        self.yanked = Some(yanked);
    }

    /// What is pasted: that of the register that was named, else what was yanked last.
    ///
    /// # Errors
    /// There is nothing.
    pub fn taken(&mut self) -> Result<Yanked, String> {
        match self.register.take() {
            Some(letter) => self.registers.get(&letter).cloned().ok_or_else(|| format!("register {letter} is empty")),
            None => self.yanked.clone().ok_or_else(|| "nothing has been yanked yet: y yanks".into()),
        }
    }

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
    /// Whether keys that go on leave it: it tells how something ended that ran beside them.
    pub stays: bool,
    /// Whether it has been on the screen.
    pub seen: bool,
}

impl Message {
    /// A message about what was asked for just now.
    pub fn new(text: impl Into<String>, bad: bool) -> Message {
        Message { text: here(&text.into()), bad, stays: false, seen: false }
    }
}

/// What commands and checks say, without that a line is one of the editor, where it is said.
pub fn here(text: &str) -> String {
    text.replace("in the editor :", ":")
}

/// What `p` pastes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Yanked {
    /// A value, or several as a list.
    pub value: Value,
    /// Its name, if it was an entry of a map.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}
