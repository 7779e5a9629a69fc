//! What commands that write files have in common: what they may replace, and what they print when done.

use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use super::Context;
use crate::base::text;
use crate::files::outputs::Guard;
use crate::files::{self, scene};
use crate::scene::Scene;

/// What an output may replace.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct Replacing {
    /// Replace files of another kind too; what the scene reads is never replaced
    #[arg(long)]
    force: bool,
}

impl Replacing {
    /// The guard of an output made from the scene at `path`. It protects the files of that scene, and those of the
    /// scene that the editor has open, both as edited and as saved.
    pub fn guard(&self, path: &Path, scene: &Scene, context: &Context) -> Guard {
        let mut guard = Guard::new(self.force);
        guard.protect(path, scene);
        if let Some(open) = &context.open {
            guard.protect(&open.path, open.document.scene());
            let saved = scene::open(&open.path, &files::Options::default()).ok();
            saved.iter().for_each(|saved| guard.protect(&open.path, saved.scene()));
        }
        guard
    }
}

impl Context {
    /// Prints that `what` is done, how large it is and how long it took.
    pub fn done(&mut self, what: &str, bytes: u64, begun: Instant) {
        let took = u64::try_from(begun.elapsed().as_millis()).unwrap_or(u64::MAX);
        // What went through a pipe has no size afterwards.
        let size = if bytes == 0 { String::new() } else { format!("{}, ", text::bytes(bytes)) };
        self.messages.say(&format!("done: {what}, {size}{}", text::took(took)));
    }

    /// Prints some lines.
    pub fn say_all(&mut self, lines: &[String]) {
        lines.iter().for_each(|line| self.messages.say(line));
    }
}

/// A stream that counts what goes through it.
pub struct Counting {
    /// Where it goes.
    pub out: Box<dyn Write + Send>,
    /// How many bytes went through.
    pub count: Arc<AtomicU64>,
}

impl Write for Counting {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes)?;
        self.count.fetch_add(written as u64, Ordering::Relaxed);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}
