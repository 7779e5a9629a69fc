//! What comes into the editor and what it asks for: types only.

use crate::base::problem::Problem;
use std::path::PathBuf;
use std::sync::Arc;

use super::graphics::TerminalPicture;
use super::graphics::counts::Counts;
use super::graphics::probed::Probed;
use crate::layers::space::camera::Camera;
use crate::ops::views::paint;
use crate::preview::editor;
use crate::render::Synth;
use crate::scene::{Document, Edit, Scene};

/// Something that happened.
pub enum Event {
    /// A key, by its name in the table.
    Key(String),
    /// A line of a script.
    Line(String),
    /// A line of the line mode, `None` at the end of the input. Handled in lines.rs, never by `update`.
    Typed(Option<String>),
    /// The lines that the one being typed could become.
    Completed(Vec<String>),
    /// Text pasted by the terminal.
    Paste(String),
    /// The terminal has been resized.
    Resize(u16, u16),
    /// This much time has passed while playing, in seconds.
    Tick(f64),
    /// A synthesis has ended: what it made, or why it failed.
    Synthesised(Box<Result<Synthesis, Problem>>),
    /// What was said last of a synthesis is true of this scene.
    Made(Arc<Scene>),
    /// A synthesis has begun.
    Synthesising,
    /// So much of the scene's files is read, in percent, if that takes a while.
    Reading(u8),
    /// So much of what takes longest in a synthesis is done, in percent, if that takes a while.
    Filling(u8),
    /// What a pixel does.
    Probed(Arc<Probed>),
    /// Which numbers the pixels of a pass have.
    Counted(Arc<Counts>),
    /// The worker has made a picture; it took so many milliseconds.
    Picture(Arc<TerminalPicture>, f64),
    /// Long work has made progress.
    Progress(String),
    /// Long work has ended, with its last message.
    Done(Result<String, String>),
    /// What is to be painted on is drawn, or why it is not.
    Drawn(Box<Result<(paint::Wanted, paint::Drawn), String>>),
    /// A program that rows were sent through has ended: what it gave back, or why there is nothing.
    Piped(Result<String, String>),
    /// A save has ended.
    Saved(Result<String, String>),
    /// A window or a script says something, or windows come and go.
    Window(editor::Event),
    /// A background thread has panicked.
    Fault(String),
    /// The log of the session cannot be written.
    Unlogged(String),
    /// Files of the scene have changed on the disk.
    FilesChanged(Vec<PathBuf>),
    /// The system asks the editor to end, or the terminal has gone away.
    End,
    /// A stop signal (as from Ctrl-Z) was sent from outside.
    Stop,
    /// The process goes on after it was stopped.
    Continue,
    /// A click, in cells of the terminal.
    Click(u16, u16),
}

/// What a synthesis has made.
pub struct Synthesis {
    /// What a frame needs.
    pub synth: Arc<Synth>,
    /// How long it took, in milliseconds.
    pub ms: f64,
    /// The longest vector of every field, by its pointer.
    pub longest: Vec<(String, f64)>,
    /// A warning about the scene's pictures.
    pub warning: Option<Problem>,
}

/// What is to be drawn to paint on it, of what is seen of a scene.
#[derive(Clone, Debug)]
pub struct ToDraw {
    /// What is wanted.
    pub wanted: paint::Wanted,
    /// The scene.
    pub document: Document,
    /// The same, ready for frames.
    pub synth: Arc<Synth>,
}

/// A change of the document, as it is sent to windows.
#[derive(Clone, Debug)]
pub struct Published {
    /// The document after it.
    pub document: Document,
    /// Its revision.
    pub revision: u64,
    /// What was changed.
    pub edit: Edit,
}

/// Something that the editor asks to be done outside.
#[derive(Clone, Debug)]
pub enum Effect {
    /// The document has changed: show it everywhere.
    Publish(Box<Published>),
    /// The time or the selection has changed.
    Show,
    /// The time has passed, or a window has changed it: windows need no message for that.
    Pass,
    /// Write the document, to the scene's own file unless another is given.
    Save {
        /// Another file.
        to: Option<PathBuf>,
        /// Whether another program's version may be overwritten.
        overwrite: bool,
        /// Whether to leave once it is safe.
        leave: bool,
    },
    /// Write a text to a new file.
    Write(PathBuf, String),
    /// Run the lines of a file.
    Source(PathBuf),
    /// Read the person's own keys again.
    Keymap,
    /// Open another scene.
    Open(PathBuf),
    /// Open this scene for editing, although somebody may be editing it elsewhere.
    TakeOver,
    /// Begin the tutor, on a scene of its own.
    Tutor,
    /// Load the pictures again.
    Reload,
    /// Probe a pixel, with these arguments of `plica probe`. On a screen the read-out shows the answer already.
    Probe(Vec<String>),
    /// Run a subcommand of the command line with these arguments.
    Run(Vec<String>),
    /// The same on what is shown of the scene, without what is muted.
    RunSeen(Vec<String>),
    /// What is muted has changed.
    Mute,
    /// What is compared has changed.
    Compare,
    /// What is seen in place of what the camera sees has changed.
    Sight,
    /// Draw what is to be painted on.
    Draw(Box<ToDraw>),
    /// Send a table through a program of the person's.
    Pipe(String, String),
    /// Look for the files that a path could become.
    Complete {
        /// The command that takes the path.
        name: String,
        /// What has been typed of it.
        path: String,
        /// The folder that the path is relative to; `None` for the present one.
        beside: Option<PathBuf>,
    },
    /// Hand a text to the terminal's clipboard.
    Copy(String),
    /// End long work.
    Cancel,
    /// Open the preview window, or give it a command.
    View(Option<String>),
    /// Let the windows look from there, or by the scene's camera again.
    Look(Option<Box<Camera>>),
    /// Ask the windows for what they have not told yet.
    Ask,
    /// Open a picture in another program.
    EditImage {
        /// The picture.
        path: PathBuf,
        /// What has been done before that, which is told with it.
        after: Option<String>,
    },
    /// Draw the whole screen again.
    Redraw,
    /// Stop the process as Ctrl-Z does in a shell.
    Suspend,
    /// Set up the screen again, whatever a shell has written on it since the process was stopped.
    Return,
    /// Leave.
    Quit,
}
