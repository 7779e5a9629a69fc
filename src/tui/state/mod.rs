//! The editor's state: a value that `update` (update.rs) changes and the panes draw. Tests drive it without a terminal.

pub mod cursor;
pub mod entry;
pub mod finding;
pub mod memory;
pub mod picture;
pub mod place;
pub mod questions;
pub mod recorder;
pub mod spots;
pub mod transport;
pub mod tutor;

pub use self::cursor::Pane;
use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;

use super::document::choice::Choice;
use super::document::door::Door;
use super::document::entry::Entry;
use super::document::palette::Palette;
use super::document::sheet::Sheet;
use super::document::tree;
use super::events::{Change, Effect};
use super::graphics::sight::Placing;
use super::keys::Keymap;
use super::state::finding::Finding;
use super::state::memory::Kept;
use super::state::picture::Seeing;
use super::state::questions::Life;
use super::state::recorder::Recorder;
use super::state::tutor::Tutor;
use super::text::colour::Depth;
use super::text::line::Line;
use crate::base::problem::Problem;
use crate::render::Synth;
use crate::scene::{Document, Edit, address, field};

/// The least terminal that the editor draws on: a split of a window, less the lines that a multiplexer takes.
pub const LEAST: (u16, u16) = (60, 20);

/// The terminal that is meant where there is none.
pub const USUAL: (u16, u16) = (80, 24);

/// Whether the editor draws on a terminal of this size; on a smaller one nothing can be edited, for nothing is seen of it.
pub fn fits((width, height): (u16, u16)) -> bool {
    width >= LEAST.0 && height >= LEAST.1
}

/// Messages that are kept.
const MOST_SAID: usize = 200;

/// Everything that the screen shows and the keys change.
pub struct State {
    /// The scene, its history and its file.
    pub door: Door,
    /// Width and height of the terminal.
    pub size: (u16, u16),
    /// What the terminal shows of colours.
    pub depth: Depth,
    /// The pane that takes the keys.
    pub focus: Pane,
    /// Pointer of the node in the middle.
    pub node: String,
    /// Nodes of the tree that are collapsed.
    pub folded: BTreeSet<String>,
    /// The row of the sheet under the cursor.
    pub row: usize,
    /// The cell of the row under the cursor.
    pub column: usize,
    /// The row where the selection began.
    pub selected_from: Option<usize>,
    /// The row where it ends; `None` if it ends at the cursor.
    pub selected_to: Option<usize>,
    /// What is going on.
    pub mode: Mode,
    /// The count typed so far.
    pub count: Option<usize>,
    /// The keys of an unfinished binding.
    pub pressed: String,
    /// The power of ten that `+` and `-` step by.
    pub step: i32,
    /// The cursor and zoom of the picture.
    pub placing: Placing,
    /// Width and height of the picture, once known.
    pub picture_size: Option<(usize, usize)>,
    /// Scene time, in [0, 1].
    pub time: f64,
    /// Whether the animation runs.
    pub playing: bool,
    /// Seconds of the scene a second.
    pub speed: f64,
    /// One line for the person.
    pub message: Option<Message>,
    /// What was said before, the newest last.
    pub said: VecDeque<Message>,
    /// Commands that were run, the newest last.
    pub lines: Vec<String>,
    /// The keys in force.
    pub keymap: Keymap,
    /// Who listens to the lines that are run.
    pub recorder: Recorder,
    /// What was yanked and selected last.
    pub kept: Kept,
    /// Marks, the jump list and the search.
    pub finding: Finding,
    /// What the threads have found out.
    pub seen: Seen,
    /// What happens to the scene outside, and what is asked about it.
    pub life: Life,
    /// What there is to see of the picture.
    pub seeing: Seeing,
    /// The lesson that is on.
    pub tutor: Option<Tutor>,
    /// What is still to happen outside.
    pub effects: VecDeque<Effect>,
}

/// What is going on.
#[derive(Clone, Debug)]
pub enum Mode {
    /// Keys are commands.
    Normal,
    /// A value is being typed into a cell.
    Entry(Entry),
    /// A command or a search is being typed.
    Line(Line),
    /// Something is being chosen from a list.
    Choice(Choice),
    /// A text is shown: the help, or what a command printed.
    Pages(Pages),
    /// Something is looked for among everything that can be run or gone to.
    Palette(Palette),
    /// The picture's cursor sets a jump vector.
    Aim,
}

/// A text that is longer than a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pages {
    /// What it is.
    pub title: String,
    /// Its lines.
    pub lines: Vec<String>,
    /// The first line shown.
    pub scroll: usize,
}

/// A line for the person.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// What is said.
    pub text: String,
    /// Whether something could not be done.
    pub bad: bool,
}

/// What the threads have found out about the scene; old while they work on.
#[derive(Clone, Default)]
pub struct Seen {
    /// What a frame needs.
    pub synth: Option<Arc<Synth>>,
    /// How long the last synthesis took.
    pub synth_ms: Option<f64>,
    /// What keeps the scene from being shown.
    pub problem: Option<String>,
    /// Long work that runs: what, and how far it is.
    pub work: Option<String>,
    /// How the window is doing.
    pub window: String,
    /// Where the pointer is in it, in pixels of the picture.
    pub pointer: Option<(f64, f64)>,
}

