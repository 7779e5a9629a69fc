//! What the commands of the key table change of what the window shows.

use kurbo::Vec2;

use super::capture::Round;
use super::panel;
use super::state::{Panel, State};
use super::style::BACKGROUNDS;
use super::viewport::Fit;
use crate::preview::keys::{KEYS, TRY_NOW};
use crate::preview::views::{self, FIELD};
use crate::render::passes;

/// A key moves the border between still and moving by this share of the picture.
const WIPE_STEP: f64 = 0.05;
/// A key pans by this share of the area.
const PAN: f64 = 0.1;

/// What a command asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// A new picture of the window.
    Redraw,
    /// The whole screen, or the window again.
    FullScreen,
    /// The window again, if it fills the screen.
    Window,
    /// The end.
    Quit,
    /// Nothing: the command is not one of the window's.
    Unknown,
}

impl State {
    /// Runs a command by its name in the key table; behind the name of a switch may stand ` on` or ` off`.
    pub fn run(&mut self, command: &str) -> Outcome {
        if command != "view-menu" && self.panel == Panel::Menu {
            self.panel = Panel::None;
        }
        if self.runs_with_words(command) {
            return Outcome::Redraw;
        }
        let (name, wanted) = views::wanted(command);
        if self.steer(name) && wanted.is_none() {
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
            "next-pass" => self.step_pass(1),
            "previous-pass" => self.step_pass(-1),
            "field-closer" => self.field_step = FIELD.step(self.field_step, -1),
            "field-wider" => self.field_step = FIELD.step(self.field_step, 1),
            "next-background" => self.background = (self.background + 1) % BACKGROUNDS.len(),
            "wipe-left" => self.move_wipe(-WIPE_STEP),
            "wipe-right" => self.move_wipe(WIPE_STEP),
            "play-part" => self.words.told = Some(self.transport.mark_part()),
            "shot" => self.screenshot = true,
            "mark-point" => self.marked = self.pointed(),
            "zoom-in" => self.zoom(1, about),
            "zoom-out" => self.zoom(-1, about),
            "zoom-fit" => self.viewport.fit(self.picture, area, Fit::Window),
            "zoom-whole" => self.viewport.fit(self.picture, area, Fit::Whole),
            "zoom-one" => self.viewport.one(self.picture, area),
            "pan-left" => self.pan(pan(-1.0, 0.0)),
            "pan-right" => self.pan(pan(1.0, 0.0)),
            "pan-up" => self.pan(pan(0.0, -1.0)),
            "pan-down" => self.pan(pan(0.0, 1.0)),
            "view-menu" => self.panel = Panel::Menu,
            "help" => self.panel = self.next_help(),
            "close-panel" => return self.close(),
            "view-full-screen" => return Outcome::FullScreen,
            "select-point" | "copy-point" | "next-sight" | TRY_NOW => {} // answered by the editor, and by whoever follows the scene
            "quit" => return Outcome::Quit,
            _ => return Outcome::Unknown,
        }
        Outcome::Redraw
    }

    /// Runs a command that may have words behind it: a pass, a capture, a switch. False for all others.
    fn runs_with_words(&mut self, command: &str) -> bool {
        if let Some(pass) = views::pass_in(command) {
            // The editor repeats what a key has done.
            if pass != self.pass {
                self.show_pass(pass);
            }
            return true;
        }
        self.words.told = None;
        if let Some(extension) = views::captured(command) {
            if !self.gives_up_capture() {
                self.capture = Some(Round::new(extension, &self.transport, &self.timeline));
            }
            return true;
        }
        let is_switch = self.switches.take(command).is_some();
        if is_switch {
            self.transport.whole_frames = self.shows("view-whole-frames");
        }
        is_switch
    }

    /// The next page of the keys, if there is one.
    fn next_help(&self) -> Panel {
        match self.panel {
            Panel::Help(page) if panel::page(self, &KEYS, page).1 => Panel::Help(page + 1),
            Panel::Help(_) => Panel::None,
            _ => Panel::Help(0),
        }
    }

    /// Closes what lies over the picture; if there is nothing, leaves the full screen.
    fn close(&mut self) -> Outcome {
        if self.gives_up_capture() {
            return Outcome::Redraw;
        }
        let panel = std::mem::take(&mut self.panel) != Panel::None;
        let marked = self.marked.take().is_some();
        if panel || marked || self.words.put_away() { Outcome::Redraw } else { Outcome::Window }
    }

    /// Gives up what is being captured, if something is.
    fn gives_up_capture(&mut self) -> bool {
        let given_up = self.capture.take().is_some();
        if given_up {
            self.words.progress = None;
            self.words.told = Some("the capture is given up".to_owned());
        }
        given_up
    }

    /// Shows the pass so many places on, of those in which the scene has something.
    fn step_pass(&mut self, by: isize) {
        let pass = passes::step(&self.passes, self.pass.as_deref(), by);
        self.show_pass(views::pass_in(&views::show_pass(Some(pass))).flatten());
        if self.passes.is_empty() {
            self.words.told = Some("no passes: nothing in the scene is in space".to_owned());
        }
    }

    /// Shows a pass, and says how to go on from there.
    fn show_pass(&mut self, pass: Option<String>) {
        let how = |pass| format!("pass {pass}, D shows the next, Backspace the one before");
        self.words.told = pass.as_ref().map(how);
        self.switches.under_pass(pass.is_some());
        self.pass = pass;
    }

