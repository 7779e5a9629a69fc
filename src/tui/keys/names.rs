//! The names of keys, and matching pressed keys with rows of the table.

use terminput::{KeyCode, KeyEvent, KeyModifiers};

/// The file with the person's own keys.
pub const OWN_FILE: &str = "$XDG_CONFIG_HOME/plica/keys.toml (else ~/.config/plica/keys.toml)";

/// Placeholders in a row for any lowercase and any uppercase letter.
pub const LETTERS: [&str; 2] = ["{a-z}", "{A-Z}"];

/// What the keys that were pressed so far mean.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// They run this line.
    Line(String),
    /// They begin one or more longer sequences.
    Prefix,
    /// They mean nothing.
    Nothing,
}

/// The line that a row runs if the pressed keys are its own. A placeholder of [`LETTERS`] at the end matches any letter; in the
/// line it is replaced by the letter that was pressed.
pub fn line_of(key: &str, command: &str, pressed: &str) -> Option<String> {
    if key == pressed {
        return Some(command.to_owned());
    }
    let any = LETTERS.into_iter().find(|any| key.ends_with(any))?;
    let letter = pressed.strip_prefix(key.strip_suffix(any)?)?;
    stands_for(any, letter).then(|| command.replace(any, letter))
}

/// Whether `any` is one of [`LETTERS`] and matches this key.
pub fn stands_for(any: &str, key: &str) -> bool {
    let fits = |c: char| (any == LETTERS[0] && c.is_ascii_lowercase()) || (any == LETTERS[1] && c.is_ascii_uppercase());
    key.len() == 1 && key.starts_with(fits)
}

/// Whether the keys of a row continue the pressed ones.
pub fn continues(key: &str, pressed: &str) -> bool {
    key.strip_prefix(pressed).is_some_and(|rest| rest.starts_with(' '))
}

/// The name of a key as the table has it; `None` if it has none.
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
