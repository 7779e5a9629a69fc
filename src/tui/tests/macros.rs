//! Macros, and repeating the last change with `.`.

use serde_json::{Value, json};

use super::support::{press, replayed, state};
use super::{check, motion, zone};

#[test]
pub fn macros_play_what_was_asked_for() {
    check(&[
        (&motion("l q a i \"+=1\" Enter j q @ a"), &zone("/motion/1/at"), json!([31, 25])),
        (&motion("l q a i \"+=1\" Enter j q 2 @ a"), &zone("/motion/2/at"), json!([41, 30])),
        (&motion("l q a i \"+=1\" Enter j q @ a @ @"), &zone("/motion/2/at"), json!([41, 30])),
        (&motion("l q a + q q b @ a @ a q @ b"), &zone("/motion/0/at"), json!([25, 20])),
        (&motion("l q a i \"7\" Esc + q @ a"), &zone("/motion/0/at"), json!([22, 20])),
        ("/ \"method\" Enter q a i j j Enter q u @ a", &zone("/interpolation/method"), json!("thin-plate")),
        (&motion("l + q a . q . 3 @ a"), &zone("/motion/0/at"), json!([26, 20])),
    ]);
}

#[test]
pub fn the_last_change_is_repeated_here() {
    check(&[
        (&motion("l i \"*2\" Enter j ."), &zone("/motion/1/at"), json!([60, 25])),
        (&motion("l i \"*2\" Enter 2 ."), &zone("/motion/0/at"), json!([160, 20])),
        (&motion("l 5 + j ."), &zone("/motion/1/at"), json!([35, 25])),
        (&motion("l 5 + j 2 ."), &zone("/motion/1/at"), json!([32, 25])),
        (&motion("l + u ."), &zone("/motion/0/at"), json!([21, 20])),
        (&motion("D 2 ."), &zone("/motion/6/tool"), json!("scale")),
        (&motion("d ."), &zone("/motion/0/at"), json!([40, 30])),
        (&motion("J ."), &zone("/motion/2/at"), json!([20, 20])),
        ("/ \"wrap\" Enter i j Enter i k Enter .", "/timeline/wrap", Value::Null),
        (&motion("g i a 3 l ."), &zone("/motion/2/at"), json!([33.5, 25.5])),
    ]);
}

#[test]
fn what_cannot_be_played_is_said() {
    for (keys, part) in [
        ("@ a", "qa records one"),
        ("@ @", "no macro has been played"),
        (".", "nothing has been changed yet"),
        ("q a j q q a @ a q @ a", "macros play one another 50 deep"),
        ("q a j k q 9 0 0 0 @ a", "stopped after 300 lines"),
        (": \"1000000000 duplicate\" Enter", "a count is at most 1000000"),
        (": \"99999999999999999999 duplicate\" Enter", "no command \"99999999999999999999\""),
        (&motion(": \"10001 duplicate\" Enter"), "duplicate repeats 10000 times at most, not 10001"),
        (&motion("d : \"10001 again\" Enter"), "again repeats 10000 times at most"),
        (&motion("y y : \"10001 paste\" Enter"), "paste repeats 10000 times at most"),
        ("q a j k q : \"10001 play-macro a\" Enter", "play-macro repeats 10000 times at most"),
        (&motion("q a l J q 5 @ a"), "macro a stopped at line 2 (reorder down): it cannot move any further"),
        ("q a q", "macro a has 0 lines"),
        ("q a : \"record b\" Enter", "macro a is being recorded"),
        (": \"record A\" Enter", "a to z"),
    ] {
        let mut state = state();
        press(&mut state, keys);
        let message = state.message.clone().expect(keys);
        assert!(message.text.matches("stopped at line").count() < 2, "{}", message.text);
        assert!(message.text.contains(part), "{keys}: {message:?}");
        assert_eq!(replayed(&state).document().json(), state.document().json(), "{keys}");
    }
}
