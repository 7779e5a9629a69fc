//! What is shown of a table and of the panes: columns that are chosen, what they add up to, one pane alone, hints, and search
//! in the help.

use super::screens::{opened, screen};
use super::support::{press, said_last, state};
use super::{MOTION, motion};
use crate::tui::state::{Mode, State};

fn heads(state: &State) -> String {
    state.row().unwrap().cells.iter().map(|cell| cell.head.as_str()).collect::<Vec<_>>().join(" ")
}

#[test]
pub fn columns_are_chosen_ordered_and_left_out() {
    for (line, expected) in [
        ("columns x y", "tool x y"),
        ("columns dy x", "tool dy x"),
        ("columns -dx -dy -|j| -a", "tool x y"),
        ("columns r", "tool |J|"),
        ("columns all", "tool x y dx dy |J| °"),
        ("columns", "tool x y dx dy |J| °"),
        ("columns freeze 2", "tool x y dx dy |J| °"),
    ] {
        let mut state = state();
        press(&mut state, &motion(&format!(": \"{line}\" Enter")));
        assert_eq!(heads(&state), expected, "{line}: {:?}", said_last(&state));
        // The other zone's table is the same.
        press(&mut state, ": \"columns all\" Enter");
        assert_eq!(heads(&state), "tool x y dx dy |J| °");
    }
    let mut state = state();
    press(&mut state, &motion("4 l : \"columns dy\" Enter i \"x+1\" Enter"));
    assert_eq!(super::support::at(&state, "/layers/0/zones/0/motion/0/jump"), serde_json::json!([0, 21]), "x is known");
    press(&mut state, ": \"columns -dy\" Enter");
    assert_eq!(said_last(&state).1, "one column has to stay");
    for (keys, part) in [
        (motion(": \"columns q\" Enter"), "there is no column \"q\" here"),
        (motion(": \"columns freeze x\" Enter"), "how many columns"),
        ("/ \"radius\" Enter : \"columns x\" Enter".into(), "only the rows of a list have columns"),
        (motion(": \"columns -x\" Enter : \"columns\" Enter"), "tool  -x  y"),
    ] {
        let mut state = self::state();
        press(&mut state, &keys);
        assert!(said_last(&state).1.contains(part), "{keys}: {:?}", said_last(&state));
    }
}

#[test]
fn so_many_columns_stay_while_the_others_move() {
    let mut state = state();
    press(&mut state, &motion(": \"columns freeze 3\" Enter 6 l"));
    let shown = screen(&state);
    let head = shown.lines().find(|line| line.contains('°')).unwrap();
    assert!(head.contains("tool") && head.contains(" x") && head.contains(" y"), "{shown}");
}

#[test]
fn the_status_line_tells_sum_and_mean_or_how_often() {
    for (keys, part) in [
        ("l V", "4 rows  sum 120  mean 30"),
        ("l t t", "2 rows  sum 50  mean 25"),
        ("V", "4 rows  point 3  scale 1"),
        ("l", ""),
    ] {
        let mut state = opened((160, 48));
        press(&mut state, &motion(keys));
        let shown = screen(&state);
        assert!(shown.contains(part) && part.is_empty() != shown.contains(" rows  "), "{keys}: {shown}");
    }
}

#[test]
pub fn one_pane_has_the_whole_screen() {
    let mut state = opened((80, 24));
    for (keys, title, others) in [("_", "scene", "left eye"), ("g e", "left eye", "scene"), ("g i", "picture", "scene")]
    {
        press(&mut state, keys);
        let shown = screen(&state);
        let first = shown.lines().next().unwrap();
        assert!(first.contains(title) && first.starts_with('┌') && first.chars().count() == 80, "{keys}: {shown}");
        assert!(first.matches('┐').count() == 1 && !first.contains('┬'), "{keys}: {first}");
        assert!(!first.contains(others), "{keys}: {first}");
    }
    press(&mut state, "_");
    assert!(screen(&state).lines().next().unwrap().contains('┬'));
    // Nothing is drawn or clicked where a pane is not shown.
    for size in [(60, 20), (80, 20), (200, 60)] {
        for focus in ["g t", "g e", "g i", "g i s", "g p"] {
            let mut state = opened(size);
            press(&mut state, &format!("{MOTION} {focus} _"));
            screen(&state);
        }
    }
}

