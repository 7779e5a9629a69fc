//! Edits: what they do, their inverses, and that every tag, list and field can be edited.

use crate::base::pointer::Pointer;
use crate::layers::parts::materials::List;
use proptest::prelude::*;
use serde_json::{Value, json};

use super::check::Rules;
use super::*;
use crate::base::problem::Problem;

fn set(document: &Document, address: &str, value: Value) -> Document {
    let path = address::resolve(document, address).unwrap();
    let edit = Edit::set(document, &path, value);
    let changed = document.apply(&edit).unwrap_or_else(|problems| panic!("{address}: {problems:?}"));
    let back = changed.apply(&edit.inverse(document)).unwrap();
    assert_eq!(back.to_text(), document.to_text(), "{address}");
    changed
}

#[test]
fn set_makes_parents_and_keeps_what_fits() {
    let eye = "layers.face.zones.\"left eye\"";
    let zone = |rest: &str| format!("{eye}.{rest}");
    for (address, value, at, expected) in [
        ("interpolation.radius", json!(12), "interpolation", json!({ "method": "modified-shepard", "radius": 12 })),
        ("interpolation.method", json!("thin-plate"), "interpolation", json!({ "method": "thin-plate" })),
        (
            "interpolation.method",
            json!("modified-shepard-random"),
            "interpolation",
            json!({ "method": "modified-shepard-random", "radius": 60, "ring": 12.5 }),
        ),
        (
            "outline.kind",
            json!("rectangle"),
            "outline",
            json!({ "kind": "rectangle", "x": 110, "y": 80, "width": 100, "height": 70 }),
        ),
        ("sampler.offset", json!([1, 2]), "sampler", json!({ "image": "cat", "offset": [1, 2] })),
        ("fold", json!(null), "fold", json!(null)),
        ("feather", json!(null), "feather", json!(0.0)),
        ("motion.0.jump.y", json!(-20), "motion.0", json!({ "tool": "point", "at": [150, 100], "jump": [0, -20] })),
        ("position.function", json!("cosine"), "position", json!({ "function": "cosine", "cycles": 0.5 })),
    ] {
        let changed = set(&squint(), &zone(address), value);
        let path = address::resolve(&changed, &zone(at)).unwrap();
        assert_eq!(field::value(&changed, &path), Some(expected), "{address}");
    }
    let bare = Start::default().picture("cat", "cat.png", (9, 9)).document().unwrap();
    for (address, value, at, expected) in [
        ("timeline.fps", json!(24), "/timeline", json!({ "fps": 24 })),
        (
            "layers.cat.zones.all.interpolation.power",
            json!(3),
            "/layers/0/zones/0/interpolation",
            json!({ "method": "shepard", "power": 3 }),
        ),
        (
            "layers.cat.zones.all.position.function",
            json!("sigmoid"),
            "/layers/0/zones/0/position",
            json!({ "function": "sigmoid" }),
        ),
    ] {
        assert_eq!(set(&bare, address, value).json().pointer(at), Some(&expected), "{address}");
    }
    let changed = set(&squint(), "layers.0.zones.0.fold.rule", json!("mask"));
    assert_eq!(changed.json()["layers"][0]["zones"][0]["fold"], json!({ "rule": "mask", "image": "cat" }));
}

/// Applies `edit` and undoes it.
fn there_and_back(document: &Document, edit: &Edit) -> Result<Document, Vec<Problem>> {
    let changed = document.apply(edit)?;
    let back = changed.apply(&edit.inverse(document)).unwrap();
    assert_eq!(back.to_text(), document.to_text(), "{edit:?}");
    Ok(changed)
}

#[test]
fn every_tag_can_be_chosen_everywhere() {
    let document = everything();
    let mut chosen = 0;
    for (pointer, field) in places(&document) {
        let Kind::Tagged { tag, variants } = &field.kind else { continue };
        for variant in variants {
            let edit = Edit::set(&document, &Pointer(&pointer).join(tag), variant.name.into());
            match there_and_back(&document, &edit) {
                Ok(changed) => assert_eq!(changed.json().pointer(&pointer).unwrap()[tag], variant.name),
                Err(problems) => {
                    let nested = variant.name == "piecewise" && pointer.ends_with("/ease");
                    let both = variant.name == "mask"
                        && ["/layers/0/zones/4/fold", "/layers/0/zones/9/fold"].contains(&&*pointer);
                    assert!(nested || both, "{problems:?}");
                }
            }
            chosen += 1;
        }
    }
    assert!(chosen > 200, "{chosen}");
}

