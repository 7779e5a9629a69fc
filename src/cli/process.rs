//! What a process owes its surroundings: it ends when asked to and leaves nothing half-written, ends quietly when nobody
//! reads its output any more, and says one line about a fault of its own.

use std::io::{self, Write};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use crate::base::error::{Error, Result};
use crate::base::system::process;
use crate::base::system::signals::{self, Answer, Signal};
use crate::base::text::printable;
use crate::files::temporary;

/// How long work may take to notice that it is cancelled: a person should not wait longer for the prompt.
const GRACE: Duration = Duration::from_millis(400);

/// Lets the first signal to end cancel the work; a second one, or patience running out, ends the process. That holds until
/// the process is gone: a second signal on its way out changes nothing.
///
/// # Errors
/// When signals cannot be listened to.
pub fn cancel_on_signals(cancel: Arc<AtomicBool>) -> Result<()> {
    let handler = move |signal| match signal {
        Signal::Stop | Signal::Continue | Signal::Resize => Answer::Pass,
        _ if cancel.swap(true, Ordering::Relaxed) => end(),
        _ => {
            std::thread::spawn(|| {
                std::thread::sleep(GRACE);
                // Where nobody reads it there is nothing more to do.
                let _ = writeln!(io::stderr(), "plica: {}", Error::Interrupted);
                end()
            });
            Answer::Done
        }
    };
    std::mem::forget(signals::handle(handler).map_err(|error| Error::at("signals", error))?);
    Ok(())
}

fn end() -> ! {
    temporary::remove_unfinished();
    process::end(Error::Interrupted.exit_status())
}

/// Makes a panic one line on standard error; the rest goes to the log.
pub fn report_panics(log: Option<PathBuf>) {
    std::panic::set_hook(Box::new(move |panic| {
        tracing::error!("{panic}\n{}", std::backtrace::Backtrace::force_capture());
        let line = panic.to_string().replace('\n', " ");
        let more = log.as_ref().map(|log| format!("; more in {}", log.display())).unwrap_or_default();
        // Where nobody reads it there is nothing more to do.
        let _ = writeln!(io::stderr(), "plica: a fault of its own: {}{}", printable(&line), printable(&more));
    }));
}

/// Standard output that remembers whether its reader has gone.
pub struct Output {
    out: io::Stdout,
    closed: Arc<AtomicBool>,
}

impl Output {
    /// Standard output; `closed` becomes true once nobody reads it.
    pub fn new(closed: Arc<AtomicBool>) -> Self {
        Output { out: io::stdout(), closed }
    }

    fn note<T>(&self, outcome: io::Result<T>) -> io::Result<T> {
        if outcome.as_ref().is_err_and(|error| error.kind() == io::ErrorKind::BrokenPipe) {
            self.closed.store(true, Ordering::Relaxed);
        }
        outcome
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let outcome = self.out.write(bytes);
        self.note(outcome)
    }

    fn flush(&mut self) -> io::Result<()> {
        let outcome = self.out.flush();
        self.note(outcome)
    }
}

/// Whether a person sits at a terminal: only then does a command open the editor unasked.
#[cfg(feature = "tui")]
pub fn is_interactive() -> bool {
    use std::io::IsTerminal;
    io::stdin().is_terminal() && io::stdout().is_terminal()
}
