//! What moved from one frame to the next: formats write that rectangle alone.

use crate::base::pixels::Frame;

/// Columns `x0..x1` and rows `y0..y1`; never empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rect {
    pub x0: usize,
    pub y0: usize,
    pub x1: usize,
    pub y1: usize,
}

impl Rect {
    pub fn whole(frame: &Frame) -> Self {
        Rect { x0: 0, y0: 0, x1: frame.width(), y1: frame.height() }
    }

    pub fn width(&self) -> usize {
        self.x1 - self.x0
    }

    pub fn height(&self) -> usize {
        self.y1 - self.y0
    }

    /// The least rectangle that holds both.
    pub fn union(self, other: Rect) -> Self {
        Rect {
            x0: self.x0.min(other.x0),
            y0: self.y0.min(other.y0),
            x1: self.x1.max(other.x1),
            y1: self.y1.max(other.y1),
        }
    }

    /// The pixels of `frame` in the rectangle, row by row, as bytes.
    pub fn cut(&self, frame: &Frame) -> Vec<u8> {
        let rows = (self.y0..self.y1).map(|y| &frame.row(y)[self.x0..self.x1]);
        rows.flat_map(|row| row.as_flattened()).copied().collect()
    }
}

/// The smallest rectangle around the pixels that `differ` from `a` to `b`, frames of one size; `None` if no pixel does.
pub fn around(a: &Frame, b: &Frame, differ: impl Fn([u8; 4], [u8; 4]) -> bool) -> Option<Rect> {
    let mut found: Option<Rect> = None;
    for y in 0..b.height() {
        let mut pairs = a.row(y).iter().zip(b.row(y)).map(|(&a, &b)| differ(a, b));
        let Some(x0) = pairs.position(|d| d) else { continue };
        let after = a.row(y).iter().zip(b.row(y)).rposition(|(&a, &b)| differ(a, b)).unwrap_or(x0);
        let row = Rect { x0, y0: y, x1: after + 1, y1: y + 1 };
        found = Some(found.map_or(row, |r| r.union(row)));
    }
    found
}

/// The least rectangle that turns `a` into `b`. If nothing changed, a single pixel, because every frame must have one.
pub fn moved(a: &Frame, b: &Frame) -> Rect {
    around(a, b, |a, b| a != b).unwrap_or(Rect { x0: 0, y0: 0, x1: 1, y1: 1 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_moving_rectangle() {
        let a = Frame::filled(5, 4, [0; 4]);
        let mut b = a.clone();
        assert_eq!(moved(&a, &b), Rect { x0: 0, y0: 0, x1: 1, y1: 1 });
        b.cells_mut()[5 + 3] = [1; 4];
        b.cells_mut()[10 + 2] = [1; 4];
        let rect = moved(&a, &b);
        assert_eq!(rect, Rect { x0: 2, y0: 1, x1: 4, y1: 3 });
        assert_eq!(rect.cut(&b), [[0, 0, 0, 0], [1; 4], [1; 4], [0; 4]].as_flattened());
    }
}