#[test]
fn every_list_takes_new_items_everywhere() {
    let document = everything();
    let mut inserted = 0;
    for (list, field) in places(&document) {
        let Kind::List(_) = field.kind else { continue };
        let fixed = list.ends_with("/matrix");
        let count = children(&document, &list).len();
        for index in 0..=count {
            let (edit, pointer) = Edit::insert_new(&document, &list, index).unwrap();
            match there_and_back(&document, &edit) {
                Ok(changed) => assert!(changed.json().pointer(&pointer).is_some(), "{pointer}"),
                Err(problems) => assert!(fixed, "{list} {index}: {problems:?}"),
            }
            inserted += 1;
        }
    }
    assert!(inserted > 100, "{inserted}");
}

#[test]
fn items_are_duplicated_moved_and_taken_away() {
    let document = everything();
    let names = |document: &Document| -> Vec<String> {
        children(document, "/layers/0/zones").into_iter().map(|child| child.name).collect()
    };
    let (edit, to) = Edit::duplicate(&document, "/layers/0/zones/2").unwrap();
    let changed = there_and_back(&document, &edit).unwrap();
    assert_eq!((to.as_str(), names(&changed)[3].as_str()), ("/layers/0/zones/3", "zone 10"));
    for (from, index) in [(0, 9), (9, 0), (4, 5), (5, 4), (3, 3)] {
        let (edit, _) = Edit::move_item(&document, &format!("/layers/0/zones/{from}"), index).unwrap();
        let changed = there_and_back(&document, &edit).unwrap();
        assert_eq!(names(&changed)[index], format!("zone {from}"));
    }
    assert!(Edit::move_item(&document, "/layers/0/zones/0", 10).is_none());
    assert!(Edit::duplicate(&document, "/title").is_none());
    let mut duplicated = 0;
    for (path, field) in places(&document) {
        let in_list = Pointer(&path).split().is_some_and(|(list, _)| !list.is_empty() && !list.ends_with("/matrix"));
        let Some((edit, _)) = Edit::duplicate(&document, &path).filter(|_| in_list) else { continue };
        if !matches!(field.kind, Kind::Number { .. }) {
            there_and_back(&document, &edit).unwrap_or_else(|problems| panic!("{path}: {problems:?}"));
            duplicated += 1;
        }
    }
    assert!(duplicated > 60, "{duplicated}");
    let changed = there_and_back(&document, &Edit::remove("/layers/0/zones/0")).unwrap();
    assert_eq!(names(&changed).len(), 9);
    // Keys return to where they were, even before others and even if the schema has another order.
    for path in ["/title", "/images/mask", "/layers/0/zones/0/position", "/layers/0/zones/1/speed"] {
        let mut json = document.json().clone();
        let undo = Edit::remove(path);
        undo.patch(&mut json).unwrap();
        undo.inverse(&document).patch(&mut json).unwrap();
        assert!(json::same(&json, document.json()), "{path}");
    }
}

#[test]
fn images_meshes_and_clips_are_renamed_everywhere() {
    let renamed = there_and_back(&everything(), &Edit::rename(&everything(), List::Images, "cat", "dog/1")).unwrap();
    assert!(!renamed.to_text().contains("\"cat\""));
    assert_eq!(renamed.scene().images["dog/1"].path, "cat.png");
    let edit = Edit::rename(&everything(), List::Meshes, "mug", "cup");
    let renamed = there_and_back(&everything(), &edit).unwrap();
    assert!(!renamed.to_text().contains("\"mug\""));
    let renamed = there_and_back(&everything(), &Edit::rename(&everything(), List::Clips, "falls", "river")).unwrap();
    assert_eq!(renamed.scene().names(List::Clips).into_iter().collect::<Vec<_>>(), ["fire", "river"]);
    assert!(!renamed.to_text().contains("\"clip\": \"falls\""));
}

