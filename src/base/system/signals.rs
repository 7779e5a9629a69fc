//! Signals have a thread of their own: a program that only looks at a flag between key presses spins or hangs for ever
//! when its terminal goes away. Handlers are ordinary code on that thread; they may lock, write and exit.

use std::io;
use std::sync::{Mutex, MutexGuard, PoisonError};

use signal_hook::consts::{
    SIGALRM, SIGCONT, SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGTSTP, SIGUSR1, SIGUSR2, SIGWINCH, SIGXCPU,
};

/// What the thread listens to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Signal {
    /// The terminal went away.
    Hangup,
    /// The system or a person asks the process to end.
    Terminate,
    /// Ctrl-C.
    Interrupt,
    /// Ctrl-Z.
    Stop,
    /// Going on after a stop.
    Continue,
    /// The terminal has another size.
    Resize,
}

/// One row per signal. Whatever would otherwise kill the process asks it to end: nothing is left half done, no terminal raw.
const TABLE: [(Signal, i32); 11] = [
    (Signal::Hangup, SIGHUP),
    (Signal::Terminate, SIGTERM),
    (Signal::Interrupt, SIGINT),
    (Signal::Stop, SIGTSTP),
    (Signal::Continue, SIGCONT),
    (Signal::Resize, SIGWINCH),
    (Signal::Terminate, SIGQUIT),
    (Signal::Terminate, SIGALRM),
    (Signal::Terminate, SIGUSR1),
    (Signal::Terminate, SIGUSR2),
    (Signal::Terminate, SIGXCPU),
];

/// Whether a handler has done what the signal asks for; else the next older one is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Done: nobody else is called.
    Done,
    /// Not mine.
    Pass,
}

type Handler = Box<dyn FnMut(Signal) -> Answer + Send>;

struct Registry {
    handlers: Vec<(u64, Handler)>,
    next: u64,
    started: bool,
}

static REGISTRY: Mutex<Registry> = Mutex::new(Registry { handlers: Vec::new(), next: 0, started: false });

/// A registered handler; dropping it takes the handler out. Not to be dropped by a handler.
#[derive(Debug)]
#[must_use = "the handler is taken out when this is dropped"]
pub struct Registration(u64);

impl Drop for Registration {
    fn drop(&mut self) {
        registry().handlers.retain(|(id, _)| *id != self.0);
    }
}

/// Calls `handler` for every signal from now on, before the older ones. A signal that nobody answers does what it does by
/// default.
///
/// # Errors
/// When the thread cannot be started.
pub fn handle(handler: impl FnMut(Signal) -> Answer + Send + 'static) -> io::Result<Registration> {
    let mut registry = registry();
    if !registry.started {
        let mut signals = signal_hook::iterator::Signals::new(TABLE.map(|(_, number)| number))?;
        std::thread::Builder::new().name("signals".into()).spawn(move || {
            for number in &mut signals {
                if let Some(&(signal, _)) = TABLE.iter().find(|(_, known)| *known == number) {
                    dispatch(signal);
                }
            }
        })?;
        registry.started = true;
    }
    let id = registry.next;
    registry.next += 1;
    registry.handlers.push((id, Box::new(handler)));
    Ok(Registration(id))
}

/// Does what the signal does by default: end the process, or stop it until it is continued.
pub fn default_action(signal: Signal) {
    let number = TABLE.iter().find(|(known, _)| *known == signal).map_or(SIGTERM, |&(_, number)| number);
    if let Err(error) = signal_hook::low_level::emulate_default_handler(number) {
        tracing::warn!("{signal:?}: {error}");
    }
}

fn dispatch(signal: Signal) {
    let answered = registry().handlers.iter_mut().rev().any(|(_, handler)| handler(signal) == Answer::Done);
    if !answered {
        default_action(signal);
    }
}

/// A handler that panicked leaves the table whole.
fn registry() -> MutexGuard<'static, Registry> {
    REGISTRY.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc;

    #[test]
    fn the_newest_handler_that_answers_is_the_last_called() {
        let (sender, heard) = mpsc::channel();
        let handler = |name: &'static str, answer: Answer| {
            let sender = sender.clone();
            handle(move |signal| {
                sender.send((name, signal)).unwrap();
                answer
            })
            .unwrap()
        };
        let _oldest = handler("oldest", Answer::Done);
        let newer = handler("newer", Answer::Pass);
        signal_hook::low_level::raise(SIGCONT).unwrap();
        assert_eq!(heard.recv().unwrap(), ("newer", Signal::Continue));
        assert_eq!(heard.recv().unwrap(), ("oldest", Signal::Continue));
        drop(newer);
        signal_hook::low_level::raise(SIGTERM).unwrap();
        assert_eq!(heard.recv().unwrap(), ("oldest", Signal::Terminate));
        assert!(heard.try_recv().is_err());
    }
}
