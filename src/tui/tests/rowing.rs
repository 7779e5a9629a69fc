//! Rows are thinned and spaced evenly, nodes get handles, and the picture's cursor goes to what is near.

use kurbo::Point;
use serde_json::{Value, json};

use super::support::{at, press, said_last, state};
use super::{check, motion, zone};
use crate::scene::Edit;

const PATH: &str = ": \"set layers.0.zones.0.outline.kind=path\" Enter : \"go layers.0.zones.0.outline.nodes\" Enter";
const POINTS: &str = ": \"go layers.0.zones.0.outline.points\" Enter";

#[test]
pub fn rows_and_nodes_are_made_anew() {
    let nodes = zone("/outline/nodes");
    check(&[
        (&motion(": \"thin 2\" Enter"), &zone("/motion/1/at"), json!([40, 30])),
        (&motion("j v j : \"thin 2\" Enter"), &zone("/motion/2/tool"), json!("scale")),
        (
            &motion("v j : \"resample 3\" Enter"),
            &zone("/motion/1"),
            json!({ "tool": "point", "at": [25, 22.5], "jump": [1.5, -7] }),
        ),
        (&motion("v j : \"resample 3\" Enter"), &zone("/motion/3/at"), json!([40, 30])),
        (&format!("{POINTS} : \"resample 7\" Enter"), &zone("/outline/points/1"), json!([30, 10])),
        (
            &format!("{POINTS} v j : \"resample 3\" Enter"),
            &zone("/outline/points"),
            json!([[10, 10], [30, 10], [50, 10], [50, 40], [10, 40]]),
        ),
        (&format!("{PATH} : \"resample 14\" Enter"), &format!("{nodes}/1"), json!({ "at": [20, 10] })),
        (&format!("{PATH} j g h"), &format!("{nodes}/1/out"), json!([8, 6])),
        (&format!("{PATH} j v g h"), &format!("{nodes}/0"), json!({ "at": [10, 10] })),
        (&format!("{PATH} j v g h g H"), &format!("{nodes}/1/in"), json!([-10.666666667, -8])),
        // The sides beside them stay as they are.
        (&format!("{PATH} g h v j : \"resample 3\" Enter"), &format!("{nodes}/0/in"), json!([-8, 6])),
        (&format!("{PATH} g h v j : \"resample 3\" Enter"), &format!("{nodes}/2/out"), json!([8, 6])),
        (&format!("{PATH} g h : \"handles none\" Enter"), &format!("{nodes}/2"), json!({ "at": [50, 40] })),
    ]);
    for (keys, part) in [
        (motion(": \"thin 2\" Enter"), "2 of 4 rows kept"),
        (motion(": \"thin 1\" Enter"), "thin takes which rows to keep: 2 for every second, 2 to"),
        (motion("g h"), "only nodes of paths and curves have handles"),
        (motion("V : \"resample 3\" Enter").replace("V", "t j t"), "only rows next to each other"),
        (format!("{POINTS} : \"thin 2\" Enter"), "at least 3"),
        (format!("{PATH} : \"thin 9\" Enter"), "one of 4 would be left: thin 3 keeps the first and the last"),
        (format!("{PATH} : \"select i==0\" Enter : \"resample 3\" Enter"), "select two or more"),
        (": \"go timeline\" Enter : \"thin 2\" Enter".into(), "only rows of a list"),
    ] {
        let mut state = state();
        press(&mut state, &keys);
        assert!(said_last(&state).1.contains(part), "{keys}: {:?}", said_last(&state));
    }
}

#[test]
pub fn the_cursor_goes_to_what_is_near() {
    for (from, keys, to) in [
        ((21.2, 21.9), "S p", (20.0, 20.0)),
        ((13.0, 20.5), "S l", (10.0, 20.5)),
        ((13.4, 20.6), "S w", (13.0, 21.0)),
        // The first anchor is selected, at 20, 20.
        ((30.0, 21.0), "S a", (20.0 + 101.0_f64.sqrt(), 20.0)),
    ] {
        let mut state = state();
        press(&mut state, &motion("j j g i"));
        if keys == "S a" {
            press(&mut state, "b b");
        }
        state.picture.cursor = Point::new(from.0, from.1);
        press(&mut state, keys);
        let found = state.picture.cursor;
        assert!(found.distance(Point::new(to.0, to.1)) < 1e-6, "{keys}: {found:?} {:?}", said_last(&state));
    }
    check(&[(&motion("g i S w a"), &zone("/motion/1/at"), json!([31, 26]))]);
    // The selected point alone is not snapped to, however others are numbered.
    let mut of_eleven = state();
    let points: Vec<Value> = (0..11).map(|k| json!([3 * k + 1, k * k / 2])).collect();
    let outline = json!({ "kind": "polygon", "points": points });
    let edit = Edit::set(of_eleven.document(), &zone("/outline"), outline);
    of_eleven.edit(edit, false).unwrap();
    press(&mut of_eleven, ": \"go layers.0.zones.0.outline.points.1\" Enter");
    for (from, to) in [((31.4, 49.6), (31.0, 50.0)), ((4.2, 0.6), (7.0, 2.0))] {
        of_eleven.picture.cursor = Point::new(from.0, from.1);
        press(&mut of_eleven, ": \"snap point\" Enter");
        assert_eq!(of_eleven.picture.cursor, Point::new(to.0, to.1), "{from:?}");
    }
    let mut state = state();
    press(&mut state, ": \"go timeline\" Enter : \"snap angle\" Enter");
    assert!(said_last(&state).1.contains("select one (w, b)"), "{:?}", said_last(&state));
    assert_eq!(at(&state, "/layers/0/name"), json!("face"));
}
