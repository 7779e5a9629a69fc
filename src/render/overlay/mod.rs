//! What is drawn over a picture to explain it: outlines, fold regions, anchors, curves, the vector field. A pure function
//! from scene, synthesis and view options to marks in image coordinates, which the window, plots and the terminal only
//! draw. Colours stand in one table; every kind also differs in shape (dash, dot, width), so colour is never the only sign.

use kurbo::{Point, Vec2};

use super::Synth;
use crate::layers::Layer;
use crate::layers::folding::anchors::anchors;
use crate::layers::folding::model::{PictureLayer, Zone};
use crate::layers::folding::outline::{Node, bezier, point, vector};
use crate::layers::folding::tools::Tool;
use crate::scene::Scene;

mod pick;
mod pixels;
mod style;

pub use pick::pick;
pub use pixels::{field_scale, longest};
pub use style::{Dot, FILL_ALPHA, Kind, SELECTED, SELECTED_GROWTH, STYLES, Style, wheel};

/// What to show.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct View {
    /// Zone outlines.
    pub outlines: bool,
    /// Fold regions.
    pub regions: bool,
    /// Anchors with their jump vectors.
    pub anchors: bool,
    /// Curves and lassos with their handles.
    pub curves: bool,
    /// The names of zones and the numbers of anchors, beside them.
    pub labels: bool,
    /// The vector field, an arrow every so many pixels, drawn at [`field_scale`].
    pub field: Option<f64>,
    /// The vector field as colours ([`wheel`]), a square every so many pixels.
    pub wheel: Option<f64>,
    /// The jump paths, one every so many pixels.
    pub paths: Option<f64>,
    /// Where jump paths meet fold regions, on one path every so many pixels.
    pub thresholds: Option<f64>,
    /// The effective places of samplers.
    pub samplers: Option<Samplers>,
    /// JSON pointer of what is selected.
    pub selection: Option<String>,
}

/// Which samplers to show, and when.
#[derive(Clone, Debug, PartialEq)]
pub struct Samplers {
    /// One every so many pixels.
    pub spacing: f64,
    /// Scene times in [0, 1]: the present one, then those that are shown ever fainter.
    pub times: Vec<f64>,
}

/// One thing to draw.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// What it shows.
    pub kind: Kind,
    /// Its shape, in pixels of the image.
    pub shape: Shape,
    /// Whether it belongs to what is selected.
    pub selected: bool,
    /// Opacity beside that of its colour, 0 to 1.
    pub strength: f32,
}

/// A shape in pixels of the image.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A line through points.
    Line {
        /// At least two points.
        points: Vec<Point>,
        /// Whether the last joins the first.
        closed: bool,
    },
    /// The inside of a polygon, even-odd.
    Fill(Vec<Point>),
    /// A square of a colour of its own around a point: place, side, sRGB with straight alpha.
    Cell(Point, f64, [u8; 4]),
    /// A dot at a point.
    Dot(Point),
    /// An arrow; its head is at the second point.
    Arrow(Point, Point),
    /// Text beside a point.
    Label(Point, String),
}

/// The marks of a scene, from those that lie below to those on top. What is shown of single pixels needs the synthesis
/// and is left out without it.
pub fn overlay(scene: &Scene, synth: Option<&Synth>, view: &View) -> Vec<Mark> {
    let mut drawing = Drawing { view, marks: Vec::new() };
    if let Some(synth) = synth {
        drawing.pixels(synth);
    }
    for (i, layer) in scene.layers.iter().enumerate() {
        let Layer::Picture(layer) = layer else { continue };
        drawing.layer(layer, i);
    }
    drawing.marks.sort_by_key(|mark| mark.kind);
    drawing.marks
}

/// The marks of samplers alone: what a view shows that changes from frame to frame.
pub fn samplers(synth: &Synth, view: &View) -> Vec<Mark> {
    let mut drawing = Drawing { view, marks: Vec::new() };
    drawing.pixels(synth);
    drawing.marks
}

fn zone_pointer(layer: usize, zone: usize) -> String {
    format!("/layers/{layer}/zones/{zone}")
}

struct Drawing<'a> {
    view: &'a View,
    marks: Vec<Mark>,
}

