//! What the window shows and how its commands change that. A value: nothing here draws, waits or reads a clock.

use kurbo::{Point, Size, Vec2};

use super::camera::{Camera, Fit};
use super::transport::Transport;
use super::words::Words;
use crate::base::maths::pow;
use crate::layers::timeline::{Timeline, Wrap};
use crate::preview::views;
use crate::render::overlay::{Samplers, View};

/// An arrow of the vector field stands about every so many logical pixels of the screen, unless keys change it, by so many
/// times twice or half.
const FIELD_PX: f64 = 22.0;
const FIELD_STEPS: std::ops::RangeInclusive<i32> = -2..=4;
/// A square of the field in colours, in logical pixels of the screen.
const WHEEL_PX: f64 = 4.0;
/// How often samplers are shown where they were before, and how far apart that is, as a share of the timeline.
const ONION: (u32, f64) = (6, 1.0 / 48.0);
/// A key moves the border between still and moving by this share of the picture.
const WIPE_STEP: f64 = 0.05;
/// A key pans by this share of the area.
const PAN: f64 = 0.1;
/// Height of the bar, in logical pixels.
pub const BAR_PX: f64 = 34.0;

/// All that a picture of the window depends on, besides the scene.
#[derive(Clone, Debug)]
pub struct State {
    /// Size of the window, in physical pixels.
    pub window: Size,
    /// Physical pixels a logical pixel.
    pub scale: f64,
    /// Size of the picture, in its pixels.
    pub picture: Size,
    /// Zoom and place.
    pub camera: Camera,
    /// Playing.
    pub transport: Transport,
    /// The scene's timeline.
    pub timeline: Timeline,
    /// Which overlays are shown; the spacing of the field is set by [`State::overlay_view`].
    pub shown: Shown,
    /// JSON pointer of what is selected in the editor.
    pub selection: Option<String>,
    /// The pointer on the screen, while it is in the window.
    pub pointer: Option<Point>,
    /// What is to be said.
    pub words: Words,
    /// What is being done to the scene beside the window, before it can be shown.
    pub work: Option<&'static str>,
    /// What lies over the picture.
    pub panel: Panel,
    /// How often the spacing of the field is doubled.
    pub field_step: i32,
    /// The border between still and moving, as a share of the picture; see [`Shown::wipe`].
    pub wipe: f64,
    /// The point marked last, in pixels of the picture.
    pub marked: Option<Point>,
    /// The jump vector under the pointer, where what is shown of jump vectors asks for it.
    pub jump: Option<Vec2>,
    /// What is selected in the editor, for people.
    pub selected: Option<String>,
    /// Frames a second, while it plays.
    pub fps: Option<f64>,
    /// Length of the field's arrows on the picture, as a share of the jump vectors.
    pub arrow_scale: f64,
    /// The longest jump vector, in pixels of the picture.
    pub longest: f64,
}

/// What can be switched on and off.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shown {
    /// Zone outlines.
    pub outlines: bool,
    /// Fold regions.
    pub regions: bool,
    /// Anchors.
    pub anchors: bool,
    /// Curves and lassos.
    pub curves: bool,
    /// The vector field as arrows.
    pub field: bool,
    /// The vector field as colours.
    pub wheel: bool,
    /// Jump paths.
    pub paths: bool,
    /// Where jump paths meet fold regions.
    pub thresholds: bool,
    /// Samplers at their effective places.
    pub samplers: bool,
    /// Samplers where they were before.
    pub onion: bool,
    /// Names and numbers.
    pub labels: bool,
    /// The pixel grid.
    pub grid: bool,
    /// The still picture instead of the moving one.
    pub still: bool,
    /// The still picture to the left of a border, the moving one to the right.
    pub wipe: bool,
    /// The difference of the last frame and the first, instead of a frame.
    pub seam: bool,
    /// A plain ground under transparency, not a checkerboard.
    pub plain: bool,
    /// No legends of what is shown of the vector field.
    pub no_legends: bool,
}

/// A list of keys over the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Panel {
    /// None.
    #[default]
    None,
    /// The view menu, until the next key.
    Menu,
    /// All keys.
    Help,
}

/// What a command asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// A new picture of the window.
    Redraw,
    /// The whole screen, or the window again.
    FullScreen,
    /// The window again, where it fills the screen.
    Window,
    /// The end.
    Quit,
    /// Nothing: the command is not one of the window's.
    Unknown,
}

