//! Limits how often the worker is asked for pictures.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::tui::graphics::TerminalPicture;
use crate::tui::graphics::request::Request;
use crate::tui::layout::picture::request;
use crate::tui::state::State;

/// What was asked of the worker, and when it may be asked for the next picture. Keys have to wait while a picture is written
/// to a slow link, so after it the link stays free for twice as long. Pictures in between are dropped, never queued.
#[derive(Default)]
pub struct Throttle {
    asked: Option<Request>,
    written: Option<Arc<TerminalPicture>>,
    free: Option<Instant>,
}

/// The longest pause between two pictures, however slow the link.
const LONGEST: Duration = Duration::from_secs(5);

impl Throttle {
    /// What to ask the worker for now; `None` if nothing has changed. It includes a picture only if the link is free.
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

    /// Notes that writing a screen took so long.
    pub fn wrote(&mut self, state: &State, took: Duration) {
        let shown = state.picture.latest.as_ref();
        if self.written.as_ref().map(Arc::as_ptr) != shown.map(Arc::as_ptr) {
            self.written = shown.cloned();
            self.free = Some(Instant::now() + (took * 2).min(LONGEST));
        }
    }

    /// How long to wait for events: `otherwise`, or until the next picture may be asked for.
    pub fn patience(&self, otherwise: Duration) -> Duration {
        let left = self.left();
        if left.is_zero() { otherwise } else { left.min(otherwise) }
    }

    fn left(&self) -> Duration {
        self.free.map_or(Duration::ZERO, |free| free.saturating_duration_since(Instant::now()))
    }
}
