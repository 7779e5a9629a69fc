//! The styles that the program brings: tables of strokes, as data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::layers::starts;

/// Where strokes come from. Its doc comments say what each is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Style {
    /// From nothing: there is only what is written.
    None,
    /// Parallel pen strokes that grow denser in the dark.
    #[default]
    Hatching,
    /// Pen strokes in layers across one another.
    CrossHatching,
    /// Dots that grow denser in the dark.
    Stipple,
    /// Even lines round the form that swell in the dark, as in copper.
    Engraving,
    /// Soft pencil on rough paper.
    Graphite,
    /// Broad, dusty strokes of charcoal.
    Charcoal,
    /// Washes of the surface's own color, with darker edges.
    Watercolor,
    /// Broad pens in the surface's own color.
    FeltTip,
    /// Thick brush strokes round the form.
    Painterly,
}

macro_rules! style {
    ($name:literal, $help:literal) => {
        starts::Style {
            name: $name,
            help: $help,
            table: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/profiles/styles/", $name, ".json")),
        }
    };
}

/// The styles that the program brings.
pub const LIST: &[starts::Style] = &[
    style!("hatching", "parallel pen strokes that grow denser in the dark"),
    style!("cross-hatching", "pen strokes in layers across one another"),
    style!("stipple", "dots that grow denser in the dark"),
    style!("engraving", "even lines round the form that swell in the dark"),
    style!("graphite", "soft pencil on rough paper"),
    style!("charcoal", "broad, dusty strokes of charcoal"),
    style!("watercolor", "washes of the surface's own color, with darker edges"),
    style!("felt-tip", "broad pens in the surface's own color"),
    style!("painterly", "thick brush strokes round the form"),
];

impl Style {
    /// The style that strokes name; hatching if they name none, and if the name is unknown.
    pub fn named(written: Option<&Value>) -> Style {
        match written {
            None => Style::default(),
            Some(Value::Null) => Style::None,
            Some(name) => serde_json::from_value(name.clone()).unwrap_or_default(),
        }
    }

    /// Its table; empty for none.
    pub fn table(self) -> Value {
        let name = serde_json::to_value(self).unwrap_or_default();
        let table = LIST.iter().find(|style| name == style.name).map_or("{}", |style| style.table);
        serde_json::from_str(table).unwrap_or_default() // a test reads them all
    }
}