impl Default for State {
    fn default() -> Self {
        State {
            window: Size::ZERO,
            scale: 1.0,
            picture: Size::ZERO,
            camera: Camera::default(),
            transport: Transport::default(),
            timeline: Timeline::default(),
            shown: Shown::default(),
            selection: None,
            pointer: None,
            words: Words::default(),
            work: None,
            panel: Panel::None,
            field_step: 0,
            wipe: 0.5,
            marked: None,
            jump: None,
            selected: None,
            fps: None,
            arrow_scale: 1.0,
            longest: 0.0,
        }
    }
}

impl State {
    /// The part of the window in which the picture stands.
    pub fn area(&self) -> Size {
        Size::new(self.window.width, (self.window.height - (BAR_PX * self.scale).round()).max(1.0))
    }

    /// Whether there is a picture yet.
    pub fn has_picture(&self) -> bool {
        self.picture != Size::ZERO
    }

    /// Takes a new size of the window.
    pub fn resize(&mut self, window: Size, scale: f64) {
        (self.window, self.scale) = (window, scale);
        self.camera.resized(self.picture, self.area());
    }

    /// Takes the size of a new picture and its timeline.
    pub fn load(&mut self, picture: Size, timeline: &Timeline) {
        let before = std::mem::replace(&mut self.picture, picture);
        if before == Size::ZERO {
            self.camera.first(picture, self.area());
        } else if before != picture {
            self.camera.fit(picture, self.area(), Fit::Window);
        }
        self.timeline = timeline.clone();
        self.transport.follow(timeline);
    }

