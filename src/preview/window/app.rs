//! The window's events: what happens becomes a change of the [`State`], and a change asks for one drawing. While nothing
//! plays the loop sleeps.

use std::io::Write;
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

use kurbo::{Point, Size};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoopProxy};
use winit::keyboard::ModifiersState;
use winit::window::WindowId;

use super::clock::Clock;
use super::mouse::{Asked, Button, Mouse};
use super::opened::{Opened, first_size};
use super::screen::Drawn;
use super::show::{Cached, Show, name};
use super::state::{Outcome, State};
use super::text::{Letters, of_system};
use super::words::Words;
use super::worker::{Event, Ready};
use super::{Manner, input};
use crate::base::error::{Error, Result};
use crate::base::problem::Problem;
use crate::preview::{Reply, Transport as Leading, Update, views};

/// A scene is given so long before the window opens with a notice alone.
const PATIENCE: Duration = Duration::from_millis(500);
/// A line of a mouse wheel is one step; a touchpad may give pixels.
const WHEEL_PX: f64 = 60.0;
/// How often a hidden window looks whether it can be seen again.
const HIDDEN: Duration = Duration::from_millis(250);

/// Editor and window may be so far apart while both play, as a share of the timeline, before the window follows.
const APART: f64 = 0.05;
/// A command that no key gives: the device is lost. For tests of what follows.
const LOSE_DEVICE: &str = "lose-device";

/// The window and all that it shows.
pub struct App {
    manner: Manner,
    replies: Sender<Reply>,
    /// For what is looked for beside the event loop.
    proxy: EventLoopProxy<Event>,
    instance: Option<wgpu::Instance>,
    letters: Letters,
    state: State,
    shown: Option<Show>,
    opened: Option<Opened>,
    marks: Cached,
    mouse: Mouse,
    /// Keys that are held with others.
    held: ModifiersState,
    clock: Clock,
    /// What the window is to grow to once its first picture is drawn.
    grows_to: Option<PhysicalSize<u32>>,
    /// What is to be answered once it is on the screen.
    owed: Option<Reply>,
    /// What was said last about how the window is doing: frames a second and what is wrong.
    reported: Option<(f64, String)>,
    /// When the window opens without a scene, to show a notice.
    open_by: Option<Instant>,
    failed: Option<Error>,
}

impl App {
    /// A window that opens with the first scene or the first problem.
    pub fn new(instance: wgpu::Instance, manner: Manner, replies: Sender<Reply>, proxy: EventLoopProxy<Event>) -> App {
        App {
            manner,
            replies,
            proxy,
            instance: Some(instance),
            letters: Letters::default(),
            state: State::default(),
            shown: None,
            opened: None,
            marks: Cached::default(),
            mouse: Mouse::default(),
            held: ModifiersState::empty(),
            grows_to: None,
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
        self.opened = Some(Opened::open(event_loop, instance, &self.manner, self.first_size(event_loop))?);
        self.report();
        self.resized();
        Ok(())
    }

    /// The size that the window opens with.
    fn first_size(&self, event_loop: &ActiveEventLoop) -> PhysicalSize<u32> {
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
        // Sending a large picture to the GPU takes a while: the window stays whole until then.
        self.grows_to = self.shown.is_none().then(|| self.first_size(event_loop));
        let most = opened.gpu.device().max_side().min(self.manner.most);
        let (show, reduced) = Show::new(ready.scene, ready.synth, most);
        self.shown = Some(show);
        self.state.words.reduced = reduced;
        self.state.words.follow_scene(ready.problems);
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
            Update::Notice(line) => self.say(|words| words.notice = Some(line).filter(|line| !line.is_empty())),
            Update::Progress(line) => self.say(|words| words.progress = Some(line).filter(|line| !line.is_empty())),
            Update::Problems(problems) => {
                self.complain(&problems);
                self.say(|words| words.follow_link(problems));
            }
            Update::Closed => event_loop.exit(),
        }
        self.redraw();
    }

    /// Says something; a window that has nothing to show opens for that in a while.
    fn say(&mut self, what: impl FnOnce(&mut Words)) {
        what(&mut self.state.words);
        self.open_by.get_or_insert(Instant::now() + PATIENCE);
    }

    /// Says what is wrong on standard error too, as long as there is no picture: the window may never open.
    fn complain(&self, problems: &[Problem]) {
        if self.shown.is_none() && self.manner.complains {
            let lines: String = problems.iter().map(|p| format!("plica: {}: {p}\n", self.manner.name)).collect();
            // Nobody may read it.
            drop(std::io::stderr().write_all(lines.as_bytes()));
        }
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
        if !self.mouse.drags_time() && !together {
            transport.playing = playing;
            transport.seek(t, timeline);
            self.clock.start();
        }
        transport.speed = speed;
        self.report();
    }

