//! The editor's hold on its windows. Every window has a thread that writes and one that reads; the editor only changes the
//! state between them, under a lock that nobody holds while writing, so it never waits for a window.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::time::Duration;

use super::display::no_window;
use super::events::Event;
use super::host::{Shared, thread};
use super::keeper::{Keeper, Life};
use super::outbox::{Latest, Measured};
use super::status::Status;
use crate::base::error::Result;
use crate::files::Options;
use crate::layers::space::camera::Camera;
use crate::preview::wire::message::FromEditor;
use crate::preview::wire::socket::{Door, Listener};
use crate::scene::Document;
use crate::scene::edit::Edit;

/// How long the editor waits at its end for windows to leave.
const FAREWELL: Duration = Duration::from_millis(300);
/// How long a question waits for the windows: a drawing that the CPU does for a GPU takes a second or two.
const ANSWER: Duration = Duration::from_secs(4);
/// How long a window that lost an earlier editor has to come back before a new one is opened.
const ORPHANS: Duration = Duration::from_secs(1);

/// The editor's hold on its windows. Dropping it says goodbye to them and ends the one it started.
pub struct Preview {
    shared: Arc<Shared>,
    scene: PathBuf,
    options: Options,
    keeper: Option<Keeper>,
    /// `None` if no window can join.
    door: Option<Door>,
    /// How often windows were told where to look from.
    looked: u64,
}

impl Preview {
    /// Starts to listen for windows of `scene`. If that fails, the editor goes on without windows and the status says why.
    pub fn start(
        scene: &Path,
        document: &Document,
        revision: u64,
        deliver: impl Fn(Event) + Send + Sync + 'static,
    ) -> Preview {
        let shared = Arc::new(Shared::new(Latest::new(document.clone(), revision), Box::new(deliver)));
        let scene = std::path::absolute(scene).unwrap_or_else(|_| scene.to_owned());
        let mut preview = Preview { shared, scene, options: Options::default(), keeper: None, door: None, looked: 0 };
        if let Err(error) = preview.listen() {
            preview.shared.lock().refused = Some(error.to_string());
        }
        preview
    }

    /// Windows that are opened from here may do what the editor may.
    pub fn with_options(mut self, options: &Options) -> Preview {
        self.options.clone_from(options);
        self
    }

    fn listen(&mut self) -> Result<()> {
        let (listener, door) = Listener::open(&self.scene)?;
        let (shared, scene) = (self.shared.clone(), self.scene.clone());
        thread("link", move || shared.take_connections(&listener, &scene))?;
        self.door = Some(door);
        Ok(())
    }

    /// The document changed by `edit` into `document`, of `revision`. Returns at once, whatever the windows do.
    pub fn publish(&self, document: &Document, revision: u64, edit: &Edit) {
        let edit = Measured::new(edit);
        self.shared.change(|state| {
            (state.latest.document, state.latest.revision) = (document.clone(), revision);
            state.peers.values_mut().for_each(|peer| peer.outbox.edited(&edit));
        });
    }

    /// Tells the windows how something is now, those that join later too: of each kind of message only the latest counts.
    /// What they know already is not said again.
    pub fn say(&self, message: FromEditor) {
        self.shared.say(message);
    }

    /// Windows look from there, or by the scene's camera again.
    pub fn look(&mut self, camera: Option<Camera>) {
        self.looked += 1;
        self.say(FromEditor::Look { camera, nth: self.looked });
    }

    /// Asks the windows for what they have not told yet; [`Event::Answered`] comes when they have, or after a while.
    pub fn ask(&self) {
        let (shared, nth) = (self.shared.clone(), self.shared.asks());
        // Without a thread nobody waits.
        if thread("link answers", move || shared.answers(nth, ANSWER)).is_err() {
            self.shared.answers(nth, Duration::ZERO);
        }
    }

