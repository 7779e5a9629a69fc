//! The window's side of the link: joins the editor that has the scene open, else follows the file, and goes from one to the
//! other by itself with a word about it. All that happens is heard by one thread, in order, over one channel.

use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use super::link::{self, HangUp, Wire};
use super::message::{self, FromEditor, Role, ToEditor};
use super::{Reply, Update};
use crate::base::error::{Error, Result};
use crate::files::watch::Watch;
use crate::files::{self, Options, materials};
use crate::scene::Document;
use crate::scene::edit::Edit;

/// How often an editor is looked for while there is none.
const LOOK: Duration = Duration::from_millis(250);

/// Both ends of the talk with a window.
pub struct Link {
    /// What the window shows. The first is the scene, or a notice why there is none yet.
    pub updates: Receiver<Update>,
    /// What the window has to say. Dropping it, or `updates`, ends the link.
    pub replies: Sender<Reply>,
}

/// Follows a scene in its editor or its file. `joined`: the window was opened by the editor, and is to close with it.
///
/// A picture that changes on disk sends the scene again; who loads it through a cache reads only that picture anew.
pub fn follow(scene: &Path, options: &Options, joined: bool) -> Link {
    let (updates, receiver) = mpsc::channel();
    let (replies, said) = mpsc::channel();
    let (sender, heard) = mpsc::channel();
    let outlet = Outlet::default();
    let client = Client {
        scene: scene.to_owned(),
        options: options.clone(),
        joined,
        updates,
        sender: sender.clone(),
        outlet: outlet.clone(),
        session: 0,
        editor: None,
        shown: None,
        last_notice: String::new(),
        watch: None,
    };
    std::thread::spawn(move || outlet.pass_on(&said, &sender));
    std::thread::spawn(move || drop(client.run(&heard)));
    Link { updates: receiver, replies }
}

/// What the client's thread hears.
enum Heard {
    /// The editor of this session says something.
    Said(u64, FromEditor),
    /// The connection of this session ended; the reason where it was a fault.
    Lost(u64, Option<Error>),
    /// The scene's file or pictures changed on disk.
    Changed(Vec<PathBuf>),
    /// The window is gone.
    Gone,
}

/// The window is gone: nothing is left to do.
struct WindowGone;

type Outcome<T = ()> = std::result::Result<T, WindowGone>;

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
        if writer.as_mut().is_some_and(|writer| message::write(writer, message).is_err()) {
            *writer = None;
        }
    }

    fn pass_on(&self, replies: &Receiver<Reply>, heard: &Sender<Heard>) {
        replies.iter().filter_map(to_editor).for_each(|message| self.send(&message));
        // The client may have ended first.
        drop(heard.send(Heard::Gone));
    }
}

/// Hands on what the editor says, until it hangs up or nobody `takes` it any more.
fn listen(mut from: &mut dyn Read, most: u64, takes: impl Fn(FromEditor) -> bool) -> Result<()> {
    while let Some(said) = message::read(&mut from, most)? {
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
        Reply::Report { .. } | Reply::Pointer { .. } => None,
        Reply::Command(name) => Some(ToEditor::Command(name)),
    }
}

struct Client {
    scene: PathBuf,
    options: Options,
    joined: bool,
    updates: Sender<Update>,
    sender: Sender<Heard>,
    outlet: Outlet,
    /// Counts connections, so that the last words of an old one are told from a new one's.
    session: u64,
    /// The connection, while there is one.
    editor: Option<HangUp>,
    /// What the window shows: the editor's document of this revision, or what was read from the file at this count.
    shown: Option<(Document, u64)>,
    last_notice: String,
    watch: Option<Watch>,
}

impl Client {
    fn run(mut self, heard: &Receiver<Heard>) -> Outcome {
        let sender = self.sender.clone();
        match Watch::new(move |files| drop(sender.send(Heard::Changed(files)))) {
            Ok(watch) => self.watch = Some(watch),
            Err(error) => self.notice(error.to_string())?,
        }
        self.watch()?;
        if !self.join()? {
            self.load()?;
        }
        loop {
            match heard.recv_timeout(LOOK) {
                Ok(Heard::Said(session, said)) if session == self.session => {
                    if self.take(said)? {
                        return Ok(());
                    }
                }
                Ok(Heard::Lost(session, error)) if session == self.session => self.lost(error)?,
                Ok(Heard::Said(..) | Heard::Lost(..)) => {}
                Ok(Heard::Changed(files)) => self.changed(&files)?,
                Err(RecvTimeoutError::Timeout) if self.editor.is_none() => drop(self.join()?),
                Err(RecvTimeoutError::Timeout) => {}
                Ok(Heard::Gone) | Err(RecvTimeoutError::Disconnected) => return Err(WindowGone),
            }
        }
    }

    fn update(&self, update: Update) -> Outcome {
        self.updates.send(update).map_err(|_| WindowGone)
    }

