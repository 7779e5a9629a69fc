//! Rows are selected one by one and by what holds for them, and sorted; values are set and replaced in many places.

use serde_json::json;

use super::support::{press, said_last, state};
use super::{check, motion, zone};
use crate::tui::state::Mode;

#[test]
pub fn rows_are_selected_one_by_one_and_by_what_holds() {
    let scale = json!({ "tool": "scale", "center": [30, 25], "factor": [1.1, 1] });
    check(&[
        (&motion(": \"select x>25\" Enter l i \"*2\" Enter"), &zone("/motion/2/at"), json!([80, 30])),
        (&motion(": \"select x>25\" Enter l i \"*2\" Enter"), &zone("/motion/0/at"), json!([20, 20])),
        (&motion(": \"select tool==scale or r>17\" Enter d"), &zone("/motion/0/at"), json!([30, 25])),
        (&motion(": \"select i==n-1\" Enter d"), &zone("/motion/2/at"), json!([40, 30])),
        (&motion("2 l : \"select v<25\" Enter d"), &zone("/motion/0/at"), json!([30, 25])),
        (&motion("t j t d"), &zone("/motion"), json!([{"tool": "point", "at": [30, 25], "jump": [3, 4]}, scale])),
        (&motion("2 t d"), &zone("/motion/0/at"), json!([40, 30])),
        (&motion("t ~ d"), &zone("/motion"), json!([{"tool": "point", "at": [20, 20], "jump": [0, -18]}])),
        (&motion("t t k t d"), &zone("/motion/0/at"), json!([30, 25])),
        (&motion("v j t d"), &zone("/motion/0/at"), json!([30, 25])),
        (&motion("t j t Esc g v d"), &zone("/motion/0/at"), json!([30, 25])),
        (&motion("v j Esc g v j d"), &zone("/motion/0"), scale.clone()),
        (&motion("l 2 t j J"), &zone("/motion/0/tool"), json!("point")),
        ("/ \"motion\" Enter : \"select x==40\" Enter d", &zone("/motion/2"), scale),
    ]);
    for (keys, part) in [
        (": \"select x>100\" Enter", "that holds for none of 4 rows"),
        (": \"select color>1\" Enter", "`color` is not known here"),
        (": \"select x=1\" Enter", "equal is =="),
        (": \"select x>25\" Enter", "3 of 4 rows selected"),
        ("t j t J", "only rows next to each other"),
        ("t ~", "3 of 4 rows selected"),
        (": \"select 1/(x-30)\" Enter", "row 1: column 1: the result is not a finite number"),
        (": \"select x>1 && x<9\" Enter", "both is `and`"),
    ] {
        let mut state = state();
        press(&mut state, &motion(keys));
        assert!(said_last(&state).1.contains(part), "{keys}: {:?}", said_last(&state));
        assert!(state.scene.is_saved(), "{keys}");
    }
}

#[test]
pub fn rows_are_sorted() {
    check(&[
        (&motion("l g S"), &zone("/motion/0/at"), json!([40, 30])),
        (&motion("l g S"), &zone("/motion/3/at"), json!([20, 20])),
        (&motion("l g S g s"), &zone("/motion/0/at"), json!([20, 20])),
        (&motion("l g S i \"7\" Enter"), &zone("/motion/3/at"), json!([7, 20])),
        (&motion("l 2 v g S"), &zone("/motion/0/at"), json!([30, 25])),
        (&motion("l 2 v g S"), &zone("/motion/2/at"), json!([40, 30])),
        (&motion("g S"), &zone("/motion/0/tool"), json!("scale")),
        (&motion(": \"sort hypot(x-40, y-30)\" Enter"), &zone("/motion/0/at"), json!([40, 30])),
        (&motion(": \"sort y desc\" Enter u"), &zone("/motion/0/at"), json!([20, 20])),
        // Rows without the column come last, whichever way.
        (&motion(": \"sort |j| desc\" Enter"), &zone("/motion/3/tool"), json!("scale")),
        (&motion(": \"sort |j|\" Enter"), &zone("/motion/3/tool"), json!("scale")),
    ]);
    for (keys, part) in [
        (motion(": \"sort colour\" Enter"), "`colour` is not known here"),
        ("/ \"radius\" Enter : \"sort\" Enter".into(), "only rows of a list are sorted"),
        (motion("l g S"), "4 rows sorted by x, the largest first"),
        (motion(": \"sort 1/(x-30)\" Enter"), "row 1: column 1: the result is not a finite number"),
        (motion("V 2 l i \"1/(y-20)\" Enter"), "row 0: column 1: the result is not a finite number"),
        (
            ": \"go layers.face.zones\" Enter : \"columns feather\" Enter V : \"put i-1\" Enter".into(),
            "row 0: -1 is out of range",
        ),
    ] {
        let mut state = state();
        press(&mut state, &keys);
        assert!(said_last(&state).1.contains(part), "{keys}: {:?}", said_last(&state));
    }
}