    /// The animation has run on to `time` (scene time, in seconds) by itself, as it does in the windows: those that join
    /// later begin there.
    pub fn passing(&self, time: f64) {
        self.shared.lock().latest.passing(time);
    }

    /// An overlay or zoom command for the windows, by name.
    pub fn view(&self, command: &str) {
        self.shared.view(command);
    }

    /// How the windows are doing.
    pub fn status(&self) -> Status {
        self.shared.lock().status()
    }

    /// Says goodbye to the windows and ends the one it started. From here on the scene is free for another editor.
    pub fn close(&mut self) {
        self.shared.change(|state| state.closing = true);
        self.door = None;
        let state = self.shared.wait(FAREWELL, |state| state.peers.is_empty());
        state.peers.values().for_each(|peer| peer.hang_up.now());
        drop(state);
        if let Some(keeper) = self.keeper.take() {
            keeper.wait_for_end(FAREWELL);
        }
    }

    /// Whether a window was opened from here and is still wanted.
    pub fn has_window(&self) -> bool {
        self.shared.lock().life == Some(Life::Running)
    }

    /// Opens a window and keeps it open; does nothing if this editor has opened one already.
    pub fn open_window(&mut self) {
        if let Some(reason) = no_window(&self.scene) {
            return self.shared.tell(|state| state.refused = Some(reason));
        }
        let (scene, options) = (self.scene.clone(), self.options.clone());
        self.keep(move || window_command(&scene, &options));
    }

    /// Keeps a process alive that joins as a window.
    fn keep(&mut self, command: impl Fn() -> Command + Send + 'static) {
        let Some(door) = self.door.as_mut().filter(|_| self.shared.lock().life != Some(Life::Running)) else { return };
        let orphans = std::mem::take(&mut door.orphans);
        self.keeper = None;
        let (shared, waiting) = (self.shared.clone(), self.shared.clone());
        let wanted = move || !orphans || !waiting.a_window_comes(ORPHANS);
        let tell = move |life| shared.tell(|state| state.life = life);
        match Keeper::start(wanted, command, tell) {
            Ok(keeper) => self.keeper = Some(keeper),
            Err(error) => self.shared.tell(|state| state.life = Some(Life::GivenUp(error.to_string()))),
        }
    }
}

impl Drop for Preview {
    fn drop(&mut self) {
        self.close();
    }
}

