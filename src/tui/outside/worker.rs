//! The thread that synthesises the scene and makes pictures, always for the newest request. Keys never wait for it; its
//! results arrive as events.

use crate::tui::graphics::probed;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError, mpsc};
use std::time::{Duration, Instant};

use crate::base::fault;
use crate::base::problem::{Problem, Severity};
use crate::base::progress::Progress;
use crate::files;
use crate::layers::parts::materials::Materials;
use crate::render::Synth;
use crate::render::shown::Shown;
use crate::scene::Scene;
use crate::tui::events::{Event, Synthesis};
use crate::tui::graphics::TerminalPicture;
use crate::tui::graphics::counts::Counts;
use crate::tui::graphics::probed::Probed;
use crate::tui::graphics::request::Request;

/// The thread that synthesises and makes pictures.
pub struct Worker {
    slot: Arc<(Mutex<Option<Request>>, Condvar)>,
    running: Running,
    /// Stops what is running.
    stop: Arc<AtomicBool>,
}

/// What is running: of which scene, and since when.
type Running = Arc<Mutex<Option<(Arc<Scene>, Instant)>>>;

/// What has taken this long is cancelled for a newer scene. Quicker work is finished, so that a held key shows steps.
const PATIENCE: Duration = Duration::from_millis(500);

impl Worker {
    /// Starts the thread.
    pub fn start(options: files::Options, events: mpsc::Sender<Event>) -> Worker {
        let slot = Arc::new((Mutex::new(None), Condvar::new()));
        let (running, stop) = (Running::default(), Arc::new(AtomicBool::new(false)));
        let (shared, in_thread) = (slot.clone(), (running.clone(), stop.clone()));
        std::thread::spawn(move || {
            let mut studio = Studio::new(options, in_thread);
            while let Some(request) = next(&shared) {
                match fault::caught(|| studio.serve(&request, &events)) {
                    Ok(true) => {}
                    Ok(false) => return,
                    Err(fault) => {
                        // Its state may be incomplete, so start again with an empty one.
                        studio = Studio::new(studio.options, (studio.running, studio.stop));
                        let told = Event::Synthesised(Box::new(Err(Problem::error("", fault))));
                        if events.send(told).and_then(|()| events.send(Event::Made(request.scene))).is_err() {
                            return;
                        }
                    }
                }
            }
        });
        Worker { slot, running, stop }
    }

