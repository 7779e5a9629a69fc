//! Pasted tables: their lines, fields and numbers, as spreadsheets and other programs write them.

use crate::base::text::counted;
use csv::{ReaderBuilder, Trim};

/// A line of a pasted table.
pub struct Record {
    /// Its number, from 1.
    pub line: u64,
    /// What stands in its columns.
    pub fields: Vec<String>,
}

/// A number as spreadsheets write it: a comma for the point, a true minus sign.
pub fn number(text: &str) -> Option<f64> {
    let plain = text.replace('−', "-");
    let plain = if plain.contains('.') { plain } else { plain.replacen(',', ".", 1) };
    let looks = plain.bytes().all(|b| b.is_ascii_digit() || b"+-.eE".contains(&b));
    plain.parse::<f64>().ok().filter(|value| looks && value.is_finite())
}

/// Whether a text is this number with fewer decimals, as programs write what they did not mean to change.
pub fn is_rounded(value: f64, text: &str) -> bool {
    const LEAST: usize = 3;
    let decimals = text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let digits = text.bytes().filter(u8::is_ascii_digit).count();
    let looks = digits >= LEAST + 2 && text.bytes().all(|b| b.is_ascii_digit() || b"-.".contains(&b));
    looks && decimals > 0 && format!("{value:.decimals$}") == text
}

/// What separates the fields of a table: of tabs, semicolons and commas the first that its first record has outside quotes
/// (RFC 4180); `None` if spaces do, as between numbers with decimal commas.
fn delimiter(text: &str) -> Option<char> {
    let (mut quoted, mut found) = (false, [false; 3]);
    for c in text.trim_start().chars() {
        match c {
            '"' => quoted = !quoted,
            '\n' if !quoted => break,
            _ if quoted => {}
            c => ['\t', ';', ','].into_iter().zip(&mut found).for_each(|(known, found)| *found |= c == known),
        }
    }
    let words = || text.trim_start().lines().next().unwrap_or_default().split_whitespace();
    // One that ends with a comma is separated by it.
    let is_number = |word: &str| !word.ends_with(',') && number(word).is_some();
    match found {
        [true, ..] => Some('\t'),
        [_, true, _] => Some(';'),
        [.., true] if words().count() > 1 && words().all(is_number) => None,
        [.., true] => Some(','),
        _ => text.contains('"').then_some(','),
    }
}

/// The line of a quote that opens a field and is not closed.
fn unclosed(text: &str, delimiter: char) -> Option<usize> {
    let (mut line, mut open, mut begins) = (1, None, true);
    for c in text.chars() {
        match (open, c) {
            // What was closed goes on where the quote is doubled.
            (Some(_), '"') => (open, begins) = (None, true),
            (Some(_), _) => {}
            (None, '"') if begins => (open, begins) = (Some(line), false),
            (None, _) => begins = c == delimiter || c == '\n',
        }
        line += usize::from(c == '\n');
    }
    open
}

/// The lines that have something in them, split where the first of them is: at tabs, semicolons, commas or spaces. A field
/// in quotes may hold any of these, line ends, and doubled quotes. All have as many fields as the first.
pub fn records(text: &str) -> Result<Vec<Record>, String> {
    let records = split(text.trim_start_matches('\u{feff}'))?;
    let count = records.first().map_or(0, |record| record.fields.len());
    match records.iter().find(|record| record.fields.len() != count) {
        None => Ok(records),
        Some(other) => {
            let (line, found) = (other.line, counted(other.fields.len(), "value"));
            Err(format!("line {line} has {found}, the lines before have {count}"))
        }
    }
}

