//! The manual of keys and commands, made from their tables.

use super::help::entries;
use super::{TABLE, all};
use crate::preview::keys as window;
use crate::tui::keys::{EVERYWHERE, KEYS};

/// docs/keys.md.
pub fn manual() -> String {
    let cell = |text: &str| text.replace('|', "\\|");
    let row = |name: &str, args: &str, help: &str| {
        let space = if args.is_empty() { "" } else { " " };
        format!("| `{}{space}{}` | {} |\n", cell(name), cell(args), cell(help))
    };
    let own: String = all().map(|command| row(command.name, command.args, command.help)).collect();
    let entries: String = entries().into_iter().map(|line| format!("    {line}\n")).collect();
    let window: String = window::KEYS.iter().map(|own| row(own.key, "", own.help)).collect();
    let others: String =
        TABLE.subcommands().map(|name| row(&name, "...", &format!("As `plica {name}`, on this scene"))).collect();
    format!(
        "# Keys and commands of the editor\n\nMade from the tables that the editor itself reads; a test holds them together. A \
         number before a key is a count: `5j`.\nIn a pane its own keys come first, then those of \"{EVERYWHERE}\". Your own keys \
         stand over them: [keymap.md](keymap.md).\n{}\n## Commands\n\nEvery key runs one of these lines; they are typed after `:`, \
         a count before the name (`:5 move down`),\nand stand in scripts (`:source`, `plica edit --script`) and in the log of a \
         session (`:log`).\n\n| line | does |\n| --- | --- |\n{own}{others}\n## What an entry may be\n\n{entries}\n## In the window\n\nThe keys of the preview window; \
         the editor has most of them behind `z`.\n\n| key | does |\n| --- | --- |\n{window}",
        crate::base::keys::markdown(&KEYS)
    )
}
