//! Background threads: one synthesises the scene and makes pictures, always for the newest request; another runs a subcommand.
//! Keys never wait for them; their results arrive as events.

use crate::tui::graphics::probed;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError, mpsc};
use std::time::{Duration, Instant};

use crate::base::error::Error;
use crate::base::fault;
use crate::base::problem::{Problem, Severity};
use crate::files::{self, temporary};
use crate::layers::parts::materials::Materials;
use crate::ops;
use crate::render::{self, Synth};
use crate::scene::Scene;
use crate::tui::events::{Event, Synthesis};
use crate::tui::graphics::TerminalPicture;
use crate::tui::graphics::probed::Probed;
use crate::tui::graphics::request::Request;

/// The thread that synthesises and makes pictures.
pub struct Worker {
    slot: Arc<(Mutex<Option<Request>>, Condvar)>,
    running: Running,
}

/// The running synthesis: its scene, when it began, and how to stop it.
type Running = Arc<Mutex<Option<(Arc<Scene>, Instant, Arc<AtomicBool>)>>>;

/// A synthesis that has taken this long is cancelled for a newer one. Quicker ones finish, so that a held key shows steps.
const PATIENCE: Duration = Duration::from_millis(500);

impl Worker {
    /// Starts the thread.
    pub fn start(options: files::Options, events: mpsc::Sender<Event>) -> Worker {
        let slot = Arc::new((Mutex::new(None), Condvar::new()));
        let running = Running::default();
        let (shared, in_thread) = (slot.clone(), running.clone());
        std::thread::spawn(move || {
            let mut studio = Studio::new(options, in_thread);
            while let Some(request) = next(&shared) {
                match fault::caught(|| studio.serve(&request, &events)) {
                    Ok(true) => {}
                    Ok(false) => return,
                    Err(fault) => {
                        // Its state may be incomplete, so start again with an empty one.
                        studio = Studio::new(studio.options, studio.running);
                        if events.send(Event::Synthesised(Box::new(Err(Problem::error("", fault))))).is_err() {
                            return;
                        }
                    }
                }
            }
        });
        Worker { slot, running }
    }

    /// Sends a request. It replaces an earlier one that has not begun yet.
    pub fn ask(&self, request: Request) {
        if let Some((scene, begun, stop)) = &*self.running.lock().unwrap_or_else(PoisonError::into_inner)
            && begun.elapsed() >= PATIENCE
            && (request.fresh || !Arc::ptr_eq(scene, &request.scene))
        {
            stop.store(true, Ordering::Relaxed);
        }
        let mut slot = self.slot.0.lock().unwrap_or_else(PoisonError::into_inner);
        let fresh = request.fresh || slot.as_ref().is_some_and(|waiting| waiting.fresh);
        *slot = Some(Request { fresh, ..request });
        drop(slot);
        self.slot.1.notify_one();
    }
}

/// Waits for a request.
fn next((slot, wake): &(Mutex<Option<Request>>, Condvar)) -> Option<Request> {
    let guard = slot.lock().unwrap_or_else(PoisonError::into_inner);
    let mut guard = wake.wait_while(guard, |request| request.is_none()).unwrap_or_else(PoisonError::into_inner);
    guard.take()
}

/// A scene and what was made of it.
struct Made {
    scene: Arc<Scene>,
    synth: Arc<Synth>,
    materials: Materials,
}

/// The state of the thread between requests.
struct Studio {
    options: files::Options,
    cache: files::materials::Cache,
    made: Option<Made>,
    picture: Option<Arc<TerminalPicture>>,
    running: Running,
}

impl Studio {
    fn new(options: files::Options, running: Running) -> Studio {
        let studio = Studio { options, cache: files::materials::Cache::default(), made: None, picture: None, running };
        studio.run(None);
        studio
    }

