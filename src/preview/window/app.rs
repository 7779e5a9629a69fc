//! The window's events: what happens becomes a change of the [`State`], and a change asks for one drawing. While nothing
//! plays the loop sleeps.

use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

use kurbo::{Point, Size};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::window::{Window, WindowId};

use super::clock::Clock;
use super::opened::{Opened, first_size};
use super::screen::{Drawn, Screen};
use super::show::{Cached, Show, name};
use super::state::{Outcome, State};
use super::worker::{Event, Ready};
use super::{PLACE, chrome, input};
use crate::base::error::{Error, Result};
use crate::preview::{Reply, Transport as Leading, Update};

/// A scene is given so long before the window opens with a notice alone.
const PATIENCE: Duration = Duration::from_millis(500);
/// A line of a mouse wheel is one step; a touchpad gives pixels.
const WHEEL_PX: f64 = 60.0;
/// A click may move the pointer so far, in logical pixels.
const CLICK_PX: f64 = 3.0;

/// Editor and window may be so far apart while both play, as a share of the timeline, before the window follows.
const APART: f64 = 0.05;
/// A command that no key gives: the device is lost. For tests of what follows.
const LOSE_DEVICE: &str = "lose-device";

/// The window and all that it shows.
pub struct App {
    title: String,
    replies: Sender<Reply>,
    /// The largest side of a picture that is given to the GPU, in pixels.
    most: usize,
    instance: Option<wgpu::Instance>,
    state: State,
    shown: Option<Show>,
    opened: Option<Opened>,
    marks: Cached,
    drag: Drag,
    /// Where the mouse button went down.
    pressed_at: Option<Point>,
    clock: Clock,
    /// What is to be answered once it is on the screen.
    owed: Option<Reply>,
    /// What was said last about how the window is doing: frames a second and what is wrong.
    reported: Option<(f64, String)>,
    /// When the window opens without a scene, to show a notice.
    open_by: Option<Instant>,
    failed: Option<Error>,
}

/// What the pressed mouse button moves.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Drag {
    Nothing,
    Picture,
    Time,
}

impl App {
    /// A window that opens with the first scene or the first problem.
    pub fn new(instance: wgpu::Instance, title: String, replies: Sender<Reply>, most: usize) -> App {
        App {
            title,
            replies,
            most,
            instance: Some(instance),
            state: State::default(),
            shown: None,
            opened: None,
            marks: Cached::default(),
            drag: Drag::Nothing,
            pressed_at: None,
            clock: Clock::default(),
            owed: None,
            reported: None,
            open_by: None,
            failed: None,
        }
    }

    /// Why the window ended, where that was an error.
    pub fn ended(self) -> Result<()> {
        tracing::info!("the window drew {} times", self.clock.drawn);
        self.failed.map_or(Ok(()), Err)
    }

    /// Does what can fail; a failure ends the window.
    fn attempt(&mut self, event_loop: &ActiveEventLoop, work: impl FnOnce(&mut App) -> Result<()>) {
        if let Err(error) = work(self) {
            self.failed = Some(error);
            event_loop.exit();
        }
    }

    /// Opens the window where it is not open yet.
    fn open(&mut self, event_loop: &ActiveEventLoop) -> Result<()> {
        let Some(instance) = self.instance.take() else { return Ok(()) };
        let size = self.first_size(event_loop);
        let attributes = Window::default_attributes()
            .with_title(self.title.clone())
            .with_inner_size(PhysicalSize::new(size.0, size.1));
        let window = Arc::new(event_loop.create_window(attributes).map_err(|e| Error::at(PLACE, e))?);
        let (gpu, screen) = Screen::open(instance, window.clone())?;
        self.opened = Some(Opened { window, gpu, screen, hidden: false });
        self.report();
        self.resized();
        Ok(())
    }

