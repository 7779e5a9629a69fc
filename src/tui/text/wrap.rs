//! Fits text into columns: measures, clips and wraps it.

use ratatui::text::Span;

use super::plain;

/// Width of a text in terminal columns.
pub fn width(text: &str) -> u16 {
    Span::raw(text).width().min(usize::from(u16::MAX)) as u16
}

/// `text` clipped to `room` columns, with an ellipsis if it does not fit. A number is left out rather than cut in two.
pub fn clipped(text: &str, room: usize) -> String {
    if usize::from(width(text)) <= room {
        return text.to_owned();
    }
    let mut kept = String::new();
    let mut wide = 0;
    for c in text.chars() {
        wide += usize::from(width(c.encode_utf8(&mut [0; 4])));
        if wide >= room.max(1) {
            break;
        }
        kept.push(c);
    }
    let part_of_number = |c: char| c.is_ascii_digit() || ".,-+".contains(c);
    if text[kept.len()..].starts_with(part_of_number) {
        let number = kept.trim_end_matches(part_of_number).len();
        // Digits of a word, as in `kodak04`, are not a number.
        if kept[number..].contains(|c: char| c.is_ascii_digit()) && !kept[..number].ends_with(char::is_alphabetic) {
            kept.truncate(number);
        }
    }
    if room > 0 { kept + "…" } else { kept }
}

/// `text` wrapped at words; a word that is wider than `room` keeps a line of its own.
pub fn wrapped(text: &str, room: u16) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let line = lines.last_mut().filter(|line| line.is_empty() || width(line) + 1 + width(word) <= room);
        match line {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) => {
                line.push(' ');
                line.push_str(word);
            }
            None => lines.push(word.to_owned()),
        }
    }
    lines
}

/// A text of several lines, wrapped at words, and within a word that is wider than `room`. Empty lines are dropped.
pub fn wrapped_lines(text: &str, room: u16) -> Vec<String> {
    let room = room.max(1);
    let mut lines = Vec::new();
    for line in text.lines().filter(|line| !line.trim().is_empty()) {
        let plain = plain(line);
        if width(&plain) <= room {
            lines.push(plain);
            continue;
        }
        for line in wrapped(&plain, room) {
            let mut rest = String::new();
            for c in line.chars() {
                if width(&rest) + width(c.encode_utf8(&mut [0; 4])) > room {
                    lines.push(std::mem::take(&mut rest));
                }
                rest.push(c);
            }
            lines.push(rest);
        }
    }
    lines
}

/// A line of a page in rows of at most `room` columns. The rows after the first are indented to the text after the first
/// wide gap, so that what follows a key stays in its column.
pub fn hanging(line: &str, room: u16) -> Vec<String> {
    if width(line) <= room {
        return vec![line.to_owned()];
    }
    let begin = line.len() - line.trim_start().len();
    let gap = line[begin..].find("  ").map_or(begin, |at| line.len() - line[begin + at..].trim_start().len());
    let indent = if width(&line[..gap]) <= room / 2 { gap } else { begin };
    let (head, text) = line.split_at(indent);
    let rows = wrapped_lines(text, room.saturating_sub(width(head)));
    let blank = " ".repeat(width(head).into());
    rows.iter().enumerate().map(|(i, row)| format!("{}{row}", if i == 0 { head } else { &blank })).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn help_is_wrapped_at_words() {
        assert_eq!(wrapped("one two  three", 8), ["one two", "three"]);
        assert_eq!(wrapped("", 8), [""]);
        assert_eq!(wrapped("a-word-too-long x", 4), ["a-word-too-long", "x"]);
        assert_eq!(wrapped_lines("a-word-too-long x\n\nyes", 6), ["a-word", "-too-l", "ong", "x", "yes"]);
        assert_eq!(wrapped_lines("日本語", 4), ["日本", "語"]);
    }

    #[test]
    fn the_rest_of_a_line_stays_in_its_column() {
        for (line, rows) in [
            ("a b  one two", &["a b  one two"][..]),
            ("ab   one two three", &["ab   one two", "     three"]),
            ("  one two three four", &["  one two", "  three four"]),
            ("a-long-name  one two", &["a-long-name", "one two"]),
            ("abcdefghijklmno", &["abcdefghijkl", "mno"]),
        ] {
            assert_eq!(hanging(line, 12), rows, "{line}");
        }
    }

    #[test]
    fn no_number_is_cut_in_two() {
        for (text, room, shown) in [
            ("at 12,34", 8, "at 12,34"),
            ("at 12,345", 8, "at …"),
            ("jump 1, -139.7 px", 13, "jump 1, …"),
            ("longest 18 px", 12, "longest 18 …"),
            ("longest 18 px", 10, "longest …"),
            ("face_kodak04", 12, "face_kodak04"),
            ("face_kodak04.eye", 12, "face_kodak0…"),
            ("目目目", 4, "目…"),
            ("abc", 1, "…"),
            ("abc", 0, ""),
        ] {
            assert_eq!(clipped(text, room), shown, "{text} in {room}");
        }
    }
}
