//! Names of numbered files, as patterns: `%04d.png`.

use std::collections::{BTreeMap, BTreeSet};

/// Numbers with more digits are refused.
const MOST_DIGITS: usize = 20;

/// A file name, in which the place of a number may be left open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    before: String,
    /// The least number of digits; `None` in a name without a number.
    digits: Option<usize>,
    after: String,
}

impl Pattern {
    /// The pattern in a file's `name`: `%d`, or `%04d` for at least four digits; `%%` is a `%`.
    ///
    /// # Errors
    /// What is wrong with it, in words: more than one number, one that is too wide, or something else after a `%`.
    pub fn of(name: &str) -> Result<Pattern, String> {
        let (mut texts, mut digits) = ([String::new(), String::new()], None);
        let mut rest = name.chars();
        while let Some(c) = rest.next() {
            let text = &mut texts[usize::from(digits.is_some())];
            if c != '%' {
                text.push(c);
                continue;
            }
            let mut spec = String::new();
            for c in rest.by_ref() {
                spec.push(c);
                if !c.is_ascii_digit() {
                    break;
                }
            }
            match spec.strip_suffix('d') {
                _ if spec == "%" => text.push('%'),
                Some(_) if digits.is_some() => return Err("the name holds two frame numbers".into()),
                Some("") => digits = Some(1),
                Some(width) => match width.parse::<usize>() {
                    Ok(width) if width <= MOST_DIGITS => digits = Some(width.max(1)),
                    _ => return Err(format!("\"%{spec}\" asks for more than {MOST_DIGITS} digits")),
                },
                None => return Err(format!("\"%{spec}\" is no frame number")),
            }
        }
        let [before, after] = texts;
        Ok(Pattern { before, digits, after })
    }

    /// Whether it names a file for each number.
    pub fn is_numbered(&self) -> bool {
        self.digits.is_some()
    }

    /// What follows the number.
    pub fn after(&self) -> &str {
        &self.after
    }

    /// The name of the file with this number.
    pub fn name(&self, number: u64) -> String {
        match self.digits {
            Some(digits) => format!("{}{number:0digits$}{}", self.before, self.after),
            None => self.before.clone(),
        }
    }

    /// The number of the file with this name, if it is one of those that the pattern names.
    pub fn number(&self, name: &str) -> Option<u64> {
        self.digits?;
        let number = name.strip_prefix(&self.before)?.strip_suffix(&self.after)?.parse().ok()?;
        (self.name(number) == name).then_some(number)
    }
}

/// Numbered files, at least one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Series {
    /// The pattern of their names.
    pub pattern: String,
    /// Their numbers, ascending.
    pub numbers: Vec<u64>,
}

impl Series {
    /// The name of file `index`, from 0.
    pub fn file(&self, index: usize) -> Option<String> {
        Some(Pattern::of(&self.pattern).ok()?.name(*self.numbers.get(index)?))
    }
}

/// The names that differ only in the last number before their extension, as patterns in order.
pub fn series<'a>(names: impl Iterator<Item = &'a str>) -> Vec<Series> {
    let mut found: BTreeMap<(&str, &str), Vec<&str>> = BTreeMap::new();
    for (before, digits, after) in names.filter_map(numbered) {
        found.entry((before, after)).or_default().push(digits);
    }
    let one = |((before, after), digits): ((&str, &str), Vec<&str>)| {
        // A zero in front says how many digits all of them have.
        let width = digits.iter().find(|digits| digits.len() > 1 && digits.starts_with('0')).map_or(0, |one| one.len());
        let number = if width == 0 { "%d".to_owned() } else { format!("%0{width}d") };
        let pattern = format!("{}{number}{}", before.replace('%', "%%"), after.replace('%', "%%"));
        let named = Pattern::of(&pattern).ok()?;
        let all = digits.iter().filter_map(|digits| named.number(&format!("{before}{digits}{after}")));
        let numbers: BTreeSet<u64> = all.collect();
        (!numbers.is_empty()).then(|| Series { pattern, numbers: numbers.into_iter().collect() })
    };
    found.into_iter().filter_map(one).collect()
}

/// What is before the last number in a name without its extension, the number, and what follows.
fn numbered(name: &str) -> Option<(&str, &str, &str)> {
    let stem = &name[..name.rfind('.').unwrap_or(name.len())];
    let end = stem.rfind(|c: char| c.is_ascii_digit())? + 1;
    let start = stem[..end]
        .rfind(|c: char| !c.is_ascii_digit())
        .map_or(0, |at| at + stem[at..].chars().next().map_or(1, char::len_utf8));
    Some((&name[..start], &name[start..end], &name[end..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_they_are_written() {
        for (pattern, name, number) in [
            ("%04d.png", "0012.png", Some(12)),
            ("%04d.png", "12345.png", Some(12345)),
            ("%04d.png", "012.png", None),
            ("%d.png", "012.png", None),
            ("a%%%d", "a%7", Some(7)),
            ("%d.png", "-1.png", None),
            ("%d.png", "+1.png", None),
            ("%d.png", "99999999999999999999.png", None),
            ("cat.png", "cat.png", None),
        ] {
            assert_eq!(Pattern::of(pattern).unwrap().number(name), number, "{pattern} {name}");
        }
    }

    #[test]
    fn names_become_patterns() {
        let found = |names: &[&str]| -> Vec<(String, Vec<u64>)> {
            series(names.iter().copied()).into_iter().map(|one| (one.pattern, one.numbers)).collect()
        };
        for (names, expected) in [
            (&["0002.png", "0001.png", "x.png", "10000.png"][..], vec![("%04d.png", vec![1, 2, 10000])]),
            (&["9.png", "10.png"], vec![("%d.png", vec![9, 10])]),
            (&["s2_01.jp2", "s2_02.jp2", "s3_01.jp2"], vec![("s2_%02d.jp2", vec![1, 2]), ("s3_%02d.jp2", vec![1])]),
            (&["100%é7b.png"], vec![("100%%é%db.png", vec![7])]),
            (&["a", ".png"], vec![]),
        ] {
            let expected: Vec<_> = expected.into_iter().map(|(pattern, all)| (pattern.to_owned(), all)).collect();
            assert_eq!(found(names), expected);
        }
    }
}