    /// Serves a request; false if nobody listens any more.
    fn serve(&mut self, request: &Request, events: &mpsc::Sender<Event>) -> bool {
        #[cfg(test)]
        assert_ne!(request.path, std::path::Path::new("a fault"), "what a test asked for");
        if request.fresh || !self.made.as_ref().is_some_and(|made| Arc::ptr_eq(&made.scene, &request.scene)) {
            if events.send(Event::Synthesising).is_err() {
                return false;
            }
            let (begun, stop) = (Instant::now(), Arc::new(AtomicBool::new(false)));
            self.run(Some((request.scene.clone(), begun, stop.clone())));
            let result = self.synthesise(request, stop.clone());
            self.run(None);
            if stop.load(Ordering::Relaxed) && result.is_err() {
                // A newer request has stopped it, and is served next.
                return true;
            }
            let ms = begun.elapsed().as_secs_f64() * 1000.0;
            let made = result.map(|(synth, warning)| {
                let longest = probed::longest(&synth);
                Synthesis { synth, ms, longest, warning }
            });
            if events.send(Event::Synthesised(Box::new(made))).is_err() {
                return false;
            }
        }
        let Some(Made { scene, synth, materials }) = &self.made else { return true };
        let probed = request.probe.and_then(|asked| Probed::new(asked, scene, synth, materials));
        if probed.is_some_and(|probed| events.send(Event::Probed(Arc::new(probed))).is_err()) {
            return false;
        }
        let Some(wanted) = request.picture.clone() else { return true };
        let picture = TerminalPicture::new(synth, scene, request.time, wanted, self.picture.as_deref());
        self.picture = Some(picture.clone());
        events.send(Event::Picture(picture)).is_ok()
    }

    fn run(&self, what: Option<(Arc<Scene>, Instant, Arc<AtomicBool>)>) {
        *self.running.lock().unwrap_or_else(PoisonError::into_inner) = what;
    }

    /// The synthesis, with a warning if there is one.
    fn synthesise(
        &mut self,
        request: &Request,
        stop: Arc<AtomicBool>,
    ) -> Result<(Arc<Synth>, Option<Problem>), Problem> {
        self.cache.stop = Some(stop);
        let (mut materials, problems) =
            files::materials::gather(&request.path, &request.scene, &self.options, &mut self.cache);
        let previous = self.made.as_ref().map(|made| &*made.synth);
        let synth = render::synth(&request.scene, &materials, previous).map_err(|problem| {
            // Why a picture could not be read says more than that it is missing.
            problems.first().unwrap_or(&problem).clone()
        })?;
        let synth = Arc::new(synth);
        materials.stop = None;
        self.made = Some(Made { scene: request.scene.clone(), synth: synth.clone(), materials });
        match problems.first() {
            Some(error) if error.severity == Severity::Error => Err(error.clone()),
            warning => Ok((synth, warning.cloned())),
        }
    }
}

/// How long a subcommand has to end when the editor ends.
const LAST: Duration = Duration::from_millis(400);

/// A running subcommand.
pub struct Job {
    cancel: Arc<AtomicBool>,
    thread: std::thread::JoinHandle<()>,
}

impl Job {
    /// Runs `command`, and sends its progress and its result as events.
    pub fn start(command: ops::Command, name: String, open: Option<ops::Open>, events: mpsc::Sender<Event>) -> Job {
        let cancel = Arc::new(AtomicBool::new(false));
        let shared = cancel.clone();
        let thread = std::thread::spawn(move || {
            let out = Buffer::default();
            let said = Buffer::default();
            let messages =
                Messages { name: name.clone(), said: said.clone(), events: events.clone(), begun: None, shown: None };
            let mut context =
                ops::Context { out: Box::new(out.clone()), messages: Box::new(messages), cancel: shared, open };
            let result = fault::caught(|| command.run(&mut context));
            let also = said.text().lines().map(|line| format!("; {line}")).collect::<String>();
            let result = match result {
                Ok(Ok(())) => Ok(answer(&name, &out.text(), &said.text())),
                Ok(Err(Error::Interrupted)) => Err(format!("{name}: interrupted, nothing half-written is left{also}")),
                Ok(Err(error)) => Err(format!("{name}: {error}")),
                Err(fault) => Err(format!("{name}: {fault}")),
            };
            // Nobody listens once the editor has left.
            let _ = events.send(Event::Done(result));
        });
        Job { cancel, thread }
    }

    /// Asks it to end.
    pub fn cancel(&self) {
        self.cancel.store(true, Ordering::Relaxed);
    }

    /// Asks it to end and waits for it, so that nothing half-written is left. If it does not end (a FIFO that nobody reads), it
    /// is abandoned after a while.
    pub fn end(self) {
        self.cancel();
        let asked = Instant::now();
        while !self.thread.is_finished() {
            if asked.elapsed() > LAST {
                tracing::warn!("a subcommand did not end");
                return temporary::remove_unfinished();
            }
            std::thread::sleep(Duration::from_millis(5));
        }
    }
}

