//! What one window has still to be told. While it owes an answer, further edits are joined into one patch from revision to
//! revision, and become the scene itself once that is shorter; of everything else only the latest counts. So it stays small
//! however long a window is stuck, and whoever edits never waits.

use std::collections::VecDeque;
use std::io;
use std::mem::{Discriminant, discriminant};
use std::sync::Arc;

use crate::files::originals::Originals;
use crate::preview::Transport;
use crate::preview::views::Views;
use crate::preview::wire::message::FromEditor;
use crate::scene::Document;
use crate::scene::edit::Edit;

/// A joined patch longer than this, in bytes, goes as the scene itself.
const MAX_PATCH: usize = 64 << 10;

/// The most overlay commands kept for a window that does not read them; the oldest go first.
const MAX_VIEWS: usize = 64;

/// The most pieces of files that a window may ask for at a time; what it asks beyond them is not heard.
const MAX_WANTS: usize = 256;

/// Which message it is, whatever it says.
pub(in crate::preview) type Kind = Discriminant<FromEditor>;

/// The editor's state, as windows see it.
#[derive(Clone)]
pub(in crate::preview) struct Latest {
    pub document: Document,
    pub revision: u64,
    /// The files that the scene names, if windows on another machine are served.
    pub originals: Option<Arc<Originals>>,
    views: Views,
    /// Everything else that a new window is told, in this order: of each kind of message the latest.
    said: Vec<FromEditor>,
}

impl Latest {
    /// A document that nothing was done with yet.
    pub fn new(document: Document, revision: u64) -> Latest {
        let said = vec![FromEditor::Selection(None), FromEditor::Transport(Transport::default())];
        Latest { document, revision, originals: None, views: Views::default(), said }
    }

    /// Takes a message of which only the latest counts; returns its kind if it says something new.
    pub fn say(&mut self, message: FromEditor) -> Option<Kind> {
        let kind = discriminant(&message);
        match self.said.iter_mut().find(|said| discriminant(*said) == kind) {
            Some(said) if *said == message => return None,
            Some(said) => *said = message,
            None => self.said.push(message),
        }
        Some(kind)
    }

    /// Takes an overlay or zoom command; returns it as it is to be sent to windows.
    pub fn view(&mut self, command: &str) -> String {
        let told = self.views.take(command);
        self.say(FromEditor::Views(self.views.list()));
        told
    }

    /// Takes the overlay and zoom commands in force where the scene is followed; returns what is to be sent to windows.
    pub fn catch_up(&mut self, commands: &[String]) -> FromEditor {
        self.views.catch_up(commands);
        FromEditor::Views(self.views.list())
    }

    /// The animation has run on to `time`, in seconds, in the windows too.
    pub fn passing(&mut self, time: f64) {
        self.said.iter_mut().for_each(|said| {
            if let FromEditor::Transport(transport) = said {
                transport.time = time;
            }
        });
    }
}

/// An edit with its length on the wire, measured once for all windows. `None`: longer than a patch may be.
#[derive(Clone)]
pub(in crate::preview) struct Measured {
    edit: Arc<Edit>,
    bytes: Option<usize>,
}

impl Measured {
    /// Costs no more than writing 64 KiB, however long the edit is.
    pub fn new(edit: &Edit) -> Self {
        let mut room = Room(MAX_PATCH);
        let fits = serde_json::to_writer(&mut room, edit).is_ok();
        Measured { edit: Arc::new(edit.clone()), bytes: fits.then_some(MAX_PATCH - room.0) }
    }
}

/// Takes bytes and forgets them until there is no room left.
struct Room(usize);

impl io::Write for Room {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 = self.0.checked_sub(bytes.len()).ok_or(io::ErrorKind::StorageFull)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// How the document changed since the window was last told.
enum Pending {
    None,
    Joined { edits: Vec<Arc<Edit>>, bytes: usize },
    Whole,
}

/// See the top of the file.
pub(in crate::preview) struct Outbox {
    /// The revision last sent, and whether its answer is still owed.
    sent: u64,
    owed: bool,
    change: Pending,
    due: VecDeque<Kind>,
    views: VecDeque<String>,
    /// Pieces of files that the window waits for: hash and offset.
    wants: VecDeque<(String, u64)>,
}

/// A message whose costly part (cloning, writing as JSON) is done later, outside any lock.
#[derive(Debug)]
pub(in crate::preview) enum Outgoing {
    Scene { document: Document, revision: u64 },
    Patch { from_revision: u64, to_revision: u64, edits: Vec<Arc<Edit>> },
    Plain(FromEditor),
    Piece { originals: Arc<Originals>, hash: String, offset: u64 },
}

impl Outgoing {
    pub fn into_message(self) -> FromEditor {
        match self {
            Outgoing::Scene { document, revision } => FromEditor::Scene { revision, document: document.json().clone() },
            Outgoing::Patch { from_revision, to_revision, edits } => {
                let operations = edits.iter().flat_map(|edit| edit.0.0.iter().cloned()).collect();
                FromEditor::Patch { from_revision, to_revision, patch: Edit(json_patch::Patch(operations)) }
            }
            Outgoing::Plain(message) => message,
            Outgoing::Piece { originals, hash, offset } => {
                let bytes = originals.piece(&hash, offset);
                FromEditor::Piece { hash, offset, bytes }
            }
        }
    }
}

impl Outbox {
    /// For a window that was greeted with this state's document, and has everything else to learn.
    pub fn greeted(latest: &Latest) -> Self {
        let due = latest.said.iter().map(discriminant).collect();
        let (views, wants) = (VecDeque::new(), VecDeque::new());
        Outbox { sent: latest.revision, owed: true, change: Pending::None, due, views, wants }
    }

