//! Waterfalls of texture sprites (after Guan et al., "Video Input Synthesize Waterfall Scenes"): sprites cut from a clip of
//! real water are carried along flow lines that obey gravity, drag and wind, change from one picture to the next on their
//! way, and are splatted from any viewpoint.

pub mod album;
pub mod automatic;
pub mod between;
pub mod births;
pub mod blend;
pub mod cells;
pub mod check;
pub mod color;
pub mod drag;
pub mod draw;
pub mod frame;
pub mod hash;
pub mod landing;
pub mod lines;
pub mod listing;
pub mod look;
pub mod marks;
pub mod model;
pub mod noise;
pub mod passes;
pub mod path;
pub mod picking;
pub mod plan;
pub mod presets;
pub mod probe;
pub mod ready;
pub mod splat;
pub mod sprites;
pub mod strip;
pub mod synth;
pub mod turned;
pub mod upload;

use std::borrow::Cow;
use std::sync::Arc;

use glam::DVec3;
use kurbo::Rect;
use serde_json::{Value, json};

use self::model::WaterfallLayer;
use super::parts::derived::Derived;
use super::parts::goal::Goal;
use super::parts::marks::Mark;
use super::parts::materials::{List, Materials, Of, Use, What};
use super::parts::moment::{Moment, Space};
use super::parts::pass::{self, Pass};
use super::parts::picking::Picks;
use super::parts::readout::{Entry, ReadOut};
use super::ready::{Making, Ready};
use super::space::eye::Ray;
use super::starts::{NewLayer, Starts, Template, halfway};
use super::technique::{Checked, Kind, Technique};
use crate::base::problem::Problem;

/// The technique.
pub static KIND: Kind = Kind {
    name: "waterfall",
    space: Space::World,
    programs: &[&[&plan::PROGRAM]],
    routines: &[],
    twins: &[plan::TWINS],
    bundle: None,
    counted: &[],
    overlays: &[marks::OVERLAYS],
    passes: &[&[passes::LINES, passes::SPRITES]],
    looks: &[marks::LOOKS],
    template: Some(Template { of: List::Clips, layer: template, ground: Some(GROUND) }),
    blank: None,
    starts: Starts { start, ascending, item, ..Starts::PLAIN },
    presets: presets::PRESETS,
    styles: None,
    comparisons: &[],
    example: include_str!("example.json"),
};

impl Technique for WaterfallLayer {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn name(&self) -> &str {
        &self.name
    }

    fn check(&self, _before: Option<(&dyn Technique, &Checked)>) -> Checked {
        Checked(vec![check::problems(self).into()])
    }

    fn memory(&self) -> Vec<(String, u64)> {
        vec![("/sprites".into(), sprites::bytes_of(&self.sprites))]
    }

    fn moves(&self) -> bool {
        true
    }

    fn check_materials(&self, materials: &Materials) -> Vec<Problem> {
        let sources = synth::sources(self, materials);
        sources.map_or_else(|_| Vec::new(), |sources| check::with_sources(self, &sources))
    }

    /// A clip in which nothing moves is only known once sprites are looked for.
    fn check_made(&self, making: &Making) -> Vec<Problem> {
        synth::Synth::new(self, making, None).err().into_iter().collect()
    }

