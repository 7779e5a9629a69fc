//! What is at a place of the picture in a layer, for selection by pointer.

use kurbo::Point;

use super::marks::zone_path;
use super::model::{PictureLayer, Zone};
use crate::layers::parts::marks::Hit;

/// The tool of the nearest anchor within `reach_px` of a place, otherwise the topmost zone that contains it, otherwise
/// `None`.
pub fn pick(layer: &PictureLayer, at: Point, reach_px: f64) -> Option<Hit> {
    let zones = || layer.zones.iter().enumerate().rev();
    let near = zones().filter_map(|(z, zone)| {
        let (tool, distance_px) = nearest(zone, at).filter(|(_, distance)| *distance <= reach_px)?;
        Some(Hit { path: format!("{}/motion/{tool}", zone_path(z)), distance_px, cell: "/tool" })
    });
    let holds = |(z, _): (usize, &Zone)| Hit { path: zone_path(z), distance_px: f64::INFINITY, cell: "" };
    near.min_by(|a, b| a.distance_px.total_cmp(&b.distance_px))
        .or_else(|| zones().find(|(_, zone)| zone.outline.polygon().contains(at)).map(holds))
}

/// The tool of the nearest anchor, and its distance.
fn nearest(zone: &Zone, at: Point) -> Option<(usize, f64)> {
    let distances = zone.anchors().into_iter().map(|anchor| (anchor.tool, anchor.at.distance(at)));
    distances.min_by(|a, b| a.1.total_cmp(&b.1))
}
