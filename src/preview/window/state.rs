//! What the window shows, as a value: nothing here draws, waits or reads a clock. `run.rs` has the commands that change it.

use std::sync::Arc;

use kurbo::{Point, Size, Vec2};

use super::capture::Round;
use super::own_view::OwnView;
use super::thin::Thin;
use super::transport::Playhead;
use super::viewport::{Fit, Viewport};
use super::words::{Words, Work};
use crate::base::pointer::Pointer;
use crate::layers::parts::vectors::Reach;
use crate::layers::ready::Ready;
use crate::layers::space::camera::Camera;
use crate::layers::space::fit::Ball;
use crate::layers::timeline::Timeline;
use crate::preview::views::Switches;
use crate::render::sight::Sight;
use crate::scene::grips::Grip;

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
    /// The scene's camera, if layers in space are seen by it.
    pub camera: Option<Camera>,
    /// What is around all that is in space, as far as that is known.
    pub around: Option<Ball>,
    /// All layers, as they are ready.
    pub layers: Vec<Arc<dyn Ready>>,
    /// Where the window looks from, if that is not where the scene's camera does.
    pub own: Option<OwnView>,
    /// Whether nothing of the scene is in the frame from there.
    pub sees_nothing: bool,
    /// Zoom and place.
    pub viewport: Viewport,
    /// Playing.
    pub transport: Playhead,
    /// The scene's timeline.
    pub timeline: Timeline,
    /// Which overlays and other switches are on.
    pub switches: Switches,
    /// The passes in which the scene has something, in order.
    pub passes: Vec<&'static str>,
    /// The pass that is shown in place of the frame, as `NAME` or `NAME:LAYER`.
    pub pass: Option<String>,
    /// Why it cannot be shown.
    pub no_pass: Option<String>,
    /// What the colors of the pass that is shown mean, by names.
    pub named_colors: Vec<(String, [u8; 3])>,
    /// Whether the picture is still being made: an older one shows.
    pub drawing: bool,
    /// JSON pointer of what is selected in the editor.
    pub selection: Option<String>,
    /// The pointer on the screen, while it is in the window.
    pub pointer: Option<Point>,
    /// What is to be said.
    pub words: Words,
    /// What is being done to the scene beside the window, before it can be shown.
    pub work: Option<Work>,
    /// What lies over the picture.
    pub panel: Panel,
    /// How often the spacing of the field is doubled.
    pub field_step: i32,
    /// Which of the backgrounds is around the picture.
    pub background: usize,
    /// The border between still and moving, as a share of the picture, if `view-wipe` is on.
    pub wipe: f64,
    /// The point marked last, in pixels of the picture.
    pub marked: Option<Point>,
    /// Where the cursor of the editor's picture is, in pixels of the picture.
    pub cursor: Option<Point>,
    /// What the window shows is to be saved.
    pub screenshot: bool,
    /// What is being captured of it.
    pub capture: Option<Round>,
    /// Two corners of the box that the mouse draws, in pixels of the picture.
    pub band: Option<(Point, Point)>,
    /// What can be dragged.
    pub grips: Vec<Grip>,
    /// What is dragged by a grip, as a JSON pointer, and where it goes, in pixels of the picture.
    pub dragged: Option<(String, Point)>,
    /// The jump vector under the pointer, where what is shown of jump vectors asks for it.
    pub jump: Option<Vec2>,
    /// What stands under the pointer of layers in space.
    pub under: Option<String>,
    /// What is selected in the editor, for people.
    pub selected: Option<String>,
    /// That not all of the scene is shown, or something in its place.
    pub otherwise: Option<String>,
    /// What is seen in place of what the scene's camera sees.
    pub sight: Option<Sight>,
    /// Where the result is looked at from meanwhile, if that is not where the scene's camera does.
    pub aside: Option<OwnView>,
    /// Frames a second, while it plays.
    pub fps: Option<f64>,
    /// Frames of the scene that were not shown since it plays, though whole frames are to be.
    pub dropped: u64,
    /// Sprites that are left out, while it plays.
    pub thin: Thin,
    /// What is drawn as the longest arrow and in the fullest color, where a legend tells it.
    pub reach: Reach,
}

/// A list of keys over the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Panel {
    /// None.
    #[default]
    None,
    /// The view menu, until the next key.
    Menu,
    /// A page of all keys.
    Help(usize),
}

impl Default for State {
    fn default() -> Self {
        State {
            window: Size::ZERO,
            scale: 1.0,
            picture: Size::ZERO,
            camera: None,
            around: None,
            layers: Vec::new(),
            own: None,
            sees_nothing: false,
            viewport: Viewport::default(),
            transport: Playhead::default(),
            timeline: Timeline::default(),
            switches: Switches::default(),
            passes: Vec::new(),
            pass: None,
            no_pass: None,
            named_colors: Vec::new(),
            drawing: false,
            selection: None,
            pointer: None,
            words: Words::default(),
            work: None,
            panel: Panel::None,
            field_step: 0,
            background: 0,
            wipe: 0.5,
            marked: None,
            cursor: None,
            screenshot: false,
            capture: None,
            band: None,
            grips: Vec::new(),
            dragged: None,
            jump: None,
            under: None,
            selected: None,
            otherwise: None,
            sight: None,
            aside: None,
            fps: None,
            dropped: 0,
            thin: Thin::default(),
            reach: Reach::default(),
        }
    }
}