/// The message of a subcommand that has succeeded. Output becomes pages; otherwise it is one line with the last message
/// first, then warnings.
fn answer(name: &str, printed: &str, said: &str) -> String {
    if !printed.trim().is_empty() {
        return format!("{printed}{said}");
    }
    let lines: Vec<&str> = said.lines().filter(|line| !line.trim().is_empty()).collect();
    match lines.split_last() {
        Some((last, earlier)) => [&[*last], earlier].concat().join("; "),
        None => format!("{name}: done"),
    }
}

/// Output of a subcommand, in memory.
#[derive(Clone, Default)]
struct Buffer(Arc<Mutex<Vec<u8>>>);

impl Buffer {
    fn text(&self) -> String {
        String::from_utf8_lossy(&self.0.lock().unwrap_or_else(PoisonError::into_inner)).into_owned()
    }
}

impl std::io::Write for Buffer {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// Progress for the status line.
struct Messages {
    name: String,
    said: Buffer,
    events: mpsc::Sender<Event>,
    /// When the work in progress began.
    begun: Option<Instant>,
    shown: Option<Instant>,
}

/// Progress as a line: what, how far, a bar, the share, and how long the rest will take.
fn progress(name: &str, what: &str, (done, total): (u64, u64), spent: Duration) -> String {
    const CELLS: u64 = 8;
    let of = |whole: u64| done.min(total) * whole / total.max(1);
    let bar: String = (0..CELLS).map(|i| if i < of(CELLS) { '█' } else { '░' }).collect();
    let left = ops::left(spent, done, total);
    format!("{name}: {what} {done}/{total} {bar} {}%{left}", of(100))
}

impl ops::Progress for Messages {
    fn say(&mut self, line: &str) {
        use std::io::Write;
        // Writing to memory cannot fail.
        let _ = writeln!(self.said, "{line}");
    }

    fn step(&mut self, what: &str, done: u64, total: u64) {
        let begun = *self.begun.get_or_insert_with(Instant::now);
        if self.shown.is_none_or(|at| at.elapsed() > Duration::from_millis(100)) {
            self.shown = Some(Instant::now());
            let line = progress(&self.name, what, (done, total), begun.elapsed());
            // Nobody listens once the editor has left.
            let _ = self.events.send(Event::Progress(line));
        }
        if done >= total {
            self.begun = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::layout::picture;

    #[test]
    fn what_was_only_said_is_one_line_that_begins_with_the_end() {
        for (printed, said, expected) in [
            ("", "", "render: done"),
            ("", "done: a.gif\n", "done: a.gif"),
            (
                "",
                "s: warning: nothing moves\nframes 8/8\ndone: a.gif\n",
                "done: a.gif; s: warning: nothing moves; frames 8/8",
            ),
            ("a\nb\n", "warning\n", "a\nb\nwarning\n"),
        ] {
            assert_eq!(answer("render", printed, said), expected);
        }
    }

    #[test]
    fn a_fault_is_told_and_the_next_request_is_served() {
        let (sender, events) = mpsc::channel();
        let worker = Worker::start(files::Options::default(), sender);
        let state = crate::tui::tests::support::state();
        let request = |path: &str| Request { path: path.into(), fresh: true, ..picture::request(&state) };
        let ended = || {
            let ends = |event| match event {
                Event::Synthesised(result) => Some(result.map(drop)),
                _ => None,
            };
            events.iter().find_map(ends).unwrap()
        };
        worker.ask(request("a fault"));
        let told = ended().unwrap_err().to_string();
        assert!(told.starts_with("a fault of its own: ") && told.contains("what a test asked for"), "{told}");
        worker.ask(request("no/scene"));
        let told = ended().unwrap_err().to_string();
        assert!(told.contains("no such file"), "{told}");
    }

    #[test]
    fn work_tells_how_far_it_is() {
        for (step, secs, line) in [
            ((0, 60), 0, "render: frame 0/60 ░░░░░░░░ 0%"),
            ((15, 60), 2, "render: frame 15/60 ██░░░░░░ 25%, 6 s left"),
            ((60, 60), 9, "render: frame 60/60 ████████ 100%"),
            ((0, 0), 1, "render: frame 0/0 ░░░░░░░░ 0%"),
        ] {
            assert_eq!(progress("render", "frame", step, Duration::from_secs(secs)), line);
        }
    }
}
