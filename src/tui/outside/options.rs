//! How the editor is opened.

use super::terminal;
use crate::base::error::{Error, Result};
use crate::files::session::Mode;
use crate::files::{lines, profiles};
use crate::tui::graphics::Protocol;
use crate::{files, ops};
use std::path::PathBuf;

/// How the editor is opened.
pub struct Options {
    /// A scene, or a picture with a scene beside it.
    pub path: PathBuf,
    /// Whether to open the preview window, if there is a display.
    pub window: bool,
    /// Whether to open the scene read-only.
    pub read_only: bool,
    /// Whether to take unsaved edits that a session left behind; `None` to ask.
    pub keep_recovery: Option<bool>,
    /// The script that is run first: its file, and its text.
    pub script: Option<(PathBuf, String)>,
    /// The folder of the tutor, if it is to begin.
    pub tutor: Option<PathBuf>,
    /// The graphics protocol; `None` to ask the terminal.
    pub graphics: Option<Protocol>,
    /// How files are read.
    pub files: files::Options,
}

impl Options {
    /// As `plica edit` without options.
    pub fn new(path: PathBuf) -> Options {
        let files = files::Options::default();
        let (keep_recovery, script, graphics, tutor) = (None, None, None, None);
        Options { path, window: true, read_only: false, keep_recovery, script, graphics, tutor, files }
    }

    /// How the scene is opened. If somebody else is editing it, the person is asked; without a person, that is an error.
    pub fn mode(&self) -> Mode {
        match (self.read_only, terminal::is_interactive()) {
            (true, _) => Mode::ReadOnly,
            (false, true) => Mode::EditOrLook,
            (false, false) => Mode::Edit,
        }
    }

    /// The tutor, on a scene of its own in a new folder.
    ///
    /// # Errors
    /// The folder cannot be made, or the terminal cannot show the lessons.
    pub fn tutor() -> Result<Options> {
        if !terminal::is_there() {
            return Err(
                Error::at("the terminal", "cannot show the lessons").cure("the tutor needs a screen to draw on")
            );
        }
        let folder = profiles::TUTOR.fresh()?;
        let path = profiles::TUTOR.unpack(&folder)?;
        Ok(Options { tutor: Some(folder), ..Options::new(path) })
    }

    /// Applies the options of the command line.
    ///
    /// # Errors
    /// A wrong limit, or a script that cannot be read.
    pub fn of(args: &ops::edit::Args) -> Result<Options> {
        let files = args.scene.options()?;
        // Before there is a screen: a pipe may be long in coming.
        let read = |path: &PathBuf| Ok((path.clone(), lines::read_piped(path)?));
        let (path, script) = (args.path.clone(), args.script.as_ref().map(read).transpose()?);
        let graphics = Protocol::named(&args.graphics);
        let (window, read_only, keep_recovery) = (!args.no_view, args.read_only, args.recovery.keep());
        Ok(Options { path, window, read_only, keep_recovery, script, graphics, tutor: None, files })
    }
}
