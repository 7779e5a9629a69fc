//! The window's own camera, as a value: it goes round the target, sideways, nearer and through the scene, and the scene
//! stays as it is.

use glam::{DMat3, DVec3};

use crate::base::maths::pow;
use crate::layers::space::camera::Camera;
use crate::layers::space::eye::{Eye, NEAR_M};
use crate::layers::space::fit::{Ball, Reach, fit};

/// The angle between the line of sight and the poles is at least this, in degrees.
const POLE_DEGREES: f64 = 1.0;
/// A step makes the distance from the target this many times shorter.
const NEARER: f64 = 1.15;
/// How near to the target, and how far from it, it goes, in meters, where it is not known how large is what is seen.
const DISTANCES_M: (f64, f64) = (2.0 * NEAR_M, 1e6);
/// The same by the radius of what is seen.
const OF_RADIUS: (f64, f64) = (2e-3, 30.0);

/// A camera at one time, to be steered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnView {
    position: DVec3,
    target: DVec3,
    up: DVec3,
    fov: f64,
}

impl OwnView {
    /// What a camera sees at scene time `t`.
    pub fn of(camera: &Camera, t: f64) -> OwnView {
        let ([position, target, up], fov) = camera.view(t);
        OwnView { position, target, up: up.normalize_or(DVec3::Y), fov }
    }

    /// The camera that stands there.
    pub fn camera(&self) -> Camera {
        let [position, target, up] = [self.position, self.target, self.up].map(Into::into);
        Camera { position, target, up, fov: self.fov, ..Camera::default() }
    }

    /// How far it is from its target.
    pub fn distance(&self) -> f64 {
        self.position.distance(self.target)
    }

    /// How large a pixel is at the target, in meters, in frames of this height.
    pub fn pixel(&self, height_px: f64) -> f64 {
        let view = [DVec3::Z, DVec3::ZERO, DVec3::Y];
        self.distance() / Eye::new(view, self.fov, (1, height_px.max(1.0) as usize)).focal_px
    }

    /// Right, up and back in the picture, as directions of the world.
    fn axes(&self) -> [DVec3; 3] {
        let eye = Eye::new([self.position, self.target, self.up], self.fov, (1, 1));
        [0, 1, 2].map(|i| eye.turn.row(i))
    }

    /// Goes round the target by degrees: to the right, and up. Poles are not passed.
    pub fn orbit(&mut self, right: f64, up: f64) {
        let (distance, [axis, ..]) = (self.distance(), self.axes());
        let offset = (self.position - self.target).normalize_or(DVec3::Z);
        let from_pole = offset.angle_between(self.up).to_degrees();
        let wanted = (from_pole - up).clamp(POLE_DEGREES, 180.0 - POLE_DEGREES);
        let lift = DMat3::from_axis_angle(axis, (wanted - from_pole).to_radians());
        let turn = DMat3::from_axis_angle(self.up, right.to_radians());
        self.position = self.target + (turn * (lift * offset)).normalize_or(DVec3::Z) * distance;
    }

    /// Goes to the right and up in the picture, in meters; it looks in the same direction.
    pub fn pan(&mut self, right: f64, up: f64) {
        let [x, y, _] = self.axes();
        self.shift(x * right + y * up);
    }

    /// Goes nearer to the target by steps, never past it; farther if they are negative. It stays where something of what is
    /// seen is more than a dot, and outside of the smallest of it.
    pub fn dolly(&mut self, steps: f64, around: Option<&Ball>) {
        let (near, far) = around.map_or(DISTANCES_M, |ball| {
            let away = self.target.distance(ball.middle);
            ((ball.radius * OF_RADIUS.0).max(DISTANCES_M.0), (ball.radius * OF_RADIUS.1).max(DISTANCES_M.0) + away)
        });
        // A view that began elsewhere is not pulled back.
        let now = self.distance();
        let distance = (now * pow(NEARER, -steps)).clamp(near.min(now), far.max(now));
        let back = (self.position - self.target).normalize_or(DVec3::Z);
        self.position = self.target + back * distance;
    }

