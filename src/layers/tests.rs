//! The list of techniques against the schema, and what every technique says of itself.

use std::collections::BTreeSet;

use super::{KINDS, Layer};

/// The variants of a tagged type, from its schema.
pub fn variants<T: schemars::JsonSchema>(tag: &str) -> Vec<String> {
    let schema = serde_json::Value::from(schemars::schema_for!(T));
    let branches = schema["oneOf"].as_array().unwrap();
    branches.iter().map(|branch| branch["properties"][tag]["const"].as_str().unwrap().to_owned()).collect()
}

/// The words of a choice, from its schema.
pub fn words<T: schemars::JsonSchema>() -> Vec<String> {
    let schema = serde_json::Value::from(schemars::schema_for!(T));
    let of = |list: &serde_json::Value| list.as_array().cloned().unwrap_or_default();
    let word = |one: serde_json::Value| one.get("const").unwrap_or(&one).as_str().map(str::to_owned);
    of(&schema["oneOf"]).into_iter().chain(of(&schema["enum"])).filter_map(word).collect()
}

#[test]
fn every_kind_of_layer_is_in_the_list() {
    let listed: BTreeSet<String> = KINDS.iter().map(|kind| kind.name.to_owned()).collect();
    assert_eq!(listed.len(), KINDS.len());
    assert_eq!(variants::<Layer>("kind").into_iter().collect::<BTreeSet<_>>(), listed);
}

#[test]
fn what_a_layer_counts_has_a_limit() {
    for kind in KINDS {
        let scene: serde_json::Value = serde_json::from_str(kind.example).unwrap();
        let layers: Vec<Layer> = serde_json::from_value(scene["layers"].clone()).unwrap();
        let mut counted = BTreeSet::new();
        for layer in &layers {
            let own = layer.technique().kind();
            layer.technique().counts(&mut |count| {
                assert!(own.counted.iter().any(|row| row.name == count.what), "{}: {}", own.name, count.what);
                counted.insert((own.name, count.what));
            });
        }
        // The other way: the example of a technique has everything that it limits.
        for row in kind.counted {
            assert!(counted.contains(&(kind.name, row.name)), "{} counts no {}", kind.name, row.name);
        }
    }
}
