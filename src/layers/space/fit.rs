//! Where a camera has to stand to see all of something.

use glam::DVec3;

use super::eye::{Eye, NEAR_M};
use crate::base::maths::{lerp, powi};
use crate::base::{geometry, number};

/// What is to be seen reaches to at most this share of the frame.
const SHARE: f64 = 0.9;

/// The camera stands before it by at least this share of its depth.
const LEAST_BEFORE: f64 = 0.125;

/// The distance from the target has at least so many units of the last digit of a place.
const UNITS: f64 = 1e4;

/// A camera that was fitted and rounded is fitted anew to within so many of them.
const SAME_UNITS: f64 = 3.0;

/// On the side of the frame that has room to spare, the middle is sought in so many steps.
const STEPS: usize = 8;

/// How far something reaches along each of some ways of the world: the greatest scalar product of one of its points with
/// it. `None` if there is nothing.
pub type Reach<'a> = &'a dyn Fn(&[DVec3]) -> Option<Vec<f64>>;

/// The middle of the box along the axes of the world around something.
pub fn middle(reach: Reach) -> Option<DVec3> {
    let far = reach(&[DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z])?;
    let [x, y, z, left, down, back] = far.try_into().ok()?;
    Some(DVec3::new(x - left, y - down, z - back) / 2.0)
}

/// A ball around something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Its middle.
    pub middle: DVec3,
    /// Its radius, in meters.
    pub radius: f64,
}

impl Ball {
    /// The ball around the box along the axes of the world around something.
    pub fn around(reach: Reach) -> Option<Ball> {
        let middle = middle(reach)?;
        let far = reach(&[DVec3::X, DVec3::Y, DVec3::Z])?;
        let corner = DVec3::from_array(far.try_into().ok()?);
        Some(Ball { middle, radius: corner.distance(middle) })
    }

    /// See [`Reach`].
    pub fn reach(&self, ways: &[DVec3]) -> Option<Vec<f64>> {
        Some(ways.iter().map(|way| way.dot(self.middle) + way.length() * self.radius).collect())
    }
}

/// The position and the target of the camera that looks from the direction `back` and sees all of something, as near as can
/// be, with a vertical field of view of `fov` degrees, in frames of this width and height.
///
/// With z along `back`, x to the right and s the slope of the right edge of what is to be filled, a point is left of that edge
/// where x + s z is at most that of the camera: the farthest point along (1, s) alone decides, and so on each side.
pub fn fit(reach: Reach, [back, up]: [DVec3; 2], fov: f64, size: (usize, usize)) -> Option<[DVec3; 2]> {
    let eye = Eye::new([back.normalize_or(DVec3::Z), DVec3::ZERO, up], fov, size);
    let [right, up, back] = [0, 1, 2].map(|axis| eye.turn.row(axis));
    let [nearest, deepest] = reach(&[back, -back])?.try_into().ok()?;
    let half = eye.middle_px * SHARE / eye.focal_px;
    let across = Side::new(reach, [right, back], half.x)?;
    let upward = Side::new(reach, [up, back], half.y)?;
    // What is long and thin is not looked at from its very end.
    let before = ((nearest + deepest) * LEAST_BEFORE).max(2.0 * NEAR_M);
    let distance = across.needed().max(upward.needed()).max(nearest + before);
    let beside = right * across.middle(distance) + up * upward.middle(distance);
    // It looks at what is half way between the nearest and the deepest.
    Some([distance, (nearest - deepest) / 2.0].map(|along| beside + back * along))
}

/// Whether something may reach into what an eye sees: on the inner side of each plane that bounds that. What is in the frame
/// itself, and reaches nowhere in space, does.
pub fn may_see(reach: Reach, eye: &Eye) -> bool {
    let half = eye.middle_px / eye.focal_px;
    let sides = [[1.0, 0.0, half.x], [-1.0, 0.0, half.x], [0.0, 1.0, half.y], [0.0, -1.0, half.y], [0.0, 0.0, 1.0]];
    let [right, up, back] = [0, 1, 2].map(|axis| eye.turn.row(axis));
    let ways = sides.map(|[x, y, ahead]| right * x + up * y - back * ahead);
    let least = [0.0, 0.0, 0.0, 0.0, NEAR_M];
    let inside = |((far, way), least): ((f64, DVec3), f64)| far - way.dot(eye.position) >= least;
    reach(&ways).is_none_or(|far| far.into_iter().zip(ways).zip(least).all(inside))
}

