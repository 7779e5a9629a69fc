//! Where a camera has to stand to see all of something.

use glam::DVec3;

use super::eye::{Eye, NEAR_M};

/// What is to be seen reaches to at most this share of the frame.
const SHARE: f64 = 0.9;

/// A box along the axes of the world, by its lowest and its highest corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The lowest corner.
    pub low: DVec3,
    /// The highest corner.
    pub high: DVec3,
}

impl Bounds {
    /// The smallest box around points; `None` around none.
    pub fn around(points: impl IntoIterator<Item = DVec3>) -> Option<Bounds> {
        let point = points.into_iter().map(|at| Bounds { low: at, high: at });
        point.reduce(|a, b| a.and(&b))
    }

    /// The smallest box around two.
    pub fn and(&self, other: &Bounds) -> Bounds {
        Bounds { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Its corners.
    pub fn corners(&self) -> [DVec3; 8] {
        let side = |i: usize, axis: usize| if (i >> axis) & 1 == 0 { self.low[axis] } else { self.high[axis] };
        std::array::from_fn(|i| DVec3::new(side(i, 0), side(i, 1), side(i, 2)))
    }

    /// Its middle.
    pub fn middle(&self) -> DVec3 {
        (self.low + self.high) / 2.0
    }
}

/// The position and the target of a camera that sees all of a box from the direction `back`, with a vertical field of view
/// of `fov` degrees, in frames of this width and height.
pub fn fit(bounds: &Bounds, [back, up]: [DVec3; 2], fov: f64, size: (usize, usize)) -> [DVec3; 2] {
    let (target, back) = (bounds.middle(), back.normalize_or(DVec3::Z));
    let eye = Eye::new([target + back, target, up], fov, size);
    let half_px = eye.middle_px * SHARE;
    let needed = bounds.corners().map(|corner| {
        let seen = eye.turn * (corner - target);
        let across = (seen.x.abs() / half_px.x).max(seen.y.abs() / half_px.y) * eye.focal_px;
        seen.z + across.max(2.0 * NEAR_M)
    });
    let distance = needed.into_iter().fold(2.0 * NEAR_M, f64::max);
    [target + back * distance, target]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_corner_is_in_the_frame_and_the_frame_is_filled() {
        let flat = Bounds { low: DVec3::new(-1.0, 0.0, -4.0), high: DVec3::new(1.0, 0.0, 4.0) };
        let tall = Bounds { low: DVec3::new(10.0, -3.0, 2.0), high: DVec3::new(11.0, 40.0, 2.5) };
        for bounds in [flat, tall] {
            for size in [(1280, 720), (100, 900)] {
                for (back, fov) in [([0.0, 0.3, 1.0], 40.0), ([-2.0, 1.0, 0.1], 100.0), ([0.0, 1.0, 0.0], 8.0)] {
                    let [position, target] = fit(&bounds, [DVec3::from(back), DVec3::Y], fov, size);
                    let eye = Eye::new([position, target, DVec3::Y], fov, size);
                    let reach = bounds.corners().map(|corner| {
                        let seen = eye.seen(corner);
                        assert!(seen.z < -NEAR_M, "{bounds:?} {size:?} {back:?}: behind");
                        let from_middle = (eye.project(seen) - eye.middle_px) / eye.middle_px;
                        from_middle.abs().max_element()
                    });
                    let reach = reach.into_iter().fold(0.0, f64::max);
                    assert!((reach - SHARE).abs() < 1e-9, "{bounds:?} {size:?} {back:?}: {reach}");
                }
            }
        }
    }

    #[test]
    fn a_point_is_seen_from_in_front() {
        let point = Bounds::around([DVec3::ONE]).unwrap();
        let [position, target] = fit(&point, [DVec3::Z, DVec3::Y], 40.0, (4, 4));
        assert_eq!(target, DVec3::ONE);
        assert!(position.z > 1.0 + NEAR_M);
        assert_eq!(Bounds::around([]), None);
    }
}
