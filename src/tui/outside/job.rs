//! A subcommand, or other work, that runs beside the editor: its progress and its result arrive as events.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError, mpsc};
use std::time::{Duration, Instant};

use crate::base::error::Error;
use crate::base::fault;
use crate::files::temporary;
use crate::ops;
use crate::tui::events::Event;

/// How long a subcommand has to end when the editor ends.
const LAST: Duration = Duration::from_millis(400);

/// Work that is running.
pub struct Job {
    cancel: Arc<AtomicBool>,
    thread: std::thread::JoinHandle<()>,
}

impl Job {
    /// Runs `command`, and sends its progress and its result as events.
    pub fn start(command: ops::Command, name: String, open: Option<ops::Open>, events: mpsc::Sender<Event>) -> Job {
        let cancel = Arc::new(AtomicBool::new(false));
        let shared = cancel.clone();
        let thread = std::thread::spawn(move || {
            let out = Buffer::default();
            let said = Buffer::default();
            let messages =
                Messages { name: name.clone(), said: said.clone(), events: events.clone(), begun: None, shown: None };
            let mut context =
                ops::Context { out: Box::new(out.clone()), messages: Box::new(messages), cancel: shared, open };
            let result = fault::caught(|| command.run(&mut context));
            let also = said.text().lines().map(|line| format!("; {line}")).collect::<String>();
            let result = match result {
                Ok(Ok(())) => Ok(answer(&name, &out.text(), &said.text())),
                Ok(Err(Error::Interrupted)) => Err(format!("{name}: interrupted, nothing half-written is left{also}")),
                // What it printed before (each problem, say) is above what went wrong.
                Ok(Err(error)) => Err(format!("{}{name}: {error}", out.text())),
                Err(fault) => Err(format!("{name}: {fault}")),
            };
            // Nobody listens once the editor has left.
            let _ = events.send(Event::Done(result));
        });
        Job { cancel, thread }
    }

    /// Other work that looks at the flag with which it is asked to end.
    pub fn beside(run: impl FnOnce(&AtomicBool) + Send + 'static) -> Job {
        let cancel = Arc::new(AtomicBool::new(false));
        let shared = cancel.clone();
        Job { cancel, thread: std::thread::spawn(move || run(&shared)) }
    }

    /// Asks it to end.
    pub fn cancel(&self) {
        self.cancel.store(true, Ordering::Relaxed);
    }

    /// Asks it to end and waits for it, so that nothing half-written is left. If it does not end (a FIFO that nobody reads), it
    /// is abandoned after a while.
    pub fn end(self) {
        self.cancel();
        let asked = Instant::now();
        while !self.thread.is_finished() {
            if asked.elapsed() > LAST {
                tracing::warn!("a subcommand did not end");
                return temporary::remove_unfinished();
            }
            std::thread::sleep(Duration::from_millis(5));
        }
    }
}

/// The message of a subcommand that has succeeded. Output becomes pages; otherwise it is one line with the last message
/// first, then warnings.
fn answer(name: &str, printed: &str, said: &str) -> String {
    if !printed.trim().is_empty() {
        return format!("{printed}{said}");
    }
    let lines: Vec<&str> = said.lines().filter(|line| !line.trim().is_empty()).collect();
    match lines.split_last() {
        Some((last, earlier)) => [&[*last], earlier].concat().join("; "),
        None => format!("{name}: done"),
    }
}

/// Output of a subcommand, in memory.
#[derive(Clone, Default)]
struct Buffer(Arc<Mutex<Vec<u8>>>);

impl Buffer {
    fn text(&self) -> String {
        String::from_utf8_lossy(&self.0.lock().unwrap_or_else(PoisonError::into_inner)).into_owned()
    }
}

impl std::io::Write for Buffer {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// Progress for the status line.
struct Messages {
    name: String,
    said: Buffer,
    events: mpsc::Sender<Event>,
    /// When the work in progress began.
    begun: Option<Instant>,
    shown: Option<Instant>,
}

/// Progress as a line: what, how far, a bar, the share, and how long the rest will take.
pub fn progress(name: &str, what: &str, (done, total): (u64, u64), spent: Duration) -> String {
    const CELLS: u64 = 8;
    let of = |whole: u64| done.min(total) * whole / total.max(1);
    let bar: String = (0..CELLS).map(|i| if i < of(CELLS) { '█' } else { '░' }).collect();
    let left = ops::left(spent, done, total);
    format!("{name}: {what} {done}/{total} {bar} {}%{left}", of(100))
}

impl ops::Progress for Messages {
    fn say(&mut self, line: &str) {
        use std::io::Write;
        // Writing to memory cannot fail.
        let _ = writeln!(self.said, "{line}");
    }

    fn step(&mut self, what: &str, done: u64, total: u64) {
        let begun = *self.begun.get_or_insert_with(Instant::now);
        if self.shown.is_none_or(|at| at.elapsed() > Duration::from_millis(100)) {
            self.shown = Some(Instant::now());
            let line = progress(&self.name, what, (done, total), begun.elapsed());
            // Nobody listens once the editor has left.
            let _ = self.events.send(Event::Progress(line));
        }
        if done >= total {
            self.begun = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_only_said_is_one_line_that_begins_with_the_end() {
        for (printed, said, expected) in [
            ("", "", "render: done"),
            ("", "done: a.gif\n", "done: a.gif"),
            (
                "",
                "s: warning: nothing moves\nframes 8/8\ndone: a.gif\n",
                "done: a.gif; s: warning: nothing moves; frames 8/8",
            ),
            ("a\nb\n", "warning\n", "a\nb\nwarning\n"),
        ] {
            assert_eq!(answer("render", printed, said), expected);
        }
    }

    #[test]
    fn work_tells_how_far_it_is() {
        for (step, secs, line) in [
            ((0, 60), 0, "render: frame 0/60 ░░░░░░░░ 0%"),
            ((15, 60), 2, "render: frame 15/60 ██░░░░░░ 25%, 6 s left"),
            ((60, 60), 9, "render: frame 60/60 ████████ 100%"),
            ((0, 0), 1, "render: frame 0/0 ░░░░░░░░ 0%"),
        ] {
            assert_eq!(progress("render", "frame", step, Duration::from_secs(secs)), line);
        }
    }
}
