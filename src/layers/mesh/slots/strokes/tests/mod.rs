//! Strokes in the document: what is in force, what is wrong, and what is told of it.

use serde_json::{Value, json};

mod promises;

use super::check;
use super::force::{self, Strokes, in_force};
use super::marks::{Ink, Outline, Pigment, Set};
use super::model::{Along, Direction, Force, Noise};
use super::restyle::STYLES;
use super::styles::Style;
use crate::layers::starts;

fn read(written: Value) -> Strokes {
    serde_json::from_value(written).unwrap()
}

fn marks(strokes: &Strokes) -> Vec<(&str, Set)> {
    strokes.marks.iter().map(|mark| (mark.name.as_str(), Set::of(mark).unwrap())).collect()
}

fn messages(written: Value) -> Vec<String> {
    check::problems(&read(written)).iter().map(ToString::to_string).collect()
}

#[test]
fn one_number_of_a_style_is_one_line() {
    let found = read(json!({
        "style": "cross-hatching", "ink": "#20304a", "direction": { "along": "curvature", "angle": 30 },
        "noises": { "a": { "spacing": 9 }, "c": null, "d": {} },
        "marks": [ { "name": "deep", "off": true }, { "name": "first", "amount": 0.5, "shade": null },
            { "name": "new", "kind": "pigment", "noise": "d" } ]
    }));
    assert_eq!((found.ink.as_str(), found.paper.as_str(), found.size), ("#20304a", "#f6f1e6", 1.0));
    assert_eq!(found.direction, Direction { along: Along::Curvature, angle: 30.0, ..Direction::default() });
    assert_eq!(found.noises.keys().collect::<Vec<_>>(), ["a", "b", "d"]);
    assert_eq!((found.noises["a"].spacing, found.noises["a"].regularity), (9.0, 3.0));
    assert_eq!(found.noises["d"], Noise::default());
    let marks = marks(&found);
    assert_eq!(marks.iter().map(|(name, _)| *name).collect::<Vec<_>>(), ["first", "across", "contour", "new"]);
    let Set::Ink(first) = &marks[0].1 else { panic!("{:?}", marks[0]) };
    assert_eq!((first.amount, first.from, first.shade, first.noise.as_str()), (0.5, 0.95, 1.0, "a"));
    assert_eq!(marks[3].1, Set::Pigment(Pigment { noise: "d".into(), strength: 0.5 }));
}

#[test]
fn null_clears_what_may_be_nothing_and_is_else_as_if_it_were_not_there() {
    let style = json!({ "size": 2, "vary": { "by": "light" }, "noises": { "a": { "direction": { "angle": 3 } } },
        "marks": [{ "name": "m", "grain": { "noise": "a", "amount": 1 }, "width": 3 }] });
    let own = json!({ "size": null, "vary": null, "noises": { "a": { "direction": null } },
        "marks": [{ "name": "m", "grain": null, "width": null }] });
    let expected = json!({ "size": 2, "noises": { "a": {} }, "marks": [{ "name": "m", "width": 3 }] });
    assert_eq!(in_force(&style, &own), expected);
}

#[test]
fn without_a_style_there_is_only_what_is_written() {
    for none in [json!("none"), Value::Null] {
        let found = read(json!({ "style": none }));
        assert_eq!((&found.noises.len(), &found.marks.len()), (&0, &0));
        assert_eq!(check::problems(&found).len(), 1, "nothing will show");
    }
    assert_eq!(*read(json!({})), *read(json!({ "style": "hatching" })));
}

#[test]
fn every_style_is_whole_and_says_so_itself() {
    for starts::Style { name, .. } in STYLES.list {
        let found = read(json!({ "style": name }));
        let style = found.style;
        assert!(style != Style::None && (style == Style::default()) == (*name == "hatching"), "{name}");
        assert_eq!(check::problems(&found), [], "{name}");
        assert_ne!(style.table(), Value::Null, "{name}");
        // Written whole, over nothing, it is the same.
        let whole = read(over_nothing(force::whole(&found)));
        assert_eq!(marks(&whole), marks(&found), "{name}");
        let marks = found.marks.clone();
        assert_eq!(Force { style, marks, ..(*whole).clone() }, *found, "{name}");
    }
    assert_eq!(Style::named(Some(&json!("felt-tip"))), Style::FeltTip);
}

