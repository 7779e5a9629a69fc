//! The marks for the document of a layer: outlines, fold regions, anchors, curves.

use std::sync::Arc;

use kurbo::{Point, Vec2};

use super::looks::{ANCHOR, ANCHORS, CURVE, CURVES, FOLD_REGION, HANDLE, JUMP, LABELS, LASSO, OUTLINES, REGIONS};
use super::looks::{STILL, ZONE_OUTLINE};
use super::model::{PictureLayer, Zone};
use super::tools::Tool;
use crate::base::geometry::{point, vector};
use crate::base::text::short;
use crate::layers::parts::marks::{Look, Mark, Shape, View};
use crate::layers::shapes::node::{Node, bezier};

/// The marks of a layer that need no synthesis.
pub fn marks(layer: &PictureLayer, view: &View) -> Vec<Mark> {
    let mut drawing = Drawing::new(view);
    for (z, zone) in layer.zones.iter().enumerate() {
        drawing.zone(zone, &zone_path(z).into());
    }
    drawing.marks
}

/// JSON pointer of a zone, relative to the layer.
pub fn zone_path(zone: usize) -> String {
    format!("/zones/{zone}")
}

/// Marks in the making.
pub(super) struct Drawing<'a> {
    /// What is to be shown.
    pub view: &'a View,
    /// What is there already.
    pub marks: Vec<Mark>,
}

impl<'a> Drawing<'a> {
    /// No marks yet.
    pub fn new(view: &'a View) -> Self {
        Drawing { view, marks: Vec::new() }
    }

    /// Adds a mark of what is at `path`, relative to the layer.
    pub fn add(&mut self, look: &'static Look, path: &Arc<str>, shape: Shape) {
        self.marks.push(Mark::new(look, path.clone(), shape));
    }

    fn zone(&mut self, zone: &Zone, at: &Arc<str>) {
        self.outlines(zone, at);
        if self.view.shows(ANCHORS) {
            self.anchors(zone, at);
        }
        for (t, tool) in zone.motion.iter().enumerate().filter(|_| self.view.shows(CURVES)) {
            self.tool(tool, &format!("{at}/motion/{t}").into());
        }
    }

    fn outlines(&mut self, zone: &Zone, at: &Arc<str>) {
        if self.view.shows(OUTLINES) {
            let points = zone.outline.polygon().vertices().to_vec();
            if let (true, Some(&first)) = (self.view.shows(LABELS), points.first()) {
                self.add(&ZONE_OUTLINE, at, Shape::Label(first, zone.name.clone()));
            }
            self.add(&ZONE_OUTLINE, at, Shape::Line { points, closed: true });
        }
        let regions = zone.fold.as_ref().map_or(&[][..], |fold| fold.regions());
        for (r, region) in regions.iter().enumerate().filter(|_| self.view.shows(REGIONS)) {
            let at = format!("{at}/fold/regions/{r}").into();
            let points = region.polygon().vertices().to_vec();
            self.add(&FOLD_REGION, &at, Shape::Fill(points.clone()));
            self.add(&FOLD_REGION, &at, Shape::Line { points, closed: true });
        }
    }

    fn anchors(&mut self, zone: &Zone, at: &Arc<str>) {
        let labels = self.view.shows(LABELS);
        let mut numbered = None;
        for anchor in zone.anchors() {
            // The first anchor of each tool is labelled with its number.
            let number =
                if numbered.replace(anchor.tool) == Some(anchor.tool) { "" } else { &format!("{}: ", anchor.tool) };
            let at = format!("{at}/motion/{}", anchor.tool).into();
            if anchor.jump == Vec2::ZERO {
                if labels && !number.is_empty() {
                    self.add(&STILL, &at, Shape::Label(anchor.at, format!("{number}still")));
                }
                self.add(&STILL, &at, Shape::Dot(anchor.at));
                continue;
            }
            self.add(&JUMP, &at, Shape::Arrow(anchor.at, anchor.at + anchor.jump));
            self.add(&ANCHOR, &at, Shape::Dot(anchor.at));
            if labels {
                let text = format!("{number}{}, {}", short(anchor.jump.x, 2), short(anchor.jump.y, 2));
                self.add(&ANCHOR, &at, Shape::Label(anchor.at, text));
            }
        }
    }

    fn tool(&mut self, tool: &Tool, at: &Arc<str>) {
        let facts = tool.facts();
        if let Some(nodes) = facts.path {
            let points = flattened(nodes);
            self.add(&CURVE, at, Shape::Line { points, closed: false });
            for node in nodes.iter() {
                self.handles(node, at);
            }
        }
        if let Some(vertices) = facts.dragged {
            let points = vertices.iter().map(|v| point(v.from)).collect();
            self.add(&LASSO, at, Shape::Line { points, closed: true });
        }
    }

    fn handles(&mut self, node: &Node, at: &Arc<str>) {
        let here = point(node.at);
        self.add(&CURVE, at, Shape::Dot(here));
        for handle in [node.handle_in, node.handle_out].map(vector) {
            if handle != Vec2::ZERO {
                self.add(&HANDLE, at, Shape::Line { points: vec![here, here + handle], closed: false });
                self.add(&HANDLE, at, Shape::Dot(here + handle));
            }
        }
    }
}

/// The open curve through nodes as a line, to within a twentieth of a pixel.
fn flattened(nodes: &[Node]) -> Vec<Point> {
    let mut points = Vec::new();
    kurbo::flatten(bezier(nodes, false), 0.05, |el| match el {
        kurbo::PathEl::MoveTo(p) | kurbo::PathEl::LineTo(p) => points.push(p),
        _ => {}
    });
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_asked_for_is_drawn() {
        let layer: PictureLayer = serde_json::from_str(
            r#"{ "name": "l", "image": "a",
              "zones": [{ "name": "eye", "outline": {"kind": "rectangle", "x": 1, "y": 1, "width": 6, "height": 4},
                "fold": {"rule": "cover", "regions": [{"kind": "rectangle", "x": 2, "y": 2, "width": 2, "height": 2}]},
                "motion": [{"tool": "curve", "samples": 3, "nodes": [{"at": [1, 1], "out": [1, 0]}, {"at": [3, 3]}],
                            "jumps": [{"along": 0, "jump": [1, 1]}]}]}]}"#,
        )
        .unwrap();
        for (shown, expected) in [
            (&[][..], &[][..]),
            (&[OUTLINES], &["zone outline"]),
            (&[REGIONS], &["fold region"]),
            (&[CURVES], &["curve", "handle"]),
            (&[ANCHORS], &["jump vector", "anchor"]),
            (&[LABELS], &[]),
        ] {
            let mut marks = marks(&layer, &View::of(shown));
            marks.sort_by_key(|mark| mark.look.order);
            let mut looks: Vec<&str> = marks.iter().map(|mark| mark.look.name).collect();
            looks.dedup();
            assert_eq!(looks, expected, "{shown:?}");
        }
    }
}
