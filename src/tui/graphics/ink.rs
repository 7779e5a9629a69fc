//! Marks drawn into the pixels of a picture: lines with their dashes, dots of their shapes, heads of arrows, fold regions
//! as hatching. A line is a walk of dots; that is enough at the size of a terminal.

use kurbo::{Point, Vec2};

use crate::base::geometry::Polygon;
use crate::base::maths;
use crate::base::pixels::Frame;
use crate::render::overlay::{self, Dot, Mark, Shape};
use crate::render::part::Part;
use crate::tui::sight::clipped;

/// Length of an arrow's head, in dots.
const HEAD: f64 = 5.0;
/// A fold region is hatched with a line every so many dots.
const HATCH: usize = 6;
/// The cursor's arms, in dots from its middle: they leave the pixel itself free.
const ARM: (f64, f64) = (3.0, 9.0);
const DARK: [u8; 4] = [0, 0, 0, 255];
const LIGHT: [u8; 4] = [255, 255, 255, 255];

/// Draws all marks, the selected ones on top.
pub fn draw(frame: &mut Frame, part: &Part, marks: &[Mark]) {
    for selected in [false, true] {
        marks.iter().filter(|mark| mark.selected == selected).for_each(|mark| draw_mark(frame, part, mark));
    }
}

fn draw_mark(frame: &mut Frame, part: &Part, mark: &Mark) {
    let style = mark.kind.style();
    let pen = Pen {
        colour: if mark.selected { overlay::SELECTED } else { style.color },
        wide: mark.selected,
        dash: style.dash_px.map(|(on, off)| (f64::from(on), f64::from(off))),
    };
    match &mark.shape {
        Shape::Line { points, closed } => {
            let from = points.iter().chain(points.first().filter(|_| *closed));
            from.clone().zip(from.skip(1)).for_each(|(&from, &to)| pen.line(frame, part.dot_of(from), part.dot_of(to)));
        }
        Shape::Arrow(from, to) => pen.arrow(frame, part.dot_of(*from), part.dot_of(*to)),
        Shape::Dot(at) => dot(frame, part.dot_of(*at), style.dot, f64::from(style.dot_px), &pen),
        Shape::Fill(points) => hatch(frame, part, points, &pen),
        Shape::Label(..) | Shape::Cell(..) => {}
    }
}

/// The jump vector that is being set.
pub fn aim(frame: &mut Frame, part: &Part, from: Point, to: Point) {
    Pen { colour: LIGHT, wide: true, dash: None }.arrow(frame, part.dot_of(from), part.dot_of(to));
}

/// The cursor: four arms around its place, light within dark, so that they show on anything.
pub fn cross(frame: &mut Frame, part: &Part, at: Point) {
    let at = part.dot_of(at);
    for (colour, wide) in [(DARK, true), (LIGHT, false)] {
        let pen = Pen { colour, wide, dash: None };
        for way in [Vec2::new(1.0, 0.0), Vec2::new(-1.0, 0.0), Vec2::new(0.0, 1.0), Vec2::new(0.0, -1.0)] {
            pen.line(frame, at + way * ARM.0, at + way * ARM.1);
        }
    }
}

struct Pen {
    colour: [u8; 4],
    wide: bool,
    dash: Option<(f64, f64)>,
}

impl Pen {
    fn line(&self, frame: &mut Frame, from: Point, to: Point) {
        let Some((a, b)) = clipped(from, to, (frame.width(), frame.height())) else { return };
        let steps = (b.x - a.x).abs().max((b.y - a.y).abs()).ceil().max(1.0);
        let (begun, length) = ((a - from).hypot2().sqrt(), (b - a).hypot2().sqrt());
        for i in 0..=steps as usize {
            let share = i as f64 / steps;
            let drawn = self.dash.is_none_or(|(on, off)| (begun + length * share) % (on + off) < on);
            if drawn {
                self.plot(frame, a.lerp(b, share));
            }
        }
    }

    fn arrow(&self, frame: &mut Frame, from: Point, to: Point) {
        self.line(frame, from, to);
        let length = (to - from).hypot2().sqrt();
        if length > 1.0 {
            let back = (from - to) * (HEAD.min(length) / length);
            for turn in [0.45, -0.45] {
                let (sin, cos) = (maths::sin(turn), maths::cos(turn));
                self.line(frame, to, to + Vec2::new(back.x * cos - back.y * sin, back.x * sin + back.y * cos));
            }
        }
    }