/// Position and target in numbers as short as may be.
pub fn short([position, target]: [DVec3; 2]) -> [DVec3; 2] {
    let decimals = number::decimals(position.distance(target), UNITS);
    [position, target].map(|at| geometry::rounded(at, decimals))
}

/// Whether two positions with their targets differ by no more than what [`short`] takes away.
pub fn is_same(a: [DVec3; 2], b: [DVec3; 2]) -> bool {
    let far = [0, 1].map(|i| (a[i] - b[i]).abs().max_element());
    far[0].max(far[1]) * powi(10.0, number::decimals(a[0].distance(a[1]), UNITS)) < SAME_UNITS + 0.5
}

/// How far something reaches beside lines of several slopes, on both sides of an axis of the frame.
struct Side {
    slopes: [f64; STEPS + 1],
    far: [[f64; 2]; STEPS + 1],
}

impl Side {
    /// Slopes up to that of the edge of the frame.
    fn new(reach: Reach, [axis, back]: [DVec3; 2], steepest: f64) -> Option<Side> {
        let slopes = std::array::from_fn(|k| steepest * k as f64 / STEPS as f64);
        let ways: Vec<DVec3> = slopes.iter().flat_map(|slope| [axis, -axis].map(|side| side + back * *slope)).collect();
        let far = reach(&ways)?;
        Some(Side { slopes, far: std::array::from_fn(|k| [far[2 * k], far[2 * k + 1]]) })
    }

    /// How far back it has to stand at least.
    fn needed(&self) -> f64 {
        let [right, left] = self.far[STEPS];
        (right + left) / (2.0 * self.slopes[STEPS])
    }

    /// Where it stands on the axis so that there is as much room on both sides, if it is so far back.
    fn middle(&self, distance: f64) -> f64 {
        let [right, left] = self.far[STEPS];
        let room = |k: usize| 2.0 * self.slopes[k] * distance - self.far[k][0] - self.far[k][1];
        let between = |k: usize| (self.far[k][0] - self.far[k][1]) / 2.0;
        // The slope at which both sides are filled. Room grows with it.
        let after = (1..=STEPS).find(|k| room(*k) >= 0.0).unwrap_or(STEPS);
        let (least, most) = (room(after - 1), room(after));
        let share = if most > least { (-least / (most - least)).clamp(0.0, 1.0) } else { 1.0 };
        let sought = lerp(between(after - 1), between(after), share);
        let end = self.slopes[STEPS] * distance;
        sought.min(end - left).max(right - end)
    }
}

#[cfg(test)]
mod tests {
    use rayon::prelude::*;

    use super::*;
    use crate::base::geometry::reach;

    fn fitted(points: &[DVec3], [back, up]: [DVec3; 2], fov: f64, size: (usize, usize)) -> [DVec3; 2] {
        fit(&|ways| reach(points.par_iter().copied(), ways), [back, up], fov, size).unwrap()
    }

    /// The least and the greatest place of points in the frame, where 1 is its edge.
    fn places(points: &[DVec3], view: [DVec3; 2], fov: f64, size: (usize, usize)) -> [glam::DVec2; 2] {
        let eye = Eye::new([view[0], view[1], DVec3::Y], fov, size);
        let places = points.iter().map(|point| {
            let seen = eye.seen(*point);
            assert!(seen.z < -NEAR_M, "{point} is behind");
            (eye.project(seen) - eye.middle_px) / eye.middle_px
        });
        let places: Vec<_> = places.collect();
        [places.iter().copied().reduce(|a, b| a.min(b)), places.iter().copied().reduce(|a, b| a.max(b))]
            .map(Option::unwrap)
    }

    #[test]
    fn what_lies_beyond_a_side_of_the_frame_is_not_seen() {
        let eye = Eye::new([DVec3::new(0.0, 0.0, 4.0), DVec3::ZERO, DVec3::Y], 90.0, (200, 100));
        for (middle, sees) in [
            ([0.0, 0.0, 0.0], true),
            ([0.0, 0.0, 6.0], false),
            ([8.5, 0.0, 0.0], true),
            ([10.5, 0.0, 0.0], false),
            ([0.0, -5.2, 0.0], true),
            ([0.0, -5.6, 0.0], false),
        ] {
            let ball = Ball { middle: DVec3::from(middle), radius: 1.0 };
            assert_eq!(may_see(&|ways| ball.reach(ways), &eye), sees, "{middle:?}");
        }
        assert!(may_see(&|_| None, &eye), "what is in the frame itself");
    }

