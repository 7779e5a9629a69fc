//! The styles that the program brings: tables of strokes, as data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

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

macro_rules! table {
    ($name:literal) => {
        include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/profiles/styles/", $name, ".json"))
    };
}

/// All of them but none: with its name, what it is for, and its table.
pub const STYLES: [(Style, &str, &str, &str); 9] = [
    (Style::Hatching, "hatching", "parallel pen strokes that grow denser in the dark", table!("hatching")),
    (Style::CrossHatching, "cross-hatching", "pen strokes in layers across one another", table!("cross-hatching")),
    (Style::Stipple, "stipple", "dots that grow denser in the dark", table!("stipple")),
    (Style::Engraving, "engraving", "even lines round the form that swell in the dark", table!("engraving")),
    (Style::Graphite, "graphite", "soft pencil on rough paper", table!("graphite")),
    (Style::Charcoal, "charcoal", "broad, dusty strokes of charcoal", table!("charcoal")),
    (Style::Watercolor, "watercolor", "washes of the surface's own color, with darker edges", table!("watercolor")),
    (Style::FeltTip, "felt-tip", "broad pens in the surface's own color", table!("felt-tip")),
    (Style::Painterly, "painterly", "thick brush strokes round the form", table!("painterly")),
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
        let table = STYLES.iter().find(|(style, ..)| *style == self).map_or("{}", |(_, _, _, table)| table);
        serde_json::from_str(table).unwrap_or_default() // a test reads them all
    }
}
