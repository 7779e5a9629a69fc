//! The mouse: what it drags, clicks and turns. A value beside the state; nothing here reads a clock or knows a window.

use std::time::{Duration, Instant};

use kurbo::Point;

use super::bar;
use super::grasp::{CLICK_PX, Grasp, Held, REACH_PX, grip_at};
use super::state::State;

/// Two clicks within this time, at about the same place, are a double click.
const DOUBLE: Duration = Duration::from_millis(400);

/// What the window is to do, besides what has changed in the state.
#[derive(Clone, Debug, PartialEq)]
pub enum Asked {
    /// Nothing.
    Nothing,
    /// Play or pause.
    Play,
    /// Select what stands there in the picture.
    Select(Point),
    /// Go to what is at this JSON pointer.
    Take(String),
    /// Move what is at this JSON pointer to a place of the picture; the drag has ended.
    Drop(String, Point),
    /// Select what stands between two corners of the picture.
    Band(Point, Point),
    /// Fit the picture into the window.
    Fit,
}

/// What the pointer looks like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shape {
    #[default]
    Arrow,
    /// Something to be pressed.
    Hand,
    /// Something to be moved to the left and the right.
    Across,
    /// The picture, while it is moved.
    Held,
}

/// What the pressed button moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Drag {
    #[default]
    Nothing,
    Picture,
    /// The window's own camera, round its target.
    Round,
    /// The same, sideways and up.
    Along,
    Time,
    Border,
    /// The corner of a box; see [`State::band`].
    Band,
    /// See [`Mouse::dragged`].
    Grip,
}

/// Which button.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    Left,
    Middle,
    Right,
}

/// See the top of the file.
#[derive(Debug, Default)]
pub struct Mouse {
    drag: Drag,
    /// Where the left button went down on the picture, as long as that may become a click.
    pressed_at: Option<Point>,
    dragged: Option<Grasp>,
    /// When and where the last click was.
    clicked: Option<(Instant, Point)>,
    /// The fraction of a wheel step that has been turned so far.
    turned: f64,
    /// Keys that are held with it.
    held: Held,
    /// The first of two reports of one notch was counted.
    half_heard: bool,
}

impl Mouse {
    /// Whether the time is dragged: then this window leads.
    pub fn drags_time(&self) -> bool {
        self.drag == Drag::Time
    }

    /// Whether something is dragged by a grip.
    pub fn drags_grip(&self) -> bool {
        self.drag == Drag::Grip
    }

    /// What a drag that goes on has moved, and where to, if that has not been told yet.
    pub fn moves(&mut self) -> Option<(&str, Point)> {
        let dragged = self.dragged.as_mut()?;
        let to = dragged.untold()?;
        Some((dragged.pointer(), to))
    }

    /// Ends a drag by a grip as if it had not been; whether there was one.
    pub fn lets_go(&mut self, state: &mut State) -> bool {
        state.dragged = None;
        let dragged = self.dragged.take();
        if dragged.is_some() {
            self.drag = Drag::Nothing;
        }
        dragged.is_some()
    }

    /// Other keys are held with it.
    pub fn hold(&mut self, held: Held) {
        self.held = held;
    }

    /// The pointer is at a place, or has left.
    pub fn moved(&mut self, state: &mut State, at: Option<Point>) {
        let before = std::mem::replace(&mut state.pointer, at);
        match (self.drag, before, at) {
            (Drag::Picture, Some(from), Some(to)) => match self.pressed_at {
                // It may be a click.
                Some(pressed) if pressed.distance(to) <= CLICK_PX * state.scale => {}
                pressed => {
                    self.pressed_at = None;
                    state.pan(pressed.unwrap_or(from) - to);
                }
            },
            (Drag::Round, Some(from), Some(to)) => state.drag_round(to - from),
            (Drag::Along, Some(from), Some(to)) => state.drag_along(to - from),
            (Drag::Time, _, Some(to)) => scrub(state, to.x),
            (Drag::Border, _, Some(to)) => state.drag_wipe(to.x),
            (Drag::Band, _, Some(to)) => {
                let to = state.viewport.image_from_screen(to, state.area());
                state.band = state.band.map(|(from, _)| (from, to));
            }
            (Drag::Grip, _, Some(to)) => self.dragged.iter_mut().for_each(|grasp| grasp.follow(state, self.held, to)),
            // Nothing is held, or the pointer comes or goes.
            (Drag::Nothing | Drag::Picture | Drag::Round | Drag::Along, ..) => {}
            (Drag::Time | Drag::Border | Drag::Band | Drag::Grip, ..) => {}
        }
    }