    #[test]
    fn the_frame_is_filled_by_what_is_seen_and_that_stands_in_its_middle() {
        let round = |i: u32| crate::base::maths::TAU * f64::from(i) / 40.0;
        let (sin, cos) = (crate::base::maths::sin, crate::base::maths::cos);
        let ring: Vec<DVec3> = (0..40).map(|i| DVec3::new(3.0 + cos(round(i)), 5.0, sin(round(i)))).collect();
        let pole = vec![DVec3::new(0.0, -3.0, 0.0), DVec3::new(0.0, 40.0, 0.5)];
        // A box around it would be larger by far.
        let diagonal = vec![DVec3::new(-3.0, 0.0, -3.0), DVec3::new(3.0, 4.0, 3.0)];
        let tetrahedron = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
        let tetrahedron = tetrahedron.map(|at| DVec3::from(at) * 1e-3).to_vec();
        for points in [ring, pole, diagonal, tetrahedron] {
            for size in [(1280, 720), (100, 900)] {
                for (back, fov) in [([0.0, 0.3, 1.0], 40.0), ([-2.0, 1.0, 0.1], 100.0), ([0.3, 1.0, 0.0], 8.0)] {
                    let ways = [DVec3::from(back), DVec3::Y];
                    let view = fitted(&points, ways, fov, size);
                    let [least, most] = places(&points, view, fov, size);
                    let widest = most.max(-least).max_element();
                    let near = (most.abs() - least.abs()).abs().max_element();
                    let told = format!("{points:?} {size:?} {back:?}: {least} {most}");
                    let back = ways[0].normalize();
                    let [nearest, deepest] =
                        [back, -back].map(|way| reach(points.par_iter().copied(), &[way]).unwrap()[0]);
                    let before = view[0].dot(back) - nearest;
                    let nearest_allowed = ((nearest + deepest) * LEAST_BEFORE).max(2.0 * NEAR_M);
                    let filled = (widest - SHARE).abs() < 1e-9 || (before - nearest_allowed).abs() < 1e-9;
                    assert!(filled && widest < SHARE + 1e-9 && near < 0.03, "{told}");
                }
            }
        }
    }

    #[test]
    fn what_is_long_is_not_seen_from_its_very_end() {
        let [position, target] = fitted(&[DVec3::Z * 8.0, DVec3::ZERO], [DVec3::Z, DVec3::Y], 40.0, (4, 4));
        assert_eq!((position, target), (DVec3::Z * 9.0, DVec3::Z * 4.0));
    }

    #[test]
    fn a_point_is_seen_from_in_front() {
        let [position, target] = fitted(&[DVec3::ONE], [DVec3::Z, DVec3::Y], 40.0, (4, 4));
        assert_eq!(target, DVec3::ONE);
        assert!(position.z > 1.0 + NEAR_M && position.truncate() == target.truncate());
        assert_eq!(fit(&|_| None, [DVec3::Z, DVec3::Y], 40.0, (4, 4)), None);
    }

    #[test]
    fn what_was_fitted_in_short_numbers_is_not_fitted_anew() {
        for (scale, up) in [(1.0, 0.3), (0.0137, 0.3), (1e5, 0.3), (2.9, -4.0), (0.11, 1.7)] {
            let points = [[-1.0, 0.0, -2.0], [1.0, 3.0, 0.5], [4.0, 0.1, 0.3]].map(|at| DVec3::from(at) * scale);
            let first = short(fitted(&points, [DVec3::new(0.2, up, 1.0), DVec3::Y], 40.0, (1280, 720)));
            let again = short(fitted(&points, [first[0] - first[1], DVec3::Y], 40.0, (1280, 720)));
            assert!(is_same(first, again), "{first:?} {again:?}");
            assert!(!is_same(first, [first[0] + DVec3::X * scale * 0.01, first[1]]));
        }
    }

    #[test]
    fn the_middle_is_that_of_the_box() {
        let points = [DVec3::new(1.0, -2.0, 5.0), DVec3::new(3.0, 4.0, 0.0), DVec3::new(1.5, 0.0, 4.9)];
        assert_eq!(middle(&|ways| reach(points.par_iter().copied(), ways)), Some(DVec3::new(2.0, 1.0, 2.5)));
        let ball = Ball::around(&|ways| reach(points.par_iter().copied(), ways)).unwrap();
        assert!(points.iter().all(|point| point.distance(ball.middle) <= ball.radius + 1e-9), "{ball:?}");
        let [position, target] = fit(&|ways| ball.reach(ways), [DVec3::Z, DVec3::Y], 60.0, (9, 9)).unwrap();
        assert!((target - ball.middle).length() < 1e-9 && position.z > ball.middle.z + ball.radius, "{position}");
    }
}