    fn move_wipe(&mut self, by: f64) {
        self.switches.set("view-wipe", Some(true));
        self.wipe = (self.wipe + by).clamp(0.0, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use kurbo::{Point, Size};

    use super::*;

    #[test]
    fn every_command_of_the_key_table_is_known() {
        for row in KEYS.iter() {
            assert_ne!(State::for_tests().run(row.command), Outcome::Unknown, "{row:?}");
        }
        assert_eq!(State::for_tests().run("sing"), Outcome::Unknown);
    }

    #[test]
    fn a_switch_is_turned_or_set() {
        let mut state = State::for_tests();
        for (command, outlines) in [
            ("view-outlines", true),
            ("view-outlines on", true),
            ("view-outlines off", false),
            ("view-outlines off", false),
        ] {
            assert_eq!(state.run(command), Outcome::Redraw);
            assert_eq!(state.shows("view-outlines"), outlines, "{command}");
        }
        state.run("view-checkerboard off");
        assert!(!state.shows("view-checkerboard"));
        state.run("view-legends");
        assert!(!state.shows("view-legends"));
        state.run("view-whole-frames on");
        assert!(state.transport.whole_frames);
        assert_eq!(state.run("zoom-in on"), Outcome::Unknown);
    }

    #[test]
    fn a_capture_is_given_up_by_its_key_and_by_esc() {
        for (commands, extension) in [
            (&["capture"][..], Some("gif")),
            (&["capture apng"], Some("apng")),
            (&["capture", "zoom-in"], Some("gif")),
            (&["capture", "capture"], None),
            (&["capture", "close-panel"], None),
        ] {
            let mut state = State::for_tests();
            commands.iter().for_each(|command| assert_eq!(state.run(command), Outcome::Redraw));
            assert_eq!(state.capture.as_ref().map(|round| round.extension.as_str()), extension, "{commands:?}");
        }
        assert_eq!(State::for_tests().run("capture ../x.gif"), Outcome::Unknown);
    }

    #[test]
    fn the_passes_are_shown_one_after_the_other() {
        let mut state = State::for_tests();
        for command in ["next-pass", "previous-pass"] {
            assert_eq!((state.run(command), state.pass.as_deref()), (Outcome::Redraw, None), "there are none");
        }
        state.passes = vec!["depth", "uv", "shade"];
        for (command, pass) in [
            ("next-pass", Some("depth")),
            ("next-pass", Some("uv")),
            ("next-pass", Some("shade")),
            ("next-pass", None),
            ("previous-pass", Some("shade")),
            ("previous-pass", Some("uv")),
            ("pass uv:face", Some("uv:face")),
            ("next-pass", Some("shade")),
            ("pass noise", Some("noise")),
            ("previous-pass", Some("shade")),
            ("pass color", None),
        ] {
            state.run(command);
            assert_eq!(state.pass.as_deref(), pass, "{command}");
        }
    }

    #[test]
    fn what_a_key_says_goes_with_the_next_key_and_not_with_its_echo() {
        for (passes, echo) in [(vec!["shade"], "pass shade"), (Vec::new(), "pass color")] {
            let mut state = State { passes, ..State::for_tests() };
            for next in ["orbit-left", "zoom-in", "view-outlines"] {
                assert_eq!((state.run("next-pass"), state.run(echo)), (Outcome::Redraw, Outcome::Redraw));
                assert!(state.words.told.is_some(), "{echo}");
                state.run(next);
                assert_eq!(state.words.told, None, "{next}");
                state.run("pass color");
            }
        }
    }

    #[test]
    fn esc_closes_one_thing_after_the_other() {
        let mut state = State { panel: Panel::Help(0), marked: Some(Point::ZERO), ..State::for_tests() };
        state.words.follow_scene(vec![crate::base::problem::Problem::error("", "wrong")]);
        assert_eq!((state.run("close-panel"), state.panel, state.marked), (Outcome::Redraw, Panel::None, None));
        assert_eq!((state.run("close-panel"), state.words.listed().len()), (Outcome::Redraw, 0));
        assert_eq!(state.run("close-panel"), Outcome::Window);
    }

    #[test]
    fn all_keys_are_on_some_page_that_can_be_read() {
        for (size, pages) in [(Size::new(480.0, 360.0), 4), (Size::new(1000.0, 600.0), 1)] {
            let mut state = State::for_tests();
            state.resize(size, 1.0);
            let mut seen = Vec::new();
            for number in 0..pages {
                state.run("help");
                assert_eq!(state.panel, Panel::Help(number));
                seen.extend(panel::page(&state, &KEYS, number).0.iter().map(|row| row.command));
            }
            state.run("help");
            assert_eq!(state.panel, Panel::None, "{size}");
            assert!(KEYS.iter().all(|row| seen.contains(&row.command)), "{size}");
            assert_eq!(
                panel::page(&state, &KEYS, 99).0,
                panel::page(&state, &KEYS, pages - 1).0,
                "made larger meanwhile"
            );
        }
    }

    #[test]
    fn the_menu_is_gone_with_the_next_key() {
        let mut state = State::for_tests();
        state.run("view-menu");
        state.run("view-outlines");
        assert_eq!((state.panel, state.shows("view-outlines")), (Panel::None, true));
    }
}
