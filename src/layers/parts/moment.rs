//! When a layer is shown, and which of its pixels are wanted.

use kurbo::Vec2;

use crate::layers::space::eye::Eye;

/// The center of a pixel, from its top-left corner.
pub const CENTER: Vec2 = Vec2::new(0.5, 0.5);

/// What a frame depends on besides the layers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Scene time, in [0, 1].
    pub t: f64,
    /// Width and height of the frame, in pixels.
    pub size_px: (usize, usize),
    /// Where the scene is seen from, if it has a camera.
    pub eye: Option<Eye>,
    /// How many births layers of many sprites leave out after each that they show: 0 but for a preview that would be slow.
    pub left_out: u32,
    /// How many times larger than that of the scene the frame is on each side, for several samples a pixel of layers that
    /// are drawn whole. Above 1, each pixel is looked at in its center.
    pub magnified: u32,
}

/// Where the layers of a technique are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// In the frame, pixel for pixel.
    Plane,
    /// In the world, seen by the camera: neighbors in the list hide each other by their depth.
    World,
}

/// Which columns of a row are wanted.
#[derive(Clone, Copy, Debug)]
pub enum Columns<'a> {
    /// All columns of the frame.
    All,
    /// These, ascending and within the frame.
    Some(&'a [usize]),
}

impl Columns<'_> {
    /// The column of the frame that the wanted cell of this number is.
    #[inline]
    pub fn at(&self, cell: usize) -> usize {
        match self {
            Columns::All => cell,
            Columns::Some(wanted) => wanted[cell],
        }
    }
}
