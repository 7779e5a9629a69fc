//! Reads the person's own keys, checked against the table of commands.

use super::TABLE;
use crate::tui::keys::Keymap;

/// The keymap of a file; mistakes name `file`.
pub fn read(file: &str, text: &str) -> Keymap {
    let help = |name: &str| TABLE.find(name).map_or("", |command| command.help);
    let names = TABLE.names().into_iter().chain(TABLE.aliases().map(str::to_owned));
    let known: Vec<(String, &'static str)> = names.map(|name| (name.clone(), help(&name))).collect();
    Keymap::with(file, text, &known)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_may_run_commands_by_their_other_names() {
        let keymap = read("keys.toml", "[tree]\nZ = \"fold\"\nX = \"open\"\nC = \"foldd\"\n");
        let mistakes: Vec<&String> = keymap.mistakes().iter().collect();
        assert!(matches!(mistakes[..], [one] if one.contains("there is no command foldd")), "{mistakes:?}");
    }
}
