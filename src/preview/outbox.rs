//! What one window has still to be told. While it owes an answer, further edits are joined into one patch from revision to
//! revision, and become the scene itself once that is shorter; of everything else only the latest counts. So it stays small
//! however long a window is stuck, and whoever edits never waits.

use std::collections::VecDeque;
use std::io;
use std::sync::Arc;

use super::message::FromEditor;
use crate::scene::Document;
use crate::scene::edit::Edit;

/// A joined patch longer than this, in bytes, goes as the scene itself.
const MAX_PATCH: usize = 64 << 10;

/// The most overlay commands kept for a window that does not read them; the oldest go first.
const MAX_VIEWS: usize = 64;

/// The editor's state, as windows see it.
#[derive(Clone)]
pub(super) struct Latest {
    pub document: Document,
    pub revision: u64,
    pub selection: Option<String>,
    pub playing: bool,
    pub time: f64,
}

/// An edit with its length on the wire, measured once for all windows. `None`: longer than a patch may be.
#[derive(Clone)]
pub(super) struct Measured {
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
enum Change {
    None,
    Joined { edits: Vec<Arc<Edit>>, bytes: usize },
    Whole,
}

/// See the top of the file.
pub(super) struct Outbox {
    /// The revision last sent, and whether its answer is still owed.
    sent: u64,
    owed: bool,
    change: Change,
    selection: bool,
    transport: bool,
    views: VecDeque<String>,
}

/// A message whose costly part (cloning, writing as JSON) is done later, outside any lock.
#[derive(Debug)]
pub(super) enum Outgoing {
    Scene { document: Document, revision: u64 },
    Patch { from_revision: u64, to_revision: u64, edits: Vec<Arc<Edit>> },
    Plain(FromEditor),
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
        }
    }
}

impl Outbox {
    /// For a window that was greeted with the document of this revision, and has everything else to learn.
    pub fn greeted(revision: u64) -> Self {
        let change = Change::None;
        Outbox { sent: revision, owed: true, change, selection: true, transport: true, views: VecDeque::new() }
    }

    /// The document changed by `edit`.
    pub fn edited(&mut self, edit: &Measured) {
        let (mut edits, sum) = match std::mem::replace(&mut self.change, Change::Whole) {
            Change::None => (Vec::new(), edit.bytes),
            Change::Joined { edits, bytes } => (edits, edit.bytes.map(|more| bytes + more)),
            Change::Whole => return,
        };
        if let Some(bytes) = sum.filter(|&bytes| bytes <= MAX_PATCH) {
            edits.push(edit.edit.clone());
            self.change = Change::Joined { edits, bytes };
        }
    }

    /// The window's copy does not fit: it gets the whole document at once.
    pub fn want_scene(&mut self) {
        self.change = Change::Whole;
        self.owed = false;
    }

    /// The window shows this revision. Answers to anything but the last message are late and mean nothing.
    pub fn shown(&mut self, revision: u64) {
        self.owed &= revision != self.sent;
    }

    pub fn selected(&mut self) {
        self.selection = true;
    }

    pub fn transport(&mut self) {
        self.transport = true;
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
            let next = match std::mem::replace(&mut self.change, Change::None) {
                Change::None => None,
                Change::Joined { edits, .. } => Some(Outgoing::Patch { from_revision, to_revision, edits }),
                Change::Whole => Some(Outgoing::Scene { document: latest.document.clone(), revision: to_revision }),
            };
            if next.is_some() {
                (self.sent, self.owed) = (to_revision, true);
                return next;
            }
        }
        if std::mem::take(&mut self.selection) {
            return Some(Outgoing::Plain(FromEditor::Selection(latest.selection.clone())));
        }
        if std::mem::take(&mut self.transport) {
            let (playing, time) = (latest.playing, latest.time);
            return Some(Outgoing::Plain(FromEditor::Transport { playing, time }));
        }
        self.views.pop_front().map(|view| Outgoing::Plain(FromEditor::View(view)))
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    const SCENE: &str = r#"{"plica": 1, "title": ""}"#;

    fn latest(revision: u64) -> Latest {
        Latest { document: Document::parse(SCENE).unwrap(), revision, selection: None, playing: false, time: 0.0 }
    }

    fn edit(length: usize) -> Measured {
        let patch = json!([{"op": "replace", "path": "/title", "value": "x".repeat(length)}]);
        Measured::new(&serde_json::from_value(patch).unwrap())
    }

    fn quiet(revision: u64) -> Outbox {
        Outbox { owed: false, selection: false, transport: false, ..Outbox::greeted(revision) }
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
        let mut outbox = Outbox::greeted(0);
        for i in 0..100_000 {
            outbox.edited(&edit(10));
            outbox.view(&i.to_string());
            outbox.selected();
        }
        assert!(matches!(outbox.change, Change::Whole));
        assert_eq!(outbox.views.len(), MAX_VIEWS);
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
        let mut outbox = Outbox::greeted(3);
        outbox.edited(&edit(1));
        outbox.view("view-field");
        assert_eq!(told(&mut outbox, 4), "Selection(None)");
        assert_eq!(told(&mut outbox, 4), "Transport { playing: false, time: 0.0 }");
        assert_eq!(told(&mut outbox, 4), "view-field");
        assert_eq!(told(&mut outbox, 4), "nothing");
        outbox.shown(3);
        assert_eq!(told(&mut outbox, 4), "1 from 3 to 4");
    }
}
