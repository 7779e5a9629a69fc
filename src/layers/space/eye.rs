//! Where a frame is seen from: camera coordinates, and their place in the frame.

use glam::{DMat3, DVec2, DVec3};

use crate::base::maths;

/// The depth at which triangles are cut off in front, in meters.
pub const NEAR_M: f64 = 0.01;

/// What is larger, or reaches further, no camera sees as a whole: positions in a scene end at ten times that, in meters.
pub const FAR_M: f64 = 1e8;

/// A camera at one time, for frames of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eye {
    /// Where it is in the world.
    pub position: DVec3,
    /// From directions in the world to camera coordinates.
    pub turn: DMat3,
    /// Distance of the picture plane, in pixels.
    pub focal_px: f64,
    /// The middle of the frame, in pixels.
    pub middle_px: DVec2,
}

/// What a place of the frame looks along in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it begins: the camera.
    pub from: DVec3,
    /// The way from one depth to the next meter of depth.
    pub along: DVec3,
}

impl Ray {
    /// Its point at a depth.
    pub fn at_depth(&self, depth: f64) -> DVec3 {
        self.from + self.along * depth
    }

    /// Where it meets the level plane at the height `y`; `None` if that is behind the camera, or nowhere.
    pub fn meets_level(&self, y: f64) -> Option<DVec3> {
        let depth = (y - self.from.y) / self.along.y;
        (depth.is_finite() && depth >= NEAR_M).then(|| self.at_depth(depth).with_y(y))
    }
}

impl Eye {
    /// Looks from `position` to `target`, with `up` as far up as can be and a vertical field of view of `fov` degrees,
    /// at frames of this width and height. If there is no such view (`target` is where it stands, or straight along
    /// `up`), another one with the same position.
    pub fn new([position, target, up]: [DVec3; 3], fov: f64, (width, height): (usize, usize)) -> Eye {
        let back = (position - target).normalize_or(DVec3::Z);
        let right = up.cross(back).try_normalize().unwrap_or_else(|| back.any_orthonormal_vector());
        let turn = DMat3::from_cols(right, back.cross(right), back).transpose();
        let half = fov.to_radians() / 2.0;
        let focal_px = height as f64 / 2.0 / (maths::sin(half) / maths::cos(half));
        Eye { position, turn, focal_px, middle_px: DVec2::new(width as f64, height as f64) / 2.0 }
    }

    /// A point of the world in camera coordinates: x right, y up, z back.
    pub fn seen(&self, world: DVec3) -> DVec3 {
        self.turn * (world - self.position)
    }

    /// Where a point in camera coordinates is in the frame, in pixels; it must be in front.
    pub fn project(&self, seen: DVec3) -> DVec2 {
        self.middle_px + DVec2::new(seen.x, -seen.y) * (self.focal_px / -seen.z)
    }

    /// The direction that the place `at` of the frame looks along, in camera coordinates, up to depth 1: the point at
    /// depth d is d times this.
    pub fn ray(&self, at: DVec2) -> DVec3 {
        let plane = (at - self.middle_px) / self.focal_px;
        DVec3::new(plane.x, -plane.y, -1.0)
    }

    /// The same in the world.
    pub fn ray_in_world(&self, at: DVec2) -> Ray {
        Ray { from: self.position, along: self.turn.transpose() * self.ray(at) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_goes_back_and_v_goes_down() {
        let eye = Eye::new([DVec3::new(0.0, 1.0, 4.0), DVec3::new(0.0, 1.0, 0.0), DVec3::Y], 90.0, (200, 100));
        assert!((eye.focal_px - 50.0).abs() < 1e-12);
        let seen = eye.seen(DVec3::new(1.0, 2.0, 2.0));
        assert_eq!(seen, DVec3::new(1.0, 1.0, -2.0));
        assert!((eye.project(seen) - DVec2::new(125.0, 25.0)).length() < 1e-12);
        assert!((eye.ray(DVec2::new(125.0, 25.0)) * 2.0 - seen).length() < 1e-12);
    }

    #[test]
    fn a_ray_meets_what_is_seen_there() {
        let eye = Eye::new([DVec3::new(1.0, 3.0, 4.0), DVec3::new(0.0, 0.5, 0.0), DVec3::Y], 50.0, (200, 100));
        let place = DVec3::new(0.3, 0.25, -1.0);
        let ray = eye.ray_in_world(eye.project(eye.seen(place)));
        assert!((ray.at_depth(-eye.seen(place).z) - place).length() < 1e-9);
        assert!((ray.meets_level(0.25).unwrap() - place).length() < 1e-9);
        assert_eq!(ray.meets_level(9.0), None, "behind the camera");
        assert_eq!(Ray { along: DVec3::X, ..ray }.meets_level(0.0), None, "never");
    }

    #[test]
    fn a_view_that_is_none_still_has_axes() {
        for target in [DVec3::ZERO, DVec3::Y, -DVec3::Y] {
            let eye = Eye::new([DVec3::ZERO, target, DVec3::Y], 40.0, (4, 4));
            assert!((eye.turn.determinant() - 1.0).abs() < 1e-12, "{target}");
        }
    }
}
