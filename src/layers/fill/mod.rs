//! A color or a gradient over the whole frame: a background beneath transparent pictures, or a veil over them.

pub mod frame;
pub mod model;
pub mod synth;

use std::sync::Arc;

use kurbo::Rect;
use serde_json::{Value, json};

use self::model::FillLayer;
use super::parts::materials::Materials;
use super::parts::moment::{Moment, Space};
use super::parts::readout::ReadOut;
use super::ready::{Making, Ready};
use super::starts::{Starts, halfway};
use super::technique::{Checked, Kind, Technique};
use crate::base::color;
use crate::base::problem::Problem;

/// The technique.
pub static KIND: Kind = Kind {
    name: "fill",
    space: Space::Plane,
    programs: &[&[&synth::PROGRAM]],
    routines: &[],
    twins: &[synth::TWINS],
    bundle: None,
    counted: &[],
    overlays: &[],
    passes: &[],
    looks: &[],
    template: None,
    blank: Some(blank),
    starts: Starts { start, ascending, item, ..Starts::PLAIN },
    presets: &[],
    styles: None,
    comparisons: &[],
    example: include_str!("example.json"),
};

impl Technique for FillLayer {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn name(&self) -> &str {
        &self.name
    }

    fn check(&self, _before: Option<(&dyn Technique, &Checked)>) -> Checked {
        Checked(vec![FillLayer::check(self).into()])
    }

    fn covers(&self, _size_px: (usize, usize), _materials: &Materials) -> bool {
        self.colors().all(|color| color::parse(color).is_some_and(|[.., alpha]| alpha == 255))
    }

    fn bounds(&self, _path: &str) -> Rect {
        let line = self.gradient.as_ref().map(|line| {
            let ([x0, y0], [x1, y1]) = (line.from, line.to);
            Rect::from_points((x0, y0), (x1, y1))
        });
        line.unwrap_or(Rect::new(0.0, 0.0, 100.0, 100.0))
    }

    fn probe(
        &self,
        making: &Making,
        _ready: Option<&dyn Ready>,
        pixel: (usize, usize),
        _moment: &Moment,
    ) -> Result<Option<ReadOut>, Problem> {
        Ok(Some(synth::Synth::new(self, making.place).read_out(&self.name, pixel)))
    }

    fn synth(&self, making: &Making, _previous: Option<&dyn Ready>) -> Result<Arc<dyn Ready>, Problem> {
        Ok(Arc::new(synth::Synth::new(self, making.place)))
    }
}

fn blank(name: &str) -> Value {
    json!({ "kind": KIND.name, "name": name, "color": "#00000000" })
}

/// A new gradient goes from black above to white below.
fn start(_variant: &str, field: &str, bounds: Rect) -> Option<Value> {
    match field {
        "from" => Some(json!([bounds.x0, bounds.y0])),
        "to" => Some(json!([bounds.x0, bounds.y1])),
        "stops" => Some(json!([[0, "#000000"], [1, "#ffffff"]])),
        "color" => Some(json!("#808080")),
        _ => None,
    }
}

fn ascending(_variant: &str, list: &str) -> Option<&'static str> {
    (list == "stops").then_some("/0")
}

fn item(_variant: &str, list: &str, items: &[Value], index: usize) -> Option<(usize, Value)> {
    halfway(items, index, "/0").filter(|_| list == "stops")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_new_is_right_and_stands_between_its_neighbours() {
        let field = |name: &str| start("", name, Rect::new(2.0, 3.0, 8.0, 9.0)).unwrap_or_default();
        let gradient = json!({ "from": field("from"), "to": field("to"), "stops": field("stops") });
        let layer: FillLayer = serde_json::from_value(json!({ "name": "f", "gradient": gradient })).unwrap();
        assert_eq!(FillLayer::check(&layer), []);
        let stops = field("stops");
        for (index, at) in [(0, 1), (1, 1), (2, 1)] {
            let (found, new) = item("", "stops", stops.as_array().unwrap(), index).unwrap();
            assert_eq!((found, new), (at, json!([0.5, "#000000"])), "{index}");
        }
        let one = [json!([0.5, "#ffffff"])];
        let along = |index| item("", "stops", &one, index).map(|(at, new)| (at, new[0].as_f64()));
        assert_eq!((along(0), along(1)), (Some((0, Some(0.25))), Some((1, Some(0.75)))));
        assert_eq!(item("", "other", &one, 0), None);
    }
}
