//! The scene that is open: its session (document, history, journal, file), and what the editor says about it. Every edit
//! of the editor goes through it.

use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::base::error::{Error, Result};
use crate::base::problem::Problem;
use crate::base::text;
use crate::files::holder::Holder;
use crate::files::outputs::{self, Guard};
use crate::files::session::{Mode, Overwrite, Recovery, Session, Taken};
use crate::files::{self, models, picture, write};
use crate::ops::new;
use crate::scene::history::{Applied, Way};
use crate::scene::merge::Side;
use crate::scene::{Document, Edit, History, Start};
use crate::tui::events::Published;

/// At most so many missing files are named.
const MOST_NAMED: usize = 5;

/// Why an edit is refused if the scene is read-only.
const READ_ONLY: &str = "the scene is open read-only: :w PATH saves a copy of it";

/// A scene that is open.
pub struct OpenScene {
    session: Session,
    options: files::Options,
    read_only: bool,
    journaled: bool,
    made: bool,
}

impl OpenScene {
    /// Opens a scene; or, given a picture or a model, the scene beside it, which is made if it is missing.
    ///
    /// # Errors
    /// The scene or the picture cannot be read, or somebody else is editing the scene.
    pub fn open(path: &Path, mode: Mode, options: &files::Options) -> Result<OpenScene> {
        let read_only = mode == Mode::ReadOnly;
        let (scene, made) =
            if files::scene::is_one(path) { (path.to_owned(), false) } else { beside(path, read_only, options)? };
        let session = Session::open(&scene, options, mode)?;
        let read_only = session.reads_only();
        Ok(OpenScene { session, options: options.clone(), read_only, journaled: !read_only, made })
    }

    /// The scene as it is now.
    pub fn document(&self) -> &Document {
        self.session.document()
    }

    /// The scene's file.
    pub fn path(&self) -> &Path {
        self.session.path()
    }

    /// How files are read.
    pub fn options(&self) -> &files::Options {
        &self.options
    }

    /// Whether the scene is open read-only.
    pub fn read_only(&self) -> bool {
        self.read_only
    }

    /// How many changes have been made.
    pub fn revision(&self) -> u64 {
        self.session.history().revision()
    }

    /// Whether the file holds the scene as it is now.
    pub fn is_saved(&self) -> bool {
        self.session.safety().saved
    }

    /// Whether every edit is safe in the journal; true if there is no working journal.
    pub fn is_synced(&self) -> bool {
        let safety = self.session.safety();
        safety.journaled || !self.journaled || safety.failing.is_some()
    }

    /// Tries again to open a journal that could not be opened. To be called now and then.
    pub fn tend(&mut self) {
        self.session.tend();
    }

    /// Gives up unsaved edits: the next session does not ask about them. Undo still has them.
    pub fn give_up(&mut self) {
        if !self.read_only {
            self.session.give_up();
        }
    }

    /// Where the unreadable bytes of a damaged journal are.
    pub fn kept_aside(&self) -> Option<&Path> {
        self.session.kept_aside()
    }

    /// Why edits do not reach the journal.
    pub fn failing(&self) -> Option<String> {
        self.session.safety().failing.filter(|_| !self.read_only)
    }

    /// How long the screen may stay as it is. Marks that will disappear by themselves are checked soon.
    pub fn patience(&self) -> Duration {
        let patience = match (self.failing().is_some(), self.is_synced()) {
            (true, _) => 500,
            (false, true) => 60_000,
            (false, false) => 15,
        };
        Duration::from_millis(patience)
    }

    /// The message after the scene has been opened.
    pub fn greeting(&self, home: Option<String>) -> String {
        let name = self.path().file_name().unwrap_or_default().to_string_lossy().into_owned();
        let made = if self.made { "made, " } else { "" };
        match self.session.kept_aside() {
            Some(aside) => format!("{name}: the journal was damaged; what could not be read is in {}", aside.display()),
            None => match home {
                Some(line) => format!("at home: {line}; ? help, :tutor teaches"),
                None if self.session.history().depth() == (0, 0) => format!("{name}: {made}? help, Space menu, :tutor"),
                None => format!("{name}: ? help, :q leaves"),
            },
        }
    }

    /// Unsaved edits that an earlier session left behind.
    pub fn offered(&self) -> Option<&Recovery> {
        self.session.recovery()
    }

    /// Who else is editing the scene, so that it is read-only here.
    pub fn held_by(&self) -> Option<&Holder> {
        self.session.held_by()
    }

    /// Refuses to change the scene if it is read-only, or while it is not decided what becomes of unsaved edits of an earlier
    /// session.
    ///
    /// # Errors
    /// Says which of the two.
    pub fn writable(&self) -> std::result::Result<(), String> {
        if self.read_only {
            return Err(READ_ONLY.into());
        }
        match self.offered() {
            None => Ok(()),
            Some(offer) => Err(format!(
                "{} left behind: :recovery keep applies what was changed, :recovery drop leaves it to undo",
                offer.in_words()
            )),
        }
    }

