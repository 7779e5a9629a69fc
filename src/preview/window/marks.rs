//! Marks of the overlays as strokes on the screen: the only place that knows how a look becomes lines and dots.

use kurbo::{Point, Rect, Size, Vec2};

use super::canvas::Canvas;
use super::stroke::Color;
use super::viewport::Viewport;
use crate::base::geometry::Polygon;
use crate::layers::parts::marks::{Dot, FILL_ALPHA, Look, Mark, SELECTED_GROWTH, Shape};

/// Distance of the lines that fill a region, in logical pixels.
const HATCH_PX: f64 = 7.0;
const HEAD_PX: f64 = 7.0;
/// The pixel grid shows from this zoom on.
const GRID_ZOOM: f64 = 8.0;
const GRID: Color = [255, 255, 255, 28];

/// Draws marks; their labels are drawn apart, over all of them.
pub fn draw(marks: &[Mark], viewport: &Viewport, area: Size, scale: f64) -> Canvas {
    let mut canvas = Canvas::default();
    let painter = Painter { viewport, area, scale };
    marks.iter().for_each(|mark| painter.mark(&mut canvas, mark));
    canvas
}

/// Draws the borders of the picture's pixels, where they are large enough.
pub fn grid(canvas: &mut Canvas, picture: Size, viewport: &Viewport, area: Size) {
    if viewport.zoom < GRID_ZOOM {
        return;
    }
    let seen = Rect::from_points(
        viewport.image_from_screen(Point::ZERO, area),
        viewport.image_from_screen((area.width, area.height).into(), area),
    );
    let seen = seen.intersect(picture.to_rect()).expand();
    let screen = |x: f64, y: f64| viewport.screen_from_image(Point::new(x, y), area);
    for x in seen.x0 as i64..=seen.x1 as i64 {
        canvas.line(screen(x as f64, seen.y0), screen(x as f64, seen.y1), 1.0, GRID);
    }
    for y in seen.y0 as i64..=seen.y1 as i64 {
        canvas.line(screen(seen.x0, y as f64), screen(seen.x1, y as f64), 1.0, GRID);
    }
}

struct Painter<'a> {
    viewport: &'a Viewport,
    area: Size,
    scale: f64,
}

