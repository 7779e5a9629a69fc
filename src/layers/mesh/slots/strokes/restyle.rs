//! How a mesh layer changes to another style, and what it is like with each anchor and in each style.

use serde::Deserialize;
use serde_json::Value;

use super::force::{self, Strokes};
use super::model::ANCHORS;
use super::styles::LIST;
use crate::layers::starts::{Comparison, Style, Styles};

/// The styles of mesh layers.
pub static STYLES: Styles = Styles {
    field: "/strokes",
    name: "/style",
    anchor: "/anchor",
    turn: "/direction/turn",
    list: LIST,
    marks: &["ground", "noises", "marks"],
    named,
    own,
    whole,
};

/// Another style keeps what is written, but for noises and marks: they change those of the style that they were written
/// over.
fn named(now: Option<&Value>, name: &str) -> Value {
    let kept = now.and_then(Value::as_object).cloned().unwrap_or_default();
    let kept = kept.into_iter().filter(|(field, _)| !["style", "noises", "marks"].contains(&field.as_str()));
    Value::Object(std::iter::once(("style".to_owned(), name.into())).chain(kept).collect())
}

fn own(table: Value) -> Value {
    let fields = table.as_object().cloned().unwrap_or_default().into_iter().filter(|(field, _)| field != "style");
    Value::Object(std::iter::once(("style".to_owned(), "none".into())).chain(fields).collect())
}

fn whole(written: &Value) -> Result<Value, String> {
    let strokes: Strokes = serde_json::from_value(written.clone()).map_err(|error| error.to_string())?;
    Ok(force::whole(&strokes))
}

/// The comparisons of strokes: with each anchor, in each style.
pub const COMPARISONS: &[Comparison] =
    &[Comparison { by: "anchor", ways: anchors }, Comparison { by: "style", ways: styles }];

/// The layer with all noises fixed to the same.
fn anchors(layer: &Value) -> Vec<(&'static str, Value)> {
    let strokes = layer.get("strokes").filter(|written| written.is_object());
    let Some(strokes) = strokes.and_then(|written| Strokes::deserialize(written).ok()) else { return Vec::new() };
    let anchored = |(_, name): (_, &'static str)| {
        let mut layer = layer.clone();
        layer["strokes"]["anchor"] = name.into();
        for noise in strokes.noises.keys() {
            layer["strokes"]["noises"][noise]["anchor"] = name.into();
        }
        (name, layer)
    };
    ANCHORS.map(anchored).to_vec()
}

/// The layer in every style of the program.
fn styles(layer: &Value) -> Vec<(&'static str, Value)> {
    let Some(now) = layer.get("strokes").filter(|written| written.is_object()) else { return Vec::new() };
    let styled = |style: &'static Style| {
        let mut layer = layer.clone();
        layer["strokes"] = named(Some(now), style.name);
        (style.name, layer)
    };
    LIST.iter().map(styled).collect()
}
