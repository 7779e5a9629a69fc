//! The one table of keys: from it come the bindings, the help, the hints after a first key, and docs/keys.md. Contexts
//! are looked up from the innermost out: a pane, then everywhere.

use ratatui::crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use crate::base::keys::KeyRow;

/// In every pane, while nothing is being typed.
pub const EVERYWHERE: &str = "everywhere";
/// The tree of the scene.
pub const TREE: &str = "tree";
/// The middle: a form or a table.
pub const TABLE: &str = "form and table";
/// The picture with its placing cursor.
pub const PICTURE: &str = "picture";
/// The picture, while the cursor sets a jump vector.
pub const AIM: &str = "aiming a jump vector";
/// A list to choose from.
pub const LIST: &str = "list of choices";
/// The help.
pub const HELP: &str = "help";
/// Any text being typed.
pub const TYPING: &str = "typing";
/// A value being typed into a cell.
pub const ENTRY: &str = "entry";
/// The command line.
pub const LINE: &str = "command line";

const fn row(context: &'static str, key: &'static str, command: &'static str, help: &'static str) -> KeyRow {
    KeyRow { context, key, command, help }
}

/// Every binding.
pub const KEYS: &[KeyRow] = &[
    row(EVERYWHERE, "?", "help", "Show the keys of this pane, then all others"),
    row(EVERYWHERE, ":", "line", "Type a command"),
    row(EVERYWHERE, "Tab", "pane next", "Go to the next pane"),
    row(EVERYWHERE, "Shift-Tab", "pane previous", "Go to the pane before"),
    row(EVERYWHERE, "Esc", "back", "End the selection, else running work, else go to the tree"),
    row(EVERYWHERE, "Ctrl-c", "leave", "As Esc, and say how to leave"),
    row(EVERYWHERE, "u", "undo", "Undo"),
    row(EVERYWHERE, "Ctrl-r", "redo", "Redo"),
    row(EVERYWHERE, "<", "step-size smaller", "Make the step ten times smaller"),
    row(EVERYWHERE, ">", "step-size larger", "Make the step ten times larger"),
    row(EVERYWHERE, "P", "play", "Play or pause"),
    row(EVERYWHERE, "[", "frame previous", "Go a frame back"),
    row(EVERYWHERE, "]", "frame next", "Go a frame on"),
    row(EVERYWHERE, "{", "frame first", "Go to the first frame"),
    row(EVERYWHERE, "}", "frame last", "Go to the last frame"),
    row(EVERYWHERE, "/", "line /", "Search by name"),
    row(EVERYWHERE, "n", "search next", "Go to the next match"),
    row(EVERYWHERE, "N", "search previous", "Go to the match before"),
    row(EVERYWHERE, "g g", "move first", "Go to the first row"),
    row(EVERYWHERE, "G", "move last", "Go to the last row, or to the row of the count"),
    row(EVERYWHERE, "g p", "probe", "Say what the pixel under the picture's cursor does"),
    row(EVERYWHERE, "g t", "pane tree", "Go to the tree"),
    row(EVERYWHERE, "g e", "pane table", "Go to the form or table"),
    row(EVERYWHERE, "g i", "pane picture", "Go to the picture"),
    row(EVERYWHERE, "z +", "zoom in", "Zoom in, here and in the window"),
    row(EVERYWHERE, "z -", "zoom out", "Zoom out"),
    row(EVERYWHERE, "z f", "zoom fit", "Show the whole picture"),
    row(EVERYWHERE, "z 1", "view zoom-one", "Window: one pixel a pixel"),
    row(EVERYWHERE, "z o", "view view-outlines", "Window: zone outlines"),
    row(EVERYWHERE, "z r", "view view-regions", "Window: fold regions"),
    row(EVERYWHERE, "z a", "view view-anchors", "Window: anchors and their jump vectors"),
    row(EVERYWHERE, "z c", "view view-curves", "Window: curves, lassos and handles"),
    row(EVERYWHERE, "z v", "view view-field", "Window: the vector field"),
    row(EVERYWHERE, "z n", "view view-labels", "Window: names and numbers"),
    row(EVERYWHERE, "z g", "view view-grid", "Window: the pixel grid, when large enough"),
    row(EVERYWHERE, "z s", "view view-still", "Window: the still picture"),
    row(EVERYWHERE, "z t", "view view-checkerboard", "Window: a checkerboard under transparency"),
    row(EVERYWHERE, "Space w", "w", "Save"),
    row(EVERYWHERE, "Space q", "q", "Leave"),
    row(EVERYWHERE, "Space v", "view", "Open the preview window"),
    row(EVERYWHERE, "Space c", "problems", "Say what is wrong in the scene"),
    row(EVERYWHERE, "M", "pointer", "Take the window's pointer into the field, else into the picture's cursor"),
    row(EVERYWHERE, "Ctrl-l", "redraw", "Draw the screen anew"),
    row(EVERYWHERE, "Ctrl-z", "suspend", "Go to the shell (`fg` comes back)"),
    row(TREE, "j", "move down", "Go down"),
    row(TREE, "Down", "move down", "Go down"),
    row(TREE, "k", "move up", "Go up"),
    row(TREE, "Up", "move up", "Go up"),
    row(TREE, "h", "fold", "Fold the node, else go to its parent"),
    row(TREE, "Left", "fold", "Fold the node, else go to its parent"),
    row(TREE, "l", "open", "Unfold the node, else edit it"),
    row(TREE, "Right", "open", "Unfold the node, else edit it"),
    row(TREE, "Enter", "pane table", "Edit the node"),
    row(TREE, "i", "pane table", "Edit the node"),
    row(TREE, "Ctrl-d", "move page-down", "Go half a page down"),
    row(TREE, "Ctrl-u", "move page-up", "Go half a page up"),
    row(TREE, "o", "add", "Add an item to the list, or a node like this one"),
    row(TREE, "d", "delete", "Delete the node"),
    row(TREE, "D", "duplicate", "Duplicate the node"),
    row(TREE, "J", "reorder down", "Move the node down among its siblings"),
    row(TREE, "K", "reorder up", "Move the node up among its siblings"),
    row(TABLE, "j", "move down", "Go down"),
    row(TABLE, "Down", "move down", "Go down"),
    row(TABLE, "k", "move up", "Go up"),
    row(TABLE, "Up", "move up", "Go up"),
    row(TABLE, "h", "move left", "Go left"),
    row(TABLE, "Left", "move left", "Go left"),
    row(TABLE, "l", "move right", "Go right"),
    row(TABLE, "Right", "move right", "Go right"),
    row(TABLE, "Home", "move start", "Go to the first cell of the row"),
    row(TABLE, "End", "move end", "Go to the last cell of the row"),
    row(TABLE, "Ctrl-d", "move page-down", "Go half a page down"),
    row(TABLE, "Ctrl-u", "move page-up", "Go half a page up"),
    row(TABLE, "Enter", "enter", "Edit the cell, or go into the node"),
    row(TABLE, "i", "enter", "Edit the cell, or go into the node"),
    row(TABLE, "c", "enter clear", "Edit the cell from nothing"),
    row(TABLE, "Backspace", "up", "Go to the node that holds this one"),
    row(TABLE, "+", "step 1", "Step the number up"),
    row(TABLE, "-", "step -1", "Step the number down"),
    row(TABLE, "v", "select", "Begin or end a selection of rows; an edit applies to all of them"),
    row(TABLE, "o", "add", "Add an item, or an optional node that is not there"),
    row(TABLE, "d", "delete", "Delete the row or the selection; a field goes back to its default"),
    row(TABLE, "D", "duplicate", "Duplicate the row"),
    row(TABLE, "J", "reorder down", "Move the row down"),
    row(TABLE, "K", "reorder up", "Move the row up"),
    row(PICTURE, "h", "cursor -1 0", "Move the cursor a pixel left"),
    row(PICTURE, "Left", "cursor -1 0", "Move the cursor a pixel left"),
    row(PICTURE, "j", "cursor 0 1", "Move the cursor a pixel down"),
    row(PICTURE, "Down", "cursor 0 1", "Move the cursor a pixel down"),
    row(PICTURE, "k", "cursor 0 -1", "Move the cursor a pixel up"),
    row(PICTURE, "Up", "cursor 0 -1", "Move the cursor a pixel up"),
    row(PICTURE, "l", "cursor 1 0", "Move the cursor a pixel right"),
    row(PICTURE, "Right", "cursor 1 0", "Move the cursor a pixel right"),
    row(PICTURE, "H", "cursor -10 0", "Move the cursor ten pixels left"),
    row(PICTURE, "J", "cursor 0 10", "Move the cursor ten pixels down"),
    row(PICTURE, "K", "cursor 0 -10", "Move the cursor ten pixels up"),
    row(PICTURE, "L", "cursor 10 0", "Move the cursor ten pixels right"),
    row(PICTURE, "a", "place add", "Add a point here to the list in focus"),
    row(PICTURE, "r", "place move", "Move the selected point here"),
    row(PICTURE, "s", "place aim", "Set the selected point's jump vector: move, then Enter"),
    row(PICTURE, "w", "place next", "Select the next point and go there"),
    row(PICTURE, "b", "place previous", "Select the point before and go there"),
    row(PICTURE, "d", "delete", "Delete the selected point"),
    row(PICTURE, "+", "zoom in", "Zoom in"),
    row(PICTURE, "-", "zoom out", "Zoom out"),
    row(PICTURE, "0", "zoom fit", "Show the whole picture"),
    row(PICTURE, "Enter", "probe", "Say what the pixel under the cursor does"),
    row(AIM, "Enter", "place jump", "Let the jump vector end at the cursor"),
    row(AIM, "Esc", "cancel", "Leave the jump vector as it was"),
    row(AIM, "Ctrl-c", "cancel", "Leave the jump vector as it was"),
    row(LIST, "j", "choice next", "Go down"),
    row(LIST, "Down", "choice next", "Go down"),
    row(LIST, "k", "choice previous", "Go up"),
    row(LIST, "Up", "choice previous", "Go up"),
    row(LIST, "Enter", "choice take", "Take it"),
    row(LIST, "Esc", "cancel", "Take nothing"),
    row(LIST, "q", "cancel", "Take nothing"),
    row(LIST, "Ctrl-c", "cancel", "Take nothing"),
    row(HELP, "j", "scroll 1", "Scroll down"),
    row(HELP, "Down", "scroll 1", "Scroll down"),
    row(HELP, "k", "scroll -1", "Scroll up"),
    row(HELP, "Up", "scroll -1", "Scroll up"),
    row(HELP, "Ctrl-d", "scroll 10", "Scroll ten lines down"),
    row(HELP, "Ctrl-u", "scroll -10", "Scroll ten lines up"),
    row(HELP, "g g", "scroll -100000", "Scroll to the top"),
    row(HELP, "G", "scroll 100000", "Scroll to the end"),
    row(HELP, "Esc", "cancel", "Close the help"),
    row(HELP, "q", "cancel", "Close the help"),
    row(HELP, "?", "cancel", "Close the help"),
    row(HELP, "Ctrl-c", "cancel", "Close the help"),
    row(TYPING, "Left", "text left", "Go left"),
    row(TYPING, "Right", "text right", "Go right"),
    row(TYPING, "Home", "text start", "Go to the start"),
    row(TYPING, "Ctrl-a", "text start", "Go to the start"),
    row(TYPING, "End", "text end", "Go to the end"),
    row(TYPING, "Ctrl-e", "text end", "Go to the end"),
    row(TYPING, "Alt-b", "text word-left", "Go a word left"),
    row(TYPING, "Alt-f", "text word-right", "Go a word right"),
    row(TYPING, "Backspace", "text rub", "Delete the character before"),
    row(TYPING, "Delete", "text delete", "Delete the character under the cursor"),
    row(TYPING, "Ctrl-w", "text rub-word", "Delete the word before"),
    row(TYPING, "Ctrl-u", "text clear", "Delete everything"),
    row(TYPING, "Esc", "cancel", "Leave it as it was"),
    row(TYPING, "Ctrl-c", "cancel", "Leave it as it was"),
    row(ENTRY, "Enter", "commit", "Take the value"),
    row(ENTRY, "Tab", "commit next", "Take the value and edit the next cell"),
    row(ENTRY, "Up", "digit 1", "Step the digit under the cursor up"),
    row(ENTRY, "Down", "digit -1", "Step the digit under the cursor down"),
    row(LINE, "Enter", "run", "Run the command"),
    row(LINE, "Tab", "complete", "Complete the word"),
    row(LINE, "Up", "recall older", "Recall an older line"),
    row(LINE, "Down", "recall newer", "Recall a newer line"),
];

