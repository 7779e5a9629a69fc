//! The window's side on the machine of the scene: joins the editor that has it open, else follows the file, and goes from
//! one to the other by itself with a word about it.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::time::Duration;

use super::news::{News, Sink, Update, window_sink};
use super::talk::{Heard, Outcome, Talk, WindowGone};
use crate::base::error::Error;
use crate::files::materials::Watched;
use crate::files::watch::Watch;
use crate::files::{self, Options};
use crate::preview::wire::handshake;
use crate::preview::wire::message::{FromEditor, Meaning, OfTheLink, Role, ToEditor};

/// How often to look for an editor while there is none.
const LOOK: Duration = Duration::from_millis(250);

/// Both ends of the talk with a window.
pub struct Link {
    /// What the window shows. The first update is the scene, or says why there is no scene yet.
    pub updates: Receiver<Update>,
    /// What the window has to say. Dropping it, or `updates`, ends the link.
    pub replies: Sender<ToEditor>,
}

/// Follows a scene in its editor or its file. `joined`: the window was opened by the editor, and is to close with it.
///
/// If a picture changes on disk, the scene is sent again; through a cache only that picture is read again.
pub fn follow(scene: &Path, options: &Options, joined: bool) -> Link {
    let (updates, receiver) = mpsc::channel();
    let replies = follow_with(scene, options, joined, window_sink(updates));
    Link { updates: receiver, replies }
}

/// The same for any receiver of the news.
pub(in crate::preview) fn follow_with(scene: &Path, options: &Options, joined: bool, sink: Sink) -> Sender<ToEditor> {
    let (talk, replies, heard) = Talk::new(scene.display().to_string(), options, sink);
    let client = Client { scene: scene.to_owned(), joined, talk, watch: None, watched: Watched::default() };
    std::thread::spawn(move || drop(client.run(&heard)));
    replies
}

struct Client {
    scene: PathBuf,
    joined: bool,
    talk: Talk,
    watch: Option<Watch>,
    watched: Watched,
}

impl Client {
    fn run(mut self, heard: &Receiver<Heard>) -> Outcome {
        let sender = self.talk.sender.clone();
        match Watch::new(move |files| drop(sender.send(Heard::Changed(files)))) {
            Ok(watch) => self.watch = Some(watch),
            Err(error) => self.talk.notice(error.to_string())?,
        }
        self.watch()?;
        if !self.join()? {
            self.load()?;
        }
        loop {
            match heard.recv_timeout(LOOK) {
                Ok(Heard::Said(session, said)) if self.talk.is_present(session) => {
                    if self.take(said)? {
                        return Ok(());
                    }
                }
                Ok(Heard::Lost(session, error)) if self.talk.is_present(session) => self.lost(error)?,
                Ok(Heard::Said(..) | Heard::Lost(..) | Heard::Connected(_)) => {}
                Ok(Heard::Changed(files)) => self.changed(&files)?,
                Ok(Heard::TryNow) if !self.talk.is_joined() => drop(self.join()?),
                Ok(Heard::TryNow) => {}
                Err(RecvTimeoutError::Timeout) if !self.talk.is_joined() => drop(self.join()?),
                Err(RecvTimeoutError::Timeout) => {}
                Ok(Heard::Gone) | Err(RecvTimeoutError::Disconnected) => return Err(WindowGone),
            }
        }
    }

    /// Joins the editor, if one answers; returns whether it did.
    fn join(&mut self) -> Outcome<bool> {
        let joined = match handshake::join(&self.scene, Role::Window, self.talk.options.limits.message) {
            Ok(Some((hello, wire))) => self.talk.enter(hello, wire),
            Ok(None) => return Ok(false),
            Err(error) => Err(error),
        };
        if let Err(error) = joined {
            self.talk.failed(error)?;
            return Ok(false);
        }
        self.talk.problems(Vec::new())?;
        self.show()?;
        self.talk.notice("joined the editor")?;
        Ok(true)
    }

    fn show(&mut self) -> Outcome {
        self.watch()?;
        self.talk.show(None)
    }

    /// Does what the editor says; returns whether that was the end.
    fn take(&mut self, said: FromEditor) -> Outcome<bool> {
        let said = said.meaning();
        let patched = match said {
            Meaning::Patch(..) | Meaning::Scene(..) => true,
            Meaning::Link(_) | Meaning::Windows(_) | Meaning::Nothing => false,
        };
        match self.talk.take(said)? {
            Some(OfTheLink::Bye(reason)) if self.joined => {
                self.talk.pass_on(FromEditor::Bye(reason))?;
                return Ok(true);
            }
            Some(OfTheLink::Bye(reason)) => {
                self.talk.leave();
                self.load()?;
                self.talk.notice(format!("{reason}; following the file"))?;
            }
            // These are for a window on another machine.
            Some(OfTheLink::Images(_) | OfTheLink::Piece(..) | OfTheLink::Notice(_) | OfTheLink::Problems(_)) => {}
            None => {}
        }
        if patched {
            self.watch()?;
        }
        Ok(false)
    }

    /// The editor is gone without a goodbye. What it showed last is newer than the file, and stays until the file changes.
    fn lost(&mut self, error: Option<Error>) -> Outcome {
        self.talk.leave();
        let why = error.map(|error| format!(" ({error})")).unwrap_or_default();
        self.talk.warn(format!("the editor is gone; this is its last state{why}"))
    }

    /// A changed scene matters if the file is followed; a changed picture always does.
    fn changed(&mut self, files: &[PathBuf]) -> Outcome {
        let scene = files.contains(&self.scene);
        if scene && !self.talk.is_joined() {
            return self.load();
        }
        if scene && files.len() == 1 {
            return Ok(());
        }
        // A model may have other parts now.
        self.watch()?;
        self.talk.tell(News::Files)
    }

    /// Shows the file. If it cannot be read, the last good scene stays.
    fn load(&mut self) -> Outcome {
        match files::scene::open(&self.scene, &self.talk.options) {
            Ok(document) => {
                let left = files::session::left_behind(&self.scene, &document);
                let count = self.talk.shown.as_ref().map_or(0, |(_, count)| count + 1);
                self.talk.shown = Some((document, count));
                self.talk.problems(Vec::new())?;
                self.show()?;
                self.talk.notice(left.map_or("following the file".to_owned(), |recovery| {
                    format!("following the file; {} left behind, plica edit offers to keep them", recovery.in_words())
                }))
            }
            Err(error) => self.talk.failed(error),
        }
    }

    /// Watches the file and the pictures of what is shown.
    fn watch(&mut self) -> Outcome {
        let Some(watch) = &mut self.watch else { return Ok(()) };
        let mut files = vec![self.scene.clone()];
        if let Some((document, _)) = &self.talk.shown {
            files.extend(self.watched.files(&self.scene, document.scene(), &self.talk.options));
        }
        watch.set(&files).or_else(|error| self.talk.notice(error.to_string()))
    }
}
