//! The window's side across machines: talks with the far end, fetches the files that the scene names, and if the link is lost
//! keeps the last state, says so and connects again by itself, after longer and longer waits.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::fetch::{Fetch, Shared};
use super::ssh::Way;
use crate::base::error::{Error, Result};
use crate::files::cache::Cache;
use crate::preview::follow::client::Link;
use crate::preview::follow::news::{News, Sink, window_sink};
use crate::preview::follow::talk::{Heard, Outcome, Talk, WindowGone};
use crate::preview::keys::{KEYS, PLAY, VIEW};
use crate::preview::views;
use crate::preview::wire::connection::{ALIVE, HangUp, Wire};
use crate::preview::wire::message::{FromEditor, OfTheLink, ToEditor};
use crate::render::shown::Shown;

/// Waits before connecting again, by the number of attempts that failed in a row, in seconds.
const WAITS_SECS: [u64; 5] = [1, 2, 5, 10, 30];
/// The shortest time between two reports of a file's progress.
const PROGRESS: Duration = Duration::from_millis(300);

/// Follows the scene at the end of `way` from the hello that was said there on. `copies` fills with the files that the scene
/// names, kept in `cache`.
///
/// # Errors
/// The scene of the hello is wrong.
pub fn follow(way: Way, (hello, wire): (FromEditor, Wire), cache: Cache, copies: Shared) -> Result<Link> {
    let (updates, receiver) = mpsc::channel();
    let settled = Arc::new(AtomicBool::new(false));
    let sink = once_settled(window_sink(updates), settled.clone());
    let (talk, replies, heard) = Talk::new(way.address.to_string(), &way.options, sink);
    let fetch = Fetch::new(cache, copies, way.options.limits.memory);
    let mut far = Far {
        talk,
        fetch,
        settled,
        standing: String::new(),
        tries: 0,
        next: None,
        going: Arc::default(),
        told: Instant::now(),
        way,
    };
    far.talk.enter(hello, wire)?;
    std::thread::spawn(move || drop(far.run(&heard)));
    Ok(Link { updates: receiver, replies })
}

/// Holds the scene back until the files that it names are here: without them there would only be error messages.
fn once_settled(mut sink: Sink, settled: Arc<AtomicBool>) -> Sink {
    let mut waiting = None;
    Box::new(move |news| match news {
        News::Document { .. } if !settled.load(Ordering::Relaxed) => {
            waiting = Some(news);
            true
        }
        News::Files => sink(waiting.take().unwrap_or(News::Files)),
        other => sink(other),
    })
}

struct Far {
    way: Way,
    talk: Talk,
    fetch: Fetch,
    settled: Arc<AtomicBool>,
    /// How the far end follows the scene, as it said last.
    standing: String,
    /// Attempts that failed in a row.
    tries: usize,
    /// When to connect again; `None` while connected or connecting.
    next: Option<Instant>,
    /// Gives up the attempt under way.
    going: Arc<Mutex<Option<HangUp>>>,
    /// When progress was reported last.
    told: Instant,
}

impl Far {
    fn run(mut self, heard: &Receiver<Heard>) -> Outcome {
        self.talk.show(None)?;
        let mut said = Instant::now();
        loop {
            let due = self.next.unwrap_or(said + ALIVE);
            match heard.recv_timeout(due.saturating_duration_since(Instant::now())) {
                Ok(Heard::Said(session, said)) if self.talk.is_present(session) => self.take(said)?,
                Ok(Heard::Lost(session, error)) if self.talk.is_present(session) => self.lost(error)?,
                Ok(Heard::Connected(Ok((hello, wire)))) => self.connected(hello, wire)?,
                Ok(Heard::Connected(Err(error))) => self.wait(error.to_string())?,
                Ok(Heard::TryNow) if self.next.is_some() => self.go(),
                Ok(Heard::Said(..) | Heard::Lost(..) | Heard::Changed(_) | Heard::TryNow) => {}
                Err(RecvTimeoutError::Timeout) if self.next.is_some() => self.go(),
                Err(RecvTimeoutError::Timeout) => {
                    self.talk.say(&ToEditor::Alive);
                    said = Instant::now();
                }
                Ok(Heard::Gone) | Err(RecvTimeoutError::Disconnected) => return Err(WindowGone),
            }
        }
    }

    fn take(&mut self, said: FromEditor) -> Outcome {
        let Some(said) = harmless(said) else { return Ok(()) };
        match self.talk.take(said.meaning())? {
            Some(OfTheLink::Images(originals)) => {
                let changed = self.fetch.told(originals);
                self.fetched(changed)
            }
            Some(OfTheLink::Piece(hash, offset, bytes)) => {
                let taken = self.fetch.piece(&hash, offset, &bytes, Instant::now());
                let whole = taken.or_else(|error| self.talk.failed(error).map(|()| true))?;
                self.fetched(whole)
            }
            Some(OfTheLink::Notice(line)) => {
                self.standing = format!("{}: {line}", self.way.address.host);
                if self.fetch.is_settled() { self.talk.notice(self.standing.clone()) } else { Ok(()) }
            }
            Some(OfTheLink::Problems(problems)) => self.talk.problems(problems),
            Some(OfTheLink::Bye(reason)) => {
                self.leave();
                self.wait(reason)
            }
            None => Ok(()),
        }
    }