    fn plot(&self, frame: &mut Frame, at: Point) {
        blend(frame, at, self.colour);
        if self.wide {
            blend(frame, at + Vec2::new(1.0, 0.0), self.colour);
            blend(frame, at + Vec2::new(0.0, 1.0), self.colour);
        }
    }
}

fn dot(frame: &mut Frame, at: Point, shape: Dot, radius: f64, pen: &Pen) {
    let radius = if pen.wide { radius * f64::from(overlay::SELECTED_GROWTH) } else { radius };
    let reach = radius.ceil() as i32;
    for (x, y) in (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| (f64::from(x), f64::from(y)))) {
        let far = match shape {
            Dot::Disc => (x * x + y * y).sqrt(),
            Dot::Square => x.abs().max(y.abs()),
            Dot::Diamond => x.abs() + y.abs(),
        };
        if far <= radius + 1.0 {
            blend(frame, at + Vec2::new(x, y), if far <= radius { pen.colour } else { DARK });
        }
    }
}

/// Slanted lines over the inside of a region.
fn hatch(frame: &mut Frame, part: &Part, points: &[Point], pen: &Pen) {
    let dots = Polygon::new(points.iter().map(|&at| part.dot_of(at)).collect());
    let mut crossings = Vec::new();
    for y in 0..frame.height() {
        crossings.clear();
        dots.row_crossings(y as f64 + 0.5, &mut crossings);
        for pair in crossings.chunks_exact(2) {
            let end = pair[1].min(frame.width() as f64);
            let inside = pair[0].max(0.0).ceil() as usize..end.max(0.0) as usize;
            inside.filter(|x| (x + y).is_multiple_of(HATCH)).for_each(|x| {
                blend(frame, Point::new(x as f64, y as f64), pen.colour);
            });
        }
    }
}

/// Lays a colour over the dot that holds `at`; what lies beyond the picture takes it too.
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
    use crate::render::overlay::Kind;

    fn text(frame: &Frame) -> Vec<String> {
        let glyph = |cell: &[u8; 4]| if *cell == [0, 0, 0, 255] { '.' } else { '#' };
        frame.cells().chunks(frame.width()).map(|row| row.iter().map(glyph).collect()).collect()
    }

    fn drawn(shape: Shape, kind: Kind, selected: bool) -> Vec<String> {
        let mut frame = Frame::filled(12, 6, DARK);
        let part = Part { corner: Point::new(10.0, 10.0), scale: 2.0, dots: (12, 6) };
        draw(&mut frame, &part, &[Mark { kind, shape, selected, strength: 1.0 }]);
        text(&frame)
    }

    #[test]
    fn marks_stand_where_they_are_in_the_picture() {
        let rectangle = [(14.0, 12.0), (28.0, 12.0), (28.0, 18.0), (14.0, 18.0)].map(Point::from).to_vec();
        let outline = Shape::Line { points: rectangle.clone(), closed: true };
        let found = drawn(outline, Kind::ZoneOutline, false);
        assert_eq!(
            found,
            ["............", "..########..", "..#......#..", "..#......#..", "..########..", "............"]
        );
        let far = Shape::Line { points: vec![Point::new(-1e9, 15.0), Point::new(1e9, 15.0)], closed: false };
        assert_eq!(drawn(far, Kind::Curve, false)[2], "############");
        assert_eq!(drawn(Shape::Fill(rectangle), Kind::FoldRegion, false)[1..4].concat().matches('#').count(), 3);
    }

    #[test]
    fn what_is_selected_is_wider_and_dashes_tell_kinds_apart() {
        let line = || Shape::Line { points: vec![Point::new(10.0, 14.0), Point::new(34.0, 14.0)], closed: false };
        let count = |rows: Vec<String>| rows.concat().matches('#').count();
        assert_eq!((count(drawn(line(), Kind::Curve, false)), count(drawn(line(), Kind::Curve, true))), (12, 24));
        assert_eq!(drawn(line(), Kind::FoldRegion, false)[2], "######....##");
    }
}