    /// Goes to where it sees all of it in the same direction, in frames of this width and height.
    pub fn see(&mut self, reach: Reach, size: (usize, usize)) {
        let view = [self.position - self.target, self.up];
        if let Some([position, target]) = fit(reach, view, self.fov, size) {
            (self.position, self.target) = (position, target);
        }
    }

    /// Goes to the right and forward on the level, in meters.
    pub fn walk(&mut self, right: f64, forward: f64) {
        let [x, ..] = self.axes();
        self.shift(x * right + self.up.cross(x) * forward);
    }

    fn shift(&mut self, by: DVec3) {
        self.position += by;
        self.target += by;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::maths::sin;

    fn view() -> OwnView {
        OwnView::of(&Camera { position: [1.0, 2.0, 4.0], target: [0.5, 0.8, 0.0], ..Camera::default() }, 0.0)
    }

    fn way(view: &OwnView) -> DVec3 {
        (view.target - view.position).normalize()
    }

    #[test]
    fn an_orbit_keeps_the_distance_and_stops_at_the_poles() {
        let mut own = view();
        for (right, up) in [(30.0, 10.0), (-200.0, 500.0), (15.0, 90.0), (40.0, -1e4), (0.0, 0.5)] {
            own.orbit(right, up);
            assert!((own.distance() - view().distance()).abs() < 1e-9, "{own:?}");
            assert_eq!(own.target, view().target);
            let level = way(&own).cross(own.up).length();
            assert!(level >= sin(POLE_DEGREES.to_radians()) - 1e-9, "{level}");
        }
        let mut own = view();
        own.orbit(0.0, 500.0);
        let above = (own.position - own.target).angle_between(own.up).to_degrees();
        assert!((above - POLE_DEGREES).abs() < 1e-6, "up goes up: {above}");
        let mut own = OwnView::of(&Camera::default(), 0.0);
        own.orbit(90.0, 0.0);
        assert!(own.position.x > 3.9 && own.position.z.abs() < 1e-9, "right goes right: {own:?}");
    }

    #[test]
    fn a_pan_and_a_walk_keep_the_direction() {
        let mut own = view();
        own.pan(0.3, -0.2);
        assert!((way(&own) - way(&view())).length() < 1e-12);
        assert!(((own.position - view().position).dot(way(&view()))).abs() < 1e-12, "across the line of sight");
        let mut own = view();
        own.walk(0.0, 0.7);
        let went = own.position - view().position;
        assert!((way(&own) - way(&view())).length() < 1e-12);
        assert!((went.length() - 0.7).abs() < 1e-12 && went.y.abs() < 1e-12 && went.z < -0.6, "{went}");
    }

    #[test]
    fn a_dolly_never_passes_the_target_nor_loses_what_is_seen() {
        let mut own = view();
        own.dolly(1.0, None);
        assert!((own.distance() * NEARER - view().distance()).abs() < 1e-9);
        let ball = |radius| Ball { middle: view().target, radius };
        for (around, near, far) in [
            (None, DISTANCES_M.0, DISTANCES_M.1),
            (Some(ball(1.0)), DISTANCES_M.0, 30.0),
            (Some(ball(1000.0)), 2.0, 3e4),
            (Some(ball(1e-3)), DISTANCES_M.0, view().distance()),
        ] {
            for (steps, distance) in [(1e4, near), (-1e4, far)] {
                let mut own = view();
                own.dolly(steps, around.as_ref());
                assert!((own.distance() - distance).abs() < 1e-6 * distance, "{around:?}: {own:?}");
                assert!((way(&own) - way(&view())).length() < 1e-6);
            }
        }
    }

    #[test]
    fn all_is_seen_in_the_same_direction() {
        let (mut own, ball) = (view(), Ball { middle: DVec3::new(9.0, 0.0, 0.0), radius: 2.0 });
        own.walk(500.0, -300.0);
        own.see(&|ways| ball.reach(ways), (200, 100));
        let seen = own.camera().at(0.0, (200, 100));
        let middle = seen.project(seen.seen(ball.middle));
        assert!((middle - seen.middle_px).length() < 1e-6 && (way(&own) - way(&view())).length() < 1e-9, "{own:?}");
        assert!((5.0..9.0).contains(&own.distance()), "{own:?}");
    }
}
