//! What the window hears of the scene that it follows: from its editor, and from the thread that synthesises.

use std::io::Write;
use std::time::{Duration, Instant};

use kurbo::{Point, Size};
use winit::event_loop::ActiveEventLoop;

use super::app::App;
use super::frames::{Frames, enough, held};
use super::show::{Show, name};
use super::state::State;
use super::words::Words;
use super::worker::{Ready, Sending, Sent};
use crate::base::error::Result;
use crate::base::problem::Problem;
use crate::preview::Transport;
use crate::preview::follow::Update;
use crate::preview::wire::message::{FromEditor, ToEditor};
use crate::render::{Synth, passes};

/// How long to wait for a scene before the window opens with a notice alone.
const PATIENCE: Duration = Duration::from_millis(500);
/// How far editor and window may be apart while both play, as a share of the timeline, before the window follows.
const APART: f64 = 0.05;
/// A command that no key gives: the device is lost. For tests of what follows.
const LOSE_DEVICE: &str = "lose-device";

impl App {
    /// Takes a scene that is ready. Until its pictures are on the GPU the window shows what it showed.
    pub(super) fn take(&mut self, event_loop: &ActiveEventLoop, ready: Ready) -> Result<()> {
        if self.opened.is_none() {
            self.load(&ready);
            self.open(event_loop)?;
        }
        self.waiting = Some(ready);
        self.send_next();
        Ok(())
    }

    /// Sends the latest scene to the GPU, one at a time.
    pub(super) fn send_next(&mut self) {
        if self.opened.is_none() || self.sending.is_some() {
            return;
        }
        let Some(ready) = self.waiting.take() else { return };
        let is_seen = |show: &&Show| show.synth.size == ready.synth.size;
        let zoom = self.shown.as_ref().filter(is_seen).map(|_| self.state.viewport.zoom);
        let by = self.held(&ready.synth).max(enough(ready.synth.size, zoom));
        self.send((ready.synth.clone(), by), Some(ready));
    }

    /// Sends the scene that is shown to the GPU again, finer or coarser, if the zoom asks for that.
    pub(super) fn follow_zoom(&mut self) {
        let Some(show) = &self.shown else { return };
        let ((width, height), by) = (show.synth.size, show.frames.by);
        let enough = enough(show.synth.size, Some(self.state.viewport.zoom));
        let wanted = self.held(&show.synth).max(enough).max(show.coarsest);
        let reduced = (by > enough).then(|| format!("{width} x {height} is shown reduced {by} times"));
        self.sending.iter().filter(|sending| sending.again.is_some_and(|by| by != wanted)).for_each(Sending::give_up);
        let sent = (wanted != by && self.sending.is_none() && self.waiting.is_none()).then(|| show.synth.clone());
        if self.state.words.reduced != reduced {
            self.state.words.reduced = reduced;
            self.report();
        }
        if let Some(synth) = sent {
            self.send((synth, wanted), None);
        }
    }

    /// How many times smaller the GPU of the window needs a scene.
    fn held(&self, synth: &Synth) -> usize {
        let most = self.opened.as_ref().map_or(usize::MAX, |opened| opened.gpu.device().max_side());
        held(synth, most.min(self.options.most))
    }

    fn send(&mut self, frames: (Synth, usize), ready: Option<Ready>) {
        let Some(opened) = &mut self.opened else { return };
        let proxy = self.proxy.clone();
        let send = move |event| proxy.send_event(event).is_ok();
        self.sending = Some(Sending::start(opened.gpu.uploader(), frames, ready, send));
    }

    /// Takes a scene whose pictures are on the GPU.
    pub(super) fn sent(&mut self, event_loop: &ActiveEventLoop, Sent { ready, made, lost }: Sent) -> Result<()> {
        let given_up = self.sending.take().is_some_and(|sending| sending.is_given_up());
        let Some(opened) = &mut self.opened else { return Ok(()) };
        match (made, ready) {
            (Ok((frames, uploaded)), ready) => {
                opened.gpu.take(uploaded);
                self.state.work = None;
                match (ready, &mut self.shown) {
                    (Some(ready), _) => self.show(event_loop, ready, frames),
                    (None, Some(show)) => show.frames = frames,
                    (None, None) => {}
                }
                self.marks.revision += 1;
                self.redraw();
            }
            // It is sent again to the device that takes its place: at once, or by the drawing that opens it.
            (Err(_), ready) if lost => {
                let still = opened.gpu.device().is_lost();
                self.waiting = self.waiting.take().or(ready);
                self.redraw();
                if still {
                    return Ok(());
                }
            }
            (Err(error), Some(_)) => return Err(error),
            // It stays as it is seen.
            (Err(error), None) => {
                self.state.work = None;
                if !given_up {
                    self.state.words.told = Some(error.to_string());
                    self.shown.iter_mut().for_each(|show| show.coarsest = show.frames.by);
                }
                self.redraw();
            }
        }
        self.send_next();
        Ok(())
    }

