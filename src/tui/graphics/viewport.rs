//! Which part of the picture is visible: zoom, center, and panning.

use kurbo::{Point, Vec2};

use crate::base::number::rounded;
use crate::render::part::Part;
use crate::tui::text::numbers;

/// The largest size of a pixel, in dots.
const LARGEST: f64 = 64.0;
/// How far one pan goes, as a share of what is visible.
const PAN: f64 = 0.25;

/// The zoom, and the center of the pane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewport {
    /// Pixels of the picture per dot; `None` to fit all of it.
    pub zoom: Option<f64>,
    /// The center of what is visible, as far as the edges of the picture and the cursor allow.
    pub center: Point,
}

/// The scale at which the whole picture fits on so many dots.
pub fn fit((width, height): (usize, usize), (across, down): (usize, usize)) -> f64 {
    let least = 1.0 / LARGEST;
    (width as f64 / across.max(1) as f64).max(height as f64 / down.max(1) as f64).max(least)
}

/// The visible part: the whole picture, centered, or at the given zoom around the viewport's center. It always contains the
/// cursor.
pub fn part(viewport: &Viewport, cursor: Point, size: (usize, usize), dots: (usize, usize)) -> Part {
    let scale = viewport.zoom.unwrap_or(f64::INFINITY).min(fit(size, dots));
    let axis = |middle: f64, cursor: f64, size: usize, dots: usize| {
        let (size, seen) = (size as f64, dots as f64 * scale);
        if seen >= size {
            return (size - seen) / 2.0;
        }
        let corner = (middle - seen / 2.0).clamp(0.0, size - seen);
        // The edge never cuts a pixel in two.
        let corner = if scale < 1.0 { corner.round() } else { (corner / scale).round() * scale };
        // If less than a pixel is visible, it is the cursor's.
        let least = cursor - seen + 0.5;
        corner.clamp(least, (cursor.max(0.5) - 0.5).max(least)).clamp(0.0, size - seen)
    };
    let corner = Point::new(
        axis(viewport.center.x, cursor.x, size.0, dots.0),
        axis(viewport.center.y, cursor.y, size.1, dots.1),
    );
    Part { corner, scale, dots }
}

/// The next scale when zooming in (or out): a power of two, so that dots and pixels align; `None` to fit the whole picture.
pub fn zoomed(from: f64, fit: f64, inward: bool) -> Option<f64> {
    let mut scale = 1.0 / LARGEST;
    while scale * 2.0 < from || (!inward && scale <= from) {
        scale *= 2.0;
    }
    (scale < fit).then_some(scale)
}

/// Pans by a quarter of what is visible, as far as the picture goes. The cursor moves along if it would become invisible.
pub fn pan(viewport: &mut Viewport, cursor: &mut Point, part: &Part, (width, height): (usize, usize), way: Vec2) {
    let seen = part.extent();
    let half = seen / 2.0;
    let moved = |corner: f64, seen: f64, way: f64, size: usize| {
        let most = size as f64 - seen;
        if most <= 0.0 { corner } else { (corner + (seen * PAN * way).round()).clamp(0.0, most) }
    };
    let (x, y) = (part.corner.x, part.corner.y);
    viewport.center = Point::new(moved(x, seen.x, way.x, width), moved(y, seen.y, way.y, height)) + half;
    let within = |cursor: f64, middle: f64, half: f64| {
        let reach = (half - 0.5).max(0.0);
        let clamped = cursor.clamp(middle - reach, middle + reach);
        if clamped == cursor { cursor } else { clamped.floor() + 0.5 }
    };
    cursor.x = within(cursor.x, viewport.center.x, half.x);
    cursor.y = within(cursor.y, viewport.center.y, half.y);
}

/// The scale in words: dots per pixel, or pixels per dot.
pub fn words(scale: f64) -> String {
    let short = |value: f64| numbers::short(rounded(value, 1));
    if scale < 1.0 { format!("{}:1", short(1.0 / scale)) } else { format!("1:{}", short(scale)) }
}