/// The window's process, in a group of its own: what the terminal does to the editor's group is not meant for it.
fn window_command(scene: &Path, options: &Options) -> Command {
    use std::os::unix::process::CommandExt;
    let program = std::env::current_exe().unwrap_or_else(|_| "plica".into());
    let mut command = Command::new(program);
    command.arg("view").arg("--joined").args(options.arguments()).arg("--").arg(scene).process_group(0);
    command
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::{Receiver, channel};

    use super::*;
    use crate::preview::follow::{Update, client};

    const PATIENCE: Duration = Duration::from_secs(60);

    struct Stage {
        folder: tempfile::TempDir,
        preview: Preview,
        events: Receiver<Event>,
    }

    fn stage() -> Stage {
        let folder = tempfile::tempdir().unwrap();
        let (sender, events) = channel();
        let document = Document::parse(r#"{"plica": 1}"#).unwrap();
        let scene = folder.path().join("s.plica.json");
        let preview = Preview::start(&scene, &document, 0, move |event| drop(sender.send(event)));
        Stage { folder, preview, events }
    }

    impl Stage {
        /// Keeps [`window_process`] alive: it joins, and dies while the file named by `dies` can be removed.
        fn keep_window(&mut self) {
            let scene = self.preview.scene.clone();
            self.preview.keep(move || {
                let mut command = Command::new(std::env::current_exe().unwrap());
                command.args(["--exact", "preview::editor::preview::tests::window_process", "--nocapture"]);
                command.env("PLICA_TEST_SCENE", &scene);
                command
            });
        }

        fn dies(&self, times: usize) {
            (1..=times).for_each(|time| std::fs::write(self.folder.path().join(time.to_string()), "").unwrap());
        }

        /// The states that the status goes through until `last`, each once.
        fn until(&self, last: impl Fn(&Status) -> bool) -> Vec<String> {
            let mut seen: Vec<String> = Vec::new();
            loop {
                let status = self.preview.status();
                if seen.last() != Some(&status.to_string()) {
                    seen.push(status.to_string());
                }
                if last(&status) {
                    return seen;
                }
                self.events.recv_timeout(PATIENCE).expect("an event");
            }
        }
    }

    fn connected(status: &Status) -> bool {
        matches!(status, Status::Connected { windows: 1, .. })
    }

    /// Plays the window; does nothing when run as a test.
    #[test]
    fn window_process() {
        let Some(scene) = std::env::var_os("PLICA_TEST_SCENE").map(PathBuf::from) else { return };
        let link = client::follow(&scene, &Options::default(), true);
        let update = link
            .updates
            .iter()
            .find(|update| matches!(update, Update::Scene { .. } | Update::Said(FromEditor::Bye(_))));
        assert!(matches!(update, Some(Update::Scene { .. })));
        if (1..9).any(|time| std::fs::remove_file(scene.with_file_name(time.to_string())).is_ok()) {
            eprintln!("plica: no adapter\u{7}");
            std::process::exit(1);
        }
        assert!(link.updates.iter().any(|update| matches!(update, Update::Said(FromEditor::Bye(_)))));
    }

    #[test]
    fn a_question_after_another_is_the_one_that_is_answered() {
        let Stage { preview, events, .. } = stage();
        let [first, second] = [(); 2].map(|()| preview.shared.asks());
        [first, second].iter().for_each(|nth| preview.shared.answers(*nth, Duration::ZERO));
        drop(preview);
        let answered = events.iter().filter(|event| matches!(event, Event::Answered { .. })).count();
        assert_eq!(answered, 1);
    }

    #[test]
    fn a_window_that_dies_comes_back() {
        let mut stage = stage();
        stage.dies(2);
        stage.keep_window();
        while stage.folder.path().join("2").exists() {
            stage.events.recv_timeout(PATIENCE).expect("an event");
        }
        stage.until(connected);
        let Stage { preview, events, .. } = stage;
        drop(preview);
        assert!(events.iter().all(|event| matches!(event, Event::Status | Event::Said(_))), "and ends with its editor");
    }

    #[test]
    fn three_deaths_turn_it_off_with_one_line() {
        let mut stage = stage();
        stage.dies(3);
        stage.keep_window();
        let seen = stage.until(|status| matches!(status, Status::OffBecause(_)));
        assert_eq!(seen.last().unwrap(), "off: no adapter");
        stage.keep_window();
        stage.until(connected);
    }

    #[test]
    fn a_window_that_lost_its_editor_is_not_doubled() {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("s.plica.json");
        // What a killed editor leaves behind: its socket and its window.
        let (listener, door) = Listener::open(&scene).unwrap();
        std::mem::forget(door);
        drop(listener);
        let document = Document::parse(r#"{"plica": 1}"#).unwrap();
        let (sender, events) = channel();
        let mut preview = Preview::start(&scene, &document, 0, move |event| drop(sender.send(event)));
        assert!(preview.door.as_ref().unwrap().orphans);
        let _orphan = client::follow(&scene, &Options::default(), true);
        drop(preview.shared.wait(PATIENCE, |state| !state.peers.is_empty()));
        preview.keep(|| Command::new("a second window"));
        // One for the keeper's start, one for its end.
        for _ in 0..2 {
            events.recv_timeout(PATIENCE).expect("an event");
        }
        drop(preview.shared.wait(PATIENCE, |state| state.life != Some(Life::Running)));
        assert_eq!(preview.shared.lock().life, None);
        assert!(connected(&preview.status()));
    }
}
