//! The table of lessons. Keys are given by the commands that they run, so that a lesson never shows the wrong key.

use serde_json::Value;

use crate::tui::keys::{ENTRY, EVERYWHERE, HELP, Keymap, LINE, LIST, TABLE, TREE, TYPING};
use crate::tui::state::{Mode, Pane, State};

/// A step of the tutor.
#[derive(Debug)]
pub struct Lesson {
    /// What it is about.
    pub title: &'static str,
    /// The text: at most three lines of at most 76 characters.
    pub text: &'static [&'static str],
    /// What to press, starting from where the previous lesson ended.
    pub keys: &'static [Press],
    /// Whether the state shows that it was done.
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
    /// How it is shown: a key by its name, a text in quotes; a command that no key runs as typed after `:`.
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

/// The zone that the lessons are about. By name, because a zone before it is deleted on the way.
const ZONE: &str = "lid";

/// All of them, in order.
pub const LESSONS: &[Lesson] = &[
    Lesson {
        title: "the tree",
        text: &[
            "A cat's eye: its lid, and its opening. The tree on the left is the scene; a",
            "search goes to a place. A curve along the lower lid has jumps: go into them.",
        ],
        keys: &[
            Key(TREE, "move down"),
            Key(EVERYWHERE, "line /"),
            Text("jumps"),
            Key(LINE, "run"),
            Key(TREE, "pane table"),
        ],
        done: |state| state.cursor.focus == Pane::Table && state.cursor.node.ends_with("/motion/0/jumps"),
    },
    Lesson {
        title: "a jump",
        text: &[
            "Along the curve, from 0 to 1, dx and dy say from how far a pixel is read in",
            "the end. y grows downward: with -19 in dy it is read from 19 px above: the",
            "lid comes down. The middle has no jump yet: give it one.",
        ],
        keys: &[
            Key(TABLE, "move down"),
            Key(TABLE, "move down"),
            Key(TABLE, "move right"),
            Key(TABLE, "move right"),
            Key(TABLE, "enter"),
            Text("-19"),
            Key(ENTRY, "commit"),
        ],
        done: |state| rise(state).get(2) == Some(&-19.0),
    },
    Lesson {
        title: "arithmetic",
        text: &[
            "An entry can compute: *2 doubles the old value, +=3 adds to it, w/2 is half",
            "the width of the picture. Double the jump.",
        ],
        keys: &[Key(TABLE, "enter"), Text("*2"), Key(ENTRY, "commit")],
        done: |state| rise(state).get(2) == Some(&-38.0),
    },
    Lesson {
        title: "steps",
        text: &[
            "Numbers also step up and down, by the step that the status line shows;",
            "< and > make it ten times smaller or larger. Step dy up once.",
        ],
        keys: &[Key(TABLE, "step 1")],
        done: |state| rise(state).get(2) == Some(&-37.0),
    },
    Lesson {
        title: "undo",
        text: &[
            "Everything can be undone, as far back as you like, even after saving and",
            "coming back. Take the step back.",
        ],
        keys: &[Key(EVERYWHERE, "undo")],
        done: |state| rise(state).get(2) == Some(&-38.0),
    },
    Lesson {
        title: "many rows at once",
        text: &[
            "Select all rows: an edit then applies to each of them, from its own value.",
            "Double all jumps, so that the eye will close, and end the selection.",
        ],
        keys: &[
            Key(TABLE, "select all"),
            Key(TABLE, "enter"),
            Text("*2"),
            Key(ENTRY, "commit"),
            Key(EVERYWHERE, "back"),
        ],
        done: |state| rise(state) == [-8.0, -56.0, -76.0, -64.0, -24.0] && state.cursor.selected_from.is_none(),
    },
    Lesson {
        title: "the probe",
        text: &[
            "Why does a pixel move as it does? A command, typed after :, puts the cursor",
            "of the picture into the eye. Ask about the pixel under it.",
        ],
        keys: &[Key(EVERYWHERE, "line"), Text("cursor at 170.5 205.5"), Key(LINE, "run"), Key(EVERYWHERE, "probe")],
        done: |state| state.picture.probing,
    },
    Lesson {
        title: "in time",
        text: &[
            "A position function says where on their jumps the pixels are at each time.",
            "Close the read-out, find the node, go in, choose cosine: there and back.",
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
            "Go to the picture, play it, watch (a window shows it larger). The eyeball",
            "comes down with the lid: we fix that next. Pause, and go to the next frame.",
        ],
        keys: &[
            Key(EVERYWHERE, "pane picture"),
            Key(EVERYWHERE, "play"),
            Key(EVERYWHERE, "play"),
            Key(EVERYWHERE, "frame next"),
        ],
        done: |state| !state.play.playing && state.play.time > 0.0,
    },
    Lesson {
        title: "one line, three uses",
        text: &[
            "The lower lid is the curve, the lower edge of the lid's outline, and that of",
            "the eye's opening. The opening is needed once more: yank its outline.",
        ],
        keys: &[
            Key(EVERYWHERE, "pane tree"),
            Key(EVERYWHERE, "line /"),
            Text("opening"),
            Key(LINE, "run"),
            Key(TREE, "move down"),
            Key(TREE, "yank"),
        ],
        done: |state| state.memory.yanked.as_ref().is_some_and(|yanked| yanked.value["kind"] == "path"),
    },
    Lesson {
        title: "a fold",
        text: &[
            "Under a fold a pixel keeps its own color until its path meets the edge of a",
            "region: so the lid slides over the eyeball. Go to the lid's fold, add it,",
            "and take the first rule.",
        ],
        keys: &[
            Key(EVERYWHERE, "line /"),
            Text("lid"),
            Key(LINE, "run"),
            Key(EVERYWHERE, "line /"),
            Text("fold"),
            Key(LINE, "run"),
            Key(TREE, "add"),
            Key(LIST, "choice take"),
        ],
        done: |state| value(state, "/fold/rule").is_some(),
    },
    Lesson {
        title: "its region",
        text: &[
            "It starts with a rectangle, which we do not need. Go into the regions, paste",
            "the outline after it, and delete the rectangle.",
        ],
        keys: &[
            Key(EVERYWHERE, "line /"),
            Text("regions"),
            Key(LINE, "run"),
            Key(TREE, "pane table"),
            Key(TABLE, "paste"),
            Key(TABLE, "move up"),
            Key(TABLE, "delete"),
        ],
        done: |state| {
            let regions = value(state, "/fold/regions");
            let regions = regions.as_ref().and_then(Value::as_array).map_or(&[] as &[_], Vec::as_slice);
            matches!(regions, [one] if one["kind"] == "path")
        },
    },
    Lesson {
        title: "tidying",
        text: &[
            "The zone with the opening has done its work, and nothing moves in it.",
            "Find it and delete it: undo would bring it back.",
        ],
        keys: &[
            Key(EVERYWHERE, "pane tree"),
            Key(EVERYWHERE, "line /"),
            Text("opening"),
            Key(LINE, "run"),
            Key(TREE, "delete"),
        ],
        done: |state| zones(state).len() == 1,
    },
    Lesson {
        title: "finding and help",
        text: &[
            "The palette finds every command, node and field by a few letters. Open it,",
            "and close it. One key shows all keys of the pane that you are in.",
        ],
        keys: &[Key(EVERYWHERE, "palette"), Key(TYPING, "cancel"), Key(EVERYWHERE, "help")],
        done: |state| matches!(state.typing.mode, Mode::Pages(_)),
    },
    Lesson {
        title: "saving",
        text: &[
            "Close the help. The * in the status line says that something is not saved.",
            "It is not lost: each edit is in a journal. The Space menu has Save: use it.",
        ],
        keys: &[Key(HELP, "cancel"), Key(EVERYWHERE, "w")],
        done: |state| state.scene.is_saved(),
    },
    Lesson {
        title: "an animation",
        text: &[
            "Commands of the command line work here, with the same arguments.",
            "Render a GIF; the status line shows the progress (.webp and .png work too).",
        ],
        keys: &[Key(EVERYWHERE, "line"), Text("render -o first.gif"), Key(LINE, "run")],
        done: |state| state.tutor.as_ref().is_some_and(|tutor| tutor.has_ended("render")),
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

/// The zones of the scene.
fn zones(state: &State) -> &[Value] {
    let zones = state.document().json().pointer("/layers/0/zones").and_then(Value::as_array);
    zones.map_or(&[], Vec::as_slice)
}

/// The value at `path` of the zone; `None` if nothing is written there.
fn value(state: &State, path: &str) -> Option<Value> {
    zones(state).iter().find(|zone| zone["name"] == ZONE)?.pointer(path).cloned()
}

/// The dy of the jumps along the lid line.
fn rise(state: &State) -> Vec<f64> {
    let jumps = value(state, "/motion/0/jumps");
    let jumps = jumps.as_ref().and_then(Value::as_array).map_or(&[] as &[_], Vec::as_slice);
    jumps.iter().map(|jump| jump["jump"][1].as_f64().unwrap_or(0.0)).collect()
}
