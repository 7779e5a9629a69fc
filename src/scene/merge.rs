//! Merges two versions of a scene that come from the same one: what only one of them changed is taken from it, what
//! both changed is a conflict. Values are compared, not patches: an item added to a list does not shift the other
//! side's changes after it.

use serde_json::{Map, Value};

use super::json;
use super::named::name_of;
use crate::base::change::same_ends;
use crate::base::pointer::Pointer;

/// One of the two versions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The version that is here.
    Mine,
    /// The version that somebody else made.
    Theirs,
}

/// A place that both sides changed, each in its own way.
#[derive(Clone, Debug, PartialEq)]
pub struct Conflict {
    /// Where it is in the version that is here.
    pub pointer: String,
    /// The value in the version that is here; `None` if it was removed.
    pub mine: Option<Value>,
    /// The value on the other side; `None` if it was removed.
    pub theirs: Option<Value>,
}

/// The result of merging two versions.
#[derive(Clone, Debug, PartialEq)]
pub struct Merged {
    /// The JSON; it may contain errors.
    pub json: Value,
    /// Where one side was overruled.
    pub conflicts: Vec<Conflict>,
}

/// Merges two versions of `base`; without a base, every difference is a conflict. In conflicts `prefer` wins.
pub fn merge(base: Option<&Value>, mine: &Value, theirs: &Value, prefer: Side) -> Merged {
    let mut merger = Merger { prefer, conflicts: Vec::new() };
    let json = merger.value(base, Some(mine), Some(theirs), "").unwrap_or(Value::Null);
    Merged { json, conflicts: merger.conflicts }
}

struct Merger {
    prefer: Side,
    conflicts: Vec<Conflict>,
}

/// The three versions of a list.
struct Lists<'a> {
    base: &'a [Value],
    mine: &'a [Value],
    theirs: &'a [Value],
}

impl Merger {
    fn value(&mut self, base: Option<&Value>, mine: Option<&Value>, theirs: Option<&Value>, at: &str) -> Option<Value> {
        if same(mine, theirs) || same(base, theirs) {
            return mine.cloned();
        }
        if same(base, mine) {
            return theirs.cloned();
        }
        match (base, mine, theirs) {
            (_, Some(Value::Object(mine)), Some(Value::Object(theirs))) => {
                return Some(Value::Object(self.object(base.and_then(Value::as_object), mine, theirs, at)));
            }
            (Some(Value::Array(base)), Some(Value::Array(mine)), Some(Value::Array(theirs))) => {
                if let Some(items) = self.list(&Lists { base, mine, theirs }, at) {
                    return Some(Value::Array(items));
                }
            }
            _ => {}
        }
        self.conflicts.push(Conflict { pointer: at.to_owned(), mine: mine.cloned(), theirs: theirs.cloned() });
        match self.prefer {
            Side::Mine => mine.cloned(),
            Side::Theirs => theirs.cloned(),
        }
    }

    /// Merges objects: keys in the order of `mine`, those only in `theirs` at the end.
    fn object(
        &mut self,
        base: Option<&Map<String, Value>>,
        mine: &Map<String, Value>,
        theirs: &Map<String, Value>,
        at: &str,
    ) -> Map<String, Value> {
        let mut merged = Map::new();
        for key in mine.keys().chain(theirs.keys().filter(|&key| !mine.contains_key(key))) {
            let old = base.and_then(|base| base.get(key));
            if let Some(value) = self.value(old, mine.get(key), theirs.get(key), &Pointer(at).join(key)) {
                merged.insert(key.clone(), value);
            }
        }
        merged
    }

    /// Merges lists; `None` if they cannot be merged.
    fn list(&mut self, lists: &Lists, at: &str) -> Option<Vec<Value>> {
        // Coordinates are changed together.
        if lists.mine.iter().chain(lists.theirs).any(Value::is_number) {
            return None;
        }
        if lists.mine.len() == lists.base.len() && lists.theirs.len() == lists.base.len() {
            return Some(self.items(lists, at));
        }
        self.named(lists, at).or_else(|| beside(lists))
    }

    /// Merges lists of the same length item by item.
    fn items(&mut self, lists: &Lists, at: &str) -> Vec<Value> {
        let triples = lists.base.iter().zip(lists.mine).zip(lists.theirs).enumerate();
        triples
            .filter_map(|(i, ((base, mine), theirs))| {
                self.value(Some(base), Some(mine), Some(theirs), &Pointer(at).join(i))
            })
            .collect()
    }

    /// Merges lists of named things by name, in the order of `mine`; what `theirs` added goes after the same item as
    /// there.
    fn named(&mut self, lists: &Lists, at: &str) -> Option<Vec<Value>> {
        let (base, mine, theirs) = (names(lists.base)?, names(lists.mine)?, names(lists.theirs)?);
        let find = |names: &[String], items: &[Value], name: &String| {
            names.iter().position(|one| one == name).map(|i| items[i].clone())
        };
        let mut order = mine.clone();
        for (i, name) in theirs.iter().enumerate().filter(|(_, name)| !mine.contains(name)) {
            let before = i.checked_sub(1).and_then(|i| order.iter().position(|one| *one == theirs[i]));
            order.insert(before.map_or(0, |at| at + 1), name.clone());
        }
        let merged = order.iter().filter_map(|name| {
            let here = mine.iter().position(|one| one == name).unwrap_or(lists.mine.len());
            let one = |names: &[String], items: &[Value]| find(names, items, name);
            let (base, mine) = (one(&base, lists.base), one(&mine, lists.mine));
            let theirs = one(&theirs, lists.theirs);
            self.value(base.as_ref(), mine.as_ref(), theirs.as_ref(), &Pointer(at).join(here))
        });
        Some(merged.collect())
    }
}

