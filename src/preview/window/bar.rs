//! The bar at the bottom: time, what is said of the scene, and where the pointer is. What does not fit goes, the least
//! important first; a message that does not fit stands above it.

use kurbo::{Point, Rect, Vec2};

use super::canvas::Canvas;
use super::state::{BAR_PX, State};
use super::stroke::Color;
use super::style::{ACCENT, DIM, MARGIN_PX, PANEL, RAIL, TEXT, TEXT_PX, WARNING};
use super::text::Letters;
use super::transport::Part;
use crate::base::maths::atan2;
use crate::base::number::rounded;
use crate::base::text::short;

const GROUND: Color = [28, 31, 37, 255];
/// Width of the sign that plays, with its room, in logical pixels.
const SIGN_PX: f64 = 18.0;
/// Between two parts of the bar, in logical pixels.
const GAP_PX: f64 = 16.0;
/// The times take at most this share of the bar, and what is said gets at least that share of the rest, if it needs it.
const TIMES: f64 = 0.6;
const SAID: f64 = 0.45;

/// While the window looks past everything.
const NOTHING: &str = "nothing of the scene is seen from here: 5 shows everything, 0 ends the own view";

/// The rail along which time runs, in physical pixels.
pub fn rail(state: &State) -> Rect {
    let (area, scale) = (state.area(), state.scale);
    let y = area.height + 6.0 * scale;
    Rect::new(MARGIN_PX * scale, y, (area.width - MARGIN_PX * scale).max(MARGIN_PX * scale + 1.0), y + 3.0 * scale)
}

