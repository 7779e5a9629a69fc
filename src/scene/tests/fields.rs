//! Fields and addresses, which forms, help and completion are made from.

use serde_json::{Value, json};

use super::*;
use crate::layers::KINDS;
use crate::scene::json_schema::{PLAIN, UNITS};
use crate::scene::schema::{Body, Shape};

/// Calls `each` with every field of the schema and its name, once per type.
fn walk(shape: Shape, name: &str, depth: usize, each: &mut impl FnMut(&str, Shape)) {
    each(name, shape);
    if depth > 12 {
        return;
    }
    match shape.body() {
        Body::List(item, ..) | Body::Map(item) => walk(item, name, depth + 1, each),
        Body::Row(count) => (0..count).for_each(|i| walk(shape.part(i).unwrap(), name, depth + 1, each)),
        Body::Object => shape.properties(None).into_iter().for_each(|(name, field)| walk(field, name, depth + 1, each)),
        Body::Tagged(tag) => {
            for (variant, help) in shape.choices() {
                assert!(!help.is_empty(), "{name}: {variant} has no help");
                let chosen = json!({ tag: variant });
                for (name, field) in shape.properties(Some(&chosen)) {
                    // Easings can nest without end.
                    let deeper = if name == "ease" { 20 } else { depth + 1 };
                    walk(field, name, deeper, each);
                }
            }
        }
        _ => {}
    }
}

#[test]
fn every_field_has_help_and_every_number_a_meaning() {
    let mut seen = 0;
    walk(Shape::root(), "scene", 0, &mut |name, shape| {
        seen += 1;
        assert!(!shape.help().is_empty(), "{name} has no help");
        assert!(shape.help().chars().next().is_some_and(|c| !c.is_whitespace()), "{name}");
        if let Body::Choice = shape.body() {
            shape.choices().for_each(|(word, help)| assert!(!help.is_empty(), "{name}: {word} has no help"));
        }
        if let Body::Number { .. } | Body::Numbers(_) = shape.body() {
            let unit = shape.unit().unwrap_or(PLAIN);
            assert!(
                UNITS.iter().any(|(known, _)| *known == unit),
                "{name}: its unit is none of the table's (1 is that of a plain number)"
            );
            let free = ["passes", "timelines"].map(Some).contains(&shape.unit());
            assert_eq!(shape.range().is_none(), free, "{name}: a range");
        }
    });
    assert!(seen > 150, "{seen}");
}

#[test]
fn every_variant_stands_in_a_good_scene() {
    let mut missing = std::collections::BTreeSet::new();
    walk(Shape::root(), "scene", 0, &mut |_, shape| {
        if let Body::Tagged(tag) = shape.body() {
            missing.extend(shape.choices().map(|(variant, _)| (tag, variant)));
        }
    });
    assert!(missing.len() > 30, "{missing:?}");
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scenes/good");
    for entry in std::fs::read_dir(folder).unwrap() {
        let Ok(document) = Document::parse(&std::fs::read_to_string(entry.unwrap().path()).unwrap()) else { continue };
        for (pointer, _) in places(&document) {
            let place = schema::Place::of(document.json(), &pointer).unwrap();
            if let Body::Tagged(tag) = place.shape.body() {
                let variant = place.value.and_then(|value| value.get(tag)?.as_str()).unwrap_or_default();
                missing.retain(|known| *known != (tag, variant));
            }
        }
    }
    assert!(missing.is_empty(), "in no scene of {folder}: {missing:?}");
}

#[test]
fn every_default_has_the_shape_of_its_field() {
    walk(Shape::root(), "scene", 0, &mut |name, shape| {
        if let Some(default) = shape.default() {
            assert!(shape::fits(shape, default), "{name}: {default}");
        }
    });
}

#[test]
fn what_need_not_be_written_has_a_default() {
    for document in [squint(), everything()] {
        for (pointer, field) in places(&document) {
            let is_tag = matches!(field.kind, Kind::Choice(_)) && field.default.is_none();
            if field.optional && !is_tag && !pointer.starts_with("/images/") {
                assert!(field::value(&document, &pointer).is_some(), "{pointer}");
            }
        }
    }
}

#[test]
fn every_place_has_an_address_that_leads_back() {
    for document in [squint(), everything()] {
        let places = places(&document);
        assert!(places.len() > 60);
        for (pointer, _) in places {
            let address = address::address(&document, &pointer);
            assert_eq!(address::resolve(&document, &address).unwrap(), pointer, "{address}");
            assert_eq!(address::resolve(&document, &pointer).unwrap(), pointer);
        }
    }
}

