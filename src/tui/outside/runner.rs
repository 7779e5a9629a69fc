//! Runs the editor: events in, effects out. The only place that knows the terminal, the threads, the files and the window.

use crate::tui::state::USUAL;
use crate::tui::text::plain;
use std::io::Write;
use std::path::PathBuf;
use std::sync::mpsc;
use std::time::{Duration, Instant};

use super::script::Scripts;
use super::throttle::Throttle;
use super::worker::{Job, Worker};
use super::{ask, input, lines, pace, terminal};
use crate::base::error::{Error, Result};
use crate::base::fault;
use crate::base::system::signals::{self, Answer, Signal};
use crate::files::lines::Log;
use crate::files::profiles;
use crate::files::session::Mode;
use crate::files::watch::Watch;
use crate::preview::editor::{self, Preview, Status};
use crate::tui::commands::update::update;
use crate::tui::document::door::Door;
use crate::tui::events::{Effect, Event};
use crate::tui::graphics;
use crate::tui::graphics::Protocol;
use crate::tui::layout::seeing;
use crate::tui::panes::view;
use crate::tui::state::State;
use crate::tui::state::transport::Stopwatch;
use crate::tui::state::tutor::Tutor;
use crate::tui::text::colour::Depth;
use crate::{files, ops};

/// How the editor is opened.
pub struct Options {
    /// A scene, or a picture whose scene lies beside it.
    pub path: PathBuf,
    /// Whether to open the preview window where there is a display.
    pub window: bool,
    /// Whether the scene may only be looked at.
    pub read_only: bool,
    /// Whether unsaved edits that a session left behind are taken; none: that is asked.
    pub keep_recovery: Option<bool>,
    /// The lines that are run at first.
    pub script: Option<PathBuf>,
    /// The folder of the tutor, where it is to begin.
    pub tutor: Option<PathBuf>,
    /// How the picture is shown; none: as the terminal answers.
    pub graphics: Option<Protocol>,
    /// How files are read.
    pub files: files::Options,
}

impl Options {
    /// As `plica edit` without options.
    pub fn new(path: PathBuf) -> Options {
        let files = files::Options::default();
        let (keep_recovery, script, graphics, tutor) = (None, None, None, None);
        Options { path, window: true, read_only: false, keep_recovery, script, graphics, tutor, files }
    }

    /// How a scene is opened: where somebody else edits it, the person is asked, if there is one.
    pub(super) fn mode(&self) -> Mode {
        match (self.read_only, lines::is_interactive()) {
            (true, _) => Mode::ReadOnly,
            (false, true) => Mode::EditOrLook,
            (false, false) => Mode::Edit,
        }
    }

    /// The tutor, on a scene of its own in a new folder.
    ///
    /// # Errors
    /// The folder cannot be made, or there is no terminal that shows the lessons.
    pub fn tutor() -> Result<Options> {
        if !terminal::is_there() {
            return Err(
                Error::at("the terminal", "cannot show the lessons").cure("the tutor needs a screen to draw on")
            );
        }
        let folder = profiles::TUTOR.fresh()?;
        let path = profiles::TUTOR.unpack(&folder)?;
        Ok(Options { tutor: Some(folder), ..Options::new(path) })
    }

    /// As the command line says.
    ///
    /// # Errors
    /// A wrong limit.
    pub fn of(args: &ops::edit::Args) -> Result<Options> {
        let files = args.scene.options()?;
        let (path, script) = (args.path.clone(), args.script.clone());
        let graphics = Protocol::named(&args.graphics);
        let (window, read_only, keep_recovery) = (!args.no_view, args.read_only, args.recovery.keep());
        Ok(Options { path, window, read_only, keep_recovery, script, graphics, tutor: None, files })
    }
}

/// How often a terminal that does not read is looked at.
const BEHIND: Duration = Duration::from_millis(20);

/// How long a terminal has to read what is left, before the editor leaves it.
const LAST_LOOK: Duration = Duration::from_millis(500);

/// How long the editor has to end by itself once the system asks for it.
const GRACE: Duration = Duration::from_secs(2);

