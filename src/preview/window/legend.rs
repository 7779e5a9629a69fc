//! Legends of the vector field: what the length of an arrow and a colour mean.

use kurbo::{Point, Rect, Vec2};

use super::canvas::Canvas;
use super::chrome::{MARGIN_PX, PANEL, TEXT, TEXT_PX};
use super::glyphs;
use super::state::State;
use crate::base::maths::{TAU, cos, pow, sin};
use crate::render::overlay::{Kind, wheel};

/// Radius of the wheel of colours and of its dots, in logical pixels, and how many rings it has.
const WHEEL_PX: f64 = 34.0;
const DOT_PX: f64 = 2.6;
const RINGS: u32 = 6;

/// Draws the legends of what is shown.
pub fn draw(canvas: &mut Canvas, state: &State) {
    if !state.has_picture() {
        return;
    }
    if state.shown.field {
        scale_bar(canvas, state);
    }
    if state.shown.wheel {
        colour_wheel(canvas, state);
    }
}

/// Colours by direction and length, the longest jump vector at the rim and its length below.
fn colour_wheel(canvas: &mut Canvas, state: &State) {
    let scale = state.scale;
    let text = format!("{} px", rounded(state.longest));
    let width = glyphs::width(&text) * TEXT_PX / glyphs::BASE;
    let side = (2.0 * WHEEL_PX).max(width) + 2.0 * MARGIN_PX;
    let corner = Point::new(state.area().width / scale - MARGIN_PX, state.area().height / scale - MARGIN_PX);
    let back = Rect::new(corner.x - side, corner.y - 2.0 * WHEEL_PX - TEXT_PX - 3.0 * MARGIN_PX, corner.x, corner.y);
    let place = |x: f64, y: f64| Point::new(x * scale, y * scale);
    canvas.rect(Rect::from_points(place(back.x0, back.y0), place(back.x1, back.y1)), 4.0 * scale, PANEL);
    let middle = place(back.center().x, back.y0 + MARGIN_PX + WHEEL_PX);
    for ring in 0..=RINGS {
        let (share, dots) = (f64::from(ring) / f64::from(RINGS), (6 * ring).max(1));
        for dot in 0..dots {
            let angle = TAU * f64::from(dot) / f64::from(dots);
            let jump = Vec2::new(cos(angle), sin(angle)) * share;
            let [r, g, b, _] = wheel(jump, 1.0);
            canvas.disc(middle + jump * ((WHEEL_PX - DOT_PX) * scale), DOT_PX * scale, [r, g, b, 255]);
        }
    }
    let text_at = place(back.center().x - width / 2.0, back.y1 - MARGIN_PX - TEXT_PX);
    canvas.text(&text, text_at, TEXT_PX * scale, TEXT);
}

/// A length with at most one decimal.
fn rounded(length: f64) -> f64 {
    (length * 10.0).round() / 10.0
}

/// An arrow of a round length, and what that is in pixels of the picture.
fn scale_bar(canvas: &mut Canvas, state: &State) {
    let scale = state.scale;
    let screen_from_jump = state.arrow_scale * state.camera.zoom / scale;
    let Some(jump) = round_length(screen_from_jump) else { return };
    let y = state.area().height - 20.0 * scale;
    let from = Point::new(2.0 * MARGIN_PX * scale, y);
    let to = from + Vec2::new(jump * screen_from_jump * scale, 0.0);
    let text = format!("{jump} px   one every {} px", rounded(state.field_spacing()));
    let right = to.x + 12.0 * scale + glyphs::width(&text) * TEXT_PX * scale / glyphs::BASE;
    let back = Rect::new(MARGIN_PX * scale, y - 10.0 * scale, right + MARGIN_PX * scale, y + 10.0 * scale);
    canvas.rect(back, 4.0 * scale, PANEL);
    canvas.arrow(from, to, 1.2 * scale, 7.0 * scale, Kind::Field.style().color);
    canvas.text(&text, Point::new(to.x + 12.0 * scale, y - TEXT_PX * scale / 2.0), TEXT_PX * scale, TEXT);
}

/// The largest of 1, 2, 5, 10, 20 ... pixels that is at most 90 logical pixels long on the screen.
fn round_length(screen_from_jump: f64) -> Option<f64> {
    let steps = (-2..7).flat_map(|power| [1.0, 2.0, 5.0].map(|step| step * pow(10.0, f64::from(power))));
    steps.filter(|length| length * screen_from_jump <= 90.0).reduce(f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_bar_has_a_round_length_that_fits() {
        for (screen_from_jump, length) in [(1.0, 50.0), (0.9, 100.0), (8.0, 10.0), (0.031, 2000.0)] {
            assert_eq!(round_length(screen_from_jump), Some(length), "{screen_from_jump}");
        }
        assert_eq!(round_length(f64::NAN), None);
    }
}
