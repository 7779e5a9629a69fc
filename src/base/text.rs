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

/// `value` with so many decimals (at least one) at most, and no needless zeros.
pub fn short(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    // Without decimals a 0 at the end counts.
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".into() } else { text.into() }
}

/// A number of bytes, in a unit that fits: `1.2 MB`.
pub fn bytes(count: u64) -> String {
    let units = [(1e9, "GB"), (1e6, "MB"), (1e3, "kB")];
    // What would be rounded up to 1000 has the next unit.
    let unit = units.iter().find(|(unit, _)| count as f64 >= unit * 0.99995);
    unit.map_or_else(|| format!("{count} bytes"), |(unit, name)| format!("{:.1} {name}", count as f64 / unit))
}

/// A number with a noun: `1 row`, `3 rows`.
pub fn counted(count: impl std::fmt::Display, name: &str) -> String {
    let count = count.to_string();
    let end = if count == "1" { "" } else { "s" };
    format!("{count} {name}{end}")
}

/// How many there are: `there is 1`, `there are 3`.
pub fn there_are(count: impl std::fmt::Display) -> String {
    let count = count.to_string();
    format!("there {} {count}", if count == "1" { "is" } else { "are" })
}

/// How long something took: `3.4 s`.
pub fn took(milliseconds: u64) -> String {
    match milliseconds {
        0..59_950 => format!("{:.1} s", milliseconds as f64 / 1e3),
        _ => format!("{} min {} s", milliseconds / 60_000, milliseconds / 1000 % 60),
    }
}

/// As [`printable`], on one line: a name with a line end in it cannot forge a line of ours.
pub fn line(text: &str) -> Cow<'_, str> {
    if !text.contains(['\n', '\t']) {
        return printable(text);
    }
    printable(text).replace('\n', "\\n").replace('\t', "\\t").into()
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

/// Bytes in hexadecimal: two small digits each.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The byte that two hexadecimal digits stand for.
pub fn byte_of_hex(digits: &[u8]) -> Option<u8> {
    let &[high, low] = digits else { return None };
    let value = |digit: u8| char::from(digit).to_digit(16);
    u8::try_from(value(high)? << 4 | value(low)?).ok()
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
    fn nouns_follow_their_number() {
        for (count, noun, sentence) in
            [(0, "0 rows", "there are 0"), (1, "1 row", "there is 1"), (12, "12 rows", "there are 12")]
        {
            assert_eq!((counted(count, "row"), there_are(count)), (noun.to_owned(), sentence.to_owned()));
        }
    }

    #[test]
    fn numbers_are_short() {
        for (value, decimals, text) in [
            (150.0, 1, "150"),
            (2.5, 3, "2.5"),
            (0.12345, 3, "0.123"),
            (1e-6, 6, "0.000001"),
            (-0.004, 2, "0"),
            (-0.0, 1, "0"),
            (-0.006, 2, "-0.01"),
            (f64::INFINITY, 2, "inf"),
        ] {
            assert_eq!(short(value, decimals), text);
        }
    }

    #[test]
    fn sizes_and_times_have_units_that_fit() {
        for (count, text) in [
            (0, "0 bytes"),
            (999, "999 bytes"),
            (1000, "1.0 kB"),
            (999_949, "999.9 kB"),
            (999_951, "1.0 MB"),
            (12_340_000, "12.3 MB"),
            (5_000_000_000, "5.0 GB"),
        ] {
            assert_eq!(bytes(count), text);
        }
        for (ms, text) in
            [(0, "0.0 s"), (340, "0.3 s"), (59_900, "59.9 s"), (60_000, "1 min 0 s"), (754_000, "12 min 34 s")]
        {
            assert_eq!(took(ms), text);
        }
    }

    #[test]
    fn bytes_are_written_and_read_in_hexadecimal() {
        assert_eq!(hex(&[0, 0x0f, 0xa0, 0xff]), "000fa0ff");
        for byte in 0..=255 {
            assert_eq!(byte_of_hex(hex(&[byte]).as_bytes()), Some(byte));
            assert_eq!(byte_of_hex(hex(&[byte]).to_uppercase().as_bytes()), Some(byte));
        }
        for text in ["", "1", "123", "+1", "0x", "1g", " 1"] {
            assert_eq!(byte_of_hex(text.as_bytes()), None, "{text}");
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
        assert_eq!(line("a\n\tb\x1b"), "a\\n\\tb\\u{1b}");
        assert_eq!(line("plain"), "plain");
    }
}