    /// Takes what is wrong with a scene.
    fn warn(&mut self, event_loop: &ActiveEventLoop, problems: Vec<Problem>) -> Result<()> {
        self.complain(&problems);
        self.state.words.follow_scene(problems);
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
            Outcome::Window => self.opened.iter().for_each(Opened::leave_full_screen),
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
            switch => self.state.is_on(switch).into_iter().for_each(|on| {
                self.reply(Reply::Command(views::set(switch, on)));
            }),
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
        self.leading(|app| app.mouse.moved(&mut app.state, at));
        if let Some(Point { x, y }) = self.state.pointed() {
            self.reply(Reply::Pointer { x, y });
        }
        self.pointed();
    }

    /// A button of the mouse goes down or up.
    fn press(&mut self, event_loop: &ActiveEventLoop, button: Button, pressed: bool) {
        let mut asked = Asked::Nothing;
        self.opened.iter().filter(|_| pressed).for_each(Opened::clicked);
        self.leading(|app| {
            asked = match pressed {
                true => app.mouse.pressed(&mut app.state, button),
                false => app.mouse.released(&app.state, Instant::now()),
            };
        });
        match asked {
            Asked::Nothing => {}
            Asked::Play => self.key(event_loop, "play"),
            Asked::Fit => self.run(event_loop, "zoom-fit"),
            Asked::Select(at) => self.tell("select-point", Some(at)),
        }
        self.pointed();
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
        let steps = match delta {
            MouseScrollDelta::PixelDelta(by) => by.y / WHEEL_PX,
            MouseScrollDelta::LineDelta(_, 0.0) => return,
            MouseScrollDelta::LineDelta(_, y) => {
                let twice = self.opened.as_ref().is_some_and(Opened::wheel_is_a_button);
                if !self.mouse.counts(twice) {
                    return;
                }
                f64::from(y)
            }
        };
        self.mouse.turned(&mut self.state, steps);
        self.redraw();
    }

    /// Draws the window, where it can be seen. A lost device is replaced, and the drawing asked for again.
    fn draw(&mut self) -> Result<()> {
        self.advance();
        let Some(opened) = &mut self.opened else { return Ok(()) };
        let was_hidden = opened.hidden;
        if opened.is_seen() {
            self.letters.begin();
            match opened.paint(&mut self.state, self.shown.as_ref(), &mut self.marks, &self.letters) {
                _ if opened.gpu.device().is_lost() => self.reopen()?,
                Ok(Drawn::Yes) => self.drawn(),
                Ok(Drawn::Again) => opened.window.request_redraw(),
                Ok(Drawn::Hidden) => opened.hidden = true,
                Ok(Drawn::Lost) => self.reopen()?,
                Err(error) => return Err(error),
            }
            self.clock.drawn += 1;
        } else if !was_hidden {
            self.report();
        }
        self.owed.take().into_iter().for_each(|reply| self.reply(reply));
        Ok(())
    }

    /// A drawing is on the screen.
    fn drawn(&mut self) {
        let Some(opened) = &mut self.opened else { return };
        opened.hidden = false;
        if let Some(size) = self.grows_to.take() {
            let _ = opened.window.request_inner_size(size); // answered by Resized
        }
        if self.letters.asks_for_fonts() {
            let proxy = self.proxy.clone();
            // Where nobody is there any more to take them, they are not needed.
            std::thread::spawn(move || drop(proxy.send_event(Event::Fonts(Box::new(of_system())))));
        }
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
        if let Some(opened) = self.opened.take() {
            self.opened = Some(opened.anew()?);
            self.redraw();
        }
        Ok(())
    }

    /// Tells the editor how the window is doing, where that has changed.
    fn report(&mut self) {
        self.state.fps = self.state.fps.filter(|_| self.plays_visibly());
        let Some(opened) = &self.opened else { return };
        let (fps, notice) = (self.state.fps.unwrap_or(0.0).round(), self.state.words.of_scene());
        let adapter = opened.gpu.device().name();
        let report = Some((fps, notice.clone()));
        if self.reported != report {
            self.reported = report;
            self.reply(Reply::Report { fps, adapter, notice });
        }
        self.redraw();
    }

    fn plays_visibly(&self) -> bool {
        self.state.transport.playing && self.opened.as_ref().is_some_and(|o| !o.hidden && !o.covered)
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
            Event::Fonts(fonts) => {
                app.letters.take_fonts(*fonts);
                app.redraw();
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
            WindowEvent::ModifiersChanged(held) => self.held = held.state(),
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
            WindowEvent::MouseWheel { delta, .. } => self.wheel(delta),
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
            Some(_) if self.state.transport.playing && self.opened.as_ref().is_some_and(|o| o.hidden) => {
                ControlFlow::WaitUntil(Instant::now() + HIDDEN)
            }
            None => self.open_by.map_or(ControlFlow::Wait, ControlFlow::WaitUntil),
            _ => ControlFlow::Wait,
        };
        event_loop.set_control_flow(flow);
    }
}