impl Drawing<'_> {
    fn add(&mut self, kind: Kind, pointer: &str, shape: Shape) {
        let selected = self.view.selection.as_deref().is_some_and(|s| is_selected(pointer, s));
        self.marks.push(Mark { kind, shape, selected, strength: 1.0 });
    }

    fn layer(&mut self, layer: &PictureLayer, index: usize) {
        for (z, zone) in layer.zones.iter().enumerate() {
            let at = zone_pointer(index, z);
            self.outlines(zone, &at);
            if self.view.anchors {
                self.anchors(zone, &at);
            }
            for (t, tool) in zone.motion.iter().enumerate() {
                if self.view.curves {
                    self.tool(tool, &format!("{at}/motion/{t}"));
                }
            }
        }
    }

    fn outlines(&mut self, zone: &Zone, at: &str) {
        if self.view.outlines {
            let points = zone.outline.polygon().vertices().to_vec();
            if let (true, Some(&first)) = (self.view.labels, points.first()) {
                self.add(Kind::ZoneOutline, at, Shape::Label(first, zone.name.clone()));
            }
            self.add(Kind::ZoneOutline, at, Shape::Line { points, closed: true });
        }
        let regions = zone.fold.as_ref().map_or(&[][..], |fold| fold.regions());
        for (r, region) in regions.iter().enumerate().filter(|_| self.view.regions) {
            let at = format!("{at}/fold/regions/{r}");
            let points = region.polygon().vertices().to_vec();
            self.add(Kind::FoldRegion, &at, Shape::Fill(points.clone()));
            self.add(Kind::FoldRegion, &at, Shape::Line { points, closed: true });
        }
    }

    fn anchors(&mut self, zone: &Zone, at: &str) {
        let mut numbered = None;
        for anchor in anchors(zone) {
            // Of the anchors that one tool gives, the first has its number.
            let number =
                if numbered.replace(anchor.tool) == Some(anchor.tool) { "" } else { &format!("{}: ", anchor.tool) };
            let at = format!("{at}/motion/{}", anchor.tool);
            if anchor.jump == Vec2::ZERO {
                if self.view.labels && !number.is_empty() {
                    self.add(Kind::Still, &at, Shape::Label(anchor.at, format!("{number}still")));
                }
                self.add(Kind::Still, &at, Shape::Dot(anchor.at));
                continue;
            }
            self.add(Kind::Jump, &at, Shape::Arrow(anchor.at, anchor.at + anchor.jump));
            self.add(Kind::Anchor, &at, Shape::Dot(anchor.at));
            if self.view.labels {
                let text = format!("{number}{}, {}", short(anchor.jump.x), short(anchor.jump.y));
                self.add(Kind::Anchor, &at, Shape::Label(anchor.at, text));
            }
        }
    }

    fn tool(&mut self, tool: &Tool, at: &str) {
        match tool {
            Tool::Curve { nodes, .. } => {
                let points = flattened(nodes);
                self.add(Kind::Curve, at, Shape::Line { points, closed: false });
                for node in nodes {
                    self.handles(node, at);
                }
            }
            Tool::Lasso { vertices, .. } => {
                let points = vertices.iter().map(|v| point(v.from)).collect();
                self.add(Kind::Lasso, at, Shape::Line { points, closed: true });
            }
            _ => {}
        }
    }

    fn handles(&mut self, node: &Node, at: &str) {
        let here = point(node.at);
        self.add(Kind::Curve, at, Shape::Dot(here));
        for handle in [node.handle_in, node.handle_out].map(vector) {
            if handle != Vec2::ZERO {
                self.add(Kind::Handle, at, Shape::Line { points: vec![here, here + handle], closed: false });
                self.add(Kind::Handle, at, Shape::Dot(here + handle));
            }
        }
    }
}

/// A number with at most two decimals.
fn short(number: f64) -> String {
    let text = format!("{number:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The curve through open nodes as a line, to within a twentieth of a pixel.
fn flattened(nodes: &[Node]) -> Vec<Point> {
    let mut points = Vec::new();
    kurbo::flatten(bezier(nodes, false), 0.05, |el| match el {
        kurbo::PathEl::MoveTo(p) | kurbo::PathEl::LineTo(p) => points.push(p),
        _ => {}
    });
    points
}

/// A mark is selected when the selection lies in it, or it lies in the selection (a zone or something smaller).
fn is_selected(mark: &str, selection: &str) -> bool {
    let within =
        |inner: &str, outer: &str| inner.strip_prefix(outer).is_some_and(|r| r.is_empty() || r.starts_with('/'));
    within(selection, mark) || (selection.contains("/zones/") && within(mark, selection))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene() -> Scene {
        serde_json::from_str(
            r#"{ "plica": 1, "images": {"a": {"path": "a.png"}}, "layers": [{ "kind": "picture", "name": "l", "image": "a",
              "zones": [{ "name": "eye", "outline": {"kind": "rectangle", "x": 1, "y": 1, "width": 6, "height": 4},
                "fold": {"rule": "cover", "regions": [{"kind": "rectangle", "x": 2, "y": 2, "width": 2, "height": 2}]},
                "motion": [{"tool": "curve", "samples": 3, "nodes": [{"at": [1, 1], "out": [1, 0]}, {"at": [3, 3]}],
                            "jumps": [{"along": 0, "jump": [1, 1]}]}]}]}]}"#,
        )
        .unwrap()
    }

    fn kinds(view: &View) -> Vec<Kind> {
        let mut kinds: Vec<_> = overlay(&scene(), None, view).iter().map(|m| m.kind).collect();
        kinds.dedup();
        kinds
    }

    #[test]
    fn only_what_is_asked_for_is_drawn() {
        for (view, expected) in [
            (View::default(), vec![]),
            (View { outlines: true, ..View::default() }, vec![Kind::ZoneOutline]),
            (View { regions: true, ..View::default() }, vec![Kind::FoldRegion]),
            (View { curves: true, ..View::default() }, vec![Kind::Curve, Kind::Handle]),
            (View { anchors: true, ..View::default() }, vec![Kind::Jump, Kind::Anchor]),
        ] {
            assert_eq!(kinds(&view), expected, "{view:?}");
        }
    }

    #[test]
    fn selection_reaches_up_to_the_zone_and_down() {
        for (mark, selection, selected) in [
            ("/layers/0/zones/2", "/layers/0/zones/2/interpolation/radius", true),
            ("/layers/0/zones/2/motion/1", "/layers/0/zones/2", true),
            ("/layers/0/zones/2/motion/1", "/layers/0/zones/2/motion/10", false),
            ("/layers/0/zones/2", "/layers/0", false),
            ("/layers/0/zones/2", "", false),
        ] {
            assert_eq!(is_selected(mark, selection), selected, "{mark} {selection}");
        }
    }
}