impl State {
    /// The editor as it opens: the tree has the focus, the first zone is shown.
    pub fn new(door: Door, size: (u16, u16), depth: Depth) -> Self {
        let node = tree::first(door.document());
        let placing = Placing::new(tree::picture_centre(door.document()));
        let life = Life::begin(&door);
        let mut state = State {
            door,
            size,
            depth,
            focus: Pane::Tree,
            node,
            folded: BTreeSet::new(),
            row: 0,
            column: 0,
            selected_from: None,
            selected_to: None,
            mode: Mode::Normal,
            count: None,
            pressed: String::new(),
            step: 0,
            placing,
            picture_size: None,
            time: 0.0,
            playing: false,
            speed: 1.0,
            message: None,
            said: VecDeque::new(),
            lines: Vec::new(),
            keymap: Keymap::default(),
            recorder: Recorder::default(),
            kept: Kept::default(),
            finding: Finding::default(),
            seen: Seen::default(),
            life,
            tutor: None,
            seeing: Seeing::default(),
            effects: VecDeque::new(),
        };
        state.ask_waiting();
        state
    }

    /// The scene as it is now.
    pub fn document(&self) -> &Document {
        self.door.document()
    }

    /// The node in the middle, as rows.
    pub fn sheet(&self) -> Sheet {
        Sheet::of(self.document(), &self.node)
    }

    /// The pointer of the row under the cursor, else of the node.
    pub fn focused(&self) -> String {
        self.sheet().pointer(self.row).unwrap_or_else(|| self.node.clone())
    }

    /// Says something.
    pub fn say(&mut self, text: impl Into<String>) {
        self.tell(Message { text: text.into(), bad: false });
    }

    /// Says that something could not be done.
    pub fn complain(&mut self, text: impl Into<String>) {
        self.tell(Message { text: text.into(), bad: true });
    }

    /// Shows a message, and keeps it for `:messages`.
    fn tell(&mut self, message: Message) {
        if self.said.len() >= MOST_SAID {
            self.said.pop_front();
        }
        self.said.push_back(message.clone());
        self.message = Some(message);
    }

    /// Asks the question that waits, once nothing else is going on.
    pub fn ask_waiting(&mut self) {
        if matches!(self.mode, Mode::Normal) {
            self.mode = self.life.waiting.take().map_or(Mode::Normal, Mode::Choice);
        }
    }

    /// Asks for something outside.
    pub fn ask(&mut self, effect: Effect) {
        self.effects.push_back(effect);
    }

    /// Applies an edit through the one door. One of a held key joins the one before it into one step of undo.
    pub fn edit(&mut self, edit: Edit, held: bool) -> Result<(), String> {
        if edit.is_empty() {
            return Ok(());
        }
        if let Some(change) = self.door.apply(edit, held).map_err(|problems| self.refusal(problems))? {
            self.changed(change);
        }
        Ok(())
    }

    /// Why an edit is refused, its place as people write it.
    fn refusal(&self, problems: Vec<Problem>) -> String {
        let told = |problem: Problem| Problem { path: address::told(self.document(), &problem.path), ..problem };
        first(&problems.into_iter().map(told).collect::<Vec<_>>())
    }

    /// Goes on from a document that has changed.
    pub fn changed(&mut self, change: Change) {
        self.finding.follow(&change);
        self.settle();
        self.ask(Effect::Publish(Box::new(change)));
    }

    /// Shows another node, its first row under the cursor.
    pub fn show(&mut self, node: impl Into<String>) {
        let node = node.into();
        if node != self.node {
            self.unselect();
            (self.node, self.row, self.column) = (node, 0, 0);
            self.ask(Effect::Show);
        }
    }

    /// Ends the selection, which `gv` takes up again; false where there is none.
    pub fn unselect(&mut self) -> bool {
        let (from, to) = (self.selected_from.take(), self.selected_to.take().unwrap_or(self.row));
        self.kept.selection = from.map(|from| (self.node.clone(), from, to)).or(self.kept.selection.take());
        from.is_some()
    }

    /// Brings the cursor back to something that is there, after the scene has changed.
    pub fn settle(&mut self) {
        while !self.node.is_empty() && !field::is_there(self.document(), &self.node) {
            let parent = self.node.rsplit_once('/').map_or("", |(parent, _)| parent).to_string();
            self.show(parent);
        }
        let sheet = self.sheet();
        let last = sheet.len().saturating_sub(1);
        self.row = self.row.min(last);
        self.column = self.column.min(sheet.row(self.row).map_or(0, |row| row.cells.len().saturating_sub(1)));
        self.selected_from = self.selected_from.map(|row| row.min(last));
        self.selected_to = self.selected_to.map(|row| row.min(last)).filter(|_| self.selected_from.is_some());
    }

    /// Whether the terminal is too small to draw on, so that nobody sees what is edited.
    pub fn is_small(&self) -> bool {
        !fits(self.size)
    }

    /// The frame that is shown, and how many there are.
    pub fn frame(&self) -> (u64, u64) {
        let timeline = &self.document().scene().timeline;
        let frames = timeline.frames();
        let nearest = (self.time / timeline.time_of(1)).round() as u64;
        (nearest.min(frames - 1), frames)
    }
}

/// The first problem, and how many more there are.
pub fn first(problems: &[Problem]) -> String {
    let one = problems.first().map(Problem::to_string).unwrap_or_default();
    if problems.len() > 1 { format!("{one} (and {} more)", problems.len() - 1) } else { one }
}
