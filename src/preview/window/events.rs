//! The window's events: what happens becomes a change of the [`State`], and a change asks for one drawing. While nothing
//! plays the loop sleeps.
//!
//! [`State`]: super::state::State

use std::time::{Duration, Instant};

use kurbo::Point;
use winit::application::ApplicationHandler;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::window::WindowId;

use super::app::App;
use super::grasp::Held;
use super::input;
use super::mouse::{Asked, Button};
use super::opened::OpenWindow;
use super::worker::Event;
use crate::base::error::{Error, Result};
use crate::base::number;
use crate::preview::keys::TRY_NOW;
use crate::preview::views;
use crate::preview::wire::message::Gesture;

/// A line of a mouse wheel is one step; a touchpad may give pixels.
const WHEEL_PX: f64 = 60.0;
/// How often a hidden window checks whether it can be seen again.
const HIDDEN: Duration = Duration::from_millis(250);

/// What is said of something that an editor takes: there may be none.
fn goes(what: &str) -> String {
    format!("{what} goes to the editor that has this scene open (plica edit)")
}

impl App {
    /// Does work that may fail; a failure ends the window.
    fn attempt(&mut self, event_loop: &ActiveEventLoop, work: impl FnOnce(&mut App) -> Result<()>) {
        if let Err(error) = work(self) {
            self.failed = Some(error);
            event_loop.exit();
        }
    }

    /// A key: the window follows at once, and the editor is told what concerns it too.
    fn key(&mut self, event_loop: &ActiveEventLoop, command: &'static str) {
        if command == "close-panel" && self.mouse.lets_go(&mut self.state) {
            self.reply(Gesture::Command("undrag".to_owned()));
            return self.redraw();
        }
        self.leading(|app| app.run(event_loop, command));
        match command {
            "mark-point" => self.tell(command, self.state.marked),
            "select-point" => self.tell(command, self.state.pointed()),
            "copy-point" => {
                self.state.words.told = self.state.pointed().map(|_| goes("the place"));
                self.tell(command, self.state.pointed());
            }
            TRY_NOW | "next-sight" => self.reply(Gesture::Command(command.to_owned())),
            "next-pass" | "previous-pass" => self.reply(Gesture::Command(views::show_pass(self.state.pass.as_deref()))),
            switch => views::setting(switch, &self.state.switches).into_iter().for_each(|setting| {
                self.reply(Gesture::Command(setting));
            }),
        }
    }

    /// Asks the editor to do something with a point of the picture.
    fn tell(&self, command: &str, at: Option<Point>) {
        if let Some(Point { x, y }) = at {
            self.reply(Gesture::Pointer { x, y });
            self.reply(Gesture::Command(command.to_owned()));
        }
    }

    fn pointer(&mut self, at: Option<Point>) {
        if self.mouse.drags_grip() {
            self.look_at_keys();
        }
        self.leading(|app| app.mouse.moved(&mut app.state, at));
        if let Some(Point { x, y }) = self.state.pointed() {
            self.reply(Gesture::Pointer { x, y });
        }
        self.pointed();
    }

    /// Learns which keys are held with the mouse while somebody else has the keyboard, as the editor mostly has.
    fn look_at_keys(&mut self) {
        if let Some(held) = self.opened.as_ref().and_then(OpenWindow::held_elsewhere) {
            self.mouse.hold(held);
        }
    }

    /// A button of the mouse goes down or up.
    fn press(&mut self, event_loop: &ActiveEventLoop, button: Button, pressed: bool) {
        let mut asked = Asked::Nothing;
        if pressed {
            self.look_at_keys();
            self.opened.iter().for_each(OpenWindow::clicked);
        }
        self.leading(|app| {
            asked = match pressed {
                true => app.mouse.pressed(&mut app.state, button),
                false => app.mouse.released(&mut app.state, Instant::now()),
            };
        });
        match asked {
            Asked::Nothing => {}
            Asked::Play => self.key(event_loop, "play"),
            Asked::Fit => self.run(event_loop, "zoom-fit"),
            Asked::Band(from, to) => {
                let corners = [from.x, from.y, to.x, to.y].map(|c| number::text(number::rounded(c, 1))).join(" ");
                self.reply(Gesture::Command(format!("band {corners}")));
            }
            Asked::Select(at) => self.tell("select-point", Some(at)),
            Asked::Take(pointer) => self.reply(Gesture::Command(format!("take {pointer}"))),
            Asked::Drop(dragged, at) => self.tell(&format!("drop {dragged}"), Some(at)),
        }
        self.pointed();
    }

    /// Tells the editor where a drag that goes on has moved something, so that it is seen there: once a drawing.
    pub(super) fn tell_drag(&mut self) {
        let told = self.mouse.moves().map(|(pointer, at)| (format!("drag {pointer}"), at));
        if let Some((command, at)) = told {
            self.tell(&command, Some(at));
        }
    }