    /// A button goes down.
    pub fn pressed(&mut self, state: &mut State, button: Button) -> Asked {
        state.words.told = None;
        let Some(at) = state.pointer else { return Asked::Nothing };
        if at.y < state.area().height {
            let grip = grip_at(state, at, self.held.draws_out()).filter(|_| button == Button::Left);
            self.drag = match button {
                Button::Right => Drag::Band,
                Button::Left if on_border(state, at) => Drag::Border,
                Button::Left if grip.is_some() => Drag::Grip,
                _ if state.camera.is_some() && self.held.shift => Drag::Along,
                Button::Middle if state.camera.is_some() => Drag::Round,
                Button::Left if state.camera.is_some() && self.held.goes_round() => Drag::Round,
                _ => Drag::Picture,
            };
            self.dragged = grip.filter(|_| self.drag == Drag::Grip).map(|grip| Grasp::new(grip, at, state));
            let corner = state.viewport.image_from_screen(at, state.area());
            state.band = (self.drag == Drag::Band).then_some((corner, corner));
            self.pressed_at = (button == Button::Left && self.drag == Drag::Picture).then_some(at);
        } else if button == Button::Left {
            if bar::is_sign(state, at) {
                return Asked::Play;
            }
            self.drag = Drag::Time;
            scrub(state, at.x);
        }
        Asked::Nothing
    }

    /// A button comes up; if the pointer has hardly moved since it went down, that was a click.
    pub fn released(&mut self, state: &mut State, now: Instant) -> Asked {
        self.drag = Drag::Nothing;
        if let Some((from, to)) = state.band.take() {
            return if from.distance(to) * state.viewport.zoom > CLICK_PX * state.scale {
                Asked::Band(from, to)
            } else {
                Asked::Nothing
            };
        }
        if let Some(grasp) = self.dragged.take() {
            return match state.dragged.take() {
                Some((pointer, at)) => Asked::Drop(pointer, at),
                None if grasp.moves => Asked::Nothing,
                None => Asked::Take(grasp.pointer().to_owned()),
            };
        }
        let (Some(_), Some(to)) = (self.pressed_at.take(), state.pointer) else { return Asked::Nothing };
        let near = |place: Point| place.distance(to) <= 2.0 * CLICK_PX * state.scale;
        let before = self.clicked.replace((now, to));
        if before.is_some_and(|(then, place)| now.saturating_duration_since(then) <= DOUBLE && near(place)) {
            self.clicked = None;
            return Asked::Fit;
        }
        state.pointed().map_or(Asked::Nothing, Asked::Select)
    }

    /// The wheel or a touchpad turned by `steps`: whole steps zoom about the pointer, with Alt they move the camera; fractions are kept until they add up to
    /// one.
    pub fn turned(&mut self, state: &mut State, steps: f64) {
        state.words.told = None;
        if steps * self.turned < 0.0 {
            self.turned = 0.0;
        }
        self.turned += steps;
        // A hair less than a step is one: parts of steps do not add up exactly.
        let whole = (self.turned + 1e-6_f64.copysign(self.turned)).trunc();
        self.turned -= whole;
        let whole = whole.clamp(-64.0, 64.0) as i32;
        if whole != 0 && self.held.goes_round() && state.camera.is_some() {
            state.wheel_nearer(whole);
        } else if whole != 0 {
            let middle = (state.area().to_vec2() / 2.0).to_point();
            state.zoom(whole, state.pointer.unwrap_or(middle));
        }
    }

    /// Whether a notch of the wheel counts: if each is reported twice, only the first report does.
    pub fn counts(&mut self, comes_twice: bool) -> bool {
        self.half_heard = comes_twice && !self.half_heard;
        !comes_twice || self.half_heard
    }

