//! Outlines, regions and curves are made of shapes that they share.

use kurbo::Rect;
use serde_json::json;

use super::support::{at, press, said_last, state};
use super::{check, zone};
use crate::tui::commands::obey;
use crate::tui::state::State;

const EYE: &str = ": \"go layers.0.zones.0.outline\" Enter";
const MOUTH: &str = ": \"go layers.face.zones.mouth.outline\" Enter";
const CURVE: &str = ": \"set layers.0.zones.0.motion.0.tool=curve\" Enter : \"go layers.0.zones.0.motion.0\" Enter";

#[test]
pub fn outlines_and_curves_are_made_of_shapes_and_get_them_back() {
    let eye = |keys: &str| format!("{EYE} {keys}");
    let share = eye(": \"share lid\" Enter");
    let after = |keys: &str| format!("{share} {keys}");
    let corners = json!([{ "at": [10, 10] }, { "at": [50, 10] }, { "at": [50, 40] }, { "at": [10, 40] }]);
    // It goes back to where it began, so that nothing is lost at its ends.
    let ring =
        json!([{ "at": [10, 10] }, { "at": [50, 10] }, { "at": [50, 40] }, { "at": [10, 40] }, { "at": [10, 10] }]);
    let of_lid = json!({ "kind": "shapes", "parts": [{ "shape": "lid" }] });
    let both = json!({ "kind": "shapes", "parts": [{ "shape": "lid" }, { "shape": "lid rest" }] });
    let select =
        ": \"set layers.0.zones.0.outline.kind=path\" Enter : \"go layers.0.zones.0.outline.nodes\" Enter j v j";
    check(&[
        (&share, "/shapes/lid/nodes", ring.clone()),
        (&share, &zone("/outline"), of_lid.clone()),
        (&after("u"), "/shapes", json!(null)),
        (&after("u"), &zone("/outline/kind"), json!("polygon")),
        (&after(": \"unshare\" Enter"), &zone("/outline"), json!({ "kind": "path", "nodes": corners })),
        (&after(&format!("{MOUTH} : \"use lid\" Enter")), "/layers/0/zones/1/outline", of_lid),
        (
            &after(&format!("{MOUTH} : \"share low\" Enter {EYE} : \"use low reverse\" Enter")),
            &zone("/outline/parts"),
            json!([{ "shape": "lid" }, { "shape": "low", "reverse": true }]),
        ),
        (&after(": \"go shapes.lid\" Enter : \"move 1 0\" Enter"), "/shapes/lid/nodes/2", json!({ "at": [51, 40] })),
        (&after(": \"go shapes.lid.nodes\" Enter + +"), "/shapes/lid/nodes/0", json!({ "at": [12, 10] })),
        (&after(": \"go shapes.lid\" Enter : \"rename top\" Enter"), &zone("/outline/parts/0/shape"), json!("top")),
        (&after(": \"go shapes.lid\" Enter d"), "/shapes/lid/nodes", ring.clone()),
        (
            &eye(&format!("{select} : \"share lid\" Enter")),
            "/shapes/lid/nodes",
            json!([{ "at": [50, 10] }, { "at": [50, 40] }]),
        ),
        (
            &eye(&format!("{select} : \"share lid\" Enter")),
            "/shapes/lid rest/nodes",
            json!([{ "at": [50, 40] }, { "at": [10, 40] }, { "at": [10, 10] }, { "at": [50, 10] }]),
        ),
        (&eye(&format!("{select} : \"share lid\" Enter")), &zone("/outline"), both),
        (&eye(&format!("{select} V : \"share lid\" Enter")), "/shapes/lid/nodes", ring.clone()),
        // The first node is next to the last.
        (
            &eye(&format!("{select} Esc : \"select i==0 or i==3\" Enter : \"share ends\" Enter")),
            "/shapes/ends/nodes",
            json!([{ "at": [10, 40] }, { "at": [10, 10] }]),
        ),
        (
            &after(&format!("{MOUTH} : \"share low\" Enter : \"unshare\" Enter : \"use lid low reverse\" Enter")),
            "/layers/0/zones/1/outline/parts",
            json!([{ "shape": "lid" }, { "shape": "low", "reverse": true }]),
        ),
        (&format!("{CURVE} : \"share line\" Enter"), &zone("/motion/0/nodes"), json!("line")),
        (&format!("{share} {CURVE} : \"use lid\" Enter"), &zone("/motion/0/nodes"), json!("lid")),
        (&format!("{share} {CURVE} : \"use lid\" Enter : \"unshare\" Enter"), &zone("/motion/0/nodes"), ring),
        (": \"go shapes\" Enter g t o", "/shapes/shape/nodes", json!([{ "at": [11, 26] }, { "at": [51, 26] }])),
    ]);
}

const ARCS: &str =
    ": \"shape low 0,20 20,30 40,20\" Enter : \"shape lid 0,20 20,0 40,20\" Enter : \"go layers.0.zones.0\" Enter";
const FOLD: &str = ": \"go layers.face.zones.mouth\" Enter : \"go .fold\" Enter";

