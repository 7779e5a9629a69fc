//! The panes: each draws one part of the state into its area and says where the real cursor stands, if it is there.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::Span;

use super::numbers::polar;
use super::terminal;

mod braille;
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

/// Width of a text in terminal columns.
pub fn width(text: &str) -> u16 {
    Span::raw(text).width().min(usize::from(u16::MAX)) as u16
}

/// Writes `text` at column `x` of a row of `area`, which may lie left of it or beyond; gives the column after it.
pub fn write(buffer: &mut Buffer, area: Rect, x: i32, y: u16, text: &str, style: Style) -> i32 {
    let end = x + i32::from(width(text));
    if y >= area.height || x >= i32::from(area.width) || end <= 0 {
        return end;
    }
    let skipped: String = text.chars().skip((-x).max(0) as usize).collect();
    let from = x.max(0) as u16;
    buffer.set_stringn(area.x + from, area.y + y, skipped, usize::from(area.width - from), style);
    end
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
        assert_eq!(text, " cdef   ");
    }
}
