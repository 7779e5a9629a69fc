//! What is kept from one session to the next: the lines that were typed after `:`, macros, registers, and for each scene the
//! marks, the collapsed nodes, the cursor, what is muted, solo or locked, and which overlays are shown. Places come back as lines, and a register is written into the log when it is used,
//! so that the log of a session leads to the same scene without what was kept.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::State;
use super::cursor::Pane;
use super::finding::Spot;
use super::memory::{Memory, Yanked};
use crate::scene::{address, json};
use crate::tui::document::sheet::Sheet;

/// The most lines that are kept.
const MOST_LINES: usize = 500;
/// The most bytes of a register that are kept.
const MOST_REGISTER: u64 = 64 << 10;
/// The most scenes whose places are kept, those that were left last.
const MOST_SCENES: usize = 100;

#[derive(Default, Serialize, Deserialize)]
#[serde(default)]
struct Kept {
    lines: Vec<String>,
    macros: BTreeMap<char, Vec<String>>,
    registers: BTreeMap<char, Yanked>,
    /// The lines that lead to the places of a scene, by its path, the latest last.
    scenes: Vec<(String, Vec<String>)>,
}

impl Kept {
    fn of(kept: Value) -> Kept {
        serde_json::from_value(kept).unwrap_or_default()
    }
}

impl Memory {
    /// Takes what an earlier session has kept.
    pub fn recall(&mut self, kept: Value) {
        let kept = Kept::of(kept);
        self.lines = kept.lines;
        self.recorder.recall(kept.macros);
        self.recalled = kept.registers;
    }

    /// What the next session may have, over what others have kept meanwhile.
    pub fn keep(&self, before: Value) -> Value {
        let mut kept = Kept::of(before);
        kept.lines.retain(|line| !self.lines.contains(line));
        kept.lines.extend(self.lines.iter().cloned());
        kept.lines.drain(..kept.lines.len().saturating_sub(MOST_LINES));
        kept.macros.extend(self.recorder.macros().clone());
        let small = |(_, yanked): &(&char, &Yanked)| json::bytes(&yanked.value) <= MOST_REGISTER;
        let registers = self.registers.iter().filter(small);
        kept.registers.extend(registers.map(|(letter, yanked)| (*letter, yanked.clone())));
        serde_json::to_value(kept).unwrap_or_default()
    }
}

/// The lines that lead to where an earlier session has left the scene at `path`.
pub fn places(kept: Value, path: &Path) -> Vec<String> {
    let path = path.to_string_lossy();
    Kept::of(kept).scenes.into_iter().find(|(own, _)| *own == path).map(|(_, lines)| lines).unwrap_or_default()
}

/// What is kept, with the places of a scene that is left.
pub fn keep_places(state: &State, before: Value, path: &Path) -> Value {
    let mut kept = Kept::of(before);
    let path = path.to_string_lossy().into_owned();
    kept.scenes.retain(|(own, _)| *own != path);
    kept.scenes.push((path, lines_to(state)));
    kept.scenes.drain(..kept.scenes.len().saturating_sub(MOST_SCENES));
    serde_json::to_value(kept).unwrap_or_default()
}

