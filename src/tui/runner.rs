//! Runs the editor: events in, effects out. The only place that knows the terminal, the threads, the files and the window.

use std::path::PathBuf;
use std::sync::mpsc;
use std::time::{Duration, Instant};

use super::app::State;
use super::colour::Depth;
use super::door::Door;
use super::update::{Event, update};
use super::worker::{Job, Worker};
use super::{input, terminal, view};
use crate::base::error::{Error, Result};
use crate::base::system::signals::{self, Answer, Signal};
use crate::files::watch::Watch;
use crate::preview::Reply;
use crate::preview::editor::{self, Preview, Status};
use crate::{files, ops};

/// How the editor is opened.
pub struct Options {
    /// A scene, or a picture whose scene lies beside it.
    pub path: PathBuf,
    /// Whether to open the preview window where there is a display.
    pub window: bool,
    /// Whether the scene may only be looked at.
    pub read_only: bool,
    /// How files are read.
    pub files: files::Options,
}

impl Options {
    /// As `plica edit` without options.
    pub fn new(path: PathBuf) -> Options {
        Options { path, window: true, read_only: false, files: files::Options::default() }
    }

    /// As the command line says.
    ///
    /// # Errors
    /// A wrong limit.
    pub fn of(args: &ops::edit::Args) -> Result<Options> {
        let files = args.scene.options()?;
        Ok(Options { path: args.path.clone(), window: !args.no_view, read_only: args.read_only, files })
    }
}

/// How long the editor has to end by itself once the system asks for it.
const GRACE: Duration = Duration::from_secs(2);

/// Opens the scene, edits it until the person leaves, and gives the terminal back.
///
/// # Errors
/// The scene cannot be opened, or there is no terminal.
pub fn run(options: Options) -> Result<()> {
    let door = Door::open(&options.path, options.read_only, &options.files)?;
    let (sender, events) = mpsc::channel();
    let _signals = end_on_signals(sender.clone())?;
    terminal::restore_on_panic();
    let screen = terminal::enter()?;
    let result = Editor::new(options, door, screen, sender).and_then(|editor| editor.run(&events));
    terminal::restore();
    result
}

/// The signal thread asks the editor to end, and ends the process where that takes too long: a terminal that went away
/// can hold a write for ever.
fn end_on_signals(sender: mpsc::Sender<Event>) -> Result<signals::Registration> {
    let handler = move |signal| match signal {
        Signal::Hangup | Signal::Terminate | Signal::Interrupt => {
            // Where nobody listens any more the editor is leaving already.
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
    /// The terminal.
    pub(super) screen: terminal::Screen,
    /// Where events come in.
    pub(super) sender: mpsc::Sender<Event>,
    /// The thread that synthesises.
    pub(super) worker: Worker,
    /// The subcommand that runs.
    pub(super) job: Option<Job>,
    /// The windows.
    pub(super) preview: Preview,
    /// The files of the scene; none where they cannot be watched.
    pub(super) watch: Option<Watch>,
    /// Whether it ends.
    pub(super) leaving: bool,
}

impl Editor {
    fn new(options: Options, door: Door, screen: terminal::Screen, sender: mpsc::Sender<Event>) -> Result<Self> {
        let size = screen.size().map_err(|e| Error::at("the terminal", e))?;
        let depth = Depth::of_environment(|name| std::env::var(name).ok());
        input::read(sender.clone());
        let worker = Worker::start(options.files.clone(), sender.clone());
        let preview = listen(&door, &options.files, sender.clone());
        let changed = sender.clone();
        // Without it changes from outside are met at the next save.
        let watch = Watch::new(move |files| drop(changed.send(Event::FilesChanged(files))));
        let watch = watch.inspect_err(|error| tracing::warn!("{error}")).ok();
        let state = State::new(door, (size.width, size.height), depth);
        let mut editor = Editor { options, state, screen, sender, worker, job: None, preview, watch, leaving: false };
        editor.begin();
        if editor.options.window && editor::opens_by_itself() {
            editor.preview.open_window();
        }
        Ok(editor)
    }

    /// What is done once for every scene that is opened.
    pub fn begin(&mut self) {
        self.state.picture_size = picture_size(&self.state);
        let greeting = self.state.door.greeting();
        self.state.say(greeting);
        self.watch_files();
        self.show(false);
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

    fn run(mut self, events: &mpsc::Receiver<Event>) -> Result<()> {
        let mut ticked = Instant::now();
        while !self.leaving {
            self.draw()?;
            self.wait(events, &mut ticked);
        }
        self.state.door.flush();
        self.job.take().into_iter().for_each(Job::end);
        Ok(())
    }

    fn draw(&mut self) -> Result<()> {
        let state = &self.state;
        self.screen.draw(|frame| view::draw(frame, state)).map(drop).map_err(|e| Error::at("the terminal", e))
    }

    /// Waits for an event and takes all that are there, so that many cost one drawing.
    fn wait(&mut self, events: &mpsc::Receiver<Event>, ticked: &mut Instant) {
        let first = match self.state.playing {
            true => events.recv_timeout(Duration::from_millis(33)).ok(),
            false => events.recv_timeout(self.state.door.patience()).ok(),
        };
        for event in first.into_iter().chain(events.try_iter()) {
            self.take(event);
        }
        self.see_window();
        let passed = ticked.elapsed().as_secs_f64();
        *ticked = Instant::now();
        if self.state.playing {
            self.take(Event::Tick(passed));
        }
    }

    /// The status line says how the window is doing; why there is none is told once, where there is room for it.
    fn see_window(&mut self) {
        let seen = match self.preview.status() {
            Status::Off => String::new(),
            status => format!("window: {status}"),
        };
        if seen != self.state.seen.window {
            if let Status::OffBecause(_) = self.preview.status() {
                self.state.complain(seen.clone());
            }
            self.state.seen.window = seen;
        }
    }

    /// Takes an event, and does what it asks for.
    pub fn take(&mut self, event: Event) {
        for effect in update(&mut self.state, event) {
            self.perform(effect);
        }
    }
}

/// Listens for windows of the scene; what they say comes as events.
pub fn listen(door: &Door, options: &files::Options, sender: mpsc::Sender<Event>) -> Preview {
    let preview = Preview::start(door.path(), door.document(), door.revision(), move |said| {
        let event = match said {
            editor::Event::Reply(Reply::Command(line)) => Event::Command(line),
            editor::Event::Reply(Reply::Pointer { x, y }) => Event::Pointer(x, y),
            editor::Event::Status | editor::Event::Reply(_) => Event::WindowChanged,
            editor::Event::Edit(asked) => Event::Asked(asked),
        };
        // Nobody listens once the editor has left.
        let _ = sender.send(event);
    });
    preview.with_options(options)
}

/// The size of the first layer's picture, from its header.
fn picture_size(state: &State) -> Option<(usize, usize)> {
    let crate::layers::Layer::Picture(layer) = state.document().scene().layers.first()?;
    let (sizes, _) = files::materials::sizes(state.door.path(), state.document().scene(), state.door.options());
    sizes.get(&layer.image).copied()
}
