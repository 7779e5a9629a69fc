//! A program of the person's that rows go through: it gets a table on its standard input and answers on its standard output.

use std::io::{Read, Write};
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use super::job::Job;
use crate::base::system;
use crate::tui::events::Event;
use crate::tui::text::wrap::clipped;

/// How long it may take.
const LIMIT: Duration = Duration::from_secs(60);
/// How often to look whether it has ended.
const LOOK_EVERY: Duration = Duration::from_millis(10);
/// How often the time is told.
const TELL_EVERY: Duration = Duration::from_millis(500);
/// How long its output may take to arrive once it has ended.
const LAST: Duration = Duration::from_secs(2);
/// The most bytes that are kept of what it complains about.
const MOST_SAID: u64 = 4000;

/// Begins it. What it gives back, at most so many bytes, arrives as an event.
pub fn start(program: String, table: String, most: u64, events: mpsc::Sender<Event>) -> Job {
    Job::beside(move |cancel| {
        let tell = |line| drop(events.send(Event::Progress(line)));
        let result = through((&program, table), (LIMIT, most), cancel, tell);
        // Nobody listens once the editor has left.
        let _ = events.send(Event::Piped(result));
    })
}

/// Runs it to its end; it and all that it has started are ended with it.
fn through(
    (program, table): (&str, String),
    (limit, most): (Duration, u64),
    cancel: &AtomicBool,
    tell: impl Fn(String),
) -> Result<String, String> {
    let mut command = Command::new("sh");
    command.args(["-c", program]).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    // A group of its own: Ctrl-C is for us, and all of it can be ended.
    let mut child = command.process_group(0).spawn().map_err(|error| format!("sh: {error}"))?;
    if let Some(mut input) = child.stdin.take() {
        // A program that does not read all of it is free to do so.
        std::thread::spawn(move || drop(input.write_all(table.as_bytes())));
    }
    let (out, said) = (read(child.stdout.take(), most + 1, false), read(child.stderr.take(), MOST_SAID, true));
    let ended = wait(&mut child, program, limit, cancel, tell);
    system::end_group(child.id());
    let _ = child.wait();
    let status = ended?;
    let (out, said) = (out.recv_timeout(LAST).unwrap_or_default(), said.recv_timeout(LAST).unwrap_or_default());
    let said = String::from_utf8_lossy(&said);
    if out.len() as u64 > most {
        return Err(format!("{program} gave more than {most} bytes: nothing was taken (--limit paste)"));
    }
    if !status.success() {
        let last = said.trim().lines().last().map(|line| format!(": {line}")).unwrap_or_default();
        return Err(format!("{program} failed ({status}){last}: nothing was taken"));
    }
    String::from_utf8(out).map_err(|_| format!("{program} gave something that is not text: nothing was taken"))
}

/// Reads so many bytes of a stream, beside everything else; the rest is dropped, or else never read.
fn read(stream: Option<impl Read + Send + 'static>, most: u64, drop_rest: bool) -> mpsc::Receiver<Vec<u8>> {
    let (sender, receiver) = mpsc::channel();
    std::thread::spawn(move || {
        let mut all = Vec::new();
        if let Some(mut stream) = stream {
            // What came before a mistake is all there is.
            let _ = stream.by_ref().take(most).read_to_end(&mut all);
            let _ = sender.send(all);
            if drop_rest {
                let _ = std::io::copy(&mut stream, &mut std::io::sink());
            }
        }
    });
    receiver
}

/// Waits until it has ended.
fn wait(
    child: &mut Child,
    program: &str,
    limit: Duration,
    cancel: &AtomicBool,
    tell: impl Fn(String),
) -> Result<std::process::ExitStatus, String> {
    let begun = Instant::now();
    let mut told = begun;
    loop {
        if let Some(status) = child.try_wait().map_err(|error| format!("{program}: {error}"))? {
            return Ok(status);
        }
        if cancel.load(Ordering::Relaxed) {
            return Err(format!("{program} was ended: nothing was taken"));
        }
        if begun.elapsed() > limit {
            return Err(format!("{program} took longer than {} s and was ended: nothing was taken", limit.as_secs()));
        }
        if told.elapsed() > TELL_EVERY {
            told = Instant::now();
            tell(format!("pipe {} {} of {} s", clipped(program, 24), begun.elapsed().as_secs(), limit.as_secs()));
        }
        std::thread::sleep(LOOK_EVERY);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_answers_fails_or_is_ended() {
        let run = |program: &str, limit: u64, cancelled: bool| {
            let limits = (Duration::from_millis(limit), 1000);
            through((program, "x,y\n1,2\n".into()), limits, &AtomicBool::new(cancelled), |_| {})
        };
        assert_eq!(run("cat", 60_000, false), Ok("x,y\n1,2\n".into()));
        // What it leaves behind does not keep us.
        assert_eq!(run("(sleep 60; echo late) & echo 3", 60_000, false), Ok("3\n".into()));
        for (program, limit, cancelled, part) in [
            ("echo no >&2; exit 3", 60_000, false, "exit status: 3): no: nothing was taken"),
            ("sleep 60", 1, false, "took longer than 0 s and was ended"),
            ("sleep 60", 60_000, true, "was ended: nothing was taken"),
            ("yes", 60_000, false, "gave more than 1000 bytes"),
            ("printf '\\377'", 60_000, false, "not text"),
        ] {
            let why = run(program, limit, cancelled).unwrap_err();
            assert!(why.contains(part), "{program}: {why}");
        }
    }
}
