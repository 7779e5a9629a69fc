//! What is selected is moved, turned, scaled, mirrored, aligned and distributed in the picture.

use serde_json::json;

use super::support::{press, said_last, state};
use super::{check, motion, zone};

const MOUTH: &str = ": \"go layers.face.zones.mouth\" Enter";

#[test]
pub fn what_is_selected_is_transformed_in_one_step() {
    let mouth = |line: &str| format!("{MOUTH} : \"{line}\" Enter");
    let outline = "/layers/0/zones/1/outline";
    let rectangle = |x: i32, y: i32, width: i32, height: i32| json!({ "kind": "rectangle", "x": x, "y": y, "width": width, "height": height });
    check(&[
        (&mouth("mirror x"), outline, rectangle(14, 45, 30, 10)),
        (&mouth("mirror x=w/4"), outline, rectangle(-18, 45, 30, 10)),
        (&mouth("mirror y=50"), outline, rectangle(20, 45, 30, 10)),
        (&mouth("mirror 0 0 1 1"), outline, rectangle(45, 20, 10, 30)),
        (&mouth("move 3 -4"), outline, rectangle(23, 41, 30, 10)),
        (&mouth("translate 3,-4"), outline, rectangle(23, 41, 30, 10)),
        (&mouth("rotate 90"), outline, rectangle(30, 35, 10, 30)),
        (&mouth("rotate 90 about 0 0"), outline, rectangle(45, -50, 10, 30)),
        (&mouth("scale 2 about 20 45"), outline, rectangle(20, 45, 60, 20)),
        (&mouth("scale 1 3"), outline, rectangle(20, 35, 30, 30)),
        (&mouth("scale 2 about 20 45"), "/layers/0/zones/1/name", json!("mouth")),
        (&format!("{} u", mouth("rotate 30")), outline, rectangle(20, 45, 30, 10)),
        (&mouth("rotate 30"), "/layers/0/zones/1/outline/kind", json!("polygon")),
        (": \"scale 2 about 0 0\" Enter", &zone("/interpolation/radius"), json!(120)),
        (
            ": \"scale 2 about 0 0\" Enter",
            &zone("/motion/1"),
            json!({ "tool": "point", "at": [60, 50], "jump": [6, 8] }),
        ),
        (&motion("v j : \"mirror x=30\" Enter"), &zone("/motion/0/at"), json!([40, 20])),
        (&motion("v j : \"mirror x=30\" Enter"), &zone("/motion/1/jump"), json!([-3, 4])),
        (&motion("v j : \"mirror x=30\" Enter"), &zone("/motion/2/at"), json!([40, 30])),
        (
            &motion("g i 9 9 9 h 9 9 9 k g e : \"scale 2 about cursor\" Enter"),
            &zone("/motion/0/at"),
            json!([39.5, 39.5]),
        ),
        (&motion("t j t : \"align left\" Enter"), &zone("/motion/2/at"), json!([20, 30])),
        (&motion("t j t : \"align middle\" Enter"), &zone("/motion/2/at"), json!([40, 25])),
        (
            &motion("j l i \"21\" Enter : \"select i<3\" Enter : \"distribute x\" Enter"),
            &zone("/motion/1/at"),
            json!([30, 25]),
        ),
        (
            "/ \"points\" Enter Enter j v j : \"move 0 -1\" Enter",
            &zone("/outline/points"),
            json!([[10, 10], [50, 9], [50, 39], [10, 40]]),
        ),
    ]);
}

#[test]
pub fn what_cannot_be_transformed_says_why() {
    let mouth = |line: &str| format!("{MOUTH} : \"{line}\" Enter");
    for (keys, part) in [
        (mouth("mirror"), "mirror takes x, x=X"),
        (mouth("scale 0"), "would leave nothing"),
        (mouth("rotate 90 about"), "about takes X Y or cursor"),
        (mouth("rotate x"), "`x` is not known here"),
        (mouth("align left"), "2 things or more"),
        (mouth("distribute x"), "3 things or more"),
        (mouth("rotate 90"), "1 thing turned by 90° about 35, 50"),
        ("/ \"radius\" Enter : \"mirror x\" Enter".into(), "has no place in a picture"),
        ("/ \"timeline\" Enter : \"move 1 1\" Enter".into(), "timeline has no place in a picture"),
        (motion(": \"move sideways\" Enter"), "move takes a way"),
        (
            motion(": \"set layers.0.zones.0.motion.3.tool=still-border\" Enter V : \"move 1 1\" Enter"),
            "3 things moved by 1, 1; 1 row has no place",
        ),
    ] {
        let mut state = state();
        press(&mut state, &keys);
        assert!(said_last(&state).1.contains(part), "{keys}: {:?}", said_last(&state));
    }
}