/// Opens the scene, edits it until the person leaves, and gives the terminal back.
///
/// # Errors
/// The scene cannot be opened, or there is no terminal.
pub fn run(options: Options) -> Result<()> {
    let door = Door::open(&options.path, options.mode(), &options.files)?;
    let (sender, events) = mpsc::channel();
    let unseen = !terminal::is_there();
    let _signals = end_on_signals(sender.clone(), unseen && lines::is_interactive())?;
    if unseen {
        let script = options.script.is_some();
        let editor = Editor::new(options, door, None, sender)?;
        return if script { editor.run_unseen(&events) } else { editor.run_lines(&events) };
    }
    let faults = sender.clone();
    // Nobody listens once the editor has left.
    terminal::on_panic(move |fault| drop(faults.send(Event::Fault(fault))));
    let screen = terminal::enter()?;
    // A panic in a loop over all cores comes back to this thread without a word of its own.
    let result =
        fault::caught(|| Editor::new(options, door, Some(screen), sender).and_then(|editor| editor.run(&events)));
    terminal::restore();
    let left =
        result.unwrap_or_else(|fault| Err(Error::at("the editor", fault).cure("plica edit offers what was typed")))?;
    if let Some(folder) = left {
        terminal::remark(&format!("your files from the tutor are in {}", folder.display()));
    }
    Ok(())
}

/// The signal thread asks the editor to end, and ends the process where that takes too long: a terminal that went away
/// can hold a write for ever. Where a person types `lines`, Ctrl-C comes as a signal and ends only what runs.
fn end_on_signals(sender: mpsc::Sender<Event>, lines: bool) -> Result<signals::Registration> {
    let handler = move |signal| match signal {
        Signal::Interrupt if lines => {
            // Where nobody listens any more the editor is leaving already.
            let _ = sender.send(Event::Line("leave".into()));
            Answer::Done
        }
        Signal::Hangup | Signal::Terminate | Signal::Interrupt => {
            // As above.
            let _ = sender.send(Event::End);
            std::thread::spawn(|| {
                std::thread::sleep(GRACE);
                terminal::restore();
                std::process::exit(i32::from(Error::Interrupted.exit_status()));
            });
            Answer::Done
        }
        Signal::Stop => {
            // As above.
            let _ = sender.send(Event::Stop);
            Answer::Done
        }
        Signal::Resize => {
            // As above.
            let _ = terminal::size().map(|(width, height)| sender.send(Event::Resize(width, height)));
            Answer::Done
        }
        Signal::Continue => Answer::Pass,
    };
    signals::handle(handler).map_err(|error| Error::at("signals", error))
}

/// An editor at work.
pub struct Editor {
    /// How it was opened.
    pub(super) options: Options,
    /// What is shown and changed.
    pub(super) state: State,
    /// The terminal; `None` if only a script is run.
    pub(super) screen: Option<terminal::Screen>,
    /// Where events come in.
    pub(super) sender: mpsc::Sender<Event>,
    /// The thread that synthesises.
    pub(super) worker: Worker,
    /// The subcommand that runs.
    pub(super) job: Option<Job>,
    /// The windows.
    pub(super) preview: Preview,
    /// What was last told of the window.
    pub(super) window_told: String,
    /// The files of the scene; `None` if they cannot be watched.
    pub(super) watch: Option<Watch>,
    /// The scripts that run.
    pub(super) scripts: Scripts,
    /// The log of the session; `None` if there is no folder for it.
    pub(super) log: Option<Log>,
    /// What the panes have asked the worker for.
    pub(super) eyes: Throttle,
    /// Whether it ends.
    pub(super) leaving: bool,
    /// Whether a signal ends it.
    pub(super) interrupted: bool,
    /// When the drawing began that the terminal has not read yet.
    drawn: Option<Instant>,
}

