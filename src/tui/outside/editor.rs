//! The running editor: its state, and the terminal, threads, files and windows around it. One of three loops feeds it events:
//! on a screen (screen.rs), for a script (script.rs), or line by line (lines.rs).

use super::job::Job;
use super::options::Options;
use super::scripts::Scripts;
use super::throttle::Throttle;
use super::worker::Worker;
use super::{ask, input, pace, terminal};
use crate::base::error::{Error, Result};
use crate::files;
use crate::files::lines;
use crate::files::lines::Log;
use crate::files::materials::Watched;
use crate::files::watch::Watch;
use crate::preview::editor::{self, Preview};
use crate::preview::wire::message::FromEditor;
use crate::scene::{FRAME, Scene};
use crate::tui::commands;
use crate::tui::commands::update::update;
use crate::tui::commands::waiting::awaits_pictures;
use crate::tui::document::choice::{Choice, Then};
use crate::tui::document::open_scene::OpenScene;
use crate::tui::events::{Effect, Event};
use crate::tui::graphics;
use crate::tui::graphics::request::Request;
use crate::tui::layout::picture;
use crate::tui::panes::marks::Kept;
use crate::tui::state::tutor::Tutor;
use crate::tui::state::{Message, Mode, Pane, State, USUAL, kept};
use crate::tui::text::color::Depth;
use crate::tui::text::plain;
use std::path::Path;
use std::sync::{Arc, mpsc};
use std::time::{Duration, Instant};

/// A running editor.
pub struct Editor {
    /// How it was opened.
    pub(super) options: Options,
    /// The state.
    pub(super) state: State,
    /// The terminal; `None` if only a script is run.
    pub(super) screen: Option<terminal::Screen>,
    /// Threads send their events here.
    pub(super) sender: mpsc::Sender<Event>,
    /// The thread that synthesises.
    pub(super) worker: Worker,
    /// The subcommand that is running.
    pub(super) job: Option<Job>,
    /// The windows.
    pub(super) preview: Preview,
    /// The last message about the window.
    pub(super) window_told: String,
    /// Watches the files of the scene; `None` if they cannot be watched.
    pub(super) watch: Option<Watch>,
    /// Which those are.
    pub(super) watched: Watched,
    /// The scripts that are running.
    pub(super) scripts: Scripts,
    /// The log of the session; `None` if there is no folder for it.
    pub(super) log: Option<Log>,
    /// Limits how often the worker is asked for pictures.
    pub(super) throttle: Throttle,
    /// The scene of which a script waits for what is shown.
    pub(super) awaited: Option<Arc<Scene>>,
    /// Whether the editor is about to end.
    pub(super) leaving: bool,
    /// Whether the screen is set up again after a stop of its own, of which the end is still to be told.
    pub(super) returned: bool,
    /// Whether a signal has ended it.
    pub(super) interrupted: bool,
    /// When the drawing began that the terminal has not fully read yet.
    pub(super) drawn: Option<Instant>,
    /// What is kept from one drawing to the next.
    pub(super) kept: Kept,
}

/// How long the terminal has to read the rest of the output when the editor ends.
const LAST_LOOK: Duration = Duration::from_millis(500);

/// How long scripts run before the screen and the keys have their turn.
const TURN: Duration = Duration::from_millis(20);

impl Editor {
    /// Starts the editor.
    ///
    /// # Errors
    /// The terminal cannot be asked for its size, or the first script cannot be read.
    pub fn new(
        options: Options,
        scene: OpenScene,
        screen: Option<terminal::Screen>,
        sender: mpsc::Sender<Event>,
    ) -> Result<Self> {
        let size = screen.as_ref().map(|screen| screen.size()).transpose().map_err(|e| Error::at("the terminal", e))?;
        let size = size.map_or(USUAL, |size| (size.width, size.height));
        let depth = Depth::of_environment(|name| std::env::var(name).ok());
        let mut typed = Vec::new();
        let mut graphics = graphics::Graphics::default();
        if screen.is_some() {
            let mut pieces = input::Pieces::new();
            (graphics, typed) = ask::ask(options.graphics, &mut pieces, |name| std::env::var(name).ok());
            input::read(pieces, sender.clone());
        }
        let worker = Worker::start(options.files.clone(), sender.clone());
        let preview = listen(&scene, &options.files, sender.clone());
        let changed = sender.clone();
        // Without a watch, changes from outside are noticed when saving.
        let watch = Watch::new(move |files| drop(changed.send(Event::FilesChanged(files))));
        let watch = watch.inspect_err(|error| tracing::warn!("{error}")).ok();
        let log = begin_log(&scene, size, sender.clone());
        let mut state = State::new(scene, size, depth);
        state.memory.recorder.set_place(log.as_ref().map(|log| log.path().to_owned()));
        state.picture.graphics = graphics;
        let mut editor = Editor {
            options,
            state,
            screen,
            sender,
            worker,
            job: None,
            preview,
            window_told: String::new(),
            watch,
            watched: Watched::default(),
            scripts: Scripts::default(),
            log,
            throttle: Throttle::default(),
            awaited: None,
            leaving: false,
            returned: false,
            interrupted: false,
            drawn: None,
            kept: Kept::default(),
        };
        editor.enter(&typed)?;
        Ok(editor)
    }