/// What the keys pressed so far mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// This row.
    Row(&'static KeyRow),
    /// The beginning of several.
    Prefix,
    /// Nothing.
    Nothing,
}

/// Looks the keys pressed up in the contexts, the innermost first.
pub fn find(contexts: &[&str], pressed: &str) -> Found {
    for context in contexts {
        let mut rows = KEYS.iter().filter(|row| row.context == *context);
        if let Some(row) = rows.clone().find(|row| row.key == pressed) {
            return Found::Row(row);
        }
        if rows.any(|row| continues(row, pressed)) {
            return Found::Prefix;
        }
    }
    Found::Nothing
}

/// The rows that begin with the keys pressed, for the hints.
pub fn continuations<'a>(contexts: &'a [&str], pressed: &'a str) -> impl Iterator<Item = &'static KeyRow> + 'a {
    KEYS.iter().filter(move |row| contexts.contains(&row.context) && continues(row, pressed))
}

fn continues(row: &KeyRow, pressed: &str) -> bool {
    row.key.strip_prefix(pressed).is_some_and(|rest| rest.starts_with(' '))
}

/// The name of a key in the table; `None` where it has none.
pub fn name(event: KeyEvent) -> Option<String> {
    let plain = match event.code {
        KeyCode::Char(' ') => "Space".to_string(),
        KeyCode::Char(c) => c.to_string(),
        KeyCode::Enter => "Enter".into(),
        KeyCode::Esc => "Esc".into(),
        KeyCode::Tab => "Tab".into(),
        KeyCode::BackTab => return Some("Shift-Tab".into()),
        KeyCode::Backspace => "Backspace".into(),
        KeyCode::Delete => "Delete".into(),
        KeyCode::Up => "Up".into(),
        KeyCode::Down => "Down".into(),
        KeyCode::Left => "Left".into(),
        KeyCode::Right => "Right".into(),
        KeyCode::Home => "Home".into(),
        KeyCode::End => "End".into(),
        KeyCode::PageUp => return Some("Ctrl-u".into()),
        KeyCode::PageDown => return Some("Ctrl-d".into()),
        _ => return None,
    };
    let control = event.modifiers.contains(KeyModifiers::CONTROL).then_some("Ctrl-");
    let alt = event.modifiers.contains(KeyModifiers::ALT).then_some("Alt-");
    // Terminals without the newer protocols send Ctrl-h for Backspace and Ctrl-j for Enter.
    match (control, plain.as_str()) {
        (Some(_), "h") => Some("Backspace".into()),
        (Some(_), "j" | "m") => Some("Enter".into()),
        _ => Some(format!("{}{}{plain}", control.unwrap_or_default(), alt.unwrap_or_default())),
    }
}

