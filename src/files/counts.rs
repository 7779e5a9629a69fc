//! How many anchors, outline points and frames a scene asks for, told from the document before any of them is made: ten
//! digits in a file must not cost gigabytes.

use super::Limits;
use crate::base::geometry::FLATNESS_PX;
use crate::base::maths::TAU;
use crate::base::problem::Problem;
use crate::layers::Layer;
use crate::layers::folding::model::Zone;
use crate::layers::folding::outline::{Node, Outline, vector};
use crate::layers::folding::tools::Tool;
use crate::scene::Scene;

impl Limits {
    /// What in `scene` exceeds the limits: the first place where a sum does, and the timeline.
    pub fn exceeded(&self, scene: &Scene) -> Vec<Problem> {
        let mut anchors = Tally::new("anchors", self.anchors);
        let mut points = Tally::new("points", self.points);
        let mut frames = Tally::new("frames", self.frames);
        frames.add(scene.timeline.frames() as f64, || "/timeline".into());
        for (l, layer) in scene.layers.iter().enumerate() {
            let Layer::Picture(layer) = layer;
            for (z, zone) in layer.zones.iter().enumerate() {
                let at = format!("/layers/{l}/zones/{z}");
                for (m, tool) in zone.motion.iter().enumerate() {
                    anchors.add(anchors_of(tool, &zone.outline), || format!("{at}/motion/{m}"));
                }
                points.add(points_of(zone), || format!("{at}/outline"));
            }
        }
        [anchors, points, frames].into_iter().filter_map(|tally| tally.exceeded).collect()
    }
}

/// A sum against a limit.
struct Tally {
    limit: &'static str,
    most: u64,
    sum: f64,
    exceeded: Option<Problem>,
}

impl Tally {
    fn new(limit: &'static str, most: u64) -> Self {
        Tally { limit, most, sum: 0.0, exceeded: None }
    }

    fn add(&mut self, count: f64, at: impl FnOnce() -> String) {
        self.sum += count;
        if self.sum > self.most as f64 && self.exceeded.is_none() {
            let Tally { limit, most, .. } = self;
            let message = format!("makes more than {most} {limit} in one scene");
            self.exceeded = Some(Problem::error(at(), message).hint(format!("make fewer, or give --limit {limit}=N")));
        }
    }
}

fn anchors_of(tool: &Tool, outline: &Outline) -> f64 {
    match tool {
        Tool::Point { .. } => 1.0,
        Tool::Curve { samples, .. } => f64::from(*samples),
        Tool::Lasso { samples, vertices } => vertices.len() as f64 * (1.0 + f64::from(*samples)),
        Tool::StillBorder { spacing } => perimeter_at_most(outline) / spacing,
        _ => 0.0,
    }
}

fn points_of(zone: &Zone) -> f64 {
    let regions = zone.fold.iter().flat_map(|fold| fold.regions());
    std::iter::once(&zone.outline).chain(regions).map(flattened_points).sum()
}

/// A little more than the points that flattening gives.
fn flattened_points(outline: &Outline) -> f64 {
    match outline {
        Outline::Rectangle { .. } => 4.0,
        Outline::Ellipse { radii: [x, y], .. } => 16.0 + TAU * (x.abs().max(y.abs()) / FLATNESS_PX).sqrt() / 4.0,
        Outline::Polygon { points } => points.len() as f64,
        Outline::Path { nodes } => sides(nodes).map(|(a, b)| 1.0 + (control_length(a, b) / FLATNESS_PX).sqrt()).sum(),
    }
}

fn perimeter_at_most(outline: &Outline) -> f64 {
    match outline {
        Outline::Rectangle { width, height, .. } => 2.0 * (width.abs() + height.abs()),
        Outline::Ellipse { radii: [x, y], .. } => TAU * x.abs().max(y.abs()),
        Outline::Polygon { .. } => outline.polygon().perimeter(),
        Outline::Path { nodes } => sides(nodes).map(|(a, b)| control_length(a, b)).sum(),
    }
}

fn sides(nodes: &[Node]) -> impl Iterator<Item = (&Node, &Node)> {
    nodes.iter().zip(nodes.iter().cycle().skip(1))
}

/// Length of a segment's control polygon: the curve is no longer.
fn control_length(a: &Node, b: &Node) -> f64 {
    let (out, back, across) = (vector(a.handle_out), vector(b.handle_in), vector(b.at) - vector(a.at));
    out.length() + (across + back - out).length() + back.length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn scene(outline: serde_json::Value, tool: serde_json::Value) -> Scene {
        serde_json::from_value(json!({ "plica": 1, "timeline": { "duration": 1e5, "fps": 10 }, "layers": [{
            "kind": "picture", "name": "l", "image": "a", "zones": [{ "name": "z", "outline": outline, "motion": [tool] }]
        }] }))
        .unwrap()
    }

    #[test]
    fn what_is_too_many_is_told_before_it_is_made() {
        let small = json!({ "kind": "rectangle", "x": 0, "y": 0, "width": 10, "height": 10 });
        let still = json!({ "tool": "translate", "by": [0, 0] });
        let vertex = json!({ "from": [0, 0], "to": [1, 1] });
        let node = |x: f64| json!({ "at": [x, 0], "out": [1e300, 0] });
        for (outline, tool, place) in [
            (&small, json!({ "tool": "lasso", "samples": 500000, "vertices": [vertex, vertex, vertex] }), "motion/0"),
            (&small, json!({ "tool": "still-border", "spacing": 1e-9 }), "motion/0"),
            (&json!({ "kind": "path", "nodes": [node(0.0), node(1.0)] }), still.clone(), "outline"),
            (&small, still.clone(), "none"),
        ] {
            let problems = Limits::default().exceeded(&scene(outline.clone(), tool));
            let found: Vec<_> = problems.iter().map(|p| p.path.as_str()).collect();
            let expected = format!("/layers/0/zones/0/{place}");
            let expected = [expected.as_str(), "/timeline"];
            assert_eq!(found, expected[usize::from(place == "none")..]);
        }
    }

    #[test]
    fn the_estimate_is_from_above() {
        for outline in [
            json!({ "kind": "ellipse", "center": [0, 0], "radii": [300, 20] }),
            json!({ "kind": "path", "nodes": [
                { "at": [0, 0], "out": [90, 0] }, { "at": [100, 50], "in": [0, -90], "out": [-300, 70] }] }),
        ] {
            let outline: Outline = serde_json::from_value(outline).unwrap();
            let polygon = outline.polygon();
            assert!(flattened_points(&outline) >= polygon.vertices().len() as f64);
            assert!(perimeter_at_most(&outline) >= polygon.perimeter());
        }
    }
}
