//! What is kept from one session to the next: the lines that were typed after `:`, and macros. Nothing of it changes what a
//! line does, so that the log of a session leads to the same scene without it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::memory::Memory;

/// The most lines that are kept.
const MOST_LINES: usize = 500;

#[derive(Default, Serialize, Deserialize)]
#[serde(default)]
struct Kept {
    lines: Vec<String>,
    macros: BTreeMap<char, Vec<String>>,
}

impl Memory {
    /// Takes what an earlier session has kept.
    pub fn recall(&mut self, kept: Value) {
        let kept: Kept = serde_json::from_value(kept).unwrap_or_default();
        self.lines = kept.lines;
        self.recorder.recall(kept.macros);
    }

    /// What the next session may have, over what others have kept meanwhile.
    pub fn keep(&self, before: Value) -> Value {
        let mut kept: Kept = serde_json::from_value(before).unwrap_or_default();
        kept.lines.retain(|line| !self.lines.contains(line));
        kept.lines.extend(self.lines.iter().cloned());
        kept.lines.drain(..kept.lines.len().saturating_sub(MOST_LINES));
        kept.macros.extend(self.recorder.macros().clone());
        serde_json::to_value(kept).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use crate::tui::tests::support::{press, state};
    use serde_json::{Value, json};

    #[test]
    fn lines_and_macros_are_kept_and_joined_with_those_of_others() {
        let mut first = state();
        press(&mut first, ": \"get title\" Enter q a j q");
        let kept = first.memory.keep(json!({ "lines": ["w", "get title"], "macros": { "b": ["undo"] }, "odd": 1 }));
        assert_eq!(kept, json!({ "lines": ["w", "get title"], "macros": { "a": ["move down"], "b": ["undo"] } }));
        let mut next = state();
        next.memory.recall(kept);
        press(&mut next, ": Up");
        let line = format!("{:?}", next.typing.mode);
        assert!(line.contains("get title"), "{line}");
        press(&mut next, "Esc @ a");
        assert!(!next.message.as_ref().is_some_and(|message| message.bad), "{:?}", next.message);
        // What is no longer readable is nothing.
        next.memory.recall(json!({ "lines": 5 }));
        assert!(next.memory.lines.is_empty());
        assert_eq!(state().memory.keep(Value::Null), json!({ "lines": [], "macros": {} }));
    }
}