#[test]
pub fn shapes_are_laid_and_what_moves_follows_them() {
    let arcs = |keys: &str| format!("{ARCS} : \"set .motion=[]\" Enter {keys}");
    let along = arcs(": \"along low to lid\" Enter");
    check(&[
        (ARCS, "/shapes/lid/nodes/0", json!({ "at": [0, 20], "out": [0, -9.43] })),
        (&format!("{ARCS} : \"shape lid 0,20 9,1\" Enter"), "/shapes/lid/nodes/1/at", json!([9, 1])),
        (&arcs(": \"along low\" Enter"), &zone("/motion/0/jumps"), json!([{ "along": 0, "jump": [0, 0] }])),
        (&along, &zone("/motion/0/nodes"), json!("low")),
        (
            &arcs(": \"along low by 3,-4.5\" Enter"),
            &zone("/motion/0/jumps"),
            json!([{ "along": 0, "jump": [3, -4.5] }]),
        ),
        (&arcs(": \"along low lid to low\" Enter"), &zone("/motion/0/jumps"), json!([{ "along": 0, "jump": [0, 0] }])),
        (&arcs(": \"along low lid to low\" Enter"), &zone("/motion/1/jumps/10/jump"), json!([0, 30])),
        (&arcs(": \"along low lid\" Enter u"), &zone("/motion"), json!([])),
        (&format!("{ARCS} : \"shape sea y=20*2\" Enter"), "/shapes/sea/nodes/1/at", json!([64, 40])),
        // A line across the picture is laid where it is used, once.
        (&format!("{EYE} : \"use y=20*2 y=10\" Enter"), "/shapes/y40/nodes/1/at", json!([64, 40])),
        (&format!("{EYE} : \"use y=40 x=3\" Enter"), &zone("/outline/parts/1/shape"), json!("x3")),
        (&format!("{EYE} : \"use y=40\" Enter : \"use x=3\" Enter u u"), "/shapes", json!(null)),
        (&arcs(": \"along y=40 y=40 to x=3\" Enter"), &zone("/motion/0/nodes"), json!("y40")),
        (&format!("{ARCS} : \"shape mast x=w/2\" Enter"), "/shapes/mast/nodes/1/at", json!([32, 64])),
        (&along, &zone("/motion/0/jumps/10"), json!({ "along": 0.5, "jump": [0, -30] })),
        // Measured anew, it stays one.
        (
            &format!("{along} : \"shape lid 0,20 20,10 40,20\" Enter : \"along low to lid\" Enter"),
            &zone("/motion/0/jumps/10/jump"),
            json!([0, -20]),
        ),
        (&format!("{along} : \"along low to lid\" Enter"), &zone("/motion/1"), json!(null)),
        // Two with the same ends: the second is turned by itself.
        (
            &format!("{ARCS} {EYE} : \"use low lid\" Enter"),
            &zone("/outline/parts"),
            json!([{ "shape": "low" }, { "shape": "lid", "reverse": true }]),
        ),
        (&format!("{ARCS} {FOLD} : \"use lid\" Enter"), "/layers/0/zones/1/fold/rule", json!("cover")),
        (
            &format!("{ARCS} {FOLD} : \"use lid low\" Enter : \"use low lid\" Enter"),
            "/layers/0/zones/1/fold/regions/1/parts/1",
            json!({ "shape": "lid", "reverse": true }),
        ),
    ]);
}

#[test]
fn what_cannot_be_laid_or_moved_along_says_so() {
    for (line, part) in [
        ("shape a 1,2", "shape takes a name and two points or more"),
        ("shape a 1,2 3;4", "\"3;4\" is no place of the picture: write it as X,Y"),
        ("along", "along takes names of shapes, and where to from each"),
        ("along low to", "along takes names of shapes, and where to from each"),
        ("along low up lid", "there is no shape \"up\""),
        ("along low by 3", "\"3\" is no place of the picture: write it as X,Y"),
        ("shape a y=q", "\"q\": "),
        ("use y=q", "\"q\": "),
        ("along x=7", "the shape \"x7\" lies elsewhere: name this line, :shape NAME x=7"),
        ("along low to lidd", "there is no shape \"lidd\" (did you mean \"lid\"?)"),
        ("along low", "along is for what moves in a zone: go to one"),
    ] {
        let mut state = state();
        press(&mut state, ARCS);
        press(&mut state, ": \"shape x7 1,2 3,4\" Enter");
        if line == "along low" {
            obey(&mut state, "go timeline", None).unwrap();
        }
        let said = obey(&mut state, line, None).err().unwrap_or_default();
        assert!(said.contains(part), "{line}: {said}");
    }
}

