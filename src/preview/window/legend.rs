//! Legends: what the length of an arrow and a color of the vector field mean, and the colors of a pass. They stand in the
//! lower corners, and above one another where the window is narrow.

use std::rc::Rc;

use kurbo::{Point, Rect, Size, Vec2};

use super::canvas::Canvas;
use super::state::State;
use super::style::{MARGIN_PX, PANEL, TEXT, TEXT_PX};
use super::text::{Letters, Text};
use crate::base::maths::{TAU, cos, nice, sin};
use crate::base::text::short;
use crate::layers::parts::marks::{Legend, VECTORS, View};
use crate::layers::parts::vectors::{Coloring, by_direction};
use crate::render::overlay::overlays;

/// Radius of the wheel of colors and of its dots, in logical pixels, and how many rings it has.
const WHEEL_PX: f64 = 34.0;
const DOT_PX: f64 = 2.6;
const RINGS: u32 = 6;
/// Width and height of a scale of colors, and in how many steps it is drawn.
const SCALE_PX: (f64, f64) = (110.0, 10.0);
const STEPS: u32 = 22;
/// The longest arrow, and the only one where all are equally long.
const LONGEST_PX: f64 = 90.0;
const EQUAL_PX: f64 = 22.0;
/// Between an arrow and its text.
const GAP_PX: f64 = 12.0;

/// Between two names, in logical pixels.
const LEAD_PX: f64 = 6.0;

