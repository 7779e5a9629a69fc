//! Draws what is to be painted on, beside the editor.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::time::Instant;

use super::job::{Job, progress};
use crate::base::fault;
use crate::base::progress::Watch;
use crate::tui::events::{Event, ToDraw};

/// Begins it. What is drawn arrives as an event.
pub fn start(asked: ToDraw, events: mpsc::Sender<Event>) -> Job {
    Job::beside(move |cancel| {
        let ToDraw { wanted, document, synth } = asked;
        let (begun, all, done) = (Instant::now(), wanted.pieces() as u64, AtomicUsize::new(0));
        let stopped = || cancel.load(Ordering::Relaxed);
        let tell = |_| {
            let done = done.fetch_add(1, Ordering::Relaxed) as u64 + 1;
            let line = progress("views add", "picture", (done, all), begun.elapsed());
            // Nobody listens once the editor has left.
            let _ = events.send(Event::Progress(line));
        };
        let watch = Watch { stopped: &stopped, done: &tell };
        let drawn = match fault::caught(|| wanted.draw(&document, &synth, &watch)) {
            _ if stopped() => Err("interrupted, nothing is added".to_owned()),
            Ok(drawn) => drawn.map_err(|error| error.to_string()),
            Err(fault) => Err(fault),
        };
        let _ = events.send(Event::Drawn(Box::new(drawn.map(|drawn| (wanted, drawn)))));
    })
}
