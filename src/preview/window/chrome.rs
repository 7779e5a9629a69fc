//! What stands around the picture: the bar at the bottom with the time, and the lists of keys.

use kurbo::{Point, Rect, Vec2};

use super::canvas::{Canvas, Color};
use super::state::{BAR_PX, Panel, State};
use super::{glyphs, legend};
use crate::base::keys::KeyRow;
use crate::preview::keys::{KEYS, VIEW};

/// The ground around the picture.
pub const GROUND: Color = [18, 20, 24, 255];
const BAR: Color = [28, 31, 37, 255];
pub const PANEL: Color = [22, 24, 29, 238];
const RAIL: Color = [58, 64, 74, 255];
const ACCENT: Color = [86, 180, 233, 255];
pub const TEXT: Color = [205, 210, 218, 255];
const WARNING: Color = [240, 160, 40, 255];
const DIM: Color = [132, 141, 153, 255];

pub const TEXT_PX: f64 = 8.0;
pub const MARGIN_PX: f64 = 12.0;

/// Draws bar and panel.
pub fn draw(state: &State) -> Canvas {
    let mut canvas = Canvas::default();
    border(&mut canvas, state);
    marked(&mut canvas, state);
    match state.panel {
        Panel::None => {}
        Panel::Menu => panel(&mut canvas, state, &mut KEYS.iter().filter(|row| row.context == VIEW)),
        Panel::Help => panel(&mut canvas, state, &mut KEYS.iter()),
    }
    legend::draw(&mut canvas, state);
    bar(&mut canvas, state);
    canvas
}

/// The border between the still picture and the moving one.
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

/// A cross at the point that was marked last.
fn marked(canvas: &mut Canvas, state: &State) {
    let Some(at) = state.marked else { return };
    let (at, scale) = (state.camera.screen_from_image(at, state.area()), state.scale);
    canvas.with_halo(|c| {
        for way in [Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0), Vec2::new(-1.0, 0.0), Vec2::new(0.0, -1.0)] {
            c.line(at + way * 3.0 * scale, at + way * 11.0 * scale, 1.5 * scale, ACCENT);
        }
    });
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
    let size = TEXT_PX * scale / glyphs::BASE;
    let right = right_text(state, (rail.x1 - left.x) / size - glyphs::width(&times) - 4.0 * glyphs::BASE);
    let right_at = rail.x1 - glyphs::width(&right) * size;
    canvas.text(&right, Point::new(right_at, y), TEXT_PX * scale, DIM);
    let from = left.x + glyphs::width(&times) * size + 24.0 * scale;
    let room = ((right_at - from - 16.0 * scale) / size).max(0.0);
    let (line, color) = said(state);
    canvas.text(&shortened(&line, room), Point::new(from, y), TEXT_PX * scale, color);
}