/// docs/keys.md.
pub fn manual() -> String {
    format!(
        "# Keys of the editor\n\nMade from the table in `src/tui/keys.rs`; a test holds the two together. A number before a key is a \
         count: `5j`.\nIn a pane its own keys come first, then those of \"{EVERYWHERE}\".\n{}",
        crate::base::keys::markdown(KEYS)
    )
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::preview::keys as window;

    #[test]
    fn no_two_bindings_clash() {
        let mut seen = BTreeSet::new();
        for row in KEYS {
            assert!(seen.insert((row.context, row.key)), "{row:?}");
            let hidden = KEYS.iter().any(|other| other.context == row.context && continues(row, other.key));
            assert!(!hidden, "{row:?} can never be reached");
            assert!(row.help.starts_with(char::is_uppercase) && !row.help.ends_with('.'), "{row:?}");
        }
    }

    #[test]
    fn every_binding_is_a_command() {
        for row in KEYS {
            let name = row.command.split(' ').next().unwrap();
            assert!(crate::tui::commands::find(name).is_some(), "{row:?}");
        }
    }

    #[test]
    fn the_window_takes_the_same_keys() {
        for row in window::KEYS {
            let key = match row.context {
                window::PLAY => row.key.to_string(),
                window::VIEW => format!("z {}", row.key),
                _ => continue,
            };
            let own = KEYS.iter().find(|own| own.context == EVERYWHERE && own.key == key);
            assert!(own.is_some(), "{row:?}");
        }
    }

    #[test]
    fn keys_are_found_from_the_inside_out() {
        let contexts = [PICTURE, EVERYWHERE];
        assert!(matches!(find(&contexts, "J"), Found::Row(row) if row.command == "cursor 0 10"));
        assert!(matches!(find(&contexts, "u"), Found::Row(row) if row.command == "undo"));
        assert_eq!(find(&contexts, "g"), Found::Prefix);
        assert_eq!(find(&contexts, "Q"), Found::Nothing);
        assert!(continuations(&contexts, "g").any(|row| row.key == "g p"));
    }

    #[test]
    fn the_manual_is_made_from_the_table() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/keys.md");
        if std::env::var_os("PLICA_UPDATE").is_some() {
            std::fs::write(&path, manual()).unwrap();
        }
        let kept = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(kept == manual(), "docs/keys.md is old: run the tests once with PLICA_UPDATE=1");
    }
}