#[test]
fn values_are_set_in_many_places_and_computed() {
    check(&[
        (": \"set layers.*.zones.*.speed=2\" Enter", "/layers/0/zones/1/speed", json!(2)),
        (": \"set layers.*.zones.*.speed=2\" Enter u", "/layers/0/zones/0/speed", json!(null)),
        (": \"set layers.*.zones.*.interpolation.radius*=2\" Enter", &zone("/interpolation/radius"), json!(120)),
        (": \"set layers.face.zones.*.feather=(i+1)/n\" Enter", "/layers/0/zones/0/feather", json!(0.5)),
        (": \"set layers.face.zones.*.motion.*.at.x+=1\" Enter", &zone("/motion/2/at"), json!([41, 30])),
        (": \"set layers.face.zones.mouth.outline.x=v*3\" Enter", "/layers/0/zones/1/outline/x", json!(60)),
        (": \"set layers.face.zones.mouth.outline.x=4,5\" Enter", "/layers/0/zones/1/outline/x", json!(4.5)),
        (": \"set timeline.fps=*2 timeline.duration/=4\" Enter", "/timeline", json!({"duration": 0.5, "fps": 20})),
        (
            ": \"set layers.*.zones.*.position.function=cosine\" Enter",
            "/layers/0/zones/1/position/function",
            json!("cosine"),
        ),
        (": \"set title=v*2\" Enter", "/title", json!("v*2")),
    ]);
    for (line, part) in [
        ("set layers.*.zones.*.speeed=2", "did you mean \"speed\""),
        ("set title+=2", "title: is not a number"),
        ("set timeline.fps=v/0", "not a finite number"),
        ("set layers.face.zonez.eye.feather*=2", "layers.face.zonez.eye.feather: there is no field \"zonez\""),
        ("set layers.face.zones.*.colour*=2", "layers.face.zones.*.colour: there is no field \"colour\""),
        ("get layers.*.name", "* stands for all of them, and here one is asked for (only set takes *)"),
        ("go layers.face.zones.*", "* stands for all of them"),
        ("set timeline.fps=w", "`w` is not known here"),
        ("set layers.face.zones.*.speed=2", "2 places are set"),
    ] {
        let mut state = state();
        press(&mut state, &format!(": \"{line}\" Enter"));
        assert!(said_last(&state).1.contains(part), "{line}: {:?}", said_last(&state));
    }
}

#[test]
pub fn names_texts_and_numbers_are_replaced() {
    check(&[
        (": \"replace eye ear\" Enter Enter", &zone("/name"), json!("left ear")),
        // A path without a file stays.
        (": \"replace cat dog\" Enter Enter", "/images", json!({ "dog": { "path": "cat.png" } })),
        (": \"replace cat a.0\" Enter Enter", "/images", json!({ "a.0": { "path": "a.0.png" } })),
        (": \"replace cat dog\" Enter Enter", "/layers/0/image", json!("dog")),
        (": \"replace cat dog\" Enter Enter u", "/images", json!({ "cat": { "path": "cat.png" } })),
        (": \"replace cat dog\" Enter Esc", "/layers/0/image", json!("cat")),
        (": \"replace cat a.0\" Enter 2 j Enter", "/images/cat/path", json!("a.0.png")),
        (": \"replace 25 26.5\" Enter Enter", &zone("/motion/3/center"), json!([30, 26.5])),
        (": \"replace 25 26.5\" Enter j Enter", &zone("/motion/1/at"), json!([30, 26.5])),
        (": \"replace 25 26.5\" Enter j Enter", &zone("/motion/3/center"), json!([30, 25])),
        (": \"replace! 20 21 layers.face.zones.mouth\" Enter", "/layers/0/zones/1/outline/x", json!(21)),
        (": \"replace! 20 21 layers.face.zones.mouth\" Enter", &zone("/motion/0/at"), json!([20, 20])),
    ]);
    let mut state = state();
    press(&mut state, ": \"replace 25 26\" Enter");
    let Mode::Choice(choice) = &state.typing.mode else { panic!("no list: {:?}", said_last(&state)) };
    assert_eq!(choice.options[0], ("all".into(), "Replace in 2 places".into()));
    assert_eq!(choice.options[1].1, "30, 25 → 30, 26");
    for (line, part) in [
        ("replace x", "takes FROM and TO"),
        ("replace zzz a", "nothing here has zzz in it"),
        ("replace cat dog images.cat.path", "images.cat.path stays: there is no file dog.png"),
        ("replace sine line", "function is sine, one of several words"),
    ] {
        let mut state = self::state();
        press(&mut state, &format!(": \"{line}\" Enter"));
        assert!(said_last(&state).1.contains(part), "{line}: {:?}", said_last(&state));
    }
}
