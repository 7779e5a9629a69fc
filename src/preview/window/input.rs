//! Keys of the window system as the key table writes them.

use winit::keyboard::{Key, ModifiersState, NamedKey};

use crate::preview::keys::{KEYS, repeats};

/// The command bound to a key; `None` if Ctrl, Alt or Super are held with it: those keys are the system's. On macOS letters
/// and signs are typed with Alt. What comes again while the key is held counts for what steps and moves.
pub fn command(key: &Key, held: ModifiersState, again: bool) -> Option<&'static str> {
    let alt = if cfg!(target_os = "macos") { ModifiersState::empty() } else { ModifiersState::ALT };
    if held.intersects(ModifiersState::CONTROL | ModifiersState::SUPER | alt) {
        return None;
    }
    let written = match key {
        Key::Named(NamedKey::ArrowLeft) => "Left",
        Key::Named(NamedKey::ArrowRight) => "Right",
        Key::Named(NamedKey::ArrowUp) => "Up",
        Key::Named(NamedKey::ArrowDown) => "Down",
        Key::Named(NamedKey::Escape) => "Esc",
        Key::Named(NamedKey::Enter) => "Enter",
        Key::Named(NamedKey::Backspace) => "Backspace",
        Key::Named(NamedKey::F11) => "F11",
        Key::Named(NamedKey::Space) => "Space",
        Key::Named(NamedKey::Tab) => "Tab",
        Key::Character(text) if text == "=" => "+", // the same key without Shift on many keyboards
        Key::Character(text) => text.as_str(),
        _ => return None,
    };
    let command = KEYS.iter().find(|row| row.key == written).map(|row| row.command)?;
    (!again || repeats(command)).then_some(command)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: ModifiersState = ModifiersState::empty();

    #[test]
    fn every_row_of_the_key_table_can_be_typed() {
        let named = [
            ("Left", NamedKey::ArrowLeft),
            ("Right", NamedKey::ArrowRight),
            ("Up", NamedKey::ArrowUp),
            ("Down", NamedKey::ArrowDown),
            ("Esc", NamedKey::Escape),
            ("Enter", NamedKey::Enter),
            ("Backspace", NamedKey::Backspace),
            ("F11", NamedKey::F11),
            ("Space", NamedKey::Space),
            ("Tab", NamedKey::Tab),
        ];
        for row in KEYS.iter() {
            let name = named.iter().find(|(written, _)| *written == row.key);
            let key = name.map_or(Key::Character(row.key.into()), |(_, key)| Key::Named(*key));
            assert_eq!(command(&key, NONE, false), Some(row.command), "{row:?}");
            assert_eq!(command(&key, ModifiersState::SHIFT, false), Some(row.command), "{row:?}");
            assert_eq!(command(&key, NONE, true), repeats(row.command).then_some(row.command), "{row:?}, held");
            for held in [ModifiersState::CONTROL, ModifiersState::SUPER, ModifiersState::ALT | ModifiersState::SHIFT] {
                let typed = cfg!(target_os = "macos") && held.alt_key();
                assert_eq!(command(&key, held, false).is_some(), typed, "{row:?} with {held:?}");
            }
        }
        assert_eq!(command(&Key::Character("=".into()), NONE, false), Some("zoom-in"));
        assert_eq!(command(&Key::Named(NamedKey::F1), NONE, false), None);
    }
}
