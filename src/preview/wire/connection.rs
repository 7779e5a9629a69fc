//! An open connection to the other end of the link, over a socket or over pipes.

use std::io::{self, Read, Write};
use std::net::Shutdown;
use std::os::unix::net::UnixStream;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Over pipes to another machine each end says something at least this often, ...
pub const ALIVE: Duration = Duration::from_secs(5);
/// ... and an end that has heard nothing for this long considers the other end gone.
pub const SILENCE: Duration = Duration::from_secs(20);

/// How long one write may block before the other end is considered gone.
const STUCK: Duration = Duration::from_secs(10);

/// An open connection: two halves that may live on two threads, and a way to end both.
pub struct Wire {
    /// Reads what the other end says.
    pub reader: Box<dyn Read + Send>,
    /// Writes what the other end is told.
    pub writer: Box<dyn Write + Send>,
    /// Ends both halves from any thread.
    pub hang_up: HangUp,
}

/// Ends a connection from any thread.
#[derive(Clone)]
pub struct HangUp(Arc<dyn Fn() + Send + Sync>);

impl HangUp {
    /// A connection that is ended by `how`, which may be called more than once.
    pub fn new(how: impl Fn() + Send + Sync + 'static) -> HangUp {
        HangUp(Arc::new(how))
    }

    /// Ends it; the halves see the end of the stream.
    pub fn now(&self) {
        (self.0)();
    }
}

impl Wire {
    /// Over a socket, with both time limits set for work after the handshake.
    pub(super) fn socket(stream: UnixStream) -> io::Result<Wire> {
        stream.set_read_timeout(None)?;
        stream.set_write_timeout(Some(STUCK))?;
        let (reader, writer) = (stream.try_clone()?, stream.try_clone()?);
        // It may have ended already.
        let hang_up = HangUp::new(move || drop(stream.shutdown(Shutdown::Both)));
        Ok(Wire { reader: Box::new(reader), writer: Box::new(writer), hang_up })
    }

    /// The same, ended once nothing has arrived for this long: for pipes to another machine, which may vanish silently.
    pub fn watched(self, most: Duration) -> Wire {
        let heard = Arc::new(Mutex::new(Instant::now()));
        let (seen, hang_up) = (Arc::downgrade(&heard), self.hang_up.clone());
        std::thread::spawn(move || {
            while let Some(heard) = seen.upgrade() {
                let silent = heard.lock().unwrap_or_else(PoisonError::into_inner).elapsed();
                if silent >= most {
                    return hang_up.now();
                }
                drop(heard);
                std::thread::sleep((most - silent).min(most / 4));
            }
        });
        Wire { reader: Box::new(Noted { reader: self.reader, heard }), ..self }
    }
}

/// A reader that notes when something last arrived.
struct Noted {
    reader: Box<dyn Read + Send>,
    heard: Arc<Mutex<Instant>>,
}

impl Read for Noted {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.reader.read(buffer);
        *self.heard.lock().unwrap_or_else(PoisonError::into_inner) = Instant::now();
        read
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_silent_end_counts_as_gone_and_a_speaking_one_does_not() {
        let (here, mut there) = UnixStream::pair().unwrap();
        let most = Duration::from_millis(200);
        let Wire { mut reader, .. } = Wire::socket(here).unwrap().watched(most);
        let began = Instant::now();
        let speaking = std::thread::spawn(move || {
            for _ in 0..6 {
                std::thread::sleep(most / 4);
                there.write_all(b"x").unwrap();
            }
            there
        });
        let mut heard = Vec::new();
        // Ends because it was hung up: the other end is still there.
        reader.read_to_end(&mut heard).unwrap();
        assert_eq!(heard.len(), 6);
        assert!(began.elapsed() > most, "{:?}", began.elapsed());
        drop(speaking.join());
    }
}
