//! When the worker may be asked for the next picture.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::tui::graphics::TerminalPicture;
use crate::tui::graphics::request::Request;
use crate::tui::layout::picture::request;
use crate::tui::state::State;

/// What was asked of the worker, and when it may be asked for the next picture. Writing a picture to a slow link takes
/// time, in which keys would wait: after it the link is left to them for twice as long. Pictures in between are dropped,
/// never queued.
#[derive(Default)]
pub struct Throttle {
    asked: Option<Request>,
    written: Option<Arc<TerminalPicture>>,
    free: Option<Instant>,
}

/// However slow the link, a picture comes as often as this.
const LONGEST: Duration = Duration::from_secs(5);

impl Throttle {
    /// What to ask the worker for now: something new, and a picture only where the link is free for one.
    pub fn request(&mut self, state: &State) -> Option<Request> {
        let mut request = request(state);
        if self.asked.as_ref() == Some(&request) {
            return None;
        }
        if !self.left().is_zero() {
            let same = |asked: &Request| Arc::ptr_eq(&asked.scene, &request.scene) && asked.probe == request.probe;
            if self.asked.as_ref().is_some_and(same) {
                return None;
            }
            request.picture = None;
        }
        self.asked = Some(request.clone());
        Some(request)
    }

    /// A screen has been written, and it took so long.
    pub fn wrote(&mut self, state: &State, took: Duration) {
        let shown = state.picture.latest.as_ref();
        if self.written.as_ref().map(Arc::as_ptr) != shown.map(Arc::as_ptr) {
            self.written = shown.cloned();
            self.free = Some(Instant::now() + (took * 2).min(LONGEST));
        }
    }

    /// How long to wait for events: `otherwise`, or until a picture may be asked for that is wanted by then.
    pub fn patience(&self, otherwise: Duration) -> Duration {
        let left = self.left();
        if left.is_zero() { otherwise } else { left.min(otherwise) }
    }

    fn left(&self) -> Duration {
        self.free.map_or(Duration::ZERO, |free| free.saturating_duration_since(Instant::now()))
    }
}
