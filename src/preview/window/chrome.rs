//! What stands around the picture and over it that is not part of the scene: the bar, lists, legends, the border of before and
//! after. No two of these overlap.

use kurbo::{Point, Rect, Vec2};

use super::canvas::Canvas;
use super::state::{Panel, State};
use super::stroke::Color;
use super::style::{ACCENT, TEXT};
use super::text::Letters;
use super::{bar, legend, panel, problems};
use crate::base::maths::{TAU, cos, sin};
use crate::layers::parts::marks::SELECTED_GROWTH;
use crate::preview::keys::{KEYS, VIEW};

/// Draws all of it.
pub fn draw(state: &State, letters: &Letters) -> Canvas {
    let mut canvas = Canvas::default();
    border(&mut canvas, state);
    grips(&mut canvas, state);
    band(&mut canvas, state);
    cross(&mut canvas, state, state.cursor, TEXT);
    cross(&mut canvas, state, state.marked, ACCENT);
    dragged(&mut canvas, state);
    let free = problems::draw(&mut canvas, state, letters);
    let free = bar::whole(&mut canvas, state, letters, free);
    match state.panel {
        Panel::None => legend::draw(&mut canvas, state, letters, free),
        Panel::Menu => panel::draw(&mut canvas, state, letters, free, KEYS.iter().filter(|row| row.context == VIEW)),
        Panel::Help(page) => {
            panel::draw(&mut canvas, state, letters, free, panel::page(state, &KEYS, page).0.into_iter());
        }
    }
    bar::draw(&mut canvas, state, letters);
    canvas
}

/// The border between the still picture and the moving one, with a handle.
fn border(canvas: &mut Canvas, state: &State) {
    let Some(x) = state.wipe_at() else { return };
    let (area, scale) = (state.area(), state.scale);
    let y = area.height / 2.0;
    let point = |dx: f64, dy: f64| Point::new(x + dx * scale, y + dy * scale);
    canvas.with_halo(|c| {
        c.line(Point::new(x, 0.0), Point::new(x, area.height), 1.5 * scale, TEXT);
        for side in [-1.0, 1.0] {
            c.polyline(
                &[point(5.0 * side, -5.0), point(10.0 * side, 0.0), point(5.0 * side, 5.0)],
                false,
                1.5 * scale,
                None,
                TEXT,
            );
        }
    });
}

/// A cross at a place of the picture: the point that was marked last, or the cursor of the editor.
fn cross(canvas: &mut Canvas, state: &State, at: Option<Point>, color: Color) {
    let Some(at) = at else { return };
    let (at, scale) = (state.viewport.screen_from_image(at, state.area()), state.scale);
    canvas.with_halo(|c| {
        for way in [Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0), Vec2::new(-1.0, 0.0), Vec2::new(0.0, -1.0)] {
            c.line(at + way * 3.0 * scale, at + way * 11.0 * scale, 1.5 * scale, color);
        }
    });
}

/// Half the side of a grip, in logical pixels; of one that is selected it is larger.
const GRIP_PX: f64 = 2.5;

/// What can be dragged: what is selected, and all that is in the same item while a mouse is there to drag it.
fn grips(canvas: &mut Canvas, state: &State) {
    let area = state.area();
    for grip in &state.grips {
        let selected = state.selects(grip);
        if !selected && state.pointer.is_none() {
            continue;
        }
        let screen = |at: Point| state.viewport.screen_from_image(at, area);
        let half = GRIP_PX * state.scale * if selected { f64::from(SELECTED_GROWTH) } else { 1.0 };
        let color = if selected { ACCENT } else { TEXT };
        canvas.with_halo(|c| {
            if let Some(from) = grip.from {
                c.line(screen(from), screen(grip.at), state.scale, color);
            }
            c.rect(Rect::from_center_size(screen(grip.at), (2.0 * half, 2.0 * half)), 0.0, color);
        });
    }
}

/// The box that the mouse draws.
fn band(canvas: &mut Canvas, state: &State) {
    let Some((from, to)) = state.band else { return };
    let corners = [(from.x, from.y), (to.x, from.y), (to.x, to.y), (from.x, to.y)];
    let points = corners.map(|at| state.viewport.screen_from_image(at.into(), state.area()));
    let dash = Some((4.0 * state.scale, 3.0 * state.scale));
    canvas.with_halo(|c| c.polyline(&points, true, state.scale, dash, ACCENT));
}

/// A ring where what is dragged goes.
fn dragged(canvas: &mut Canvas, state: &State) {
    let Some((_, at)) = &state.dragged else { return };
    let (at, scale) = (state.viewport.screen_from_image(*at, state.area()), state.scale);
    let ring: Vec<Point> = (0..24)
        .map(|k| {
            let angle = f64::from(k) * TAU / 24.0;
            at + Vec2::new(cos(angle), sin(angle)) * 6.0 * scale
        })
        .collect();
    canvas.with_halo(|c| c.polyline(&ring, true, 1.5 * scale, None, ACCENT));
}

#[cfg(test)]
mod tests {
    use super::super::style::PANEL;
    use super::*;
    use crate::base::problem::Problem;
    use crate::layers::parts::vectors::Reach;
    use crate::layers::timeline::Timeline;
    use kurbo::Size;

    #[test]
    fn keys_fit_a_small_window_beside_legends_and_problems() {
        let letters = Letters::default();
        for size in [Size::new(360.0, 240.0), Size::new(480.0, 320.0), Size::new(512.0, 802.0)] {
            let mut state = State {
                panel: Panel::Help(0),
                reach: Reach { longest_px: 40.0, ..Reach::default() },
                ..State::default()
            };
            for command in ["view-field", "view-wheel"] {
                state.run(command);
            }
            state.words.follow_scene(vec![Problem::error("/layers/0", "something is wrong")]);
            state.resize(size, 1.0);
            state.load(Size::new(320.0, 200.0), &Timeline::default());
            let canvas = draw(&state, &letters);
            let furthest = |axis: usize| canvas.strokes.iter().fold(0.0, |f: f32, s| f.max(s.a[axis]).max(s.b[axis]));
            assert!(furthest(0) <= size.width as f32 + 1.0 && furthest(1) <= size.height as f32, "{size:?}");
            let panels: Vec<_> = canvas.strokes.iter().filter(|s| s.color == PANEL).collect();
            assert_eq!(panels.len(), 2, "the keys and the problems");
            let lower = panels.iter().map(|s| s.a[1]).fold(0.0, f32::max);
            let upper = panels.iter().map(|s| s.b[1]).fold(f32::MAX, f32::min);
            assert!(upper <= lower, "{upper} {lower}");
        }
    }
}