/// The lines that lead to the marks, the collapsed nodes, the cursor, what is muted, solo or locked in this scene, and the overlays
/// that are shown.
fn lines_to(state: &State) -> Vec<String> {
    let address = |pointer: &str| address::address(state.document(), pointer);
    let way = |spot: &Spot| {
        let row = Sheet::of(state.document(), &spot.node).position(&spot.row).unwrap_or(0);
        let pane = match spot.focus {
            Pane::Tree => "tree",
            Pane::Table => "table",
            Pane::Picture => "picture",
        };
        // Rows are counted in the table.
        let rows = ["pane table".into(), format!("{row} move first"), format!("{} move right", spot.column)];
        let rows = rows.into_iter().take(if spot.focus == Pane::Tree { 0 } else { 3 });
        let node = format!("go {}", address(&spot.node));
        std::iter::once(node.trim_end().to_owned()).chain(rows).chain([format!("pane {pane}")]).collect::<Vec<_>>()
    };
    let mark = |(letter, spot): (char, &Spot)| [way(spot), vec![format!("mark {letter}")]].concat();
    let marks = state.memory.finding.marks().flat_map(mark);
    let folds = state.cursor.collapsed.iter().map(|node| format!("collapse {}", address(node)));
    let apart = &state.apart;
    let apart = [("mute", &apart.muted), ("solo", &apart.solo), ("lock", &apart.locked)].into_iter();
    let apart = apart.flat_map(|(name, set)| set.iter().map(move |pointer| format!("{name} {}", address(pointer))));
    // What is off in the picture is off in windows too, if it is one of theirs.
    let off = state.picture.off.iter().map(|name| format!("{name} off"));
    let views: BTreeSet<String> = off.chain(state.picture.switches.changed()).collect();
    let views = views.into_iter().map(|command| format!("view {command}"));
    let lines = marks.chain(way(&state.spot())).chain(folds).chain(apart).chain(views);
    lines.filter(|line| !line.contains(char::is_control)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::commands::obey;
    use crate::tui::tests::support::{at, press, said_last, state};
    use serde_json::{Value, json};

    #[test]
    fn lines_and_macros_are_kept_and_joined_with_those_of_others() {
        let mut first = state();
        press(&mut first, ": \"get title\" Enter q a j q");
        let kept = first.memory.keep(json!({ "lines": ["w", "get title"], "macros": { "b": ["undo"] }, "odd": 1 }));
        let expected = json!({ "lines": ["w", "get title"], "macros": { "a": ["move down"], "b": ["undo"] } });
        assert_eq!((&kept["lines"], &kept["macros"]), (&expected["lines"], &expected["macros"]));
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
        let nothing = json!({ "lines": [], "macros": {}, "registers": {}, "scenes": [] });
        assert_eq!(state().memory.keep(Value::Null), nothing);
    }

    #[test]
    fn a_register_of_an_earlier_session_is_pasted_and_comes_into_the_log() {
        let mut first = state();
        press(&mut first, "/ \"motion\" Enter Enter j : \"register c\" Enter y");
        assert!(said_last(&first).1.ends_with("yanked into register c"), "{:?}", said_last(&first));
        let mut next = state();
        next.memory.recall(first.memory.keep(Value::Null));
        assert!(next.memory.recorder.log().is_empty());
        press(&mut next, "/ \"motion\" Enter Enter : \"register c\" Enter p");
        let motion = "/layers/0/zones/0/motion";
        assert_eq!(at(&next, &format!("{motion}/1")), at(&first, &format!("{motion}/1")));
        assert_eq!(at(&next, motion).as_array().map(Vec::len), Some(5));
        let again = crate::tui::tests::support::replayed(&next);
        assert_eq!(again.document().json(), next.document().json());
    }

    #[test]
    fn overlays_come_back_here_and_in_windows() {
        let mut first = state();
        press(&mut first, "z v z o z o z t");
        let path = Path::new("/a/scene.plica.json");
        let lines = places(keep_places(&first, Value::Null, path), path);
        let mut next = state();
        for line in &lines {
            obey(&mut next, line, None).unwrap_or_else(|why| panic!("{line}: {why}"));
        }
        assert_eq!(next.picture.switches, first.picture.switches);
        assert_eq!(next.picture.off, first.picture.off);
        let views: Vec<&str> = lines.iter().filter_map(|line| line.strip_prefix("view ")).collect();
        assert_eq!(views, ["view-checkerboard off", "view-field on", "view-outlines off"]);
    }

    #[test]
    fn marks_folds_and_the_cursor_come_back_by_lines() {
        let mut first = state();
        press(
            &mut first,
            "/ \"motion\" Enter Enter j m b G m c g t k h h h j j h : \"go layers.face.zones.mouth\" Enter",
        );
        let path = Path::new("/a/scene.plica.json");
        let kept = keep_places(&first, Value::Null, path);
        let mut next = state();
        for line in places(kept.clone(), path) {
            obey(&mut next, &line, None).unwrap_or_else(|why| panic!("{line}: {why}"));
        }
        assert_eq!((next.focused(), next.cursor.focus), (first.focused(), first.cursor.focus));
        assert_eq!(next.cursor.collapsed, first.cursor.collapsed);
        press(&mut next, "' b");
        assert_eq!(next.focused(), "/layers/0/zones/0/motion/1");
        press(&mut next, "' c");
        assert_eq!(next.focused(), "/layers/0/zones/0/motion/3");
        assert!(places(kept, Path::new("/a/other.plica.json")).is_empty());
        let mut many = Value::Null;
        for i in 0..MOST_SCENES + 5 {
            many = keep_places(&first, many, Path::new(&format!("/{i}")));
        }
        assert!(places(many.clone(), Path::new("/4")).is_empty() && !places(many, Path::new("/5")).is_empty());
    }
}