/// Merges lists that each side changed in one stretch, apart from the other's. `None` if the stretches meet.
fn beside(lists: &Lists) -> Option<Vec<Value>> {
    let (mine, theirs) = (Stretch::of(lists.base, lists.mine), Stretch::of(lists.base, lists.theirs));
    let apart = |a: &Stretch, b: &Stretch| a.end < b.start || (a.end == b.start && a.start < b.end);
    let (first, second) = if apart(&mine, &theirs) {
        (&mine, &theirs)
    } else if apart(&theirs, &mine) {
        (&theirs, &mine)
    } else {
        return None;
    };
    let base = lists.base;
    let parts = [&base[..first.start], first.new, &base[first.end..second.start], second.new, &base[second.end..]];
    Some(parts.concat())
}

/// The stretch of a list that a version changed, and what is there now.
struct Stretch<'a> {
    start: usize,
    end: usize,
    new: &'a [Value],
}

impl<'a> Stretch<'a> {
    fn of(base: &[Value], version: &'a [Value]) -> Stretch<'a> {
        let (start, behind) = same_ends(base, version);
        Stretch { start, end: base.len() - behind, new: &version[start..version.len() - behind] }
    }
}

/// The names of all items; `None` if one has no name or two have the same.
fn names(items: &[Value]) -> Option<Vec<String>> {
    let names: Vec<String> = items.iter().map(|item| name_of(Some(item))).collect::<Option<_>>()?;
    let unique = names.iter().enumerate().all(|(i, name)| !names[..i].contains(name));
    unique.then_some(names)
}

fn same(a: Option<&Value>, b: Option<&Value>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => json::same(a, b),
        (a, b) => a.is_none() && b.is_none(),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn what_does_not_meet_goes_together() {
        let zone = |name: &str, radius: i32| json!({ "name": name, "radius": radius });
        for (what, base, mine, theirs, merged) in [
            ("nothing changed", json!(1), json!(1), json!(1), json!(1)),
            ("mine alone", json!(1), json!(2), json!(1), json!(2)),
            ("theirs alone", json!(1), json!(1), json!(2), json!(2)),
            ("both alike", json!(1), json!(2), json!(2), json!(2)),
            (
                "two keys",
                json!({"a": 1, "b": 1}),
                json!({"a": 2, "b": 1}),
                json!({"a": 1, "b": 2}),
                json!({"a": 2, "b": 2}),
            ),
            ("a key each", json!({}), json!({"a": 1}), json!({"b": 2}), json!({"a": 1, "b": 2})),
            ("one away", json!({"a": 1, "b": 1}), json!({"b": 1}), json!({"a": 1, "b": 2}), json!({"b": 2})),
            (
                "two points",
                json!([[1, 1], [2, 2]]),
                json!([[9, 1], [2, 2]]),
                json!([[1, 1], [2, 8]]),
                json!([[9, 1], [2, 8]]),
            ),
            (
                "a zone added, another changed",
                json!([zone("a", 1), zone("b", 1)]),
                json!([zone("a", 2), zone("b", 1)]),
                json!([zone("a", 1), zone("new", 5), zone("b", 1)]),
                json!([zone("a", 2), zone("new", 5), zone("b", 1)]),
            ),
            (
                "a zone away, another changed",
                json!([zone("a", 1), zone("b", 1)]),
                json!([zone("b", 1)]),
                json!([zone("a", 1), zone("b", 3)]),
                json!([zone("b", 3)]),
            ),
            (
                "an anchor added, one changed",
                json!([[1, 1], [2, 2]]),
                json!([[1, 1], [2, 2], [3, 3]]),
                json!([[9, 9], [2, 2]]),
                json!([[9, 9], [2, 2], [3, 3]]),
            ),
        ] {
            let merged = Merged { json: merged, conflicts: Vec::new() };
            assert_eq!(merge(Some(&base), &mine, &theirs, Side::Mine), merged, "{what}");
        }
    }

    #[test]
    fn what_meets_is_a_conflict_and_one_side_gives_way() {
        let zone = |radius: i32| json!([{ "name": "a", "radius": radius }, { "name": "b" }]);
        for (what, base, mine, theirs, at) in [
            ("a number", json!(1), json!(2), json!(3), ""),
            ("a key", json!({"a": 1}), json!({"a": 2}), json!({"a": 3}), "/a"),
            ("away and changed", json!({"a": 1}), json!({}), json!({"a": 3}), "/a"),
            ("one point", json!([[1, 1]]), json!([[2, 1]]), json!([[1, 2]]), "/0"),
            ("the same place of a list", json!([]), json!([[1, 1]]), json!([[2, 2]]), ""),
            ("a zone away and changed", zone(1), json!([{ "name": "b" }]), zone(2), "/1"),
        ] {
            for (prefer, winner) in [(Side::Mine, &mine), (Side::Theirs, &theirs)] {
                let merged = merge(Some(&base), &mine, &theirs, prefer);
                assert_eq!((&merged.json, merged.conflicts.len()), (winner, 1), "{what}");
                assert_eq!(merged.conflicts[0].pointer, at, "{what}");
            }
        }
        assert_eq!(merge(None, &json!({"a": 1, "b": 2}), &json!({"a": 1, "b": 3}), Side::Mine).conflicts.len(), 1);
    }
}
