//! Writes to the terminal without blocking. While the terminal does not read (a frozen link, Ctrl-S), output waits here, and
//! the editor goes on: keys still work, and the journal records them. Nothing more is drawn until all of it is written; then
//! the screen is updated to the present state.

use std::io::{self, ErrorKind, Write, stdout};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use crate::base::system;

/// Whether output is waiting for the terminal.
static BEHIND: AtomicBool = AtomicBool::new(false);

/// How many bytes were given to the terminal so far.
static GIVEN: AtomicUsize = AtomicUsize::new(0);

/// How many bytes were given to the terminal so far.
pub fn given() -> usize {
    GIVEN.load(Ordering::Relaxed)
}

/// Whether the terminal has not yet read all that was drawn.
pub fn is_behind() -> bool {
    BEHIND.load(Ordering::Relaxed)
}

/// A writer to the terminal that never waits for it.
pub struct Pace {
    /// The terminal, opened for writing without blocking; `None` if that is not possible, and writes block.
    terminal: Option<Box<dyn Write + Send>>,
    waiting: Vec<u8>,
}

impl Pace {
    /// Writes to the terminal at standard output.
    pub fn new() -> Pace {
        let terminal = system::open_terminal(stdout()).ok();
        Pace { terminal: terminal.map(|terminal| Box::new(terminal) as Box<dyn Write + Send>), waiting: Vec::new() }
    }

    fn push(&mut self) -> io::Result<()> {
        let Some(terminal) = &mut self.terminal else {
            let mut out = stdout().lock();
            out.write_all(&self.waiting).and_then(|()| out.flush())?;
            self.waiting.clear();
            return Ok(());
        };
        let mut sent = 0;
        let pushed = loop {
            match terminal.write(&self.waiting[sent..]) {
                _ if sent == self.waiting.len() => break Ok(()),
                Ok(0) => break Err(ErrorKind::WriteZero.into()),
                Ok(bytes) => sent += bytes,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if error.kind() == ErrorKind::WouldBlock => break Ok(()),
                Err(error) => break Err(error),
            }
        };
        self.waiting.drain(..sent);
        BEHIND.store(!self.waiting.is_empty(), Ordering::Relaxed);
        pushed
    }
}

impl Write for Pace {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.waiting.extend_from_slice(bytes);
        GIVEN.fetch_add(bytes.len(), Ordering::Relaxed);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.push()
    }
}

/// Gives the terminal this long to read the rest of the output.
pub fn drain(screen: &mut impl Write, most: Duration) {
    let begun = Instant::now();
    // A terminal that has gone away reads nothing more.
    while screen.flush().is_ok() && is_behind() && begun.elapsed() < most {
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;
    use std::os::unix::net::UnixStream;

    #[test]
    fn a_terminal_that_does_not_read_makes_nobody_wait() {
        let (ours, mut theirs) = UnixStream::pair().unwrap();
        ours.set_nonblocking(true).unwrap();
        let mut pace = Pace { terminal: Some(Box::new(ours)), waiting: Vec::new() };
        let drawn: Vec<u8> = (0..4_000_000_u32).map(|i| (i % 251) as u8).collect();
        pace.write_all(&drawn).unwrap();
        pace.flush().unwrap();
        assert!(!pace.waiting.is_empty(), "more than a socket takes at once");
        let reader = std::thread::spawn(move || {
            let mut read = vec![0; 4_000_000];
            theirs.read_exact(&mut read).unwrap();
            read
        });
        while !pace.waiting.is_empty() {
            pace.flush().unwrap();
            std::thread::yield_now();
        }
        assert!(reader.join().unwrap() == drawn);
        pace.write_all(b"to nobody").unwrap();
        assert!(pace.flush().is_err(), "gone away");
    }
}
