//! What a key means: the rows of the one table (table.rs), looked up by context from the innermost out: a pane, then everywhere.

use ratatui::crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use crate::base::keys::KeyRow;

mod table;
pub use table::{AIM, ENTRY, EVERYWHERE, HELP, KEYS, LINE, LIST, NUMBER, PICTURE, RECORDING, TABLE, TREE, TYPING};

/// Stands in a row for any letter from a to z.
const LETTER: &str = "{a-z}";

/// What the keys pressed so far mean.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Found {
    /// This line is to be run.
    Line(String),
    /// The beginning of several.
    Prefix,
    /// Nothing.
    Nothing,
}

/// Looks the keys pressed up in the contexts, the innermost first.
pub fn find(contexts: &[&str], pressed: &str) -> Found {
    for context in contexts {
        let mut rows = KEYS.iter().filter(|row| row.context == *context);
        if let Some(line) = rows.clone().find_map(|row| line(row, pressed)) {
            return Found::Line(line);
        }
        if rows.any(|row| continues(row, pressed)) {
            return Found::Prefix;
        }
    }
    Found::Nothing
}

/// The line that a row runs where the keys pressed are its own. A key `{a-z}` at the end stands for any letter, and in the
/// line for the one that was pressed.
fn line(row: &KeyRow, pressed: &str) -> Option<String> {
    if row.key == pressed {
        return Some(row.command.to_owned());
    }
    let letter = pressed.strip_prefix(row.key.strip_suffix(LETTER)?)?;
    let one = letter.len() == 1 && letter.starts_with(|c: char| c.is_ascii_lowercase());
    one.then(|| row.command.replace(LETTER, letter))
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
        "# Keys of the editor\n\nMade from the table in `src/tui/keys/table.rs`; a test holds the two together. A number before a key is a \
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
        assert_eq!(find(&contexts, "J"), Found::Line("cursor 0 10".into()));
        assert_eq!(find(&contexts, "u"), Found::Line("undo".into()));
        assert_eq!(find(&contexts, "g"), Found::Prefix);
        assert_eq!(find(&contexts, "Q"), Found::Nothing);
        assert!(continuations(&contexts, "g").any(|row| row.key == "g p"));
    }

    #[test]
    fn a_row_may_take_any_letter() {
        let row = KeyRow { context: TREE, key: "q {a-z}", command: "record {a-z}", help: "Record" };
        for (pressed, expected) in
            [("q a", Some("record a")), ("q z", Some("record z")), ("q A", None), ("q", None), ("q Esc", None)]
        {
            assert_eq!(line(&row, pressed).as_deref(), expected, "{pressed}");
        }
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
