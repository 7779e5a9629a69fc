//! Synthesis beside the event loop. One thread listens to the outside, one synthesises; the latest scene wins, and what
//! an edit left as it was is taken over from the synthesis before.

use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::frames::Frames;
use super::text::Fonts;
use super::words::Work;
use crate::base::error::Error;
use crate::base::fault;
use crate::base::problem::Problem;
use crate::base::progress::Progress;
use crate::layers::parts::marks::Mark;
use crate::layers::parts::materials::Materials;
use crate::layers::space::fit::Ball;
use crate::preview::follow::Update;
use crate::preview::views::shows_otherwise;
use crate::preview::wire::message::FromEditor;
use crate::render::gpu::{Uploaded, Uploader};
use crate::render::shown::Shown;
use crate::render::sight::Sight;
use crate::render::{self, Synth};
use crate::scene::{Document, Scene, named};

/// How long after its beginning, and how often from then on, progress is told.
const BETWEEN: Duration = Duration::from_millis(500);
const READING: &str = "reading the files";
const SYNTHESISING: &str = "synthesising";
/// What moves is looked at at so many times, for what is around it.
const TIMES: u32 = 2;
/// How often to check for a signal.
const LOOK: Duration = Duration::from_millis(250);

/// Loads what a scene names, and counts the files; returns what was loaded, and what is wrong with it.
pub type Load = Box<dyn FnMut(&Scene, Progress) -> (Materials, Vec<Problem>) + Send>;

/// What reaches the event loop.
#[derive(Debug)]
pub enum Event {
    /// From outside; never a scene.
    Update(Update),
    /// A scene is ready to be shown.
    Ready(Ready),
    /// What is being done to a scene.
    Work(Work),
    /// A scene cannot be shown: all that is wrong with it.
    Problems(Vec<Problem>),
    /// What a scene needs is on the GPU: it can be shown.
    Sent(Box<Sent>),
    /// A picture that was made beside the event loop.
    Drawn,
    /// The fonts of the system.
    Fonts(Box<Fonts>),
    /// A captured round is saved, or cannot be: what is to be said.
    Captured(String),
    /// A signal asks for the end.
    Interrupted,
}

/// A scene that is ready to be shown.
#[derive(Debug)]
pub struct Ready {
    /// The document.
    pub document: Document,
    /// The scene, as it is shown.
    pub scene: Arc<Scene>,
    /// Its synthesis.
    pub synth: Synth,
    /// What is around all that is in space.
    pub around: Option<Ball>,
    /// Its revision.
    pub revision: u64,
    /// What the synthesis took, in milliseconds.
    pub synth_ms: f64,
    /// What is wrong with it, although it can be shown.
    pub problems: Vec<Problem>,
    /// That not all of it is shown, or something in its place.
    pub otherwise: Option<String>,
    /// Marks over it beside those of the overlays.
    pub marks: Vec<Mark>,
    /// What is seen in place of what the scene's camera sees.
    pub sight: Option<Sight>,
}

/// A scene whose textures are on the GPU.
pub struct Sent {
    /// The scene as it was ready, unless it is the one that is shown.
    pub ready: Option<Ready>,
    /// As large as it is to be drawn; or why that failed.
    pub made: Result<(Frames, Uploaded), Error>,
    /// Whether the GPU's device was lost meanwhile.
    pub lost: bool,
}

impl fmt::Debug for Sent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Sent({:?})", self.ready.as_ref().map(|ready| ready.revision))
    }
}

/// A scene on its way to the GPU. Dropping it ends that: nothing may use the GPU once the window is gone.
pub struct Sending {
    thread: Option<JoinHandle<()>>,
    stop: Arc<AtomicBool>,
    /// How many times smaller it is made, if it is the scene that is shown.
    pub again: Option<usize>,
}

impl Sending {
    /// Sends a scene, made so many times smaller, beside the event loop, which goes on drawing what it drew. `ready`: see
    /// [`Sent`].
    pub fn start(
        uploader: Uploader,
        (synth, by): (Synth, usize),
        ready: Option<Ready>,
        send: impl Fn(Event) -> bool + Clone + Send + 'static,
    ) -> Sending {
        let stop = Arc::new(AtomicBool::new(false));
        let (stopped, again) = (stop.clone(), ready.is_none().then_some(by));
        let thread = std::thread::spawn(move || {
            let sent = progress("sending the picture to the GPU", send.clone());
            let make = || {
                let frames = Frames::new(&synth, by);
                let uploaded = uploader.upload(&[&frames.moving, &frames.still], &sent, &stopped)?;
                Ok((frames, uploaded))
            };
            let made = fault::caught(make).unwrap_or_else(|fault| Err(Error::at("window", fault)));
            let lost = uploader.is_lost();
            drop(uploader);
            send(Event::Sent(Box::new(Sent { ready, made, lost })));
        });
        Sending { thread: Some(thread), stop, again }
    }