    /// Takes the unsaved edits that are offered, or leaves them, so that only undo has them.
    pub fn recover(&mut self, take: bool) -> Option<Published> {
        let before = self.document().clone();
        if take {
            self.session.recover();
        } else {
            self.session.discard_recovery();
        }
        let edit = Edit::between(&before, self.document());
        (!edit.is_empty()).then(|| Published { document: self.document().clone(), revision: self.revision(), edit })
    }

    /// Applies an edit. If `held`, it joins the edit before it into one step of undo. `None` if it changes nothing.
    ///
    /// # Errors
    /// The problems that the scene would have.
    pub fn apply(&mut self, edit: Edit, held: bool) -> std::result::Result<Option<Published>, Vec<Problem>> {
        self.writable().map_err(|why| vec![Problem::error("", why)])?;
        let applied = self.session.apply(edit, held)?;
        Ok(applied.map(|applied| self.change(applied)))
    }

    fn change(&self, applied: Applied) -> Published {
        Published { document: self.document().clone(), revision: applied.revision, edit: applied.edit }
    }

    /// Undoes the last step; `None` if there is none.
    pub fn undo(&mut self) -> Option<Published> {
        let applied = self.session.undo()?;
        Some(self.change(applied))
    }

    /// Redoes the last undone step; `None` if there is none.
    pub fn redo(&mut self) -> Option<Published> {
        let applied = self.session.redo()?;
        Some(self.change(applied))
    }

    /// Goes back to the scene as it was so long ago, counted from now, or from the time of the present state if that is not
    /// the newest. Also returns how many steps that was.
    pub fn earlier(&mut self, time: Duration) -> (usize, Option<Published>) {
        let history = self.session.history();
        let now = if history.state() == history.newest() { files::now_ms() } else { history.time_ms() };
        let all = self.session.travel(|history| history.earlier(now.saturating_sub(millis(time))));
        self.travelled(all)
    }

    /// Goes forward by so long from the time of the present state. Also returns how many steps that was.
    pub fn later(&mut self, time: Duration) -> (usize, Option<Published>) {
        let time = self.session.history().time_ms().saturating_add(millis(time));
        let all = self.session.travel(|history| history.later(time));
        self.travelled(all)
    }

    /// Goes to a state of the history, in any branch.
    pub fn go_to(&mut self, state: usize) -> Option<Published> {
        let all = self.session.travel(|history| history.go_to(state));
        self.travelled(all).1
    }

    fn travelled(&self, all: Vec<(Way, Applied)>) -> (usize, Option<Published>) {
        let count = all.len();
        let edit = Edit::all(all.into_iter().map(|(_, applied)| applied.edit));
        (count, (count > 0).then(|| Published { document: self.document().clone(), revision: self.revision(), edit }))
    }

    /// What was done and can be undone.
    pub fn history(&self) -> &History {
        self.session.history()
    }

    /// How long ago a time (in milliseconds since the epoch) is, in words.
    pub fn ago(&self, time_ms: u64) -> String {
        text::ago(files::now_ms().saturating_sub(time_ms))
    }

    /// Ends a step of undo: the next edit does not join it.
    pub fn close_step(&mut self) {
        self.session.close_step();
    }

    /// Saves the scene, or a copy of it if `to` is another file. Existing content is replaced only if `overwrite`, and files
    /// that the scene reads never. Returns a message.
    ///
    /// # Errors
    /// Why it was not saved.
    pub fn save(&mut self, to: Option<&Path>, overwrite: bool) -> Result<String> {
        if let Some(to) = to.filter(|to| !outputs::is_same(to, self.path())) {
            return self.save_copy(to, overwrite);
        }
        if !overwrite && let Err(why) = self.session.may_overwrite() {
            tracing::warn!("not saved: {why}");
            let way = match self.session.difference() {
                Ok(_) => ":merge takes it in, :w! overwrites it",
                Err(_) => "it can no longer be read; :w! overwrites it",
            };
            return Err(Error::Usage(format!("another program changed the file: {way}")));
        }
        if !overwrite && self.session.refuse_protected().is_err() {
            return Err(Error::Usage("the file is read-only: :w! writes it anyway, :w PATH saves elsewhere".into()));
        }
        self.session.save(if overwrite { Overwrite::Yes } else { Overwrite::No })?;
        Ok(format!("{} is saved", self.path().display()))
    }

