//! The row of a key table: the editor and the window each have one such table, and from it come the bindings, the help,
//! the hints and the manual, so that none of them can be wrong.

/// One binding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeyRow {
    /// Where the key means this: a pane, a mode, or everywhere.
    pub context: &'static str,
    /// The key or keys, as written in the manual: `j`, `Down`, `Ctrl-d`, `g g`.
    pub key: &'static str,
    /// The command that it runs, with its arguments.
    pub command: &'static str,
    /// What it does, in a few words.
    pub help: &'static str,
}

/// The rows as a Markdown table, one section per context, in the order of the table.
pub fn markdown(rows: &[KeyRow]) -> String {
    let mut text = String::new();
    let mut context = "";
    for row in rows {
        if row.context != context {
            context = row.context;
            text.push_str(&format!("\n## {}\n\n| key | does | command |\n| --- | --- | --- |\n", capitalised(context)));
        }
        let escape = |text: &str| text.replace('|', "\\|");
        text.push_str(&format!("| `{}` | {} | `{}` |\n", escape(row.key), escape(row.help), escape(row.command)));
    }
    text
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_context_is_a_section() {
        let row = |context, key| KeyRow { context, key, command: "go", help: "Goes" };
        let text = markdown(&[row("tree", "j"), row("tree", "a|b"), row("form", "k")]);
        assert_eq!(text.matches("\n## ").count(), 2);
        assert!(text.contains("## Tree") && text.contains("| `a\\|b` | Goes | `go` |"), "{text}");
    }
}
