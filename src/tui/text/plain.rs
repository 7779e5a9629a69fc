//! Makes text safe to show: nothing in it can control the terminal.

/// `text` without anything that could control a terminal: control characters become their pictures (U+2400), direction marks
/// and the like a replacement character. Joiners stay in words whose script has them. Between emoji they are removed: some
/// terminals join these and some do not, and the width of the text must not depend on that.
pub fn plain(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut after = text.chars();
    while let Some(c) = after.next() {
        let before = plain.chars().next_back();
        let next = after.clone().next();
        let word = |c: Option<char>| c.is_some_and(|c| !c.is_ascii() && c.is_alphabetic());
        // Vowel signs and the like belong to the letter before them.
        let marked = before.is_some_and(|c| matches!(c, '\u{900}'..='\u{dff}'));
        match c {
            '\u{200c}' | '\u{200d}' if (word(before) || marked) && word(next) => plain.push(c),
            '\u{200d}' if before.is_some_and(is_sign) && next.is_some_and(is_sign) => {}
            '\u{0}'..='\u{1f}' => plain.push(char::from_u32(0x2400 + u32::from(c)).unwrap_or('\u{fffd}')),
            '\u{7f}' => plain.push('\u{2421}'),
            '\u{80}'..='\u{9f}'
            | '\u{200b}'..='\u{200f}'
            | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}'
            | '\u{feff}' => plain.push('\u{fffd}'),
            _ => plain.push(c),
        }
    }
    plain
}

/// Whether a character is an emoji or modifies one: joiners combine these into one.
fn is_sign(c: char) -> bool {
    matches!(c, '\u{2190}'..='\u{2bff}' | '\u{fe0f}' | '\u{1f000}'..='\u{1faff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_commands_a_terminal_gets_through() {
        for (text, safe) in [
            ("left eye", "left eye"),
            ("\u{1b}[2J", "␛[2J"),
            ("a\nb\tc", "a␊b␉c"),
            ("\u{9b}31m", "\u{fffd}31m"),
            ("\u{202e}abc", "\u{fffd}abc"),
            ("größe 目", "größe 目"),
            ("👩\u{200d}💻 👁\u{fe0f}\u{200d}🗨", "👩💻 👁\u{fe0f}🗨"),
            ("می\u{200c}خواهم", "می\u{200c}خواهم"),
            ("a\u{200d}b\u{200c} \u{200d}", "a\u{fffd}b\u{fffd} \u{fffd}"),
        ] {
            assert_eq!(plain(text), safe);
        }
    }
}
