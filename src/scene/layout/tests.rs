//! The layout of a text under edits: with examples, and with any text under any edit.

use proptest::prelude::*;
use serde_json::json;

use super::*;

/// A scene as somebody might write it by hand.
const BY_HAND: &str = concat!(
    "{ \"title\":\"by hand\",\n\n",
    "    \"plica\" : 1,\n",
    "  \"layers\": [ {\"name\": \"a\", \"size\": 1e1},\n",
    "              {\"name\": \"b\",\n               \"size\": 2.50,   \"at\": [1, 2.0,\n  3] },\n",
    "              {\"name\": \"c\", \"size\": 3}\n  ],\n",
    "\t\"last\": \"\\u00fc\"}"
);

fn edited(source: &str, edit: impl FnOnce(&mut Value)) -> String {
    let mut value = json::parse(source).unwrap();
    edit(&mut value);
    let text = rewrite(source, &value);
    assert!(json::same(&json::parse(&text).unwrap(), &value), "{text}");
    text
}

#[test]
fn what_is_not_touched_keeps_its_bytes() {
    let set = |pointer: &'static str, value: Value| move |all: &mut Value| *all.pointer_mut(pointer).unwrap() = value;
    let remove = |list: &'static str, at: usize| {
        move |all: &mut Value| drop(all.pointer_mut(list).unwrap().as_array_mut().unwrap().remove(at))
    };
    let insert =
        |at: usize, value: Value| move |all: &mut Value| all["layers"].as_array_mut().unwrap().insert(at, value);
    let a = "{\"name\": \"a\", \"size\": 1e1},\n              ";
    let b = "{\"name\": \"b\",\n               \"size\": 2.50,   \"at\": [1, 2.0,\n  3] },\n              ";
    let new = "{ \"name\": \"new\" }";
    type Case = (Box<dyn FnOnce(&mut Value)>, &'static str, String);
    let cases: Vec<Case> = vec![
        (Box::new(set("/layers/2/size", json!(4))), "\"c\", \"size\": 3", "\"c\", \"size\": 4".into()),
        (Box::new(set("/layers/1/at/1", json!(7.5))), "2.0,\n", "7.5,\n".into()),
        (Box::new(set("/title", json!("x\"y"))), "\"by hand\"", "\"x\\\"y\"".into()),
        (Box::new(set("/layers/1/at", json!([1, 3]))), "[1, 2.0,\n  3]", "[1,\n  3]".into()),
        (Box::new(remove("/layers", 0)), a, String::new()),
        (Box::new(remove("/layers", 1)), b, String::new()),
        (Box::new(remove("/layers", 2)), ",\n              {\"name\": \"c\", \"size\": 3}", String::new()),
        (Box::new(insert(0, json!({ "name": "new" }))), a, format!("{new},\n              {a}")),
        (Box::new(insert(1, json!({ "name": "new" }))), a, format!("{a}{new},\n              ")),
        (Box::new(insert(3, json!({ "name": "new" }))), "\"size\": 3}", format!("\"size\": 3}},\n              {new}")),
        (
            Box::new(|all| drop(all.as_object_mut().unwrap().shift_remove("plica"))),
            "    \"plica\" : 1,\n",
            String::new(),
        ),
        (Box::new(|all| all["more"] = json!(true)), "\"\\u00fc\"}", "\"\\u00fc\",\n\t\"more\":true}".into()),
        (Box::new(|all| all["layers"][2]["on"] = json!([1, 2])), "3}", "3, \"on\": [1, 2]}".into()),
    ];
    for (edit, old, expected) in cases {
        let (from, to) = (BY_HAND.to_owned(), BY_HAND.replacen(old, &expected, 1));
        assert_ne!(from, to, "{old}");
        // A blank line or an indentation may go with what was after it, nothing else.
        let text = edited(BY_HAND, edit);
        let squeezed = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(squeezed(&text), squeezed(&to), "{old}");
        let kept = to.lines().filter(|line| !text.lines().any(|other| other == *line)).count();
        assert!(kept <= 1, "{text}\n-- instead of\n{to}");
    }
}

#[test]
fn an_item_that_moves_takes_its_text_along() {
    let text = edited(BY_HAND, |all| all["layers"].as_array_mut().unwrap().swap(0, 1));
    assert!(text.contains("\"size\": 2.50,   \"at\": [1, 2.0,\n  3] }") && text.contains("\"size\": 1e1}"), "{text}");
    let source = "{\n  \"images\": { \"cat\":  { \"path\":\"cat.png\"} },\n  \"x\": 1e0\n}\n";
    let renamed = edited(source, |all| all["images"] = json!({ "dog": { "path": "cat.png" } }));
    assert_eq!(renamed, source.replace("\"cat\":", "\"dog\":"));
}

#[test]
fn an_edit_beside_a_deletion_finds_its_item() {
    let source =
        "[\n  {\"name\": \"a\", \"x\": 1e0},\n  {\"name\": \"b\", \"x\": 2e0},\n  {\"name\": \"c\", \"x\": 3e0}\n]\n";
    let text = edited(source, |all| {
        all[2]["x"] = json!(9);
        all.as_array_mut().unwrap().remove(1);
    });
    assert_eq!(text, "[\n  {\"name\": \"a\", \"x\": 1e0},\n  {\"name\": \"c\", \"x\": 9}\n]\n");
}

