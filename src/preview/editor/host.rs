//! The editor's threads. One takes connections; every window has one that reads and one that writes. Between them and the
//! editor stands a state under a lock, which nobody holds while reading, writing or cloning a document's JSON.

use std::collections::BTreeMap;
use std::io::{Read, Write};
use std::path::Path;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::events::{Asked, Event, Silent};
use super::keeper::Life;
use super::outbox::{Latest, Outbox, Outgoing};
use super::status::Status;
use crate::base::error::{Error, Result};
use crate::base::fault;
use crate::base::problem::Problem;
use crate::preview::wire::connection::{HangUp, Wire};
use crate::preview::wire::frame;
use crate::preview::wire::message::{FromEditor, Role, ToEditor};
use crate::preview::wire::socket::{Caller, Listener};
use crate::scene::edit::Edit;

/// The most connections at a time.
const MAX_PEERS: usize = 64;
/// How long a script waits for the editor to take or refuse its edit.
const ANSWER: Duration = Duration::from_secs(10);

/// What the threads share.
pub(in crate::preview) struct Shared {
    state: Mutex<State>,
    changed: Condvar,
    deliver: Box<dyn Fn(Event) + Send + Sync>,
    /// The longest silence towards a window that would not notice the end of this process; `None` if it would.
    alive: Option<Duration>,
}

/// How things stand.
pub(in crate::preview) struct State {
    pub latest: Latest,
    pub peers: BTreeMap<u64, Peer>,
    next_peer: u64,
    /// Connections, shaking hands or shaken.
    connections: usize,
    pub life: Option<Life>,
    /// Why no window can join or be opened.
    pub refused: Option<String>,
    report: Report,
    /// How often the windows were asked for what they have not told.
    asked: u64,
    pub closing: bool,
}

/// One window that has joined.
pub(in crate::preview) struct Peer {
    pub outbox: Outbox,
    pub hang_up: HangUp,
    /// The number of the question that it has answered last.
    pub answered: u64,
}

#[derive(Default)]
struct Report {
    synth_ms: Option<f64>,
    fps: Option<f64>,
    adapter: String,
    notice: String,
}

impl Report {
    fn take(&mut self, fps: f64, adapter: &str, notice: &str) {
        (self.fps, self.adapter, self.notice) = (Some(fps), adapter.into(), notice.into());
    }
}

/// Starts a detached thread.
pub(in crate::preview) fn thread(name: &str, work: impl FnOnce() + Send + 'static) -> Result<()> {
    let started = std::thread::Builder::new().name(name.into()).spawn(work);
    started.map(drop).map_err(|e| Error::at("link", e))
}

impl State {
    /// Tells the windows something, except the one that said so. Overlay and zoom commands are told one by one; of all else
    /// only how it is now, and not again what they know already.
    pub fn say(&mut self, except: Option<u64>, message: FromEditor) {
        let others = self.peers.iter_mut().filter(|(id, _)| Some(**id) != except).map(|(_, peer)| &mut peer.outbox);
        if let FromEditor::View(command) = message {
            let told = self.latest.view(&command);
            others.for_each(|outbox| outbox.view(&told));
        } else if let Some(kind) = self.latest.say(message) {
            others.for_each(|outbox| outbox.due(kind));
        }
    }

    /// What the status line says.
    pub fn status(&self) -> Status {
        match (self.peers.len(), &self.refused, &self.life) {
            (0, _, Some(Life::Running)) => Status::Starting,
            (0, _, Some(Life::GivenUp(reason))) | (0, Some(reason), _) => Status::OffBecause(reason.clone()),
            (0, None, _) => Status::Off,
            (windows, ..) => {
                let Report { synth_ms, fps, adapter, notice } = &self.report;
                let (adapter, notice) = (adapter.clone(), notice.clone());
                Status::Connected { windows, synth_ms: *synth_ms, fps: *fps, adapter, notice }
            }
        }
    }
}

fn hello(scene: &Path, Latest { document, revision, .. }: &Latest) -> FromEditor {
    let (program, scene) = (env!("CARGO_PKG_VERSION").into(), scene.display().to_string());
    FromEditor::Hello { program, scene, revision: *revision, document: document.json().clone() }
}

impl Shared {
    pub fn new(latest: Latest, deliver: Box<dyn Fn(Event) + Send + Sync>) -> Self {
        let state = State {
            latest,
            peers: BTreeMap::new(),
            next_peer: 0,
            connections: 0,
            life: None,
            refused: None,
            report: Report::default(),
            asked: 0,
            closing: false,
        };
        Shared { state: Mutex::new(state), changed: Condvar::new(), deliver, alive: None }
    }

    /// The same, with a message at least this often.
    pub fn alive(self, every: Duration) -> Self {
        Shared { alive: Some(every), ..self }
    }