fn over_nothing(whole: Value) -> Value {
    (STYLES.own)(whole)
}

#[test]
fn another_style_keeps_all_but_noises_and_marks() {
    let now = json!({ "ink": "#20304a", "style": "stipple", "noises": { "a": null }, "marks": [] });
    assert_eq!((STYLES.named)(Some(&now), "charcoal"), json!({ "style": "charcoal", "ink": "#20304a" }));
    assert_eq!((STYLES.named)(None, "charcoal"), json!({ "style": "charcoal" }));
    let whole = (STYLES.whole)(&json!({ "style": "stipple", "size": 2 })).unwrap();
    assert_eq!((&whole["size"], &whole["marks"][0]["opacity"], whole.get("style")), (&json!(2), &json!(1), None));
}

#[test]
fn what_is_not_written_is_told() {
    let found = read(json!({ "style": "engraving", "noises": { "line": { "overlap": 9 } },
        "marks": [{ "name": "contour" }, { "name": "cross", "from": 0.5 }] }));
    for (path, expected) in [
        ("/direction/along", Some(json!("curvature"))),
        ("/noises/line/spacing", Some(json!(5))),
        ("/marks/0/width", Some(json!(1.2))),
        ("/marks/1/amount", Some(json!(0.55))),
        ("/marks/1/width", None),
        ("/tone/dark", Some(json!(0.25))),
        ("/style", Some(json!("hatching"))),
    ] {
        assert_eq!(found.value(path), expected, "{path}");
    }
    assert_eq!((found.place_of("cross"), found.place_of("line")), ("/marks/1".into(), "/marks".into()));
}

fn are_told(cases: &[(Value, &str)]) {
    for (written, expected) in cases {
        let found = messages(written.clone());
        assert!(found.iter().any(|message| message == expected), "{written}\n{expected}\n{found:#?}");
    }
}

#[test]
fn what_is_wrong_is_told_with_its_place_and_the_cure() {
    are_told(&[
        (json!({ "ink": "red" }), "ink: \"red\" is no color (as #20304a)"),
        (json!({ "ink": "#20304a80" }), "ink: \"#20304a80\" is no color (as #20304a)"),
        (json!({ "tone": { "dark": 0.95 } }), "tone.dark: dark is not below light (0.95 and 0.9) (make it smaller)"),
        (
            json!({ "noises": { "a": { "spacing": 400, "regularity": 4 } } }),
            "noises.a.spacing: spacing 400 times regularity 4 times size 1 gives waves of radius 1600.000 px (1 to 1000 px are drawn) (the nearest spacing is 250.0000)",
        ),
        (
            json!({ "size": 0.1, "vary": { "by": "facing", "low": 0.5, "high": 1 } }),
            "noises.a.spacing: spacing 7.5 times regularity 2.4 times size 0.1 gives waves of radius 0.900 px (1 to 1000 px are drawn) (the nearest spacing is 8.3333)",
        ),
        (
            json!({ "noises": { "a": null } }),
            "noises.a: the mark \"light\" is made of the noise \"a\", which is not there (there are \"b\", \"c\": give the mark one of them, or \"off\": true)",
        ),
        (
            json!({ "style": "watercolor", "noises": { "a": { "spacing": 9 } } }),
            "noises.a: warning: no mark is made of the noise \"a\" (name it as the noise of a mark, or remove it)",
        ),
        (
            json!({ "direction": { "along": "axis", "axis": [0, 0, 0] } }),
            "direction.axis: the axis has no direction (make it [0, 1, 0] for strokes that run up and down)",
        ),
        (
            json!({ "noises": { "b": { "direction": { "along": "image" } } } }),
            "noises.b.direction.image: strokes along an image name none (name an image of the scene; along curvature needs none)",
        ),
        (
            json!({ "style": "none", "ground": "clear", "noises": { "a": {} }, "marks": [{ "name": "p", "kind": "relief", "noise": "a" }] }),
            "marks: warning: nothing will show: the ground is clear, and no mark is ink or an outline",
        ),
    ]);
}

