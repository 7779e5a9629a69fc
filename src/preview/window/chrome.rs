//! What stands around the picture: the bar at the bottom with the time, and the lists of keys.

use kurbo::{Point, Rect, Vec2};

use super::canvas::{Canvas, Color};
use super::glyphs;
use super::state::{BAR_PX, Panel, State};
use crate::base::keys::KeyRow;
use crate::base::maths::pow;
use crate::preview::keys::{KEYS, VIEW};
use crate::render::overlay::Kind;

/// The ground around the picture.
pub const GROUND: Color = [18, 20, 24, 255];
const BAR: Color = [28, 31, 37, 255];
const PANEL: Color = [22, 24, 29, 238];
const RAIL: Color = [58, 64, 74, 255];
const ACCENT: Color = [86, 180, 233, 255];
const TEXT: Color = [205, 210, 218, 255];
const WARNING: Color = [240, 160, 40, 255];
const DIM: Color = [132, 141, 153, 255];

const TEXT_PX: f64 = 8.0;
const MARGIN_PX: f64 = 12.0;

/// Draws bar and panel.
pub fn draw(state: &State) -> Canvas {
    let mut canvas = Canvas::default();
    match state.panel {
        Panel::None => {}
        Panel::Menu => panel(&mut canvas, state, &mut KEYS.iter().filter(|row| row.context == VIEW)),
        Panel::Help => panel(&mut canvas, state, &mut KEYS.iter()),
    }
    if state.shown.field {
        scale_bar(&mut canvas, state);
    }
    bar(&mut canvas, state);
    canvas
}

/// The rail in the bar along which time runs, in physical pixels.
pub fn rail(state: &State) -> Rect {
    let (area, scale) = (state.area(), state.scale);
    let y = area.height + 6.0 * scale;
    Rect::new(MARGIN_PX * scale, y, (area.width - MARGIN_PX * scale).max(MARGIN_PX * scale + 1.0), y + 3.0 * scale)
}

fn bar(canvas: &mut Canvas, state: &State) {
    let (area, scale) = (state.area(), state.scale);
    canvas.rect(Rect::new(0.0, area.height, state.window.width, state.window.height), 0.0, BAR);
    let rail = rail(state);
    let (corner, share) = (1.5 * scale, place(state));
    let knob = Point::new(rail.x0 + rail.width() * share, rail.center().y);
    canvas.rect(rail, corner, RAIL);
    canvas.rect(Rect::new(rail.x0, rail.y0, knob.x, rail.y1), corner, ACCENT);
    canvas.disc(knob, 4.0 * scale, ACCENT);
    let y = area.height + (BAR_PX - 6.0 - TEXT_PX) * scale;
    sign(canvas, state.transport.playing, Point::new(rail.x0, y), TEXT_PX * scale);
    let left = Point::new(rail.x0 + 18.0 * scale, y);
    let times = times(state);
    canvas.text(&times, left, TEXT_PX * scale, TEXT);
    let right = right_text(state);
    let size = TEXT_PX * scale / glyphs::BASE;
    let right_at = rail.x1 - glyphs::width(&right) * size;
    canvas.text(&right, Point::new(right_at, y), TEXT_PX * scale, DIM);
    if let Some(line) = state.problem.as_ref().or(state.notice.as_ref()) {
        let color = if state.problem.is_some() { WARNING } else { DIM };
        let from = left.x + glyphs::width(&times) * size + 24.0 * scale;
        let room = ((right_at - from - 16.0 * scale) / size).max(0.0);
        canvas.text(&shortened(line, room), Point::new(from, y), TEXT_PX * scale, color);
    }
}

/// Where the knob stands on the rail, 0 to 1.
fn place(state: &State) -> f64 {
    let last = (state.timeline.frames() as f64 - 1.0).max(1.0);
    (state.transport.frame / last).min(1.0)
}

/// The frame that belongs to a place on the rail.
pub fn frame_at(state: &State, x: f64) -> f64 {
    let rail = rail(state);
    let last = state.timeline.frames() as f64 - 1.0;
    (((x - rail.x0) / rail.width()).clamp(0.0, 1.0) * last).round()
}

/// What can be done: a triangle that plays, or two lines that pause.
fn sign(canvas: &mut Canvas, playing: bool, at: Point, height: f64) {
    let point = |x: f64, y: f64| Point::new(at.x + x * height, at.y + y * height);
    let width = 0.16 * height;
    if playing {
        canvas.line(point(0.2, 0.05), point(0.2, 0.95), width, TEXT);
        canvas.line(point(0.65, 0.05), point(0.65, 0.95), width, TEXT);
    } else {
        canvas.polyline(&[point(0.1, 0.0), point(0.9, 0.5), point(0.1, 1.0)], true, width, None, TEXT);
    }
}

fn times(state: &State) -> String {
    let (timeline, transport) = (&state.timeline, &state.transport);
    let still = if state.shown.still { "  still" } else { "" };
    format!(
        "{:.2} / {:.2} s   frame {} / {}{still}",
        transport.secs(timeline),
        timeline.frames() as f64 / timeline.fps,
        transport.frame.floor(),
        timeline.frames(),
    )
}

