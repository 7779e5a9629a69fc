//! Names and numbers beside what they name, above all other marks: on the side away from a jump vector, off anchors and the
//! arrows of their jumps, and not on one another. Many labels keep farther apart.

use std::collections::HashMap;
use std::rc::Rc;

use kurbo::{Point, Rect, Size, Vec2};

use super::canvas::Canvas;
use super::stroke::Color;
use super::text::{Letters, Text};
use super::viewport::Viewport;
use crate::layers::parts::marks::{Mark, Shape};

const LABEL_PX: f64 = 8.0;
/// From what is named to its label, and from a label's text to its rim, in logical pixels.
const AWAY_PX: f64 = 7.0;
const RIM_PX: f64 = 4.0;
/// What lies under a label, so that it can be read on anything.
const GROUND: Color = [16, 18, 22, 205];
/// Side of a cell of what is taken, in logical pixels.
const CELL_PX: f64 = 4.0;
/// Labels that would take more than this share of the window keep [`APART`] times their height apart.
const CROWD: f64 = 0.2;
const APART: f64 = 2.0;

/// The sides on which a label may stand, in the order in which they are tried if there is no vector.
const SIDES: [(f64, f64); 8] =
    [(1.0, -1.0), (1.0, 0.0), (1.0, 1.0), (0.0, -1.0), (0.0, 1.0), (-1.0, -1.0), (-1.0, 0.0), (-1.0, 1.0)];

/// Draws the labels among marks, those of what is selected first. One that finds no room waits until there is some.
pub fn draw(marks: &[Mark], viewport: &Viewport, area: Size, scale: f64, letters: &Letters) -> Canvas {
    let mut canvas = Canvas::default();
    let screen = |at: Point| viewport.screen_from_image(at, area);
    let labels = found(marks, &screen, area, scale, letters);
    if labels.is_empty() {
        return canvas;
    }
    let mut taken = Taken::new(area, CELL_PX * scale);
    let vectors = obstacles(marks, &screen, &mut taken, scale);
    let covered: f64 = labels.iter().map(|label| label.size.area()).sum();
    let apart = if covered > CROWD * area.area() { APART * LABEL_PX * scale } else { 0.0 };
    for label in &labels {
        let way = vectors.get(&key(label.at)).copied().unwrap_or(Vec2::ZERO);
        let Some(place) = label.place(way, &taken, area, scale) else { continue };
        taken.set(Rect::inflate(&place, apart, apart), LABEL);
        canvas.rect(place, 3.0 * scale, GROUND);
        canvas.text(&label.text, place.origin() + Vec2::new(RIM_PX, RIM_PX) * scale, label.color);
    }
    canvas
}

struct Label {
    /// What is named, on the screen.
    at: Point,
    text: Rc<Text>,
    color: Color,
    size: Size,
}

fn found(marks: &[Mark], screen: &impl Fn(Point) -> Point, area: Size, scale: f64, letters: &Letters) -> Vec<Label> {
    let selected = marks.iter().filter(|mark| mark.selected);
    let all = selected.chain(marks.iter().filter(|mark| !mark.selected));
    let in_sight = area.to_rect();
    let label = |mark: &Mark| {
        let Shape::Label(at, text) = &mark.shape else { return None };
        let at = Some(screen(*at)).filter(|at| in_sight.contains(*at))?;
        let text = letters.line(text, LABEL_PX * scale);
        let size = Size::new(text.width, LABEL_PX * scale) + Size::new(2.0 * RIM_PX, 2.0 * RIM_PX) * scale;
        Some(Label { at, text, color: mark.color(), size })
    };
    all.filter_map(label).collect()
}

impl Label {
    /// The place that hides least, away from its vector; `None` if every place would overlap another label.
    fn place(&self, way: Vec2, taken: &Taken, area: Size, scale: f64) -> Option<Rect> {
        let mut sides = SIDES.map(Vec2::from);
        sides.sort_by(|a, b| way.dot(*a).total_cmp(&way.dot(*b)));
        let places = sides.map(|side| {
            let half = self.size.to_vec2() / 2.0;
            let away = half + Vec2::new(AWAY_PX, AWAY_PX) * scale;
            let middle = self.at + Vec2::new(side.x * away.x, side.y * away.y);
            // As it is, or as far inside the window as it takes to be read whole.
            let inside = |at: f64, half: f64, room: f64| at.clamp(half, (room - half).max(half));
            let middle = Point::new(inside(middle.x, half.x, area.width), inside(middle.y, half.y, area.height));
            Rect::from_points(middle - half, middle + half)
        });
        let free = places.iter().filter(|place| taken.count(**place, LABEL) == 0);
        free.min_by_key(|place| taken.count(**place, MARK)).copied()
    }
}

/// Takes the room of anchors and of the arrows of their jumps; returns the arrows by where they begin on the screen.
fn obstacles(
    marks: &[Mark],
    screen: &impl Fn(Point) -> Point,
    taken: &mut Taken,
    scale: f64,
) -> HashMap<(i64, i64), Vec2> {
    let mut vectors = HashMap::new();
    for mark in marks {
        match &mark.shape {
            Shape::Arrow(from, to) if mark.look.keeps_labels_off => {
                let (from, to) = (screen(*from), screen(*to));
                taken.line(from, to);
                taken.set(Rect::from_center_size(to, (8.0 * scale, 8.0 * scale)), MARK);
                vectors.insert(key(from), to - from);
            }
            Shape::Dot(at) if mark.look.keeps_labels_off => {
                taken.set(Rect::from_center_size(screen(*at), (7.0 * scale, 7.0 * scale)), MARK);
            }
            Shape::Arrow(..) | Shape::Dot(_) => {}
            Shape::Line { .. } | Shape::Fill(_) | Shape::Cell(..) | Shape::Label(..) => {}
        }
    }
    vectors
}

