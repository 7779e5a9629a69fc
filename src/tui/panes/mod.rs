//! The panes: each draws one part of the state into its area and says where the real cursor stands, if it is there.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use ratatui::text::Span;

use super::outside::terminal;
use super::text::colour;
use super::text::input::Text;
use super::text::numbers::polar;

mod braille;
mod columns;
pub mod detail;
pub mod field;
pub mod lesson;
pub mod line;
pub mod palette;
pub mod picture;
pub mod popup;
pub mod position;
pub mod probe;
pub mod status;
pub mod table;
pub mod tree;
pub mod view;

/// Width of a text in terminal columns.
pub fn width(text: &str) -> u16 {
    Span::raw(text).width().min(usize::from(u16::MAX)) as u16
}

/// Writes `text` at column `x` of a row of `area`, which may lie left of it or beyond; gives the column after it. What does
/// not fit ends with a mark.
pub fn write(buffer: &mut Buffer, area: Rect, x: i32, y: u16, text: &str, style: Style) -> i32 {
    let end = x + i32::from(width(text));
    if y >= area.height || x >= i32::from(area.width) || end <= 0 {
        return end;
    }
    let skipped: String = text.chars().skip((-x).max(0) as usize).collect();
    let from = x.max(0) as u16;
    let room = usize::from(area.width - from);
    buffer.set_stringn(area.x + from, area.y + y, clipped(&skipped, room), room, style);
    end
}

/// `text` in so many columns: whole, else what is left of it before a mark. No number is cut in two.
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
        // Digits of a word, as in `kodak04`, are no number.
        if kept[number..].contains(|c: char| c.is_ascii_digit()) && !kept[..number].ends_with(char::is_alphabetic) {
            kept.truncate(number);
        }
    }
    if room > 0 { kept + "…" } else { kept }
}

/// Writes a text that is being typed so that its cursor is in sight, with marks where it goes on; gives the cursor.
pub fn typed(buffer: &mut Buffer, area: Rect, text: &Text, style: Style) -> Position {
    let shown = terminal::plain(text.value());
    let (column, room) = (text.column(), usize::from(area.width));
    let hidden = (column + 1).saturating_sub(room);
    if hidden == 0 && usize::from(width(&shown)) <= room {
        write(buffer, area, 0, 0, &shown, style);
    } else {
        let mut at = 0;
        let within = shown.chars().filter(|c| {
            let from = at;
            at += usize::from(width(c.encode_utf8(&mut [0; 4])));
            from >= hidden
        });
        buffer.set_stringn(area.x, area.y, within.collect::<String>(), room, style);
        if hidden > 0 && column > hidden {
            write(buffer, area, 0, 0, "<", colour::faint());
        }
        if usize::from(width(&shown)).saturating_sub(hidden) > room && column + 1 < hidden + room {
            write(buffer, area, room as i32 - 1, 0, ">", colour::faint());
        }
    }
    Position::new(area.x + column.saturating_sub(hidden) as u16, area.y)
}

/// The arrow for the direction of a vector, one of eight.
pub fn arrow(vector: kurbo::Vec2) -> &'static str {
    const ARROWS: [&str; 8] = ["→", "↗", "↑", "↖", "←", "↙", "↓", "↘"];
    ARROWS[(polar(vector).1 / 45.0).round().rem_euclid(8.0) as usize]
}

/// `text` in lines that fit.
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

/// A text of several lines in lines that fit: at words, and where one is longer than a line inside it. None is empty.
pub fn folded(text: &str, room: u16) -> Vec<String> {
    let room = room.max(1);
    let mut lines = Vec::new();
    for line in text.lines().filter(|line| !line.trim().is_empty()) {
        let plain = terminal::plain(line);
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

/// The first of `count` rows that is shown in `height` lines, so that row `at` stands in the middle where it can.
pub fn first_row(at: usize, count: usize, height: u16) -> usize {
    let height = usize::from(height);
    at.saturating_sub(height / 2).min(count.saturating_sub(height))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_scroll_around_the_cursor() {
        for (at, count, height, first) in [(0, 100, 10, 0), (50, 100, 10, 45), (99, 100, 10, 90), (3, 5, 10, 0)] {
            assert_eq!(first_row(at, count, height), first);
        }
    }

    #[test]
    fn help_is_wrapped_at_words() {
        assert_eq!(wrapped("one two  three", 8), ["one two", "three"]);
        assert_eq!(wrapped("", 8), [""]);
        assert_eq!(wrapped("a-word-too-long x", 4), ["a-word-too-long", "x"]);
        assert_eq!(folded("a-word-too-long x\n\nyes", 6), ["a-word", "-too-l", "ong", "x", "yes"]);
        assert_eq!(folded("日本語", 4), ["日本", "語"]);
    }

    #[test]
    fn text_is_clipped_on_both_sides() {
        let area = Rect::new(1, 0, 4, 1);
        let mut buffer = Buffer::empty(Rect::new(0, 0, 8, 1));
        assert_eq!(write(&mut buffer, area, -2, 0, "abcdefgh", Style::new()), 6);
        write(&mut buffer, area, 0, 5, "below", Style::new());
        let text: String = buffer.content().iter().map(|cell| cell.symbol()).collect();
        assert_eq!(text, " cde…   ");
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