fn right_text(state: &State) -> String {
    let place = state.pointed().map_or(String::new(), |p| format!("x {:.1}  y {:.1}   ", p.x, p.y));
    let percent = state.camera.zoom * 100.0;
    format!("{place}{} %   ? keys", if percent >= 10.0 { percent.round() } else { (percent * 10.0).round() / 10.0 })
}

/// As much of a text as fits.
fn shortened(text: &str, room: f64) -> String {
    if glyphs::width(text) <= room {
        return text.to_owned();
    }
    let mut kept = String::new();
    for letter in text.chars() {
        kept.push(letter);
        if glyphs::width(&kept) + glyphs::width("...") > room {
            kept.pop();
            break;
        }
    }
    if kept.is_empty() { kept } else { kept + "..." }
}

/// An arrow of a round length, and what that is in pixels of the picture: the legend of the vector field.
fn scale_bar(canvas: &mut Canvas, state: &State) {
    let scale = state.scale;
    let screen_from_jump = state.arrow_scale * state.camera.zoom / scale;
    let Some(jump) = round_length(screen_from_jump) else { return };
    let y = state.area().height - 20.0 * scale;
    let from = Point::new(2.0 * MARGIN_PX * scale, y);
    let to = from + Vec2::new(jump * screen_from_jump * scale, 0.0);
    let text = format!("{jump} px");
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

/// A list of keys in the upper left corner, in as many columns as it needs.
fn panel(canvas: &mut Canvas, state: &State, rows: &mut dyn Iterator<Item = &KeyRow>) {
    let rows: Vec<_> = rows.collect();
    let widest = |text: fn(&KeyRow) -> &str| {
        rows.iter().map(|r| glyphs::width(text(r))).fold(0.0, f64::max) * TEXT_PX / glyphs::BASE
    };
    // In logical pixels; then as much smaller as the window asks for.
    let (keys, line) = (widest(|r| r.key) + 1.5 * MARGIN_PX, glyphs::LINE * TEXT_PX / glyphs::BASE * 1.35);
    let column = keys + widest(|r| r.help) + 2.0 * MARGIN_PX;
    let room = ((state.area().height / state.scale - 4.0 * MARGIN_PX) / line).floor().max(1.0) as usize;
    let columns = rows.len().div_ceil(room);
    let height = rows.len().div_ceil(columns.max(1));
    let width = column * columns as f64 + 2.0 * MARGIN_PX;
    let scale = state.scale * (state.area().width / state.scale / width).min(1.0);
    let [margin, keys, line, column] = [MARGIN_PX, keys, line, column].map(|length| length * scale);
    let frame = Rect::new(
        margin,
        margin,
        margin + column * columns as f64,
        3.0 * margin + line * (height as f64 - 1.0) + TEXT_PX * scale,
    );
    canvas.rect(frame, 6.0 * scale, PANEL);
    for (i, row) in rows.iter().enumerate() {
        let at = frame.origin() + Vec2::new(margin + column * (i / height) as f64, margin + line * (i % height) as f64);
        canvas.text(row.key, at, TEXT_PX * scale, ACCENT);
        canvas.text(row.help, at + Vec2::new(keys, 0.0), TEXT_PX * scale, TEXT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::timeline::Timeline;
    use kurbo::Size;

    fn state() -> State {
        let mut state = State::default();
        state.resize(Size::new(640.0, 480.0), 1.0);
        state.load(Size::new(320.0, 200.0), &Timeline::default());
        state
    }

    #[test]
    fn the_rail_runs_from_the_first_to_the_last_frame() {
        let mut state = state();
        let rail = rail(&state);
        for (x, frame) in [(0.0, 0.0), (rail.x0, 0.0), (rail.x1, 59.0), (9999.0, 59.0)] {
            assert_eq!(frame_at(&state, x), frame, "{x}");
        }
        state.transport.frame = 59.0;
        assert_eq!(place(&state), 1.0);
    }

    #[test]
    fn long_notices_are_shortened() {
        let room = glyphs::width("the scene");
        assert_eq!(shortened("the scene", room), "the scene");
        let short = shortened("the scene cannot be read", room);
        assert!(short.ends_with("...") && glyphs::width(&short) <= room + 2.0, "{short}");
    }

    #[test]
    fn the_scale_bar_has_a_round_length_that_fits() {
        for (screen_from_jump, length) in [(1.0, 50.0), (0.9, 100.0), (8.0, 10.0), (0.031, 2000.0)] {
            assert_eq!(round_length(screen_from_jump), Some(length), "{screen_from_jump}");
        }
        assert_eq!(round_length(f64::NAN), None);
    }

    #[test]
    fn all_keys_fit_a_small_window() {
        let mut state = State { panel: Panel::Help, ..state() };
        state.resize(Size::new(480.0, 320.0), 1.0);
        let furthest = |axis: usize| draw(&state).strokes.iter().fold(0.0, |f: f32, s| f.max(s.a[axis]).max(s.b[axis]));
        assert!(furthest(0) <= 480.0 && furthest(1) <= 320.0, "{} {}", furthest(0), furthest(1));
    }

    #[test]
    fn the_bar_tells_time_and_frame() {
        let mut state = state();
        state.transport.frame = 15.0;
        assert_eq!(times(&state), "0.50 / 2.00 s   frame 15 / 60");
    }
}