fn key(at: Point) -> (i64, i64) {
    ((at.x * 4.0).round() as i64, (at.y * 4.0).round() as i64)
}

const MARK: u8 = 1;
const LABEL: u8 = 2;

/// What of the window is taken, in cells.
struct Taken {
    cell: f64,
    width: usize,
    height: usize,
    cells: Vec<u8>,
}

impl Taken {
    fn new(area: Size, cell: f64) -> Taken {
        let [width, height] = [area.width, area.height].map(|side| (side / cell).ceil().max(1.0) as usize);
        Taken { cell, width, height, cells: vec![0; width * height] }
    }

    /// The cells of a rectangle that lie in the window.
    fn cells(&self, rect: Rect) -> impl Iterator<Item = usize> + use<> {
        let range = |from: f64, to: f64, cells: usize, cell: f64| {
            (from / cell).floor().max(0.0) as usize..((to / cell).ceil().max(0.0) as usize).min(cells)
        };
        let (across, width) = (range(rect.x0, rect.x1, self.width, self.cell), self.width);
        range(rect.y0, rect.y1, self.height, self.cell).flat_map(move |y| across.clone().map(move |x| y * width + x))
    }

    fn set(&mut self, rect: Rect, kind: u8) {
        self.cells(rect).for_each(|i| self.cells[i] |= kind);
    }

    fn count(&self, rect: Rect, kind: u8) -> usize {
        self.cells(rect).filter(|&i| self.cells[i] & kind != 0).count()
    }

    /// Marks the cells of a line, as far as it can be in the window.
    fn line(&mut self, from: Point, to: Point) {
        let long = (to - from).hypot().min(8192.0);
        let steps = (long / self.cell).ceil().max(1.0);
        for k in 0..=steps as usize {
            let at = from + (to - from) * (k as f64 / steps);
            self.set(Rect::from_center_size(at, (1.0, 1.0)), MARK);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::stroke::BOX;
    use super::super::viewport::Fit;
    use super::*;
    use crate::layers::parts::marks::Look;

    const AREA: Size = Size::new(400.0, 300.0);
    static ANCHOR: Look = Look::new("anchor", 0, [60, 210, 160, 255], 1.4).off_labels();

    fn marks(anchors: &[((f64, f64), (f64, f64))]) -> Vec<Mark> {
        let mark = |shape| Mark::new(&ANCHOR, "", shape);
        let each = anchors.iter().flat_map(|&(at, jump)| {
            let at = Point::from(at);
            [
                mark(Shape::Arrow(at, at + Vec2::from(jump))),
                mark(Shape::Dot(at)),
                mark(Shape::Label(at, "0: 40, -6".into())),
            ]
        });
        each.collect()
    }

    /// Where the labels stand.
    fn boxes(marks: &[Mark]) -> Vec<Rect> {
        let mut viewport = Viewport::default();
        viewport.fit(AREA, AREA, Fit::Window);
        let canvas = draw(marks, &viewport, AREA, 1.0, &Letters::default());
        let rect = |s: &super::super::stroke::Stroke| {
            let [x0, y0, x1, y1] = [s.a[0], s.a[1], s.b[0], s.b[1]].map(f64::from);
            Rect::new(x0, y0, x1, y1)
        };
        canvas.strokes.iter().filter(|s| s.form == BOX).map(rect).collect()
    }

    fn touches(place: Rect, from: Point, way: Vec2) -> bool {
        (0..=200).any(|k| place.contains(from + way * (f64::from(k) / 200.0)))
    }

    #[test]
    fn a_label_hides_no_arrow() {
        for turn in 0..24 {
            let way = Vec2::from_angle(std::f64::consts::TAU * f64::from(turn) / 24.0) * 60.0;
            for at in [(200.0, 150.0), (20.0, 20.0), (380.0, 280.0)] {
                let places = boxes(&marks(&[(at, (way.x, way.y))]));
                assert_eq!(places.len(), 1);
                assert!(!touches(places[0], at.into(), way), "{way:?} at {at:?}: {places:?}");
                assert!(AREA.to_rect().contains_rect(places[0]), "{places:?}");
            }
        }
        let between = [((200.0, 150.0), (50.0, 0.0)), ((150.0, 150.0), (40.0, 4.0))];
        let places = boxes(&marks(&between));
        assert!(places.len() == 2 && !places[0].overlaps(places[1]), "{places:?}");
        for ((at, way), place) in between.iter().flat_map(|anchor| places.iter().map(move |place| (*anchor, *place))) {
            assert!(!touches(place, at.into(), way.into()), "{place:?}");
        }
    }

    #[test]
    fn labels_do_not_lie_on_one_another_and_a_crowd_is_thinned() {
        let anchors: Vec<_> =
            (0..3000).map(|i| ((f64::from(i % 60) * 6.6, f64::from(i / 60) * 6.0), (1.0, 1.0))).collect();
        let places = boxes(&marks(&anchors));
        assert!(places.len() > 8, "{}", places.len());
        for (i, place) in places.iter().enumerate() {
            assert!(places[i + 1..].iter().all(|other| !other.overlaps(*place)), "{place:?}");
        }
        let covered: f64 = places.iter().map(|place| place.area()).sum();
        assert!(covered < 0.4 * AREA.area(), "{}", covered / AREA.area());
        let mut one = marks(&anchors);
        one[3 * 1234 + 2].selected = true;
        assert!(boxes(&one)[0].center().distance(Point::from(anchors[1234].0)) < 60.0, "what is selected comes first");
    }
}
