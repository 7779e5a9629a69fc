//! A window's half of the link: the copy of the document that patches are applied to, and where replies go. One thread takes
//! everything that happens, in order, over one channel, whatever the connection is.

use std::io::{Read, Write};
use std::path::PathBuf;
use std::sync::mpsc::{self, Receiver, Sender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::news::{News, Sink};
use crate::base::error::{Error, Result};
use crate::base::problem::Problem;
use crate::files::Options;
use crate::preview::keys::TRY_NOW;
use crate::preview::wire::connection::{HangUp, Wire};
use crate::preview::wire::frame;
use crate::preview::wire::message::{FromEditor, Gesture, Meaning, OfTheLink, ToEditor};
use crate::scene::Document;
use crate::scene::edit::Edit;

/// What reaches the thread of a talk.
pub(in crate::preview) enum Heard {
    /// Whoever serves this session says something.
    Said(u64, FromEditor),
    /// The connection of this session ended; the error if it did not end well.
    Lost(u64, Option<Error>),
    /// Files changed on disk.
    Changed(Vec<PathBuf>),
    /// An attempt to connect again ended.
    Connected(Result<(FromEditor, Wire)>),
    /// The person does not want to wait for the next attempt to connect.
    TryNow,
    /// The window is gone.
    Gone,
}

/// The window is gone: there is nothing left to do.
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
    /// Counts connections, so that late messages of an old one are not taken for those of a new one.
    session: u64,
    /// The connection, while there is one.
    hang_up: Option<HangUp>,
    last_notice: String,
    last_problems: Vec<Problem>,
}