    /// The size that the window opens with.
    fn first_size(&self, event_loop: &ActiveEventLoop) -> (u32, u32) {
        let monitor = event_loop.primary_monitor().or_else(|| event_loop.available_monitors().next());
        let (scale, room) = monitor.map_or((1.0, None), |m| (m.scale_factor(), Some(m.size())));
        first_size(self.state.picture, scale, room)
    }

    fn resized(&mut self) {
        if let Some(opened) = &self.opened {
            let size = opened.window.inner_size();
            if size.width > 0 && size.height > 0 {
                self.state.resize(Size::new(size.width.into(), size.height.into()), opened.window.scale_factor());
            }
            self.redraw();
        }
    }

    fn redraw(&self) {
        if let Some(opened) = &self.opened {
            opened.window.request_redraw();
        }
    }

    /// Takes a scene that is ready.
    fn take(&mut self, event_loop: &ActiveEventLoop, ready: Ready) -> Result<()> {
        let (width, height) = ready.synth.size;
        self.state.load(Size::new(width as f64, height as f64), &ready.scene.timeline);
        self.open(event_loop)?;
        let Some(opened) = &self.opened else { return Ok(()) };
        if self.shown.is_none() {
            let (width, height) = self.first_size(event_loop);
            let _ = opened.window.request_inner_size(PhysicalSize::new(width, height)); // answered by Resized
        }
        let most = opened.gpu.device().max_side().min(self.most);
        let (show, reduced) = Show::new(ready.scene, ready.synth, most);
        self.shown = Some(show);
        self.state.problem = reduced;
        self.marks.revision += 1;
        self.owed = Some(Reply::Shown { revision: ready.revision, synth_ms: ready.synth_ms });
        self.select(self.state.selection.clone());
        self.report();
        Ok(())
    }

    /// Takes what comes from the editor.
    fn follow(&mut self, event_loop: &ActiveEventLoop, update: Update) {
        match update {
            Update::Scene { .. } => {} // comes as Ready, synthesised
            Update::Selection(pointer) => self.select(pointer),
            Update::Transport(transport) => self.join_in(transport),
            Update::View(command) if command == LOSE_DEVICE => {
                self.opened.iter().for_each(|opened| opened.gpu.device().raw.destroy());
            }
            Update::View(command) => self.run(event_loop, &command),
            Update::Notice(line) => {
                self.state.notice = Some(line).filter(|line| !line.is_empty());
                self.open_by.get_or_insert(Instant::now() + PATIENCE);
            }
            Update::Closed => event_loop.exit(),
        }
        self.redraw();
    }

    fn select(&mut self, pointer: Option<String>) {
        let named = pointer.as_deref().zip(self.shown.as_ref());
        self.state.selected = named.and_then(|(pointer, show)| name(&show.scene, pointer));
        self.state.selection = pointer;
        self.redraw();
    }

    /// Plays or stands as the editor does. Whoever drags the time leads, and two clocks that run need not be set.
    fn join_in(&mut self, Leading { playing, time, speed }: Leading) {
        let State { transport, timeline, .. } = &mut self.state;
        let t = time / timeline.duration.max(f64::MIN_POSITIVE);
        let apart = (transport.scene_time(timeline) - t).abs();
        let together = playing && transport.playing && apart.min(1.0 - apart) < APART;
        if self.drag != Drag::Time && !together {
            transport.playing = playing;
            transport.seek(t, timeline);
            self.clock.start();
        }
        transport.speed = speed;
        self.report();
    }

    /// Takes what is wrong with a scene.
    fn warn(&mut self, event_loop: &ActiveEventLoop, line: String) -> Result<()> {
        self.state.problem = Some(line);
        self.open(event_loop)?;
        self.report();
        self.redraw();
        Ok(())
    }

    fn run(&mut self, event_loop: &ActiveEventLoop, command: &str) {
        let played = self.state.transport.playing;
        match self.state.run(command) {
            Outcome::Redraw => self.redraw(),
            Outcome::FullScreen => self.opened.iter().for_each(Opened::toggle_full_screen),
            Outcome::Quit => event_loop.exit(),
            Outcome::Unknown => {}
        }
        if self.state.transport.playing != played {
            self.clock.start();
            self.report();
        }
    }

