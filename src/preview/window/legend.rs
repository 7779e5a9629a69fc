//! Legends of the vector field: what the length of an arrow and a color mean. They stand in the lower corners, and above one
//! another where the window is narrow.

use std::rc::Rc;

use kurbo::{Point, Rect, Size, Vec2};

use super::canvas::Canvas;
use super::state::State;
use super::style::{MARGIN_PX, PANEL, TEXT, TEXT_PX};
use super::text::{Letters, Text};
use crate::base::maths::{TAU, cos, nice, sin};
use crate::base::text::short;
use crate::layers::parts::marks::{Legend, VECTORS, vector_color};
use crate::render::overlay::overlays;

/// Radius of the wheel of colors and of its dots, in logical pixels, and how many rings it has.
const WHEEL_PX: f64 = 34.0;
const DOT_PX: f64 = 2.6;
const RINGS: u32 = 6;
/// The longest arrow.
const LONGEST_PX: f64 = 90.0;
/// Between an arrow and its text.
const GAP_PX: f64 = 12.0;

/// Draws the legends of what is shown into what is free of the area.
pub fn draw(canvas: &mut Canvas, state: &State, letters: &Letters, free: Rect) {
    if !state.has_picture() || !state.shows("view-legends") {
        return;
    }
    let needs = |legend| overlays().any(|overlay| overlay.legend == Some(legend) && state.shows(overlay.name));
    // Where nothing jumps there are no colors to explain.
    let wheel = (needs(Legend::Colors) && state.longest > 0.0).then(|| Wheel::new(state, letters));
    let bar = needs(Legend::Arrows).then(|| ScaleBar::new(state, letters)).flatten();
    let sizes = [wheel.as_ref().map(|wheel| wheel.size), bar.as_ref().map(|bar| bar.size)];
    let [wheel_at, bar_at] = places(sizes, free, MARGIN_PX * state.scale);
    wheel.zip(wheel_at).into_iter().for_each(|(wheel, at)| wheel.draw(canvas, state, at));
    bar.zip(bar_at).into_iter().for_each(|(bar, at)| bar.draw(canvas, state, at));
}

/// Where to place two boxes of these sizes: the first in the right corner, the second in the left corner, or above the first
/// if they do not fit side by side. A box that does not fit is left out.
fn places([right, left]: [Option<Size>; 2], free: Rect, margin: f64) -> [Option<Rect>; 2] {
    let room = free.inset(-margin);
    let fits = |place: &Rect| place.x0 >= room.x0 && place.y0 >= room.y0;
    let right = right.map(|size| Rect::new(room.x1 - size.width, room.y1 - size.height, room.x1, room.y1)).filter(fits);
    let left = left.map(|size| {
        let beside = right.filter(|right| room.x0 + size.width + margin > right.x0);
        let bottom = beside.map_or(room.y1, |right| right.y0 - margin / 2.0);
        Rect::new(room.x0, bottom - size.height, room.x0 + size.width, bottom)
    });
    [right, left.filter(|place| fits(place) && place.x1 <= room.x1)]
}

/// Colors by direction and length, the longest jump vector at the rim and its length below.
struct Wheel {
    text: Rc<Text>,
    size: Size,
}

impl Wheel {
    fn new(state: &State, letters: &Letters) -> Wheel {
        let scale = state.scale;
        let text = letters.line(&format!("{} px", short(state.longest, 1)), TEXT_PX * scale);
        let width = (2.0 * WHEEL_PX * scale).max(text.width) + 2.0 * MARGIN_PX * scale;
        let size = Size::new(width, (2.0 * WHEEL_PX + TEXT_PX + 3.0 * MARGIN_PX) * scale);
        Wheel { text, size }
    }

    fn draw(&self, canvas: &mut Canvas, state: &State, at: Rect) {
        let scale = state.scale;
        canvas.rect(at, 4.0 * scale, PANEL);
        let middle = Point::new(at.center().x, at.y0 + (MARGIN_PX + WHEEL_PX) * scale);
        for ring in 0..=RINGS {
            let (share, dots) = (f64::from(ring) / f64::from(RINGS), (6 * ring).max(1));
            for dot in 0..dots {
                let angle = TAU * f64::from(dot) / f64::from(dots);
                let jump = Vec2::new(cos(angle), sin(angle)) * share;
                let [r, g, b, _] = vector_color(jump, 1.0);
                canvas.disc(middle + jump * ((WHEEL_PX - DOT_PX) * scale), DOT_PX * scale, [r, g, b, 255]);
            }
        }
        let text_at = Point::new(at.center().x - self.text.width / 2.0, at.y1 - (MARGIN_PX + TEXT_PX) * scale);
        canvas.text(&self.text, text_at, TEXT);
    }
}

/// An arrow of a round length, and what that is in pixels of the picture.
struct ScaleBar {
    /// Length of the arrow, on the screen.
    length: f64,
    text: Rc<Text>,
    size: Size,
}

impl ScaleBar {
    fn new(state: &State, letters: &Letters) -> Option<ScaleBar> {
        let scale = state.scale;
        let screen_from_jump = state.arrow_scale * state.viewport.zoom / scale;
        let jump = nice(LONGEST_PX / screen_from_jump)?;
        let length = jump * screen_from_jump * scale;
        let text = format!("{jump} px   one every {} px", short(state.field_spacing(), 1));
        let text = letters.line(&text, TEXT_PX * scale);
        let size = Size::new(length + text.width + (GAP_PX + 2.0 * MARGIN_PX) * scale, 20.0 * scale);
        Some(ScaleBar { length, text, size })
    }

    fn draw(&self, canvas: &mut Canvas, state: &State, at: Rect) {
        let scale = state.scale;
        canvas.rect(at, 4.0 * scale, PANEL);
        let from = Point::new(at.x0 + MARGIN_PX * scale, at.center().y);
        let to = from + Vec2::new(self.length, 0.0);
        canvas.arrow(from, to, 1.2 * scale, 7.0 * scale, VECTORS.color);
        canvas.text(&self.text, to + Vec2::new(GAP_PX * scale, -TEXT_PX * scale / 2.0), TEXT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn legends_stand_beside_or_above_one_another_within_the_window_or_not_at_all() {
        let (wheel, bar) = (Size::new(92.0, 112.0), Size::new(220.0, 20.0));
        for ((width, height), shown) in [
            ((960.0, 640.0), [true, true]),
            ((330.0, 300.0), [true, true]),
            ((330.0, 140.0), [true, false]),
            ((330.0, 100.0), [false, true]),
            ((200.0, 400.0), [true, false]),
            ((60.0, 20.0), [false, false]),
        ] {
            let free = Rect::new(0.0, 0.0, width, height);
            let places = places([Some(wheel), Some(bar)], free, 12.0);
            assert_eq!(places.map(|place| place.is_some()), shown, "{width} {height}");
            assert!(places.iter().flatten().all(|place| free.contains_rect(*place)), "{places:?}");
            if let [Some(wheel), Some(bar)] = places {
                assert!(!wheel.overlaps(bar), "{places:?}");
            }
        }
    }
}
