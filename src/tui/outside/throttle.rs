//! Limits how often the worker is asked for pictures.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::tui::graphics::TerminalPicture;
use crate::tui::graphics::request::Request;
use crate::tui::layout::picture::request;
use crate::tui::state::State;

/// What was asked of the worker, and when it may be asked for the next picture. Keys have to wait while a picture is written
/// to a slow link, so after it the link stays free for twice as long; while half-blocks play, for as long as it takes for the bytes
/// to be no more a second than they may be, and no picture is made before the last is written. Pictures in between are dropped, never
/// queued.
#[derive(Default)]
pub struct Throttle {
    asked: Option<Request>,
    /// Whether a picture was asked for that is not written yet.
    awaits: bool,
    written: Option<Arc<TerminalPicture>>,
    free: Option<Instant>,
    /// All bytes given to the terminal until the last picture.
    given: usize,
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
        let calm = request.picture.as_ref().is_some_and(|picture| picture.calm);
        if !self.left().is_zero() || calm && self.awaits {
            let same = |asked: &Request| Arc::ptr_eq(&asked.scene, &request.scene) && asked.probe == request.probe;
            if self.asked.as_ref().is_some_and(same) {
                return None;
            }
            request.picture = None;
        }
        self.awaits = request.picture.is_some();
        self.asked = Some(request.clone());
        Some(request)
    }

    /// Notes that writing a screen took so long, and how many bytes the terminal was given so far in all.
    pub fn wrote(&mut self, state: &State, took: Duration, given: usize) {
        let shown = state.picture.latest.as_ref();
        if self.written.as_ref().map(Arc::as_ptr) != shown.map(Arc::as_ptr) {
            self.written = shown.cloned();
            self.awaits = false;
            let bytes = given - std::mem::replace(&mut self.given, given);
            let calm = shown.is_some_and(|shown| shown.wanted.calm);
            let paced = Duration::from_secs_f64(bytes as f64 / state.picture.graphics.rate as f64);
            let pause = if calm { paced.max(took * 2) } else { took * 2 };
            self.free = Some(Instant::now() + pause.min(LONGEST));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::graphics::Protocol;
    use crate::tui::tests::screens::{opened, see};
    use crate::tui::tests::support::press;

    #[test]
    fn no_picture_of_half_blocks_is_made_before_the_last_is_written() {
        for (protocol, asks) in [(Protocol::Blocks, false), (Protocol::Sixel, true)] {
            let mut state = opened((160, 48));
            state.picture.graphics.forced = Some(protocol);
            press(&mut state, "/ \"speed\" Enter P");
            let mut throttle = Throttle::default();
            assert!(throttle.request(&state).is_some_and(|request| request.picture.is_some()));
            state.play.time = 0.3;
            assert_eq!(throttle.request(&state).is_some(), asks, "{protocol:?}");
            press(&mut state, "+");
            assert!(throttle.request(&state).is_some(), "an edit does not wait");
            see(&mut state);
            throttle.wrote(&state, Duration::ZERO, 0);
            state.play.time = 0.4;
            assert!(throttle.request(&state).is_some_and(|request| request.picture.is_some()), "{protocol:?}");
        }
    }

    #[test]
    fn half_blocks_play_no_faster_than_the_line_takes_them() {
        for (keys, protocol, rate, least, most) in [
            ("P", Protocol::Blocks, 60_000, 0.4, 0.5),
            ("P", Protocol::Blocks, 600_000, 0.04, 0.05),
            ("", Protocol::Blocks, 60_000, 0.0, 0.0),
            ("P", Protocol::Sixel, 60_000, 0.0, 0.0),
        ] {
            let mut state = opened((160, 48));
            state.picture.graphics.forced = Some(protocol);
            state.picture.graphics.rate = rate;
            press(&mut state, keys);
            see(&mut state);
            let mut throttle = Throttle { given: 10_000, ..Throttle::default() };
            throttle.wrote(&state, Duration::ZERO, 40_000);
            let left = throttle.left().as_secs_f64();
            assert!((least..=most).contains(&left), "{keys} {protocol:?} {rate}: {left}");
            throttle.wrote(&state, Duration::ZERO, 90_000);
            assert!(throttle.left().as_secs_f64() <= most, "the same picture");
        }
    }
}
