//! The JSON Schema of a scene, generated from its types, with a range for every number.

use std::sync::LazyLock;

use serde_json::Value;

/// The limit for positions, vectors and plain numbers without a range of their own: every sum and product of a few of
/// them stays finite.
const LARGEST: f64 = 1e9;

/// The units of numbers, each with the range of numbers that have no range of their own; `None` if they may be any
/// finite number. The schema has the unit of every number.
pub(super) const UNITS: [(&str, Option<(f64, f64)>); 16] = [
    (PLAIN, Some((-LARGEST, LARGEST))),
    ("px", Some((-LARGEST, LARGEST))),
    ("m", Some((-LARGEST, LARGEST))),
    ("degrees", Some((-LARGEST, LARGEST))),
    ("cycles", Some((-LARGEST, LARGEST))),
    ("s", Some((-LARGEST, LARGEST))),
    ("m/s", Some((-LARGEST, LARGEST))),
    ("m/s2", Some((-LARGEST, LARGEST))),
    ("1/s", Some((-LARGEST, LARGEST))),
    ("texels", Some((-LARGEST, LARGEST))),
    ("layers", Some((-LARGEST, LARGEST))),
    ("percent", Some((0.0, 100.0))),
    ("fps", Some((-LARGEST, LARGEST))),
    ("frames", Some((-LARGEST, LARGEST))),
    ("passes", None),
    ("timelines", None),
];

/// The unit of fractions, factors and counts; forms show no unit for it.
pub(super) const PLAIN: &str = "1";

/// The range of whole numbers that have no range of their own.
const WHOLE: (f64, f64) = (0.0, u32::MAX as f64);

/// Whether a range is only the one for numbers without a range of their own; messages about other things leave it out.
pub fn is_widest(range: (f64, f64)) -> bool {
    range == WHOLE || UNITS.iter().any(|(_, widest)| *widest == Some(range))
}

static SCHEMA: LazyLock<Value> = LazyLock::new(|| {
    let mut schema = Value::from(schemars::schema_for!(super::Scene));
    bound(&mut schema, None);
    schema
});

/// The JSON Schema of a scene.
pub fn json_schema() -> &'static Value {
    &SCHEMA
}

/// Adds a range to every number in the schema that has none.
fn bound(node: &mut Value, unit: Option<&str>) {
    let own = node.get("unit").and_then(Value::as_str).map(str::to_owned);
    let unit = own.as_deref().or(unit);
    if let Value::Object(map) = node {
        // What may be missing may be null too.
        let numeric = match map.get("type") {
            Some(Value::Array(names)) => names.iter().filter_map(Value::as_str).find(|name| *name != "null"),
            name => name.and_then(Value::as_str),
        };
        if let Some(range) = numeric.and_then(|kind| widest(kind, unit)) {
            map.entry("minimum").or_insert(range[0].clone());
            map.entry("maximum").or_insert(range[1].clone());
        }
    }
    let children: Box<dyn Iterator<Item = &mut Value>> = match node {
        Value::Object(map) => Box::new(map.values_mut()),
        Value::Array(items) => Box::new(items.iter_mut()),
        _ => Box::new(std::iter::empty()),
    };
    children.for_each(|child| bound(child, unit));
}

fn widest(kind: &str, unit: Option<&str>) -> Option<[Value; 2]> {
    match kind {
        "integer" => Some([0.into(), u32::MAX.into()]),
        "number" => {
            let (least, most) = UNITS.iter().find(|(name, _)| Some(*name) == unit)?.1?;
            Some([least.into(), most.into()])
        }
        _ => None,
    }
}

/// A range with its unit in words.
pub fn range_text(range: Option<(f64, f64)>, unit: Option<&str>) -> Option<String> {
    let (min, max) = range?;
    let unit = unit.map(|unit| format!(" {unit}")).unwrap_or_default();
    Some(match (min.is_finite(), max.is_finite()) {
        (true, false) => format!("at least {min}{unit}"),
        (false, true) => format!("at most {max}{unit}"),
        _ => format!("{min} to {max}{unit}"),
    })
}
