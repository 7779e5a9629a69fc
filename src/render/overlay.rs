//! What is drawn over a picture to explain it: outlines, fold regions, anchors, curves, the vector field. A pure function
//! from scene, synthesis and view options to marks in image coordinates, which the window, plots and the terminal only
//! draw. Colours stand in one table; every kind also differs in shape (dash, dot, width), so colour is never the only sign.

use kurbo::{Point, Vec2};

use super::{LayerSynth, Synth};
use crate::layers::Layer;
use crate::layers::folding::field::Field;
use crate::layers::folding::model::{PictureLayer, Zone};
use crate::layers::folding::outline::{Node, bezier, point, vector};
use crate::layers::folding::tools::Tool;
use crate::layers::folding::{self, anchors::anchors};
use crate::scene::Scene;

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
    /// JSON pointer of what is selected.
    pub selection: Option<String>,
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
    /// A dot at a point.
    Dot(Point),
    /// An arrow; its head is at the second point.
    Arrow(Point, Point),
    /// Text beside a point.
    Label(Point, String),
}

/// What a mark shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// The jump vectors of pixels.
    Field,
    /// The outline of a zone.
    ZoneOutline,
    /// A fold region.
    FoldRegion,
    /// A curve along which anchors stand.
    Curve,
    /// A lasso, where it is.
    Lasso,
    /// A node of a path or curve, and the lines to its handles.
    Handle,
    /// The jump vector of an anchor.
    Jump,
    /// An anchor that moves.
    Anchor,
    /// An anchor with a jump of (0, 0).
    Still,
}

/// How a kind looks. Lengths are in pixels of the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// sRGB with straight alpha.
    pub color: [u8; 4],
    /// Width of lines.
    pub width_px: f32,
    /// Length of a dash and of the gap after it; none: solid.
    pub dash_px: Option<(f32, f32)>,
    /// The shape of dots.
    pub dot: Dot,
    /// Radius of dots.
    pub dot_px: f32,
}

/// The shape of a dot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dot {
    /// A filled disc.
    Disc,
    /// A filled square.
    Square,
    /// A filled square on its corner.
    Diamond,
}

/// The look of what is selected: this colour, and lines and dots larger by [`SELECTED_GROWTH`].
pub const SELECTED: [u8; 4] = [255, 255, 255, 255];
/// See [`SELECTED`].
pub const SELECTED_GROWTH: f32 = 1.6;
/// Opacity of a [`Shape::Fill`] in its kind's colour.
pub const FILL_ALPHA: f32 = 0.16;

/// Every kind, what it is called, and its look. The colours keep apart for colour-blind eyes (after Okabe and Ito).
pub const STYLES: [(Kind, &str, Style); 9] = {
    const fn style(color: [u8; 4], width_px: f32, dash_px: Option<(f32, f32)>, dot: Dot, dot_px: f32) -> Style {
        Style { color, width_px, dash_px, dot, dot_px }
    }
    [
        (Kind::Field, "vector field", style([190, 205, 220, 230], 1.0, None, Dot::Disc, 1.0)),
        (Kind::ZoneOutline, "zone outline", style([86, 180, 233, 255], 1.6, None, Dot::Square, 3.0)),
        (Kind::FoldRegion, "fold region", style([240, 160, 40, 255], 1.6, Some((6.0, 4.0)), Dot::Square, 3.0)),
        (Kind::Curve, "curve", style([214, 130, 190, 255], 1.6, None, Dot::Diamond, 4.0)),
        (Kind::Lasso, "lasso", style([240, 228, 66, 255], 1.4, Some((2.0, 3.0)), Dot::Square, 3.0)),
        (Kind::Handle, "handle", style([170, 150, 165, 255], 1.0, None, Dot::Diamond, 3.5)),
        (Kind::Jump, "jump vector", style([60, 210, 160, 255], 1.8, None, Dot::Disc, 2.0)),
        (Kind::Anchor, "anchor", style([60, 210, 160, 255], 1.4, None, Dot::Disc, 3.5)),
        (Kind::Still, "still anchor", style([235, 120, 80, 255], 1.4, None, Dot::Square, 2.5)),
    ]
};

impl Kind {
    /// How the kind looks.
    pub fn style(self) -> Style {
        let row = STYLES.iter().find(|(kind, ..)| *kind == self);
        row.expect("every kind has a style").2
    }
}

