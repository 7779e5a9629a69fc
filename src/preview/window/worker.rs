//! Synthesis beside the event loop. One thread listens to the outside, one synthesises; the latest scene wins, and what
//! an edit left as it was is taken over from the synthesis before.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

use super::text::Fonts;
use crate::base::fault;
use crate::base::problem::Problem;
use crate::layers::parts::materials::Materials;
use crate::preview::follow::Update;
use crate::render::{self, Synth};
use crate::scene::Scene;

/// How often a signal is looked for.
const LOOK: Duration = Duration::from_millis(250);

/// Loads what a scene names: what there is, and what is wrong.
pub type Load = Box<dyn FnMut(&Scene) -> (Materials, Vec<Problem>) + Send>;

/// What reaches the event loop.
#[derive(Debug)]
pub enum Event {
    /// From outside; never a scene.
    Update(Update),
    /// A scene is ready to be shown.
    Ready(Ready),
    /// What is being done to a scene.
    Work(&'static str),
    /// A scene cannot be shown: all that is wrong with it.
    Problems(Vec<Problem>),
    /// The fonts of the system.
    Fonts(Box<Fonts>),
    /// A signal asks for the end.
    Interrupted,
}

/// A scene that is ready to be shown.
#[derive(Debug)]
pub struct Ready {
    /// The scene.
    pub scene: Arc<Scene>,
    /// Its synthesis.
    pub synth: Synth,
    /// Its revision.
    pub revision: u64,
    /// What the synthesis took, in milliseconds.
    pub synth_ms: f64,
    /// What is wrong with it all the same.
    pub problems: Vec<Problem>,
}

/// The event loop is gone.
struct Gone;

/// Starts both threads. `send` gives an event to the event loop and tells whether that is still there.
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

fn listen(
    updates: &Receiver<Update>,
    cancel: &AtomicBool,
    jobs: &Sender<(Arc<Scene>, u64)>,
    send: &impl Fn(Event) -> bool,
) {
    let mut alive = true;
    while alive {
        alive = match updates.recv_timeout(LOOK) {
            Ok(Update::Scene { scene, revision }) => jobs.send((scene, revision)).is_ok(),
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

fn synthesise(work: &Receiver<(Arc<Scene>, u64)>, mut load: Load, send: &impl Fn(Event) -> bool) -> Result<(), Gone> {
    let send = |event| if send(event) { Ok(()) } else { Err(Gone) };
    let mut previous: Option<Synth> = None;
    while let Ok(first) = work.recv() {
        let (scene, revision) = work.try_iter().last().unwrap_or(first);
        let began = Instant::now();
        send(Event::Work("reading the pictures"))?;
        let made = fault::caught(|| {
            let (materials, problems) = load(&scene);
            send(Event::Work("synthesising"))?;
            Ok((render::synth(&scene, &materials, previous.as_ref()), problems))
        });
        let (synth, problems) = match made {
            Ok(made) => made?,
            Err(fault) => {
                previous = None;
                send(Event::Problems(vec![Problem::error("", fault)]))?;
                continue;
            }
        };
        match synth {
            Ok(synth) => {
                previous = Some(synth.clone());
                let synth_ms = began.elapsed().as_secs_f64() * 1000.0;
                send(Event::Ready(Ready { scene, synth, revision, synth_ms, problems }))?;
            }
            // A missing picture was already found, with its reason, while it was loaded.
            Err(problem) => send(Event::Problems(if problems.is_empty() { vec![problem] } else { problems }))?,
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::picture::Picture;
    use crate::preview::wire::message::FromEditor;

    fn scene(image: &str) -> Arc<Scene> {
        let text = format!(r#"{{"plica": 1, "layers": [{{"kind": "picture", "name": "a", "image": "{image}"}}]}}"#);
        Arc::new(serde_json::from_str(&text).unwrap())
    }

    #[test]
    fn the_latest_scene_wins_and_the_rest_passes_in_order() {
        let (updates, receiver) = mpsc::channel();
        let (events, seen) = mpsc::channel();
        let load = Box::new(|_: &Scene| {
            let picture = Arc::new(Picture::filled(2, 2, [1.0; 4]));
            (Materials { pictures: [("a".to_owned(), picture)].into(), ..Materials::default() }, Vec::new())
        });
        for revision in 1..=3 {
            updates.send(Update::Scene { scene: scene("a"), revision }).unwrap();
        }
        updates.send(Update::Scene { scene: scene("b"), revision: 4 }).unwrap();
        updates.send(Update::Said(FromEditor::Notice("hello".into()))).unwrap();
        drop(updates);
        start(receiver, load, Arc::default(), move |event| events.send(event).is_ok());
        let all: Vec<Event> = seen.iter().collect();
        assert!(all.iter().any(|e| matches!(e, Event::Update(Update::Said(FromEditor::Notice(n))) if n == "hello")));
        let last = all.iter().rfind(|e| !matches!(e, Event::Update(_)));
        let Some(Event::Problems(problems)) = last else { panic!("{all:?}") };
        assert!(problems[0].to_string().contains("/layers/0/image"), "{all:?}");
    }
}
