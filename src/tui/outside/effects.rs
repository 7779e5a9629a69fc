//! Performs the effects that `update` asks for: on files, threads, the window and the terminal.

use crate::tui::commands::own_keys;
use std::path::Path;

use super::editor::{Editor, listen};
use super::job::Job;
use super::options::Options;
use super::{image_editor, paint, pipe, terminal};
use crate::base::system::folders;
use crate::base::system::signals::{self, Signal};
use crate::files::session::Mode;
use crate::files::{clips, lines, paths, picture, write};
use crate::ops;
use crate::preview::views;
use crate::preview::wire::message::FromEditor;
use crate::scene::Document;
use crate::tui::document::open_scene::OpenScene;
use crate::tui::events::{Effect, Event};
use crate::tui::graphics::request::Request;
use crate::tui::keys::Keymap;
use crate::tui::layout::picture::request;
use crate::tui::state::{State, painting};
use crate::tui::text::said;

impl Editor {
    /// Performs an effect.
    pub fn perform(&mut self, effect: Effect) {
        match effect {
            Effect::Publish(change) => {
                self.preview.publish(&change.document, change.revision, &change.edit);
                self.watch_files();
            }
            Effect::Show => {
                self.preview.say(FromEditor::Selection(Some(painting::selection(&self.state))));
                self.preview.say(FromEditor::Transport(self.state.transport()));
            }
            Effect::Pass => self.preview.passing(self.state.transport().time),
            Effect::Reload => {
                // A model may have other parts now.
                self.watch_files();
                self.worker.ask(Request { fresh: true, ..request(&self.state) });
            }
            Effect::Save { to, overwrite, leave } => self.save(to.as_deref(), overwrite, leave),
            Effect::Write(path, text) => self.write(&path, &text),
            Effect::Source(path) => {
                self.source(&path).unwrap_or_else(|error| self.state.complain(error.to_string()));
            }
            Effect::Keymap => self.load_keys(),
            Effect::Open(path) => drop(self.open(&path, self.options.mode())),
            Effect::TakeOver => {
                let path = self.state.scene.path().to_owned();
                self.open(&path, Mode::TakeOver);
            }
            Effect::Tutor => self.learn(),
            Effect::Run(words) => self.start(&words, false),
            Effect::RunSeen(words) => self.start(&words, true),
            Effect::Compare => self.preview.view(&views::show_compared(self.state.apart.compared.as_deref())),
            Effect::Sight => self.preview.view(&views::show_sight(self.state.picture.told.as_ref())),
            Effect::Mute => self.preview.view(&views::show_muted(&self.state.apart.hidden(self.state.document()))),
            Effect::Probe(words) if self.screen.is_none() => self.start(&words, false),
            Effect::Probe(_) => {}
            Effect::Draw(asked) => self.job = Some(paint::start(*asked, self.sender.clone())),
            Effect::Pipe(program, table) => {
                let most = self.options.files.limits.paste;
                self.job = Some(pipe::start(program, table, most, self.sender.clone()));
            }
            Effect::Complete { name, path, beside } => self.complete(&name, &path, beside.as_deref()),
            Effect::Copy(text) => match &mut self.screen {
                Some(screen) => terminal::copy(screen, &text),
                // Without a screen there is no clipboard.
                None => text.lines().for_each(terminal::print),
            },
            Effect::Cancel => self.job.iter().for_each(Job::cancel),
            Effect::EditImage { path, after } => self.edit_image(&path, after),
            Effect::View(None) => self.open_window(),
            Effect::View(Some(command)) => self.preview.view(&command),
            Effect::Look(camera) => self.preview.look(camera.map(|camera| *camera)),
            Effect::Ask => self.preview.ask(),
            Effect::Redraw => self.screen.iter_mut().for_each(|screen| drop(terminal::forget(screen))),
            Effect::Suspend => self.suspend(),
            Effect::Return if std::mem::take(&mut self.returned) => {}
            Effect::Return => self.set_up(),
            Effect::Quit => self.leaving = true,
        }
    }

    /// Opens the window. If there is none, it says why each time that it is asked for.
    fn open_window(&mut self) {
        self.window_told.clear();
        self.preview.open_window();
    }

    /// Completes the path of the command `name`, from the folder `beside`.
    fn complete(&mut self, name: &str, path: &str, beside: Option<&Path>) {
        let folder = beside.unwrap_or(Path::new("."));
        // One line for a clip, before its many files.
        let clips = if name == "add" { clips::complete(folder, path) } else { Vec::new() };
        let found = clips.into_iter().chain(paths::complete(folder, path));
        self.take(Event::Completed(found.map(|path| format!("{name} {}", said::one_word(&path))).collect()));
    }

    /// Saves the scene, to another file if one is given, and then leaves if asked to.
    fn save(&mut self, to: Option<&Path>, overwrite: bool, leave: bool) {
        let result = self.state.scene.save(to, overwrite);
        self.leaving = leave && result.is_ok();
        if self.leaving {
            // The copy has the edits, and the scene's own file stays as it is.
            self.state.scene.give_up();
        }
        self.take(Event::Saved(result.map_err(|error| error.to_string())));
    }