/// The marks of a scene, from those that lie below to those on top. The field needs the synthesis and is left out
/// without it.
pub fn overlay(scene: &Scene, synth: Option<&Synth>, view: &View) -> Vec<Mark> {
    let mut drawing = Drawing { view, marks: Vec::new() };
    for (i, layer) in scene.layers.iter().enumerate() {
        let Layer::Picture(layer) = layer;
        if let (Some(spacing), Some(LayerSynth::Picture(synth))) = (view.field, synth.and_then(|s| s.layers.get(i))) {
            let scale = field_scale(synth, spacing);
            for zone in &synth.zones {
                drawing.field(&zone.field, spacing, scale, &zone_pointer(i, zone.index));
            }
        }
        drawing.layer(layer, i);
    }
    drawing.marks.sort_by_key(|mark| mark.kind);
    drawing.marks
}

/// By how much the arrows of a layer's field are shorter than its jump vectors, so that they keep apart: the longest
/// covers the distance of two.
pub fn field_scale(synth: &folding::synth::Synth, spacing: f64) -> f64 {
    let jumps = synth.zones.iter().flat_map(|zone| zone.field.jumps.cells());
    let longest = jumps.map(|&[x, y]| f64::from(x * x + y * y)).fold(0.0, f64::max).sqrt();
    (2.0 * spacing.max(1.0) / longest).min(1.0)
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
        self.marks.push(Mark { kind, shape, selected });
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
        for anchor in anchors(zone) {
            let at = format!("{at}/motion/{}", anchor.tool);
            if anchor.jump == Vec2::ZERO {
                self.add(Kind::Still, &at, Shape::Dot(anchor.at));
                continue;
            }
            self.add(Kind::Jump, &at, Shape::Arrow(anchor.at, anchor.at + anchor.jump));
            self.add(Kind::Anchor, &at, Shape::Dot(anchor.at));
            if self.view.labels {
                let numbers = format!("{}, {}", short(anchor.jump.x), short(anchor.jump.y));
                self.add(Kind::Anchor, &at, Shape::Label(anchor.at, numbers));
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

    /// An arrow every `spacing` pixels, at the same pixels whatever the zone's box is.
    fn field(&mut self, field: &Field, spacing: f64, scale: f64, at: &str) {
        let spacing = spacing.max(1.0);
        let steps = |from: usize, n: usize| {
            let first = ((from as f64) / spacing - 0.5).ceil().max(0.0) as usize;
            (first..)
                .map(move |k| ((k as f64 + 0.5) * spacing) as usize)
                .take_while(move |&p| p < from + n)
                .filter(move |&p| p >= from)
        };
        for y in steps(field.y0, field.inside.height()) {
            for x in steps(field.x0, field.inside.width()) {
                let (i, j) = (x - field.x0, y - field.y0);
                if *field.inside.get(i, j) {
                    let q = Point::new(x as f64 + 0.5, y as f64 + 0.5);
                    let [jx, jy] = field.jumps.get(i, j).map(f64::from);
                    self.add(Kind::Field, at, Shape::Arrow(q, q + Vec2::new(jx, jy) * scale));
                }
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
    fn every_kind_has_a_style_of_its_own() {
        for (i, (_, name, style)) in STYLES.iter().enumerate() {
            for (_, other, s) in &STYLES[i + 1..] {
                assert!((style.width_px, style.dash_px, style.dot) != (s.width_px, s.dash_px, s.dot), "{name} {other}");
            }
        }
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

    #[test]
    fn field_arrows_stand_on_one_lattice() {
        use crate::base::pixels::Grid;
        let field = Field {
            x0: 3,
            y0: 0,
            inside: Grid::filled(10, 3, true),
            jumps: Grid::filled(10, 3, [2.0, 0.0]),
            folds: None,
        };
        let view = View::default();
        let mut drawing = Drawing { view: &view, marks: Vec::new() };
        drawing.field(&field, 4.0, 0.5, "");
        let arrow = |x: f64| Shape::Arrow(Point::new(x, 2.5), Point::new(x + 1.0, 2.5));
        let shapes: Vec<_> = drawing.marks.into_iter().map(|m| m.shape).collect();
        assert_eq!(shapes, [arrow(6.5), arrow(10.5)]);
    }
}