    /// What happens before the first key: keymap, what was kept, lessons, what was `typed` meanwhile, window and script.
    fn enter(&mut self, typed: &[input::Piece]) -> Result<()> {
        if self.screen.is_some() {
            self.state.memory.recall(files::kept::read(files::kept::EDITOR));
        }
        self.begin();
        self.load_keys();
        self.begin_tutor();
        typed.iter().filter_map(input::event).for_each(|event| self.take(event));
        if self.options.window && self.screen.is_some() && editor::opens_by_itself() {
            self.preview.open_window();
        }
        if let (Some(keep), true) = (self.options.keep_recovery, self.state.scene.offered().is_some()) {
            self.take(Event::Line(format!("recovery {}", if keep { "keep" } else { "drop" })));
        }
        if let Some((path, text)) = self.options.script.clone() {
            self.scripts.begin(&path.display().to_string(), &text)?;
        }
        Ok(())
    }

    /// Begins the lessons. The tutor's folder becomes the current one, so that its output is beside its scene.
    pub fn begin_tutor(&mut self) {
        let Some(folder) = self.options.tutor.clone() else { return };
        if let Err(error) = std::env::set_current_dir(&folder) {
            tracing::warn!("{}: {error}", folder.display());
        }
        self.state.tutor = Some(Tutor::begin());
    }

    /// What is done once for each scene that is opened.
    pub fn begin(&mut self) {
        self.state.picture.size = picture_size(&self.state);
        self.resume();
        let greeting = self.state.scene.greeting(editor::way_home(self.state.scene.path()));
        self.state.say(greeting);
        self.watch_files();
        // Tell windows the selection before the first key.
        self.perform(Effect::Show);
    }

    /// Goes to where an earlier session has left the scene. Scripts begin where a scene begins.
    fn resume(&mut self) {
        if self.screen.is_none() || self.options.script.is_some() {
            return;
        }
        // A question that waits goes on waiting.
        let mode = std::mem::replace(&mut self.state.typing.mode, Mode::Normal);
        for line in kept::places(files::kept::read(files::kept::EDITOR), self.state.scene.path()) {
            // A place that is gone is left out.
            let _ = commands::obey(&mut self.state, &line, None);
        }
        self.state.typing.mode = mode;
        self.state.memory.recorder.end_preface();
    }

    /// Keeps what the next session may have.
    pub(super) fn keep(&mut self) {
        if self.screen.is_none() {
            return;
        }
        let mut kept = self.state.memory.keep(files::kept::read(files::kept::EDITOR));
        // Lessons have a new scene each time.
        if self.state.tutor.is_none() {
            kept = kept::keep_places(&self.state, kept, self.state.scene.path());
        }
        files::kept::write(files::kept::EDITOR, &kept);
    }

    /// Watches the scene and all files that it names.
    pub fn watch_files(&mut self) {
        let Some(watch) = &mut self.watch else { return };
        let path = self.state.scene.path();
        let mut all = self.watched.files(path, self.state.document().scene(), &self.options.files);
        all.push(path.to_owned());
        if let Err(error) = watch.set(&all) {
            tracing::warn!("{error}");
        }
    }

    /// Whether a signal has ended it.
    ///
    /// # Errors
    /// It was interrupted.
    pub fn ended(&self) -> Result<()> {
        if self.interrupted { Err(Error::Interrupted) } else { Ok(()) }
    }

    /// Ends work and writes everything to disk.
    pub fn end(&mut self) {
        self.state.scene.tend();
        self.state.scene.flush();
        self.job.take().into_iter().for_each(Job::end);
        self.keep();
        self.log = None;
    }

    /// Gives the terminal a moment to read the rest of the output.
    pub fn drain(&mut self) {
        self.screen.iter_mut().for_each(|screen| pace::drain(screen.backend_mut(), LAST_LOOK));
    }

    /// Handles an event and performs its effects.
    pub fn take(&mut self, event: Event) {
        match &event {
            // Cells may be lost even if the terminal has its old size again.
            Event::Resize(..) => self.screen.iter_mut().for_each(|screen| drop(terminal::forget(screen))),
            // Keys are judged by the present size, of which the signal may not have arrived yet.
            Event::Key(_) | Event::Paste(_) if self.screen.is_some() => {
                self.state.size = terminal::size().unwrap_or(self.state.size);
            }
            _ => {}
        }
        if let (Event::Resize(..), Some(cell)) = (&event, ask::cell()) {
            self.state.picture.graphics.cell = cell;
        }
        self.interrupted |= matches!(event, Event::End);
        let effects = update(&mut self.state, event);
        if let Some(log) = &self.log {
            self.state.memory.recorder.unwritten().iter().for_each(|line| log.write(line.clone()));
        }
        for effect in effects {
            self.perform(effect);
        }
        let in_picture = self.state.cursor.focus == Pane::Picture;
        let cursor = in_picture.then_some(self.state.picture.cursor).map(|at| (at.x, at.y));
        self.preview.say(FromEditor::Cursor(cursor));
    }