/// What the middle of the bar says: what is wrong, else what is shown instead of the picture, else what is selected and how
/// the window is connected.
fn said(state: &State) -> (String, Color) {
    let explained = if !state.has_picture() {
        Some("synthesising".to_owned())
    } else if state.shown.seam {
        let last = state.timeline.frames() - 1;
        Some(format!("seam: frame {last} against 0, differences x 8"))
    } else if state.shown.wipe {
        Some("still left, moving right".to_owned())
    } else {
        None
    };
    match (&state.problem, explained) {
        (Some(problem), _) => (problem.clone(), WARNING),
        (None, Some(explained)) => (explained, TEXT),
        (None, None) => {
            let parts = [state.selected.as_deref(), state.notice.as_deref()];
            (parts.into_iter().flatten().collect::<Vec<_>>().join("   "), DIM)
        }
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
    if !state.has_picture() {
        return String::new();
    }
    let (timeline, transport) = (&state.timeline, &state.transport);
    let still = if state.shown.still { "   still picture" } else { "" };
    let speed = if transport.speed == 1.0 { String::new() } else { format!("   speed {}", transport.speed) };
    format!(
        "{:.2} / {:.2} s   frame {} / {}{speed}{still}",
        transport.secs(timeline),
        timeline.frames() as f64 / timeline.fps,
        transport.frame.floor(),
        timeline.frames(),
    )
}

/// What stands on the right, as much of it as fits: the least important goes first.
fn right_text(state: &State, room: f64) -> String {
    let percent = state.camera.zoom * 100.0;
    let percent = if percent >= 10.0 { percent.round() } else { (percent * 10.0).round() / 10.0 };
    let mut parts: Vec<(u8, String)> = Vec::new();
    parts.extend(state.pointed().map(|p| (3, format!("x {:.1}  y {:.1}", p.x, p.y))));
    parts.extend(state.jump.map(|jump| (2, format!("jump {:.2}, {:.2}", jump.x, jump.y))));
    parts.extend(state.transport.whole_frames.then(|| (0, "whole frames".to_owned())));
    parts.extend(state.fps.map(|fps| (2, format!("{fps:.0} fps"))));
    parts.extend(state.has_picture().then(|| (4, format!("{percent} %"))));
    parts.push((1, "? keys".to_owned()));
    loop {
        let text = parts.iter().map(|(_, part)| part.as_str()).collect::<Vec<_>>().join("   ");
        let least = parts.iter().map(|(weight, _)| *weight).min();
        if parts.len() <= 1 || glyphs::width(&text) <= room {
            return text;
        }
        parts.retain(|(weight, _)| Some(*weight) != least);
    }
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

/// A list of keys in the upper left corner, in as many columns as it needs.
fn panel(canvas: &mut Canvas, state: &State, rows: &mut dyn Iterator<Item = &KeyRow>) {
    let rows: Vec<_> = rows.collect();
    let widest = |text: fn(&KeyRow) -> &str| {
        rows.iter().map(|r| glyphs::width(text(r))).fold(0.0, f64::max) * TEXT_PX / glyphs::BASE
    };
    // In logical pixels; then as much smaller as the window asks for.
    let (keys, line) = (widest(|r| r.key) + 1.5 * MARGIN_PX, glyphs::LINE * TEXT_PX / glyphs::BASE * 1.35);
    let column = keys + widest(|r| r.help) + 2.0 * MARGIN_PX;
    // As many columns as leave the letters largest.
    let area = state.area() / state.scale;
    let fits = |columns: usize| {
        let width = column * columns as f64 + 2.0 * MARGIN_PX;
        let height = line * rows.len().div_ceil(columns) as f64 + 4.0 * MARGIN_PX;
        (area.width / width).min(area.height / height).min(1.0)
    };
    let columns = (1..=4).rev().max_by(|&a, &b| fits(a).total_cmp(&fits(b))).unwrap_or(1);
    let height = rows.len().div_ceil(columns);
    let scale = state.scale * fits(columns);
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
        state.transport.speed = 0.25;
        assert!(times(&state).ends_with("frame 15 / 60   speed 0.25"));
        assert_eq!(right_text(&state, 999.0), "200 %   ? keys");
        (state.fps, state.transport.whole_frames) = (Some(59.97), true);
        assert_eq!(right_text(&state, 999.0), "whole frames   60 fps   200 %   ? keys");
        state.pointer = Some(Point::new(10.0, 43.0));
        for text in ["x 5.0  y 10.0   60 fps   200 %   ? keys", "x 5.0  y 10.0   200 %", "200 %"] {
            assert_eq!(right_text(&state, glyphs::width(text) + 0.1), text);
        }
    }

    #[test]
    fn the_bar_says_the_most_important_thing() {
        let mut state = State { notice: Some("joined".into()), selected: Some("face/eye".into()), ..state() };
        assert_eq!(said(&state), ("face/eye   joined".into(), DIM));
        state.shown.seam = true;
        assert!(said(&state).0.contains("frame 59 against 0"));
        state.problem = Some("no picture".into());
        assert_eq!(said(&state), ("no picture".into(), WARNING));
    }
}