fn split(text: &str) -> Result<Vec<Record>, String> {
    let Some(delimiter) = delimiter(text) else {
        let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        let fields = |line: &str| line.split_whitespace().map(str::to_owned).collect();
        return Ok(lines.map(|(i, line)| Record { line: i as u64 + 1, fields: fields(line) }).collect());
    };
    if let Some(line) = unclosed(text, delimiter) {
        return Err(format!("the quote of line {line} is not closed"));
    }
    let reader = ReaderBuilder::new()
        .delimiter(delimiter as u8)
        .has_headers(false)
        .flexible(true)
        .trim(Trim::All)
        .from_reader(text.as_bytes());
    let (mut seen, mut line) = (0, 1);
    // The reader counts no line end before the first character of a record.
    let record = |record: csv::StringRecord| {
        let from = record.position().map_or(seen, |at| at.byte() as usize).min(text.len());
        let begun = text.len() - text[from..].trim_start_matches(['\r', '\n']).len();
        line += text[seen..begun].bytes().filter(|b| *b == b'\n').count() as u64;
        seen = begun;
        Record { line, fields: record.iter().map(str::to_owned).collect() }
    };
    let records = reader.into_records().filter_map(Result::ok).map(record);
    Ok(records.filter(|record| record.fields.iter().any(|field| !field.is_empty())).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_split_where_their_first_line_is() {
        for (text, expected) in [
            ("1,2\n3,4", vec![(1, "1|2"), (2, "3|4")]),
            ("1 ; 2\r\n\r\n3 ;4\r\n", vec![(1, "1|2"), (3, "3|4")]),
            ("1,5\t2\n", vec![(1, "1,5|2")]),
            ("  1   2\n 3 4", vec![(1, "1|2"), (2, "3|4")]),
            ("\u{feff}x,\"d,x\"\n", vec![(1, "x|d,x")]),
            ("\n\n7", vec![(3, "7")]),
            ("\"1\",\"2\"\n\"3\",\"4\"", vec![(1, "1|2"), (2, "3|4")]),
            ("\"1,5\",\"2,5\"", vec![(1, "1,5|2,5")]),
            ("\"a;b\",c", vec![(1, "a;b|c")]),
            ("\"1,5\";\"2\"", vec![(1, "1,5|2")]),
            ("\"1,5\"\t2", vec![(1, "1,5|2")]),
            ("\"say \"\"a\"\"\",2", vec![(1, "say \"a\"|2")]),
            ("\"a\nb\",2\n3,4", vec![(1, "a\nb|2"), (3, "3|4")]),
            ("\"5\"\n\"6\"", vec![(1, "5"), (2, "6")]),
            ("1,5 2,5\n3 4,5", vec![(1, "1,5|2,5"), (2, "3|4,5")]),
            ("1, 2, 3", vec![(1, "1|2|3")]),
            ("5\",\"6\"", vec![(1, "5\"|6")]),
        ] {
            let found: Vec<(u64, String)> =
                records(text).unwrap().iter().map(|r| (r.line, r.fields.join("|"))).collect();
            let expected: Vec<(u64, String)> =
                expected.into_iter().map(|(line, text)| (line, text.to_string())).collect();
            assert_eq!(found, expected, "{text:?}");
        }
    }

    #[test]
    fn quotes_are_closed_and_rows_are_of_one_length() {
        for (text, why) in [
            ("\"1,2,3,4", "the quote of line 1 is not closed"),
            ("1,2\n3,\"4\n5,6", "the quote of line 2 is not closed"),
            ("1,\"2\"\"\n3,4", "the quote of line 1 is not closed"),
            ("1,5\n2,5\n3", "line 3 has 1 value, the lines before have 2"),
            ("x,y\n1,2,3", "line 2 has 3 values, the lines before have 2"),
        ] {
            assert_eq!(records(text).err().as_deref(), Some(why), "{text:?}");
        }
    }

    #[test]
    fn what_is_rounded_is_the_same_number() {
        for (value, text, is_same) in [
            (5.830951895, "5.83095", true),
            (5.830951895, "5.8309518950", true),
            (-53.130102354, "-53.1301", true),
            (5.830951895, "5.83096", false),
            (5.830951895, "5.83", false),
            (5.830951895, "6", false),
            (12345.4, "12345", false),
        ] {
            assert_eq!(is_rounded(value, text), is_same, "{text}");
        }
    }

    #[test]
    fn numbers_are_read_as_spreadsheets_write_them() {
        for (text, value) in [
            ("1.5", Some(1.5)),
            ("1,5", Some(1.5)),
            ("−18", Some(-18.0)),
            ("+3e2", Some(300.0)),
            ("inf", None),
            ("1e999", None),
            ("x", None),
            ("", None),
        ] {
            assert_eq!(number(text), value, "{text}");
        }
    }
}
