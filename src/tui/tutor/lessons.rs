//! The lessons as a table. Keys are named by what they run, so that a lesson never shows a key that does something else.

use kurbo::Point;
use serde_json::Value;

use super::has_ended;
use crate::tui::app::{Mode, Pane, State};
use crate::tui::keys::{ENTRY, EVERYWHERE, HELP, Keymap, LINE, LIST, PICTURE, TABLE, TREE, TYPING};

/// A step of the tutor.
#[derive(Debug)]
pub struct Lesson {
    /// What it is about.
    pub title: &'static str,
    /// What is said, a line each of at most 76 characters, three at most.
    pub text: &'static [&'static str],
    /// What to press, from where the lesson before has ended.
    pub keys: &'static [Press],
    /// Whether it was done.
    pub done: fn(&State) -> bool,
}

/// Something to press.
#[derive(Clone, Copy, Debug)]
pub enum Press {
    /// The key that runs a command in a context.
    Key(&'static str, &'static str),
    /// A text to type.
    Text(&'static str),
}

impl Press {
    /// As it is shown: a key by its name, a text in quotes; what no key does is typed as a command.
    pub fn label(self, keymap: &Keymap) -> String {
        match self {
            Key(context, command) => match keymap.key_of(context, command) {
                Some(key) => key.to_owned(),
                None => format!(":{command}"),
            },
            Text(text) => format!("\"{text}\""),
        }
    }
}

use Press::{Key, Text};

/// The zone that all of it is about.
const ZONE: &str = "/layers/0/zones/0";

/// All of them, in order.
pub const LESSONS: &[Lesson] = &[
    Lesson {
        title: "the tree",
        text: &[
            "A picture with one zone: the cat's eye. The scene is the tree on the left.",
            "Go down to \"motion\", the list of what moves in the zone, and into its table.",
        ],
        keys: &[Key(TREE, "move down"), Key(TREE, "move down"), Key(TREE, "pane table")],
        done: |state| state.focus == Pane::Table && state.node.ends_with("/motion"),
    },
    Lesson {
        title: "an anchor",
        text: &[
            "An anchor says where one pixel of the zone goes; what lies between follows.",
            "Add one. It stands in the middle of the zone until you say where.",
        ],
        keys: &[Key(TABLE, "add")],
        done: |state| !anchors(state).is_empty(),
    },
    Lesson {
        title: "numbers",
        text: &[
            "Every number takes what you type. The cursor is on x: 170, then y: 176.",
            "One key takes a value and goes on to the next cell, one takes it and stays.",
        ],
        keys: &[Key(TABLE, "enter"), Text("170"), Key(ENTRY, "commit next"), Text("176"), Key(ENTRY, "commit")],
        done: |state| anchors(state).first().is_some_and(|(at, _)| *at == Point::new(170.0, 176.0)),
    },
    Lesson {
        title: "a jump",
        text: &[
            "dx and dy say how far, and |J| and ° say it again. y grows down, so with",
            "-18 in dy the lid's pixels are read from 18 px above: the lid is seen to",
            "come down.",
        ],
        keys: &[
            Key(TABLE, "move right"),
            Key(TABLE, "move right"),
            Key(TABLE, "enter"),
            Text("-18"),
            Key(ENTRY, "commit"),
        ],
        done: |state| lift(state) == [-18.0],
    },
    Lesson {
        title: "arithmetic",
        text: &[
            "An entry may compute: *2 doubles the old value, +=3 adds to it, w/2 is half",
            "the width of the picture. Double the jump.",
        ],
        keys: &[Key(TABLE, "enter"), Text("*2"), Key(ENTRY, "commit")],
        done: |state| lift(state) == [-36.0],
    },
    Lesson {
        title: "steps",
        text: &[
            "Numbers also step up and down, by what the status line calls the step;",
            "< and > make it ten times smaller or larger. Step dy up once.",
        ],
        keys: &[Key(TABLE, "step 1")],
        done: |state| lift(state) == [-35.0],
    },
    Lesson {
        title: "undo",
        text: &["Everything can be undone, without end, also after saving and coming back.", "Take the step back."],
        keys: &[Key(EVERYWHERE, "undo")],
        done: |state| lift(state) == [-36.0],
    },
    Lesson {
        title: "another anchor",
        text: &["Rows and nodes can be duplicated, deleted and moved.", "Duplicate the anchor."],
        keys: &[Key(TABLE, "duplicate")],
        done: |state| anchors(state).len() == 2,
    },
    Lesson {
        title: "many rows at once",
        text: &[
            "Select both anchors: an edit then applies to each, from its own value.",
            "Halve both jumps, and end the selection.",
        ],
        keys: &[
            Key(TABLE, "select"),
            Key(TABLE, "move up"),
            Key(TABLE, "enter"),
            Text("/2"),
            Key(ENTRY, "commit"),
            Key(EVERYWHERE, "back"),
        ],
        done: |state| lift(state) == [-18.0, -18.0] && state.selected_from.is_none(),
    },
    Lesson {
        title: "placing by eye",
        text: &[
            "Go to the picture and select the next point. Small letters move the cursor",
            "by one pixel, capitals by ten. Move it away, then let the point follow.",
        ],
        keys: &[
            Key(EVERYWHERE, "pane picture"),
            Key(PICTURE, "place next"),
            Key(PICTURE, "cursor 10 0"),
            Key(PICTURE, "cursor 10 0"),
            Key(PICTURE, "cursor 10 0"),
            Key(PICTURE, "place move"),
        ],
        done: |state| matches!(anchors(state)[..], [(a, _), (b, _)] if a.distance(b) >= 10.0),
    },
    Lesson {
        title: "the probe",
        text: &["Why does a pixel move as it does? Ask about the one under the cursor."],
        keys: &[Key(EVERYWHERE, "probe")],
        done: |state| state.seeing.probing,
    },
    Lesson {
        title: "in time",
        text: &[
            "A position function says when the pixels are where along their jumps. Close",
            "the read-out, search for the node, go in, choose cosine: there and back.",
        ],
        keys: &[
            Key(EVERYWHERE, "probe"),
            Key(EVERYWHERE, "pane tree"),
            Key(EVERYWHERE, "line /"),
            Text("position"),
            Key(LINE, "run"),
            Key(TREE, "pane table"),
            Key(TABLE, "enter"),
            Key(LIST, "choice next"),
            Key(LIST, "choice next"),
            Key(LIST, "choice next"),
            Key(LIST, "choice next"),
            Key(LIST, "choice next"),
            Key(LIST, "choice take"),
        ],
        done: |state| value(state, "/position/function") == Some("cosine".into()),
    },
    Lesson {
        title: "playing",
        text: &[
            "Go to the picture, play it, and watch (a window shows it larger).",
            "Then pause, and go on frame by frame.",
        ],
        keys: &[
            Key(EVERYWHERE, "pane picture"),
            Key(EVERYWHERE, "play"),
            Key(EVERYWHERE, "play"),
            Key(EVERYWHERE, "frame next"),
        ],
        done: |state| !state.playing && state.time > 0.0,
    },
    Lesson {
        title: "a fold",
        text: &[
            "Where a jump path meets a fold region, one piece slides under another.",
            "Go to the zone's fold, add it, and take the first rule.",
        ],
        keys: &[
            Key(EVERYWHERE, "pane tree"),
            Key(EVERYWHERE, "line /"),
            Text("fold"),
            Key(LINE, "run"),
            Key(TABLE, "add"),
            Key(LIST, "choice take"),
        ],
        done: |state| value(state, "/fold/rule").is_some(),
    },
    Lesson {
        title: "finding and help",
        text: &[
            "The palette finds every command, node and field by a few letters: look, and",
            "leave it. All keys of the pane you are in are one key away.",
        ],
        keys: &[Key(EVERYWHERE, "palette"), Key(TYPING, "cancel"), Key(EVERYWHERE, "help")],
        done: |state| matches!(state.mode, Mode::Pages(_)),
    },
    Lesson {
        title: "saving",
        text: &[
            "Close the help. The * in the status line says that something is not saved;",
            "it is not lost: each edit is in a journal. The Space menu has Save: use it.",
        ],
        keys: &[Key(HELP, "cancel"), Key(EVERYWHERE, "w")],
        done: |state| state.door.is_saved(),
    },
    Lesson {
        title: "an animation",
        text: &[
            "Commands have the names and arguments of the command line, on this scene.",
            "Render a GIF; the status line shows how far it is (.webp and .png work too).",
        ],
        keys: &[Key(EVERYWHERE, "line"), Text("render -o first.gif"), Key(LINE, "run")],
        done: |state| has_ended(state, "render"),
    },
    Lesson {
        title: "leaving",
        text: &[
            "That is a first animation. :q leaves, and tells you where your files are.",
            "More to look at: `plica demo --list`. More to read: ? and docs/keys.md.",
        ],
        keys: &[Key(EVERYWHERE, "line"), Text("q"), Key(LINE, "run")],
        done: |_| false,
    },
];

/// What stands at `path` of the zone; none where nothing is written.
fn value(state: &State, path: &str) -> Option<Value> {
    state.document().json().pointer(&format!("{ZONE}{path}")).cloned()
}

/// The point anchors of the zone: where they are, and where they jump.
fn anchors(state: &State) -> Vec<(Point, Point)> {
    let motion = value(state, "/motion");
    let items = motion.as_ref().and_then(Value::as_array).map_or(&[] as &[_], Vec::as_slice);
    let point = |item: &Value, key: &str| {
        let part = |i: usize| item.get(key).and_then(|pair| pair.get(i)).and_then(Value::as_f64).unwrap_or(0.0);
        Point::new(part(0), part(1))
    };
    let points = items.iter().filter(|item| item.get("tool").is_some_and(|tool| tool == "point"));
    points.map(|item| (point(item, "at"), point(item, "jump"))).collect()
}

/// The dy of all anchors.
fn lift(state: &State) -> Vec<f64> {
    anchors(state).iter().map(|(_, jump)| jump.y).collect()
}