#[test]
fn what_is_no_line_or_no_shape_says_so() {
    for (keys, part) in [
        (": \"share a\" Enter".to_owned(), "left eye\".outline is made of the shape \"a\" now"),
        (": \"go timeline\" Enter : \"share a\" Enter".into(), "go to an outline, a fold region or a curve first"),
        (format!("{EYE} : \"share\" Enter"), "share takes a name"),
        (
            format!("{EYE} : \"use lid\" Enter"),
            "there is no shape \"lid\" (:shape lays one, :share makes one of what is there)",
        ),
        (format!("{EYE} : \"share lid\" Enter : \"use lidd\" Enter"), "did you mean \"lid\""),
        (format!("{EYE} : \"share lid\" Enter : \"share a\" Enter"), "made of shapes already: :unshare"),
        (format!("{EYE} : \"share lid\" Enter {MOUTH} : \"share lid\" Enter"), "there is already a shape \"lid\""),
        (
            format!("{EYE} : \"share lid\" Enter {MOUTH} : \"use lid reverse\" Enter"),
            "mouth.outline is made of \"lid\" reversed",
        ),
        (format!("{EYE} : \"share lid\" Enter : \"use lid\" Enter"), "outline is made of \"lid\" too"),
        (format!("{EYE} : \"share a b\" Enter"), "one with spaces in double quotes"),
        (
            format!("{CURVE} : \"go layers.0.zones.0.motion.0.nodes\" Enter v : \"share a\" Enter"),
            "a curve is made of one shape as a whole",
        ),
        (format!("{EYE} : \"unshare\" Enter"), "not made of shapes: :use"),
        (
            format!("{EYE} : \"share lid\" Enter {CURVE} : \"use lid reverse\" Enter"),
            "a curve follows one shape, from its beginning to its end",
        ),
        (format!("{EYE} : \"share lid\" Enter : \"go shapes.lid\" Enter d"), "lid is used by layers.face.zones"),
        (format!("{EYE} : \"share lid\" Enter : \"move 1 1\" Enter"), "made of shared shapes: move those"),
        (
            format!("{EYE} : \"share lid\" Enter : \"set layers.0.zones.0.outline.parts.0.shape=lidd\" Enter"),
            "did you mean \"lid\"",
        ),
    ] {
        let mut state = state();
        press(&mut state, &keys);
        assert!(said_last(&state).1.contains(part), "{keys}: {:?}", said_last(&state));
    }
}

#[test]
fn an_edit_of_a_shape_moves_all_that_is_made_of_it() {
    let mut state = state();
    let bounds = |state: &State, path: &str| state.document().scene().layers[0].technique().bounds(path);
    press(&mut state, &format!("{EYE} : \"share lid\" Enter {MOUTH} : \"use lid\" Enter"));
    assert_eq!(bounds(&state, "/zones/1"), Rect::new(10.0, 10.0, 50.0, 40.0), "{:?}", said_last(&state));
    press(&mut state, ": \"set shapes.lid.nodes.1.at.x=60\" Enter");
    for zone in ["/zones/0", "/zones/1"] {
        assert_eq!(bounds(&state, zone), Rect::new(10.0, 10.0, 60.0, 40.0), "{zone}");
    }
    press(&mut state, "u u");
    assert_eq!(bounds(&state, "/zones/1"), Rect::new(20.0, 45.0, 50.0, 55.0));
    press(&mut state, ": \"go layers.0.zones.0.outline\" Enter : \"unshare\" Enter");
    assert_eq!(at(&state, "/shapes/lid/nodes/0/at"), json!([10, 10]));
}

/// What a path means does not change when it is shared, and comes back as it was.
#[test]
fn sharing_keeps_every_handle() {
    let mut state = state();
    let nodes = json!([
        { "at": [10, 20], "in": [-4, 6], "out": [3, -9] },
        { "at": [60, 22], "in": [-2, -8], "out": [5, 7] },
        { "at": [40, 50], "in": [9, 1], "out": [-9, -1] }
    ]);
    let line = format!("set layers.0.zones.0.outline={}", json!({ "kind": "path", "nodes": nodes }));
    obey(&mut state, &line, None).unwrap();
    let outline = |state: &State| state.document().scene().layers[0].technique().bounds("/zones/0/outline");
    let before = outline(&state);
    for share in ["share edge", "share \"an edge\""] {
        press(&mut state, EYE);
        obey(&mut state, share, None).unwrap();
        assert_eq!(outline(&state), before);
        obey(&mut state, "unshare", None).unwrap();
        assert_eq!(at(&state, &zone("/outline/nodes")), nodes, "{share}");
        obey(&mut state, "undo 2", None).unwrap();
    }
}

#[test]
fn straight_lines_become_an_outline_together() {
    let mut state = state();
    press(&mut state, EYE);
    for (name, x) in [("a", 1), ("b", 9)] {
        let line = format!("set shapes.{name}={}", json!({ "nodes": [{ "at": [x, 1] }, { "at": [x, 20] }] }));
        obey(&mut state, &line, None).unwrap();
    }
    let why = obey(&mut state, "use a", None).unwrap_err();
    assert!(why.contains("an outline of several: :use a OTHER"), "{why}");
    obey(&mut state, "use a b reverse", None).unwrap();
    let parts = json!([{ "shape": "a" }, { "shape": "b", "reverse": true }]);
    assert_eq!(at(&state, &zone("/outline/parts")), parts);
}
