//! The editor's state: a value that `update` (commands/update.rs) changes and the panes draw. Each of its parts has a file
//! here. Tests drive it without a terminal.

pub mod apart;
pub mod cursor;
pub mod entry;
pub mod finding;
pub mod kept;
mod locked;
pub mod looking;
pub mod memory;
pub mod outside;
pub mod painting;
pub mod picture;
pub mod place;
pub mod play;
pub mod recorder;
pub mod spatial;
pub mod spots;
pub mod tutor;
pub mod typing;

use std::collections::VecDeque;

use self::apart::Apart;
use self::cursor::Cursor;
pub use self::cursor::Pane;
use self::memory::Memory;
pub use self::memory::Message;
use self::outside::Outside;
use self::picture::Picture;
use self::play::{Passed, Play};
use self::tutor::Tutor;
use self::typing::Typing;
pub use self::typing::{Mode, Pages};
use super::document::open_scene::OpenScene;
use super::document::sheet::{Row, Sheet};
use super::document::tree;
use super::events::{Effect, Published};
use super::keys::Keymap;
use super::text::color::Depth;
use crate::base::pointer::Pointer;
use crate::base::problem::Problem;
use crate::layers::timeline::Timeline;
use crate::preview::Transport;
use crate::scene::{Document, Edit, address, field};

/// The smallest terminal that the editor draws on: a split window, less the lines that a multiplexer takes.
pub const LEAST: (u16, u16) = (60, 20);

/// The size that is assumed if there is no terminal.
pub const USUAL: (u16, u16) = (80, 24);

/// Whether the editor draws on a terminal of this size. On a smaller one nothing can be edited, because nobody would see it.
pub fn fits((width, height): (u16, u16)) -> bool {
    width >= LEAST.0 && height >= LEAST.1
}

/// Everything that the screen shows and the keys change.
pub struct State {
    /// The scene, its history and its file.
    pub scene: OpenScene,
    /// Width and height of the terminal.
    pub size: (u16, u16),
    /// How many colors the terminal shows.
    pub depth: Depth,
    /// The keys in use.
    pub keymap: Keymap,
    /// Where the cursor is, and which rows are selected.
    pub cursor: Cursor,
    /// What is muted, solo or locked.
    pub apart: Apart,
    /// What the next key means.
    pub typing: Typing,
    /// Which part of the picture shows, and what the threads have made of the scene.
    pub picture: Picture,
    /// The time of the scene, and whether it runs.
    pub play: Play,
    /// What is known of the file, the window and long work.
    pub outside: Outside,
    /// What is remembered of what was done and said before.
    pub memory: Memory,
    /// The lesson of the tutor, if it runs.
    pub tutor: Option<Tutor>,
    /// The message that is shown.
    pub message: Option<Message>,
    /// What is to be done outside, in order.
    pub effects: VecDeque<Effect>,
}

impl State {
    /// The editor right after opening a scene: the tree has the focus, the first zone is shown.
    pub fn new(scene: OpenScene, size: (u16, u16), depth: Depth) -> Self {
        let mut state = State {
            size,
            depth,
            keymap: Keymap::default(),
            cursor: Cursor::new(tree::first(scene.document())),
            apart: Apart::default(),
            typing: Typing::default(),
            picture: Picture::new(tree::picture_center(scene.document())),
            play: Play::default(),
            outside: Outside::new(&scene),
            memory: Memory::default(),
            tutor: None,
            message: None,
            effects: VecDeque::new(),
            scene,
        };
        state.ask_waiting();
        state
    }

    /// The scene as it is now.
    pub fn document(&self) -> &Document {
        self.scene.document()
    }

    /// The node in the middle column, as rows.
    pub fn sheet(&self) -> Sheet {
        Sheet::of(self.document(), &self.cursor.node).with(self.memory.columns.of(&self.cursor.node))
    }

    /// The row under the cursor.
    pub fn row(&self) -> Option<Row> {
        self.sheet().row(self.cursor.row)
    }

    /// The pointer of the row under the cursor; of the node if it has no rows.
    pub fn focused(&self) -> String {
        self.sheet().pointer(self.cursor.row).unwrap_or_else(|| self.cursor.node.clone())
    }

    /// Shows a message.
    pub fn say(&mut self, text: impl Into<String>) {
        self.tell(Message::new(text, false));
    }

    /// Shows a message that something could not be done.
    pub fn complain(&mut self, text: impl Into<String>) {
        self.tell(Message::new(text, true));
    }

    /// Shows how something ended that ran beside the keys. They may be going on, so it stays until Esc or the next message.
    pub fn tell_beside(&mut self, result: Result<String, String>) {
        let bad = result.is_err();
        let text = result.unwrap_or_else(|why| why);
        self.tell(Message { stays: true, ..Message::new(text, bad) });
    }