    /// A key: the window follows at once, and the editor is told what concerns it too.
    fn key(&mut self, event_loop: &ActiveEventLoop, command: &'static str) {
        self.leading(|app| app.run(event_loop, command));
        match command {
            "mark-point" => self.tell(command, self.state.marked),
            "select-point" => self.tell(command, self.state.pointed()),
            _ => {}
        }
    }

    /// Asks the editor to do something with a point of the picture.
    fn tell(&self, command: &str, at: Option<Point>) {
        if let Some(Point { x, y }) = at {
            self.reply(Reply::Pointer { x, y });
            self.reply(Reply::Command(command.to_owned()));
        }
    }

    /// Does what may change the time; the editor follows.
    fn leading(&mut self, change: impl FnOnce(&mut App)) {
        let before = self.state.transport.clone();
        change(self);
        let now = &self.state.transport;
        if (now.playing, now.frame, now.speed) != (before.playing, before.frame, before.speed) {
            self.lead();
        }
    }

    /// Tells the editor how the animation runs.
    fn lead(&self) {
        let State { transport, timeline, .. } = &self.state;
        let time = transport.scene_time(timeline) * timeline.duration;
        self.reply(Reply::Transport(Leading { playing: transport.playing, time, speed: transport.speed }));
    }

    fn reply(&self, reply: Reply) {
        // Nobody listens where a file is followed, or once the editor is gone: the window goes on.
        let _ = self.replies.send(reply);
    }

    fn pointer(&mut self, at: Option<Point>) {
        let before = std::mem::replace(&mut self.state.pointer, at);
        match (self.drag, before, at) {
            (Drag::Picture, Some(from), Some(to)) => self.state.camera.pan(from - to),
            (Drag::Time, _, Some(to)) => self.scrub(to.x),
            _ => {}
        }
        if let Some(Point { x, y }) = self.state.pointed() {
            self.reply(Reply::Pointer { x, y });
        }
        self.redraw();
    }

    /// The left button goes down or up; where it comes up at the same place that was a click.
    fn press(&mut self, pressed: bool) {
        let clicked = (self.pressed_at, self.state.pointer);
        if let (false, Drag::Picture, (Some(from), Some(to))) = (pressed, self.drag, clicked)
            && from.distance(to) <= CLICK_PX * self.state.scale
        {
            self.tell("select-point", self.state.pointed());
        }
        self.pressed_at = self.state.pointer.filter(|_| pressed);
        self.drag = match self.state.pointer {
            Some(at) if pressed && at.y >= self.state.area().height => Drag::Time,
            Some(_) if pressed => Drag::Picture,
            _ => Drag::Nothing,
        };
        if let (Drag::Time, Some(at)) = (self.drag, self.state.pointer) {
            self.scrub(at.x);
        }
    }

    fn scrub(&mut self, x: f64) {
        let frame = chrome::frame_at(&self.state, x);
        self.leading(|app| app.state.transport.go_to(frame, &app.state.timeline));
        self.report();
        self.redraw();
    }

    fn wheel(&mut self, steps: f64) {
        let about = self.state.pointer.unwrap_or(Point::ZERO);
        if steps != 0.0 {
            let steps = if steps > 0.0 { steps.ceil() } else { steps.floor() };
            self.state.camera.zoom_step(steps as i32, about, self.state.area());
            self.redraw();
        }
    }

