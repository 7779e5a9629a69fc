//! A window's half of the talk with whoever serves it: the copy of the document that patches are applied to, and where
//! replies go. What happens is heard by one thread, in order, over one channel, whatever the wire is.

use std::io::{Read, Write};
use std::path::PathBuf;
use std::sync::mpsc::{self, Receiver, Sender};
use std::sync::{Arc, Mutex, PoisonError};

use crate::base::error::{Error, Result};
use crate::base::problem::Problem;
use crate::files::Options;
use crate::preview::views::Views;
use crate::preview::wire::connection::{HangUp, Wire};
use crate::preview::wire::frame;
use crate::preview::wire::message::{FromEditor, ToEditor};
use crate::preview::{Reply, Update};
use crate::scene::Document;
use crate::scene::edit::Edit;

/// What is told of a scene that is followed.
pub(in crate::preview) enum News {
    /// The document of this revision.
    Document {
        /// The document.
        document: Document,
        /// As in [`Update::Scene`].
        revision: u64,
        /// What made it of the one before, where that is known.
        edit: Option<Edit>,
    },
    /// Files that the document names changed.
    Files,
    /// The overlay and zoom commands in force at the other end.
    Views(Vec<String>),
    /// Anything else; never a scene.
    Update(Update),
}

/// Takes news; tells whether anybody is still there to hear them.
pub(in crate::preview) type Sink = Box<dyn FnMut(News) -> bool + Send>;

/// What the thread of a talk hears.
pub(in crate::preview) enum Heard {
    /// Whoever serves this session says something.
    Said(u64, FromEditor),
    /// The connection of this session ended; the reason where it was a fault.
    Lost(u64, Option<Error>),
    /// Files changed on disk.
    Changed(Vec<PathBuf>),
    /// An attempt to connect again ended.
    Connected(Result<(FromEditor, Wire)>),
    /// The window is gone.
    Gone,
}

/// The window is gone: nothing is left to do.
pub(in crate::preview) struct WindowGone;

/// How a step of the talk ends.
pub(in crate::preview) type Outcome<T = ()> = std::result::Result<T, WindowGone>;

/// See the top of the file.
pub(in crate::preview) struct Talk {
    /// What messages call the scene.
    pub place: String,
    /// What a scene may take.
    pub options: Options,
    /// What is shown: the document of this revision, or what was read from the file at this count.
    pub shown: Option<(Document, u64)>,
    /// For threads that have something to tell.
    pub sender: Sender<Heard>,
    sink: Sink,
    outlet: Outlet,
    /// Counts connections, so that the last words of an old one are told from a new one's.
    session: u64,
    /// The connection, while there is one.
    hang_up: Option<HangUp>,
    last_notice: String,
    last_problems: Vec<Problem>,
}

impl Talk {
    /// A talk with nobody yet; replies go to whoever serves it then.
    pub fn new(place: String, options: &Options, sink: Sink) -> (Talk, Sender<Reply>, Receiver<Heard>) {
        let (sender, heard) = mpsc::channel();
        let (replies, said) = mpsc::channel();
        let talk = Talk {
            place,
            options: options.clone(),
            shown: None,
            sender: sender.clone(),
            sink,
            outlet: Outlet::default(),
            session: 0,
            hang_up: None,
            last_notice: String::new(),
            last_problems: Vec::new(),
        };
        let outlet = talk.outlet.clone();
        std::thread::spawn(move || outlet.pass_on(&said, &sender));
        (talk, replies, heard)
    }

    /// Whether somebody serves it.
    pub fn is_joined(&self) -> bool {
        self.hang_up.is_some()
    }

    /// Whether this session is the present one.
    pub fn is_present(&self, session: u64) -> bool {
        self.session == session
    }

    /// Tells something.
    pub fn tell(&mut self, news: News) -> Outcome {
        if (self.sink)(news) { Ok(()) } else { Err(WindowGone) }
    }

    /// Tells an update.
    pub fn update(&mut self, update: Update) -> Outcome {
        self.tell(News::Update(update))
    }

    /// A line for the person; the same one is not said again and again.
    pub fn notice(&mut self, line: impl Into<String>) -> Outcome {
        let line = line.into();
        if line == self.last_notice {
            return Ok(());
        }
        self.last_notice.clone_from(&line);
        self.update(Update::Notice(line))
    }

    /// How far something is; nothing once it is done.
    pub fn progress(&mut self, line: Option<String>) -> Outcome {
        self.update(Update::Progress(line.unwrap_or_default()))
    }

    /// All that is wrong now; the same is not said again.
    pub fn problems(&mut self, problems: Vec<Problem>) -> Outcome {
        if problems == self.last_problems {
            return Ok(());
        }
        self.last_problems.clone_from(&problems);
        self.update(Update::Problems(problems))
    }

    /// What went wrong is all that is wrong now.
    pub fn failed(&mut self, error: Error) -> Outcome {
        let problems = crate::preview::problems(error, &self.place);
        self.problems(problems)
    }

    /// A line for the person that is a warning too: how the scene is followed, and that this is not how it should be.
    pub fn warn(&mut self, line: String) -> Outcome {
        self.problems(vec![Problem::warning("", line.clone())])?;
        self.notice(line)
    }

    /// Says something to whoever serves it.
    pub fn say(&self, message: &ToEditor) {
        self.outlet.send(message);
    }