/// Draws the legends of what is shown into what is free of the area.
pub fn draw(canvas: &mut Canvas, state: &State, letters: &Letters, free: Rect) {
    if !state.has_picture() || !state.shows("view-legends") {
        return;
    }
    let needs = |legend| overlays().any(|overlay| overlay.legend == Some(legend) && state.shows(overlay.name));
    let look = &state.switches.vectors;
    let is_stroke = needs(Legend::Arrows) || needs(Legend::Lines);
    let colors = needs(Legend::Colors) || is_stroke && look.color != Coloring::Plain;
    // Where nothing jumps there are no colors to explain.
    let colors = (colors && state.reach.longest_px > 0.0).then(|| Colors::new(state, letters));
    let bar = needs(Legend::Arrows).then(|| ScaleBar::new(state, letters)).flatten();
    let names = Names::new(state, letters, free);
    let left = names.as_ref().map(|names| names.size).or(bar.as_ref().map(|bar| bar.size));
    let sizes = [colors.as_ref().map(|colors| colors.size), left];
    let [colors_at, left_at] = places(sizes, free, MARGIN_PX * state.scale);
    colors.zip(colors_at).into_iter().for_each(|(colors, at)| colors.draw(canvas, state, at));
    match (names, bar, left_at) {
        (Some(names), _, Some(at)) => names.draw(canvas, state, at),
        (None, Some(bar), Some(at)) => bar.draw(canvas, state, at),
        _ => {}
    }
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

/// What colors tell: directions on a wheel, the longest jump vector at its rim and its length below, or a scale from the least
/// to the most.
struct Colors {
    /// The scale and its ends; `None` for the wheel.
    scale: Option<(fn(f64) -> [u8; 3], [Rc<Text>; 2])>,
    /// The length at the rim, or what the scale tells.
    text: Rc<Text>,
    size: Size,
}

impl Colors {
    fn new(state: &State, letters: &Letters) -> Colors {
        let (scale, look) = (state.scale, &state.switches.vectors);
        let line = |text: &str| letters.line(text, TEXT_PX * scale);
        let found = look.scale(state.reach).map(|(color, ends)| (color, ends.map(|end| line(&end))));
        let (text, extent) = match &found {
            None => (line(&format!("{} px", short(state.reach.longest_px, 1))), [2.0 * WHEEL_PX; 2]),
            Some(_) => (line(look.color.name()), [SCALE_PX.0, SCALE_PX.1 + TEXT_PX + MARGIN_PX]),
        };
        let width = (extent[0] * scale).max(text.width) + 2.0 * MARGIN_PX * scale;
        let size = Size::new(width, (extent[1] + TEXT_PX + 3.0 * MARGIN_PX) * scale);
        Colors { scale: found, text, size }
    }

    fn draw(&self, canvas: &mut Canvas, state: &State, at: Rect) {
        let scale = state.scale;
        canvas.rect(at, 4.0 * scale, PANEL);
        match &self.scale {
            None => wheel(canvas, Point::new(at.center().x, at.y0 + (MARGIN_PX + WHEEL_PX) * scale), scale),
            Some((color, ends)) => {
                let (x0, x1, y0) = (at.x0 + MARGIN_PX * scale, at.x1 - MARGIN_PX * scale, at.y0 + MARGIN_PX * scale);
                let step = (x1 - x0) / f64::from(STEPS);
                for k in 0..STEPS {
                    let [r, g, b] = color((f64::from(k) + 0.5) / f64::from(STEPS));
                    let x = x0 + step * f64::from(k);
                    canvas.rect(Rect::new(x, y0, x + step, y0 + SCALE_PX.1 * scale), 0.0, [r, g, b, 255]);
                }
                let below = y0 + (SCALE_PX.1 + MARGIN_PX / 2.0) * scale;
                canvas.text(&ends[0], Point::new(x0, below), TEXT);
                canvas.text(&ends[1], Point::new(x1 - ends[1].width, below), TEXT);
            }
        }
        let text_at = Point::new(at.center().x - self.text.width / 2.0, at.y1 - (MARGIN_PX + TEXT_PX) * scale);
        canvas.text(&self.text, text_at, TEXT);
    }
}

fn wheel(canvas: &mut Canvas, middle: Point, scale: f64) {
    for ring in 0..=RINGS {
        let (share, dots) = (f64::from(ring) / f64::from(RINGS), (6 * ring).max(1));
        for dot in 0..dots {
            let angle = TAU * f64::from(dot) / f64::from(dots);
            let way = Vec2::new(cos(angle), sin(angle));
            let [r, g, b] = by_direction(way, share);
            canvas.disc(middle + way * (share * (WHEEL_PX - DOT_PX) * scale), DOT_PX * scale, [r, g, b, 255]);
        }
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
        let view = View { reach: state.reach, ..state.fixed_view() };
        let every = short(state.field_spacing(), 1);
        let (length, text) = if view.vectors.equal {
            (EQUAL_PX * scale, format!("direction alone   one every {every} px"))
        } else {
            let screen_from_jump = view.arrow_scale() * state.viewport.zoom / scale;
            let jump = nice(LONGEST_PX / screen_from_jump)?;
            (jump * screen_from_jump * scale, format!("{jump} px   one every {every} px"))
        };
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

/// The names of what the colors of a pass mean, as many as have room.
struct Names {
    /// Each with its color; one without says how many are left out.
    rows: Vec<(Option<[u8; 3]>, Rc<Text>)>,
    size: Size,
}

impl Names {
    fn new(state: &State, letters: &Letters, free: Rect) -> Option<Names> {
        let (scale, named) = (state.scale, &state.named_colors);
        let room = ((free.height() / scale - 4.0 * MARGIN_PX) / (TEXT_PX + LEAD_PX)).max(0.0) as usize;
        let shown = if named.len() > room { room.saturating_sub(1) } else { named.len() };
        let row = |(name, color): &(String, [u8; 3])| (Some(*color), letters.line(name, TEXT_PX * scale));
        let more = (shown < named.len()).then(|| format!("and {} more", named.len() - shown));
        let more = more.map(|text| (None, letters.line(&text, TEXT_PX * scale)));
        let rows: Vec<_> = named[..shown].iter().map(row).chain(more).collect();
        let widest = rows.iter().map(|(_, text)| text.width).reduce(f64::max).filter(|_| room > 0)?;
        let height = rows.len() as f64 * (TEXT_PX + LEAD_PX) + 2.0 * MARGIN_PX - LEAD_PX;
        let size = Size::new(widest + (TEXT_PX + GAP_PX + 2.0 * MARGIN_PX) * scale, height * scale);
        Some(Names { rows, size })
    }

    fn draw(&self, canvas: &mut Canvas, state: &State, at: Rect) {
        let scale = state.scale;
        canvas.rect(at, 4.0 * scale, PANEL);
        let from = Point::new(at.x0 + MARGIN_PX * scale, at.y0 + MARGIN_PX * scale);
        for (i, (color, text)) in self.rows.iter().enumerate() {
            let top = from.y + i as f64 * (TEXT_PX + LEAD_PX) * scale;
            let radius = TEXT_PX * scale / 2.0;
            if let Some([r, g, b]) = *color {
                canvas.disc(Point::new(from.x + radius, top + radius), radius, [r, g, b, 255]);
            }
            canvas.text(text, Point::new(from.x + (TEXT_PX + GAP_PX) * scale, top), TEXT);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_colors_of_a_pass_are_named_as_far_as_there_is_room() {
        let letters = Letters::default();
        let free = Rect::new(0.0, 0.0, 640.0, 400.0);
        let mut state = State::for_tests();
        assert!(Names::new(&state, &letters, free).is_none());
        for (count, left_out) in [(3, 0), (256, 1)] {
            state.named_colors = (0..count).map(|i| (format!("view {i}"), [i as u8; 3])).collect();
            let names = Names::new(&state, &letters, free).unwrap();
            assert!(names.size.height <= free.height() - 2.0 * MARGIN_PX, "{:?}", names.size);
            assert_eq!(names.rows.iter().filter(|(color, _)| color.is_none()).count(), left_out);
            let mut canvas = Canvas::default();
            draw(&mut canvas, &state, &letters, free);
            assert!(!canvas.strokes.is_empty());
        }
        assert!(Names::new(&state, &letters, Rect { y1: 40.0, ..free }).is_none());
    }

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