    /// Draws the window. A lost device is replaced, and the drawing asked for again.
    fn draw(&mut self) -> Result<()> {
        self.advance();
        let Some(opened) = &mut self.opened else { return Ok(()) };
        match opened.paint(&mut self.state, self.shown.as_ref(), &mut self.marks) {
            _ if opened.gpu.device().is_lost() => self.reopen()?,
            Ok(Drawn::Yes) => opened.hidden = false,
            Ok(Drawn::Again) => opened.window.request_redraw(),
            Ok(Drawn::Hidden) => opened.hidden = true,
            Ok(Drawn::Lost) => self.reopen()?,
            Err(error) => return Err(error),
        }
        self.clock.drawn += 1;
        self.owed.take().into_iter().for_each(|reply| self.reply(reply));
        Ok(())
    }

    /// The animation runs on, and stops by itself where it plays once.
    fn advance(&mut self) {
        let (passed, fps) = self.clock.tick();
        if !self.state.transport.playing {
            return;
        }
        if let Some(fps) = fps {
            self.state.fps = Some(fps);
            self.report();
        }
        self.state.transport.advance(passed, &self.state.timeline);
        if !self.state.transport.playing {
            self.lead();
            self.report();
        }
    }

    /// Goes on after device or surface were lost, with new ones in the same window.
    fn reopen(&mut self) -> Result<()> {
        if let Some(Opened { window, gpu, screen, .. }) = self.opened.take() {
            let instance = gpu.instance().clone();
            drop((gpu, screen)); // a window has one surface at a time
            let (gpu, screen) = Screen::open(instance, window.clone())?;
            self.opened = Some(Opened { window, gpu, screen, hidden: false });
            self.redraw();
        }
        Ok(())
    }

    /// Tells the editor how the window is doing, where that has changed.
    fn report(&mut self) {
        self.state.fps = self.state.fps.filter(|_| self.state.transport.playing);
        let Some(opened) = &self.opened else { return };
        let (fps, notice) = (self.state.fps.unwrap_or(0.0).round(), self.state.problem.clone().unwrap_or_default());
        let adapter = opened.gpu.device().name();
        let report = Some((fps, notice.clone()));
        if self.reported != report {
            self.reported = report;
            self.reply(Reply::Report { fps, adapter, notice });
        }
        self.redraw();
    }

    fn plays_visibly(&self) -> bool {
        self.state.transport.playing && self.opened.as_ref().is_some_and(|o| !o.hidden)
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
            Event::Problem(line) => app.warn(event_loop, line),
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
            WindowEvent::Occluded(hidden) => {
                self.opened.iter_mut().for_each(|o| o.hidden = hidden);
                self.redraw();
            }
            WindowEvent::KeyboardInput { event, is_synthetic: false, .. } if event.state == ElementState::Pressed => {
                if let Some(command) = input::command(&event.logical_key) {
                    self.key(event_loop, command);
                }
            }
            WindowEvent::CursorMoved { position, .. } => self.pointer(Some(Point::new(position.x, position.y))),
            WindowEvent::CursorLeft { .. } => self.pointer(None),
            WindowEvent::MouseInput { state, button: MouseButton::Left, .. } => {
                self.press(state == ElementState::Pressed);
            }
            WindowEvent::MouseWheel { delta: MouseScrollDelta::LineDelta(_, y), .. } => self.wheel(f64::from(y)),
            WindowEvent::MouseWheel { delta: MouseScrollDelta::PixelDelta(by), .. } => self.wheel(by.y / WHEEL_PX),
            _ => {}
        }
    }

    fn new_events(&mut self, event_loop: &ActiveEventLoop, cause: StartCause) {
        if matches!(cause, StartCause::ResumeTimeReached { .. }) {
            self.attempt(event_loop, |app| app.open(event_loop));
            self.redraw();
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let rest = self.state.transport.until_next(&self.state.timeline);
        let interval = self.opened.as_ref().map(Opened::interval);
        let flow = match interval {
            Some(interval) if self.plays_visibly() => ControlFlow::WaitUntil(self.clock.next(interval, rest)),
            None => self.open_by.map_or(ControlFlow::Wait, ControlFlow::WaitUntil),
            _ => ControlFlow::Wait,
        };
        event_loop.set_control_flow(flow);
    }
}
