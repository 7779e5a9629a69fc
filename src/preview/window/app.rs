//! The window and all that it shows, with what its events, its link and its drawings have in common.

use std::sync::mpsc::Sender;
use std::time::Instant;

use kurbo::Size;
use winit::dpi::PhysicalSize;
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::keyboard::ModifiersState;

use super::clock::Clock;
use super::hurry::Hurry;
use super::kept::Kept;
use super::mouse::Mouse;
use super::opened::{OpenWindow, first_size};
use super::options::WindowOptions;
use super::own_view::OwnView;
use super::run::Outcome;
use super::show::{Cached, Show};
use super::state::State;
use super::text::Letters;
use super::worker::{Event, Ready, Sending};
use crate::base::error::{Error, Result};
use crate::preview::Transport;
use crate::preview::wire::message::{Gesture, ToEditor};

/// The window and all that it shows.
pub struct App {
    pub(super) options: WindowOptions,
    pub(super) replies: Sender<ToEditor>,
    /// For threads beside the event loop.
    pub(super) proxy: EventLoopProxy<Event>,
    pub(super) instance: Option<wgpu::Instance>,
    pub(super) letters: Letters,
    pub(super) state: State,
    pub(super) shown: Option<Show>,
    pub(super) opened: Option<OpenWindow>,
    pub(super) marks: Cached,
    pub(super) mouse: Mouse,
    /// Keys that are held with others.
    pub(super) held: ModifiersState,
    pub(super) clock: Clock,
    /// Whether changes come one right after the other.
    pub(super) hurry: Hurry,
    /// The size that the window is to grow to once its first picture is drawn.
    pub(super) grows_to: Option<PhysicalSize<u32>>,
    /// What comes back of an earlier window of the scene.
    pub(super) kept: Kept,
    /// The scene that is on its way to the GPU, and the next one.
    pub(super) sending: Option<Sending>,
    pub(super) waiting: Option<Ready>,
    /// The answer that is due once the scene is on the screen.
    pub(super) owed: Option<ToEditor>,
    /// What was said last about how the window is doing: frames a second and what is wrong.
    pub(super) reported: Option<(f64, String)>,
    /// What the editor was told last of the window's own view.
    pub(super) told_view: Option<OwnView>,
    /// When the window opens without a scene, to show a notice.
    pub(super) open_by: Option<Instant>,
    pub(super) failed: Option<Error>,
}

impl App {
    /// A window that opens with the first scene or the first problem.
    pub fn new(
        instance: wgpu::Instance,
        options: WindowOptions,
        replies: Sender<ToEditor>,
        proxy: EventLoopProxy<Event>,
    ) -> App {
        let kept = Kept::of(&options.screenshots);
        let state = State { background: kept.background, ..State::default() };
        App {
            options,
            kept,
            replies,
            proxy,
            instance: Some(instance),
            letters: Letters::default(),
            state,
            shown: None,
            opened: None,
            marks: Cached::default(),
            mouse: Mouse::default(),
            held: ModifiersState::empty(),
            grows_to: None,
            clock: Clock::default(),
            hurry: Hurry::default(),
            sending: None,
            waiting: None,
            owed: None,
            reported: None,
            told_view: None,
            open_by: None,
            failed: None,
        }
    }

    /// Why the window ended, if that was an error.
    pub fn ended(mut self) -> Result<()> {
        drop(self.sending.take());
        tracing::info!("the window drew {} times", self.clock.drawn);
        self.failed.map_or(Ok(()), Err)
    }

    /// Opens the window if it is not open yet.
    pub(super) fn open(&mut self, event_loop: &ActiveEventLoop) -> Result<()> {
        let Some(instance) = self.instance.take() else { return Ok(()) };
        let size = self.first_size(event_loop);
        self.opened = Some(OpenWindow::open(event_loop, instance, &self.options, (size, self.kept.place))?);
        self.report();
        self.resized();
        self.come_back();
        Ok(())
    }