    /// The pointer shows what can be done where it is.
    fn pointed(&mut self) {
        let shape = self.mouse.shape(&self.state);
        self.opened.iter_mut().for_each(|opened| opened.point(shape));
        if self.mouse.drags_time() {
            self.report();
        }
        self.redraw();
    }

    fn wheel(&mut self, delta: MouseScrollDelta) {
        self.look_at_keys();
        let steps = match delta {
            MouseScrollDelta::PixelDelta(by) => by.y / WHEEL_PX,
            MouseScrollDelta::LineDelta(_, 0.0) => return,
            MouseScrollDelta::LineDelta(_, y) => {
                let twice = self.opened.as_ref().is_some_and(OpenWindow::wheel_is_a_button);
                if !self.mouse.counts(twice) {
                    return;
                }
                f64::from(y)
            }
        };
        self.mouse.turned(&mut self.state, steps);
        self.redraw();
    }
}

impl ApplicationHandler<Event> for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        event_loop.set_control_flow(ControlFlow::Wait);
        self.redraw();
    }

    fn user_event(&mut self, event_loop: &ActiveEventLoop, event: Event) {
        self.attempt(event_loop, |app| match event {
            Event::Ready(ready) => app.take(event_loop, ready),
            Event::Problems(problems) => app.warn(event_loop, problems),
            Event::Work(work) => {
                app.state.work = Some(work);
                app.redraw();
                Ok(())
            }
            Event::Drawn => {
                app.redraw();
                Ok(())
            }
            Event::Sent(sent) => app.sent(event_loop, *sent),
            Event::Fonts(fonts) => {
                app.letters.take_fonts(*fonts);
                app.redraw();
                Ok(())
            }
            Event::Captured(told) => {
                app.state.capture = None;
                (app.state.words.progress, app.state.words.told) = (None, Some(told));
                app.report();
                Ok(())
            }
            Event::Interrupted => Err(Error::Interrupted),
            Event::Update(update) => {
                app.follow(event_loop, update);
                Ok(())
            }
        });
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::RedrawRequested => self.attempt(event_loop, App::draw),
            WindowEvent::Resized(_) | WindowEvent::ScaleFactorChanged { .. } => self.resized(),
            WindowEvent::Occluded(covered) => {
                self.opened.iter_mut().for_each(|o| o.covered = covered);
                self.redraw();
            }
            WindowEvent::ModifiersChanged(held) => {
                self.held = held.state();
                let held = &self.held;
                let (shift, alt, ctrl) = (held.shift_key(), held.alt_key(), held.control_key());
                self.mouse.hold(Held { shift, alt, ctrl });
            }
            WindowEvent::KeyboardInput { event, is_synthetic: false, .. } if event.state == ElementState::Pressed => {
                if let Some(command) = input::command(&event.logical_key, self.held, event.repeat) {
                    self.key(event_loop, command);
                }
            }
            WindowEvent::CursorMoved { position, .. } => self.pointer(Some(Point::new(position.x, position.y))),
            WindowEvent::CursorLeft { .. } => self.pointer(None),
            WindowEvent::MouseInput { state, button: MouseButton::Left, .. } => {
                self.press(event_loop, Button::Left, state == ElementState::Pressed);
            }
            WindowEvent::MouseInput { state, button: MouseButton::Middle, .. } => {
                self.press(event_loop, Button::Middle, state == ElementState::Pressed);
            }
            WindowEvent::MouseInput { state, button: MouseButton::Right, .. } => {
                self.press(event_loop, Button::Right, state == ElementState::Pressed);
            }
            WindowEvent::MouseWheel { delta, .. } => self.wheel(delta),
            WindowEvent::DroppedFile(path) => {
                self.state.words.told = Some(goes(&path.display().to_string()));
                self.reply(Gesture::Command(format!("file {}", path.display())));
                self.redraw();
            }
            _ => {}
        }
    }

    fn new_events(&mut self, event_loop: &ActiveEventLoop, cause: StartCause) {
        if matches!(cause, StartCause::ResumeTimeReached { .. }) {
            self.attempt(event_loop, |app| app.open(event_loop));
            self.redraw();
        }
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        self.keep();
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let rest = self.state.transport.until_next(&self.state.timeline);
        let interval = self.opened.as_ref().map(OpenWindow::interval);
        let flow = match interval {
            Some(interval) if self.plays_visibly() => ControlFlow::WaitUntil(self.clock.next(interval, rest)),
            Some(_) if self.state.transport.playing && self.opened.as_ref().is_some_and(|o| o.hidden) => {
                ControlFlow::WaitUntil(Instant::now() + HIDDEN)
            }
            None => self.open_by.map_or(ControlFlow::Wait, ControlFlow::WaitUntil),
            _ => self.hurry.ends().map_or(ControlFlow::Wait, ControlFlow::WaitUntil),
        };
        event_loop.set_control_flow(flow);
    }
}
