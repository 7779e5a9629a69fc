//! JSON pointers (RFC 6901) as plain strings: the addresses of problems, fields and edits.

/// The tokens of a pointer, unescaped. The empty pointer has none.
pub fn tokens(pointer: &str) -> impl Iterator<Item = String> + '_ {
    pointer.split('/').skip(1).map(|token| token.replace("~1", "/").replace("~0", "~"))
}

/// `pointer` one step deeper.
pub fn join(pointer: &str, token: impl std::fmt::Display) -> String {
    let mut joined = pointer.to_owned();
    push(&mut joined, &token.to_string());
    joined
}

/// Appends a token to a pointer.
pub fn push(pointer: &mut String, token: &str) {
    pointer.push('/');
    if token.contains(['~', '/']) {
        pointer.push_str(&token.replace('~', "~0").replace('/', "~1"));
    } else {
        pointer.push_str(token);
    }
}

/// The pointer to the parent, and the last token; `None` for the whole document.
pub fn split(pointer: &str) -> Option<(&str, String)> {
    let (parent, last) = pointer.rsplit_once('/')?;
    Some((parent, last.replace("~1", "/").replace("~0", "~")))
}

/// A token as an index of a list: digits, no leading zero.
pub fn index(token: &str) -> Option<usize> {
    let plain = token.bytes().all(|b| b.is_ascii_digit()) && (token == "0" || !token.starts_with('0'));
    plain.then(|| token.parse().ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back() {
        for names in [vec![], vec![""], vec!["a", "b/c", "d~e", "~1"]] {
            let pointer = names.iter().fold(String::new(), |pointer, name| join(&pointer, name));
            assert_eq!(tokens(&pointer).collect::<Vec<_>>(), names);
            let last = split(&pointer).map(|(_, last)| last);
            assert_eq!(last.as_deref(), names.last().copied());
        }
        assert_eq!(["0", "12", "01", "-", "", "+1"].map(index), [Some(0), Some(12), None, None, None, None]);
    }
}