    pub fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes the state and wakes the writers.
    pub fn change(&self, how: impl FnOnce(&mut State)) {
        how(&mut self.lock());
        self.changed.notify_all();
    }

    /// Changes the state in a way that shows in the status.
    pub fn tell(&self, how: impl FnOnce(&mut State)) {
        self.change(how);
        (self.deliver)(Event::Status);
    }

    /// An overlay or zoom command for the windows.
    pub fn view(&self, command: &str) {
        self.say(FromEditor::View(command.to_owned()));
    }

    /// The overlay and zoom commands in force where the scene is followed.
    pub fn catch_up(&self, commands: &[String]) {
        self.change(|state| {
            let message = state.latest.catch_up(commands);
            state.say(None, message);
        });
    }

    /// Tells the windows something, as [`State::say`].
    pub fn say(&self, message: FromEditor) {
        self.change(|state| state.say(None, message));
    }

    /// Waits until a condition holds, but not longer than this.
    pub fn wait(&self, most: Duration, until: impl Fn(&State) -> bool) -> MutexGuard<'_, State> {
        let waited = self.changed.wait_timeout_while(self.lock(), most, |state| !until(state));
        waited.unwrap_or_else(PoisonError::into_inner).0
    }

    /// Asks the windows for what they have not told yet; returns the number of the question.
    pub fn asks(&self) -> u64 {
        let mut nth = 0;
        self.change(|state| {
            state.asked += 1;
            nth = state.asked;
            state.say(None, FromEditor::Ask(nth));
        });
        nth
    }

    /// Waits until all windows have answered a question, but not longer than this, and tells which have not. Nothing is told
    /// of a question after which another was asked.
    pub fn answers(&self, nth: u64, most: Duration) {
        let owes = |peer: &&Peer| peer.answered < nth;
        let is_over = |state: &State| state.closing || state.asked > nth;
        let state = self.wait(most, |state| is_over(state) || !state.peers.values().any(|peer| owes(&peer)));
        let windows = state.peers.values().zip(1..).filter(|(peer, _)| owes(peer)).map(|(_, nth)| nth).collect();
        let silent = Silent { windows, of: state.peers.len() };
        let is_latest = state.asked == nth;
        drop(state);
        if is_latest {
            (self.deliver)(Event::Answered(silent));
        }
    }

    /// Waits for a window to join by itself, or for the editor to close; returns whether either happened in time.
    pub fn a_window_comes(&self, most: Duration) -> bool {
        let state = self.wait(most, |state| state.closing || !state.peers.is_empty());
        state.closing || !state.peers.is_empty()
    }

    /// Takes connections until the editor ends.
    pub fn take_connections(self: &Arc<Self>, listener: &Listener, scene: &Path) {
        loop {
            let caller = listener.accept();
            {
                let mut state = self.lock();
                if state.closing {
                    return;
                }
                if state.connections == MAX_PEERS || caller.is_err() {
                    drop(state);
                    // Most likely out of file handles: wait, so as not to spin.
                    std::thread::sleep(Duration::from_millis(50));
                    continue;
                }
                state.connections += 1;
            }
            let (shared, scene) = (self.clone(), scene.to_owned());
            let started = thread("link reader", move || {
                let talk = || caller.map_err(|e| Error::at("link", e)).and_then(|caller| shared.talk(caller, &scene));
                // A fault ends this connection and no other.
                if let Ok(Err(error)) = fault::caught(talk) {
                    tracing::info!("{error}");
                }
                shared.change(|state| state.connections -= 1);
            });
            if started.is_err() {
                self.change(|state| state.connections -= 1);
            }
        }
    }

    fn talk(self: &Arc<Self>, caller: Caller, scene: &Path) -> Result<()> {
        match caller.greet()? {
            (Role::Window, wire) => self.talk_with_window(wire, scene),
            (Role::Script, wire) => self.talk_with_script(wire, scene),
        }
    }

    /// Sends a window the whole state, then every change, and handles what it says, until it is gone.
    pub fn talk_with_window(self: &Arc<Self>, wire: Wire, scene: &Path) -> Result<()> {
        let Wire { mut reader, mut writer, hang_up } = wire;
        let (latest, id) = {
            let mut state = self.lock();
            let (latest, id) = (state.latest.clone(), state.next_peer);
            state.next_peer += 1;
            state.peers.insert(id, Peer { outbox: Outbox::greeted(&latest), hang_up, answered: 0 });
            (latest, id)
        };
        let hello = hello(scene, &latest);
        self.tell(|_| {});
        let writing = self.clone();
        let started = thread("link writer", move || {
            if let Err(error) = frame::write(&mut writer, &hello).and_then(|()| writing.write(id, &mut *writer)) {
                tracing::info!("{error}");
            }
            writing.forget(id);
        });
        let ended = fault::caught(|| started.and_then(|()| self.read(id, &mut *reader)));
        self.forget(id);
        ended.unwrap_or_else(|fault| Err(Error::at("link", fault)))
    }

    /// Sends what the outbox holds until the window is gone.
    fn write(&self, id: u64, mut to: &mut (dyn Write + Send)) -> Result<()> {
        loop {
            let outgoing = {
                let mut state = self.lock();
                loop {
                    let State { latest, peers, closing, .. } = &mut *state;
                    let Some(peer) = peers.get_mut(&id) else { return Ok(()) };
                    if *closing {
                        break None;
                    }
                    if let Some(outgoing) = peer.outbox.next(latest) {
                        break Some(outgoing);
                    }
                    let Some(alive) = self.alive else {
                        state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
                        continue;
                    };
                    let (now, waited) = self.changed.wait_timeout(state, alive).unwrap_or_else(PoisonError::into_inner);
                    state = now;
                    if waited.timed_out() {
                        break Some(Outgoing::Plain(FromEditor::Alive));
                    }
                }
            };
            match outgoing {
                Some(outgoing) => frame::write(&mut to, &outgoing.into_message())?,
                None => return frame::write(&mut to, &FromEditor::Bye("the editor was closed".into())),
            }
        }
    }

    fn outbox(&self, id: u64, how: impl FnOnce(&mut Outbox)) {
        self.change(|state| {
            if let Some(peer) = state.peers.get_mut(&id) {
                how(&mut peer.outbox);
            }
        });
    }

    /// Handles what the window says until it is gone.
    fn read(&self, id: u64, mut from: &mut (dyn Read + Send)) -> Result<()> {
        while let Some(said) = frame::read::<ToEditor>(&mut from, frame::most())? {
            match said {
                ToEditor::Ack { revision, synth_ms } => {
                    self.change(|state| state.report.synth_ms = Some(synth_ms));
                    self.outbox(id, |outbox| outbox.shown(revision));
                    self.heard(said);
                }
                ToEditor::Report { .. } => {
                    let said = said.in_lines();
                    if let ToEditor::Report { fps, adapter, notice } = &said {
                        self.change(|state| state.report.take(*fps, adapter, notice));
                    }
                    self.heard(said);
                }
                ToEditor::Gesture(ref gesture) => {
                    gesture.echo().into_iter().for_each(|echo| self.change(|state| state.say(Some(id), echo)));
                    self.heard(said);
                }
                ToEditor::WantScene => self.outbox(id, Outbox::want_scene),
                ToEditor::Want { hash, offset } => self.outbox(id, |outbox| outbox.want(hash, offset)),
                ToEditor::Answer(nth) => {
                    self.heard(said);
                    self.change(|state| {
                        state.peers.get_mut(&id).into_iter().for_each(|peer| peer.answered = nth);
                    });
                }
                ToEditor::Alive => {}
                ToEditor::Hello { .. } | ToEditor::Edit { .. } => {
                    return Err(Error::at("link", "a window said what only a script says"));
                }
            }
        }
        Ok(())
    }

    fn heard(&self, said: ToEditor) {
        (self.deliver)(Event::Said(said.in_lines()));
    }

    fn forget(&self, id: u64) {
        let mut gone = None;
        self.change(|state| {
            gone = state.peers.remove(&id);
            if state.peers.is_empty() {
                state.report = Report::default();
            }
        });
        if let Some(peer) = gone {
            peer.hang_up.now();
            (self.deliver)(Event::Status);
        }
    }

    fn talk_with_script(&self, mut wire: Wire, scene: &Path) -> Result<()> {
        let latest = self.lock().latest.clone();
        frame::write(&mut wire.writer, &hello(scene, &latest))?;
        while let Some(said) = frame::read::<ToEditor>(&mut wire.reader, frame::most())? {
            let ToEditor::Edit { revision, patch } = said else {
                return Err(Error::at("link", "a script said what only a window says"));
            };
            let problems = self.ask(revision, patch);
            frame::write(&mut wire.writer, &FromEditor::Edited(problems))?;
        }
        Ok(())
    }

    /// Hands an edit to the editor and waits for its answer.
    fn ask(&self, revision: u64, edit: Edit) -> Vec<Problem> {
        if self.lock().latest.revision != revision {
            return vec![Problem::error("", "the scene changed meanwhile")];
        }
        let (asked, answered) = Asked::new(edit);
        (self.deliver)(Event::Edit(asked));
        let no_answer = |_| vec![Problem::error("", "the editor does not take the edit")];
        answered.recv_timeout(ANSWER).unwrap_or_else(no_answer)
    }
}
