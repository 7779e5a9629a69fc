//! Only what an edit changes is checked and read again: the result must be that of checking the whole.

use proptest::prelude::*;
use serde_json::{Value, json};

use super::*;
use crate::base::pointer::Pointer;
use crate::base::problem::{Problem, Severity};

/// Every place in a value.
fn places(value: &Value, path: &str, all: &mut Vec<String>) {
    all.push(path.to_owned());
    match value {
        Value::Object(map) => map.iter().for_each(|(key, value)| places(value, &Pointer(path).join(key), all)),
        Value::Array(items) => items.iter().enumerate().for_each(|(i, item)| places(item, &Pointer(path).join(i), all)),
        _ => {}
    }
}

/// One operation made from random numbers: what is done, where, and with which value.
fn operation(json: &Value, (what, at, from): (usize, usize, usize)) -> Edit {
    let mut all = Vec::new();
    places(json, "", &mut all);
    let at = &all[at % all.len()];
    let other = &all[from % all.len()];
    let words = [json!(null), json!(-1), json!(0.5), json!("return"), json!({}), json!([]), json!("b"), json!(1e6)];
    let word = words[from % words.len()].clone();
    let found = || json.pointer(other).cloned().unwrap_or_default();
    match what % 8 {
        0 | 1 => Edit::replace(at, word),
        2 => Edit::replace(at, found()),
        3 | 4 => Edit::remove(at),
        5 => Edit::add(at, found()),
        6 => Edit::add(&Pointer(at).join(["-", "0", "name", "fold", "speed", "at"][from % 6]), found()),
        _ => Edit::moved(other, at),
    }
}

/// The result of checking the whole document after an edit.
fn whole(document: &Document, edit: &Edit) -> Result<Document, Vec<Problem>> {
    let mut json = document.json().clone();
    edit.patch(&mut json).map_err(|problem| vec![problem])?;
    Document::from_json(json).map_err(|mut problems| {
        problems.retain(|problem| problem.severity == Severity::Error);
        problems
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn an_edit_is_checked_as_the_whole_would_be(
        large: bool,
        edits in prop::collection::vec(prop::collection::vec(any::<(usize, usize, usize)>(), 1..3), 1..12),
    ) {
        let mut document = if large { everything() } else { squint() };
        for operations in edits {
            let edit = Edit::all(operations.into_iter().map(|one| operation(document.json(), one)));
            match (document.apply(&edit), whole(&document, &edit)) {
                (Ok(found), Ok(expected)) => {
                    prop_assert_eq!(found.scene(), expected.scene(), "{:?}", edit);
                    prop_assert_eq!(found.warnings(), expected.warnings(), "{:?}", edit);
                    prop_assert!(json::same(found.json(), expected.json()));
                    document = found;
                }
                (Err(found), Err(expected)) => prop_assert_eq!(found, expected, "{:?}", edit),
                // The only thing that can be read but not edited.
                (Err(found), Ok(expected)) if expected.json()["plica"] != document.json()["plica"] => {
                    prop_assert_eq!(&found[0].path, "/plica");
                }
                (found, expected) => prop_assert!(false, "{edit:?}\n{found:?}\n{expected:?}"),
            }
        }
    }
}
