//! Text to JSON and back. serde_json reads, but through a visitor of our own: it refuses duplicate keys (serde_json
//! would silently keep the last) and text nested too deep, each with its line and column. The writer keeps what changes
//! together on one line, so that diffs are small.

use std::fmt;
use std::iter::repeat_n;

use serde::de::{DeserializeSeed, Deserializer, Error as _, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value};

pub use crate::base::change::same;
use crate::base::problem::{Kind, LARGEST, Problem};

/// How deep objects and lists may be nested.
pub const MAX_DEPTH: usize = 64;

/// What is put on one line ends before this column.
const MAX_COLUMN: usize = 110;
/// Spaces per level.
pub(super) const INDENT: usize = 2;

/// Bytes of memory that `value` takes, slightly overestimated.
pub fn bytes(value: &Value) -> u64 {
    let key = |key: &String| (key.len() + size_of::<String>() + 2 * size_of::<usize>()) as u64;
    size_of::<Value>() as u64
        + match value {
            Value::Array(items) => items.iter().map(bytes).sum(),
            Value::Object(map) => map.iter().map(|(name, value)| key(name) + bytes(value)).sum(),
            Value::String(text) => text.len() as u64,
            Value::Null | Value::Bool(_) | Value::Number(_) => 0,
        }
}

/// How deep objects and lists are nested in `value`.
pub fn depth(value: &Value) -> usize {
    match value {
        Value::Array(items) => 1 + items.iter().map(depth).max().unwrap_or(0),
        Value::Object(map) => 1 + map.values().map(depth).max().unwrap_or(0),
        _ => 0,
    }
}

/// The most bytes of memory that the value of a JSON text can take, estimated from its punctuation without parsing it.
pub fn bytes_of_text(text: &[u8]) -> u64 {
    let parts = text.iter().filter(|byte| matches!(byte, b',' | b'[' | b'{' | b':')).count() as u64;
    (parts + 1) * size_of::<Value>() as u64 + text.len() as u64
}

/// Parses `text`; the problem names the line and the column.
pub fn parse(text: &str) -> Result<Value, Problem> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut deserializer = serde_json::Deserializer::from_str(text);
    let value = Seed { depth: 0 }.deserialize(&mut deserializer);
    value.and_then(|value| deserializer.end().map(|()| value)).map_err(|error| place(&error, text))
}

/// Messages of serde_json, and the same in plainer words: its `classify` does not tell them apart.
const PLAINER: [(&str, &str); 9] = [
    ("EOF while parsing a value", "the text ends where a value was expected"),
    ("EOF while parsing an object", "the text ends within an object: a } is missing"),
    ("EOF while parsing a list", "the text ends within a list: a ] is missing"),
    ("EOF while parsing a string", "the text ends within a text: a \" is missing"),
    (OUT_OF_RANGE, "the number is too large"),
    ("expected value", "expected a value: a number, a text in quotes, a list, an object"),
    ("expected `,` or `}`", "a comma or a } is missing before this"),
    ("expected `,` or `]`", "a comma or a ] is missing before this"),
    ("trailing characters", "something follows after the end: a bracket too many, or one too early"),
];

const OUT_OF_RANGE: &str = "number out of range";

fn place(error: &serde_json::Error, text: &str) -> Problem {
    let (line, column) = (error.line(), error.column());
    let message = error.to_string();
    let what = message.strip_suffix(&format!(" at line {line} column {column}")).unwrap_or(&message);
    let plainer = PLAINER.iter().find(|(theirs, _)| *theirs == what).map_or(what, |(_, ours)| ours);
    let at = |what: &str| Problem::error("", format!("line {line}, column {column}: {what}"));
    if what == OUT_OF_RANGE {
        return Problem { kind: Kind::TooLargeNumber, ..at(plainer).hint(LARGEST) };
    }
    let rest = text.lines().nth(line.saturating_sub(1)).and_then(|line| line.get(column.saturating_sub(1)..));
    let word = |word: &&&str| rest.is_some_and(|rest| rest.starts_with(**word));
    match NO_NUMBERS.iter().find(word) {
        Some(word) => at(&format!("{word} is no number in JSON")).hint("write a finite number"),
        None => at(plainer),
    }
}

