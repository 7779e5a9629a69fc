//! How a mesh layer changes to another style.

use serde_json::Value;

use super::force::{self, Strokes};
use super::styles::LIST;
use crate::layers::starts::Styles;

/// The styles of mesh layers.
pub static STYLES: Styles = Styles { field: "/strokes", name: "/style", list: LIST, named, own, whole };

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
