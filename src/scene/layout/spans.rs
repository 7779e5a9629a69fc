//! Where the parts of a JSON text are. Only one object or list is scanned at a time, so that a large text costs memory
//! only for what changes in it. The text has been parsed before: what does not look like JSON here gives `None`.

/// An item of an object or a list: byte offsets in the text.
#[derive(Debug)]
pub struct Element {
    /// Where it begins: at its key, if it has one.
    pub start: usize,
    /// Its key.
    pub key: Option<String>,
    /// Where the key ends; the start of the value if there is none.
    pub key_end: usize,
    /// Where its value begins.
    pub value: usize,
    /// Where its value ends.
    pub end: usize,
    /// Where the comma after it is, or the closing bracket.
    pub comma: usize,
}

/// Where the value of a text begins.
pub fn start(text: &str) -> usize {
    let mark = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
    blank(text.as_bytes(), mark)
}

/// Where the value that begins at `at` ends.
pub fn end(text: &str, at: usize) -> Option<usize> {
    let bytes = text.as_bytes();
    let mut depth = 0_usize;
    let mut at = at;
    loop {
        match bytes.get(at)? {
            b'"' => at = string_end(bytes, at)?,
            b'{' | b'[' => (depth, at) = (depth + 1, at + 1),
            b'}' | b']' => (depth, at) = (depth.checked_sub(1)?, at + 1),
            b',' | b':' | b' ' | b'\t' | b'\r' | b'\n' => at = (depth > 0).then_some(at + 1)?,
            _ => at = plain_end(bytes, at),
        }
        if depth == 0 {
            return Some(at);
        }
    }
}

/// The items of the object or list that begins at `at`; empty for a plain value.
pub fn elements(text: &str, at: usize) -> Option<Vec<Element>> {
    let bytes = text.as_bytes();
    let close = match bytes.get(at)? {
        b'{' => b'}',
        b'[' => b']',
        _ => return Some(Vec::new()),
    };
    let mut found = Vec::new();
    let mut at = blank(bytes, at + 1);
    if bytes.get(at) == Some(&close) {
        return Some(found);
    }
    loop {
        let start = at;
        let (mut key, mut key_end) = (None, start);
        if close == b'}' {
            key_end = string_end(bytes, start)?;
            key = Some(serde_json::from_str(&text[start..key_end]).ok()?);
            at = blank(bytes, key_end);
            at = blank(bytes, (bytes.get(at) == Some(&b':')).then_some(at + 1)?);
        }
        let (value, end) = (at, end(text, at)?);
        let comma = blank(bytes, end);
        found.push(Element { start, key, key_end, value, end, comma });
        match bytes.get(comma)? {
            b',' => at = blank(bytes, comma + 1),
            byte if *byte == close => return Some(found),
            _ => return None,
        }
    }
}

/// The first offset from `at` that is not white space.
fn blank(bytes: &[u8], at: usize) -> usize {
    let blanks = bytes.iter().skip(at).take_while(|byte| matches!(byte, b' ' | b'\t' | b'\r' | b'\n'));
    at + blanks.count()
}

/// The offset after the string that begins at `at`.
fn string_end(bytes: &[u8], at: usize) -> Option<usize> {
    let mut at = (bytes.get(at) == Some(&b'"')).then_some(at + 1)?;
    loop {
        match bytes.get(at)? {
            b'\\' => at += 2,
            b'"' => return Some(at + 1),
            _ => at += 1,
        }
    }
}

/// The offset after the number or word that begins at `at`.
fn plain_end(bytes: &[u8], at: usize) -> usize {
    let ends =
        |byte: &u8| matches!(byte, b',' | b':' | b'[' | b']' | b'{' | b'}' | b'"' | b' ' | b'\t' | b'\r' | b'\n');
    bytes.iter().skip(at).position(ends).map_or(bytes.len(), |length| at + length)
}
