//! History: steps, the saved mark, held keys, times.

use serde_json::json;

use super::*;

fn feather(history: &mut History, value: i32, time_ms: u64, held: bool) -> history::Applied {
    let edit = Edit::set(history.document(), "/layers/0/zones/0/feather", json!(value));
    history.apply(edit, Stamp { time_ms, held }).unwrap().unwrap()
}

fn now(history: &History) -> f64 {
    history.document().json().pointer("/layers/0/zones/0/feather").unwrap().as_f64().unwrap()
}

#[test]
fn a_held_key_is_one_step() {
    let mut history = History::new(squint());
    feather(&mut history, 5, 1, false);
    for (i, value) in (6..30).enumerate() {
        assert_eq!(feather(&mut history, value, 2 + i as u64, true).step, 0);
    }
    assert_eq!((history.revision(), history.depth()), (25, (1, 0)));
    // Another field, or a key that was released, begins another step.
    let edit = Edit::set(history.document(), "/layers/0/zones/0/speed", json!(2));
    assert_eq!(history.apply(edit, Stamp { time_ms: 40, held: true }).unwrap().unwrap().step, 1);
    feather(&mut history, 40, 41, true);
    history.close_step();
    assert_eq!(feather(&mut history, 41, 42, true).step, 3);
    for expected in [40.0, 29.0, 29.0, 4.0] {
        history.undo().unwrap();
        assert_eq!(now(&history), expected);
    }
    assert!(history.undo().is_none());
    assert_eq!(history.document().to_text(), squint().to_text());
    history.redo().unwrap();
    assert_eq!(now(&history), 29.0);
    // What was undone and redone is closed.
    assert_ne!(feather(&mut history, 50, 60, true).step, 0);
}

#[test]
fn the_saved_mark_follows_undo() {
    let mut history = History::new(squint());
    assert!(history.is_saved());
    feather(&mut history, 5, 1, false);
    assert!(!history.is_saved());
    history.mark_saved();
    feather(&mut history, 6, 2, true);
    assert_eq!((history.is_saved(), history.depth()), (false, (2, 0)));
    history.undo();
    assert!(history.is_saved());
    history.undo();
    assert!(!history.is_saved());
    history.redo();
    assert!(history.is_saved());
    history.undo();
    feather(&mut history, 7, 3, false);
    history.undo();
    history.redo();
    assert!(!history.is_saved());
    history.mark_unsaved();
    history.undo();
    assert!(!history.is_saved());
}

#[test]
fn earlier_and_later_go_by_time() {
    let mut history = History::new(squint());
    for value in 1..=5 {
        feather(&mut history, value * 10, value as u64 * 1000, false);
    }
    assert_eq!((history.earlier(3500).len(), now(&history)), (2, 30.0));
    assert_eq!((history.earlier(0).len(), now(&history)), (3, 4.0));
    assert_eq!((history.later(2000).len(), now(&history)), (2, 20.0));
    assert_eq!(history.revision(), 12);
}

#[test]
fn undo_is_a_tree_and_time_goes_through_all_of_it() {
    let mut history = History::new(squint());
    // As in vim's manual: three edits, three undos, three other edits.
    for value in [10, 20, 30] {
        feather(&mut history, value, value as u64, false);
    }
    (0..3).for_each(|_| drop(history.undo().unwrap()));
    for value in [40, 50, 60] {
        feather(&mut history, value, value as u64, false);
    }
    assert_eq!((history.state(), history.newest(), history.depth()), (6, 6, (3, 0)));
    for (state, value, way) in [(5, 50.0, 1), (4, 40.0, 1), (3, 30.0, 4), (2, 20.0, 1), (1, 10.0, 1), (0, 4.0, 1)] {
        assert_eq!((history.go_to(state).len(), now(&history), history.state()), (way, value, state));
    }
    // Redo goes along the branch that was left last.
    history.redo().unwrap();
    assert_eq!((now(&history), history.depth()), (10.0, (1, 2)));
    history.undo();
    history.go_to(6);
    (0..3).for_each(|_| drop(history.undo().unwrap()));
    history.redo().unwrap();
    assert_eq!(now(&history), 40.0);
    // By time, from one branch to the other.
    assert_eq!((history.earlier(35).len(), now(&history)), (4, 30.0));
    assert_eq!((history.later(55).len(), now(&history)), (5, 50.0));
    assert!(history.go_to(7).is_empty() && history.state() == 5);
    let told: Vec<_> = history.told_aside(9).into_iter().map(|told| (told.before, told.state, told.words)).collect();
    let words = |from: i32, to: i32| format!("left eye · feather {from} → {to}");
    assert_eq!(told, [(0, 1, words(4, 10)), (1, 2, words(10, 20)), (2, 3, words(20, 30))]);
    assert_eq!(history.told_aside(2).len(), 2);
    history.go_to(2);
    let told: Vec<_> = history.told_aside(9).into_iter().map(|told| told.state).collect();
    assert_eq!((told, history.depth()), (vec![4, 5, 6], (2, 1)));
}

#[test]
fn the_version_of_the_format_is_not_for_editing() {
    for value in [json!(2), json!(0), json!(1.0), json!("1"), json!(null)] {
        for edit in [
            Edit::set(&squint(), "/plica", value.clone()),
            Edit::remove("/plica"),
            Edit::replace("", {
                let mut all = squint().json().clone();
                all["plica"] = value;
                all
            }),
        ] {
            let problems = squint().apply(&edit).unwrap_err();
            assert!(problems.iter().any(|problem| problem.to_string().contains("plica")), "{problems:?}");
        }
    }
    let fields: Vec<_> = children(&squint(), "").into_iter().map(|child| child.name).collect();
    assert!(fields.contains(&"title".into()) && !fields.contains(&"plica".into()), "{fields:?}");
}

#[test]
fn what_changes_nothing_is_no_step() {
    let mut history = History::new(squint());
    let edit = Edit::set(history.document(), "/timeline/fps", json!(30));
    assert_eq!(history.apply(edit, Stamp::default()), Ok(None));
    assert_eq!((history.revision(), history.depth(), history.is_saved()), (0, (0, 0), true));
    let edit = Edit::set(history.document(), "/timeline/fps", json!(-30));
    assert!(history.apply(edit, Stamp::default()).is_err());
    assert_eq!(history.document().to_text(), squint().to_text());
}
