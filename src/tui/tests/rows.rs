//! Rows are selected one by one and by what holds for them, sorted, sent through programs; values are set and replaced in
//! many places.

use serde_json::json;

use super::support::{at, press, replayed, said_last, state};
use super::{MOTION, check, motion, zone};
use crate::tui::commands::update::update;
use crate::tui::events::{Effect, Event};
use crate::tui::state::{Mode, State};

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
        (": \"replace cat dog\" Enter Enter", "/images", json!({ "dog": { "path": "dog.png" } })),
        (": \"replace cat dog\" Enter Enter", "/layers/0/image", json!("dog")),
        (": \"replace cat dog\" Enter Enter u", "/images", json!({ "cat": { "path": "cat.png" } })),
        (": \"replace cat dog\" Enter Esc", "/layers/0/image", json!("cat")),
        (": \"replace cat dog\" Enter 2 j Enter", "/images/cat/path", json!("dog.png")),
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
    for (line, part) in [("replace x", "takes FROM and TO"), ("replace zzz a", "nothing here has zzz in it")] {
        let mut state = self::state();
        press(&mut state, &format!(": \"{line}\" Enter"));
        assert!(said_last(&state).1.contains(part), "{line}: {:?}", said_last(&state));
    }
}

#[test]
pub fn rows_go_through_a_program_or_nothing_changes() {
    let sent = |state: &mut State, keys: &str| -> Option<String> {
        press(state, MOTION);
        press(state, keys).into_iter().find_map(|effect| match effect {
            Effect::Pipe(program, table) => Some(format!("{program}: {table}")),
            _ => None,
        })
    };
    let pipe = "t j t | \"awk\" Enter";
    for (back, said, expected) in [
        (Ok("x,y\n1,2\n3,4\n"), "2 rows came back from awk", json!([[1, 2], [30, 25], [3, 4]])),
        (Ok("1,2\n3,4\n"), "2 rows came back", json!([[20, 20], [30, 25], [40, 30]])),
        (Ok("x,y\n1,2\n"), "2 rows went out and 1 came back", json!([[20, 20], [30, 25], [40, 30]])),
        (Ok(""), "2 rows went out and 0 came back", json!([[20, 20], [30, 25], [40, 30]])),
        (Ok("x,y\n1,a\nb,2\n"), "2 rows refused, and nothing changed: row 0", json!([[20, 20], [30, 25], [40, 30]])),
        (Ok("x,y\n1,a\n3,2\n"), "row 0, column 2: \"a\" is not a number", json!([[20, 20], [30, 25], [40, 30]])),
        (Err("awk took too long"), "pipe: awk took too long", json!([[20, 20], [30, 25], [40, 30]])),
    ] {
        let mut state = state();
        // Without a header values begin at the column of the cursor.
        let column = if back == Ok("1,2\n3,4\n") { "3 l " } else { "" };
        let table = sent(&mut state, &format!("{column}{pipe}")).unwrap();
        assert_eq!(table, "awk: tool,x,y,dx,dy,|J|,°\npoint,20,20,0,-18,18,90\npoint,40,30,0,0,0,0\n");
        assert_eq!(state.outside.work.as_deref(), Some("pipe awk"));
        update(&mut state, Event::Piped(back.map(str::to_owned).map_err(str::to_owned)));
        assert!(said_last(&state).1.contains(said), "{back:?}: {:?}", said_last(&state));
        let places: Vec<_> = (0..3).map(|i| at(&state, &zone(&format!("/motion/{i}/at")))).collect();
        assert_eq!(json!(places), expected, "{back:?}");
        assert!(state.outside.work.is_none());
        assert_eq!(replayed(&state).document().json(), state.document().json(), "{back:?}");
    }
    let mut state = state();
    sent(&mut state, pipe).unwrap();
    press(&mut state, "l +");
    update(&mut state, Event::Piped(Ok("x\n1\n2\n".into())));
    assert!(said_last(&state).1.contains("changed meanwhile: nothing was taken"), "{:?}", said_last(&state));
    assert!(sent(&mut self::state(), "g t : \"pipe cat\" Enter").unwrap().contains("point,30,25,3,4"), "all rows");
    assert_eq!(sent(&mut self::state(), ": \"pipe\" Enter"), None);
}

#[test]
fn a_changed_column_of_a_table_that_comes_back_counts() {
    let mut state = state();
    press(&mut state, &motion("v : \"pipe turn\" Enter"));
    update(&mut state, Event::Piped(Ok("tool,x,y,dx,dy,|J|,°\npoint,20,20,0,-18,9,90\n".into())));
    assert_eq!(at(&state, &zone("/motion/0/jump")), json!([0, -9]), "{:?}", said_last(&state));
}
