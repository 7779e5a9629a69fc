//! What is open once there is something to show: the window with its GPU and surface, and one drawing of it.

use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use kurbo::Size;
use winit::dpi::{LogicalSize, PhysicalPosition, PhysicalSize};
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::window::{CursorIcon, Fullscreen, Window};

use super::capture::{self, Capture, Round};
use super::chrome;
use super::grasp::Held;
use super::mouse::Shape;
use super::options::{PLACE, WindowOptions};
use super::own_view::OwnView;
use super::pass::{self, For};
use super::screen::{Pictures, Presented, Screen, Strokes};
use super::show::{Cached, Show, seen, thinned, under};
use super::state::{BAR_PX, State};
use super::text::Letters;
use super::worker::Event;
use super::x11::Desk;
use crate::base::error::{Error, Result};
use crate::base::pixels::Frame;
use crate::export::still;
use crate::files::write;
use crate::render::Synth;
use crate::render::gpu::Gpu;
use crate::render::overlay::jump_at;
use crate::render::passes::Asked;

/// Smallest and first size of a window, in logical pixels.
const SMALLEST: (f64, f64) = (480.0, 320.0);
/// A window is made no smaller than this, if the window manager obeys.
const LEAST: (f64, f64) = (360.0, 240.0);
/// How often to check whether the window can be seen, while it can.
const LOOK: Duration = Duration::from_millis(250);
const FIRST: (f64, f64) = (960.0, 640.0);
/// A window opens on at most this share of the monitor.
const MOST_OF_MONITOR: f64 = 0.85;
/// Frames a second if the monitor does not tell.
const RATE: f64 = 60.0;

/// What is open once there is something to show.
pub struct OpenWindow {
    pub window: Arc<Window>,
    pub gpu: Gpu,
    pub screen: Screen,
    /// Nothing of it can be seen: it is minimised, or on another desktop.
    pub hidden: bool,
    /// Other windows lie over all of it.
    pub covered: bool,
    desk: Option<Desk>,
    looked: Option<Instant>,
    shape: Shape,
    passes: pass::KeptPasses,
    /// From where it was found out whether anything is seen: the window's own view, the scene time and the scene.
    looked_from: Option<(OwnView, f64, u64)>,
    /// Whether the CPU makes the picture.
    by_cpu: bool,
    /// See [`WindowOptions::screenshots`].
    screenshots: PathBuf,
    /// What encodes a round that is being captured.
    pub capture: Option<Capture>,
}

impl OpenWindow {
    /// Opens the window. If the person did not ask for it at this moment, it does not take the keyboard focus.
    pub fn open(
        event_loop: &ActiveEventLoop,
        instance: wgpu::Instance,
        options: &WindowOptions,
        (size, place): (PhysicalSize<u32>, Option<(i32, i32)>),
    ) -> Result<OpenWindow> {
        let mut attributes = Window::default_attributes()
            .with_title(format!("{} - plica", options.name))
            .with_inner_size(size)
            .with_min_inner_size(LogicalSize::<f64>::from(LEAST))
            .with_active(options.takes_keyboard)
            .with_visible(options.takes_keyboard);
        attributes.position = place.map(|(x, y)| PhysicalPosition::new(x, y).into());
        let window = Arc::new(event_loop.create_window(attributes).map_err(|e| Error::at(PLACE, e))?);
        let desk = Desk::of(&window);
        if !options.takes_keyboard {
            desk.iter().for_each(Desk::leave_the_keyboard);
            window.set_visible(true);
        }
        let (gpu, screen) = Screen::open(instance, window.clone())?;
        let (shape, passes, looked_from, by_cpu) = Default::default();
        let (hidden, covered, looked) = Default::default();
        let screenshots = options.screenshots.clone();
        Ok(OpenWindow {
            window,
            gpu,
            screen,
            hidden,
            covered,
            desk,
            looked,
            shape,
            passes,
            looked_from,
            by_cpu,
            screenshots,
            capture: None,
        })
    }

    /// The same window on a new device.
    pub fn anew(self) -> Result<OpenWindow> {
        let instance = self.gpu.instance().clone();
        drop((self.gpu, self.screen)); // a window has one surface at a time
        let (gpu, screen) = Screen::open(instance, self.window.clone())?;
        let (passes, looked_from, by_cpu) = Default::default();
        Ok(OpenWindow { gpu, screen, hidden: false, looked: None, passes, looked_from, by_cpu, ..self })
    }

