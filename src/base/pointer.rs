//! JSON pointers (RFC 6901): the addresses of problems, fields and edits. Whoever keeps one keeps it as text, as it
//! stands in messages and in patches; [`Pointer`] is how it is read.

use std::fmt::Display;

/// A JSON pointer: nothing for the whole document, else `/` and a token for each step down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pointer<'a>(pub &'a str);

impl<'a> Pointer<'a> {
    /// The tokens, unescaped. The empty pointer has none.
    pub fn tokens(self) -> impl Iterator<Item = String> + 'a {
        self.0.split('/').skip(1).map(unescaped)
    }

    /// How many tokens it has.
    pub fn depth(self) -> usize {
        self.0.matches('/').count()
    }

    /// The pointer one step deeper.
    pub fn join(self, token: impl Display) -> String {
        let mut joined = self.0.to_owned();
        push(&mut joined, &token.to_string());
        joined
    }

    /// The first token, and the way from there; `None` for the whole document.
    pub fn first(self) -> Option<(String, &'a str)> {
        let rest = self.0.strip_prefix('/')?;
        let (token, way) = rest.split_at(rest.find('/').unwrap_or(rest.len()));
        Some((unescaped(token), way))
    }

    /// The pointer to the parent, and the last token; `None` for the whole document.
    pub fn split(self) -> Option<(&'a str, String)> {
        let (parent, last) = self.0.rsplit_once('/')?;
        Some((parent, unescaped(last)))
    }

    /// The pointer to the parent; `None` for the whole document.
    pub fn parent(self) -> Option<&'a str> {
        self.0.rsplit_once('/').map(|(parent, _)| parent)
    }

    /// The pointer and its ancestors, the innermost first.
    pub fn upward(self) -> impl Iterator<Item = &'a str> {
        std::iter::successors(Some(self.0), |pointer| Pointer(pointer).parent())
    }

    /// The way from `outer` to here, itself a pointer; `None` if this is neither `outer` nor below it.
    pub fn below(self, outer: &str) -> Option<&'a str> {
        self.0.strip_prefix(outer).filter(|rest| rest.is_empty() || rest.starts_with('/'))
    }

    /// The way as people write it, with dots: `layers.0.zones`. Nothing for the whole document.
    pub fn dotted(self) -> String {
        self.tokens().map(|token| spelled(&token, false)).collect::<Vec<_>>().join(".")
    }

    /// Whether this is `outer` or below it.
    pub fn is_within(self, outer: &str) -> bool {
        self.below(outer).is_some()
    }

    /// Whether this is below `outer`.
    pub fn is_inside(self, outer: &str) -> bool {
        self.below(outer).is_some_and(|way| !way.is_empty())
    }

    /// The index of the item of `list` that this is.
    pub fn item(self, list: &str) -> Option<usize> {
        self.item_of(list).filter(|(_, way)| way.is_empty()).map(|(index, _)| index)
    }

    /// The index of the item of `list` that this is or is in, and the way from that item to here.
    pub fn item_of(self, list: &str) -> Option<(usize, &'a str)> {
        let (token, way) = Pointer(self.below(list)?).first()?;
        Some((index(&token)?, way))
    }
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

/// A name as people write it: in quotes if it needs them, as one does that begins with a digit where that would be an
/// index.
pub fn spelled(name: &str, in_list: bool) -> String {
    let plain = !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || "-_+".contains(c));
    // In a list digits are an index, and - is the place after the last.
    if plain && !(in_list && (name == "-" || name.starts_with(|c: char| c.is_ascii_digit()))) {
        return name.to_owned();
    }
    format!("\"{}\"", name.replace('\\', "\\\\").replace('"', "\\\""))
}

/// A token as an index of a list: digits, no leading zero.
pub fn index(token: &str) -> Option<usize> {
    let plain = token.bytes().all(|b| b.is_ascii_digit()) && (token == "0" || !token.starts_with('0'));
    plain.then(|| token.parse().ok()).flatten()
}

fn unescaped(token: &str) -> String {
    if token.contains('~') { token.replace("~1", "/").replace("~0", "~") } else { token.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back() {
        for names in [vec![], vec![""], vec!["a", "b/c", "d~e", "~1"]] {
            let pointer = names.iter().fold(String::new(), |pointer, name| Pointer(&pointer).join(name));
            assert_eq!(Pointer(&pointer).tokens().collect::<Vec<_>>(), names);
            let last = Pointer(&pointer).split().map(|(_, last)| last);
            assert_eq!(last.as_deref(), names.last().copied());
            assert_eq!(Pointer(&pointer).upward().count(), names.len() + 1);
        }
        assert_eq!(["0", "12", "01", "-", "", "+1"].map(index), [Some(0), Some(12), None, None, None, None]);
    }

    #[test]
    fn people_write_dots() {
        for (pointer, dotted) in [
            ("", ""),
            ("/layers", "layers"),
            ("/layers/0/a b", "layers.0.\"a b\""),
            ("/a~1b/c\"d", "\"a/b\".\"c\\\"d\""),
        ] {
            assert_eq!(Pointer(pointer).dotted(), dotted, "{pointer}");
        }
    }

    #[test]
    fn what_is_in_what() {
        for (inner, outer, way) in [
            ("/a/1/b", "/a", Some("/1/b")),
            ("/a", "/a", Some("")),
            ("/ab", "/a", None),
            ("/a", "", Some("/a")),
            ("", "/a", None),
        ] {
            assert_eq!(Pointer(inner).below(outer), way, "{inner} in {outer}");
            assert_eq!(Pointer(inner).is_inside(outer), inner != outer && way.is_some(), "{inner} in {outer}");
        }
        for (inner, item) in [
            ("/a/1/b", Some((1, "/b"))),
            ("/a/20", Some((20, ""))),
            ("/a", None),
            ("/a/-", None),
            ("/a/x/b", None),
            ("/b/1", None),
        ] {
            assert_eq!(Pointer(inner).item_of("/a"), item, "{inner}");
            let whole = item.filter(|(_, way)| way.is_empty()).map(|(index, _)| index);
            assert_eq!(Pointer(inner).item("/a"), whole, "{inner}");
        }
    }
}
