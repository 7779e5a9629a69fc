//! Keeps the window's process alive: starts it, captures what it says on standard error (graphics drivers chatter there),
//! starts it again when it dies, later each time, and gives up with one clear line when it dies too often.

use std::collections::VecDeque;
use std::io::Read;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Waits before the next start, by deaths in a row.
const WAITS: [Duration; 3] = [Duration::from_millis(100), Duration::from_millis(400), Duration::from_millis(1600)];
/// This many deaths ...
const TOO_MANY: usize = 3;
/// ... within this time are too many.
const WITHIN: Duration = Duration::from_secs(60);
/// How much of the end of standard error is kept, in bytes.
const KEPT: usize = 4096;

/// Decides when to start a process again that died. Times are measured from any fixed moment.
#[derive(Debug, Default)]
struct Backoff {
    recent: Vec<Duration>,
    in_a_row: usize,
}

impl Backoff {
    /// The process died at `now`, having run for `lived`. Returns how long to wait before the next start; `None` to give up.
    fn died(&mut self, now: Duration, lived: Duration) -> Option<Duration> {
        self.recent.retain(|&death| now.saturating_sub(death) < WITHIN);
        self.recent.push(now);
        self.in_a_row = if lived >= WITHIN { 0 } else { self.in_a_row + 1 };
        let wait = WAITS[self.in_a_row.clamp(1, WAITS.len()) - 1];
        (self.recent.len() < TOO_MANY).then_some(wait)
    }
}

/// How the process is doing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::preview) enum Life {
    /// It runs, or will run again in a moment.
    Running,
    /// It ended with success: the person closed it.
    Closed,
    /// It died too often; the reason in one line.
    GivenUp(String),
}

/// A process that is kept alive until this is dropped, which ends it.
pub(in crate::preview) struct Keeper {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

struct Shared {
    state: Mutex<State>,
    changed: Condvar,
}

struct State {
    child: Option<Child>,
    stop: bool,
}

impl Keeper {
    /// Calls `command` for each start, if `wanted` (which may be slow) says so.
    /// `tell` is called on the keeper's thread with each change of its life; with `None` if it was not wanted.
    pub fn start(
        wanted: impl FnOnce() -> bool + Send + 'static,
        command: impl Fn() -> Command + Send + 'static,
        tell: impl Fn(Option<Life>) + Send + 'static,
    ) -> std::io::Result<Keeper> {
        let state = Mutex::new(State { child: None, stop: false });
        let shared = Arc::new(Shared { state, changed: Condvar::new() });
        let kept = shared.clone();
        let thread = std::thread::Builder::new().name("window keeper".into()).spawn(move || {
            tell(Some(Life::Running));
            match wanted() {
                true => kept.keep(command, &tell),
                false => tell(None),
            }
        })?;
        Ok(Keeper { shared, thread: Some(thread) })
    }