#[test]
fn addresses() {
    let document = squint();
    for (address, expected) in [
        ("", Ok("")),
        ("/layers/0/name", Ok("/layers/0/name")),
        ("layers.face.zones.\"left eye\".interpolation.radius", Ok("/layers/0/zones/0/interpolation/radius")),
        ("layers.0.zones.0.motion.1.nodes.0.at.y", Ok("/layers/0/zones/0/motion/1/nodes/0/at/1")),
        ("layers.0.zones.0.motion.0.jump.dy", Ok("/layers/0/zones/0/motion/0/jump/1")),
        ("layers.0.zones.0.motion.0.jump.y", Ok("/layers/0/zones/0/motion/0/jump/1")),
        ("layers.face.zones.\"left eye\".sampler.offset", Ok("/layers/0/zones/0/sampler/offset")),
        ("images.dog", Ok("/images/dog")),
        ("timeline.fps", Ok("/timeline/fps")),
        ("images.nope.path.x", Err("there is no \"nope\" in images")),
        ("shapes.nope.nodes.0.at", Err("there is no \"nope\" in shapes")),
        ("timeline.fpss", Err("there is no field \"fpss\" in timeline (did you mean \"fps\"?)")),
        ("layers.fase", Err("there is no \"fase\" in layers (did you mean \"face\"?)")),
        ("layers.1", Err("there is no \"1\" in layers (there is \"face\")")),
        ("layers.face.interpolation.radius", Err("there is no field \"interpolation\" in layers.face")),
        ("layers.\"face", Err("a quote is not closed")),
        ("title.x", Err("title has no parts")),
    ] {
        let found = address::resolve(&document, address).map_err(|error| error.to_string());
        match expected {
            Ok(pointer) => assert_eq!(found.as_deref(), Ok(pointer), "{address}"),
            Err(part) => assert!(found.as_ref().is_err_and(|e| e.contains(part)), "{address}: {found:?}"),
        }
    }
}

#[test]
fn fields_tell_what_a_form_needs() {
    let document = squint();
    let field = |path: &str| field::field(&document, path).unwrap();
    let radius = field("/layers/0/zones/0/interpolation/radius");
    assert_eq!((radius.kind, radius.unit, radius.optional), (Kind::Number { integer: false }, Some("px"), false));
    assert_eq!((radius.range, radius.help), (Some((0.001, 1e6)), "Anchors farther than this do not count."));
    let fps = field("/timeline/fps");
    assert_eq!((fps.default, fps.optional), (Some(json!(30.0)), true));
    let jump = field("/layers/0/zones/0/motion/0/jump");
    assert_eq!((jump.kind, jump.unit), (Kind::Numbers(vec!["dx".into(), "dy".into()]), Some("px")));
    assert_eq!(field("/layers/0/image").kind, Kind::Reference("images"));
    assert_eq!(field("/layers/0/zones/0").name, "left eye");
    let Kind::Choice(methods) = field("/layers/0/zones/0/interpolation/method").kind else { panic!() };
    assert_eq!(methods.len(), 5);
    let Kind::List(point) = field("/layers/0/zones/0/outline/points").kind else { panic!() };
    assert_eq!((point.kind, point.unit), (Kind::Numbers(vec!["x".into(), "y".into()]), Some("px")));
    let sampler = field("/layers/0/zones/0/sampler");
    assert_eq!((sampler.kind, sampler.optional), (Kind::Object, true));
    assert_eq!(field::value(&document, "/layers/0/zones/0/sampler"), Some(Value::Null));
    assert!(field::field(&document, "/layers/0/zones/0/radius").is_none());
    assert!(field::field(&document, "/layers/3").is_none());
}

#[test]
fn children_also_list_what_is_not_written() {
    let document = Start::default().picture("cat", "cat.png", (9, 9)).document().unwrap();
    let children = |path: &str| -> Vec<(String, bool)> {
        children(&document, path).into_iter().map(|child| (child.name, child.set)).collect()
    };
    let named = |names: &[(&str, bool)]| names.iter().map(|&(n, s)| (n.to_owned(), s)).collect::<Vec<_>>();
    assert_eq!(children("/timeline"), named(&[("duration", false), ("fps", false), ("loop", false)]));
    assert_eq!(children("/layers"), named(&[("cat", true)]));
    assert_eq!(children("/layers/0/zones/0/interpolation"), named(&[("method", false), ("power", false)]));
    assert_eq!(children("/layers/0/zones/0/fold"), named(&[]));
    let zone = children("/layers/0/zones/0");
    assert_eq!((zone[0].clone(), zone.len()), (("name".into(), true), 10));
}

#[test]
fn a_row_of_several_kinds_is_told_by_its_columns() {
    let fill = KINDS.iter().find(|kind| kind.name == "fill").unwrap();
    let document = Document::parse(fill.example).unwrap();
    let stop = "/layers/0/gradient/stops/1";
    let children: Vec<_> = children(&document, stop).into_iter().map(|child| (child.name, child.pointer)).collect();
    let [along, color] = ["0", "1"].map(|token| format!("{stop}/{token}"));
    assert_eq!(children, [("along".into(), along.clone()), ("color".into(), color.clone())]);
    let pointer = |address: &str| address::resolve(&document, address).unwrap();
    assert_eq!(pointer("layers.ground.gradient.stops.1.color"), color);
    assert_eq!(address::address(&document, &along), "layers.ground.gradient.stops.1.along");
    let found = |value: Value| shape::problems(schema::Place::of(document.json(), stop).unwrap().shape, &value);
    assert_eq!(found(json!([0.5, "#000000"])), []);
    for (value, path) in [(json!([0.5]), ""), (json!([2, "#000000"]), "/0"), (json!([0.5, 1]), "/1"), (json!({}), "")] {
        assert_eq!(
            found(value.clone()).iter().map(|problem| problem.path.as_str()).collect::<Vec<_>>(),
            [path],
            "{value}"
        );
    }
}
