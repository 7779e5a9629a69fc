//! What a key means: the rows of one table (table.rs), overridden by the person's own (keymap.rs). They are looked up by
//! context, the innermost first: a pane, then everywhere.

mod keymap;
mod names;
pub use keymap::{Keymap, contexts};
pub use names::{Meaning, OWN_FILE, name};
mod table;
pub use table::{
    AIM, ENTRY, EVERYWHERE, HELP, KEYS, LINE, LIST, MOVING, NUMBER, PAINTED, PAINTING, PALETTE, PICKABLE, PICKING,
    PICTURE, RECORDING, SELECTING, SMALL, TABLE, TREE, TURNING, TYPING,
};

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::names::{continues, line_of};
    use super::*;
    use crate::preview::keys as window;
    use crate::tui::commands::TABLE;
    use crate::tui::commands::manual::manual;

    #[test]
    fn no_two_bindings_clash() {
        let mut seen = BTreeSet::new();
        for row in KEYS.iter() {
            assert!(seen.insert((row.context, row.key)), "{row:?}");
            let hidden = KEYS.iter().any(|other| other.context == row.context && continues(row.key, other.key));
            assert!(!hidden, "{row:?} can never be reached");
            assert!(row.help.starts_with(char::is_uppercase) && !row.help.ends_with('.'), "{row:?}");
        }
    }

    #[test]
    fn every_binding_is_a_command() {
        for row in KEYS.iter() {
            let name = row.command.split(' ').next().unwrap();
            assert!(TABLE.find(name).is_some(), "{row:?}");
        }
    }

    #[test]
    fn the_window_takes_the_same_keys() {
        for row in window::KEYS.iter() {
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
        let contexts = [PICTURE, TURNING, MOVING, EVERYWHERE];
        let find = |contexts: &[&str], pressed: &str| Keymap::default().find(contexts, pressed);
        assert_eq!(find(&contexts, "J"), Meaning::Line("cursor 0 10".into()));
        assert_eq!(find(&contexts, "u"), Meaning::Line("undo".into()));
        assert_eq!(find(&contexts, "g"), Meaning::Prefix);
        assert_eq!(find(&contexts, "Q"), Meaning::Nothing);
        assert!(Keymap::default().continuations(&contexts, "g").any(|row| row.key == "g p"));
    }

    #[test]
    fn a_row_may_take_any_letter() {
        for (pressed, expected) in
            [("q a", Some("record a")), ("q z", Some("record z")), ("q A", None), ("q", None), ("q Esc", None)]
        {
            assert_eq!(line_of("q {a-z}", "record {a-z}", pressed).as_deref(), expected, "{pressed}");
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
