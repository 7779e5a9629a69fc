//! Where a place is after an edit: pointers into a document are adjusted when items before them are added, removed or
//! moved.

use json_patch::PatchOperation;
use serde_json::Value;

use super::{Document, Edit};
use crate::base::pointer::{self, Pointer};

impl Edit {
    /// Where the place at `pointer` is after this edit, which led to `after`; `None` if it was removed.
    pub fn follow(&self, after: &Document, pointer: &str) -> Option<String> {
        let item = |path: &str| {
            let (list, last) = Pointer(path).split()?;
            let is_list = after.json().pointer(list).is_some_and(Value::is_array);
            Some((list.to_owned(), pointer::index(&last).filter(|_| is_list)?))
        };
        let added = |place: String, path: &str| match item(path) {
            Some((list, index)) => shifted(&place, &list, |i| if i >= index { i + 1 } else { i }),
            None => place,
        };
        let removed = |place: String, path: &str| match item(path) {
            Some((list, index)) => shifted(&place, &list, |i| if i > index { i - 1 } else { i }),
            None => place,
        };
        self.0.iter().try_fold(pointer.to_owned(), |place, operation| {
            let path = operation.path().as_str();
            match operation {
                PatchOperation::Add(_) | PatchOperation::Copy(_) => Some(added(place, path)),
                PatchOperation::Remove(_) => (!Pointer(&place).is_within(path)).then(|| removed(place, path)),
                PatchOperation::Move(one) => {
                    let from = one.from.as_str();
                    if Pointer(&place).is_within(from) {
                        return Some(format!("{path}{}", &place[from.len()..]));
                    }
                    Some(added(removed(place, from), path))
                }
                PatchOperation::Replace(_) | PatchOperation::Test(_) => Some(place),
            }
        })
    }
}

/// `place` with its index in `list` changed, if it is in that list.
fn shifted(place: &str, list: &str, index: impl Fn(usize) -> usize) -> String {
    match Pointer(place).item_of(list) {
        Some((old, way)) => format!("{list}/{}{way}", index(old)),
        None => place.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_go_along() {
        let scene = Document::parse(include_str!("../../tests/scenes/good/squint.plica.json")).unwrap();
        let zone = "/layers/0/zones/0";
        let item = |i: usize| format!("{zone}/motion/{i}");
        for (edit, from, to) in [
            (Edit::duplicate(&scene, &item(0)).unwrap().0, item(1) + "/at", Some(item(2) + "/at")),
            (Edit::duplicate(&scene, &item(1)).unwrap().0, item(1), Some(item(1))),
            (Edit::remove(&item(0)), item(1), Some(item(0))),
            (Edit::remove(&item(0)), item(0) + "/at", None),
            (Edit::move_item(&scene, &item(1), 0).unwrap().0, item(1) + "/at", Some(item(0) + "/at")),
            (Edit::move_item(&scene, &item(1), 0).unwrap().0, item(0), Some(item(1))),
            (Edit::remove(&item(0)), format!("{zone}/speed"), Some(format!("{zone}/speed"))),
        ] {
            let after = scene.apply(&edit).unwrap();
            assert_eq!(edit.follow(&after, &from), to, "{edit:?} {from}");
        }
    }
}