/// Whether a place on the screen is on the sign that plays.
pub fn is_sign(state: &State, at: Point) -> bool {
    let rail = rail(state);
    at.y > rail.y1 + 3.0 * state.scale && at.x < rail.x0 + SIGN_PX * state.scale
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

/// Draws it.
pub fn draw(canvas: &mut Canvas, state: &State, letters: &Letters) {
    let (area, scale) = (state.area(), state.scale);
    canvas.rect(Rect::new(0.0, area.height, state.window.width, state.window.height), 0.0, GROUND);
    let rail = rail(state);
    let (corner, share) = (1.5 * scale, place(state));
    let knob = Point::new(rail.x0 + rail.width() * share, rail.center().y);
    canvas.rect(rail, corner, RAIL);
    canvas.rect(Rect::new(rail.x0, rail.y0, knob.x, rail.y1), corner, ACCENT);
    part(canvas, state, rail);
    canvas.disc(knob, 4.0 * scale, ACCENT);
    let height = TEXT_PX * scale;
    let y = area.height + (BAR_PX - 7.0 - TEXT_PX) * scale;
    sign(canvas, state.transport.playing, Point::new(rail.x0, y), height);
    let row = row(state, letters);
    let is_above = row.is_above(state, letters);
    let Row { times, times_at, said, color, said_at, room, right, right_at } = row;
    canvas.text(&letters.line(&times, height), Point::new(times_at, y), TEXT);
    canvas.text(&letters.line(&right, height), Point::new(right_at, y), DIM);
    if room > 2.0 * height && !is_above {
        canvas.text(&letters.within(&said, height, room), Point::new(said_at, y), color);
    }
}

/// The ends of what is played, if that is a part.
fn part(canvas: &mut Canvas, state: &State, rail: Rect) {
    let ends = match state.transport.part {
        Part::All => [None; 2],
        Part::From(frame) => [Some(frame), None],
        Part::Between(first, last) => [Some(first), Some(last)],
    };
    let last = (state.timeline.frames() as f64 - 1.0).max(1.0);
    for frame in ends.into_iter().flatten() {
        let x = rail.x0 + rail.width() * (frame / last).min(1.0);
        let half = 1.0 * state.scale;
        canvas.rect(Rect::new(x - half, rail.y0 - 3.0 * half, x + half, rail.y1 + 3.0 * half), 0.0, TEXT);
    }
}

/// The texts of the bar, and where they begin.
struct Row {
    times: String,
    times_at: f64,
    said: String,
    color: Color,
    said_at: f64,
    /// For what is said.
    room: f64,
    right: String,
    right_at: f64,
}

fn row(state: &State, letters: &Letters) -> Row {
    let (rail, scale) = (rail(state), state.scale);
    let (height, gap) = (TEXT_PX * scale, GAP_PX * scale);
    let width = |text: &str| letters.width(text, height);
    let times_at = rail.x0 + SIGN_PX * scale;
    let times = first_that_fits(times(state), TIMES * (rail.x1 - times_at), width);
    let said_at = if times.is_empty() { times_at } else { times_at + width(&times) + gap };
    let (said, color) = said(state);
    let room = rail.x1 - said_at;
    let right = right_text(state, room - gap - width(&said).min(SAID * room), width);
    let right_at = rail.x1 - width(&right);
    Row { times, times_at, said, color, said_at, room: right_at - said_at - gap, right, right_at }
}

impl Row {
    /// Whether what is said is a message that the bar has no room for. What is being done is told in few words, and changes.
    fn is_above(&self, state: &State, letters: &Letters) -> bool {
        let messages = [state.words.told.as_deref(), state.no_pass.as_deref(), Some(NOTHING)];
        let is_message = self.color == WARNING || messages.contains(&Some(self.said.as_str()));
        is_message && letters.width(&self.said, TEXT_PX * state.scale) > self.room
    }
}

/// Draws a message that the bar has no room for, on as many lines as it takes, at the bottom of what is `free` of the area;
/// returns what is free then.
pub fn whole(canvas: &mut Canvas, state: &State, letters: &Letters, free: Rect) -> Rect {
    let row = row(state, letters);
    if !row.is_above(state, letters) {
        return free;
    }
    let Row { said, color, .. } = row;
    let [margin, height] = [MARGIN_PX, TEXT_PX].map(|length| length * state.scale);
    let text = letters.wrapped(&said, height, (free.width() - 2.0 * margin).max(4.0 * height));
    let top = (free.y1 - text.height() - 2.0 * margin).max(free.y0).round();
    canvas.rect(Rect { y0: top, ..free }, 0.0, PANEL);
    canvas.text(&text, Point::new(free.x0 + margin, top + margin), color);
    Rect { y1: top, ..free }
}

fn first_that_fits(texts: Vec<String>, room: f64, width: impl Fn(&str) -> f64) -> String {
    texts.into_iter().find(|text| width(text) <= room).unwrap_or_default()
}

/// What the middle of the bar says: what is wrong, else what is shown instead of the picture, else what is selected and how
/// the window is connected.
fn said(state: &State) -> (String, Color) {
    let words = &state.words;
    let work = state.work.filter(|work| work.is_long).map(|work| work.to_string());
    let explained = if !state.has_picture() {
        Some(words.progress.clone().unwrap_or_else(|| state.waits_for()))
    } else if work.is_some() {
        work.clone()
    } else if state.drawing && !state.transport.playing {
        Some(format!("drawing {}", state.pass.as_ref().map_or("the frame".into(), |pass| format!("the pass {pass}"))))
    } else if let Some(why) = &state.no_pass {
        Some(why.clone())
    } else if words.told.is_some() {
        words.told.clone()
    } else if state.sees_nothing {
        Some(NOTHING.to_owned())
    } else if let Some(pass) = &state.pass {
        Some(format!("pass {pass}"))
    } else if state.shows("view-seam") {
        let last = state.timeline.frames() - 1;
        Some(format!("seam: frame {last} against 0, differences x 8"))
    } else if state.shows("view-wipe") {
        Some("still left, moving right".to_owned())
    } else {
        None
    };
    match (words.in_one_line().filter(|_| words.listed().is_empty()), explained) {
        (Some(problem), _) => ([Some(problem), work].into_iter().flatten().collect::<Vec<_>>().join("   "), WARNING),
        (None, Some(explained)) => (explained, TEXT),
        (None, None) => {
            let followed = words.progress.as_deref().or(words.notice.as_deref());
            let parts = [state.otherwise.as_deref(), state.selected.as_deref(), followed];
            (parts.into_iter().flatten().collect::<Vec<_>>().join("   "), DIM)
        }
    }
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

/// Time and frame, from the longest way of saying it to the shortest.
fn times(state: &State) -> Vec<String> {
    if !state.has_picture() {
        return Vec::new();
    }
    let (timeline, transport) = (&state.timeline, &state.transport);
    let still = if state.shows("view-still") { "   still picture" } else { "" };
    let speed = if transport.speed == 1.0 { String::new() } else { format!("   speed {}", transport.speed) };
    let seconds = format!("{:.2} / {:.2} s", transport.secs(timeline), timeline.frames() as f64 / timeline.fps);
    let frames = format!("{} / {}", transport.frame.floor(), timeline.frames());
    vec![
        format!("{seconds}   frame {frames}{speed}{still}"),
        format!("{seconds}   frame {frames}"),
        format!("frame {frames}"),
        frames,
    ]
}

/// Length and direction of a jump vector, counter-clockwise as in the editor's table.
fn polar(jump: Vec2) -> String {
    let degrees = if jump == Vec2::ZERO { 0.0 } else { atan2(0.0 - jump.y, jump.x).to_degrees() };
    format!("{} px {}°", short(jump.hypot2().sqrt(), 2), short(degrees, 1))
}

/// What stands on the right, as much of it as fits: the least important goes first.
fn right_text(state: &State, room: f64, width: impl Fn(&str) -> f64) -> String {
    let percent = state.viewport.zoom * 100.0;
    let percent = if percent >= 10.0 { percent.round() } else { rounded(percent, 1) };
    let mut parts: Vec<(u8, String)> = Vec::new();
    parts.extend(state.pointed().map(|p| (3, format!("x {:.1}  y {:.1}", p.x, p.y))));
    parts.extend(state.under.clone().map(|under| (5, under)));
    parts.extend(state.jump.map(|jump| (2, format!("jump {:.2}, {:.2}", jump.x, jump.y))));
    parts.extend(state.jump.map(|jump| (1, polar(jump))));
    parts.extend(state.transport.whole_frames.then(|| (0, "whole frames".to_owned())));
    parts.extend(state.fps.map(|fps| (2, format!("{fps:.0} fps"))));
    parts.extend((state.dropped > 0).then(|| (3, format!("{} dropped", state.dropped))));
    parts.extend(state.thin.words().map(|words| (5, words.to_owned())));
    parts.extend(state.has_picture().then(|| (4, format!("{percent} %"))));
    parts.extend(state.own.map(|_| (6, "own view, 0 ends it".to_owned())));
    parts.push((1, "? keys".to_owned()));
    loop {
        let text = parts.iter().map(|(_, part)| part.as_str()).collect::<Vec<_>>().join("   ");
        let least = parts.iter().map(|(weight, _)| *weight).min();
        if parts.is_empty() || width(&text) <= room {
            return text;
        }
        parts.retain(|(weight, _)| Some(*weight) != least);
    }
}

#[cfg(test)]
mod tests {
    use super::super::words::Work;
    use super::*;
    use crate::base::problem::Problem;
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
        let below = |x: f64| Point::new(x, rail.y1 + 8.0);
        assert!(is_sign(&state, below(rail.x0 + 4.0)) && !is_sign(&state, below(60.0)));
        assert!(!is_sign(&state, rail.origin()), "the rail itself");
    }

    #[test]
    fn the_bar_tells_time_and_frame() {
        let mut state = state();
        state.transport.frame = 15.0;
        assert_eq!(times(&state)[0], "0.50 / 2.00 s   frame 15 / 60");
        state.transport.speed = 0.25;
        assert!(times(&state)[0].ends_with("frame 15 / 60   speed 0.25"));
        let letters = Letters::default();
        let width = |text: &str| letters.width(text, TEXT_PX);
        for text in times(&state) {
            assert_eq!(first_that_fits(times(&state), width(&text), width), text);
        }
        assert_eq!(first_that_fits(times(&state), 1.0, width), "");
        assert_eq!(right_text(&state, 999.0, width), "200 %   ? keys");
        state.take_camera(Some(&Default::default()), None);
        state.run("orbit-left");
        assert_eq!(right_text(&state, 999.0, width), "200 %   own view, 0 ends it   ? keys");
        assert_eq!(right_text(&state, width("own view, 0 ends it"), width), "own view, 0 ends it");
        state.run("own-view-off");
        (state.fps, state.transport.whole_frames) = (Some(59.97), true);
        assert_eq!(right_text(&state, 999.0, width), "whole frames   60 fps   200 %   ? keys");
        state.dropped = 7;
        assert_eq!(right_text(&state, 999.0, width), "whole frames   60 fps   7 dropped   200 %   ? keys");
        state.dropped = 0;
        (0..8).for_each(|_| state.thin.took(1.0));
        assert_eq!(right_text(&state, 999.0, width), "whole frames   60 fps   every fourth sprite   200 %   ? keys");
        state.thin = Default::default();
        state.under = Some("stone, triangle 7, 4.00 m".to_owned());
        assert!(right_text(&state, 999.0, width).starts_with("stone, triangle 7, 4.00 m   whole frames"));
        let narrow = width("stone, triangle 7, 4.00 m   own view, 0 ends it");
        state.run("orbit-left");
        assert_eq!(right_text(&state, narrow, width), "stone, triangle 7, 4.00 m   own view, 0 ends it");
        state.run("own-view-off");
        state.under = None;
        state.pointer = Some(Point::new(10.0, 43.0));
        for text in ["x 5.0  y 10.0   60 fps   200 %   ? keys", "x 5.0  y 10.0   200 %", "200 %", ""] {
            assert_eq!(right_text(&state, width(text), width), text);
        }
    }

    #[test]
    fn the_bar_says_the_most_important_thing() {
        let mut state = state();
        state.words.notice = Some("joined".into());
        state.select(Some("/face".into()), Some("face".into()));
        assert_eq!(said(&state), ("face   joined".into(), DIM));
        state.select(Some("/eye".into()), Some("face/eye".into()));
        assert_eq!(said(&state).0, "face/eye", "that has been read");
        state.words.notice = Some("joined".into());
        state.otherwise = Some("without 2 muted".into());
        assert_eq!(said(&state).0, "without 2 muted   face/eye   joined");
        state.passes = vec!["shade"];
        state.run("next-pass");
        assert_eq!(said(&state).0, "pass shade, D shows the next, Backspace the one before");
        state.sees_nothing = true;
        assert!(said(&state).0.starts_with("pass shade, D shows"), "an answer to a key comes first");
        state.run("field-wider");
        assert_eq!(said(&state).0, NOTHING);
        state.sees_nothing = false;
        state.run("view-seam");
        assert_eq!(said(&state).0, "pass shade", "how to go on is said once");
        state.run("pass color");
        assert!(said(&state).0.contains("frame 59 against 0"));
        state.words.reduced = Some("shown reduced".into());
        assert_eq!(said(&state), ("shown reduced".into(), WARNING));
        let work = Some(Work { what: "sending", is_long: true, percent: Some(34) });
        assert_eq!(said(&State { work, ..state.clone() }), ("shown reduced   sending: 34 %".into(), WARNING));
        state.words.follow_scene(vec![Problem::error("/images", "no picture")]);
        assert_eq!(said(&state).1, TEXT, "problems stand in a list of their own");
        state.words.put_away();
        assert_eq!(said(&state), ("images: no picture".into(), WARNING));
    }

    #[test]
    fn before_the_first_picture_the_bar_says_what_is_waited_for() {
        let mut state = State::default();
        assert_eq!(said(&state).0, "opening");
        state.work = Some(Work { what: "synthesising", is_long: false, percent: None });
        assert_eq!(said(&State { work: state.work, ..State::for_tests() }).0, "", "what may soon be done");
        state.work = Some(Work { what: "synthesising", is_long: true, percent: None });
        assert_eq!(said(&State { work: state.work, ..State::for_tests() }).0, "synthesising");
        assert_eq!(said(&state).0, "synthesising");
        state.work = Some(Work { what: "synthesising", is_long: true, percent: Some(34) });
        assert_eq!(said(&state).0, "synthesising: 34 %");
        assert_eq!(said(&State { work: state.work, ..State::for_tests() }).0, "synthesising: 34 %", "later ones too");
        for (pass, told) in [(None, "drawing the frame"), (Some("depth".to_owned()), "drawing the pass depth")] {
            assert_eq!(said(&State { drawing: true, pass, ..State::for_tests() }).0, told);
        }
        state.words.progress = Some("fetching sea.jpg: 34 %".into());
        assert_eq!(said(&state).0, "fetching sea.jpg: 34 %");
        state.words.progress = None;
        state.words.follow_link(vec![Problem::error("", "not a scene")]);
        assert_eq!(said(&state).0, "nothing to show yet");
    }

    #[test]
    fn a_message_that_does_not_fit_stands_above_the_bar_with_its_cure() {
        let letters = Letters::default();
        let cure = "there is no pass \"dept\" (did you mean \"depth\"?)".to_owned();
        for (width, fits) in [(200.0, false), (480.0, false), (1400.0, true)] {
            let mut state = State { no_pass: Some(cure.clone()), ..state() };
            state.resize(Size::new(width, 400.0), 1.0);
            let (mut canvas, area) = (Canvas::default(), state.area().to_rect());
            let free = whole(&mut canvas, &state, &letters, area);
            assert_eq!((free == area, canvas.strokes.is_empty()), (fits, fits), "{width}");
            let glyphs = canvas.strokes.iter().filter(|stroke| stroke.form == super::super::stroke::GLYPH);
            assert!(fits || glyphs.count() >= cure.chars().filter(|c| !c.is_whitespace()).count(), "{width}");
            assert!(canvas.strokes.iter().all(|s| s.b[0] <= width as f32 && f64::from(s.b[1]) <= area.y1), "{width}");
        }
        let mut state = State { work: Some(Work { what: "synthesising", is_long: true, percent: Some(3) }), ..state() };
        state.resize(Size::new(200.0, 400.0), 1.0);
        let area = state.area().to_rect();
        assert_eq!(whole(&mut Canvas::default(), &state, &letters, area), area);
    }

    #[test]
    fn nothing_lies_on_one_another_however_narrow_the_window_is() {
        let letters = Letters::default();
        for width in [80.0, 120.0, 200.0, 240.0, 320.0, 480.0, 960.0] {
            let mut state = State { selected: Some("face/left eye/motion/3".into()), ..state() };
            state.words.notice = Some("following the file".into());
            state.resize(Size::new(width, 400.0), 1.0);
            state.pointer = Some(Point::new(width / 2.0, 180.0));
            let mut canvas = Canvas::default();
            draw(&mut canvas, &state, &letters);
            let mut glyphs: Vec<_> = canvas.strokes.iter().filter(|s| s.form == super::super::stroke::GLYPH).collect();
            glyphs.sort_by(|a, b| a.a[0].total_cmp(&b.a[0]));
            assert!(glyphs.windows(2).all(|pair| pair[0].b[0] <= pair[1].a[0] + 2.0), "at {width}");
            assert!(glyphs.iter().all(|glyph| glyph.b[0] <= width as f32), "at {width}");
        }
    }
}