#[test]
pub fn the_help_is_searched() {
    let mut state = state();
    press(&mut state, "? / \"duplicate\" Enter");
    let found = |state: &State| match &state.typing.mode {
        Mode::Pages(pages) => pages.lines[pages.scroll].clone(),
        _ => String::new(),
    };
    let first = found(&state);
    assert!(first.contains("Duplicate"), "{first}");
    press(&mut state, "n");
    assert!(found(&state).contains("Duplicate") && found(&state) != first);
    press(&mut state, "N");
    assert_eq!(found(&state), first);
    press(&mut state, "/ \"no such word\" Enter");
    assert_eq!(found(&state), first);
    assert!(said_last(&state).1.contains("nothing here has no such word in it"));
    press(&mut state, "/ \"x\" Esc");
    assert_eq!(found(&state), first, "a search that is not run leaves the page");
    press(&mut state, "q");
    assert!(matches!(state.typing.mode, Mode::Normal));
    // What was being typed below the help comes back.
    press(&mut state, &format!("{MOTION} l i \"7\" ? / \"sqrt\" Enter q"));
    assert!(matches!(&state.typing.mode, Mode::Entry(entry) if entry.text.value() == "7"), "{:?}", state.typing.mode);
}

#[test]
fn the_empty_last_line_tells_the_keys_of_the_pane() {
    for (keys, part) in [
        ("", "Enter edit   o add   d delete"),
        (MOTION, "Enter edit   o add"),
        ("g i", "a add   r move   ? help"),
        ("/ \"radius\" Enter i", "Enter take it   Tab next cell"),
        ("/ \"function\" Enter Enter", "Enter take it   j down"),
    ] {
        let mut state = opened((80, 24));
        press(&mut state, keys);
        state.message = None;
        let shown = screen(&state);
        let last = shown.lines().nth(23).unwrap();
        assert!(last.contains(part), "{keys}: {last}");
    }
}

#[test]
pub fn lists_are_narrowed() {
    let taken = |state: &State| match &state.typing.mode {
        Mode::Choice(choice) => choice.options.iter().map(|(word, _)| word.clone()).collect::<Vec<_>>().join(" "),
        _ => String::new(),
    };
    let mut state = state();
    press(&mut state, "/ \"function\" Enter Enter / \"expo\" Enter");
    assert_eq!(taken(&state), "exponential exponential-inverse", "{:?}", said_last(&state));
    press(&mut state, "j Enter");
    assert_eq!(
        super::support::at(&state, "/layers/0/zones/0/position/function"),
        serde_json::json!("exponential-inverse")
    );
    assert_eq!(super::support::replayed(&state).document().json(), state.document().json());
    press(&mut state, "Enter");
    let all = taken(&state);
    for (keys, part) in [("/ \"qqq\" Enter", "nothing here has qqq in it"), ("/ \"lin\" Esc", "")] {
        press(&mut state, keys);
        assert!(taken(&state) == all && said_last(&state).1.contains(part), "{keys}: {:?}", said_last(&state));
    }
}

#[test]
pub fn registers_hold_what_was_yanked_into_them() {
    super::check(&[
        (
            &motion(": \"register a\" Enter y j : \"register b\" Enter y G : \"register a\" Enter p"),
            "/layers/0/zones/0/motion/4/at",
            serde_json::json!([20, 20]),
        ),
        (
            &motion(": \"register a\" Enter y j : \"register b\" Enter y G p"),
            "/layers/0/zones/0/motion/4/at",
            serde_json::json!([30, 25]),
        ),
        (
            &motion(": \"register a\" Enter y j y G : \"register a\" Enter p : \"register a\" Enter p"),
            "/layers/0/zones/0/motion/5/at",
            serde_json::json!([20, 20]),
        ),
    ]);
    let mut state = state();
    super::super::commands::update::update(&mut state, crate::tui::events::Event::Key("\"".into()));
    press(&mut state, "r");
    assert_eq!(state.memory.register, Some('r'));
    press(&mut state, &motion("y : \"register q\" Enter p"));
    assert_eq!(said_last(&state).1, "register q is empty");
}
