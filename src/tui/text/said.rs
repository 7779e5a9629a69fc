//! The syntax of a line: `[COUNT] NAME [ARGS]`. Keys run such lines, people type them after `:`, and scripts, macros and the
//! log consist of them.

/// The parts of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Said<'a> {
    /// The count: how often, or which one.
    pub count: Option<usize>,
    /// The name of the command; empty for an empty line.
    pub name: &'a str,
    /// What follows the name.
    pub text: &'a str,
}

impl<'a> Said<'a> {
    /// Parses a line, with or without the colon that one types before it. A count typed before its key multiplies the line's
    /// own. A number alone goes to that row, as in vim.
    pub fn parse(line: &'a str, typed: Option<usize>) -> Said<'a> {
        let (first, rest) = split(line.trim_start().trim_start_matches(':'));
        let count = first.parse::<usize>().ok();
        let (name, text) = if count.is_some() { split(rest) } else { (first, rest) };
        let both = typed.zip(count).map(|(typed, count)| typed.saturating_mul(count));
        let count = both.or(typed).or(count);
        match (count, name) {
            (Some(_), "") => Said { count, name: "move", text: "last" },
            _ => Said { count, name, text },
        }
    }
}

impl std::fmt::Display for Said<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let count = self.count.map(|count| format!("{count} ")).unwrap_or_default();
        let space = if self.text.is_empty() { "" } else { " " };
        write!(f, "{count}{}{space}{}", self.name, self.text)
    }
}

/// The first word, and what follows it.
fn split(line: &str) -> (&str, &str) {
    let line = line.trim();
    line.split_once(' ').map_or((line, ""), |(word, rest)| (word, rest.trim_start()))
}

/// A text as an argument of a line: quoted as in JSON if it would otherwise be read back differently.
pub fn quoted(text: &str) -> String {
    let bare = !text.is_empty() && !text.starts_with('"') && text.trim() == text && !text.contains(char::is_control);
    if bare { text.to_owned() } else { serde_json::Value::from(text).to_string() }
}

/// Reverses [`quoted`].
pub fn unquoted(text: &str) -> String {
    serde_json::from_str(text).ok().filter(|_| text.starts_with('"')).unwrap_or_else(|| text.to_owned())
}

/// The words of a line. Double quotes keep spaces; inside them a backslash escapes a quote or itself.
pub fn words(line: &str) -> Result<Vec<String>, String> {
    let mut words = Vec::new();
    let mut word: Option<String> = None;
    let mut quoted = false;
    let mut all = line.chars().peekable();
    while let Some(c) = all.next() {
        match c {
            '\\' if quoted && all.peek().is_some_and(|next| matches!(next, '"' | '\\')) => {
                word.get_or_insert_default().extend(all.next());
            }
            '"' => {
                quoted = !quoted;
                word.get_or_insert_default();
            }
            ' ' if !quoted => words.extend(word.take()),
            _ => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    if quoted { Err("a \" is not closed".into()) } else { Ok(words) }
}

/// Words as alternatives: `a, b or c`.
pub fn one_of(words: &[&str]) -> String {
    match words {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [all @ .., last] => format!("{} or {last}", all.join(", ")),
    }
}

/// A text quoted so that [`words`] reads it as one word.
pub fn one_word(word: &str) -> String {
    let bare = !word.is_empty() && !word.contains([' ', '"']) && !word.starts_with('!');
    if bare { word.to_owned() } else { format!("\"{}\"", word.replace('\\', "\\\\").replace('"', "\\\"")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_count_stands_before_the_name() {
        for (line, typed, said) in [
            ("move down", None, "move down"),
            (" 5  move  down ", None, "5 move down"),
            ("move down", Some(3), "3 move down"),
            ("2 move down", Some(3), "6 move down"),
            ("12", None, "12 move last"),
            ("put 5", None, "put 5"),
            (" :put :5", None, "put :5"),
            (":3 move down", None, "3 move down"),
            ("", None, ""),
        ] {
            assert_eq!(Said::parse(line, typed).to_string(), said, "{line:?}");
        }
    }

    #[test]
    fn quotes_keep_words_together() {
        assert_eq!(
            words("render -o \"my file.gif\"  x"),
            Ok(vec!["render".into(), "-o".into(), "my file.gif".into(), "x".into()])
        );
        assert!(words("a \"b").is_err());
        for (word, line) in [
            ("a.gif", "a.gif"),
            ("a b.gif", "\"a b.gif\""),
            ("a\"b\\.gif", "\"a\\\"b\\\\.gif\""),
            ("a\\b", "a\\b"),
            ("", "\"\""),
            ("!a", "\"!a\""),
        ] {
            assert_eq!(one_word(word), line);
            assert_eq!(words(line), Ok(vec![word.to_owned()]));
        }
    }

    #[test]
    fn what_is_quoted_is_read_back() {
        for (text, line) in [
            ("*1.1", "*1.1"),
            ("two words", "two words"),
            (" ", "\" \""),
            ("", "\"\""),
            ("\"a\"", "\"\\\"a\\\"\""),
            ("a\nb", "\"a\\nb\""),
        ] {
            assert_eq!(quoted(text), line);
            assert_eq!(unquoted(line), text);
        }
        assert_eq!(unquoted("\"open"), "\"open");
    }
}
