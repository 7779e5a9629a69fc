//! A line of text with a cursor, for entries, `:` and `/`. It knows nothing of what the text means, so that one table of keys
//! serves all three.

use tui_input::{Input, InputRequest};

use crate::base::maths;

/// A line being typed.
#[derive(Clone, Debug, Default)]
pub struct Text {
    input: Input,
    /// Whether the first character typed replaces the text.
    fresh: bool,
}

impl Text {
    /// Starts with `text`, the cursor after it. If `fresh`, the first character typed replaces it.
    pub fn new(text: impl Into<String>, fresh: bool) -> Self {
        Text { input: Input::new(text.into()), fresh }
    }

    /// The text.
    pub fn value(&self) -> &str {
        self.input.value()
    }

    /// Where the cursor is, in terminal columns from the start.
    pub fn column(&self) -> usize {
        self.input.visual_cursor()
    }

    /// Where the cursor is, in characters from the start.
    pub fn cursor(&self) -> usize {
        self.input.cursor()
    }

    /// Whether the next character typed replaces the text.
    pub fn is_fresh(&self) -> bool {
        self.fresh
    }

    /// Types `typed` at the cursor. Control characters are left out.
    pub fn insert(&mut self, typed: &str) {
        if std::mem::take(&mut self.fresh) {
            self.input.reset();
        }
        for c in typed.chars().filter(|c| !c.is_control()) {
            self.input.handle(InputRequest::InsertChar(c));
        }
    }

    /// Replaces the text and sets the cursor, in characters.
    pub fn set(&mut self, text: String, cursor: usize) {
        self.fresh = false;
        self.input = Input::new(text).with_cursor(cursor);
    }

    /// Does one of the edits that the key table names (`text left`, ...); false if there is no such edit.
    pub fn change(&mut self, what: &str) -> bool {
        let request = match what {
            "left" => InputRequest::GoToPrevChar,
            "right" => InputRequest::GoToNextChar,
            "start" => InputRequest::GoToStart,
            "end" => InputRequest::GoToEnd,
            "word-left" => InputRequest::GoToPrevWord,
            "word-right" => InputRequest::GoToNextWord,
            "rub" => InputRequest::DeletePrevChar,
            "delete" => InputRequest::DeleteNextChar,
            "rub-word" => InputRequest::DeletePrevWord,
            "delete-word" => InputRequest::DeleteNextWord,
            "clear" => InputRequest::DeleteLine,
            _ => return false,
        };
        self.fresh = false;
        self.input.handle(request);
        true
    }

    /// Steps the digit under (or just before) the cursor by `steps`, carrying into the others. The cursor stays on its place
    /// value; a decimal comma or a true minus sign is kept. False if the text is not a plain number with a digit there.
    pub fn step_digit(&mut self, steps: i64) -> bool {
        let (comma, minus) = (self.value().contains(','), self.value().contains('−'));
        let text = self.value().replace(',', ".").replace('−', "-");
        let Some((decimals, place)) = digit_at(&text, self.cursor()) else { return false };
        let unit = maths::ten_to(place);
        let Ok(value) = text.trim().parse::<f64>() else { return false };
        let stepped = format!("{:.decimals$}", value + steps as f64 * unit);
        let nothing = stepped.strip_prefix('-').filter(|rest| rest.bytes().all(|b| b"0.".contains(&b)));
        let stepped = nothing.map(str::to_owned).unwrap_or(stepped);
        let from_end = text.chars().count() - self.cursor().min(text.chars().count());
        let cursor = stepped.chars().count().saturating_sub(from_end);
        let stepped = if comma { stepped.replace('.', ",") } else { stepped };
        let stepped = if minus { stepped.replace('-', "−") } else { stepped };
        self.set(stepped, cursor);
        true
    }
}

/// The number of decimals of a plain number, and the place value (power of ten) of its digit under the cursor.
fn digit_at(text: &str, cursor: usize) -> Option<(usize, i32)> {
    if text.is_empty() || !text.chars().all(|c| c.is_ascii_digit() || "+-.".contains(c)) {
        return None;
    }
    let point = text.find('.').unwrap_or(text.len());
    let decimals = text.len().saturating_sub(point + 1);
    let mut at = cursor.min(text.len() - 1);
    // On the sign the first digit steps, on the point the ones.
    if at == 0 && "+-".contains(&text[..1]) {
        at = 1.min(text.len() - 1);
    }
    if !text.as_bytes()[at].is_ascii_digit() {
        at = at.checked_sub(1)?;
    }
    if !text.as_bytes()[at].is_ascii_digit() {
        return None;
    }
    let place = if at < point { (point - at - 1) as i32 } else { -((at - point) as i32) };
    Some((decimals, place))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_character_replaces_a_fresh_text() {
        let mut text = Text::new("150", true);
        text.insert("7");
        assert_eq!(text.value(), "7");
        let mut text = Text::new("150", true);
        text.change("left");
        text.insert("7");
        assert_eq!(text.value(), "1570");
        text.insert("\u{1b}\n");
        assert_eq!(text.value(), "1570");
    }

    #[test]
    fn digits_step_with_carry() {
        for (text, cursor, steps, stepped) in [
            ("150", 3, 1, "151"),
            ("150", 0, 1, "250"),
            ("150", 1, -6, "90"),
            ("0.95", 2, 1, "1.05"),
            ("0.95", 3, 1, "0.96"),
            ("0.95", 4, 1, "0.96"),
            ("-18", 2, -1, "-19"),
            ("9", 1, 1, "10"),
            ("999", 1, 1, "1009"),
            ("1000", 1, -1, "900"),
            ("1", 1, -1, "0"),
            ("0", 1, -1, "-1"),
            ("1", 1, -3, "-2"),
            ("-1", 2, 1, "0"),
            ("-1", 2, 3, "2"),
            ("-18", 0, 1, "-8"),
            ("-0.3", 4, 3, "0.0"),
            ("0.05", 4, -10, "-0.05"),
            ("12.50", 2, 1, "13.50"),
            ("12.50", 5, 1, "12.51"),
            ("0.001", 5, -2, "-0.001"),
            ("5", 1, 25, "30"),
            ("0,5", 3, 2, "0,7"),
            ("0,95", 2, 1, "1,05"),
            ("−5", 1, 2, "−3"),
            ("−5", 2, 6, "1"),
            ("−0,5", 4, -1, "−0,6"),
        ] {
            let mut line = Text::new(text, true);
            line.set(text.into(), cursor);
            assert!(line.step_digit(steps), "{text}");
            assert_eq!(line.value(), stepped, "{text} at {cursor}");
        }
        for text in ["w/2", "1,5,2", "1.5,2"] {
            assert!(!Text::new(text, false).step_digit(1), "{text}");
        }
    }
}