impl Talk {
    /// A talk without a connection yet; replies go to the end that serves it later.
    pub fn new(place: String, options: &Options, sink: Sink) -> (Talk, Sender<ToEditor>, Receiver<Heard>) {
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

    /// Whether it is connected.
    pub fn is_joined(&self) -> bool {
        self.hang_up.is_some()
    }

    /// Whether this is the current session.
    pub fn is_present(&self, session: u64) -> bool {
        self.session == session
    }

    /// Tells something.
    pub fn tell(&mut self, news: News) -> Outcome {
        if (self.sink)(news) { Ok(()) } else { Err(WindowGone) }
    }

    /// Tells what the editor says, or what is said in its place.
    pub fn pass_on(&mut self, message: FromEditor) -> Outcome {
        self.tell(News::Said(message))
    }

    /// A line for the person; not repeated if it is the same as before.
    pub fn notice(&mut self, line: impl Into<String>) -> Outcome {
        let line = line.into();
        if line == self.last_notice {
            return Ok(());
        }
        self.last_notice.clone_from(&line);
        self.pass_on(FromEditor::Notice(line))
    }

    /// Progress of something; `None` once it is done.
    pub fn progress(&mut self, line: Option<String>) -> Outcome {
        self.tell(News::Progress(line.unwrap_or_default()))
    }

    /// All that is wrong now; not repeated if it is the same as before.
    pub fn problems(&mut self, problems: Vec<Problem>) -> Outcome {
        if problems == self.last_problems {
            return Ok(());
        }
        self.last_problems.clone_from(&problems);
        self.pass_on(FromEditor::Problems(problems))
    }

    /// An error is all that is wrong now.
    pub fn failed(&mut self, error: Error) -> Outcome {
        let problems = problems(error, &self.place);
        self.problems(problems)
    }

    /// A line for the person that is a warning too: the scene is followed, but not as it should be.
    pub fn warn(&mut self, line: String) -> Outcome {
        self.problems(vec![Problem::warning("", line.clone())])?;
        self.notice(line)
    }

    /// Sends a message to the end that serves it.
    pub fn say(&self, message: &ToEditor) {
        self.outlet.send(message);
    }

    /// Takes over the document of a hello and starts to read from that connection.
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

    /// Tells the present document, the first or a changed one.
    pub fn show(&mut self, edit: Option<Edit>) -> Outcome {
        match self.shown.clone() {
            Some((document, revision)) => self.tell(News::Document { document, revision, edit }),
            None => Ok(()),
        }
    }

    /// Applies what changes the document and passes on what is meant for windows; returns what concerns the link itself.
    pub fn take(&mut self, said: Meaning) -> Outcome<Option<OfTheLink>> {
        match said {
            Meaning::Patch(from, to, patch) => self.patch(from, to, patch)?,
            Meaning::Scene(revision, document) => self.replace(revision, document)?,
            Meaning::Link(said) => return Ok(Some(said)),
            Meaning::Windows(said) => self.pass_on(said)?,
            Meaning::Nothing => {}
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

    /// Ends the connection if there is one; what it still says is dropped.
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

/// Where replies go: to the editor while there is one.
#[derive(Clone, Default)]
struct Outlet(Arc<Mutex<End>>);

#[derive(Default)]
struct End {
    writer: Option<Box<dyn Write + Send>>,
    /// Where the window looks from, which an editor that comes later has to know.
    looks: Option<ToEditor>,
}

impl End {
    /// A connection that cannot be written to is lost for reading too; the reading thread notices that.
    fn write(&mut self, message: &ToEditor) {
        if self.writer.as_mut().is_some_and(|writer| frame::write(writer, message).is_err()) {
            self.writer = None;
        }
    }
}

impl Outlet {
    fn end(&self) -> MutexGuard<'_, End> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn set(&self, writer: Option<Box<dyn Write + Send>>) {
        let mut end = self.end();
        end.writer = writer;
        end.looks.clone().iter().for_each(|looks| end.write(looks));
    }

    fn send(&self, message: &ToEditor) {
        let mut end = self.end();
        if let ToEditor::Gesture(Gesture::Camera(camera)) = message {
            end.looks = camera.is_some().then(|| message.clone());
        }
        end.write(message);
    }

    fn pass_on(&self, replies: &Receiver<ToEditor>, heard: &Sender<Heard>) {
        for message in replies.iter().filter(ToEditor::is_finite) {
            match message {
                // The talk may have ended first, here and below.
                ToEditor::Gesture(Gesture::Command(name)) if name == TRY_NOW => drop(heard.send(Heard::TryNow)),
                message => self.send(&message),
            }
        }
        drop(heard.send(Heard::Gone));
    }
}

/// Passes on what is read, until the other end hangs up or `takes` returns false.
fn listen(mut from: &mut dyn Read, most: u64, takes: impl Fn(FromEditor) -> bool) -> Result<()> {
    while let Some(said) = frame::read(&mut from, most)? {
        if !takes(said) {
            break;
        }
    }
    Ok(())
}

/// What is wrong with the scene that messages call `scene`, one by one.
fn problems(error: Error, scene: &str) -> Vec<Problem> {
    match error {
        Error::Scene { problems, .. } => problems,
        Error::Failed { place, what, cure } => {
            let place = if place == scene { String::new() } else { place };
            let problem = Problem::error(place, what);
            vec![cure.into_iter().fold(problem, Problem::hint)]
        }
        other => vec![Problem::error("", other.to_string())],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::space::camera::Camera;

    #[derive(Clone, Default)]
    struct Sent(Arc<Mutex<Vec<u8>>>);

    impl Write for Sent {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            self.0.lock().unwrap().write(bytes)
        }

        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn an_editor_that_comes_later_hears_where_the_window_looks_from() {
        let outlet = Outlet::default();
        let camera = Gesture::Camera(Some(Camera::default()));
        for (said, told) in [
            (camera.clone(), Some(camera.clone())),
            (Gesture::Pointer { x: 1.0, y: 2.0 }, Some(camera)),
            (Gesture::Camera(None), None),
        ] {
            outlet.send(&said.clone().into());
            let sent = Sent::default();
            outlet.set(Some(Box::new(sent.clone())));
            let bytes = sent.0.lock().unwrap().clone();
            let heard = frame::read::<ToEditor>(&mut bytes.as_slice(), 1 << 20).unwrap();
            assert_eq!(heard, told.map(ToEditor::Gesture), "{said:?}");
            outlet.set(None);
        }
    }
}
