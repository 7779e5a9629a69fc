//! The protocol between editor, windows and scripts: what may be said, in both directions. These are also the types in which
//! windows hear their editor and the editor hears its windows: a message that the link itself does not answer is passed
//! through as it is. See `frame.rs` for the bytes.

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::Value;

use crate::base::problem::Problem;
use crate::files::originals::Original;
use crate::layers::space::camera::Camera;
use crate::preview::Transport;
use crate::preview::views;
use crate::scene::edit::Edit;

/// The most characters of a text from a window that are shown.
const MOST_OF_A_LINE: usize = 200;

/// What the editor says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum FromEditor {
    /// Answers a [`ToEditor::Hello`] with the whole state.
    Hello {
        /// Version of the program, for people.
        program: String,
        /// The scene's path on the editor's machine.
        scene: String,
        /// Revision of `document`.
        revision: u64,
        /// The document.
        document: Value,
    },
    /// The document changed from one revision to another, perhaps over several edits.
    Patch {
        /// The revision that the patch is applied to.
        from_revision: u64,
        /// The revision that comes out.
        to_revision: u64,
        /// The edits, joined.
        patch: Edit,
    },
    /// The whole document, if a patch would be longer or does not fit.
    Scene {
        /// Revision of `document`.
        revision: u64,
        /// The document.
        document: Value,
    },
    /// JSON pointer of what is selected.
    Selection(Option<String>),
    /// Where the cursor of the editor's picture is, in pixels of the picture, while the picture has the focus.
    Cursor(Option<(f64, f64)>),
    /// Whether the animation runs, and where it is.
    Transport(Transport),
    /// Look from somewhere.
    Look {
        /// The camera; `None` is the scene's.
        camera: Option<Camera>,
        /// How often windows have been told to look somewhere: the same place twice is not the same message.
        nth: u64,
    },
    /// Asks for what the window has not told yet, as while it draws: it tells that, and answers with the number.
    Ask(u64),
    /// An overlay or zoom command, by name.
    View(String),
    /// The overlay and zoom commands in force, for a window that was not there when they were given.
    Views(Vec<String>),
    /// The files that the scene names, for a window on another machine, which requests those that it does not have.
    Images(Vec<Original>),
    /// Answers a [`ToEditor::Want`]: the bytes from there on, at most [`PIECE`](crate::files::originals::PIECE).
    Piece {
        /// SHA-256 of the file, in hexadecimal.
        hash: String,
        /// Position of the bytes in the file.
        offset: u64,
        /// The bytes; `None` if the file is not there any more.
        #[serde(skip)]
        bytes: Vec<u8>,
    },
    /// One line for the person at a window on another machine.
    Notice(String),
    /// All that is wrong with the scene that is followed there.
    Problems(Vec<Problem>),
    /// Nothing happened; this end is still there.
    Alive,
    /// Answers a [`ToEditor::Edit`]: no problems means done.
    Edited(Vec<Problem>),
    /// The editor leaves, or refuses this peer; the reason, for people.
    Bye(String),
}

/// Who joins an editor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// A window: wants the state and every change of it.
    Window,
    /// A script (`plica set`, `plica get`): wants the state once, may send one edit.
    Script,
}

/// What a window or a script says to the editor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ToEditor {
    /// The first message.
    Hello {
        /// Version of the program, for people.
        program: String,
        /// Window or script.
        role: Role,
    },
    /// The document of this revision has been synthesised and is shown.
    Ack {
        /// The revision shown.
        revision: u64,
        /// What the synthesis took, in milliseconds.
        synth_ms: f64,
    },
    /// The patch did not fit: send the whole document.
    WantScene,
    /// How the window is doing.
    Report {
        /// Frames a second.
        fps: f64,
        /// Name of the graphics adapter.
        adapter: String,
        /// One line for the editor's status; empty if all is well.
        notice: String,
    },
    /// See there: the link passes it on as it is.
    Gesture(Gesture),
    /// Answers a [`FromEditor::Ask`]: what happened in the window before it is told.
    Answer(u64),
    /// A window on another machine requests a piece of a file that [`FromEditor::Images`] announced.
    Want {
        /// SHA-256 of the file, in hexadecimal.
        hash: String,
        /// Position of the piece in the file, in bytes.
        offset: u64,
    },
    /// Nothing happened; the window is still there.
    Alive,
    /// A change asked for by a script.
    Edit {
        /// The revision that the patch was made for.
        revision: u64,
        /// The change.
        patch: Edit,
    },
}