    /// Takes over the document of a hello and starts to listen to who said it.
    pub fn enter(&mut self, hello: FromEditor, wire: Wire) -> Result<()> {
        let FromEditor::Hello { revision, document, .. } = hello else {
            return Err(Error::at("link", "the editor did not say hello"));
        };
        let document = self.document(document)?;
        let Wire { mut reader, writer, hang_up } = wire;
        self.session += 1;
        let (session, sender, most) = (self.session, self.sender.clone(), self.options.limits.message);
        std::thread::spawn(move || {
            let lost = listen(&mut *reader, most, |said| sender.send(Heard::Said(session, said)).is_ok()).err();
            drop(sender.send(Heard::Lost(session, lost)));
        });
        self.outlet.set(Some(writer));
        self.hang_up = Some(hang_up);
        self.shown = Some((document, revision));
        Ok(())
    }

    /// Shows another document, or the first.
    pub fn show(&mut self, edit: Option<Edit>) -> Outcome {
        match self.shown.clone() {
            Some((document, revision)) => self.tell(News::Document { document, revision, edit }),
            None => Ok(()),
        }
    }

    /// Does what is said, as far as it is the same for every window; returns the rest.
    pub fn take(&mut self, said: FromEditor) -> Outcome<Option<FromEditor>> {
        match said {
            FromEditor::Patch { from_revision, to_revision, patch } => self.patch(from_revision, to_revision, patch)?,
            FromEditor::Scene { revision, document } => self.replace(revision, document)?,
            FromEditor::Selection(pointer) => self.update(Update::Selection(pointer))?,
            FromEditor::Transport(transport) => self.update(Update::Transport(transport))?,
            FromEditor::View(name) => self.update(Update::View(name))?,
            FromEditor::Views(names) => self.tell(News::Views(names))?,
            other => return Ok(Some(other)),
        }
        Ok(None)
    }

    fn patch(&mut self, from: u64, to: u64, patch: Edit) -> Outcome {
        let old = self.shown.as_ref().filter(|(_, revision)| *revision == from);
        match old.and_then(|(document, _)| document.apply(&patch).ok()) {
            Some(document) => {
                self.shown = Some((document, to));
                self.show(Some(patch))
            }
            None => {
                self.say(&ToEditor::WantScene);
                Ok(())
            }
        }
    }

    fn replace(&mut self, revision: u64, document: serde_json::Value) -> Outcome {
        match self.document(document) {
            Ok(document) => {
                self.shown = Some((document, revision));
                self.show(None)
            }
            Err(error) => self.failed(error),
        }
    }

    fn document(&self, json: serde_json::Value) -> Result<Document> {
        let file = self.place.clone();
        Document::from_json_under(json, self.options.rules()).map_err(|problems| Error::Scene { file, problems })
    }

    /// Ends the connection where there is one; its last words are not heard.
    pub fn leave(&mut self) {
        self.session += 1;
        self.outlet.set(None);
        if let Some(hang_up) = self.hang_up.take() {
            hang_up.now();
        }
    }
}

impl Drop for Talk {
    fn drop(&mut self) {
        self.leave();
    }
}

/// Tells a window: what comes back after a lost link is not switched over.
pub(in crate::preview) fn window_sink(updates: Sender<Update>) -> Sink {
    let mut views = Views::default();
    let mut shown = None;
    Box::new(move |news| {
        let send = |update| updates.send(update).is_ok();
        match news {
            News::Document { document, revision, .. } => {
                let scene = document.scene().clone();
                shown = Some((scene.clone(), revision));
                send(Update::Scene { scene, revision })
            }
            News::Files => shown.clone().is_none_or(|(scene, revision)| send(Update::Scene { scene, revision })),
            News::Views(list) => views.catch_up(&list).into_iter().all(|name| send(Update::View(name))),
            News::Update(update) => match update {
                Update::View(name) => send(Update::View(views.take(&name))),
                other => send(other),
            },
        }
    })
}

/// Where replies go: to the editor while there is one.
#[derive(Clone, Default)]
struct Outlet(Arc<Mutex<Option<Box<dyn Write + Send>>>>);

impl Outlet {
    fn set(&self, writer: Option<Box<dyn Write + Send>>) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = writer;
    }

    /// A connection that cannot be written to is lost for reading too, where that is noticed.
    fn send(&self, message: &ToEditor) {
        let mut writer = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if writer.as_mut().is_some_and(|writer| frame::write(writer, message).is_err()) {
            *writer = None;
        }
    }

    fn pass_on(&self, replies: &Receiver<Reply>, heard: &Sender<Heard>) {
        replies.iter().filter_map(to_editor).for_each(|message| self.send(&message));
        // The talk may have ended first.
        drop(heard.send(Heard::Gone));
    }
}

/// Hands on what is said, until the other end hangs up or nobody `takes` it any more.
fn listen(mut from: &mut dyn Read, most: u64, takes: impl Fn(FromEditor) -> bool) -> Result<()> {
    while let Some(said) = frame::read(&mut from, most)? {
        if !takes(said) {
            break;
        }
    }
    Ok(())
}

/// A reply as it goes over the wire; nothing where it holds no number that JSON can write.
fn to_editor(reply: Reply) -> Option<ToEditor> {
    match reply {
        Reply::Shown { revision, synth_ms } if synth_ms.is_finite() => Some(ToEditor::Ack { revision, synth_ms }),
        Reply::Shown { revision, .. } => Some(ToEditor::Ack { revision, synth_ms: 0.0 }),
        Reply::Report { fps, adapter, notice } if fps.is_finite() => Some(ToEditor::Report { fps, adapter, notice }),
        Reply::Pointer { x, y } if x.is_finite() && y.is_finite() => Some(ToEditor::Pointer { x, y }),
        Reply::Transport(t) if t.time.is_finite() && t.speed.is_finite() => Some(ToEditor::Transport(t)),
        Reply::Report { .. } | Reply::Pointer { .. } | Reply::Transport(_) => None,
        Reply::Command(name) => Some(ToEditor::Command(name)),
    }
}