impl Painter<'_> {
    fn screen(&self, at: Point) -> Point {
        self.viewport.screen_from_image(at, self.area)
    }

    fn seen(&self, points: &[Point]) -> bool {
        let mut bounds = Rect::new(f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY);
        points.iter().for_each(|&p| bounds = bounds.union_pt(p));
        bounds.inflate(40.0, 40.0).overlaps(self.area.to_rect())
    }

    fn mark(&self, canvas: &mut Canvas, mark: &Mark) {
        let look = mark.look;
        let grown = if mark.selected { f64::from(SELECTED_GROWTH) } else { 1.0 } * self.scale;
        let color = mark.color();
        let width = f64::from(look.width_px) * grown;
        match &mark.shape {
            Shape::Line { points, closed } => {
                let points: Vec<_> = points.iter().map(|&p| self.screen(p)).collect();
                let dash = look.dash_px.map(|(a, b)| (f64::from(a) * self.scale, f64::from(b) * self.scale));
                if self.seen(&points) {
                    canvas.with_halo(|c| c.polyline(&points, *closed, width, dash, color));
                }
            }
            Shape::Fill(points) => self.hatch(canvas, points, color),
            Shape::Dot(at) => self.dot(canvas, self.screen(*at), look, grown, color),
            Shape::Arrow(from, to) => {
                let (from, to) = (self.screen(*from), self.screen(*to));
                if self.seen(&[from, to]) {
                    canvas.with_halo(|c| c.arrow(from, to, width, HEAD_PX * grown, color));
                }
            }
            Shape::Cell(at, side) => {
                // On whole pixels, so that neighbors meet without a seam.
                let [a, b] = [-0.5, 0.5].map(|half| self.screen(*at + Vec2::new(side * half, side * half)).round());
                if self.seen(&[a, b]) {
                    canvas.rect(Rect::from_points(a, b), 0.0, color);
                }
            }
            Shape::Label(..) => {}
        }
    }

    fn dot(&self, canvas: &mut Canvas, at: Point, look: &Look, grown: f64, color: Color) {
        let r = f64::from(look.dot_px) * grown;
        if self.seen(&[at]) {
            canvas.with_halo(|c| match look.dot {
                Dot::Disc => c.disc(at, r, color),
                Dot::Square => c.rect(Rect::from_center_size(at, (2.0 * r, 2.0 * r)), 0.0, color),
                Dot::Diamond => c.diamond(at, r, color),
            });
        }
    }

    /// Thin slanted lines over the inside of a polygon, and a light tint by their nearness.
    fn hatch(&self, canvas: &mut Canvas, points: &[Point], [r, g, b, _]: Color) {
        let polygon = Polygon::new(points.iter().map(|&p| self.screen(p)).collect());
        let (bounds, step) = (polygon.bounds(), HATCH_PX * self.scale);
        let color = [r, g, b, (FILL_ALPHA * 4.0 * 255.0) as u8];
        let slant = Vec2::new(1.0, -1.0);
        let first = ((bounds.x0 + bounds.y0) / step).ceil() as i64;
        let last = ((bounds.x1 + bounds.y1) / step).floor() as i64;
        for k in first..=last {
            let from = Point::new(k as f64 * step, 0.0);
            let mut cuts = polygon.line_crossings(from, slant);
            cuts.sort_unstable_by(f64::total_cmp);
            for pair in cuts.chunks_exact(2) {
                let ends = [from + slant * pair[0], from + slant * pair[1]];
                if self.seen(&ends) {
                    canvas.line(ends[0], ends[1], self.scale, color);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::viewport::Fit;
    use super::*;
    use crate::layers::space::marks::{AXES, FRUSTUM, GRID as GROUND};

    static LOOK: Look = Look::new("dashed", 0, [240, 160, 40, 255], 1.6).dashed(6.0, 4.0).dots(Dot::Square, 3.0);
    const AREA: Size = Size::new(200.0, 100.0);

    fn viewport() -> Viewport {
        let mut viewport = Viewport::default();
        viewport.fit(AREA, AREA, Fit::Window);
        viewport
    }

    fn mark(shape: Shape, selected: bool) -> Mark {
        Mark { selected, ..Mark::new(&LOOK, "", shape) }
    }

    fn strokes(shape: Shape, selected: bool) -> usize {
        draw(&[mark(shape, selected)], &viewport(), AREA, 1.0).strokes.len()
    }

    #[test]
    fn what_is_out_of_sight_is_not_drawn() {
        assert!(strokes(Shape::Dot(Point::new(50.0, 50.0)), false) > 0);
        assert_eq!(strokes(Shape::Dot(Point::new(500.0, 50.0)), false), 0);
        assert_eq!(strokes(Shape::Arrow(Point::new(-90.0, 0.0), Point::new(-50.0, 0.0)), false), 0);
    }

    #[test]
    fn what_fades_is_less_opaque_and_cells_stand_on_whole_pixels() {
        let faint = Mark { strength: 0.5, ..mark(Shape::Dot(Point::new(50.0, 50.0)), false) };
        let canvas = draw(&[faint], &viewport(), AREA, 1.0);
        assert_eq!(canvas.strokes.last().unwrap().color[3], 128);
        let cell = mark(Shape::Cell(Point::new(50.3, 50.0), 4.5), false);
        let canvas = draw(&[cell], &viewport(), AREA, 1.0);
        assert_eq!((canvas.strokes[0].a, canvas.strokes[0].b), ([48.0, 48.0], [53.0, 52.0]));
    }

    #[test]
    fn lines_in_space_stand_out_on_light_and_dark() {
        let line = || Shape::Line { points: vec![Point::new(20.0, 20.0), Point::new(60.0, 20.0)], closed: false };
        for look in AXES.iter().chain([&GROUND, &FRUSTUM]) {
            let canvas = draw(&[Mark::new(look, "", line())], &viewport(), AREA, 1.0);
            let [rim, inner] = [canvas.strokes.first(), canvas.strokes.last()].map(|stroke| stroke.unwrap().color);
            for ground in [0.0, 56.0, 74.0, 128.0, 255.0] {
                let over = |color: Color, under: f64| {
                    let far = |c: usize| (f64::from(color[c]) - under) * f64::from(color[3]) / 255.0;
                    [0, 1, 2].map(far).into_iter().max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap()
                };
                let edge = over(rim, ground);
                let seen = edge.abs().max(over(inner, ground + edge).abs());
                assert!(seen > 60.0, "{} on {ground}: {seen}", look.name);
            }
        }
    }

    #[test]
    fn hatches_stay_inside() {
        let polygon = vec![(20.0, 20.0).into(), (60.0, 20.0).into(), (60.0, 60.0).into(), (20.0, 60.0).into()];
        let canvas = draw(&[mark(Shape::Fill(polygon), false)], &viewport(), AREA, 1.0);
        assert!(canvas.strokes.len() > 5);
        let inside = |p: [f32; 2]| p.iter().all(|c| (19.9..=60.1).contains(c));
        assert!(canvas.strokes.iter().all(|s| inside(s.a) && inside(s.b)));
    }

    #[test]
    fn the_grid_waits_until_pixels_are_large() {
        let mut canvas = Canvas::default();
        grid(&mut canvas, Size::new(4.0, 4.0), &viewport(), AREA);
        assert!(canvas.strokes.is_empty());
        let mut near = Viewport::default();
        near.fit(Size::new(4.0, 4.0), AREA, Fit::Window);
        grid(&mut canvas, Size::new(4.0, 4.0), &near, AREA);
        assert_eq!(canvas.strokes.len(), 10);
    }
}
