//! What a key means: the rows of the one table (table.rs), with the person's own over them (keymap.rs), looked up by context
//! from the innermost out: a pane, then everywhere.

use terminput::{KeyCode, KeyEvent, KeyModifiers};

use super::commands;
use crate::preview::keys as window;

mod keymap;
pub use keymap::Keymap;
mod table;
pub use table::{
    AIM, ENTRY, EVERYWHERE, HELP, KEYS, LINE, LIST, NUMBER, PALETTE, PICTURE, RECORDING, SMALL, TABLE, TREE, TYPING,
};

/// Where the person's own keys stand.
pub const OWN_FILE: &str = "$XDG_CONFIG_HOME/plica/keys.toml (else ~/.config/plica/keys.toml)";

/// Stand in a row for any small and for any capital letter.
const LETTERS: [&str; 2] = ["{a-z}", "{A-Z}"];

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

/// The line that a row runs where the keys pressed are its own. A key of [`LETTERS`] at the end stands for any letter, and in
/// the line for the one that was pressed.
fn line_of(key: &str, command: &str, pressed: &str) -> Option<String> {
    if key == pressed {
        return Some(command.to_owned());
    }
    let any = LETTERS.into_iter().find(|any| key.ends_with(any))?;
    let letter = pressed.strip_prefix(key.strip_suffix(any)?)?;
    stands_for(any, letter).then(|| command.replace(any, letter))
}

/// Whether a key of a row is one of [`LETTERS`] and stands for this key.
fn stands_for(any: &str, key: &str) -> bool {
    let fits = |c: char| (any == LETTERS[0] && c.is_ascii_lowercase()) || (any == LETTERS[1] && c.is_ascii_uppercase());
    key.len() == 1 && key.starts_with(fits)
}

/// Whether the keys of a row go on from those pressed.
fn continues(key: &str, pressed: &str) -> bool {
    key.strip_prefix(pressed).is_some_and(|rest| rest.starts_with(' '))
}

/// The name of a key in the table; `None` where it has none.
pub fn name(event: KeyEvent) -> Option<String> {
    let shift = event.modifiers.contains(KeyModifiers::SHIFT);
    let plain = match event.code {
        KeyCode::Char(' ') => "Space".to_string(),
        KeyCode::Char(c) if shift => c.to_uppercase().to_string(),
        KeyCode::Char(c) => c.to_string(),
        KeyCode::Enter => "Enter".into(),
        KeyCode::Esc => "Esc".into(),
        KeyCode::Tab if shift => return Some("Shift-Tab".into()),
        KeyCode::Tab => "Tab".into(),
        KeyCode::Backspace => "Backspace".into(),
        KeyCode::Delete => "Delete".into(),
        KeyCode::Up => "Up".into(),
        KeyCode::Down => "Down".into(),
        KeyCode::Left => "Left".into(),
        KeyCode::Right => "Right".into(),
        KeyCode::Home => "Home".into(),
        KeyCode::End => "End".into(),
        KeyCode::F(n) => format!("F{n}"),
        KeyCode::PageUp => return Some("Ctrl-u".into()),
        KeyCode::PageDown => return Some("Ctrl-d".into()),
        _ => return None,
    };
    let control = event.modifiers.contains(KeyModifiers::CTRL).then_some("Ctrl-");
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
    let cell = |text: &str| text.replace('|', "\\|");
    let row = |name: &str, args: &str, help: &str| {
        let space = if args.is_empty() { "" } else { " " };
        format!("| `{}{space}{}` | {} |\n", cell(name), cell(args), cell(help))
    };
    let own: String = commands::all().map(|command| row(command.name, command.args, command.help)).collect();
    let entries: String = commands::entries().into_iter().map(|line| format!("    {line}\n")).collect();
    let window: String = window::KEYS.iter().map(|own| row(own.key, "", own.help)).collect();
    let others: String =
        commands::subcommands().map(|name| row(&name, "...", &format!("As `plica {name}`, on this scene"))).collect();
    format!(
        "# Keys and commands of the editor\n\nMade from the tables that the editor itself reads; a test holds them together. A \
         number before a key is a count: `5j`.\nIn a pane its own keys come first, then those of \"{EVERYWHERE}\". Your own keys \
         stand over them: [keymap.md](keymap.md).\n{}\n## Commands\n\nEvery key runs one of these lines; they are typed after `:`, \
         a count before the name (`:5 move down`),\nand stand in scripts (`:source`, `plica edit --script`) and in the log of a \
         session (`:log`).\n\n| line | does |\n| --- | --- |\n{own}{others}\n## What an entry may be\n\n{entries}\n## In the window\n\nThe keys of the preview window; \
         the editor has most of them behind `z`.\n\n| key | does |\n| --- | --- |\n{window}",
        crate::base::keys::markdown(KEYS)
    )
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn no_two_bindings_clash() {
        let mut seen = BTreeSet::new();
        for row in KEYS {
            assert!(seen.insert((row.context, row.key)), "{row:?}");
            let hidden = KEYS.iter().any(|other| other.context == row.context && continues(row.key, other.key));
            assert!(!hidden, "{row:?} can never be reached");
            assert!(row.help.starts_with(char::is_uppercase) && !row.help.ends_with('.'), "{row:?}");
        }
    }

    #[test]
    fn every_binding_is_a_command() {
        for row in KEYS {
            let name = row.command.split(' ').next().unwrap();
            assert!(commands::find(name).is_some(), "{row:?}");
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
        let find = |contexts: &[&str], pressed: &str| Keymap::default().find(contexts, pressed);
        assert_eq!(find(&contexts, "J"), Found::Line("cursor 0 10".into()));
        assert_eq!(find(&contexts, "u"), Found::Line("undo".into()));
        assert_eq!(find(&contexts, "g"), Found::Prefix);
        assert_eq!(find(&contexts, "Q"), Found::Nothing);
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