    /// The document changed by `edit`.
    pub fn edited(&mut self, edit: &Measured) {
        let (mut edits, sum) = match std::mem::replace(&mut self.change, Pending::Whole) {
            Pending::None => (Vec::new(), edit.bytes),
            Pending::Joined { edits, bytes } => (edits, edit.bytes.map(|more| bytes + more)),
            Pending::Whole => return,
        };
        if let Some(bytes) = sum.filter(|&bytes| bytes <= MAX_PATCH) {
            edits.push(edit.edit.clone());
            self.change = Pending::Joined { edits, bytes };
        }
    }

    /// The window's copy does not fit: it gets the whole document at once.
    pub fn want_scene(&mut self) {
        self.change = Pending::Whole;
        self.owed = false;
    }

    /// The window shows this revision. Answers to anything but the last message are late and mean nothing.
    pub fn shown(&mut self, revision: u64) {
        self.owed &= revision != self.sent;
    }

    /// The latest message of this kind is still to be told.
    pub fn due(&mut self, kind: Kind) {
        if !self.due.contains(&kind) {
            self.due.push_back(kind);
        }
    }

    /// The window asks for a piece of a file.
    pub fn want(&mut self, hash: String, offset: u64) {
        if self.wants.len() < MAX_WANTS {
            self.wants.push_back((hash, offset));
        }
    }

    pub fn view(&mut self, command: &str) {
        if self.views.len() == MAX_VIEWS {
            self.views.pop_front();
        }
        self.views.push_back(command.to_owned());
    }