#[test]
fn fields_of_which_one_is_written_replace_each_other() {
    let sampler = |zone: usize, rest: &str| format!("/layers/0/zones/{zone}/sampler{rest}");
    // Zone 4 reads an image, zone 9 a clip, zone 0 neither.
    for (path, value, zone, after) in [
        (sampler(4, "/clip"), json!("fire"), 4, json!({ "offset": [3, -2], "clip": "fire" })),
        (sampler(9, "/image"), json!("mask"), 9, json!({ "offset": [3, -2], "image": "mask" })),
        (sampler(9, "/clip"), json!("fire"), 9, json!({ "clip": "fire", "offset": [3, -2] })),
        (sampler(0, "/clip"), json!("fire"), 0, json!({ "clip": "fire" })),
        (sampler(0, "/offset"), json!([1, 2]), 0, json!({ "image": "cat", "offset": [1, 2] })),
        (sampler(4, "/clip"), json!(null), 4, json!({ "image": "cat", "offset": [3, -2] })),
    ] {
        let changed = there_and_back(&everything(), &Edit::set(&everything(), &path, value)).unwrap();
        assert_eq!(changed.json().pointer(&sampler(zone, "")), Some(&after), "{path}");
    }
    for (path, what) in
        [(sampler(4, "/image"), "\"image\" or \"clip\" is missing"), (sampler(9, "/clip"), "is missing")]
    {
        let problems = everything().apply(&Edit::remove(&path)).unwrap_err();
        assert!(problems[0].message.contains(what), "{path}: {problems:?}");
    }
    let both = everything().apply(&Edit::add(&sampler(4, "/clip"), json!("fire"))).unwrap_err();
    assert_eq!((both.len(), both[0].path.as_str()), (1, sampler(4, "").as_str()), "{both:?}");
}

#[test]
fn what_would_be_wrong_is_refused_with_the_range() {
    let eye = "/layers/0/zones/0";
    for (path, value, message) in [
        ("/feather", json!(-1), "-1 is too small: 0 to 1000000 px"),
        ("/speed", json!("fast"), "expected a number, found the text \"fast\""),
        ("/name", json!(""), "is empty"),
        ("/raduis", json!(1), "unknown field \"raduis\""),
        ("/motion/7/at", json!([1, 2]), "there is nothing here"),
        ("/outline/kind", json!("circle"), "there is no kind \"circle\""),
    ] {
        let path = format!("{eye}{path}");
        let problems = squint().apply(&Edit::set(&squint(), &path, value)).unwrap_err();
        assert_eq!((problems.len(), problems[0].message.as_str()), (1, message), "{path}");
    }
}