    /// What the first picture waits for; nothing where it would wait in vain.
    pub fn waits_for(&self) -> Option<&'static str> {
        match self.words.problems().next() {
            Some(_) => Some("nothing to show yet"),
            None => self.work.or(Some("opening")),
        }
    }

    /// Runs a command by its name in the key table; behind the name of a switch may stand ` on` or ` off`.
    pub fn run(&mut self, command: &str) -> Outcome {
        if command != "view-menu" && self.panel == Panel::Menu {
            self.panel = Panel::None;
        }
        let (name, wanted) = views::wanted(command);
        if name == "view-whole-frames" {
            self.transport.whole_frames = wanted.unwrap_or(!self.transport.whole_frames);
            return Outcome::Redraw;
        }
        if let Some((switch, inverted)) = self.shown.switch(name) {
            *switch = wanted.map_or(!*switch, |on| on != inverted);
            return Outcome::Redraw;
        }
        let area = self.area();
        let about = self.pointer.filter(|p| p.y < area.height).unwrap_or((area.to_vec2() / 2.0).to_point());
        let pan = |x: f64, y: f64| Vec2::new(x * area.width * PAN, y * area.height * PAN);
        match command {
            "play" => self.transport.toggle(&self.timeline),
            "frame-back" => self.transport.step(-1, &self.timeline),
            "frame-on" => self.transport.step(1, &self.timeline),
            "first-frame" => self.transport.go_to(0.0, &self.timeline),
            "last-frame" => self.transport.go_to_end(&self.timeline),
            "slower" => self.transport.change_speed(-1),
            "faster" => self.transport.change_speed(1),
            "field-closer" => self.step_field(-1),
            "field-wider" => self.step_field(1),
            "wipe-left" => self.move_wipe(-WIPE_STEP),
            "wipe-right" => self.move_wipe(WIPE_STEP),
            "mark-point" => self.marked = self.pointed(),
            "zoom-in" => self.zoom(1, about),
            "zoom-out" => self.zoom(-1, about),
            "zoom-fit" => self.camera.fit(self.picture, area, Fit::Window),
            "zoom-whole" => self.camera.fit(self.picture, area, Fit::Whole),
            "zoom-one" => self.camera.one(self.picture, area),
            "pan-left" => self.pan(pan(-1.0, 0.0)),
            "pan-right" => self.pan(pan(1.0, 0.0)),
            "pan-up" => self.pan(pan(0.0, -1.0)),
            "pan-down" => self.pan(pan(0.0, 1.0)),
            "view-menu" => self.panel = Panel::Menu,
            "help" => self.panel = if self.panel == Panel::Help { Panel::None } else { Panel::Help },
            "close-panel" => return self.close(),
            "view-full-screen" => return Outcome::FullScreen,
            "select-point" => {} // the editor's answer is a selection
            "quit" => return Outcome::Quit,
            _ => return Outcome::Unknown,
        }
        Outcome::Redraw
    }

    /// Zooms by steps about a place on the screen.
    pub fn zoom(&mut self, steps: i32, about: Point) {
        self.camera.zoom_step(steps, about, self.picture, self.area());
    }

    /// Moves what is seen by a distance on the screen.
    pub fn pan(&mut self, by: Vec2) {
        self.camera.pan(by, self.picture, self.area());
    }

    /// Closes what lies over the picture; where nothing does, the full screen.
    fn close(&mut self) -> Outcome {
        let panel = std::mem::take(&mut self.panel) != Panel::None;
        let marked = self.marked.take().is_some();
        if panel || marked || self.words.put_away() { Outcome::Redraw } else { Outcome::Window }
    }

    /// Whether a switch is on; `None` if the command is no switch that all windows are to show alike.
    pub fn is_on(&mut self, command: &str) -> Option<bool> {
        if command == "view-whole-frames" {
            return Some(self.transport.whole_frames);
        }
        self.shown.switch(command).map(|(switch, inverted)| *switch != inverted)
    }

    /// The place in the picture under the pointer, where it is on the picture.
    pub fn pointed(&self) -> Option<Point> {
        let at = self.camera.image_from_screen(self.pointer.filter(|p| p.y < self.area().height)?, self.area());
        self.picture.to_rect().contains(at).then_some(at)
    }

    fn step_field(&mut self, by: i32) {
        self.field_step = (self.field_step + by).clamp(*FIELD_STEPS.start(), *FIELD_STEPS.end());
    }

    fn move_wipe(&mut self, by: f64) {
        self.shown.wipe = true;
        self.wipe = (self.wipe + by).clamp(0.0, 1.0);
    }

    /// Puts the border between still and moving at a place on the screen.
    pub fn drag_wipe(&mut self, x: f64) {
        let at = self.camera.image_from_screen(Point::new(x, 0.0), self.area()).x;
        self.wipe = (at / self.picture.width.max(1.0)).clamp(0.0, 1.0);
    }

    /// The border between still and moving on the screen, where it is shown.
    pub fn wipe_at(&self) -> Option<f64> {
        let at = self.camera.screen_from_image(Point::new(self.picture.width * self.wipe, 0.0), self.area());
        (self.shown.wipe && !self.shown.seam).then(|| at.x.round().clamp(0.0, self.window.width))
    }

    /// Pixels of the picture between two of those whose jump vectors are shown, when they are about `px` logical pixels
    /// of the screen apart: a power of two.
    fn spacing(&self, px: f64) -> f64 {
        let wanted = px * self.scale / self.camera.zoom;
        (0..24).map(|k| f64::from(1 << k)).find(|&s| s >= wanted).unwrap_or(wanted)
    }

    /// The samplers that are shown: now, and where they were before.
    pub fn samplers(&self) -> Option<Samplers> {
        let now = self.transport.scene_time(&self.timeline);
        let before = (1..=ONION.0).map(|k| now - f64::from(k) * ONION.1);
        let before = before.filter_map(|t| match self.timeline.wrap {
            Wrap::Once => (t >= 0.0).then_some(t),
            Wrap::Repeat | Wrap::PingPong => Some(t.rem_euclid(1.0)),
        });
        let before = before.filter(|_| self.shown.onion);
        let shown = self.shown.samplers || self.shown.onion;
        shown.then(|| Samplers { spacing: self.field_spacing(), times: std::iter::once(now).chain(before).collect() })
    }

    /// Pixels of the picture between two arrows of the field, two jump paths or two samplers.
    pub fn field_spacing(&self) -> f64 {
        self.spacing(FIELD_PX * pow(2.0, f64::from(self.field_step)))
    }

    /// Whether anything is shown of the jump vectors of pixels.
    pub fn shows_jumps(&self) -> bool {
        let shown = &self.shown;
        shown.field || shown.wheel || shown.paths || shown.samplers || shown.onion || shown.thresholds
    }

    /// What the overlay shows but the samplers, its field as dense as the screen bears.
    pub fn overlay_view(&self) -> View {
        let spacing = Some(self.field_spacing());
        View {
            outlines: self.shown.outlines,
            regions: self.shown.regions,
            anchors: self.shown.anchors,
            curves: self.shown.curves,
            labels: self.shown.labels,
            field: spacing.filter(|_| self.shown.field),
            wheel: self.shown.wheel.then(|| self.spacing(WHEEL_PX)),
            paths: spacing.filter(|_| self.shown.paths),
            thresholds: spacing.filter(|_| self.shown.thresholds),
            samplers: None,
            selection: self.selection.clone(),
        }
    }
}