    /// Writes a text to a new file.
    fn write(&mut self, path: &Path, text: &str) {
        let written = write::write_new(path, text.as_bytes()).map(|()| format!("{} is written", path.display()));
        self.take(Event::Saved(written.map_err(|error| error.to_string())));
    }

    /// Opens a picture in another program. Only if it is a picture: a desktop may run other files instead of opening them.
    /// Opens a picture in another program, and tells how that went behind what was done before.
    fn edit_image(&mut self, path: &Path, after: Option<String>) {
        let read = picture::size(path, &self.options.files.limits).map_err(|error| error.to_string());
        let opened = read.and_then(|_| image_editor::open(path));
        self.state.opened_image(after, opened);
    }

    /// Reads the person's own keys, and shows the mistakes in them.
    pub fn load_keys(&mut self) {
        let path = folders::config().map(|folder| folder.join("keys.toml")).filter(|path| path.exists());
        let Some(path) = path else { return self.state.keymap = Keymap::default() };
        self.state.keymap = match lines::read(&path) {
            Ok(text) => own_keys::read(&path.display().to_string(), &text),
            Err(error) => Keymap::unread(error.to_string()),
        };
        match self.state.keymap.mistakes() {
            [] => {}
            [one] => self.state.complain(one.clone()),
            [first, rest @ ..] => self.state.complain(format!("{first} ({} more: :keys)", rest.len())),
        }
    }

    /// Opens another scene in place of this one; on failure shows why, and returns false.
    fn open(&mut self, path: &Path, mode: Mode) -> bool {
        match OpenScene::open(path, mode, &self.options.files) {
            Ok(scene) => {
                // The command has refused already if there were unsaved edits to be kept.
                self.state.scene.give_up();
                self.keep();
                let window = self.preview.has_window();
                // Close first: it may be the same scene, and a scene has only one editor.
                self.preview.close();
                self.preview = listen(&scene, &self.options.files, self.sender.clone());
                if window {
                    self.preview.open_window();
                }
                let State { size, depth, .. } = self.state;
                let before = std::mem::replace(&mut self.state, State::new(scene, size, depth));
                self.state.keymap = before.keymap;
                self.state.memory.recorder = before.memory.recorder;
                self.state.memory.lines = before.memory.lines;
                self.state.memory.yanked = before.memory.yanked;
                self.state.memory.registers = before.memory.registers;
                self.state.memory.recalled = before.memory.recalled;
                self.state.picture.graphics = before.picture.graphics;
                self.begin();
                true
            }
            Err(error) => {
                self.state.complain(error.to_string());
                false
            }
        }
    }

    /// Begins the tutor on a scene of its own.
    fn learn(&mut self) {
        match Options::tutor() {
            Ok(options) => {
                if self.open(&options.path, Mode::Edit) {
                    self.options.tutor = options.tutor;
                    self.begin_tutor();
                }
            }
            Err(error) => self.state.complain(error.to_string()),
        }
    }

    /// The scene as it is now; or as it is shown, without what is muted, if it can be without it.
    fn document(&self, seen: bool) -> Document {
        let document = self.state.document();
        let hidden = self.state.apart.hidden(document);
        let size = self.state.picture.synth.as_ref().map(|synth| synth.size).or(self.state.picture.size);
        let shown = size.filter(|_| seen && !hidden.is_empty()).map(|size| document.without(&hidden, size));
        shown.unwrap_or_else(|| document.clone())
    }

    /// Starts a subcommand on the open scene as it is now, or as it is shown.
    fn start(&mut self, words: &[String], seen: bool) {
        if let Err(why) = self.state.outside.idle() {
            return self.state.complain(why);
        }
        let path = self.state.scene.path().to_owned();
        let words: Vec<String> = words.iter().map(|word| at_home(word)).collect();
        let mut with = words.clone();
        with.insert(1, path.to_string_lossy().into_owned());
        let command = ops::parse(&with).or_else(|error| ops::parse(&words).map_err(|_| error));
        match command {
            Ok(command) => {
                let name = words[0].clone();
                let open = Some(ops::Open { path, document: self.document(seen) });
                self.state.outside.work = Some(name.clone());
                self.job = Some(Job::start(command, name, open, self.sender.clone()));
            }
            Err(error) => self.state.complain(error.to_string()),
        }
    }

    /// Restores the terminal, stops the process as Ctrl-Z does, and sets up the screen again afterwards.
    fn suspend(&mut self) {
        if self.screen.is_none() {
            return signals::default_action(Signal::Stop);
        }
        self.drain();
        terminal::restore();
        signals::default_action(Signal::Stop);
        self.set_up();
        self.returned = true;
    }

    /// Sets up the screen again.
    fn set_up(&mut self) {
        if self.screen.is_none() {
            return;
        }
        terminal::restore();
        match terminal::enter() {
            Ok(screen) => self.screen = Some(screen),
            Err(_) => self.leaving = true,
        }
    }
}

/// Replaces a leading `~` of an argument, or of the value of an option, by the home folder, as a shell does.
fn at_home(word: &str) -> String {
    let typed = |path: &str| paths::typed(path).to_string_lossy().into_owned();
    match word.split_once('=') {
        Some((option, path)) if option.starts_with("--") => format!("{option}={}", typed(path)),
        _ => typed(word),
    }
}