#[test]
fn a_patch_of_somebody_else_is_applied_as_rfc_6902_says() {
    let document = Document::parse(r#"{ "plica": 1, "title": "a", "images": { "x": { "path": "x" } } }"#).unwrap();
    for (patch, expected) in [
        (json!([{ "op": "copy", "from": "/images/x", "path": "/images/y" }]), Ok("/images/y/path")),
        (json!([{ "op": "move", "from": "/images/x", "path": "/images/z" }]), Ok("/images/z/path")),
        (json!([{ "op": "move", "from": "/images", "path": "/images/x" }]), Err("cannot be moved into itself")),
        (json!([{ "op": "test", "path": "/title", "value": "a" }, { "op": "remove", "path": "/title" }]), Ok("/plica")),
        (json!([{ "op": "test", "path": "/title", "value": "b" }]), Err("is not what the edit was made for")),
        (json!([{ "op": "replace", "path": "/timeline", "value": {} }]), Err("there is nothing here")),
        (json!([{ "op": "remove", "path": "" }]), Err("the whole scene cannot be removed")),
        (json!([{ "op": "add", "path": "", "value": { "plica": 1 } }]), Ok("/plica")),
    ] {
        let edit: Edit = serde_json::from_value(patch.clone()).unwrap();
        match (there_and_back(&document, &edit), expected) {
            (Ok(changed), Ok(there)) => assert!(changed.json().pointer(there).is_some(), "{patch}"),
            (Err(problems), Err(part)) => assert!(problems[0].message.contains(part), "{patch}: {problems:?}"),
            (found, _) => panic!("{patch}: {found:?}"),
        }
    }
}

/// Anything that may be tried on a document: a value set somewhere; an item added, copied, moved or removed.
fn tried(document: &Document, (action, place, index, value): &(u8, prop::sample::Index, usize, Value)) -> Option<Edit> {
    let places = places(document);
    let (path, _) = place.get(&places);
    match action {
        0 => Edit::insert_new(document, path, *index).map(|(edit, _)| edit),
        1 => Edit::duplicate(document, path).map(|(edit, _)| edit),
        2 => Edit::move_item(document, path, *index).map(|(edit, _)| edit),
        3 => Some(Edit::remove(path)),
        _ => Some(Edit::set(document, path, value.clone())),
    }
}

fn values() -> impl Strategy<Value = Value> {
    let words = &["ellipse", "path", "sine", "keyframes", "rigid", "fly-over", "smooth", "cat", "once", "new name"];
    prop_oneof![
        (-50i32..50).prop_map(Value::from),
        (-2.0..2.0).prop_map(Value::from),
        prop::sample::select(words).prop_map(Value::from),
        (0..40, 0..40).prop_map(|(x, y)| json!([x, y])),
        Just(Value::Null),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn edits_go_there_and_back(
        actions in prop::collection::vec((0u8..8, any::<prop::sample::Index>(), 0usize..4, values()), 1..12),
    ) {
        let start = everything();
        let mut history = History::new(start.clone());
        for action in &actions {
            let Some(edit) = tried(history.document(), action) else { continue };
            if there_and_back(history.document(), &edit).is_ok() {
                history.apply(edit, Stamp { time_ms: 0, held: action.0 > 5 }).unwrap();
            }
        }
        let end = history.document().clone();
        prop_assert_eq!(Document::parse(&end.to_text()).unwrap().to_text(), end.to_text());
        let between = Edit::between(&start, &end);
        prop_assert_eq!(start.apply(&between).unwrap().to_text(), end.to_text());
        while history.undo().is_some() {}
        prop_assert_eq!(history.document().to_text(), start.to_text());
        prop_assert!(history.is_saved());
        while history.redo().is_some() {}
        prop_assert_eq!(history.document().to_text(), end.to_text());
    }
}

/// What a hostile or broken program may write.
fn nasty() -> impl Strategy<Value = Value> {
    let number = prop::sample::select(&[0.0, -0.0, -1.0, 1e-300, 0.5, 1.0, 1e6, 1e9, -1e9, 1e300, -1e308][..]);
    prop_oneof![
        number.clone().prop_map(Value::from),
        (number.clone(), number).prop_map(|(x, y)| json!([x, y])),
        Just(json!([])),
        Just(json!({})),
        Just(Value::Null),
        Just(json!("\u{202e}\u{7}")),
        Just(json!([[[[1]]]])),
        Just(json!(u64::MAX)),
        Just(json!(true)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn nothing_makes_a_check_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), nasty()), 1..6),
        cut in any::<prop::sample::Index>(),
    ) {
        let start = everything();
        let places = places(&start);
        let mut json = start.json().clone();
        for (place, value) in &changes {
            if let Some(target) = json.pointer_mut(&place.get(&places).0) {
                *target = value.clone();
            }
        }
        if let Err(problems) = Document::from_json(json) {
            prop_assert!(!problems.is_empty());
            let steers = |problem: &Problem| problem.to_string().contains(char::from(7));
            prop_assert!(!problems.iter().any(steers));
        }
        let text = start.to_text();
        let end = cut.index(text.len());
        prop_assert!(!text.is_char_boundary(end) || end + 1 >= text.len() || Document::parse(&text[..end]).is_err());
    }
}

#[test]
fn an_edit_makes_no_more_than_it_says() {
    let document = squint();
    let edit = |operations: Vec<Value>| serde_json::from_value::<Edit>(operations.into()).unwrap();
    let doubled = |times: usize| {
        let first = json!({ "op": "add", "path": "/notes", "value": [["x".repeat(1000)]] });
        let copy = json!({ "op": "copy", "from": "/notes", "path": "/notes/-" });
        edit(std::iter::once(first).chain(std::iter::repeat_n(copy, times)).collect())
    };
    let refusal = |edit: &Edit| edit.patch(&mut document.json().clone()).err().map(|problem| problem.message);
    assert_eq!(refusal(&doubled(4)), None);
    assert!(refusal(&doubled(40)).unwrap().contains("copies more than 64 MiB"));
    let mut replay = history::Replay::new(document.json().clone());
    let twelve = doubled(12);
    let refused = (0..100).find_map(|id| replay.edit(&twelve, &twelve, Stamp::default(), id).err());
    assert!(refused.unwrap().message.contains("copies more"), "a journal's edits count together");
    let deep = |levels: usize| (0..levels).fold(json!(1), |inner, _| json!([inner]));
    assert_eq!(refusal(&edit(vec![json!({ "op": "add", "path": "/notes", "value": deep(63) })])), None);
    for operations in [
        vec![json!({ "op": "add", "path": "/notes", "value": deep(64) })],
        vec![
            json!({ "op": "add", "path": "/notes", "value": deep(40) }),
            json!({ "op": "replace", "path": format!("/notes{}", "/0".repeat(40)), "value": deep(40) }),
        ],
    ] {
        assert!(refusal(&edit(operations)).unwrap().contains("deeper than 64"));
    }
}

