//! Draws marks into the pixels of a picture: lines and dashes, dots, arrowheads, hatched fold regions. Lines are not
//! antialiased; at the size of a terminal that is good enough.

use kurbo::{Point, Vec2};

use super::viewport::clipped;
use crate::base::geometry::Polygon;
use crate::base::maths;
use crate::base::pixels::Frame;
use crate::layers::parts::marks::{Dot, Mark, SELECTED_GROWTH, Shape};
use crate::render::part::Part;

/// Length of an arrow's head, in dots.
const HEAD: f64 = 5.0;
/// Distance of the lines that hatch a fold region, in dots.
const HATCH: usize = 6;
/// Where the cursor's arms begin and end, in dots from its center: the pixel itself stays free.
const ARM: (f64, f64) = (3.0, 9.0);
/// Dots are this much smaller than in the window, because a pane of the terminal is small.
const DOTS: f64 = 0.75;
const DARK: [u8; 4] = [0, 0, 0, 255];
const LIGHT: [u8; 4] = [255, 255, 255, 255];

/// Draws into a frame.
pub struct Ink<'a> {
    /// The frame.
    pub frame: &'a mut Frame,
    /// The part of the picture that it shows.
    pub part: &'a Part,
    /// How many times the picture is reduced, and its marks with it.
    pub by: usize,
}

impl Ink<'_> {
    /// Draws all marks, the selected ones on top.
    pub fn draw(&mut self, marks: &[Mark]) {
        for selected in [false, true] {
            marks.iter().filter(|mark| mark.selected == selected).for_each(|mark| self.mark(mark));
        }
    }

    fn mark(&mut self, mark: &Mark) {
        let look = mark.look;
        let dash = look.dash_px.map(|(on, off)| (self.less(on.into()).max(1.0), self.less(off.into()).max(1.0)));
        let color = mark.color();
        let pen = Pen { color, wide: mark.selected && self.by == 1, dash };
        match &mark.shape {
            Shape::Line { points, closed } => {
                let from = points.iter().chain(points.first().filter(|_| *closed));
                from.clone().zip(from.skip(1)).for_each(|(&from, &to)| self.line(&pen, self.at(from), self.at(to)));
            }
            Shape::Arrow(from, to) => self.arrow(&pen, self.at(*from), self.at(*to)),
            Shape::Dot(at) => self.dot(&pen, self.at(*at), look.dot, f64::from(look.dot_px), mark.selected),
            Shape::Fill(points) => self.hatch(&pen, points),
            Shape::Cell(at, side) => self.cell(*at, *side, color),
            Shape::Label(..) => {}
        }
    }

    /// Draws a square of the picture.
    fn cell(&mut self, at: Point, side: f64, color: [u8; 4]) {
        let half = Vec2::new(side / 2.0, side / 2.0);
        let [from, to] = [at - half, at + half].map(|corner| self.at(corner).round());
        let [columns, rows] = [(from.x, to.x, self.frame.width()), (from.y, to.y, self.frame.height())]
            .map(|(from, to, most)| from.max(0.0) as usize..(to.max(0.0) as usize).min(most));
        for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
            blend(self.frame, Point::new(x as f64, y as f64), color);
        }
    }

    /// Draws the jump vector that is being set.
    pub fn aim(&mut self, from: Point, to: Point) {
        let pen = Pen { color: LIGHT, wide: self.by == 1, dash: None };
        self.arrow(&pen, self.at(from), self.at(to));
    }

    /// Draws the cursor: four arms around its place, light with a dark edge, so that they show on any picture.
    pub fn cross(&mut self, at: Point) {
        let at = self.at(at);
        let (near, far) = (self.less(ARM.0).max(1.0), self.less(ARM.1).max(3.0));
        for (color, wide) in [(DARK, true), (LIGHT, false)] {
            let pen = Pen { color, wide, dash: None };
            for way in [Vec2::new(1.0, 0.0), Vec2::new(-1.0, 0.0), Vec2::new(0.0, 1.0), Vec2::new(0.0, -1.0)] {
                self.line(&pen, at + way * near, at + way * far);
            }
        }
    }

    fn at(&self, place: Point) -> Point {
        self.part.dot_of(place)
    }

    fn less(&self, dots: f64) -> f64 {
        dots / self.by as f64
    }

    fn line(&mut self, pen: &Pen, from: Point, to: Point) {
        let Some((a, b)) = clipped(from, to, (self.frame.width(), self.frame.height())) else { return };
        let steps = (b.x - a.x).abs().max((b.y - a.y).abs()).ceil().max(1.0);
        let (begun, length) = ((a - from).hypot2().sqrt(), (b - a).hypot2().sqrt());
        for i in 0..=steps as usize {
            let share = i as f64 / steps;
            if pen.dash.is_none_or(|(on, off)| (begun + length * share) % (on + off) < on) {
                let at = a.lerp(b, share);
                blend(self.frame, at, pen.color);
                if pen.wide {
                    blend(self.frame, at + Vec2::new(1.0, 0.0), pen.color);
                    blend(self.frame, at + Vec2::new(0.0, 1.0), pen.color);
                }
            }
        }
    }

    fn arrow(&mut self, pen: &Pen, from: Point, to: Point) {
        self.line(pen, from, to);
        let length = (to - from).hypot2().sqrt();
        if length > 1.0 {
            let back = (from - to) * (self.less(HEAD).max(2.0).min(length) / length);
            for turn in [0.45, -0.45] {
                let (sin, cos) = (maths::sin(turn), maths::cos(turn));
                self.line(pen, to, to + Vec2::new(back.x * cos - back.y * sin, back.x * sin + back.y * cos));
            }
        }
    }

    /// Draws a dot with a dark rim; a small one has no rim.
    fn dot(&mut self, pen: &Pen, at: Point, shape: Dot, radius: f64, selected: bool) {
        let growth = if selected { f64::from(SELECTED_GROWTH) } else { 1.0 };
        let radius = self.less(radius * growth * DOTS);
        let rim = if radius >= 1.5 { 1.0 } else { 0.0 };
        let reach = (radius + rim).ceil() as i32;
        for (x, y) in (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| (f64::from(x), f64::from(y)))) {
            let far = match shape {
                Dot::Disc => (x * x + y * y).sqrt(),
                Dot::Square => x.abs().max(y.abs()),
                Dot::Diamond => x.abs() + y.abs(),
            };
            if far <= radius + rim {
                blend(self.frame, at + Vec2::new(x, y), if far <= radius { pen.color } else { DARK });
            }
        }
    }

    /// Hatches the inside of a region.
    fn hatch(&mut self, pen: &Pen, points: &[Point]) {
        let dots = Polygon::new(points.iter().map(|&at| self.at(at)).collect());
        let every = (HATCH / self.by).max(3);
        let mut crossings = Vec::new();
        for y in 0..self.frame.height() {
            crossings.clear();
            dots.row_crossings(y as f64 + 0.5, &mut crossings);
            for pair in crossings.chunks_exact(2) {
                let end = pair[1].min(self.frame.width() as f64);
                let inside = pair[0].max(0.0).ceil() as usize..end.max(0.0) as usize;
                inside.filter(|x| (x + y).is_multiple_of(every)).for_each(|x| {
                    blend(self.frame, Point::new(x as f64, y as f64), pen.color);
                });
            }
        }
    }
}