#[test]
fn what_is_wrong_with_marks_is_told_with_its_place_and_the_cure() {
    are_told(&[
        (
            json!({ "marks": [{ "name": "drak", "off": true }] }),
            "marks.0.name: warning: the style has no mark \"drak\" that could be left out (did you mean \"dark\"?)",
        ),
        (
            json!({ "marks": [{ "name": "light", "grain": { "noise": "bb", "amount": 1 } }] }),
            "marks.0.grain.noise: the mark \"light\" is made of the noise \"bb\", which is not there (there are \"a\", \"b\", \"c\")",
        ),
        (
            json!({ "marks": [{ "name": "new" }] }),
            "marks.0: the mark \"new\" has no kind, and the style has no \"new\" (give it a kind: ink, pigment, relief or outline)",
        ),
        (
            json!({ "marks": [{ "name": "p", "kind": "pigment", "noise": "a", "strength": 2 }] }),
            "marks.0.strength: 2 is too large: the strength of pigment is 0 to 1",
        ),
        (
            json!({ "marks": [{ "name": "dark", "color": "blue" }] }),
            "marks.0.color: \"blue\" is no color (ink, paper, scene, or as #20304a)",
        ),
        (
            json!({ "marks": [{ "name": "dark" }, { "name": "dark" }] }),
            "marks.1.name: the name \"dark\" is taken (number 0 of the list has it)",
        ),
    ]);
}

#[test]
fn too_many_waves_are_refused_before_they_are_made() {
    let grain =
        |overlap: f64| read(json!({ "noises": { "a": { "spacing": 2.5, "regularity": 0.4, "overlap": overlap } } }));
    assert_eq!(check::too_many(&grain(8.0), (1920, 1080), 0.0), None);
    let problem = check::too_many(&grain(128.0), (1920, 1080), 0.0).unwrap();
    assert_eq!(problem.path, "/noises/a");
    assert!(problem.to_string().ends_with("(raise spacing or lower overlap)"), "{problem}");
    let texture = read(json!({ "anchor": "texture" }));
    assert_eq!(check::too_many(&texture, (9000, 9000), 1e6), None, "the surface counts, not the frame");
    assert!(check::too_many(&texture, (90, 90), 1e10).is_some());
}

#[test]
fn images_are_named_where_they_count() {
    let found = read(json!({ "direction": { "along": "image", "image": "flow" }, "vary": { "image": "unused" },
        "noises": { "a": { "vary": { "by": "image", "image": "size", "low": 1, "high": 2 } } } }));
    let expected = [("/direction/image".to_owned(), "flow"), ("/noises/a/vary/image".to_owned(), "size")];
    assert_eq!(check::images(&found), expected);
    let problem = check::without_uv(&found, "cow", 4).unwrap();
    assert!(problem.message.contains("\"flow\" needs texture coordinates"), "{problem}");
    assert!(check::without_uv(&read(json!({})), "cow", 4).is_none());
}

#[test]
fn every_kind_of_mark_has_its_own_defaults() {
    let of = |kind: &str| {
        let found = read(json!({ "style": "none", "marks": [{ "name": "m", "kind": kind }] }));
        Set::of(&found.marks[0]).unwrap()
    };
    assert!(matches!(of("ink"), Set::Ink(Ink { from: 1.0, to: 0.0, amount: 1.0, softness: 1.0, rim: 0.0, .. })));
    assert!(matches!(of("relief"), Set::Relief(relief) if (relief.strength, relief.angle) == (0.3, 135.0)));
    assert!(matches!(of("outline"), Set::Outline(Outline { width: 1.5, step: 4.0, creases: None, .. })));
}
