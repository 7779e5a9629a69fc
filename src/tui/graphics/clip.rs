//! A frame of a clip in place of the scene, for the pane in which pictures are picked from it.

use kurbo::{Point, Rect};

use crate::layers::parts::marks::{Look, Mark, Shape};
use crate::layers::parts::picking::Subject;
use crate::render::Synth;
use crate::render::sight::alone;

/// What is looked at in place of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct ClipView {
    /// The layer whose pictures are picked.
    pub layer: usize,
    /// What of its clip is seen.
    pub sight: Subject,
    /// What is selected.
    pub selection: String,
}

/// The square at the cursor.
static SQUARE: Look = Look::new("square at the cursor", 50, [255, 255, 255, 255], 1.0).stroke("▪");

/// The square of this side around a place, as a mark.
pub fn square(at: Point, side: f64) -> Mark {
    let of = Rect::from_center_size(at, (side, side));
    let points = [(of.x0, of.y0), (of.x1, of.y0), (of.x1, of.y1), (of.x0, of.y1)].map(Point::from);
    Mark::new(&SQUARE, "", Shape::Line { points: points.into(), closed: true })
}

impl ClipView {
    /// The picture as a scene of its own, and the marks over it with the side of a square; `None` if there is nothing to
    /// be seen.
    pub fn seen(&self, synth: &Synth) -> Option<(Synth, Vec<Mark>, f64)> {
        let found = synth.layers.get(self.layer)?.picking(self.sight)?;
        let told = |mark: Mark| {
            let mark = Mark { layer: Some(self.layer), ..mark };
            Mark { selected: mark.pointer() == self.selection, ..mark }
        };
        Some((alone(found.picture)?, found.marks.into_iter().map(told).collect(), found.side))
    }
}
