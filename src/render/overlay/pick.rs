//! What stands at a place of the picture, for a selection by pointer.

use kurbo::Point;

use crate::layers::Layer;
use crate::layers::folding::anchors::anchors;
use crate::layers::folding::model::Zone;
use crate::scene::Scene;

/// JSON pointer of what is at a place, in pixels of the picture: the tool of the anchor nearest to it, not farther than
/// `reach_px`; else the topmost zone that holds it; else none.
pub fn pick(scene: &Scene, at: Point, reach_px: f64) -> Option<String> {
    let zones = || {
        scene.layers.iter().enumerate().rev().flat_map(|(l, layer)| {
            let zones = match layer {
                Layer::Picture(layer) => layer.zones.as_slice(),
                _ => &[],
            };
            let zones = zones.iter().enumerate().rev();
            zones.map(move |(z, zone)| (super::zone_pointer(l, z), zone))
        })
    };
    let near = zones().filter_map(|(pointer, zone)| {
        let (tool, distance) = nearest(zone, at)?;
        (distance <= reach_px).then(|| (distance, format!("{pointer}/motion/{tool}")))
    });
    let anchor = near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, pointer)| pointer);
    anchor.or_else(|| zones().find(|(_, zone)| zone.outline.polygon().contains(at)).map(|(pointer, _)| pointer))
}

/// The tool of the nearest anchor, and how far that is.
fn nearest(zone: &Zone, at: Point) -> Option<(usize, f64)> {
    let distances = anchors(zone).into_iter().map(|anchor| (anchor.tool, anchor.at.distance(at)));
    distances.min_by(|a, b| a.1.total_cmp(&b.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_anchor_else_the_topmost_zone_is_picked() {
        let zone = |name: &str, x: u32| {
            format!(
                r#"{{ "name": "{name}", "outline": {{"kind": "rectangle", "x": {x}, "y": 0, "width": 40, "height": 20}},
                    "motion": [{{"tool": "translate", "by": [1, 0]}}, {{"tool": "point", "at": [{}, 10]}}]}}"#,
                x + 5
            )
        };
        let scene: Scene = serde_json::from_str(&format!(
            r#"{{ "plica": 1, "images": {{"a": {{"path": "a.png"}}}},
              "layers": [{{ "kind": "picture", "name": "l", "image": "a", "zones": [{}, {}]}}]}}"#,
            zone("below", 0),
            zone("above", 30)
        ))
        .unwrap();
        for ((x, y), expected) in [
            ((5.0, 10.0), Some("/layers/0/zones/0/motion/1")),
            ((8.0, 10.0), Some("/layers/0/zones/0/motion/1")),
            ((37.0, 11.0), Some("/layers/0/zones/1/motion/1")),
            ((12.0, 3.0), Some("/layers/0/zones/0")),
            ((38.0, 3.0), Some("/layers/0/zones/1")),
            ((60.0, 3.0), Some("/layers/0/zones/1")),
            ((90.0, 3.0), None),
            ((1.0, 25.0), None),
        ] {
            assert_eq!(pick(&scene, Point::new(x, y), 4.0).as_deref(), expected, "{x} {y}");
        }
    }
}