    /// Begins the script of a file.
    ///
    /// # Errors
    /// It cannot be read, or scripts run one another endlessly.
    pub fn source(&mut self, path: &Path) -> Result<()> {
        let text = lines::read(path)?;
        self.scripts.begin(&path.display().to_string(), &text)
    }

    /// Runs a line as if it was typed.
    ///
    /// # Errors
    /// Why it could not be done.
    pub fn obey(&mut self, line: String) -> std::result::Result<(), String> {
        self.take(Event::Line(line));
        self.refused()
    }

    pub fn refused(&self) -> std::result::Result<(), String> {
        match &self.state.message {
            Some(Message { text, bad: true, .. }) => Err(text.clone()),
            _ => Ok(()),
        }
    }

    /// Runs the next line of the scripts, unless the long work of the last line is still running. A mistake ends all scripts.
    /// False if there is nothing to run now.
    ///
    /// # Errors
    /// FILE:LINE and the mistake.
    pub fn run_next(&mut self) -> Result<bool> {
        if self.state.outside.work.is_some() || self.leaving {
            return Ok(false);
        }
        let (place, done) = match self.scripts.waits.take() {
            Some(place) => (place, self.refused()),
            None => match self.scripts.next() {
                Some((place, line)) if self.awaits(&line) => {
                    self.scripts.hold(place, line);
                    return Ok(false);
                }
                Some((place, line)) => (place, self.obey(line)),
                None => return Ok(false),
            },
        };
        if let Err(why) = done {
            self.scripts = Scripts::default();
            return Err(Error::at(place, why).cure("nothing after it was run"));
        }
        self.scripts.waits = self.state.outside.work.is_some().then_some(place);
        Ok(true)
    }

    /// Whether a line has to wait for what is shown, which without a screen nobody else asks for.
    pub fn awaits(&mut self, line: &str) -> bool {
        if !awaits_pictures(&self.state, line) {
            return false;
        }
        let scene = self.state.document().scene();
        if !self.awaited.as_ref().is_some_and(|awaited| Arc::ptr_eq(awaited, scene)) {
            self.awaited = Some(scene.clone());
            if self.screen.is_none() {
                self.worker.ask(Request { picture: None, probe: None, ..picture::request(&self.state) });
            }
        }
        true
    }

    /// Whether scripts have something to do now.
    pub fn scripts_go_on(&self) -> bool {
        !self.scripts.is_empty() && !self.scripts.holds() && self.state.outside.work.is_none()
    }

    /// Runs the scripts for a short while, and shows a mistake with its place.
    pub fn run_scripts(&mut self) {
        let begun = Instant::now();
        while begun.elapsed() < TURN {
            match self.run_next() {
                Ok(true) => {}
                Ok(false) => return,
                Err(error) => return self.state.complain(error.to_string()),
            }
        }
    }

    /// Takes the messages of the last line.
    pub fn said(&mut self) -> Vec<String> {
        let pages = match std::mem::replace(&mut self.state.typing.mode, Mode::Normal) {
            Mode::Pages(pages) => pages.lines,
            Mode::Choice(Choice { options, then: Then::Go | Then::Replace(_), .. }) => {
                options.into_iter().map(|(place, text)| format!("{place}: {text}")).collect()
            }
            mode => {
                self.state.typing.mode = mode;
                Vec::new()
            }
        };
        self.state.message.take().into_iter().map(|message| message.text).chain(pages).collect()
    }
}

/// Listens for windows of the scene; their messages arrive as events.
pub fn listen(scene: &OpenScene, options: &files::Options, sender: mpsc::Sender<Event>) -> Preview {
    let preview = Preview::start(scene.path(), scene.document(), scene.revision(), move |said| {
        // Nobody listens once the editor has left.
        let _ = sender.send(Event::Window(said));
    });
    preview.with_options(options)
}

/// Begins the log of this session. If it cannot be written, the editor gets an event.
fn begin_log(scene: &OpenScene, (width, height): (u16, u16), sender: mpsc::Sender<Event>) -> Option<Log> {
    let header = vec![
        format!("plica {}", env!("CARGO_PKG_VERSION")),
        format!("scene {}", plain(&scene.path().display().to_string())),
        format!("terminal {width} x {height}"),
    ];
    // Nobody listens once the editor has left.
    Log::begin(scene.path(), header, move |why| drop(sender.send(Event::Unlogged(why))))
}

/// The size of a frame, as far as the document and the header of a picture tell.
fn picture_size(state: &State) -> Option<(usize, usize)> {
    let scene = state.document().scene();
    if let Some([width, height]) = scene.size {
        return Some((width as usize, height as usize));
    }
    let Some(image) = scene.layers.iter().find_map(|layer| layer.technique().frame_of()) else { return Some(FRAME) };
    let (sizes, _) = files::materials::sizes(state.scene.path(), state.document().scene(), state.scene.options());
    sizes.get(image).copied()
}
