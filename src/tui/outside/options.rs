//! How the editor is opened.

use super::terminal;
use crate::base::error::{Error, Result};
use crate::files::profiles;
use crate::files::session::Mode;
use crate::tui::graphics::Protocol;
use crate::{files, ops};
use std::path::PathBuf;

/// How the editor is opened.
pub struct Options {
    /// A scene, or a picture whose scene lies beside it.
    pub path: PathBuf,
    /// Whether to open the preview window where there is a display.
    pub window: bool,
    /// Whether the scene may only be looked at.
    pub read_only: bool,
    /// Whether unsaved edits that a session left behind are taken; none: that is asked.
    pub keep_recovery: Option<bool>,
    /// The lines that are run at first.
    pub script: Option<PathBuf>,
    /// The folder of the tutor, where it is to begin.
    pub tutor: Option<PathBuf>,
    /// How the picture is shown; none: as the terminal answers.
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

    /// How a scene is opened: where somebody else edits it, the person is asked, if there is one.
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
    /// The folder cannot be made, or there is no terminal that shows the lessons.
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

    /// As the command line says.
    ///
    /// # Errors
    /// A wrong limit.
    pub fn of(args: &ops::edit::Args) -> Result<Options> {
        let files = args.scene.options()?;
        let (path, script) = (args.path.clone(), args.script.clone());
        let graphics = Protocol::named(&args.graphics);
        let (window, read_only, keep_recovery) = (!args.no_view, args.read_only, args.recovery.keep());
        Ok(Options { path, window, read_only, keep_recovery, script, graphics, tutor: None, files })
    }
}
