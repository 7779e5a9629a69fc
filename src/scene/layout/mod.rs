//! The text of a scene after an edit, in its author's layout: what has not changed keeps its bytes, from the spelling
//! of numbers to line ends and blank lines, and what is new looks like its neighbors. The new text depends only on the
//! old text and the new value, so it does not matter how one became the other: by edits, undo, a merge or a migration.

use std::iter::repeat_n;

use serde_json::Value;

use super::json;

mod align;
mod spans;

use align::{Origin, align_keys, align_values};
use spans::Element;

/// The text for `value` if `source` is in the file. If this program laid out `source` itself, or it cannot be read, the
/// layout is that of [`json::to_text`].
pub fn rewrite(source: &str, value: &Value) -> String {
    let laid_out = || json::to_text(value);
    let Ok(old) = json::parse(source) else { return laid_out() };
    if json::same(&old, value) {
        return source.to_owned();
    }
    if source == json::to_text(&old) {
        return laid_out();
    }
    let Some(text) = Rewrite::new(source).and_then(|rewrite| rewrite.all(&old, value)) else { return laid_out() };
    // Whatever the layout, the value is what counts.
    if json::parse(&text).is_ok_and(|made| json::same(&made, value)) { text } else { laid_out() }
}

/// Writes the new text from the old one.
struct Rewrite<'a> {
    source: &'a str,
    out: String,
    /// How a line ends.
    line_end: &'static str,
    /// What one more level of nesting adds to the beginning of a line.
    unit: &'a str,
    /// Whether the whole text is on one line.
    one_line: bool,
}

impl<'a> Rewrite<'a> {
    fn new(source: &'a str) -> Option<Rewrite<'a>> {
        let root = spans::start(source);
        let first = spans::elements(source, root)?.first().map_or(root, |element| element.start);
        let lead = &source[root..first];
        let unit = lead.rfind('\n').map_or("  ", |at| &lead[at + 1..]);
        let line_end = if source.contains("\r\n") { "\r\n" } else { "\n" };
        let one_line = !source.trim_end().contains('\n');
        Some(Rewrite { source, out: String::new(), line_end, unit, one_line })
    }

    fn all(mut self, old: &Value, new: &Value) -> Option<String> {
        let start = spans::start(self.source);
        let end = spans::end(self.source, start)?;
        self.out.push_str(&self.source[..start]);
        let flat = self.one_line;
        self.value(start, end, old, new, flat)?;
        self.out.push_str(&self.source[end..]);
        Some(self.out)
    }

    /// Writes `new` in place of `old`, which is between `start` and `end`; new values go on one line if `flat`.
    fn value(&mut self, start: usize, end: usize, old: &Value, new: &Value, flat: bool) -> Option<()> {
        let origins = match (old, new) {
            _ if json::same(old, new) => {
                self.out.push_str(&self.source[start..end]);
                return Some(());
            }
            (Value::Object(old), Value::Object(new)) if !old.is_empty() && !new.is_empty() => align_keys(old, new),
            (Value::Array(old), Value::Array(new)) if !old.is_empty() && !new.is_empty() => align_values(old, new),
            _ => {
                self.fresh(new, flat);
                return Some(());
            }
        };
        let new = match new {
            Value::Object(map) => map.iter().map(|(key, value)| (Some(key.as_str()), value)).collect(),
            other => other.as_array().into_iter().flatten().map(|value| (None, value)).collect(),
        };
        let list = List { elements: spans::elements(self.source, start)?, start, end, old, new };
        self.list(&list, &origins)
    }

    /// Writes the items of an object or a list, with the text between them.
    fn list(&mut self, list: &List, origins: &[Origin]) -> Option<()> {
        let last = list.elements.len() - 1;
        let flat = !self.source[list.start..list.end].contains('\n');
        self.out.push_str(&self.source[list.start..=list.start]);
        // The last old item so far that stayed in its place.
        let mut before = None;
        for (i, origin) in origins.iter().enumerate() {
            let stays = origin.stays();
            let lead = match stays {
                _ if i == 0 => self.lead(list, 0),
                Some(at) if at > 0 => self.lead(list, at),
                _ => self.lead_of_new(list, before),
            };
            self.out.push_str(lead);
            self.item(list, i, origin, flat)?;
            before = stays.or(before);
            let trail = match stays {
                _ if i + 1 == origins.len() => self.trail(list, last),
                Some(at) if at < last => self.trail(list, at),
                _ if last > 0 => self.trail(list, 0),
                _ => "",
            };
            self.out.push_str(trail);
            if i + 1 < origins.len() {
                self.out.push(',');
            }
        }
        self.out.push_str(&self.source[list.end - 1..list.end]);
        Some(())
    }

    /// Writes one item, with its key.
    fn item(&mut self, list: &List, i: usize, origin: &Origin, flat: bool) -> Option<()> {
        let (key, new) = *list.new.get(i)?;
        let from = origin.from().map(|at| (&list.elements[at], list.old_item(at)));
        if let Some(key) = key {
            let known = from.as_ref().filter(|(element, _)| element.key.as_deref() == Some(key));
            match known {
                Some((element, _)) => self.out.push_str(&self.source[element.start..element.value]),
                None => {
                    let model = from.as_ref().map_or(&list.elements[0], |(element, _)| element);
                    self.out.push_str(&Value::from(key).to_string());
                    self.out.push_str(&self.source[model.key_end..model.value]);
                }
            }
        }
        match from {
            Some((element, Some(old))) => self.value(element.value, element.end, old, new, flat)?,
            _ => self.fresh(new, flat),
        }
        Some(())
    }

    /// The text before an old item, from the bracket or comma before it.
    fn lead(&self, list: &List, at: usize) -> &'a str {
        let begin = if at == 0 { list.start + 1 } else { list.elements[at - 1].comma + 1 };
        &self.source[begin..list.elements[at].start]
    }

