//! The page of keys and commands: docs/keys.md, which is made from the editor's tables, as roff.

use super::roff;

const KEYS: &str = include_str!("../../../docs/keys.md");

/// The page.
pub fn page() -> String {
    roff::title("plica-keys", 7, "keys and commands of the editor of plica") + &of_markdown(KEYS)
}

/// Headings, paragraphs, tables and indented lines.
fn of_markdown(text: &str) -> String {
    let mut page = roff::heading("DESCRIPTION");
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        if let Some(title) = line.strip_prefix("## ") {
            page += &roff::heading(&title.to_uppercase());
        } else if line.starts_with('|') {
            page += &row(line);
        } else if line.starts_with("    ") {
            let mut block = vec![line];
            while let Some(next) = lines.next_if(|next| next.starts_with("    ")) {
                block.push(next);
            }
            page += &roff::as_it_stands(&block);
        } else if !line.is_empty() && !line.starts_with("# ") {
            let mut words = vec![line];
            while let Some(next) = lines.next_if(|next| !next.is_empty() && !next.starts_with(['|', '#'])) {
                words.push(next);
            }
            page += &roff::paragraph(&plain(&words.join(" ")));
        }
    }
    page
}

/// A row of a table: its first cell, the last one if there are three, and what it does. Heads are left out.
fn row(line: &str) -> String {
    const BAR: char = '\u{1}';
    let line = line.replace("\\|", &BAR.to_string());
    let cell = |text: &str| plain(text.trim()).replace(BAR, "|");
    let cells: Vec<String> = line.trim_matches('|').split('|').map(cell).collect();
    match cells.as_slice() {
        [first, ..] if first.starts_with("---") || first == "key" || first == "line" => String::new(),
        [key, does, command] => roff::tagged(key, &format!(":{command}"), does),
        [name, does] => roff::tagged(name, "", does),
        _ => String::new(),
    }
}

/// Without the marks of code, and of links only their words.
fn plain(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("](") {
        plain += &before.replacen('[', "", 1);
        rest = after.split_once(')').map_or("", |(_, rest)| rest);
    }
    (plain + rest).replace('`', "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markdown_becomes_roff() {
        let page = of_markdown(
            "# Title\n\nSee [keys](a.md), `5j`\nmore.\n\n## Tree\n\n| key | does | command |\n| --- | --- | --- |\n| `\\|` | Go | `move -1` |\n\n    x  y\n",
        );
        let expected = ".SH \"DESCRIPTION\"\n.PP\nSee keys, 5j more.\n.SH \"TREE\"\n.TP\n\\fB\\&|\\fR  :move \\-1\nGo\n.PP\n.nf\n\\&    x  y\n.fi\n";
        assert_eq!(page, expected);
        assert!(super::page().contains("\\fB\\&g g\\fR  :move first"));
    }
}