    fn uses(&self) -> Vec<Use<'_>> {
        let clip =
            self.clip.iter().map(|clip| Use { at: "/clip".into(), of: Of::Name(List::Clips, clip), what: What::Clip });
        let sheets = self.sprites.sheets.iter().enumerate().map(|(i, sheet)| {
            let at = format!("/sprites/sheets/{i}/image");
            Use { at, of: Of::Name(List::Images, &sheet.image), what: What::Picture }
        });
        clip.chain(sheets).collect()
    }

    /// Where a window lies in the clip's first corner.
    fn bounds(&self, _path: &str) -> Rect {
        let side = f64::from(self.sprites.size);
        Rect::new(0.0, 0.0, side, side)
    }

    fn reach(&self, ways: &[DVec3]) -> Option<Vec<f64>> {
        let values = automatic::Values::of(self);
        lines::reach(&values, &lines::lines(&values, &self.foam, hash::Random(self.seed)), ways)
    }

    fn automatic(&self, path: &str) -> Option<Value> {
        automatic::Values::of(self).field(path)
    }

    fn derived(&self, path: &str) -> &'static [Derived] {
        if path == "/lip" { landing::COLUMNS } else { &[] }
    }

    fn derive(&self, column: &Derived, item: &Value) -> Option<f64> {
        landing::Fall::of(self, item)?.value(column)
    }

    fn solve(&self, column: &Derived, item: &Value, to: f64) -> Result<Value, String> {
        let fall = landing::Fall::of(self, item).ok_or("this is no node of the lip")?;
        fall.solved(column, to).map(|velocity| json!(velocity.to_array()))
    }

    fn picks(&self) -> Option<Picks> {
        let kinds = &[("add", "water"), ("foam", "foam")];
        let (node, list) = ("/sprites", "/sprites/picks");
        Some(Picks { node, list, frame: "frame", at: "at", track: "track", kind: "kind", kinds })
    }

    fn aimed(&self, path: &str, ray: &Ray) -> Result<(String, Value), String> {
        landing::aimed(self, path, ray)
    }

    fn aimed_marks(&self, path: &str, ray: &Ray, moment: &Moment) -> Vec<Mark> {
        landing::would_fall(self, path, ray).map_or_else(Vec::new, |fall| marks::of_fall(&fall, moment))
    }

    /// Sprites have no surfaces, which the passes that all layers share are of.
    fn has_pass(&self, pass: &Pass) -> bool {
        !pass::PASSES.contains(&pass)
    }

    fn goal(&self, path: &str) -> Result<Goal, String> {
        landing::goal(self, path)
    }

    fn probe(
        &self,
        making: &Making,
        ready: Option<&dyn Ready>,
        pixel: (usize, usize),
        moment: &Moment,
    ) -> Result<Option<ReadOut>, Problem> {
        let made = match ready.and_then(|ready| ready.downcast::<synth::Synth>()) {
            Some(made) => Cow::Borrowed(made),
            None => Cow::Owned(synth::Synth::new(self, making, None)?),
        };
        Ok(Some(probe::probe(self, &made, pixel, moment)))
    }

    fn flow_lines(&self, samples: usize, each: &mut dyn FnMut(Vec<Entry>)) -> bool {
        listing::list(self, samples, each);
        true
    }

    fn synth(&self, making: &Making, previous: Option<&dyn Ready>) -> Result<Arc<dyn Ready>, Problem> {
        let previous = previous.and_then(|previous| previous.downcast::<synth::Synth>());
        Ok(Arc::new(synth::Synth::new(self, making, previous)?))
    }
}

/// White water on transparent paper is not seen.
const GROUND: &str = "#15191c";

/// A fall of water from a clip; what is cut out of it fits into it, as far as that can be.
fn template(shown: &NewLayer) -> Value {
    let mut layer = json!({ "kind": "waterfall", "name": shown.name, "clip": shown.name });
    let mut fitting = shown.frames.map(|frames| sprites::fitting(shown.size_px, frames)).unwrap_or_default();
    // Where nothing moves, no window chooses itself.
    if shown.is_still {
        let (width, height) = shown.size_px;
        fitting.insert("picks".into(), json!([{ "frame": 0, "at": [width / 2, height / 2], "track": false }]));
    }
    if !fitting.is_empty() {
        layer["sprites"] = fitting.into();
    }
    layer
}

fn start(_variant: &str, field: &str, bounds: Rect) -> Option<Value> {
    match field {
        "at" => Some(json!([bounds.center().x, bounds.center().y])),
        "color" => Some(json!("#ffffff")),
        _ => None,
    }
}

fn ascending(_variant: &str, list: &str) -> Option<&'static str> {
    (list == "tint").then_some("/at")
}

/// A color half way between its neighbors; a node half way between them, or as far beyond the last as that is from the one
/// before.
fn item(_variant: &str, list: &str, items: &[Value], index: usize) -> Option<(usize, Value)> {
    match list {
        "tint" if items.is_empty() => Some((0, json!({ "at": 0, "color": "#ffffff" }))),
        "tint" => halfway(items, index, "/at"),
        "lip" => Some((index, node(items, index))),
        _ => None,
    }
}

fn node(items: &[Value], index: usize) -> Value {
    let at = |i: usize| -> Option<[f64; 3]> { serde_json::from_value(items.get(i)?.get("at")?.clone()).ok() };
    let mix = |a: [f64; 3], b: [f64; 3], share: f64| [0, 1, 2].map(|c| a[c] + (b[c] - a[c]) * share);
    let place = match (index.checked_sub(1).and_then(at), at(index)) {
        (Some(before), Some(after)) => mix(before, after, 0.5),
        (None, Some(first)) => at(1).map_or(mix(first, first, 0.0), |second| mix(first, second, -1.0)),
        (Some(last), None) => {
            let before = index.checked_sub(2).and_then(at);
            before.map_or([last[0] + 1.0, last[1], last[2]], |before| mix(before, last, 2.0))
        }
        (None, None) => [0.0, 2.0, 0.0],
    };
    // In all else it is like its neighbor.
    let mut node = items.get(index.saturating_sub(1)).and_then(|item| item.as_object().cloned()).unwrap_or_default();
    node.insert("at".into(), json!(place));
    Value::Object(node)
}