    /// Ends it soon; that is told as a failure.
    pub fn give_up(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    /// Whether it was given up.
    pub fn is_given_up(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

impl Drop for Sending {
    fn drop(&mut self) {
        self.give_up();
        self.thread.take().into_iter().for_each(|thread| drop(thread.join()));
    }
}

/// A scene to be synthesised.
#[derive(Clone)]
struct Job {
    document: Document,
    revision: u64,
    /// How it is shown.
    how: Shown,
}

/// The event loop is gone.
struct Gone;

/// How far something is, told to the event loop now and then, and not at all if it is done soon.
pub fn progress(what: &'static str, send: impl Fn(Event) -> bool + Send + 'static) -> Progress {
    let state = Mutex::new((Instant::now(), send));
    Progress::new(move |percent| {
        // Whoever holds it tells at this moment.
        let Ok(mut state) = state.try_lock() else { return };
        if state.0.elapsed() >= BETWEEN {
            (state.1)(Event::Work(Work { what, is_long: true, percent: Some(percent) }));
            state.0 = Instant::now();
        }
    })
}

/// Tells the event loop of what takes a while though nobody counts how far it is; nothing once this is dropped.
struct Late {
    /// Ends the wait when it is dropped.
    ended: Option<Sender<()>>,
    waits: Option<JoinHandle<()>>,
}

impl Late {
    fn begin(what: &'static str, send: impl Fn(Event) -> bool + Send + 'static) -> Late {
        let (ended, wait) = mpsc::channel();
        let waits = std::thread::spawn(move || {
            if wait.recv_timeout(BETWEEN) == Err(RecvTimeoutError::Timeout) {
                send(Event::Work(Work { what, is_long: true, percent: None }));
            }
        });
        Late { ended: Some(ended), waits: Some(waits) }
    }
}

impl Drop for Late {
    fn drop(&mut self) {
        self.ended = None;
        self.waits.take().into_iter().for_each(|waits| drop(waits.join()));
    }
}

/// Starts both threads. `send` passes an event to the event loop; it returns false once that is gone.
pub fn start(
    updates: Receiver<Update>,
    load: Load,
    cancel: Arc<AtomicBool>,
    send: impl Fn(Event) -> bool + Clone + Send + 'static,
) {
    let (jobs, work) = mpsc::channel();
    let told = send.clone();
    std::thread::spawn(move || listen(&updates, &cancel, &jobs, &told));
    std::thread::spawn(move || drop(synthesise(&work, load, &send)));
}

fn listen(updates: &Receiver<Update>, cancel: &AtomicBool, jobs: &Sender<Job>, send: &impl Fn(Event) -> bool) {
    let mut alive = true;
    let (mut latest, mut how) = (None, Shown::default());
    while alive {
        alive = match updates.recv_timeout(LOOK) {
            Ok(Update::Scene { document, revision }) => {
                let job = Job { document, revision, how: how.clone() };
                latest = Some(job.clone());
                jobs.send(job).is_ok()
            }
            Ok(Update::Said(FromEditor::View(command))) if shows_otherwise(&mut how, &command) => {
                let job = latest.as_mut().map(|latest: &mut Job| {
                    latest.how = how.clone();
                    latest.clone()
                });
                job.is_none_or(|job| jobs.send(job).is_ok())
            }
            Ok(other) => send(Event::Update(other)),
            Err(RecvTimeoutError::Timeout) => true,
            Err(RecvTimeoutError::Disconnected) => return,
        };
        if cancel.load(Ordering::Relaxed) {
            send(Event::Interrupted);
            return;
        }
    }
}

fn synthesise(
    work: &Receiver<Job>,
    mut load: Load,
    tell: &(impl Fn(Event) -> bool + Clone + Send + 'static),
) -> Result<(), Gone> {
    let send = |event| if tell(event) { Ok(()) } else { Err(Gone) };
    let mut previous: Option<Synth> = None;
    while let Ok(first) = work.recv() {
        let Job { document, revision, how } = work.try_iter().last().unwrap_or(first);
        let scene = document.scene().clone();
        let began = Instant::now();
        send(Event::Work(Work { what: READING, is_long: false, percent: None }))?;
        let made = fault::caught(|| {
            let (mut materials, problems) = {
                let _late = Late::begin(READING, tell.clone());
                load(&scene, progress(READING, tell.clone()))
            };
            send(Event::Work(Work { what: SYNTHESISING, is_long: false, percent: None }))?;
            let _late = Late::begin(SYNTHESISING, tell.clone());
            materials.progress = Some(Arc::new(progress(SYNTHESISING, tell.clone())));
            materials.leaves_out = true;
            Ok((how.synth(&scene, &materials, previous.as_ref()), problems))
        });
        let (synth, mut problems) = match made {
            Ok(made) => made?,
            Err(fault) => {
                previous = None;
                send(Event::Problems(vec![Problem::error("", fault)]))?;
                continue;
            }
        };
        match synth {
            Ok((scene, synth)) => {
                previous = Some(synth.clone());
                let synth_ms = began.elapsed().as_secs_f64() * 1000.0;
                problems.extend(synth.lacks());
                let problems = named(&scene, problems);
                send(Event::Ready(ready(Job { document, revision, how }, scene, synth, (synth_ms, problems))))?;
            }
            // A missing picture was already found, with its reason, while it was loaded.
            Err(problem) => {
                let problems = if problems.is_empty() { vec![problem] } else { problems };
                send(Event::Problems(named(&scene, problems)))?;
            }
        }
    }
    Ok(())
}

/// A scene that is ready, as it is seen.
fn ready(job: Job, scene: Arc<Scene>, synth: Synth, (synth_ms, problems): (f64, Vec<Problem>)) -> Ready {
    let Job { document, revision, how } = job;
    let around = Ball::around(&|ways| render::reach(&synth.layers, TIMES, ways));
    let otherwise = otherwise(&how, &scene);
    let sight = how.sight.clone();
    let (scene, synth, marks) = how.seen(scene, synth);
    Ready { document, scene, synth, around, revision, synth_ms, problems, otherwise, marks, sight }
}

/// In words, that not all of a scene is shown, or something in its place.
fn otherwise(how: &Shown, scene: &Scene) -> Option<String> {
    let muted = Some(how.muted.len()).filter(|count| *count > 0).map(|count| format!("without {count} muted"));
    let sight = how.sight.as_ref().map(|sight| match sight {
        Sight::From(_) => "select".to_owned(),
        Sight::Painting { layer, picture, share } => {
            let lying = scene.layers.get(*layer).and_then(|layer| layer.technique().lying()).unwrap_or_default();
            let name = lying.get(*picture).map_or("", |lying| lying.name);
            format!("painting {name}, {:.0} % of it", share * 100.0)
        }
    });
    let all: Vec<String> = [sight, muted].into_iter().flatten().collect();
    Some(all.join(", ")).filter(|all| !all.is_empty())
}

/// Problems of a scene with the names of what they are in.
fn named(scene: &Scene, problems: Vec<Problem>) -> Vec<Problem> {
    let json = if problems.is_empty() { None } else { serde_json::to_value(scene).ok() };
    match json {
        Some(json) => named::problems(&json, problems),
        None => problems,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::picture::Picture;
    use crate::preview::wire::message::FromEditor;

    fn document(image: &str) -> Document {
        let images = r#"{"a": {"path": "a.png"}, "b": {"path": "b.png"}}"#;
        let layers = format!(r#"[{{"kind": "picture", "name": "a", "image": "{image}"}}]"#);
        Document::parse(&format!(r#"{{"plica": 1, "images": {images}, "layers": {layers}}}"#)).unwrap()
    }

    #[test]
    fn the_latest_scene_wins_and_the_rest_passes_in_order() {
        let (updates, receiver) = mpsc::channel();
        let (events, seen) = mpsc::channel();
        let load = Box::new(|_: &Scene, _| {
            let picture = Arc::new(Picture::filled(2, 2, [1.0; 4]));
            (Materials { pictures: [("a".to_owned(), picture)].into(), ..Materials::default() }, Vec::new())
        });
        for revision in 1..=3 {
            updates.send(Update::Scene { document: document("a"), revision }).unwrap();
        }
        updates.send(Update::Scene { document: document("b"), revision: 4 }).unwrap();
        updates.send(Update::Said(FromEditor::Notice("hello".into()))).unwrap();
        drop(updates);
        start(receiver, load, Arc::default(), move |event| events.send(event).is_ok());
        let all: Vec<Event> = seen.iter().collect();
        assert!(all.iter().any(|e| matches!(e, Event::Update(Update::Said(FromEditor::Notice(n))) if n == "hello")));
        let last = all.iter().rfind(|e| !matches!(e, Event::Update(_)));
        let Some(Event::Problems(problems)) = last else { panic!("{all:?}") };
        assert_eq!(problems[0].path, "/layers/0/image", "{all:?}");
    }

    #[test]
    fn what_takes_a_while_is_told_though_nobody_counts() {
        for (rest, times) in [(Duration::ZERO, 0), (2 * BETWEEN, 1)] {
            let (sender, told) = mpsc::channel();
            let late = Late::begin("working", move |event| sender.send(event).is_ok());
            std::thread::sleep(rest);
            drop(late);
            let told: Vec<Event> = told.iter().collect();
            assert_eq!(told.len(), times, "{told:?}");
            let is_long = |event: &Event| matches!(event, Event::Work(Work { is_long: true, percent: None, .. }));
            assert!(told.iter().all(is_long), "{told:?}");
        }
    }

    #[test]
    fn progress_is_told_once_it_takes_a_while() {
        let (sender, told) = mpsc::channel();
        let progress = progress("working", move |event| sender.send(event).is_ok());
        progress.expect(100);
        progress.done(50);
        std::thread::sleep(BETWEEN);
        progress.done(10);
        progress.done(10);
        drop(progress);
        let told: Vec<Event> = told.iter().collect();
        assert!(
            matches!(told[..], [Event::Work(Work { what: "working", is_long: true, percent: Some(60) })]),
            "{told:?}"
        );
    }
}
