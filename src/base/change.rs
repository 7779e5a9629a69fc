//! What differs between two JSON values, found in one walk over both, so that what comes after an edit (checks, reading
//! into types) looks only where something has changed.

use serde_json::{Map, Value};

/// How a value differs from the one that stood in its place.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// Identical, byte for byte, including key order.
    Same,
    /// It is another value.
    Other,
    /// An object of which these fields differ: changed, added (absent from the old one) or removed.
    Fields(Vec<(String, Change)>),
    /// A list that differs in one stretch.
    Items(Items),
}

/// How a list differs: the same items at both ends, others between.
#[derive(Clone, Debug, PartialEq)]
pub struct Items {
    /// So many items at the beginning are the old ones.
    pub ahead: usize,
    /// And so many at the end.
    pub behind: usize,
    /// The new list's items between, against the old ones at the same places; [`Change::Other`] where there are none.
    pub between: Vec<Change>,
}

impl Change {
    /// What makes `new` of `old`.
    pub fn of(old: &Value, new: &Value) -> Change {
        match (old, new) {
            (Value::Object(old), Value::Object(new)) => fields(old, new),
            (Value::Array(old), Value::Array(new)) => items(old, new),
            _ if old == new => Change::Same,
            _ => Change::Other,
        }
    }

    /// How the field `name` of an object differs.
    pub fn field(&self, name: &str) -> &Change {
        match self {
            Change::Same => &Change::Same,
            Change::Fields(fields) => fields.iter().find(|(key, _)| key == name).map_or(&Change::Same, |(_, one)| one),
            _ => &Change::Other,
        }
    }
}

impl Items {
    /// The items that may differ, each with its place in the new list.
    pub fn each(&self) -> impl Iterator<Item = (usize, &Change)> {
        self.between.iter().enumerate().map(|(i, change)| (self.ahead + i, change))
    }
}

/// Whether two values are the same byte for byte, including key order (`==` on objects does not look at it).
pub fn same(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Object(a), Value::Object(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|((ka, a), (kb, b))| ka == kb && same(a, b))
        }
        (Value::Array(a), Value::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b)),
        (a, b) => a == b,
    }
}

/// How many items at the beginning of two lists are the same, and how many of the others at the end.
pub fn same_ends(old: &[Value], new: &[Value]) -> (usize, usize) {
    let ahead = old.iter().zip(new).take_while(|(old, new)| same(old, new)).count();
    let least = old.len().min(new.len()) - ahead;
    let behind = old.iter().rev().zip(new.iter().rev()).take(least).take_while(|(old, new)| same(old, new)).count();
    (ahead, behind)
}

fn fields(old: &Map<String, Value>, new: &Map<String, Value>) -> Change {
    let mut changed = Vec::new();
    let mut note = |key: &String, change: Change| {
        if change != Change::Same {
            changed.push((key.clone(), change));
        }
    };
    if old.keys().eq(new.keys()) {
        old.iter().zip(new).for_each(|((key, old), (_, new))| note(key, Change::of(old, new)));
    } else {
        let kept = |a: &Map<String, Value>, b: &Map<String, Value>| -> Vec<String> {
            a.keys().filter(|key| b.contains_key(*key)).cloned().collect()
        };
        if kept(old, new) != kept(new, old) {
            return Change::Other;
        }
        old.keys().filter(|key| !new.contains_key(*key)).for_each(|key| note(key, Change::Other));
        new.iter().for_each(|(key, new)| note(key, old.get(key).map_or(Change::Other, |old| Change::of(old, new))));
    }
    if changed.is_empty() { Change::Same } else { Change::Fields(changed) }
}

/// Every item is looked at once: an edit of one among ten thousand is found by one walk.
fn items(old: &[Value], new: &[Value]) -> Change {
    if old.len() != new.len() {
        let (ahead, behind) = same_ends(old, new);
        let old = &old[ahead..old.len() - behind];
        let new = new[ahead..new.len() - behind].iter().enumerate();
        let between = new.map(|(i, new)| old.get(i).map_or(Change::Other, |old| Change::of(old, new))).collect();
        return Change::Items(Items { ahead, behind, between });
    }
    let mut between: Vec<Change> = old.iter().zip(new).map(|(old, new)| Change::of(old, new)).collect();
    let is_same = |change: &&Change| **change == Change::Same;
    let ahead = between.iter().take_while(is_same).count();
    if ahead == new.len() {
        return Change::Same;
    }
    let behind = between.iter().rev().take_while(is_same).count();
    between.truncate(new.len() - behind);
    Change::Items(Items { ahead, behind, between: between.split_off(ahead) })
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn only_what_differs_is_told() {
        let old = json!({ "a": 1, "b": [1, 2, 3, 4], "c": { "d": "x", "e": null } });
        let changed = |path: &str, value: Value| {
            let mut new = old.clone();
            *new.pointer_mut(path).unwrap() = value;
            Change::of(&old, &new)
        };
        let field = |name: &str, change| Change::Fields(vec![(name.to_owned(), change)]);
        let items =
            |ahead, behind, between: &[Change]| Change::Items(Items { ahead, behind, between: between.to_vec() });
        let other = || Change::Other;
        assert_eq!(Change::of(&old, &old), Change::Same);
        assert_eq!(changed("/a", json!(2)), field("a", other()));
        assert_eq!(changed("/c/d", json!("y")), field("c", field("d", other())));
        assert_eq!(changed("/b/2", json!(9)), field("b", items(2, 1, &[other()])));
        assert_eq!(changed("/b", json!([1, 2, 4])), field("b", items(2, 1, &[])));
        assert_eq!(changed("/b", json!([1, 2, 2, 3, 4])), field("b", items(2, 2, &[other()])));
        assert_eq!(
            changed("/b", json!([0, 2, 5, 0, 4])),
            field("b", items(0, 1, &[other(), Change::Same, other(), other()]))
        );
        assert_eq!(changed("/c", json!({ "e": null })), field("c", field("d", other())));
        assert_eq!(changed("/c", json!({ "e": null, "d": "x" })), field("c", other()));
        assert_eq!(changed("/a", json!(1.0)), field("a", other()));
    }
}