/// What other formats write where there is no number.
const NO_NUMBERS: [&str; 4] = ["NaN", "nan", "Infinity", "inf"];

/// Reads one value at a given depth.
#[derive(Clone, Copy)]
struct Seed {
    depth: usize,
}

impl Seed {
    fn deeper<E: serde::de::Error>(self) -> Result<Seed, E> {
        if self.depth < MAX_DEPTH {
            Ok(Seed { depth: self.depth + 1 })
        } else {
            Err(E::custom(format_args!("nested deeper than {MAX_DEPTH}")))
        }
    }
}

impl<'de> DeserializeSeed<'de> for Seed {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Value, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Seed {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("JSON")
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_f64<E>(self, value: f64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_str<E>(self, value: &str) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut access: A) -> Result<Value, A::Error> {
        let inner = self.deeper()?;
        let mut items = Vec::new();
        while let Some(item) = access.next_element_seed(inner)? {
            items.push(item);
        }
        Ok(Value::Array(items))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut access: A) -> Result<Value, A::Error> {
        let inner = self.deeper()?;
        let mut map = Map::new();
        while let Some(key) = access.next_key::<String>()? {
            if map.contains_key(&key) {
                return Err(A::Error::custom(format_args!("{} appears twice in one object", Value::from(key))));
            }
            let value = access.next_value_seed(inner)?;
            map.insert(key, value);
        }
        Ok(Value::Object(map))
    }
}

/// The text of a document: two spaces per level, lists of numbers and short objects of plain values on one line, a line
/// end at the end. `parse` returns the same value, and that gives the same text.
pub fn to_text(value: &Value) -> String {
    let mut out = String::new();
    write(value, 0, 0, &mut out);
    out.push('\n');
    out
}

/// The text of a value within a document, one level deep, on a line that already holds `column` characters.
pub(super) fn below(value: &Value, column: usize) -> String {
    let mut out = String::new();
    write(value, 1, column, &mut out);
    out
}

/// The text of a value on one line.
pub(super) fn on_one_line(value: &Value) -> String {
    let mut out = String::new();
    inline(value, &mut out);
    out
}

/// Writes `value` where the line already holds `column` characters.
fn write(value: &Value, level: usize, column: usize, out: &mut String) {
    if (level > 0 || !value.is_object()) && is_flat(value) {
        let start = out.len();
        inline(value, out);
        if out.len() - start + column < MAX_COLUMN || is_row(value) {
            return;
        }
        out.truncate(start);
    }
    match value {
        Value::Object(map) if !map.is_empty() => {
            lines(map.iter(), '{', '}', level, out, |(key, value), out| {
                let start = out.len();
                scalar(&Value::from(key.as_str()), out);
                out.push_str(": ");
                write(value, level + 1, INDENT * (level + 1) + out.len() - start, out);
            });
        }
        Value::Array(items) if !items.is_empty() => {
            lines(items.iter(), '[', ']', level, out, |item, out| write(item, level + 1, INDENT * (level + 1), out));
        }
        _ => inline(value, out),
    }
}

fn lines<T>(
    items: impl ExactSizeIterator<Item = T>,
    open: char,
    close: char,
    level: usize,
    out: &mut String,
    mut each: impl FnMut(T, &mut String),
) {
    let last = items.len() - 1;
    out.push(open);
    for (i, item) in items.enumerate() {
        out.push('\n');
        out.extend(repeat_n(" ", INDENT * (level + 1)));
        each(item, out);
        if i < last {
            out.push(',');
        }
    }
    out.push('\n');
    out.extend(repeat_n(" ", INDENT * level));
    out.push(close);
}

/// Whether `value` may be on one line: a plain value, numbers, or an object of those.
fn is_flat(value: &Value) -> bool {
    match value {
        Value::Object(map) => map.values().all(|value| is_scalar(value) || is_numbers(value)),
        Value::Array(_) => is_numbers(value),
        _ => true,
    }
}

/// Whether it is a list of numbers, or of such lists.
fn is_numbers(value: &Value) -> bool {
    value.as_array().is_some_and(|items| items.iter().all(|item| item.is_number() || is_numbers(item)))
}

/// Whether it stays on its line however long it is: a list of plain numbers, or a plain value.
fn is_row(value: &Value) -> bool {
    is_scalar(value) || value.as_array().is_some_and(|items| items.iter().all(Value::is_number))
}

fn is_scalar(value: &Value) -> bool {
    !value.is_object() && !value.is_array()
}

fn inline(value: &Value, out: &mut String) {
    match value {
        Value::Object(map) if !map.is_empty() => {
            for (i, (key, value)) in map.iter().enumerate() {
                out.push_str(if i == 0 { "{ " } else { ", " });
                scalar(&Value::from(key.as_str()), out);
                out.push_str(": ");
                inline(value, out);
            }
            out.push_str(" }");
        }
        Value::Array(items) => {
            out.push('[');
            for (i, item) in items.iter().enumerate() {
                out.push_str(if i == 0 { "" } else { ", " });
                inline(item, out);
            }
            out.push(']');
        }
        scalar_or_empty => scalar(scalar_or_empty, out),
    }
}

/// Writes a plain value or an empty object as serde_json does: numbers at their shortest, integers as integers.
fn scalar(value: &Value, out: &mut String) {
    use std::fmt::Write;
    write!(out, "{value}").expect("writing to a string does not fail");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn broken_text_is_refused_with_its_place() {
        for (text, expected) in [
            ("{ \"a\": 1,\n  \"a\": 2 }", "line 2, column 5: \"a\" appears twice in one object"),
            ("[1e999]", "line 1, column 6: the number is too large"),
            ("{ \"a\": NaN }", "line 1, column 8: NaN is no number in JSON"),
            ("{ \"a\":\n x }", "line 2, column 2: expected a value: a number, a text in quotes, a list, an object"),
            (
                "{ \"a\": 1 } x",
                "line 1, column 12: something follows after the end: a bracket too many, or one too early",
            ),
            ("", "line 1, column 0: the text ends where a value was expected"),
        ] {
            assert_eq!(parse(text).unwrap_err().message, expected, "{text}");
        }
        let deep = |n: usize| "[".repeat(n) + &"]".repeat(n);
        assert!(parse(&deep(MAX_DEPTH)).is_ok());
        assert_eq!(parse(&deep(MAX_DEPTH + 1)).unwrap_err().message, "line 1, column 66: nested deeper than 64");
        assert!(parse(&deep(100_000)).is_err());
    }

    /// Fails if serde_json changes its words: then the table must follow.
    #[test]
    fn the_words_of_serde_json_are_known() {
        let broken = ["", "{", "[", "\"", "[1e999]", "[x]", "{\"a\": 1 2}", "[1 2]", "{}}"];
        for ((theirs, ours), text) in PLAINER.iter().zip(broken) {
            let error = serde_json::from_str::<Value>(text).unwrap_err().to_string();
            assert_eq!(error.split(" at line").next(), Some(*theirs), "{text}");
            let problem = parse(text).unwrap_err();
            assert!(problem.message.ends_with(ours), "{text}: {problem:?}");
            assert_eq!(problem.kind == Kind::TooLargeNumber, text == "[1e999]", "{text}");
        }
    }

    #[test]
    fn text_is_stable_and_keeps_numbers_and_order() {
        let text = concat!(
            "{\n  \"z\": 1,\n  \"a\": 2.0,\n  \"empty\": {},\n  \"none\": [],\n",
            "  \"point\": { \"at\": [1, -0.5], \"name\": \"\\u0007 é\" },\n",
            "  \"list\": [\n    { \"x\": 1e300 },\n    { \"y\": { \"z\": 3 } }\n  ]\n}\n"
        );
        let expected = text.replace("{ \"y\": { \"z\": 3 } }", "{\n      \"y\": { \"z\": 3 }\n    }");
        let value = parse(text).unwrap();
        assert_eq!(to_text(&value), expected.replace("1e300", "1e+300"));
        assert!(same(&parse(&to_text(&value)).unwrap(), &value));
    }

    #[test]
    fn long_rows_stay_and_long_lists_of_points_break() {
        let numbers = Value::from((0..200).collect::<Vec<_>>());
        let points = Value::from((0..200).map(|i| vec![i, i]).collect::<Vec<_>>());
        let text = to_text(&serde_json::json!({ "n": numbers, "p": points }));
        assert_eq!(text.lines().count(), 2 + 1 + 202);
    }
}