    /// The next message to send, if any may be sent now.
    pub fn next(&mut self, latest: &Latest) -> Option<Outgoing> {
        if !self.owed {
            let (from_revision, to_revision) = (self.sent, latest.revision);
            let next = match std::mem::replace(&mut self.change, Pending::None) {
                Pending::None => None,
                Pending::Joined { edits, .. } => Some(Outgoing::Patch { from_revision, to_revision, edits }),
                Pending::Whole => Some(Outgoing::Scene { document: latest.document.clone(), revision: to_revision }),
            };
            if next.is_some() {
                (self.sent, self.owed) = (to_revision, true);
                return next;
            }
        }
        while let Some(kind) = self.due.pop_front() {
            let Some(message) = latest.said.iter().find(|said| discriminant(*said) == kind) else { continue };
            if matches!(message, FromEditor::Views(_)) {
                // They are among those in force.
                self.views.clear();
            }
            return Some(Outgoing::Plain(message.clone()));
        }
        if let Some(view) = self.views.pop_front() {
            return Some(Outgoing::Plain(FromEditor::View(view)));
        }
        let originals = latest.originals.clone()?;
        let (hash, offset) = self.wants.pop_front()?;
        Some(Outgoing::Piece { originals, hash, offset })
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    const SCENE: &str = r#"{"plica": 1, "title": ""}"#;

    fn latest(revision: u64) -> Latest {
        Latest::new(Document::parse(SCENE).unwrap(), revision)
    }

    fn edit(length: usize) -> Measured {
        let patch = json!([{"op": "replace", "path": "/title", "value": "x".repeat(length)}]);
        Measured::new(&serde_json::from_value(patch).unwrap())
    }

    fn quiet(revision: u64) -> Outbox {
        Outbox { owed: false, due: VecDeque::new(), ..Outbox::greeted(&latest(revision)) }
    }

    /// What goes out, in one word and its revisions.
    fn told(outbox: &mut Outbox, revision: u64) -> String {
        match outbox.next(&latest(revision)).map(Outgoing::into_message) {
            None => "nothing".into(),
            Some(FromEditor::Patch { from_revision, to_revision, patch }) => {
                format!("{} from {from_revision} to {to_revision}", patch.0.0.len())
            }
            Some(FromEditor::Scene { revision, .. }) => format!("scene {revision}"),
            Some(FromEditor::View(name)) => name,
            Some(other) => format!("{other:?}"),
        }
    }

    #[test]
    fn edits_are_joined_while_an_answer_is_owed() {
        let mut outbox = quiet(0);
        outbox.edited(&edit(1));
        assert_eq!(told(&mut outbox, 1), "1 from 0 to 1");
        for _ in 0..5 {
            outbox.edited(&edit(1));
            assert_eq!(told(&mut outbox, 6), "nothing");
        }
        outbox.shown(0);
        assert_eq!(told(&mut outbox, 6), "nothing", "a late answer");
        outbox.shown(1);
        assert_eq!(told(&mut outbox, 6), "5 from 1 to 6");
        assert_eq!(told(&mut outbox, 6), "nothing");
    }

    #[test]
    fn long_patches_go_as_the_scene() {
        let table: [(&str, &[usize], &str); 4] = [
            ("short ones", &[1000, 1000], "2 from 0 to 9"),
            ("one too long", &[MAX_PATCH], "scene 9"),
            ("together too long", &[40_000, 40_000], "scene 9"),
            ("short after long", &[MAX_PATCH, 1], "scene 9"),
        ];
        for (name, lengths, expected) in table {
            let mut outbox = quiet(0);
            lengths.iter().for_each(|&length| outbox.edited(&edit(length)));
            assert_eq!(told(&mut outbox, 9), expected, "{name}");
        }
    }

    #[test]
    fn a_stuck_window_costs_no_memory() {
        let mut outbox = Outbox::greeted(&latest(0));
        let selection = discriminant(&FromEditor::Selection(None));
        for i in 0..100_000 {
            outbox.edited(&edit(10));
            outbox.view(&i.to_string());
            outbox.due(selection);
        }
        assert!(matches!(outbox.change, Pending::Whole));
        assert_eq!((outbox.views.len(), outbox.due.len()), (MAX_VIEWS, 2));
        assert_eq!(outbox.views.back().unwrap(), "99999");
    }

    #[test]
    fn a_window_that_wants_the_scene_gets_it_though_it_owes_an_answer() {
        let mut outbox = quiet(0);
        outbox.edited(&edit(1));
        told(&mut outbox, 1);
        outbox.edited(&edit(1));
        outbox.want_scene();
        assert_eq!(told(&mut outbox, 2), "scene 2");
        assert_eq!(told(&mut outbox, 2), "nothing");
    }

    #[test]
    fn a_new_window_learns_everything_and_the_rest_waits_for_no_answer() {
        let mut outbox = Outbox::greeted(&latest(3));
        outbox.edited(&edit(1));
        outbox.view("view-field");
        assert_eq!(told(&mut outbox, 4), "Selection(None)");
        assert_eq!(told(&mut outbox, 4), "Transport(Transport { playing: false, time: 0.0, speed: 1.0 })");
        assert_eq!(told(&mut outbox, 4), "view-field");
        assert_eq!(told(&mut outbox, 4), "nothing");
        outbox.shown(3);
        assert_eq!(told(&mut outbox, 4), "1 from 3 to 4");
    }

    #[test]
    fn pieces_of_files_go_last_one_at_a_time() {
        let mut latest = latest(0);
        latest.originals = Some(Arc::default());
        let mut outbox = quiet(0);
        let told = |outbox: &mut Outbox, latest: &Latest| match outbox.next(latest).map(Outgoing::into_message) {
            Some(FromEditor::Piece { offset, .. }) => offset.to_string(),
            Some(FromEditor::Patch { .. }) => "patch".into(),
            Some(FromEditor::Notice(_)) => "notice".into(),
            other => format!("{other:?}"),
        };
        (0..1000).for_each(|offset| outbox.want("a".into(), offset));
        assert_eq!(outbox.wants.len(), MAX_WANTS);
        assert_eq!(told(&mut outbox, &latest), "0");
        outbox.edited(&edit(1));
        latest.say(FromEditor::Notice("a".into())).into_iter().for_each(|kind| outbox.due(kind));
        assert_eq!(["patch", "notice", "1", "2"].map(|_| told(&mut outbox, &latest)), ["patch", "notice", "1", "2"]);
    }

    #[test]
    fn who_joins_late_learns_what_is_in_force() {
        let mut latest = latest(0);
        latest.view("view-field");
        let mut outbox = Outbox::greeted(&latest);
        outbox.view("view-field");
        let all: Vec<_> = std::iter::from_fn(|| outbox.next(&latest)).map(Outgoing::into_message).collect();
        let views = all.iter().filter(|m| matches!(m, FromEditor::View(_) | FromEditor::Views(_))).collect::<Vec<_>>();
        assert_eq!(views, [&FromEditor::Views(vec!["view-field on".into()])], "told once");
    }
}
