//! Places on the sphere round what a view looks at, through its camera: where extreme points are, and where one blends from.

use glam::DVec3;
use serde_json::{Value, json};

use super::map::Map;
use super::view::{Extremes, View};
use crate::base::maths::{atan, atan2};
use crate::base::number::rounded_json;
use crate::layers::mesh::pose::Placed;
use crate::layers::parts::shots::Put;
use crate::layers::space::eye::Ray;

/// Degrees and lengths are written with so many decimals.
const DECIMALS: (u32, u32) = (1, 3);
/// The greatest angle of an extreme point, in degrees.
const MOST: f64 = 170.0;

/// What is put where a ray of the world meets the sphere of the view of this number, relative to the surface: the list that it
/// goes to, or what is to be set where there is no such list yet; and its value.
///
/// # Errors
/// The map is not made of the view.
pub fn put(map: &Map, number: usize, put: Put, ray: &Ray, placed: &Placed) -> Result<(String, Value), String> {
    let view = map.wanted.views.iter().find(|view| view.number == number);
    let view = view.ok_or("the view does not count: make it active")?;
    let place = met(view, placed, ray);
    match (put, &view.extremes) {
        (Put::Blend, _) => {
            let written = |at: DVec3| at.to_array().map(|part| rounded_json(part, DECIMALS.1));
            Ok(("/blend/points".into(), json!({ "position": written(place), "target": written(view.target) })))
        }
        (Put::Nothing, _) | (Put::Extreme, Extremes::Points(_)) => {
            let [right, up] = degrees(view, place).map(|angle| rounded_json(angle.clamp(-MOST, MOST), DECIMALS.0));
            Ok((format!("/views/{number}/extremes/points"), json!([right, up])))
        }
        (Put::Extreme, Extremes::Auto(reach) | Extremes::Cone(reach)) => {
            // A ring where it is gone now.
            let far = (2.0 * atan(*reach)).to_degrees().min(MOST);
            let [most, least] = [far, -far].map(|angle| rounded_json(angle, DECIMALS.0));
            let ring = json!([[most, 0], [0, most], [least, 0], [0, least]]);
            Ok((format!("/views/{number}/extremes"), json!({ "kind": "points", "points": ring })))
        }
    }
}

/// Where a ray first meets the sphere; where it passes by, the place of the sphere that is nearest to it.
fn met(view: &View, placed: &Placed, ray: &Ray) -> DVec3 {
    let from = placed.turn.transpose() * (ray.from - placed.position) / placed.scale;
    let along = (placed.turn.transpose() * ray.along).normalize_or_zero();
    let radius = view.camera.position.distance(view.target);
    let (away, back) = (from - view.target, -(from - view.target).dot(along));
    let inside = back * back - away.length_squared() + radius * radius;
    let far = match inside.max(0.0).sqrt() {
        half if back - half > 0.0 => back - half,
        half => (back + half).max(0.0),
    };
    view.target + (away + along * far).normalize_or(view.camera.axes()[2]) * radius
}

/// How far a place is turned from the camera of a view: to the right and up.
fn degrees(view: &View, place: DVec3) -> [f64; 2] {
    let [x, y, _] = view.camera.axes();
    let way = (place - view.target).normalize_or_zero();
    let front = (view.camera.position - view.target).normalize_or_zero();
    let level = (way.dot(x) * way.dot(x) + way.dot(front) * way.dot(front)).sqrt();
    [atan2(way.dot(x), way.dot(front)), atan2(way.dot(y), level)].map(f64::to_degrees)
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec2};

    use super::*;
    use crate::layers::mesh::pose::Pose;
    use crate::layers::mesh::slots::view_map::tests::view;

    #[test]
    fn where_a_ray_meets_the_sphere_is_told_as_extreme_points_are() {
        let view = view([1.0, 2.0, 4.0], 0);
        let pose = Pose { position: [3.0, -1.0, 0.5], rotate: [10.0, 40.0, 0.0], scale: 2.0, ..Pose::default() };
        let placed = pose.at(0.0);
        for [right, up] in [[0.0, 0.0], [30.0, -20.0], [-65.0, 40.0], [80.0, 70.0]] {
            let Extremes::Points(places) = Extremes::points(&view.camera, view.target, &[DVec2::new(right, up)]) else {
                panic!()
            };
            // From outside, straight to the middle.
            let at = placed.point(places[0], DVec3::ZERO).0;
            let middle = placed.point(view.target, DVec3::ZERO).0;
            let ray = Ray { from: middle + (at - middle) * 3.0, along: middle - at };
            let found = met(&view, &placed, &ray);
            assert!(found.distance(places[0]) < 1e-9, "{found} {}", places[0]);
            let found = degrees(&view, found);
            assert!((found[0] - right).abs() + (found[1] - up).abs() < 1e-9, "{found:?}");
        }
        // What passes by comes as near as it can.
        let flat = Placed { turn: DMat3::IDENTITY, ..Pose::default().at(0.0) };
        let beside = met(&view, &flat, &Ray { from: DVec3::new(100.0, 0.0, 50.0), along: DVec3::NEG_Z });
        assert!(beside.distance(DVec3::X * 21f64.sqrt()) < 1e-9, "{beside}");
    }
}