/// What the person at a window does that whoever edits is to hear of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Gesture {
    /// The pointer, in pixels of the picture.
    Pointer {
        /// From the left edge.
        x: f64,
        /// From the top edge.
        y: f64,
    },
    /// The camera that the window looks through, where it is not the scene's.
    Camera(Option<Camera>),
    /// The animation was started or stopped in the window, or moved.
    Transport(Transport),
    /// A request by command name.
    Command(String),
}

/// What a message of the editor is to one who follows it.
#[derive(Clone, Debug, PartialEq)]
pub enum Meaning {
    /// A change from one revision of the document to another.
    Patch(u64, u64, Edit),
    /// The whole document, of a revision.
    Scene(u64, Value),
    /// Something that each end of the link answers in its own way.
    Link(OfTheLink),
    /// Something that is passed on to windows as it is.
    Windows(FromEditor),
    /// Nothing to be done.
    Nothing,
}

/// What each end of the link answers in its own way.
#[derive(Clone, Debug, PartialEq)]
pub enum OfTheLink {
    /// See [`FromEditor::Images`].
    Images(Vec<Original>),
    /// See [`FromEditor::Piece`]: the hash, the position, the bytes.
    Piece(String, u64, Vec<u8>),
    /// See [`FromEditor::Notice`].
    Notice(String),
    /// See [`FromEditor::Problems`].
    Problems(Vec<Problem>),
    /// See [`FromEditor::Bye`].
    Bye(String),
}

impl FromEditor {
    /// What it is to one who follows the editor.
    pub fn meaning(self) -> Meaning {
        match self {
            FromEditor::Patch { from_revision, to_revision, patch } => {
                Meaning::Patch(from_revision, to_revision, patch)
            }
            FromEditor::Scene { revision, document } => Meaning::Scene(revision, document),
            FromEditor::Images(originals) => Meaning::Link(OfTheLink::Images(originals)),
            FromEditor::Piece { hash, offset, bytes } => Meaning::Link(OfTheLink::Piece(hash, offset, bytes)),
            FromEditor::Notice(line) => Meaning::Link(OfTheLink::Notice(line)),
            FromEditor::Problems(problems) => Meaning::Link(OfTheLink::Problems(problems)),
            FromEditor::Bye(reason) => Meaning::Link(OfTheLink::Bye(reason)),
            FromEditor::Selection(_) | FromEditor::Transport(_) | FromEditor::Look { .. } => Meaning::Windows(self),
            FromEditor::Cursor(_) | FromEditor::Ask(_) => Meaning::Windows(self),
            FromEditor::View(_) | FromEditor::Views(_) => Meaning::Windows(self),
            // What begins the link is heard before; what scripts are told, windows are not.
            FromEditor::Hello { .. } | FromEditor::Alive | FromEditor::Edited(_) => Meaning::Nothing,
        }
    }

    /// The problems with an edit that the message answers; `None` for all other messages.
    pub fn answer(self) -> Option<Vec<Problem>> {
        if let FromEditor::Edited(problems) = self { Some(problems) } else { None }
    }