    /// Whether the window can be seen: checked now and then while it can, and at every drawing while it cannot.
    pub fn is_seen(&mut self) -> bool {
        let due = self.hidden || self.looked.is_none_or(|looked| looked.elapsed() >= LOOK);
        if let Some(desk) = self.desk.as_ref().filter(|_| due) {
            self.looked = Some(Instant::now());
            self.hidden = !desk.is_seen() || self.window.is_minimized() == Some(true);
        }
        self.desk.is_none() || !self.hidden
    }

    /// See [`Desk::take_the_keyboard`].
    pub fn clicked(&self) {
        self.desk.iter().for_each(Desk::take_the_keyboard);
    }

    /// The keys that are held with the mouse, if somebody else has the keyboard and that can be known.
    pub fn held_elsewhere(&self) -> Option<Held> {
        self.desk.as_ref().filter(|_| !self.window.has_focus())?.held()
    }

    /// See [`Desk::wheel_is_a_button`].
    pub fn wheel_is_a_button(&self) -> bool {
        self.desk.as_ref().is_some_and(Desk::wheel_is_a_button)
    }

    /// Gives the pointer a shape.
    pub fn point(&mut self, shape: Shape) {
        if self.shape != shape {
            self.shape = shape;
            self.window.set_cursor(match shape {
                Shape::Arrow => CursorIcon::Default,
                Shape::Hand => CursorIcon::Pointer,
                Shape::Across => CursorIcon::EwResize,
                Shape::Held => CursorIcon::Grabbing,
            });
        }
    }

    /// Draws all that the window shows.
    pub fn paint(
        &mut self,
        state: &mut State,
        show: Option<&Show>,
        marks: &mut Cached,
        (letters, wake): (&Letters, &EventLoopProxy<Event>),
    ) -> Result<Presented> {
        let pictures = match show {
            Some(show) => {
                marks.follow(state, show, letters);
                state.reach = marks.reach;
                state.grips = [&marks.grips[..], &marks.moving_grips].concat();
                let asked = state.pointed().filter(|_| state.shows_vectors());
                state.jump = asked.and_then(|at| jump_at(&show.synth, at));
                let in_space = state.pointed().filter(|_| state.camera.is_some());
                state.under = in_space.and_then(|at| {
                    let synth = seen(&show.synth, state.own_camera().as_ref());
                    let only = Asked::only_shown(state.pass.as_deref(), &show.scene).map(|layer| synth.only(layer));
                    let synth = only.as_ref().unwrap_or(&synth);
                    under(&show.scene, synth, state.transport.scene_time(&state.timeline), at)
                });
                let pictures = self.pictures(state, show, (marks.revision, wake))?;
                let looks = state.own.map(|own| (own, state.transport.scene_time(&state.timeline), marks.revision));
                if std::mem::replace(&mut self.looked_from, looks) != looks {
                    let from = |(own, t, _): (OwnView, f64, u64)| (seen(&show.synth, Some(&own.camera())), t);
                    let nothing = |(synth, t): (Cow<Synth>, f64)| !synth.shows_something(t);
                    state.sees_nothing = looks.map(from).is_some_and(nothing);
                }
                // An older frame would show something else there.
                state.under.take_if(|_| state.drawing);
                pictures
            }
            None => self.nothing()?,
        };
        let chrome = chrome::draw(state, letters);
        let layers =
            [&marks.fixed, &marks.moving, &marks.dragged, &marks.labels, &chrome].map(|canvas| &canvas.strokes[..]);
        let strokes = Strokes { layers, letters };
        let drawn = self.screen.draw(&self.gpu, state, &pictures, &strokes);
        self.keep(state, (&pictures, &strokes), wake);
        self.gpu.device().take_uncaught()?;
        drawn
    }