    /// The text after an old item, up to its comma or the closing bracket.
    fn trail(&self, list: &List, at: usize) -> &'a str {
        &self.source[list.elements[at].end..list.elements[at].comma]
    }

    /// The text before a new item that follows the old one at `before`: the same as before its neighbors.
    fn lead_of_new(&self, list: &List, before: Option<usize>) -> &'a str {
        let last = list.elements.len() - 1;
        match before.map_or(1, |before| before + 1).min(last) {
            0 if self.lead(list, 0).contains('\n') => self.lead(list, 0),
            0 if self.one_line && !self.source.contains(": ") => "",
            0 => " ",
            at => self.lead(list, at),
        }
    }

    /// Writes a value that is not in the source, on one line or in this program's layout.
    fn fresh(&mut self, value: &Value, flat: bool) {
        if flat {
            let compact = self.one_line && !self.source.contains(": ");
            self.out.push_str(&if compact { value.to_string() } else { json::on_one_line(value) });
            return;
        }
        let line = self.out.rfind('\n').map_or(0, |at| at + 1);
        let indent: String = self.out[line..].chars().take_while(|c| matches!(c, ' ' | '\t')).collect();
        let text = json::below(value, self.out[line..].chars().count());
        for (i, line) in text.lines().enumerate() {
            let spaces = line.len() - line.trim_start_matches(' ').len();
            if i > 0 {
                self.out.push_str(self.line_end);
                self.out.push_str(&indent);
                self.out.extend(repeat_n(self.unit, (spaces / json::INDENT).saturating_sub(1)));
            }
            self.out.push_str(&line[spaces..]);
        }
    }
}

/// An object or a list in the source, and what it becomes. Neither is empty.
struct List<'a> {
    elements: Vec<Element>,
    start: usize,
    end: usize,
    old: &'a Value,
    /// The new items, with their keys.
    new: Vec<(Option<&'a str>, &'a Value)>,
}

impl List<'_> {
    fn old_item(&self, at: usize) -> Option<&Value> {
        match self.old {
            Value::Object(map) => map.get(self.elements.get(at)?.key.as_deref()?),
            other => other.get(at),
        }
    }
}

#[cfg(test)]
mod tests;
