//! Completion of addresses, for people who type them.

use std::collections::BTreeSet;

use serde_json::Value;

use super::field::Kind;
use super::{Document, address, field, named};
use crate::base::pointer::Pointer;

/// As [`paths`], where one that begins with a dot is looked for around the place `here`.
pub fn paths_around(document: &Document, here: &str, typed: &str) -> Vec<String> {
    let Some(way) = typed.strip_prefix('.') else { return paths(document, typed) };
    let (parent, _) = way.split_at(last_step(way));
    let holders: Vec<String> = match parent.strip_suffix('.') {
        None => Pointer(here).upward().map(|at| address::address(document, at)).collect(),
        Some(parent) => address::around(document, here, &format!(".{parent}")).into_iter().collect(),
    };
    let all = holders.iter().flat_map(|holder| {
        let whole = |way: &str| if holder.is_empty() { way.to_owned() } else { format!("{holder}.{way}") };
        let begin = whole("").len();
        let found = paths(document, &whole(&way[parent.len()..])).into_iter();
        found.map(move |path| format!(".{parent}{}", &path[begin..]))
    });
    let mut seen = BTreeSet::new();
    all.filter(|path| seen.insert(path.clone())).collect()
}

/// The paths of the scene that continue `typed` by one name.
pub fn paths(document: &Document, typed: &str) -> Vec<String> {
    if typed.contains('=') {
        return Vec::new();
    }
    let (parent, last) = typed.split_at(last_step(typed));
    let pointer = match parent.trim_end_matches('.') {
        "" => Some(String::new()),
        // With a `*`, the first place that it means stands for all.
        parent => address::resolve_all(document, parent).ok().and_then(|all| all.into_iter().next()),
    };
    let holder = pointer.as_deref().map(|pointer| address::address(document, pointer)).unwrap_or_default();
    let children = pointer.map(|pointer| below(document, &pointer)).unwrap_or_default();
    // The name as an address spells it, with quotes if it has spaces.
    let name = |child: String| {
        let whole = address::address(document, &child);
        whole.strip_prefix(holder.as_str()).unwrap_or(&whole).trim_start_matches('.').to_owned()
    };
    let begins = |name: &String| name.trim_start_matches('"').starts_with(last.trim_start_matches('"'));
    children.into_iter().map(name).filter(begins).map(|name| format!("{parent}{name}")).collect()
}

/// The values that what is typed as `PATH=VALUE` may end with, if there are only some.
pub fn values(document: &Document, typed: &str) -> Vec<String> {
    let Some((path, value)) = typed.split_once('=') else { return Vec::new() };
    let pointer = address::resolve_all(document, path).ok().and_then(|all| all.into_iter().next());
    let kind = pointer.and_then(|pointer| field::field(document, &pointer)).map(|field| field.kind);
    let known: Vec<String> = match kind {
        Some(Kind::Choice(words) | Kind::Tagged { variants: words, .. }) => {
            words.into_iter().map(|word| word.name.to_owned()).collect()
        }
        Some(Kind::Reference(list)) => match document.json().get(list) {
            Some(Value::Object(named)) => named.keys().cloned().collect(),
            Some(Value::Array(items)) => items.iter().filter_map(|item| named::name_of(Some(item))).collect(),
            _ => Vec::new(),
        },
        Some(Kind::Bool) => vec!["true".into(), "false".into()],
        Some(Kind::Number { .. } | Kind::Numbers(_) | Kind::Text | Kind::List(_) | Kind::Map(_)) => Vec::new(),
        Some(Kind::Object) | None => Vec::new(),
    };
    known.into_iter().filter(|name| name.starts_with(value)).collect()
}

/// The places directly below a place, also those that stand there though they are not written.
fn below(document: &Document, pointer: &str) -> Vec<String> {
    let children = || match field::standing(document, pointer) {
        Some(place) => field::below(place, pointer).into_iter().map(|(child, _)| child.pointer).collect(),
        None => Vec::new(),
    };
    let laid = field::laid(document, pointer);
    laid.map_or_else(children, |tokens| tokens.iter().map(|token| Pointer(pointer).join(token)).collect())
}

/// Where the last step of an address begins: after the last dot outside quotes.
fn last_step(typed: &str) -> usize {
    let mut inside = false;
    let dots = typed.char_indices().filter(|&(_, c)| {
        inside ^= c == '"';
        c == '.' && !inside
    });
    dots.last().map_or(0, |(at, _)| at + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_go_on_by_one_name() {
        let text = r#"{ "plica": 1, "layers": [{ "kind": "fill", "name": "dark ground" }, { "kind": "fill", "name": "light" }] }"#;
        let document = Document::parse(text).unwrap();
        for (typed, expected) in [
            ("lay", vec!["layers"]),
            ("layers.", vec!["layers.\"dark ground\"", "layers.light"]),
            ("layers.l", vec!["layers.light"]),
            ("layers.*.co", vec!["layers.*.color"]),
            ("layers.light.color=", vec![]),
            ("nowhere.", vec![]),
        ] {
            assert_eq!(paths(&document, typed), expected, "{typed}");
        }
        for (typed, expected) in [
            (".col", vec![".color"]),
            (".ti", vec![".title", ".timeline"]),
            (".timeline.f", vec![".timeline.fps"]),
            (".nowhere.", vec![]),
            ("lay", vec!["layers"]),
        ] {
            assert_eq!(paths_around(&document, "/layers/1/name", typed), expected, "{typed}");
        }
        assert_eq!(values(&document, "layers.light.gradient="), Vec::<String>::new());
    }
}