    /// Saves what is shown, where that was asked for: once, and as the next frame of a round.
    fn keep(&mut self, state: &mut State, shown: (&Pictures, &Strokes<'_>), wake: &EventLoopProxy<Event>) {
        if std::mem::take(&mut state.screenshot) {
            let screenshot = self.screen.screenshot(&self.gpu, state, shown.0, shown.1);
            let saved = screenshot.and_then(|screenshot| self.save(&screenshot));
            state.words.told = Some(saved.unwrap_or_else(|error| error.to_string()));
            self.window.request_redraw();
        }
        let Some(round) = state.capture.take() else {
            self.capture = None;
            return;
        };
        // What is drawn may be an older picture.
        let is_due = state.has_picture() && !state.drawing && round.next(&state.transport, &state.timeline).is_some();
        let kept = if is_due { self.capture(round, state, shown, wake) } else { Ok(round) };
        match kept {
            Ok(round) => {
                state.words.progress = Some(round.words());
                state.capture = Some(round);
            }
            Err(error) => {
                state.words.progress = None;
                state.words.told = Some(error.to_string());
                self.capture = None;
            }
        }
        if is_due {
            self.window.request_redraw();
        }
    }

    /// Takes what is shown above the bar as the next frame of a round.
    fn capture(
        &mut self,
        mut round: Round,
        state: &State,
        (pictures, strokes): (&Pictures, &Strokes<'_>),
        wake: &EventLoopProxy<Event>,
    ) -> Result<Round> {
        let shown = self.screen.screenshot(&self.gpu, state, pictures, strokes)?;
        let (width, height) = (shown.width(), shown.height().min(state.area().height as usize).max(1));
        let frame = Frame::from_cells(width, height, shown.cells()[..width * height].to_vec());
        let capture = match &mut self.capture {
            Some(capture) => capture,
            none => {
                let wake = wake.clone();
                // If the window is gone by then, nobody reads it.
                let told = move |told| drop(wake.send_event(Event::Captured(told)));
                none.insert(Capture::begin(&self.screenshots, &round, (width, height), told)?)
            }
        };
        capture.take(frame)?;
        round.took_one();
        Ok(round)
    }

    /// Saves a screenshot under the first name that is free; returns what is to be said of it.
    fn save(&self, screenshot: &Frame) -> Result<String> {
        let png = still::frame(screenshot).map_err(|error| Error::at(PLACE, error))?;
        let file = |stem: &str| format!("{stem}.png");
        let path = self.screenshots.with_file_name(file(&capture::free(&self.screenshots, "shot", file)?));
        write::write_new(&path, &png)?;
        Ok(format!("saved as {}", path.display()))
    }

    /// How long a new picture took, if there is one: a drawing that took `drawing`, or what was made beside it.
    pub fn took(&mut self, drawing: Duration) -> Option<Duration> {
        if self.by_cpu { self.passes.took() } else { Some(drawing) }
    }

    /// A picture with nothing in it.
    fn nothing(&mut self) -> Result<Pictures> {
        let frame = self.gpu.texture(&Synth { size: (1, 1), ..Synth::default() }, 0.0)?;
        Ok(Pictures { frame, other: None, scale: 1.0 })
    }

    fn pictures(
        &mut self,
        state: &mut State,
        show: &Show,
        (revision, wake): (u64, &EventLoopProxy<Event>),
    ) -> Result<Pictures> {
        let time = state.transport.scene_time(&state.timeline);
        let last = state.timeline.time_of(state.timeline.frames() - 1);
        let (frame, other) = if state.shows("view-seam") {
            ((&show.frames.moving, last), Some((&show.frames.moving, 0.0)))
        } else if state.shows("view-wipe") {
            ((&show.frames.moving, time), Some((&show.frames.still, 0.0)))
        } else {
            ((if state.shows("view-still") { &show.frames.still } else { &show.frames.moving }, time), None)
        };
        let own = state.own_camera();
        let frame = (&*seen(frame.0, own.as_ref()), frame.1);
        let other = other.map(|(synth, t)| (seen(synth, own.as_ref()), t));
        let asked = state.pass.as_deref().map(|pass| Asked::parse(pass, &show.scene)).transpose();
        state.no_pass = asked.as_ref().err().cloned();
        state.named_colors = asked.iter().flatten().flat_map(|asked| asked.colors(&show.scene)).collect();
        // Passes are drawn by the CPU, and so are sprites, strokes and view maps where the CPU would only pretend to be a GPU: that
        // takes several times as long.
        let much = show.has_sprites() || show.synth.takes_long();
        let by_cpu = self.gpu.by_cpu(&show.frames.moving).is_some() || much && self.gpu.device().is_software();
        let asked = asked.ok().flatten().or_else(|| by_cpu.then_some(Asked::FRAME));
        let was_by_cpu = std::mem::take(&mut self.by_cpu);
        state.drawing = false;
        let left_out = state.thin.left_out();
        let frame = (&*thinned(frame.0, left_out), frame.1);
        if let Some(asked) = asked {
            let times = (frame.1, other.as_ref().map(|(_, t)| *t), state.shows("view-still"));
            let wanted = For { asked, revision, own: state.own, times, left_out };
            let textures = self.passes.follow(&self.gpu, &wanted, (frame, other.clone()), wake)?;
            state.drawing = self.passes.is_making();
            // Until a pass is there, the frame that was shown stays.
            self.by_cpu = by_cpu || was_by_cpu || !state.drawing;
            if self.by_cpu {
                let scale = show.frames.scale() / self.passes.each.max(1) as f64;
                return textures.map_or_else(|| self.nothing(), |(frame, other)| Ok(Pictures { frame, other, scale }));
            }
        }
        let scale = show.frames.scale();
        let seen = state.viewport.seen(state.window, frame.0.size, scale);
        let (frame, other) = self.gpu.textures(frame, other.as_ref().map(|(synth, t)| (&**synth, *t)), seen)?;
        Ok(Pictures { frame, other, scale })
    }

    /// Fills the screen, or goes back to a window.
    pub fn toggle_full_screen(&self) {
        let full = self.window.fullscreen().is_none().then_some(Fullscreen::Borderless(None));
        self.window.set_fullscreen(full);
    }

    /// Goes back to a window.
    pub fn leave_full_screen(&self) {
        if self.window.fullscreen().is_some() {
            self.window.set_fullscreen(None);
        }
    }

    /// How long a frame of the display lasts.
    pub fn interval(&self) -> Duration {
        let rate = self.window.current_monitor().and_then(|m| m.refresh_rate_millihertz());
        Duration::from_secs_f64(1.0 / rate.map_or(RATE, |r| f64::from(r) / 1000.0).max(1.0))
    }
}

/// The size of a window around a picture, in physical pixels: that of an earlier one, otherwise as large as the picture is in
/// logical ones. `room` is the monitor's.
pub fn first_size(
    picture: Size,
    earlier: Option<(u32, u32)>,
    (scale, room): (f64, Option<PhysicalSize<u32>>),
) -> PhysicalSize<u32> {
    if let Some((width, height)) = earlier {
        let most = room.unwrap_or(PhysicalSize::new(u32::MAX, u32::MAX));
        return PhysicalSize::new(width.min(most.width), height.min(most.height));
    }
    let first = if picture == Size::ZERO { Size::from(FIRST) } else { picture } * scale;
    let side = |wanted: f64, least: f64, room: Option<u32>| {
        let most = room.map_or(f64::INFINITY, |r| f64::from(r) * MOST_OF_MONITOR);
        wanted.max(least * scale).min(most).round() as u32
    };
    let bar = (BAR_PX * scale).round();
    PhysicalSize::new(
        side(first.width, SMALLEST.0, room.map(|r| r.width)),
        side(first.height + bar, SMALLEST.1, room.map(|r| r.height)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_opens_around_its_picture_within_the_monitor() {
        let room = Some(PhysicalSize::new(1000, 1000));
        for (picture, scale, size) in [
            (Size::ZERO, 1.0, (850, 674)),
            (Size::new(600.0, 400.0), 1.0, (600, 434)),
            (Size::new(10.0, 10.0), 1.0, (480, 320)),
            (Size::new(5000.0, 10.0), 1.0, (850, 320)),
            (Size::new(560.0, 400.0), 1.5, (840, 651)),
            (Size::new(200.0, 100.0), 1.5, (720, 480)),
        ] {
            assert_eq!(first_size(picture, None, (scale, room)), size.into(), "{picture:?}");
        }
        for (earlier, size) in [((700, 333), (700, 333)), ((4000, 900), (1000, 900))] {
            assert_eq!(first_size(Size::ZERO, Some(earlier), (1.0, room)), size.into());
        }
    }
}