#[test]
fn line_ends_indentation_and_the_end_of_the_file_stay() {
    for (source, expected) in [
        (
            "{\r\n\t\"a\": 1,\r\n\t\"b\": 2\r\n}",
            "{\r\n\t\"a\": {\r\n\t\t\"c\": {\r\n\t\t\t\"d\": {}\r\n\t\t}\r\n\t},\r\n\t\"b\": 2\r\n}",
        ),
        ("\u{feff}{\"a\":1,\"b\":2}", "\u{feff}{\"a\":{\"c\":{\"d\":{}}},\"b\":2}"),
        ("{ \"a\": 1, \"b\": 2 }\n\n", "{ \"a\": { \"c\": { \"d\": {} } }, \"b\": 2 }\n\n"),
        (
            "{\n    \"a\": 1.0,\n    \"b\": 2\n}\n",
            "{\n    \"a\": {\n        \"c\": {\n            \"d\": {}\n        }\n    },\n    \"b\": 2\n}\n",
        ),
    ] {
        assert_eq!(edited(source, |all| all["a"] = json!({ "c": { "d": {} } })), expected);
    }
}

#[test]
fn a_text_of_our_own_is_laid_out_as_ever() {
    let source = json::to_text(&json!({ "a": [[1, 2]], "b": 1 }));
    let value = json!({ "a": (0..100).map(|i| [i, i]).collect::<Vec<_>>(), "b": 1 });
    assert_eq!(rewrite(&source, &value), json::to_text(&value));
    assert_eq!(rewrite("no JSON", &value), json::to_text(&value));
    assert_eq!(rewrite("{\"b\":1}", &json!({ "b": 1 })), "{\"b\":1}");
}

/// Values that are not deeply nested.
fn values() -> impl Strategy<Value = Value> {
    let plain = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        (0..5_i64).prop_map(Value::from),
        (0..5_i64).prop_map(|n| Value::from(n as f64 * 2.5)),
        "[a\"\\\\ü,:\\[{]{0,3}".prop_map(Value::from),
    ];
    plain.prop_recursive(4, 40, 6, |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..6).prop_map(Value::from),
            prop::collection::vec(("[a-f]", inner), 0..6)
                .prop_map(|fields| Value::Object(fields.into_iter().collect())),
        ]
    })
}

/// `value` as somebody might write it: with any white space, by the bits of `whim`.
fn by_hand(value: &Value, whim: &mut u64, out: &mut String) {
    let mut blank = |out: &mut String| {
        *whim = whim.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        out.push_str(["", " ", "\n", "\r\n  ", "\t", "  \n\n ", "", " "][(*whim >> 61) as usize]);
    };
    blank(out);
    match value {
        Value::Object(map) => {
            out.push('{');
            for (i, (key, value)) in map.iter().enumerate() {
                out.push_str(if i > 0 { "," } else { "" });
                by_hand(&Value::from(key.as_str()), whim, out);
                out.push(':');
                by_hand(value, whim, out);
            }
            out.push('}');
        }
        Value::Array(items) => {
            out.push('[');
            for (i, item) in items.iter().enumerate() {
                out.push_str(if i > 0 { "," } else { "" });
                by_hand(item, whim, out);
            }
            out.push(']');
        }
        Value::Number(number) if number.is_f64() => out.push_str(&format!("{:e}", number.as_f64().unwrap())),
        other => out.push_str(&other.to_string()),
    }
    *whim = whim.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
    out.push_str(["", " ", "\n", ""][(*whim >> 62) as usize]);
}

/// Every value of `value` with its pointer.
fn all_of(value: &Value, pointer: String, found: &mut Vec<String>) {
    found.push(pointer.clone());
    match value {
        Value::Object(map) => map.iter().for_each(|(key, value)| all_of(value, format!("{pointer}/{key}"), found)),
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(i, item)| all_of(item, format!("{pointer}/{i}"), found));
        }
        _ => {}
    }
}

/// The value whatever its spelling: `1e0` reads as `1.0`.
fn plainly(text: &str) -> Value {
    json::parse(text).unwrap()
}

proptest! {
    #[test]
    fn any_text_becomes_any_value(old in values(), new in values(), whim: u64) {
        let mut source = String::new();
        by_hand(&old, &mut whim.clone(), &mut source);
        let text = rewrite(&source, &new);
        prop_assert!(json::same(&plainly(&text), &new), "{source}\n->\n{text}");
    }

    #[test]
    fn one_value_changes_and_all_other_bytes_stay(old in values(), new in values(), whim: u64, at: prop::sample::Index) {
        let mut source = String::new();
        by_hand(&old, &mut whim.clone(), &mut source);
        // Parsed as scenes are: numbers as spelled in the text.
        let old = plainly(&source);
        let mut pointers = Vec::new();
        all_of(&old, String::new(), &mut pointers);
        let pointer = at.get(&pointers);
        let mut changed = old.clone();
        *changed.pointer_mut(pointer).unwrap() = new;
        let text = rewrite(&source, &changed);
        prop_assert!(json::same(&plainly(&text), &changed));
        if source != json::to_text(&old) {
            let same_ahead = source.bytes().zip(text.bytes()).take_while(|(a, b)| a == b).count();
            let same_behind = source.bytes().rev().zip(text.bytes().rev()).take_while(|(a, b)| a == b).count();
            let start = find(&source, pointer);
            let end = spans::end(&source, start).unwrap();
            prop_assert!(same_ahead >= start && same_behind >= source.len() - end, "{pointer}\n{source}\n->\n{text}");
        }
    }
}

/// Where the value at `pointer` begins in `source`.
fn find(source: &str, pointer: &str) -> usize {
    let mut at = spans::start(source);
    for token in pointer.split('/').skip(1) {
        let elements = spans::elements(source, at).unwrap();
        let by_key = elements.iter().find(|element| element.key.as_deref() == Some(token));
        at = by_key.unwrap_or_else(|| &elements[token.parse::<usize>().unwrap()]).value;
    }
    at
}