    /// Sends a request. It replaces an earlier one that has not begun yet.
    pub fn ask(&self, request: Request) {
        if let Some((scene, begun)) = &*self.running.lock().unwrap_or_else(PoisonError::into_inner)
            && begun.elapsed() >= PATIENCE
            && (request.fresh || !Arc::ptr_eq(scene, &request.scene))
        {
            self.stop.store(true, Ordering::Relaxed);
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

/// Tells how far something is, once that takes a while.
fn telling(begun: Instant, events: mpsc::Sender<Event>, event: fn(u8) -> Event) -> Progress {
    Progress::new(move |percent| {
        if begun.elapsed() >= PATIENCE {
            // Nobody listens once the editor has left.
            let _ = events.send(event(percent));
        }
    })
}

/// A scene and what was made of it.
struct Made {
    scene: Arc<Scene>,
    how: Shown,
    /// What is shown of it.
    shown: Arc<Scene>,
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
    stop: Arc<AtomicBool>,
}

impl Studio {
    fn new(options: files::Options, (running, stop): (Running, Arc<AtomicBool>)) -> Studio {
        let cache = files::materials::Cache::until(stop.clone());
        let studio = Studio { options, cache, made: None, picture: None, running, stop };
        studio.ends();
        studio
    }

    /// Serves a request; false if nobody listens any more.
    fn serve(&mut self, request: &Request, events: &mpsc::Sender<Event>) -> bool {
        #[cfg(test)]
        assert_ne!(request.path, std::path::Path::new("a fault"), "what a test asked for");
        let is_made = |made: &Made| Arc::ptr_eq(&made.scene, &request.scene) && made.how == request.how;
        if request.fresh || !self.made.as_ref().is_some_and(is_made) {
            if events.send(Event::Synthesising).is_err() {
                return false;
            }
            let begun = self.begins(&request.scene);
            self.cache.progress = Some(Arc::new(telling(begun, events.clone(), Event::Reading)));
            let result = self.synthesise(request, telling(begun, events.clone(), Event::Filling));
            if self.ends() && result.is_err() {
                // A newer request has stopped it, and is served next.
                return true;
            }
            let ms = begun.elapsed().as_secs_f64() * 1000.0;
            let made = result.map(|(synth, warning)| {
                let longest = probed::longest(&synth);
                Synthesis { synth, ms, longest, warning }
            });
            let told = events.send(Event::Synthesised(Box::new(made)));
            if told.and_then(|()| events.send(Event::Made(request.scene.clone()))).is_err() {
                return false;
            }
        }
        let Some(Made { scene, shown, synth, materials, .. }) = &self.made else { return true };
        let begun = self.begins(scene);
        let probed = request.probe.and_then(|asked| Probed::new(asked, shown, synth, materials));
        let probed = probed.filter(|_| !synth.is_stopped());
        if probed.is_some_and(|probed| events.send(Event::Probed(Arc::new(probed))).is_err()) {
            return false;
        }
        let counts = request.counts.clone().map(|asked| Counts::new(asked, synth));
        let counts = counts.filter(|_| !synth.is_stopped());
        if counts.is_some_and(|counts| events.send(Event::Counted(Arc::new(counts))).is_err()) {
            return false;
        }
        let picture = request.picture.clone();
        let before = self.picture.as_deref();
        let picture = picture.map(|wanted| TerminalPicture::new(synth, shown, request.time, wanted, before));
        // If it was stopped, a newer request is served next.
        let Some(picture) = picture.filter(|_| !self.ends()) else { return true };
        let ms = begun.elapsed().as_secs_f64() * 1000.0;
        self.picture = Some(picture.clone());
        events.send(Event::Picture(picture, ms)).is_ok()
    }

    /// Something begins, which may be stopped.
    fn begins(&self, scene: &Arc<Scene>) -> Instant {
        let (begun, mut running) = (Instant::now(), self.running.lock().unwrap_or_else(PoisonError::into_inner));
        self.stop.store(false, Ordering::Relaxed);
        *running = Some((scene.clone(), begun));
        begun
    }

    /// It ends; whether it was stopped.
    fn ends(&self) -> bool {
        *self.running.lock().unwrap_or_else(PoisonError::into_inner) = None;
        self.stop.load(Ordering::Relaxed)
    }

    /// The synthesis, with a warning if there is one.
    fn synthesise(&mut self, request: &Request, filling: Progress) -> Result<(Arc<Synth>, Option<Problem>), Problem> {
        let (mut materials, problems) =
            files::materials::gather(&request.path, &request.scene, &self.options, &mut self.cache);
        materials.leaves_out = true;
        materials.progress = Some(Arc::new(filling));
        let previous = self.made.as_ref().map(|made| &*made.synth);
        let (shown, synth) = request.how.synth(&request.scene, &materials, previous).map_err(|problem| {
            // Why a picture could not be read says more than that it is missing.
            problems.first().unwrap_or(&problem).clone()
        })?;
        let synth = Arc::new(synth);
        (materials.stop, materials.progress) = (None, None);
        let (scene, how) = (request.scene.clone(), request.how.clone());
        self.made = Some(Made { scene, how, shown, synth: synth.clone(), materials });
        match problems.first() {
            Some(error) if error.severity == Severity::Error => Err(error.clone()),
            warning => {
                let lacking = synth.lacks().into_iter().next();
                Ok((synth, lacking.or_else(|| warning.cloned())))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::layout::picture;

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
}
