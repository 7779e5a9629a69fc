//! The little of roff that the pages need.

/// A text in which nothing is a command.
pub fn text(text: &str) -> String {
    let line = |line: &str| {
        let line = line.replace('\\', "\\e").replace('-', "\\-");
        if line.starts_with(['.', '\'']) { format!("\\&{line}") } else { line }
    };
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}

/// The beginning of a page.
pub fn title(name: &str, section: u8, what: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let upper = name.to_uppercase();
    format!(".TH {upper} {section} \"\" \"plica {version}\"\n.SH NAME\n{name} \\- {}\n", text(what))
}

/// A heading.
pub fn heading(title: &str) -> String {
    format!(".SH \"{}\"\n", text(title).replace('"', "\\(dq"))
}

/// A heading within one.
pub fn subheading(title: &str) -> String {
    format!(".SS \"{}\"\n", text(title).replace('"', "\\(dq"))
}

/// A paragraph.
pub fn paragraph(words: &str) -> String {
    format!(".PP\n{}\n", text(words))
}

/// A name, what kind of thing it is, and what it means.
pub fn tagged(name: &str, kind: &str, help: &str) -> String {
    let kind = if kind.is_empty() { String::new() } else { format!("  {}", text(kind)) };
    format!(".TP\n\\fB\\&{}\\fR{kind}\n{}\n", text(name), text(help))
}

/// Lines that stay as they are.
pub fn as_it_stands(lines: &[&str]) -> String {
    let lines: String = lines.iter().map(|line| format!("\\&{}\n", text(line).trim_start_matches("\\&"))).collect();
    format!(".PP\n.nf\n{lines}.fi\n")
}