    fn load(&mut self, ready: &Ready) {
        let (width, height) = ready.synth.size;
        self.state.load(Size::new(width as f64, height as f64), &ready.scene.timeline);
        self.state.take_camera(ready.synth.stage.seen_by(), ready.around);
        self.state.layers.clone_from(&ready.synth.layers);
        self.state.passes = passes::shown(&ready.scene);
    }

    fn show(&mut self, event_loop: &ActiveEventLoop, ready: Ready, frames: Frames) {
        self.hurry.changed(Instant::now());
        self.state.see(ready.sight.clone());
        self.load(&ready);
        self.come_back();
        // A window that opened without a picture stays as it is until there is one.
        self.grows_to = self.shown.is_none().then(|| self.first_size(event_loop));
        let Ready { document, scene, synth, marks, .. } = ready;
        self.shown = Some(Show { document, scene, synth, frames, coarsest: 1, marks });
        self.state.otherwise = ready.otherwise;
        self.state.words.follow_scene(ready.problems);
        self.owed = Some(ToEditor::Ack { revision: ready.revision, synth_ms: ready.synth_ms });
        self.select(self.state.selection.clone());
        self.report();
    }

    /// Takes what comes from the editor.
    pub(super) fn follow(&mut self, event_loop: &ActiveEventLoop, update: Update) {
        match update {
            Update::Scene { .. } => {} // comes as Ready, synthesised
            Update::Progress(line) => self.say(|words| words.progress = Some(line).filter(|line| !line.is_empty())),
            Update::Said(said) => self.hear(event_loop, said),
        }
        self.redraw();
    }

    fn hear(&mut self, event_loop: &ActiveEventLoop, said: FromEditor) {
        match said {
            FromEditor::Selection(pointer) => self.select(pointer),
            FromEditor::Cursor(at) => self.state.cursor = at.map(Point::from),
            FromEditor::Transport(transport) => self.join_in(transport),
            FromEditor::Look { camera, .. } => self.state.look_from(camera.as_ref()),
            FromEditor::Ask(nth) => {
                self.tell_view();
                self.reply(ToEditor::Answer(nth));
            }
            FromEditor::View(command) if command == LOSE_DEVICE => {
                self.opened.iter().for_each(|opened| opened.gpu.device().raw.destroy());
            }
            FromEditor::View(command) => self.run(event_loop, &command),
            FromEditor::Notice(line) => self.say(|words| words.notice = Some(line).filter(|line| !line.is_empty())),
            FromEditor::Problems(problems) => {
                self.complain(&problems);
                self.say(|words| words.follow_link(problems));
            }
            FromEditor::Bye(_) => event_loop.exit(),
            // Answered by whoever follows the scene for the window.
            FromEditor::Hello { .. } | FromEditor::Patch { .. } | FromEditor::Scene { .. } | FromEditor::Alive => {}
            FromEditor::Views(_) | FromEditor::Images(_) | FromEditor::Piece { .. } | FromEditor::Edited(_) => {}
        }
    }

    /// Says something; a window that has nothing to show opens for that after a while.
    fn say(&mut self, what: impl FnOnce(&mut Words)) {
        what(&mut self.state.words);
        self.open_by.get_or_insert(Instant::now() + PATIENCE);
    }

    /// As long as there is no picture, also writes what is wrong to standard error: the window may never open.
    fn complain(&self, problems: &[Problem]) {
        if self.shown.is_none() && self.options.complains {
            let lines: String = problems.iter().map(|p| format!("plica: {}: {p}\n", self.options.name)).collect();
            // Standard error may be closed.
            drop(std::io::stderr().write_all(lines.as_bytes()));
        }
    }

    fn select(&mut self, pointer: Option<String>) {
        let named = pointer.as_deref().zip(self.shown.as_ref());
        let named = named.and_then(|(pointer, show)| name(&show.scene, pointer));
        self.state.select(pointer, named);
        self.redraw();
    }

    /// Plays or pauses as the editor does. A window in which the time is dragged leads, and two running clocks that nearly
    /// agree are left alone.
    fn join_in(&mut self, Transport { playing, time, speed }: Transport) {
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
    pub(super) fn warn(&mut self, event_loop: &ActiveEventLoop, problems: Vec<Problem>) -> Result<()> {
        self.complain(&problems);
        self.state.work = None;
        self.state.words.follow_scene(problems);
        self.open(event_loop)?;
        self.report();
        self.redraw();
        Ok(())
    }
}
