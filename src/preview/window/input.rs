//! Keys of the window system as the key table writes them.

use winit::keyboard::{Key, NamedKey};

use crate::preview::keys::KEYS;

/// The command bound to a key.
pub fn command(key: &Key) -> Option<&'static str> {
    let written = match key {
        Key::Named(NamedKey::ArrowLeft) => "Left",
        Key::Named(NamedKey::ArrowRight) => "Right",
        Key::Named(NamedKey::ArrowUp) => "Up",
        Key::Named(NamedKey::ArrowDown) => "Down",
        Key::Named(NamedKey::Escape) => "Esc",
        Key::Named(NamedKey::Enter) => "Enter",
        Key::Named(NamedKey::F11) => "F11",
        Key::Named(NamedKey::Space) => "Space",
        Key::Character(text) if text == "=" => "+", // the same key without Shift on many keyboards
        Key::Character(text) => text.as_str(),
        _ => return None,
    };
    KEYS.iter().find(|row| row.key == written).map(|row| row.command)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_of_the_key_table_can_be_typed() {
        let named = [
            ("Left", NamedKey::ArrowLeft),
            ("Right", NamedKey::ArrowRight),
            ("Up", NamedKey::ArrowUp),
            ("Down", NamedKey::ArrowDown),
            ("Esc", NamedKey::Escape),
            ("Enter", NamedKey::Enter),
            ("F11", NamedKey::F11),
            ("Space", NamedKey::Space),
        ];
        for row in KEYS {
            let name = named.iter().find(|(written, _)| *written == row.key);
            let key = name.map_or(Key::Character(row.key.into()), |(_, key)| Key::Named(*key));
            assert_eq!(command(&key), Some(row.command), "{row:?}");
        }
        assert_eq!(command(&Key::Character("=".into())), Some("zoom-in"));
        assert_eq!(command(&Key::Named(NamedKey::F1)), None);
    }
}