    /// Waits for the process to end, for one that was asked to.
    pub fn wait_for_end(&self, most: Duration) {
        let state = self.shared.lock();
        let gone = self.shared.changed.wait_timeout_while(state, most, |state| state.child.is_some());
        drop(gone.unwrap_or_else(PoisonError::into_inner));
    }
}

impl Drop for Keeper {
    fn drop(&mut self) {
        {
            let mut state = self.shared.lock();
            state.stop = true;
            if let Some(child) = &mut state.child {
                // It may be gone already.
                drop(child.kill());
            }
        }
        self.shared.changed.notify_all();
        if let Some(thread) = self.thread.take() {
            drop(thread.join());
        }
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Runs until stopped, closed or given up.
    fn keep(&self, command: impl Fn() -> Command, tell: &impl Fn(Option<Life>)) {
        let start = Instant::now();
        let mut backoff = Backoff::default();
        loop {
            let born = Instant::now();
            let reason = match self.live(&command) {
                Ok(_) if self.lock().stop => return,
                Ok((status, _)) if status.success() => return tell(Some(Life::Closed)),
                Ok((status, said)) => last_words(&said, status),
                Err(error) => error.to_string(),
            };
            let Some(wait) = backoff.died(start.elapsed(), born.elapsed()) else {
                return tell(Some(Life::GivenUp(reason)));
            };
            let state = self.lock();
            let (state, _) = self
                .changed
                .wait_timeout_while(state, wait, |state| !state.stop)
                .unwrap_or_else(PoisonError::into_inner);
            if state.stop {
                return;
            }
        }
    }

    /// One life: returns how it ended and the end of what it said.
    fn live(&self, command: &impl Fn() -> Command) -> std::io::Result<(ExitStatus, String)> {
        let stderr = {
            let mut state = self.lock();
            if state.stop {
                return Ok((ExitStatus::default(), String::new()));
            }
            let mut child = command().stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn()?;
            let stderr = child.stderr.take();
            state.child = Some(child);
            stderr
        };
        // Standard error ends with the process; waiting first would hold the lock that ending it needs.
        let said = stderr.map(tail).unwrap_or_default();
        let mut state = self.lock();
        let status = state.child.as_mut().map_or(Ok(ExitStatus::default()), Child::wait);
        state.child = None;
        self.changed.notify_all();
        Ok((status?, said))
    }
}

/// The last bytes of a stream, as text.
pub(in crate::preview) fn tail(mut stream: impl Read) -> String {
    let mut kept = VecDeque::new();
    let mut buffer = [0; 1024];
    while let Ok(n) = stream.read(&mut buffer) {
        if n == 0 {
            break;
        }
        kept.extend(&buffer[..n]);
        kept.drain(..kept.len().saturating_sub(KEPT));
    }
    String::from_utf8_lossy(kept.make_contiguous()).into_owned()
}

/// One line on why a process died: its own message if it has one, else what the system says.
fn last_words(said: &str, status: ExitStatus) -> String {
    let mut lines = said.lines().rev().map(str::trim).filter(|line| !line.is_empty());
    let own = said.lines().rev().find_map(|line| line.strip_prefix("plica: "));
    let line = own.or_else(|| lines.next()).map_or_else(|| format!("it ended with {status}"), str::to_owned);
    line.chars().filter(|c| !c.is_control()).take(200).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;

    use super::*;

    #[test]
    fn a_process_that_dies_comes_back_later_each_time_and_not_for_ever() {
        let secs = Duration::from_secs;
        // When it died and how long it had lived, in seconds, and the wait that follows, in milliseconds.
        type Death = (u64, u64, Option<u64>);
        let table: [(&str, &[Death]); 4] = [
            ("at once", &[(0, 0, Some(100)), (1, 1, Some(400)), (2, 1, None)]),
            ("spread", &[(0, 0, Some(100)), (50, 50, Some(400)), (70, 20, Some(1600)), (120, 50, Some(1600))]),
            ("long lives", &[(60, 60, Some(100)), (130, 70, Some(100)), (200, 70, Some(100))]),
            ("a long life between", &[(0, 0, Some(100)), (70, 70, Some(100)), (71, 1, Some(100))]),
        ];
        for (name, deaths) in table {
            let mut backoff = Backoff::default();
            for &(now, lived, wait) in deaths {
                assert_eq!(backoff.died(secs(now), secs(lived)), wait.map(Duration::from_millis), "{name}, {now} s");
            }
        }
    }

    fn shell(script: &'static str) -> (Keeper, mpsc::Receiver<Life>) {
        let (sender, lives) = mpsc::channel();
        let command = move || {
            let mut command = Command::new("sh");
            command.args(["-c", script]);
            command
        };
        (Keeper::start(|| true, command, move |life| drop(sender.send(life.unwrap()))).unwrap(), lives)
    }

    #[test]
    fn the_reason_is_one_clear_line() {
        let table = [
            (
                "echo chatter >&2; echo 'plica: no display: none here' >&2; echo more >&2; exit 1",
                "no display: none here",
            ),
            ("printf 'first\\n\\033last\\n\\n' >&2; exit 1", "last"),
            ("exit 3", "it ended with exit status: 3"),
            ("kill -9 $$", "it ended with signal: 9 (SIGKILL)"),
        ];
        for (script, reason) in table {
            let (_keeper, lives) = shell(script);
            let told: Vec<Life> = lives.iter().collect();
            assert_eq!(told, [Life::Running, Life::GivenUp(reason.into())], "{script}");
        }
    }

    #[test]
    fn a_window_that_was_closed_stays_closed() {
        let (_keeper, lives) = shell("exit 0");
        assert_eq!(lives.iter().collect::<Vec<_>>(), [Life::Running, Life::Closed]);
    }

    #[test]
    fn dropping_the_keeper_ends_the_process_and_says_nothing() {
        let (keeper, lives) = shell("echo up >&2; exec sleep 1000");
        assert_eq!(lives.recv(), Ok(Life::Running));
        drop(keeper);
        assert_eq!(lives.iter().collect::<Vec<_>>(), []);
    }
}