impl State {
    /// Takes what is selected, and its name. What was said of the link before something else was selected has been read.
    pub fn select(&mut self, pointer: Option<String>, name: Option<String>) {
        if self.selection.is_some() && self.selection != pointer {
            self.words.notice = None;
        }
        (self.selection, self.selected) = (pointer, name);
    }

    /// The part of the window in which the picture stands.
    pub fn area(&self) -> Size {
        Size::new(self.window.width, (self.window.height - (BAR_PX * self.scale).round()).max(1.0))
    }

    /// Whether an overlay or another switch is on, by its command.
    pub fn shows(&self, command: &str) -> bool {
        self.switches.is_on(command)
    }

    /// Whether there is a picture yet.
    pub fn has_picture(&self) -> bool {
        self.picture != Size::ZERO
    }

    /// Takes a new size of the window.
    pub fn resize(&mut self, window: Size, scale: f64) {
        (self.window, self.scale) = (window, scale);
        self.viewport.resized(self.picture, self.area());
    }

    /// Takes the size of a new picture and its timeline.
    pub fn load(&mut self, picture: Size, timeline: &Timeline) {
        let before = std::mem::replace(&mut self.picture, picture);
        if before == Size::ZERO {
            self.viewport.first(picture, self.area());
        } else if before != picture {
            self.viewport.fit(picture, self.area(), Fit::Window);
        }
        self.timeline = timeline.clone();
        self.transport.follow(timeline);
    }

    /// What the first picture waits for.
    pub fn waits_for(&self) -> String {
        match self.words.problems().next() {
            Some(_) => "nothing to show yet".to_owned(),
            None => self.work.map_or("opening".to_owned(), |work| work.to_string()),
        }
    }

    /// Zooms by steps about a place on the screen.
    pub fn zoom(&mut self, steps: i32, about: Point) {
        self.viewport.zoom_step(steps, about, self.picture, self.area());
    }

    /// Moves what is seen by a distance on the screen.
    pub fn pan(&mut self, by: Vec2) {
        self.viewport.pan(by, self.picture, self.area());
    }

    /// The place in the picture under the pointer; `None` if the pointer is not on the picture.
    pub fn pointed(&self) -> Option<Point> {
        let at = self.viewport.image_from_screen(self.pointer.filter(|p| p.y < self.area().height)?, self.area());
        self.picture.to_rect().contains(at).then_some(at)
    }

    /// Whether what a grip moves is selected in the editor, or belongs to that.
    pub fn selects(&self, grip: &Grip) -> bool {
        let selected = |at: &str| Pointer(at).is_within(&grip.pointer) || Pointer(&grip.pointer).is_within(at);
        self.selection.as_deref().is_some_and(|at| !at.is_empty() && selected(at))
    }

    /// Puts the border between still and moving at a place on the screen.
    pub fn drag_wipe(&mut self, x: f64) {
        let at = self.viewport.image_from_screen(Point::new(x, 0.0), self.area()).x;
        self.wipe = (at / self.picture.width.max(1.0)).clamp(0.0, 1.0);
    }

    /// Where the border between still and moving stands on the screen, if it is shown.
    pub fn wipe_at(&self) -> Option<f64> {
        let at = self.viewport.screen_from_image(Point::new(self.picture.width * self.wipe, 0.0), self.area());
        (self.shows("view-wipe") && !self.shows("view-seam")).then(|| at.x.round().clamp(0.0, self.window.width))
    }

    /// A picture of 320 x 200 pixels in a window where it stands at 200 %.
    #[cfg(test)]
    pub fn for_tests() -> State {
        let mut state = State::default();
        state.resize(Size::new(640.0, 434.0), 1.0);
        state.load(Size::new(320.0, 200.0), &Timeline::default());
        state
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_border_is_where_the_pointer_drags_it() {
        let mut state = State::for_tests();
        state.run("view-wipe");
        for (x, at) in [(160.0, 160.0), (-50.0, 0.0), (700.0, 640.0)] {
            state.drag_wipe(x);
            assert_eq!(state.wipe_at(), Some(at), "{x}");
        }
    }

    #[test]
    fn an_edit_keeps_the_view_and_another_picture_is_fitted() {
        let mut state = State::for_tests();
        state.run("zoom-in");
        let kept = state.viewport.clone();
        state.load(Size::new(320.0, 200.0), &Timeline::default());
        assert_eq!(state.viewport, kept);
        state.load(Size::new(100.0, 200.0), &Timeline::default());
        assert_ne!(state.viewport, kept);
    }

    #[test]
    fn a_zoom_that_was_asked_for_before_the_first_picture_lasts() {
        let mut state = State::default();
        state.resize(Size::new(640.0, 434.0), 1.0);
        state.run("zoom-one");
        state.load(Size::new(320.0, 200.0), &Timeline::default());
        assert_eq!((state.viewport.zoom, state.viewport.center), (1.0, Point::new(160.0, 100.0)));
    }

    #[test]
    fn the_pointer_tells_its_place_on_the_picture_only() {
        let mut state = State::for_tests();
        for (at, place) in [((10.0, 20.0), Some(Point::new(5.0, 10.0))), ((10.0, 420.0), None)] {
            state.pointer = Some(at.into());
            assert_eq!(state.pointed(), place, "{at:?}");
        }
    }
}
