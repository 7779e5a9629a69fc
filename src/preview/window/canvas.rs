//! Strokes for the screen: lines, dots, boxes and glyphs as instances that the shader draws, with smooth edges. All in
//! physical pixels; nothing here knows what it draws.

use kurbo::{Point, Rect, Vec2};

use super::stroke::{BOX, Color, DIAMOND, LINE, Stroke};
use super::text::Text;

/// Darkens what lies beneath a mark, so that it can be told from any picture.
const HALO: Color = [0, 0, 0, 120];
const HALO_PX: f32 = 1.0;

/// A list of strokes to be drawn in order.
#[derive(Clone, Debug, Default)]
pub struct Canvas {
    /// The strokes.
    pub strokes: Vec<Stroke>,
}

impl Canvas {
    /// A line with round ends.
    pub fn line(&mut self, a: Point, b: Point, width: f64, color: Color) {
        self.push(a, b, width / 2.0, LINE, color);
    }

    /// A disc.
    pub fn disc(&mut self, at: Point, radius: f64, color: Color) {
        self.push(at, at, radius, LINE, color);
    }

    /// A box with rounded corners.
    pub fn rect(&mut self, rect: Rect, corner: f64, color: Color) {
        self.push(rect.origin(), Point::new(rect.x1, rect.y1), corner, BOX, color);
    }

    /// A square on its corner.
    pub fn diamond(&mut self, at: Point, radius: f64, color: Color) {
        self.push(at, at, radius, DIAMOND, color);
    }

    /// A line through points, dashed where lengths of dash and gap are given.
    pub fn polyline(&mut self, points: &[Point], closed: bool, width: f64, dash: Option<(f64, f64)>, color: Color) {
        let closing = points.last().zip(points.first()).filter(|_| closed);
        let sides = points.windows(2).map(|w| (w[0], w[1])).chain(closing.map(|(&a, &b)| (a, b)));
        match dash {
            None => sides.for_each(|(a, b)| self.line(a, b, width, color)),
            Some((dash, gap)) => {
                let mut along = 0.0;
                for (a, b) in sides {
                    along = self.dashes(a, b, along, dash, gap, width, color);
                }
            }
        }
    }

    /// One side of a dashed line. `along` is the position in the pattern at which it begins; returns the one at which it ends.
    #[expect(clippy::too_many_arguments, reason = "one side of one line, called once")]
    fn dashes(&mut self, a: Point, b: Point, along: f64, dash: f64, gap: f64, width: f64, color: Color) -> f64 {
        let length = (b - a).hypot2().sqrt();
        let at = |x: f64| a + (b - a) * (x / length);
        let mut x = -along;
        while x < length {
            let (from, to) = (x.max(0.0), (x + dash).min(length));
            if from < to {
                self.line(at(from), at(to), width, color);
            }
            x += dash + gap;
        }
        (along + length).rem_euclid(dash + gap)
    }

    /// An arrow with an open head at `b`; a dot if it has no length.
    pub fn arrow(&mut self, a: Point, b: Point, width: f64, head: f64, color: Color) {
        let length = (b - a).hypot2().sqrt();
        if length < 0.5 {
            return self.disc(a, width, color);
        }
        let back = (a - b) / length * head.min(length * 0.5);
        let side = Vec2::new(-back.y, back.x) * 0.55;
        self.line(a, b, width, color);
        self.line(b, b + back + side, width, color);
        self.line(b, b + back - side, width, color);
    }

    /// Text with the top left of its capitals at `at`.
    pub fn text(&mut self, text: &Text, at: Point, color: Color) {
        self.strokes.extend(text.strokes(at, color));
    }

    /// What `draw` draws, on a dark rim.
    pub fn with_halo(&mut self, draw: impl FnOnce(&mut Canvas)) {
        let first = self.strokes.len();
        draw(self);
        let halo: Vec<_> = self.strokes[first..].iter().map(rim).collect();
        self.strokes.splice(first..first, halo);
    }

    fn push(&mut self, a: Point, b: Point, radius: f64, form: u32, color: Color) {
        let xy = |p: Point| [p.x as f32, p.y as f32];
        self.strokes.push(Stroke { a: xy(a), b: xy(b), radius: radius as f32, form, color, texel: [0; 2] });
    }
}

/// The dark rim of a stroke.
fn rim(stroke: &Stroke) -> Stroke {
    let grow = if stroke.form == BOX { HALO_PX } else { 0.0 };
    Stroke {
        a: stroke.a.map(|x| x - grow),
        b: stroke.b.map(|x| x + grow),
        radius: stroke.radius + HALO_PX,
        color: [HALO[0], HALO[1], HALO[2], (u16::from(HALO[3]) * u16::from(stroke.color[3]) / 255) as u8],
        ..*stroke
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHITE: Color = [255; 4];

    #[test]
    fn dashes_go_on_around_corners() {
        let mut canvas = Canvas::default();
        let points = [Point::ZERO, Point::new(5.0, 0.0), Point::new(5.0, 5.0)];
        canvas.polyline(&points, false, 1.0, Some((4.0, 3.0)), WHITE);
        let ends: Vec<_> = canvas.strokes.iter().map(|s| (s.a, s.b)).collect();
        assert_eq!(ends, [([0.0, 0.0], [4.0, 0.0]), ([5.0, 2.0], [5.0, 5.0])]);
    }

    #[test]
    fn a_halo_lies_below_what_it_surrounds() {
        let mut canvas = Canvas::default();
        canvas.disc(Point::ZERO, 1.0, WHITE);
        canvas.with_halo(|c| c.disc(Point::ZERO, 2.0, WHITE));
        let radii: Vec<_> = canvas.strokes.iter().map(|s| (s.radius, s.color == WHITE)).collect();
        assert_eq!(radii, [(1.0, true), (3.0, false), (2.0, true)]);
    }

    #[test]
    fn an_arrow_without_length_is_a_dot() {
        let mut canvas = Canvas::default();
        canvas.arrow(Point::ZERO, Point::ZERO, 1.0, 6.0, WHITE);
        assert_eq!(canvas.strokes.len(), 1);
        canvas.arrow(Point::ZERO, Point::new(9.0, 0.0), 1.0, 6.0, WHITE);
        assert_eq!(canvas.strokes.len(), 4);
    }
}
