//! What the window shows and how its commands change that. A value: nothing here draws, waits or reads a clock.

use kurbo::{Point, Size, Vec2};

use super::camera::Camera;
use super::transport::Transport;
use crate::layers::timeline::Timeline;
use crate::render::overlay::View;

/// An arrow of the vector field stands about every so many logical pixels of the screen.
const FIELD_PX: f64 = 22.0;
/// A key pans by this share of the area.
const PAN: f64 = 0.1;
/// Height of the bar, in logical pixels.
pub const BAR_PX: f64 = 34.0;

/// All that a picture of the window depends on, besides the scene.
#[derive(Clone, Debug, Default)]
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
    /// How the window is connected: a line for the person.
    pub notice: Option<String>,
    /// What is wrong with the scene: a line for the person, before the notice.
    pub problem: Option<String>,
    /// What lies over the picture.
    pub panel: Panel,
    /// Length of the field's arrows on the picture, as a share of the jump vectors.
    pub arrow_scale: f64,
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
    /// The vector field.
    pub field: bool,
    /// Names and numbers.
    pub labels: bool,
    /// The pixel grid.
    pub grid: bool,
    /// The still picture instead of the moving one.
    pub still: bool,
    /// A plain ground under transparency, not a checkerboard.
    pub plain: bool,
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
    /// The end.
    Quit,
    /// Nothing: the command is not one of the window's.
    Unknown,
}

impl State {
    /// The part of the window in which the picture stands.
    pub fn area(&self) -> Size {
        Size::new(self.window.width, (self.window.height - (BAR_PX * self.scale).round()).max(1.0))
    }

    /// Takes a new size of the window.
    pub fn resize(&mut self, window: Size, scale: f64) {
        (self.window, self.scale) = (window, scale);
        self.camera.resized(self.picture, self.area());
    }

    /// Takes the size of a new picture and its timeline.
    pub fn load(&mut self, picture: Size, timeline: &Timeline) {
        if self.picture != picture {
            self.picture = picture;
            self.camera.fit(picture, self.area());
        }
        self.timeline = timeline.clone();
        self.transport.follow(timeline);
    }

    /// Runs a command by its name in the key table.
    pub fn run(&mut self, command: &str) -> Outcome {
        if command != "view-menu" && self.panel == Panel::Menu {
            self.panel = Panel::None;
        }
        if let Some(switch) = self.shown.switch(command) {
            *switch = !*switch;
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
            "zoom-in" => self.camera.zoom_step(1, about, area),
            "zoom-out" => self.camera.zoom_step(-1, about, area),
            "zoom-fit" => self.camera.fit(self.picture, area),
            "zoom-one" => self.camera.one(self.picture, area),
            "pan-left" => self.camera.pan(pan(-1.0, 0.0)),
            "pan-right" => self.camera.pan(pan(1.0, 0.0)),
            "pan-up" => self.camera.pan(pan(0.0, -1.0)),
            "pan-down" => self.camera.pan(pan(0.0, 1.0)),
            "view-menu" => self.panel = Panel::Menu,
            "help" => self.panel = if self.panel == Panel::Help { Panel::None } else { Panel::Help },
            "close-panel" => self.panel = Panel::None,
            "quit" => return Outcome::Quit,
            _ => return Outcome::Unknown,
        }
        Outcome::Redraw
    }

    /// The place in the picture under the pointer, where it is on the picture.
    pub fn pointed(&self) -> Option<Point> {
        let at = self.camera.image_from_screen(self.pointer.filter(|p| p.y < self.area().height)?, self.area());
        self.picture.to_rect().contains(at).then_some(at)
    }

    /// What the overlay shows, its field as dense as the screen bears.
    pub fn overlay_view(&self) -> View {
        let spacing = FIELD_PX * self.scale / self.camera.zoom;
        let doubled = (0..24).map(|k| f64::from(1 << k)).find(|&s| s >= spacing);
        View {
            outlines: self.shown.outlines,
            regions: self.shown.regions,
            anchors: self.shown.anchors,
            curves: self.shown.curves,
            labels: self.shown.labels,
            field: self.shown.field.then_some(doubled.unwrap_or(spacing)),
            selection: self.selection.clone(),
        }
    }
}

impl Shown {
    /// What a command switches.
    fn switch(&mut self, command: &str) -> Option<&mut bool> {
        Some(match command {
            "view-outlines" => &mut self.outlines,
            "view-regions" => &mut self.regions,
            "view-anchors" => &mut self.anchors,
            "view-curves" => &mut self.curves,
            "view-field" => &mut self.field,
            "view-labels" => &mut self.labels,
            "view-grid" => &mut self.grid,
            "view-still" => &mut self.still,
            "view-checkerboard" => &mut self.plain,
            _ => return None,
        })
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
