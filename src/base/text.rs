//! Text for a terminal: nothing that comes from data (names, paths, messages of libraries) may steer it.

use std::borrow::Cow;

/// `text` with control characters written out, line ends and tabs apart.
pub fn printable(text: &str) -> Cow<'_, str> {
    let steers = |c: char| (c.is_control() && c != '\n' && c != '\t') || BIDI.contains(&c);
    if !text.contains(steers) {
        return text.into();
    }
    text.chars().map(|c| if steers(c) { c.escape_unicode().to_string() } else { c.to_string() }).collect()
}

/// How long ago something was, in words: `3 min ago`.
pub fn ago(milliseconds: u64) -> String {
    let seconds = milliseconds / 1000;
    match seconds {
        0..5 => "just now".into(),
        5..60 => format!("{seconds} s ago"),
        60..3600 => format!("{} min ago", seconds / 60),
        3600..172_800 => format!("{} h ago", seconds / 3600),
        _ => format!("{} days ago", seconds / 86_400),
    }
}

/// Characters that turn the order of what is shown.
const BIDI: [char; 9] =
    ['\u{202a}', '\u{202b}', '\u{202c}', '\u{202d}', '\u{202e}', '\u{2066}', '\u{2067}', '\u{2068}', '\u{2069}'];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_told_in_words() {
        for (seconds, text) in
            [(0, "just now"), (59, "59 s ago"), (60, "1 min ago"), (7200, "2 h ago"), (172_800, "2 days ago")]
        {
            assert_eq!(ago(seconds * 1000), text);
        }
    }

    #[test]
    fn nothing_steers_the_terminal() {
        for (text, shown) in [
            ("Größe: 3\n\tx", "Größe: 3\n\tx"),
            ("a\x1b[2Jb", "a\\u{1b}[2Jb"),
            ("\r\x07\u{9b}31m\x7f", "\\u{d}\\u{7}\\u{9b}31m\\u{7f}"),
            ("gnp\u{202e}.exe", "gnp\\u{202e}.exe"),
        ] {
            assert_eq!(printable(text), shown);
        }
    }
}