impl Shown {
    /// What a command switches, and whether that is on where it is not set.
    fn switch(&mut self, command: &str) -> Option<(&mut bool, bool)> {
        let switch = match command {
            "view-outlines" => &mut self.outlines,
            "view-regions" => &mut self.regions,
            "view-anchors" => &mut self.anchors,
            "view-curves" => &mut self.curves,
            "view-field" => &mut self.field,
            "view-wheel" => &mut self.wheel,
            "view-paths" => &mut self.paths,
            "view-thresholds" => &mut self.thresholds,
            "view-samplers" => &mut self.samplers,
            "view-onion" => &mut self.onion,
            "view-wipe" => &mut self.wipe,
            "view-seam" => &mut self.seam,
            "view-labels" => &mut self.labels,
            "view-grid" => &mut self.grid,
            "view-still" => &mut self.still,
            "view-checkerboard" => &mut self.plain,
            "view-legends" => &mut self.no_legends,
            _ => return None,
        };
        Some((switch, ["view-checkerboard", "view-legends"].contains(&command)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preview::keys::KEYS;

    fn state() -> State {
        let mut state = State::default();
        state.resize(Size::new(640.0, 434.0), 1.0);
        state.load(Size::new(320.0, 200.0), &Timeline::default());
        state
    }

    #[test]
    fn every_command_of_the_key_table_is_known() {
        for row in KEYS {
            assert_ne!(state().run(row.command), Outcome::Unknown, "{row:?}");
        }
        assert_eq!(state().run("sing"), Outcome::Unknown);
    }

    #[test]
    fn a_switch_is_turned_or_set() {
        let mut state = state();
        for (command, outlines) in [
            ("view-outlines", true),
            ("view-outlines on", true),
            ("view-outlines off", false),
            ("view-outlines off", false),
        ] {
            assert_eq!(state.run(command), Outcome::Redraw);
            assert_eq!(state.shown.outlines, outlines, "{command}");
        }
        state.run("view-checkerboard off");
        assert!(state.shown.plain);
        state.run("view-legends");
        assert!(state.shown.no_legends);
        assert_eq!(state.run("zoom-in on"), Outcome::Unknown);
    }

    #[test]
    fn esc_closes_one_thing_after_the_other() {
        let mut state = State { panel: Panel::Help, marked: Some(Point::ZERO), ..state() };
        state.words.follow_scene(vec![crate::base::problem::Problem::error("", "wrong")]);
        assert_eq!((state.run("close-panel"), state.panel, state.marked), (Outcome::Redraw, Panel::None, None));
        assert_eq!((state.run("close-panel"), state.words.listed().len()), (Outcome::Redraw, 0));
        assert_eq!(state.run("close-panel"), Outcome::Window);
    }

    #[test]
    fn the_border_is_where_the_pointer_drags_it() {
        let mut state = state();
        state.run("view-wipe");
        for (x, at) in [(160.0, 160.0), (-50.0, 0.0), (700.0, 640.0)] {
            state.drag_wipe(x);
            assert_eq!(state.wipe_at(), Some(at), "{x}");
        }
    }

    #[test]
    fn the_menu_is_gone_with_the_next_key() {
        let mut state = state();
        state.run("view-menu");
        state.run("view-outlines");
        assert_eq!((state.panel, state.shown.outlines), (Panel::None, true));
    }

    #[test]
    fn an_edit_keeps_the_view_and_another_picture_is_fitted() {
        let mut state = state();
        state.run("zoom-in");
        let kept = state.camera.clone();
        state.load(Size::new(320.0, 200.0), &Timeline::default());
        assert_eq!(state.camera, kept);
        state.load(Size::new(100.0, 200.0), &Timeline::default());
        assert_ne!(state.camera, kept);
    }

    #[test]
    fn a_zoom_that_was_asked_for_before_the_first_picture_lasts() {
        let mut state = State::default();
        state.resize(Size::new(640.0, 434.0), 1.0);
        state.run("zoom-one");
        state.load(Size::new(320.0, 200.0), &Timeline::default());
        assert_eq!((state.camera.zoom, state.camera.center), (1.0, Point::new(160.0, 100.0)));
    }

    #[test]
    fn the_field_keeps_its_distance_on_the_screen() {
        let mut state = state();
        state.shown.field = true;
        for _ in 0..16 {
            let on_screen = state.overlay_view().field.unwrap() * state.camera.zoom;
            assert!(on_screen >= FIELD_PX, "{on_screen}");
            state.run("zoom-out");
        }
    }

    #[test]
    fn the_pointer_tells_its_place_on_the_picture_only() {
        let mut state = state();
        for (at, place) in [((10.0, 20.0), Some(Point::new(5.0, 10.0))), ((10.0, 420.0), None)] {
            state.pointer = Some(at.into());
            assert_eq!(state.pointed(), place, "{at:?}");
        }
    }
}