struct Pen {
    color: [u8; 4],
    wide: bool,
    dash: Option<(f64, f64)>,
}

/// Blends a color over the dot at `at`, also beyond the picture.
fn blend(frame: &mut Frame, at: Point, [r, g, b, a]: [u8; 4]) {
    let (width, height) = (frame.width(), frame.height());
    if at.x >= 0.0 && at.y >= 0.0 && at.x < width as f64 && at.y < height as f64 {
        let cell = &mut frame.cells_mut()[at.y as usize * width + at.x as usize];
        let under = if cell[3] == 0 { [r, g, b, 255] } else { *cell };
        let laid = |over: u8, under: u8| {
            ((u32::from(over) * u32::from(a) + u32::from(under) * (255 - u32::from(a))) / 255) as u8
        };
        *cell = [laid(r, under[0]), laid(g, under[1]), laid(b, under[2]), 255];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::parts::marks::Look;

    static SOLID: Look = Look::new("solid", 0, [200, 200, 200, 255], 1.5).dots(Dot::Disc, 3.5);
    static DASHED: Look = Look::new("dashed", 0, [200, 200, 200, 255], 1.5).dashed(6.0, 4.0);

    fn text(frame: &Frame) -> Vec<String> {
        let glyph = |cell: &[u8; 4]| if *cell == [0, 0, 0, 255] { '.' } else { '#' };
        frame.cells().chunks(frame.width()).map(|row| row.iter().map(glyph).collect()).collect()
    }

    fn drawn(shape: Shape, look: &'static Look, selected: bool) -> Vec<String> {
        let mut frame = Frame::filled(12, 6, DARK);
        let part = Part { corner: Point::new(10.0, 10.0), scale: 2.0, dots: (12, 6) };
        Ink { frame: &mut frame, part: &part, by: 1 }.draw(&[Mark { selected, ..Mark::new(look, "", shape) }]);
        text(&frame)
    }

    #[test]
    fn marks_stand_where_they_are_in_the_picture() {
        let rectangle = [(14.0, 12.0), (28.0, 12.0), (28.0, 18.0), (14.0, 18.0)].map(Point::from).to_vec();
        let outline = Shape::Line { points: rectangle.clone(), closed: true };
        let found = drawn(outline, &SOLID, false);
        assert_eq!(
            found,
            ["............", "..########..", "..#......#..", "..#......#..", "..########..", "............"]
        );
        let cell = Shape::Cell(Point::new(20.0, 15.0), 4.0);
        assert_eq!(drawn(cell, &SOLID, false)[1..4], ["............", "....##......", "....##......"]);
        let far = Shape::Line { points: vec![Point::new(-1e9, 15.0), Point::new(1e9, 15.0)], closed: false };
        assert_eq!(drawn(far, &SOLID, false)[2], "############");
        assert_eq!(drawn(Shape::Fill(rectangle), &DASHED, false)[1..4].concat().matches('#').count(), 3);
    }

    #[test]
    fn marks_shrink_with_the_picture() {
        let mut frame = Frame::filled(12, 6, DARK);
        let part = Part { corner: Point::ZERO, scale: 8.0, dots: (12, 6) };
        let mut ink = Ink { frame: &mut frame, part: &part, by: 4 };
        ink.draw(&[Mark::new(&SOLID, "", Shape::Dot(Point::new(20.0, 20.0)))]);
        assert_eq!(text(&frame).concat().matches('#').count(), 1);
    }

    #[test]
    fn what_is_selected_is_wider_and_dashes_tell_kinds_apart() {
        let line = || Shape::Line { points: vec![Point::new(10.0, 14.0), Point::new(34.0, 14.0)], closed: false };
        let count = |rows: Vec<String>| rows.concat().matches('#').count();
        assert_eq!((count(drawn(line(), &SOLID, false)), count(drawn(line(), &SOLID, true))), (12, 24));
        assert_eq!(drawn(line(), &DASHED, false)[2], "######....##");
    }
}