    /// The message with only those of its commands that are to be obeyed; `None` if it was nothing else.
    pub fn obeying(self, obeyed: impl Fn(&String) -> bool) -> Option<FromEditor> {
        match self {
            FromEditor::View(name) => obeyed(&name).then_some(FromEditor::View(name)),
            FromEditor::Views(names) => Some(FromEditor::Views(names.into_iter().filter(obeyed).collect())),
            // The document, and what is selected, playing or wrong in it.
            FromEditor::Hello { .. } | FromEditor::Patch { .. } | FromEditor::Scene { .. } => Some(self),
            FromEditor::Selection(_) | FromEditor::Transport(_) | FromEditor::Look { .. } => Some(self),
            FromEditor::Cursor(_) | FromEditor::Ask(_) => Some(self),
            FromEditor::Notice(_) | FromEditor::Problems(_) => Some(self),
            // The link and the files that it brings.
            FromEditor::Images(_) | FromEditor::Piece { .. } | FromEditor::Alive => Some(self),
            FromEditor::Edited(_) | FromEditor::Bye(_) => Some(self),
        }
    }
}

impl ToEditor {
    /// The message with all its text as single lines of bounded length, without control characters.
    #[must_use]
    pub fn in_lines(self) -> ToEditor {
        let line = |text: String| text.chars().filter(|c| !c.is_control()).take(MOST_OF_A_LINE).collect();
        match self {
            ToEditor::Report { fps, adapter, notice } => {
                ToEditor::Report { fps, adapter: line(adapter), notice: line(notice) }
            }
            ToEditor::Gesture(Gesture::Command(name)) => Gesture::Command(line(name)).into(),
            // Numbers alone, or what the link answers.
            ToEditor::Gesture(Gesture::Pointer { .. } | Gesture::Camera(_) | Gesture::Transport(_)) => self,
            ToEditor::Hello { .. } | ToEditor::Ack { .. } | ToEditor::WantScene | ToEditor::Want { .. } => self,
            ToEditor::Answer(_) | ToEditor::Alive | ToEditor::Edit { .. } => self,
        }
    }

    /// Whether JSON can write all numbers of the message: it knows no infinity and no NaN.
    pub fn is_finite(&self) -> bool {
        match self {
            ToEditor::Ack { synth_ms, .. } => synth_ms.is_finite(),
            ToEditor::Report { fps, .. } => fps.is_finite(),
            ToEditor::Gesture(gesture) => gesture.is_finite(),
            ToEditor::Hello { .. } | ToEditor::WantScene | ToEditor::Want { .. } => true,
            ToEditor::Answer(_) | ToEditor::Alive | ToEditor::Edit { .. } => true,
        }
    }
}

impl From<Gesture> for ToEditor {
    fn from(gesture: Gesture) -> ToEditor {
        ToEditor::Gesture(gesture)
    }
}

impl Gesture {
    fn is_finite(&self) -> bool {
        match self {
            Gesture::Pointer { x, y } => x.is_finite() && y.is_finite(),
            Gesture::Camera(None) | Gesture::Command(_) => true,
            Gesture::Camera(Some(Camera { position, target, up, fov, .. })) => {
                [position, target, up].into_iter().flatten().chain([fov]).all(|number| number.is_finite())
            }
            Gesture::Transport(transport) => transport.time.is_finite() && transport.speed.is_finite(),
        }
    }

    /// What the other windows are told, so that they do the same.
    pub fn echo(&self) -> Option<FromEditor> {
        match self {
            Gesture::Transport(transport) => Some(FromEditor::Transport(*transport)),
            Gesture::Command(name) => views::is_for_all(name).then(|| FromEditor::View(name.clone())),
            Gesture::Pointer { .. } | Gesture::Camera(_) => None,
        }
    }
}

/// What goes over the wire: JSON, and bytes where a message has some.
pub trait Message: Serialize + DeserializeOwned {
    /// The bytes that go after its JSON.
    fn bytes(&self) -> Option<&[u8]> {
        None
    }

    /// Where to put the bytes that came after its JSON; `None` for most messages.
    fn bytes_mut(&mut self) -> Option<&mut Vec<u8>> {
        None
    }
}

impl Message for ToEditor {}

impl Message for FromEditor {
    fn bytes(&self) -> Option<&[u8]> {
        if let FromEditor::Piece { bytes, .. } = self { Some(bytes) } else { None }
    }

    fn bytes_mut(&mut self) -> Option<&mut Vec<u8>> {
        if let FromEditor::Piece { bytes, .. } = self { Some(bytes) } else { None }
    }
}