#[test]
fn a_document_takes_no_more_memory_than_is_allowed() {
    let text = squint().to_text();
    let most = json::bytes_of_text(text.as_bytes());
    assert!(json::bytes(squint().json()) <= most);
    let rules = |memory| Rules { memory, ..Rules::default() };
    let document = Document::parse_under(&text, rules(most)).unwrap();
    let refused = Document::parse_under(&text, rules(most - 1)).unwrap_err();
    assert!(refused[0].hint.as_ref().unwrap().contains("--limit memory"), "{refused:?}");
    let title = |length: usize| Edit::set(&document, "/title", "x".repeat(length).into());
    document.apply(&title(10)).unwrap();
    assert!(document.apply(&title(most as usize)).unwrap_err()[0].message.contains("of memory"));
}

fn of_meshes(layers: &str, camera: &str) -> Document {
    let meshes = r#""meshes": { "cow": { "path": "cow.obj" } }"#;
    Document::parse(&format!(r#"{{ "plica": 1, {camera} {meshes}, "layers": {layers} }}"#)).unwrap()
}

#[test]
fn a_new_layer_shows_what_the_scene_has_and_is_like_the_one_before() {
    let fill = r##"{ "kind": "fill", "name": "sky", "color": "#8899aa" }"##;
    let cow = r#"{ "kind": "mesh", "name": "cow", "mesh": "cow" }"#;
    let camera = r#""camera": {},"#;
    for (layers, camera, kind) in [
        ("[]".to_owned(), "", "mesh"),
        (format!("[{cow}]"), camera, "mesh"),
        (format!("[{cow}, {fill}]"), camera, "fill"),
    ] {
        let document = of_meshes(&layers, camera);
        let (edit, at) = Edit::insert_new(&document, "/layers", 9).unwrap();
        let after = document.apply(&edit).unwrap();
        assert_eq!(after.json().pointer(&at).unwrap()["kind"], kind, "{layers}");
        assert!(after.scene().camera.is_some(), "{layers}: a layer in space brings a camera");
    }
}

#[test]
fn a_layer_that_becomes_a_mesh_brings_a_camera() {
    let document = of_meshes(r##"[{ "kind": "fill", "name": "sky", "color": "#8899aa" }]"##, "");
    let after = document.apply(&Edit::set(&document, "/layers/0/kind", "mesh".into())).unwrap();
    assert_eq!((after.json()["layers"][0]["mesh"].as_str(), &after.json()["camera"]), (Some("cow"), &json!({})));
}

#[test]
fn triples_have_x_y_and_z_and_sizes_are_whole() {
    let document = of_meshes("[]", r#""camera": {},"#);
    let at = address::resolve(&document, "camera.position.y").unwrap();
    assert_eq!((at.as_str(), field::field(&document, &at).unwrap().name.as_str()), ("/camera/position/1", "y"));
    assert_eq!(address::address(&document, "/camera/target/2"), "camera.target.z");
    let problems = document.apply(&Edit::set(&document, "/size", json!([100.5, 100]))).unwrap_err();
    assert_eq!(problems[0].to_string(), "size.x: expected a whole number, found 100.5");
    let after = document.apply(&Edit::set(&document, "/size/0", 200.into())).unwrap();
    assert_eq!(after.json()["size"], json!([200, 720]));
}

#[test]
fn what_keys_of_the_camera_rule_is_told_when_it_is_set() {
    let scene = r#"{ "plica": 1, "layers": [], "camera": { "keys": [{ "at": 0, "position": [0, 1, 4] }, { "at": 1, "fov": 30 }] } }"#;
    let document = Document::parse(scene).unwrap();
    for (path, value, ruled) in [
        ("/camera/position", json!([1, 2, 3]), Some("position")),
        ("/camera/position/0", json!(1), Some("position")),
        ("/camera/fov", json!(20), Some("fov")),
        ("/camera/target", json!([0, 0, 0]), None),
        ("/camera/turn", json!(90), None),
        ("/camera", json!({}), None),
    ] {
        let told = Edit::set(&document, path, value).overruled(&document);
        let expected = ruled
            .map(|field| format!("the camera's keys rule its {field}, so this is not seen (in the editor :camera key"));
        assert_eq!(told.is_some(), expected.is_some(), "{path}: {told:?}");
        assert!(told.unwrap_or_default().starts_with(&expected.unwrap_or_default()), "{path}");
    }
}
