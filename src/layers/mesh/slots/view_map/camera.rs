//! The camera of a view, in the coordinates of the model.

use glam::{DMat3, DVec2, DVec3};

use crate::layers::space::eye::Eye;

/// A camera with pixels of any shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where it is.
    pub position: DVec3,
    /// From directions of the model to camera coordinates: x right, y up, z back.
    pub turn: DMat3,
    /// Distance of the picture plane, in widths and in heights of a pixel.
    pub focal_px: DVec2,
    /// Where the axis meets the picture, in pixels.
    pub middle_px: DVec2,
    /// Width and height of the picture.
    pub size_px: (usize, usize),
}

impl Camera {
    /// As an eye sees, in pictures of this width and height.
    pub fn of_eye(eye: &Eye, size_px: (usize, usize)) -> Camera {
        let Eye { position, turn, focal_px, middle_px } = *eye;
        Camera { position, turn, focal_px: DVec2::splat(focal_px), middle_px, size_px }
    }

    /// From the turn and the shift that lead from the model to x right, y down, z forward.
    pub fn of_turn(turn: DMat3, shift: DVec3, focal_px: DVec2, middle_px: DVec2, size_px: (usize, usize)) -> Camera {
        let flip = DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0));
        Camera { position: -(turn.transpose() * shift), turn: flip * turn, focal_px, middle_px, size_px }
    }

    /// The same for pictures of another size.
    pub fn resized(&self, (width, height): (usize, usize)) -> Camera {
        let by = DVec2::new(width as f64 / self.size_px.0 as f64, height as f64 / self.size_px.1 as f64);
        Camera { focal_px: self.focal_px * by, middle_px: self.middle_px * by, size_px: (width, height), ..*self }
    }

    /// An eye for pictures so many times larger, if heights are stretched to be as wide as pixels; see [`Camera::seen`].
    pub fn eye(&self, times: f64) -> Eye {
        let Camera { position, turn, focal_px, middle_px, .. } = *self;
        Eye { position, turn, focal_px: focal_px.x * times, middle_px: middle_px * times }
    }

    /// A point of the model in camera coordinates whose heights are stretched for [`Camera::eye`].
    #[inline]
    pub fn seen(&self, model: DVec3) -> DVec3 {
        let seen = self.turn * (model - self.position);
        seen.with_y(seen.y * (self.focal_px.y / self.focal_px.x))
    }

    /// Its right, its up, and from where it looks to itself: the axes of the camera in the model.
    pub fn axes(&self) -> [DVec3; 3] {
        [self.turn.row(0), self.turn.row(1), self.turn.row(2)]
    }
}

/// The rotation that is nearest to a matrix that nearly is one.
pub fn nearest_turn(of: DMat3) -> DMat3 {
    /// Each step squares the error.
    const STEPS: usize = 6;
    (0..STEPS).fold(of, |turn, _| (turn + turn.inverse().transpose()) * 0.5)
}
