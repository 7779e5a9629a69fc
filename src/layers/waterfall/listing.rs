//! Flow lines as entries, for people and scripts.

use super::automatic::Values;
use super::hash::Random;
use super::lines::{Line, lines};
use super::model::WaterfallLayer;
use crate::layers::parts::readout::{Entry, Value};

/// Calls `each` with every line, in the order of their numbers, with so many places evenly over its life.
pub fn list(layer: &WaterfallLayer, samples: usize, each: &mut dyn FnMut(Vec<Entry>)) {
    let values = Values::of(layer);
    let all = lines(&values, &layer.foam, Random(layer.seed));
    all.iter().for_each(|line| each(entries(&values, line, samples)));
}

fn entries(values: &Values, line: &Line, samples: usize) -> Vec<Entry> {
    let entry = |key, value| Entry { key, label: key, value };
    let place = |v: glam::DVec3| Value::Coordinates(v.to_array().to_vec(), "m");
    let at = |age: f64| values.laws.at(&line.path, age);
    let (end, last) = at(line.life);
    let kind = if line.foam { "foam" } else { "water" };
    let sample = |i: usize| {
        let age = line.life * i as f64 / (samples.max(2) - 1) as f64;
        let (place_at, velocity) = at(age);
        vec![
            entry("age", Value::Number(age)),
            entry("at", place(place_at)),
            entry("speed", Value::Number(velocity.length())),
        ]
    };
    let velocity = Value::Coordinates(line.path.velocity.to_array().to_vec(), "m/s");
    vec![
        entry("line", Value::Index(line.number as usize)),
        entry("kind", Value::Of(Some(kind.to_owned()))),
        entry("start", place(line.path.start)),
        entry("velocity", velocity),
        entry("life", Value::Number(line.life)),
        entry("end", place(end)),
        entry("impact", Value::Number(last.length())),
        entry("samples", Value::Items((0..samples).map(sample).collect())),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_is_listed_with_places_from_its_start_to_its_end() {
        let layer: WaterfallLayer = serde_json::from_str(r#"{"name": "f", "lines": 3, "foam": {"lines": 2}}"#).unwrap();
        let mut found = Vec::new();
        list(&layer, 5, &mut |entries| found.push(entries));
        let of = |line: usize, key: &str| found[line].iter().find(|entry| entry.key == key).unwrap().value.clone();
        assert_eq!(found.len(), 9);
        assert_eq!((of(0, "kind"), of(3, "kind")), (Value::Of(Some("water".into())), Value::Of(Some("foam".into()))));
        for line in 0..9 {
            let Value::Items(samples) = of(line, "samples") else { panic!("no samples") };
            assert_eq!((samples.len(), &samples[0][1].value), (5, &of(line, "start")));
            assert_eq!((&samples[4][0].value, &samples[4][1].value), (&of(line, "life"), &of(line, "end")));
        }
    }
}