impl Editor {
    fn new(
        options: Options,
        door: Door,
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
        let preview = listen(&door, &options.files, sender.clone());
        let changed = sender.clone();
        // Without it changes from outside are met at the next save.
        let watch = Watch::new(move |files| drop(changed.send(Event::FilesChanged(files))));
        let watch = watch.inspect_err(|error| tracing::warn!("{error}")).ok();
        let log = begin_log(&door, size, sender.clone());
        let mut state = State::new(door, size, depth);
        state.recorder.set_place(log.as_ref().map(|log| log.path().to_owned()));
        state.seeing.graphics = graphics;
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
            scripts: Scripts::default(),
            log,
            eyes: Throttle::default(),
            leaving: false,
            interrupted: false,
            drawn: None,
        };
        editor.begin();
        editor.load_keys();
        editor.begin_tutor();
        typed.iter().filter_map(input::event).for_each(|event| editor.take(event));
        if editor.options.window && editor.screen.is_some() && editor::opens_by_itself() {
            editor.preview.open_window();
        }
        if let (Some(keep), true) = (editor.options.keep_recovery, editor.state.door.offered().is_some()) {
            editor.take(Event::Line(format!("recovery {}", if keep { "keep" } else { "drop" })));
        }
        if let Some(script) = editor.options.script.clone() {
            editor.source(&script)?;
        }
        Ok(editor)
    }

    /// Begins the lessons; what they write without a path lies beside their scene.
    pub fn begin_tutor(&mut self) {
        let Some(folder) = self.options.tutor.clone() else { return };
        if let Err(error) = std::env::set_current_dir(&folder) {
            tracing::warn!("{}: {error}", folder.display());
        }
        self.state.tutor = Some(Tutor::begin());
    }

    /// What is done once for every scene that is opened.
    pub fn begin(&mut self) {
        self.state.picture_size = picture_size(&self.state);
        let greeting = self.state.door.greeting(editor::way_home(self.state.door.path()));
        self.state.say(greeting);
        self.watch_files();
        // Windows learn what is selected before the first key.
        self.perform(Effect::Show);
    }

    /// Watches the scene and all that it names.
    pub fn watch_files(&mut self) {
        let Some(watch) = &mut self.watch else { return };
        let path = self.state.door.path();
        let mut all = files::materials::files(path, self.state.document().scene());
        all.push(path.to_owned());
        if let Err(error) = watch.set(&all) {
            tracing::warn!("{error}");
        }
    }

    /// Edits until the person leaves; gives the folder of the tutor, where it was there.
    ///
    /// # Errors
    /// The terminal cannot be drawn on, or a signal ended it.
    fn run(mut self, events: &mpsc::Receiver<Event>) -> Result<Option<PathBuf>> {
        let mut watch = Stopwatch::default();
        while !self.leaving {
            self.eyes.request(&self.state).into_iter().for_each(|request| self.worker.ask(request));
            self.draw()?;
            self.wait(events, &mut watch);
        }
        if let (Protocol::Kitty, Some(screen)) = (seeing::protocol(&self.state), &mut self.screen) {
            // A terminal that has gone away has nothing to forget.
            let _ = screen.backend_mut().write_all(graphics::forget().as_bytes());
        }
        self.drain();
        self.end();
        self.ended()?;
        Ok(self.options.tutor)
    }

    /// How it ended.
    ///
    /// # Errors
    /// By a signal.
    pub fn ended(&self) -> Result<()> {
        if self.interrupted { Err(Error::Interrupted) } else { Ok(()) }
    }

    /// Brings everything to the disk.
    pub fn end(&mut self) {
        self.state.door.tend();
        self.state.door.flush();
        self.job.take().into_iter().for_each(Job::end);
        self.log = None;
    }

    /// Gives the terminal a moment to read what is left for it.
    pub fn drain(&mut self) {
        self.screen.iter_mut().for_each(|screen| pace::drain(screen.backend_mut(), LAST_LOOK));
    }

    fn draw(&mut self) -> Result<()> {
        let (state, Some(screen)) = (&self.state, &mut self.screen) else { return Ok(()) };
        let failed = |e| Error::at("the terminal", e);
        if pace::is_behind() {
            Write::flush(screen.backend_mut()).map_err(failed)?;
            if pace::is_behind() {
                return Ok(());
            }
        }
        if let Some(begun) = self.drawn.take() {
            self.eyes.wrote(state, begun.elapsed());
        }
        let begun = Instant::now();
        screen.draw(|frame| view::draw(frame, state)).map_err(failed)?;
        match pace::is_behind() {
            true => self.drawn = Some(begun),
            false => self.eyes.wrote(state, begun.elapsed()),
        }
        Ok(())
    }

    /// Waits for an event and takes all that are there, so that many cost one drawing.
    fn wait(&mut self, events: &mpsc::Receiver<Event>, watch: &mut Stopwatch) {
        let script_goes_on = !self.scripts.is_empty() && self.state.seen.work.is_none();
        let patience = match self.state.playing {
            _ if script_goes_on => Duration::ZERO,
            _ if pace::is_behind() => BEHIND,
            true => Duration::from_millis(33),
            false => self.eyes.patience(self.state.door.patience()),
        };
        self.state.door.tend();
        let first = events.recv_timeout(patience).ok();
        for event in first.into_iter().chain(events.try_iter()) {
            self.take(event);
        }
        self.run_scripts();
        self.see_window();
        let passed = watch.lap(self.state.playing, Instant::now());
        if self.state.playing {
            self.take(Event::Tick(passed));
        }
    }

    /// The status line says how the window is doing; why there is none is told once, where there is room for it.
    fn see_window(&mut self) {
        let seen = match self.preview.status() {
            // Windows belong to whoever edits the scene.
            _ if self.state.door.held_by().is_some() => String::new(),
            Status::Off => String::new(),
            status => format!("window: {status}"),
        };
        if seen != self.window_told {
            // What was said of a window that is off does not outlive it.
            self.state.message.take_if(|message| message.text == self.window_told);
            self.window_told.clone_from(&seen);
            let off = matches!(self.preview.status(), Status::OffBecause(_));
            if off {
                self.state.complain(seen.clone());
            }
            self.state.seen.window = if off { "window: off".into() } else { seen };
        }
    }

    /// Takes an event, and does what it asks for.
    pub fn take(&mut self, event: Event) {
        match &event {
            // The terminal may have lost cells though it is as large again as what was drawn last.
            Event::Resize(..) => self.screen.iter_mut().for_each(|screen| drop(terminal::forget(screen))),
            // What is typed counts by the size that there is now: the signal of a new one may be on its way yet.
            Event::Key(_) | Event::Paste(_) if self.screen.is_some() => {
                self.state.size = terminal::size().unwrap_or(self.state.size);
            }
            _ => {}
        }
        if let (Event::Resize(..), Some(cell)) = (&event, ask::cell()) {
            self.state.seeing.graphics.cell = cell;
        }
        self.interrupted |= matches!(event, Event::End);
        let effects = update(&mut self.state, event);
        if let Some(log) = &self.log {
            self.state.recorder.unwritten().iter().for_each(|line| log.write(line.clone()));
        }
        for effect in effects {
            self.perform(effect);
        }
    }
}

/// Listens for windows of the scene; what they say comes as events.
pub fn listen(door: &Door, options: &files::Options, sender: mpsc::Sender<Event>) -> Preview {
    let preview = Preview::start(door.path(), door.document(), door.revision(), move |said| {
        // Nobody listens once the editor has left.
        let _ = sender.send(Event::Window(said));
    });
    preview.with_options(options)
}

/// The log of this session; it tells the editor where it cannot be written.
fn begin_log(door: &Door, (width, height): (u16, u16), sender: mpsc::Sender<Event>) -> Option<Log> {
    let header = vec![
        format!("plica {}", env!("CARGO_PKG_VERSION")),
        format!("scene {}", plain(&door.path().display().to_string())),
        format!("terminal {width} x {height}"),
    ];
    // Nobody listens once the editor has left.
    Log::begin(door.path(), header, move |why| drop(sender.send(Event::Unlogged(why))))
}

/// The size of the first layer's picture, from its header.
fn picture_size(state: &State) -> Option<(usize, usize)> {
    let image = state.document().scene().layers.first()?.technique().frame_of()?;
    let (sizes, _) = files::materials::sizes(state.door.path(), state.document().scene(), state.door.options());
    sizes.get(image).copied()
}