    /// The size that the window opens with.
    pub(super) fn first_size(&self, event_loop: &ActiveEventLoop) -> PhysicalSize<u32> {
        let monitor = event_loop.primary_monitor().or_else(|| event_loop.available_monitors().next());
        let (scale, room) = monitor.map_or((1.0, None), |m| (m.scale_factor(), Some(m.size())));
        first_size(self.state.picture, self.kept.size, (scale, room))
    }

    /// Shows what an earlier window showed of the picture, once that is there, unless it was asked for something else.
    pub(super) fn come_back(&mut self) {
        let State { viewport, picture, .. } = &mut self.state;
        if *picture == Size::ZERO || self.opened.is_none() {
            return;
        }
        if let Some((zoom, x, y)) = self.kept.view.take().filter(|_| viewport.is_fitted()) {
            let (picture, area) = (self.state.picture, self.state.area());
            self.state.viewport.show(zoom, (x, y).into(), picture, area);
        }
    }

    /// Keeps how the window is for the next one.
    pub(super) fn keep(&mut self) {
        if let Some(opened) = &self.opened {
            self.kept.take(opened, &self.state);
            self.kept.keep(&self.options.screenshots);
        }
    }

    pub(super) fn resized(&mut self) {
        if let Some(opened) = &self.opened {
            let size = opened.window.inner_size();
            if size.width > 0 && size.height > 0 {
                self.state.resize(Size::new(size.width.into(), size.height.into()), opened.window.scale_factor());
            }
            self.redraw();
        }
    }

    pub(super) fn redraw(&self) {
        if let Some(opened) = &self.opened {
            opened.window.request_redraw();
        }
    }

    pub(super) fn run(&mut self, event_loop: &ActiveEventLoop, command: &str) {
        let played = self.state.transport.playing;
        match self.state.run(command) {
            Outcome::Redraw => self.redraw(),
            Outcome::FullScreen => self.opened.iter().for_each(OpenWindow::toggle_full_screen),
            Outcome::Window => self.opened.iter().for_each(OpenWindow::leave_full_screen),
            Outcome::Quit => event_loop.exit(),
            Outcome::Unknown => {}
        }
        if self.state.transport.playing != played {
            self.clock.start();
            self.state.dropped = 0;
            self.report();
        }
    }

    /// Makes a change that may move the time; the editor is told.
    pub(super) fn leading(&mut self, change: impl FnOnce(&mut App)) {
        let before = self.state.transport.clone();
        change(self);
        let now = &self.state.transport;
        if (now.playing, now.frame, now.speed) != (before.playing, before.frame, before.speed) {
            self.lead();
        }
    }

    /// Tells the editor how the animation runs.
    pub(super) fn lead(&self) {
        let State { transport, timeline, .. } = &self.state;
        let time = transport.scene_time(timeline) * timeline.duration;
        self.reply(Gesture::Transport(Transport { playing: transport.playing, time, speed: transport.speed }));
    }

    pub(super) fn reply(&self, reply: impl Into<ToEditor>) {
        // Nobody listens where a file is followed, or once the editor is gone: the window goes on.
        let _ = self.replies.send(reply.into());
    }

    /// Tells the editor how the window is doing, if that has changed.
    pub(super) fn report(&mut self) {
        self.state.fps = self.state.fps.filter(|_| self.plays_visibly());
        let Some(opened) = &self.opened else { return };
        let notice = self.state.words.for_editor(self.state.capture.is_some());
        let notice = notice.or(self.state.thin.words().map(str::to_owned)).unwrap_or_default();
        let fps = self.state.fps.unwrap_or(0.0).round();
        let adapter = opened.gpu.device().name();
        let report = Some((fps, notice.clone()));
        if self.reported != report {
            self.reported = report;
            self.reply(ToEditor::Report { fps, adapter, notice });
        }
        self.redraw();
    }

    pub(super) fn plays_visibly(&self) -> bool {
        self.state.transport.playing && self.opened.as_ref().is_some_and(|o| !o.hidden && !o.covered)
    }
}
