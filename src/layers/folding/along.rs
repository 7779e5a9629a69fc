//! A curve of a zone's motion along a shape: what lies there stays, or goes to another path.

use kurbo::Point;
use serde_json::{Value, json};

use super::model::PictureLayer;
use super::neat::{neat_pair, ratio};
use super::tools::Tool;
use crate::base::geometry::point;
use crate::base::pointer::Pointer;
use crate::layers::shapes::handles::evenly;
use crate::layers::shapes::node::Node;
use crate::layers::technique::Lead;

/// A new curve has an anchor about every so many pixels, at most so many.
const SPACING_PX: f64 = 10.0;
const MOST: usize = 200;

/// Jump vectors are given at so many places along it: every twentieth.
const PLACES: usize = 21;

/// The curve along the shape of this name in the zone that `path` is in, and where it is to be written: in place of the one that is
/// there, with as many anchors. `None` if `path` is in no zone.
pub fn along(layer: &PictureLayer, path: &str, (name, nodes): (&str, &[Node]), lead: Lead) -> Option<(String, Value)> {
    let (zone, _) = Pointer(path).item_of("/zones")?;
    let motion = &layer.zones.get(zone)?.motion;
    let own = |tool: &Tool| match tool {
        Tool::Curve { samples, nodes, .. } if nodes.shape.as_deref() == Some(name) => Some(*samples),
        _ => None,
    };
    let found = motion.iter().enumerate().find_map(|(i, tool)| Some((i.to_string(), own(tool)?)));
    let (item, samples) = found.unwrap_or_else(|| ("-".to_owned(), anchors(nodes)));
    let jumps = match lead {
        Lead::By(by) => json!([{ "along": 0, "jump": neat_pair(by.to_point()) }]),
        Lead::To(other) => leading(nodes, other),
    };
    let curve = json!({ "tool": "curve", "samples": samples, "nodes": name, "jumps": jumps });
    Some((Pointer(&format!("/zones/{zone}/motion")).join(item), curve))
}

/// How many anchors a new curve has.
fn anchors(nodes: &[Node]) -> u32 {
    let places = evenly(nodes, false, MOST);
    let length: f64 = places.windows(2).map(|ends| point(ends[0].at).distance(point(ends[1].at))).sum();
    (length / SPACING_PX).round().clamp(1.0, MOST as f64) as u32 + 1
}

/// Jump vectors that lead from each part of one path to the same part of another, whichever way that runs.
fn leading(from: &[Node], to: &[Node]) -> Value {
    let places = |nodes| evenly(nodes, false, PLACES).iter().map(|node| point(node.at)).collect::<Vec<Point>>();
    let (from, mut to) = (places(from), places(to));
    let far = |to: &[Point]| from[0].distance(to[0]) + from[PLACES - 1].distance(to[PLACES - 1]);
    let reversed: Vec<Point> = to.iter().rev().copied().collect();
    if far(&reversed) < far(&to) {
        to = reversed;
    }
    let part = |k: usize| ratio(k as f64 / (PLACES - 1) as f64);
    let jump = |(k, (from, to)): (usize, (&Point, &Point))| json!({ "along": part(k), "jump": neat_pair((*to - *from).to_point()) });
    from.iter().zip(&to).enumerate().map(jump).collect()
}

#[cfg(test)]
mod tests {
    use kurbo::Vec2;

    use super::*;

    fn line(y: f64, xs: [f64; 2]) -> Vec<Node> {
        xs.map(|x| Node::corner([x, y])).to_vec()
    }

    fn layer(motion: Value) -> PictureLayer {
        let outline = json!({ "kind": "rectangle", "x": 0, "y": 0, "width": 9, "height": 9 });
        let zone = json!({ "name": "z", "outline": outline, "motion": motion });
        serde_json::from_value(json!({ "name": "l", "image": "i", "zones": [zone] })).unwrap()
    }

    #[test]
    fn a_curve_stays_or_goes_part_by_part_to_the_other_path() {
        let (low, lid) = (line(20.0, [0.0, 40.0]), line(4.0, [40.0, 0.0]));
        let (at, still) = along(&layer(json!([])), "/zones/0/fold", ("low", &low), Lead::By(Vec2::ZERO)).unwrap();
        assert_eq!(at, "/zones/0/motion/-");
        let jumps = json!([{ "along": 0, "jump": [0, 0] }]);
        assert_eq!(still, json!({ "tool": "curve", "samples": 5, "nodes": "low", "jumps": jumps }));
        // The other one runs from right to left.
        let own = json!([{ "tool": "point", "at": [1, 1] }, { "tool": "curve", "samples": 7, "nodes": "low", "jumps": jumps }]);
        let (at, moved) = along(&layer(own), "/zones/0", ("low", &low), Lead::To(&lid)).unwrap();
        assert_eq!((at.as_str(), &moved["samples"]), ("/zones/0/motion/1", &json!(7)));
        assert_eq!(moved["jumps"][1], json!({ "along": 0.05, "jump": [0, -16] }));
        assert_eq!(moved["jumps"].as_array().unwrap().len(), PLACES);
        assert!(along(&layer(json!([])), "/image", ("low", &low), Lead::To(&lid)).is_none());
    }
}