    /// What the pointer is to look like.
    pub fn shape(&self, state: &State) -> Shape {
        match (self.drag, state.pointer) {
            (Drag::Border, _) => Shape::Across,
            (Drag::Band, _) => Shape::Arrow,
            (Drag::Picture | Drag::Round | Drag::Along | Drag::Grip, _) => Shape::Held,
            (Drag::Nothing, Some(at)) if at.y >= state.area().height && bar::is_sign(state, at) => Shape::Hand,
            (Drag::Nothing, Some(at)) if on_border(state, at) => Shape::Across,
            (Drag::Nothing, Some(at)) if grip_at(state, at, false).is_some() => Shape::Hand,
            (Drag::Nothing | Drag::Time, _) => Shape::Arrow,
        }
    }
}

fn on_border(state: &State, at: Point) -> bool {
    let reach = REACH_PX * state.scale;
    at.y < state.area().height && state.wipe_at().is_some_and(|x| (x - at.x).abs() <= reach)
}

fn scrub(state: &mut State, x: f64) {
    let frame = bar::frame_at(state, x);
    state.transport.go_to(frame, &state.timeline);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::space::camera::Camera;
    use crate::scene::grips::Grip;

    /// Presses at one place, moves through the others, lets go at the last.
    fn drag(mouse: &mut Mouse, state: &mut State, button: Button, places: &[(f64, f64)], at: Instant) -> Asked {
        mouse.moved(state, Some(places[0].into()));
        let asked = mouse.pressed(state, button);
        places.iter().for_each(|&place| mouse.moved(state, Some(place.into())));
        match mouse.released(state, at) {
            Asked::Nothing => asked,
            asked => asked,
        }
    }

    #[test]
    fn in_space_the_middle_button_goes_round_and_shift_moves_along() {
        let (now, scene) = (Instant::now(), Camera::default());
        let (mut mouse, mut state) = (Mouse::default(), State::for_tests());
        state.take_camera(Some(&scene), None);
        let across = [(100.0, 100.0), (150.0, 100.0)];
        for (button, alt, shift) in [
            (Button::Middle, false, false),
            (Button::Left, true, false),
            (Button::Left, false, true),
            (Button::Middle, false, true),
        ] {
            state.run("own-view-off");
            mouse.hold(Held { alt, shift, ctrl: false });
            assert_eq!(drag(&mut mouse, &mut state, button, &across, now), Asked::Nothing);
            let own = state.own_camera().unwrap();
            assert_ne!(own.position, scene.position, "{button:?} {alt} {shift}");
            assert_eq!(own.target != scene.target, shift, "{button:?} {alt} {shift}");
        }
        state.run("own-view-off");
        mouse.hold(Held::default());
        drag(&mut mouse, &mut state, Button::Left, &across, now);
        mouse.turned(&mut state, 1.0);
        assert_eq!(state.own_camera(), None, "these move the picture");
        mouse.hold(Held { alt: true, ..Held::default() });
        let zoom = state.viewport.zoom;
        mouse.turned(&mut state, 1.0);
        assert!(state.own_camera().unwrap().position[2] < scene.position[2] && state.viewport.zoom == zoom);
    }

    #[test]
    fn a_vector_without_length_is_drawn_out_of_its_place_with_alt() {
        let now = Instant::now();
        let (mut mouse, mut state) = (Mouse::default(), State::for_tests());
        let at = Point::new(100.0, 60.0);
        let grip = |pointer: &str, from| Grip { pointer: pointer.to_owned(), at, from };
        state.grips = vec![grip("/at", None), grip("/in", Some(at)), grip("/out", Some(at))];
        let on_screen = state.viewport.screen_from_image(at, state.area());
        let far = [(on_screen.x, on_screen.y), (on_screen.x + 40.0, on_screen.y)];
        for (alt, pointer) in [(false, "/at"), (true, "/out")] {
            mouse.hold(Held { alt, ..Held::default() });
            let dragged = drag(&mut mouse, &mut state, Button::Left, &far, now);
            assert_eq!(dragged, Asked::Drop(pointer.to_owned(), Point::new(120.0, 60.0)), "{alt}");
        }
    }

    #[test]
    fn what_is_pressed_is_what_is_moved() {
        let now = Instant::now();
        let (mut mouse, mut state) = (Mouse::default(), State::for_tests());
        let place = |state: &State| state.viewport.origin(state.area());
        let origin = place(&state);
        let across = [(100.0, 100.0), (150.0, 110.0)];
        assert_eq!(drag(&mut mouse, &mut state, Button::Left, &across, now), Asked::Nothing);
        assert_eq!((place(&state) - origin).x, 50.0);
        assert_eq!(drag(&mut mouse, &mut state, Button::Middle, &across, now), Asked::Nothing);
        assert_eq!((place(&state) - origin).x, 100.0);
        state.run("zoom-fit");
        state.run("view-wipe");
        assert_eq!(drag(&mut mouse, &mut state, Button::Left, &[(322.0, 90.0), (160.0, 95.0)], now), Asked::Nothing);
        assert_eq!((state.wipe, place(&state)), (0.25, origin));
        drag(&mut mouse, &mut state, Button::Left, &[(60.0, 408.0), (9999.0, 408.0)], now);
        assert_eq!(state.transport.frame, 59.0);
        assert_eq!(drag(&mut mouse, &mut state, Button::Left, &[(16.0, 424.0)], now), Asked::Play);
        assert_eq!(state.transport.frame, 59.0, "the sign is no place on the rail");
        assert_eq!(drag(&mut mouse, &mut state, Button::Middle, &[(60.0, 408.0)], now), Asked::Nothing);
    }

    #[test]
    fn a_click_selects_and_two_fit() {
        let now = Instant::now();
        let (mut mouse, mut state) = (Mouse::default(), State::for_tests());
        let later = |ms| now + Duration::from_millis(ms);
        let at = |mouse: &mut Mouse, state: &mut State, x: f64, ms| {
            drag(mouse, state, Button::Left, &[(x, 100.0), (x + 2.0, 100.0)], later(ms))
        };
        let select = |x: f64| Asked::Select(Point::new(x, 50.0));
        assert_eq!(at(&mut mouse, &mut state, 100.0, 0), select(51.0));
        assert_eq!(at(&mut mouse, &mut state, 101.0, 200), Asked::Fit);
        assert_eq!(at(&mut mouse, &mut state, 101.0, 300), select(51.5), "a third click is a first one");
        assert_eq!(at(&mut mouse, &mut state, 201.0, 400), select(101.5), "elsewhere");
        assert_eq!(at(&mut mouse, &mut state, 201.0, 1400), select(101.5), "too late");
        assert_eq!(drag(&mut mouse, &mut state, Button::Middle, &[(201.0, 100.0)], later(1500)), Asked::Nothing);
    }

    #[test]
    fn the_wheel_zooms_by_what_it_sends() {
        let (mut mouse, mut state) = (Mouse::default(), State::for_tests());
        state.run("zoom-one");
        for (turns, percent) in [
            (&[1.0][..], 141),
            (&[-1.0], 100),
            (&[0.1; 9], 100),
            (&[0.1], 141),
            (&[0.5, -0.9], 141),
            (&[-0.1], 100),
            (&[0.05; 20], 141),
            (&[-3.0], 50),
        ] {
            turns.iter().for_each(|&steps| mouse.turned(&mut state, steps));
            assert_eq!((state.viewport.zoom * 100.0).round() as i32, percent, "{turns:?}");
        }
    }

    #[test]
    fn a_notch_that_comes_twice_counts_once() {
        let mut mouse = Mouse::default();
        let heard: Vec<bool> = [true, true, true, true, false, false, true].map(|twice| mouse.counts(twice)).into();
        assert_eq!(heard, [true, false, true, false, true, true, true]);
    }

    #[test]
    fn a_grip_is_dropped_where_the_button_comes_up() {
        let now = Instant::now();
        let (mut mouse, mut state) = (Mouse::default(), State::for_tests());
        // The picture stands at 200 %.
        let grip = |pointer: &str, x| Grip { pointer: pointer.into(), at: Point::new(x, 50.0), from: None };
        state.grips = vec![grip("/a", 50.0), grip("/b", 52.0)];
        let origin = state.viewport.origin(state.area());
        let mut dragged =
            |from: f64, to: (f64, f64)| drag(&mut mouse, &mut state, Button::Left, &[(from, 100.0), to], now);
        assert_eq!(dragged(105.0, (200.0, 60.0)), Asked::Drop("/b".into(), Point::new(99.5, 30.0)));
        assert_eq!(dragged(97.0, (200.0, 60.0)), Asked::Drop("/a".into(), Point::new(101.5, 30.0)), "it does not jump");
        assert_eq!(dragged(97.0, (98.0, 101.0)), Asked::Take("/a".into()), "a click");
        state.selection = Some("/b".into());
        let mut dragged =
            |from: f64, to: (f64, f64)| drag(&mut mouse, &mut state, Button::Left, &[(from, 100.0), to], now);
        assert_eq!(
            dragged(99.0, (98.0, 101.0)),
            Asked::Take("/b".into()),
            "what is selected, though another is nearer"
        );
        state.selection = None;
        let mut dragged =
            |from: f64, to: (f64, f64)| drag(&mut mouse, &mut state, Button::Left, &[(from, 100.0), to], now);
        assert_eq!(dragged(97.0, (9999.0, 60.0)), Asked::Nothing, "beside the picture");
        assert_eq!(state.viewport.origin(state.area()), origin, "the picture stays");
        mouse.moved(&mut state, Some((97.0, 100.0).into()));
        mouse.pressed(&mut state, Button::Left);
        mouse.moved(&mut state, Some((200.0, 60.0).into()));
        assert_eq!(state.dragged, Some(("/a".to_owned(), Point::new(101.5, 30.0))), "it is seen under the pointer");
        assert_eq!(mouse.moves(), Some(("/a", Point::new(101.5, 30.0))));
        assert_eq!(mouse.moves(), None, "that is told");
        for (shift, ctrl, at) in
            [(true, false, (101.5, 50.0)), (false, true, (55.15, 48.0)), (false, false, (101.5, 30.0))]
        {
            mouse.hold(Held { shift, alt: false, ctrl });
            mouse.moved(&mut state, Some((200.0, 60.0).into()));
            assert_eq!(state.dragged, Some(("/a".to_owned(), at.into())), "{shift} {ctrl}");
            assert_eq!(mouse.moves(), Some(("/a", at.into())), "{shift} {ctrl}");
        }
        mouse.released(&mut state, now);
        assert_eq!(state.dragged, None);
        mouse.moved(&mut state, Some((97.0, 100.0).into()));
        mouse.pressed(&mut state, Button::Left);
        mouse.moved(&mut state, Some((200.0, 60.0).into()));
        assert!(mouse.lets_go(&mut state) && state.dragged.is_none() && !mouse.lets_go(&mut state));
        assert_eq!(mouse.released(&mut state, now), Asked::Nothing, "it was let go");
        assert_eq!(drag(&mut mouse, &mut state, Button::Middle, &[(97.0, 100.0), (90.0, 100.0)], now), Asked::Nothing);
        assert_ne!(state.viewport.origin(state.area()), origin, "the middle button moves it");
    }

    #[test]
    fn the_right_button_draws_a_box() {
        let now = Instant::now();
        let (mut mouse, mut state) = (Mouse::default(), State::for_tests());
        let asked = drag(&mut mouse, &mut state, Button::Right, &[(20.0, 40.0), (60.0, 100.0)], now);
        assert_eq!((asked, state.band), (Asked::Band(Point::new(10.0, 20.0), Point::new(30.0, 50.0)), None));
        assert_eq!(drag(&mut mouse, &mut state, Button::Right, &[(20.0, 40.0), (21.0, 40.0)], now), Asked::Nothing);
    }

    #[test]
    fn the_pointer_shows_what_can_be_done() {
        let (mut mouse, mut state) = (Mouse::default(), State::for_tests());
        state.run("view-wipe");
        for (at, shape) in [
            ((100.0, 100.0), Shape::Arrow),
            ((325.0, 100.0), Shape::Across),
            ((16.0, 424.0), Shape::Hand),
            ((100.0, 424.0), Shape::Arrow),
        ] {
            mouse.moved(&mut state, Some(at.into()));
            assert_eq!(mouse.shape(&state), shape, "{at:?}");
        }
    }
}