    /// Tells how the opening of a picture in another program went, behind what was done before that and beside the keys.
    pub fn opened_image(&mut self, after: Option<String>, opened: Result<String, String>) {
        match (after, opened) {
            (None, Ok(said)) => self.say(said),
            (None, Err(why)) => self.complain(why),
            (Some(done), Ok(said)) => self.tell_beside(Ok(format!("{done}; {said}"))),
            (Some(done), Err(why)) => self.tell_beside(Err(format!("{done}, but {why}"))),
        }
    }

    /// Shows a message, and remembers it for `:messages`. What went wrong beside the keys gives way once it has been seen.
    fn tell(&mut self, message: Message) {
        self.memory.hear(message.clone());
        let waits = self.message.as_ref().is_some_and(|old| old.stays && old.bad && !old.seen);
        if !waits || message.bad {
            self.message = Some(message);
        }
    }

    /// A key or a line begins: what was said before goes, unless it stays.
    pub fn begin_key(&mut self, ends: bool) {
        self.message.take_if(|message| ends || !message.stays);
    }

    /// What is shown has been drawn.
    pub fn drawn(&mut self) {
        self.message.iter_mut().for_each(|message| message.seen = true);
    }

    /// Asks the waiting question, once nothing else is going on.
    pub fn ask_waiting(&mut self) {
        if matches!(self.typing.mode, Mode::Normal) {
            self.typing.mode = self.outside.waiting.take().map_or(Mode::Normal, Mode::Choice);
        }
    }

    /// Requests something to be done outside.
    pub fn ask(&mut self, effect: Effect) {
        self.effects.push_back(effect);
    }

    /// Applies an edit. If `held`, it joins the edit before it into one step of undo.
    pub fn edit(&mut self, edit: Edit, held: bool) -> Result<(), String> {
        if edit.is_empty() {
            return Ok(());
        }
        self.unlocked(&edit)?;
        let overruled = edit.overruled(self.document());
        if let Some(change) = self.scene.apply(edit, held).map_err(|problems| self.refusal(problems))? {
            self.changed(change);
            overruled.into_iter().for_each(|why| self.say(why));
        }
        Ok(())
    }

    /// Why an edit is refused, with its place as people write it.
    fn refusal(&self, problems: Vec<Problem>) -> String {
        first(&problems.iter().map(|problem| address::of_problem(self.document(), problem)).collect::<Vec<_>>())
    }

    /// Adapts to a change of the document, and passes it on.
    pub fn changed(&mut self, change: Published) {
        self.memory.finding.follow(&change);
        self.follow_apart(&change);
        self.settle();
        self.ask(Effect::Publish(Box::new(change)));
    }

    /// Shows another node, with the cursor on its first row.
    pub fn show(&mut self, node: impl Into<String>) {
        let node = field::by_name(self.document(), &node.into());
        if node != self.cursor.node {
            self.cursor.unselect();
            (self.cursor.node, self.cursor.row, self.cursor.column) = (node, 0, 0);
            self.ask(Effect::Show);
        }
    }

    /// Moves the cursor to something that exists, after the scene has changed.
    pub fn settle(&mut self) {
        while !self.cursor.node.is_empty() && !field::is_there(self.document(), &self.cursor.node) {
            let parent = Pointer(&self.cursor.node).parent().unwrap_or_default().to_owned();
            self.show(parent);
        }
        let sheet = self.sheet();
        self.cursor.settle(&sheet);
    }

    /// Whether the terminal is too small to draw on.
    pub fn is_small(&self) -> bool {
        !fits(self.size)
    }

    /// The duration and the frames of the animation.
    pub fn timeline(&self) -> &Timeline {
        &self.document().scene().timeline
    }

    /// The state of the animation as it is sent to windows.
    pub fn transport(&self) -> Transport {
        self.play.transport(self.timeline())
    }

    /// Plays or pauses as a window does.
    pub fn follow(&mut self, transport: Transport) {
        let timeline = &self.scene.document().scene().timeline;
        if self.play.follow(transport, timeline) {
            self.ask(Effect::Pass);
        }
    }

    /// Lets so many seconds pass.
    pub fn pass(&mut self, seconds: f64) {
        let timeline = &self.scene.document().scene().timeline;
        match self.play.pass(seconds, timeline) {
            Passed::Nothing => {}
            Passed::On => self.ask(Effect::Pass),
            Passed::End => self.ask(Effect::Show),
        }
    }
}

/// The first problem, and how many more there are.
pub fn first(problems: &[Problem]) -> String {
    let one = problems.first().map(Problem::to_string).unwrap_or_default();
    if problems.len() > 1 { format!("{one} (and {} more)", problems.len() - 1) } else { one }
}