    fn save_copy(&self, to: &Path, overwrite: bool) -> Result<String> {
        let scene = self.document().scene();
        let mut guard = Guard::default();
        guard.protect(self.path(), scene);
        // Files that the saved scene names are protected too: without saving, it needs them again.
        let saved = files::scene::open(self.path(), &self.options).ok();
        saved.iter().for_each(|saved| guard.protect(self.path(), saved.scene()));
        guard.spare(to)?;
        let text = self.session.text();
        match to.symlink_metadata() {
            Err(_) => write::write_new(to, text.as_bytes())?,
            Ok(_) if overwrite => files::scene::save(to, &text)?,
            Ok(_) => {
                let error = Error::at(to.display(), "is there already");
                return Err(error.cure("choose another name, or replace it with :w! PATH"));
            }
        }
        let missing = few(&outputs::missing(to, scene));
        let but = if missing.is_empty() { missing } else { format!(", but lacks what it reads there: {missing}") };
        Ok(format!("{} is written{but}", to.display()))
    }

    /// The scene as its file has it, as one edit. `None` if there is no difference.
    ///
    /// # Errors
    /// The file cannot be read, or has errors in it.
    pub fn revert(&mut self) -> Result<Option<Published>> {
        let applied = self.session.revert()?;
        Ok(applied.map(|applied| self.change(applied)))
    }

    /// Takes what another program wrote to the file in: see [`Session::take_in`].
    ///
    /// # Errors
    /// The file cannot be read, or has errors in it.
    pub fn take_in(&mut self, prefer: Option<Side>) -> Result<(Taken, Option<Published>)> {
        let (taken, applied) = self.session.take_in(prefer)?;
        Ok((taken, applied.map(|applied| self.change(applied))))
    }

    /// What the file has otherwise than the scene here, in words.
    ///
    /// # Errors
    /// As [`OpenScene::take_in`].
    pub fn difference(&self) -> Result<Vec<String>> {
        self.session.difference()
    }

    /// Waits until every edit is in the journal.
    pub fn flush(&self) {
        if let Err(reason) = self.session.flush() {
            tracing::warn!("leaving without a journal: {reason}");
        }
    }

    /// What becomes of unsaved edits that are left now, in words.
    pub fn left_unsaved(&self) -> String {
        match self.session.flush() {
            Ok(()) => "the edits are not saved; the next `plica edit` offers them".into(),
            Err(reason) => format!("the edits are not saved, and lost: no journal has them ({reason})"),
        }
    }
}

fn millis(time: Duration) -> u64 {
    time.as_millis().try_into().unwrap_or(u64::MAX)
}

/// The scene beside a picture or a model, and whether it had to be made.
fn beside(picture: &Path, read_only: bool, options: &files::Options) -> Result<(PathBuf, bool)> {
    let scene = new::beside(picture);
    if scene.exists() {
        refuse_other(picture, &scene, options)?;
        return Ok((scene, false));
    }
    if read_only {
        let error = Error::at(picture.display(), "has no scene yet, and --read-only makes none");
        return Err(error.cure("leave --read-only out"));
    }
    if models::is_one(picture) {
        new::create(&scene, &[picture.to_owned()], options)?;
        return Ok((scene, true));
    }
    let size = picture::size(picture, &options.limits)?;
    let (name, file) = (new::called(picture), new::file_name(picture)?);
    let place = || scene.display().to_string();
    let document = Start::default().picture(&name, &file, size).document();
    let document = document.map_err(|problems| Error::Scene { file: place(), problems })?;
    write::write_new(&scene, document.to_text().as_bytes())?;
    Ok((scene, true))
}

/// Refuses the scene beside a picture where it is one of other pictures. What is wrong in it is told when it is opened.
fn refuse_other(picture: &Path, scene: &Path, options: &files::Options) -> Result<()> {
    let Ok(document) = files::scene::open(scene, options) else { return Ok(()) };
    if outputs::reads(scene, document.scene(), picture) {
        return Ok(());
    }
    if !models::is_one(picture) {
        picture::size(picture, &options.limits)?;
    }
    let (own, other) = (picture.display(), scene.display());
    let cure = format!("edit that one, or make another: plica new {own} -o OTHER.plica.json");
    Err(Error::at(own, format!("is not read by the scene beside it, {other}")).cure(cure))
}

/// The first of many files, and how many more there are.
fn few(files: &[String]) -> String {
    let (first, rest) = files.split_at(files.len().min(MOST_NAMED));
    let more = if rest.is_empty() { String::new() } else { format!(" and {} more", rest.len()) };
    first.join(", ") + &more
}

#[cfg(test)]
impl OpenScene {
    /// A scene whose edits stay in memory.
    pub fn in_memory(path: &Path) -> OpenScene {
        let options = files::Options::default();
        let session = Session::open(path, &options, Mode::ReadOnly).expect("a scene of the tests");
        OpenScene { session, options, read_only: false, journaled: false, made: false }
    }
}