/// The part of the line from `a` to `b` within so many dots (Liang and Barsky).
pub fn clipped(a: Point, b: Point, (width, height): (usize, usize)) -> Option<(Point, Point)> {
    let d = b - a;
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for (along, least, most) in [(d.x, -a.x, width as f64 - a.x), (d.y, -a.y, height as f64 - a.y)] {
        if along == 0.0 {
            if least > 0.0 || most < 0.0 {
                return None;
            }
            continue;
        }
        let (enter, leave) = (least / along, most / along);
        from = from.max(enter.min(leave));
        to = to.min(enter.max(leave));
    }
    (from <= to).then(|| (a + d * from, a + d * to))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All of the picture, and the cursor on it.
    fn at(x: f64, y: f64) -> (Viewport, Point) {
        (Viewport { zoom: None, center: Point::new(x, y) }, Point::new(x, y))
    }

    #[test]
    fn the_whole_picture_fits_and_the_zoom_keeps_the_cursor_in_sight() {
        let (mut viewport, mut cursor) = at(390.5, 290.5);
        let whole = part(&viewport, cursor, (400, 300), (40, 40));
        assert_eq!((whole.scale, whole.corner), (10.0, Point::new(0.0, -50.0)));
        viewport.zoom = Some(2.0);
        let near = part(&viewport, cursor, (400, 300), (40, 40));
        assert_eq!((near.scale, near.corner), (2.0, Point::new(320.0, 220.0)));
        cursor = Point::new(100.5, 290.5);
        let far = part(&viewport, cursor, (400, 300), (40, 40));
        assert_eq!(far.corner, Point::new(100.0, 220.0), "as little as needed");
    }

    #[test]
    fn zooming_goes_by_powers_of_two() {
        for (from, inward, to) in [
            (10.0, true, Some(8.0)),
            (8.0, true, Some(4.0)),
            (1.0, true, Some(0.5)),
            (0.5, false, Some(1.0)),
            (4.0, false, Some(8.0)),
            (8.0, false, None),
            (1.0 / 64.0, true, Some(1.0 / 64.0)),
        ] {
            assert_eq!(zoomed(from, 10.0, inward), to, "{from} {inward}");
        }
    }

    #[test]
    fn panning_takes_the_cursor_along() {
        let (mut viewport, mut cursor) = at(100.5, 100.5);
        viewport.zoom = Some(1.0);
        let before = part(&viewport, cursor, (400, 300), (40, 40));
        assert_eq!(before.corner, Point::new(81.0, 81.0));
        pan(&mut viewport, &mut cursor, &before, (400, 300), Vec2::new(1.0, 0.0));
        let after = part(&viewport, cursor, (400, 300), (40, 40));
        assert_eq!((after.corner.x, cursor.x), (91.0, 100.5));
        for _ in 0..3 {
            let now = part(&viewport, cursor, (400, 300), (40, 40));
            pan(&mut viewport, &mut cursor, &now, (400, 300), Vec2::new(1.0, 0.0));
        }
        assert_eq!(part(&viewport, cursor, (400, 300), (40, 40)).corner.x, 121.0);
        assert_eq!(cursor, Point::new(121.5, 100.5));
    }

    #[test]
    fn lines_are_clipped_to_the_dots() {
        let p = |x: f64, y: f64| Point::new(x, y);
        assert_eq!(clipped(p(-10.0, 5.0), p(30.0, 5.0), (20, 10)), Some((p(0.0, 5.0), p(20.0, 5.0))));
        assert_eq!(clipped(p(-10.0, 50.0), p(30.0, 50.0), (20, 10)), None);
        assert_eq!(clipped(p(3.0, 3.0), p(3.0, 3.0), (20, 10)), Some((p(3.0, 3.0), p(3.0, 3.0))));
        assert_eq!((words(3.25), words(0.25), words(1.0)), ("1:3.3".into(), "4:1".into(), "1:1".into()));
    }
}