    /// Goes on fetching; once files have arrived, the scene is shown with them.
    fn fetched(&mut self, changed: bool) -> Outcome {
        let wants = match self.fetch.wants(Instant::now()) {
            Ok(wants) => wants,
            Err(error) => return self.talk.failed(error),
        };
        wants.iter().for_each(|want| self.talk.say(want));
        let settled = self.fetch.is_settled();
        if changed || settled && !self.settled.load(Ordering::Relaxed) {
            self.settled.fetch_or(settled, Ordering::Relaxed);
            if self.settled.load(Ordering::Relaxed) {
                self.talk.tell(News::Files)?;
            }
        }
        match self.fetch.progress() {
            Some(_) if self.told.elapsed() < PROGRESS => Ok(()),
            Some(line) => {
                self.told = Instant::now();
                self.talk.progress(Some(line))
            }
            None if settled => {
                self.talk.progress(None)?;
                self.talk.notice(self.standing.clone())
            }
            None => Ok(()),
        }
    }

    fn leave(&mut self) {
        self.talk.leave();
        self.fetch.lost();
    }

    fn lost(&mut self, error: Option<Error>) -> Outcome {
        self.leave();
        let why =
            error.map_or("the connection was lost".to_owned(), |error| format!("the connection was lost ({error})"));
        self.wait(why)
    }

    /// The last state stays; another attempt follows after a while.
    fn wait(&mut self, why: String) -> Outcome {
        let wait = Duration::from_secs(WAITS_SECS[self.tries.min(WAITS_SECS.len() - 1)]);
        self.tries += 1;
        self.next = Some(Instant::now() + wait);
        self.talk.progress(None)?;
        self.talk.warn(format!("reconnecting: {why}; again in {} s, T tries now", wait.as_secs()))
    }

    /// Connects again, on another thread: ssh may have something to ask.
    fn go(&mut self) {
        self.next = None;
        let (way, sender, going) = (self.way.clone(), self.talk.sender.clone(), self.going.clone());
        std::thread::spawn(move || {
            let keep = |hang_up| *going.lock().unwrap_or_else(PoisonError::into_inner) = Some(hang_up);
            let connected = way.connect(keep);
            if let Err(mpsc::SendError(Heard::Connected(Ok((_, wire))))) = sender.send(Heard::Connected(connected)) {
                wire.hang_up.now();
            }
        });
    }

    fn connected(&mut self, hello: FromEditor, wire: Wire) -> Outcome {
        let hang_up = wire.hang_up.clone();
        if let Err(error) = self.talk.enter(hello, wire) {
            hang_up.now();
            return self.wait(error.to_string());
        }
        self.tries = 0;
        self.talk.problems(Vec::new())?;
        self.talk.show(None)?;
        self.talk.notice(format!("{}: connected again", self.way.address.host))
    }
}

/// What the far end says, without commands that change more than the view: it cannot close a window here, make it fill the
/// screen or lose the GPU.
fn harmless(said: FromEditor) -> Option<FromEditor> {
    // A switch says what it is set to: `view-field on`.
    let is_view = |line: &String| {
        if views::shows_otherwise(&mut Shown::default(), line) {
            return true;
        }
        let name = line.strip_suffix(" on").or(line.strip_suffix(" off")).unwrap_or(line);
        let row = KEYS.iter().find(|row| row.command == name);
        row.is_some_and(|row| [PLAY, VIEW].contains(&row.context)) && name != "view-full-screen"
    };
    said.obeying(is_view)
}

impl Drop for Far {
    fn drop(&mut self) {
        if let Some(hang_up) = self.going.lock().unwrap_or_else(PoisonError::into_inner).take() {
            hang_up.now();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_far_end_changes_the_view_and_no_more() {
        for (name, obeyed) in [
            ("view-field", true),
            ("view-field on", true),
            ("view-outlines off", true),
            ("view-field on on", false),
            ("zoom-in", true),
            ("play", true),
            ("quit", false),
            ("view-full-screen", false),
            ("view-full-screen on", false),
            ("quit on", false),
            ("mark-point", false),
            ("select-point", false),
            ("lose-device", false),
            ("", false),
        ] {
            let view = harmless(FromEditor::View(name.into()));
            assert_eq!(view, obeyed.then(|| FromEditor::View(name.into())), "{name}");
        }
        let names = |names: &[&str]| FromEditor::Views(names.iter().map(|name| (*name).to_owned()).collect());
        assert_eq!(harmless(names(&["quit", "view-grid"])), Some(names(&["view-grid"])));
        assert_eq!(harmless(FromEditor::Alive), Some(FromEditor::Alive));
    }
}