    /// A line for the person; the same one is not said again and again.
    fn notice(&mut self, line: impl Into<String>) -> Outcome {
        let line = line.into();
        if line == self.last_notice {
            return Ok(());
        }
        self.last_notice.clone_from(&line);
        self.update(Update::Notice(line))
    }

    /// Joins the editor where one answers.
    fn join(&mut self) -> Outcome<bool> {
        let joined = match link::join(&self.scene, Role::Window, self.options.limits.message) {
            Ok(Some((hello, wire))) => self.enter(hello, wire),
            Ok(None) => return Ok(false),
            Err(error) => Err(error),
        };
        if let Err(error) = joined {
            self.notice(error.to_string())?;
            return Ok(false);
        }
        self.show()?;
        self.notice("joined the editor")?;
        Ok(true)
    }

    /// Takes over the editor's document and starts to listen to it.
    fn enter(&mut self, hello: FromEditor, wire: Wire) -> Result<()> {
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
        self.editor = Some(hang_up);
        self.shown = Some((document, revision));
        Ok(())
    }

    fn document(&self, json: serde_json::Value) -> Result<Document> {
        let file = self.scene.display().to_string();
        Document::from_json_under(json, self.options.rules()).map_err(|problems| Error::Scene { file, problems })
    }

    /// Shows a document, or the same one again.
    fn show(&mut self) -> Outcome {
        self.watch()?;
        match &self.shown {
            Some((document, revision)) => {
                self.update(Update::Scene { scene: document.scene().clone(), revision: *revision })
            }
            None => Ok(()),
        }
    }

    /// Does what the editor says; tells whether that was the end.
    fn take(&mut self, said: FromEditor) -> Outcome<bool> {
        match said {
            FromEditor::Patch { from_revision, to_revision, patch } => {
                self.patch(from_revision, to_revision, &patch)?
            }
            FromEditor::Scene { revision, document } => self.replace(revision, document)?,
            FromEditor::Selection(pointer) => self.update(Update::Selection(pointer))?,
            FromEditor::Transport { playing, time } => self.update(Update::Transport { playing, time })?,
            FromEditor::View(name) => self.update(Update::View(name))?,
            FromEditor::Bye(_) if self.joined => {
                self.update(Update::Closed)?;
                return Ok(true);
            }
            FromEditor::Bye(reason) => {
                self.leave();
                self.load()?;
                self.notice(format!("{reason}; following the file"))?;
            }
            FromEditor::Hello { .. } | FromEditor::Edited(_) => {}
        }
        Ok(false)
    }

    fn patch(&mut self, from: u64, to: u64, patch: &Edit) -> Outcome {
        let old = self.shown.as_ref().filter(|(_, revision)| *revision == from);
        match old.and_then(|(document, _)| document.apply(patch).ok()) {
            Some(document) => {
                self.shown = Some((document, to));
                self.show()
            }
            None => {
                self.outlet.send(&ToEditor::WantScene);
                Ok(())
            }
        }
    }

    fn replace(&mut self, revision: u64, document: serde_json::Value) -> Outcome {
        match self.document(document) {
            Ok(document) => {
                self.shown = Some((document, revision));
                self.show()
            }
            Err(error) => self.notice(error.to_string()),
        }
    }

    /// The editor is gone without a word. What it showed last is newer than the file, and stays until the file changes.
    fn lost(&mut self, error: Option<Error>) -> Outcome {
        self.leave();
        let why = error.map(|error| format!(" ({error})")).unwrap_or_default();
        self.notice(format!("the editor is gone; this is its last state{why}"))
    }

    fn leave(&mut self) {
        self.outlet.set(None);
        if let Some(hang_up) = self.editor.take() {
            hang_up.now();
        }
    }

    /// A changed scene counts where the file is followed; a changed picture always.
    fn changed(&mut self, files: &[PathBuf]) -> Outcome {
        let scene = files.contains(&self.scene);
        if scene && self.editor.is_none() {
            return self.load();
        }
        if scene && files.len() == 1 { Ok(()) } else { self.show() }
    }

    /// Shows the file. Where it cannot be read the last good scene stays.
    fn load(&mut self) -> Outcome {
        match files::scene::open(&self.scene, &self.options) {
            Ok(document) => {
                let count = self.shown.as_ref().map_or(0, |(_, count)| count + 1);
                self.shown = Some((document, count));
                self.show()?;
                self.notice("following the file")
            }
            Err(error) => self.notice(error.to_string()),
        }
    }

    /// Watches the file and the pictures of what is shown.
    fn watch(&mut self) -> Outcome {
        let Some(watch) = &mut self.watch else { return Ok(()) };
        let mut files = vec![self.scene.clone()];
        if let Some((document, _)) = &self.shown {
            files.extend(materials::files(&self.scene, document.scene()));
        }
        watch.set(&files).or_else(|error| self.notice(error.to_string()))
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        self.leave();
    }
}
