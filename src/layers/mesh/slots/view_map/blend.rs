//! How much of the base coat alone is seen from a place: what blend points around it say.

use glam::DVec3;

use super::model::{Blend, BlendPoint};
use crate::base::maths::cos;
use crate::base::mesh::Mesh;

/// How far from all points the base coat fades in and out.
const STEEP: f64 = 4.0;
/// The least distance that points reach, in radii of the mesh.
const LEAST_REACH: f64 = 1e-3;
/// How far a point alone reaches, in radii of the mesh.
const ALONE: f64 = 2.0;
/// The greatest cosine that points reach to.
const MOST_COSINE: f64 = 0.99;

/// Blend points ready for any camera.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Points {
    /// Where one stands, where one looks, and how much of the base coat is seen from there.
    pub points: Vec<(DVec3, DVec3, f64)>,
    /// The cosine of the angle that they reach.
    pub cosine: f64,
    /// How far they reach, in meters.
    pub distance: f64,
}

impl Points {
    /// The points of a document, round a mesh.
    pub fn new(blend: &Blend, mesh: &Mesh) -> Points {
        let point = |point: &BlendPoint| {
            let [position, target] = [point.position, point.target].map(DVec3::from);
            (position, (target - position).normalize_or_zero(), point.base)
        };
        let points: Vec<(DVec3, DVec3, f64)> = blend.points.iter().map(point).collect();
        let radius = mesh.bounds().map_or(0.0, |(low, high)| (high - low).length() / 2.0);
        let alone = points.len() < 2;
        let cosine = match blend.angle {
            Some(angle) => cos(angle.to_radians()),
            None if alone => 0.0,
            None => mean_of_least(&points, |a, b| a.1.dot(b.1)).clamp(-1.0, MOST_COSINE),
        };
        let distance = match blend.distance {
            Some(distance) => distance,
            None if alone => ALONE * radius,
            None => mean_of_least(&points, |a, b| a.0.distance(b.0)).max(LEAST_REACH * radius),
        };
        Points { points, cosine, distance }
    }

    /// How much is seen from a camera of the model that looks this way.
    pub fn at(&self, position: DVec3, way: DVec3) -> f64 {
        let strengths = self.points.iter().map(|(at, toward, base)| {
            let turned = ((way.dot(*toward) - self.cosine) / (1.0 - self.cosine)).max(0.0);
            (turned * (1.0 - position.distance(*at) / self.distance).max(0.0), *base)
        });
        let (sum, bases) =
            strengths.fold((0.0, 0.0), |(sum, bases), (strength, base)| (sum + strength, bases + strength * base));
        if sum > 0.0 { bases / sum * (STEEP * sum).min(1.0) } else { 0.0 }
    }
}

/// The mean over all points of the least of something between each and the others.
fn mean_of_least<T>(points: &[T], between: impl Fn(&T, &T) -> f64) -> f64 {
    let least = points.iter().enumerate().map(|(i, one)| {
        let others = points.iter().enumerate().filter(|(j, _)| *j != i);
        others.map(|(_, other)| between(one, other)).fold(f64::INFINITY, f64::min)
    });
    least.sum::<f64>() / points.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_say_how_much_of_the_base_coat_is_seen() {
        let mesh = Mesh::default();
        let points = |json: &str| Points::new(&serde_json::from_str(json).unwrap(), &mesh);
        let two = r#"{"points": [{"position": [0, 0, 4], "base": 1}, {"position": [4, 0, 0], "base": 0}]}"#;
        let two = points(two);
        assert!(two.cosine.abs() < 1e-12 && (two.distance - 32f64.sqrt()).abs() < 1e-12, "{two:?}");
        let from = |at: [f64; 3]| two.at(at.into(), -DVec3::from(at).normalize());
        assert_eq!(from([0.0, 0.0, 4.0]), 1.0);
        assert_eq!(from([4.0, 0.0, 0.0]), 0.0);
        assert!((from([2.0, 0.0, 2.0]) - 0.5).abs() < 1e-12);
        assert_eq!(from([0.0, 0.0, -4.0]), 0.0, "no point there");
        // It fades out: there is no step where the last point ends.
        let alone = points(r#"{"points": [{"position": [0, 0, 4]}], "angle": 90, "distance": 1}"#);
        let at = |z: f64| alone.at(DVec3::new(0.0, 0.0, z), -DVec3::Z);
        assert_eq!([at(4.5), at(5.0)], [1.0, 0.0]);
        assert!((at(4.9) - 0.4).abs() < 1e-12, "{}", at(4.9));
    }
}
