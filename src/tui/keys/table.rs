//! The table of keys. The bindings, the help, the hints after a first key and docs/keys.md are made from it.

use std::sync::LazyLock;

use crate::base::keys::KeyRow;
use crate::preview::keys as window;

/// In every pane, while nothing is being typed.
pub const EVERYWHERE: &str = "everywhere";
/// The tree of the scene.
pub const TREE: &str = "tree";
/// The middle column: a form or a table.
pub const TABLE: &str = "form and table";
/// A node of the tree whose pictures are picked from a clip.
pub const PICKABLE: &str = "tree, on sprites";
/// The picture, while it shows a clip that pictures are picked from.
pub const PICKING: &str = "picking from a clip";
/// The picture, in the layout for painting on a mesh.
pub const PAINTING: &str = "picture, in the layout for painting";
/// The picture, while what is painted is seen in that layout.
pub const PAINTED: &str = "picture, in painting";
/// The picture, while the cameras of views are seen in that layout.
pub const SELECTING: &str = "picture, in select";
/// The picture, while a layer with strokes is shown.
pub const TURNING: &str = "picture, of strokes";
/// The picture with its cursor.
pub const PICTURE: &str = "picture";
/// The picture's cursor, also while it sets a jump vector or a landing.
pub const MOVING: &str = "moving the picture's cursor";
/// The picture, while its cursor sets a jump vector or a landing.
pub const AIM: &str = "aiming a jump vector or a landing";
/// A list to choose from.
pub const LIST: &str = "list of choices";
/// The palette.
pub const PALETTE: &str = "palette";
/// The help.
pub const HELP: &str = "help";
/// Every pane, while a macro is being recorded.
pub const RECORDING: &str = "recording a macro";
/// Any text being typed.
pub const TYPING: &str = "typing";
/// A terminal that is too small for the panes.
pub const SMALL: &str = "too small a terminal";
/// A value being typed into a cell.
pub const ENTRY: &str = "entry";
/// A number being typed into a cell.
pub const NUMBER: &str = "entry of a number";
/// The command line.
pub const LINE: &str = "command line";

const fn row(context: &'static str, key: &'static str, command: &'static str, help: &'static str) -> KeyRow {
    KeyRow { context, key, command, help }
}

/// Every binding: the editor's own, and after `z` those of the window's view menu.
pub static KEYS: LazyLock<Vec<KeyRow>> = LazyLock::new(|| {
    let view = OWN.iter().position(|row| row.key == "z <").unwrap_or(OWN.len());
    let of_window = OF_WINDOW.iter().map(|[key, command, help]| row(EVERYWHERE, key, command, help));
    OWN[..view].iter().copied().chain(of_window).chain(OWN[view..].iter().copied()).collect()
});

/// The rows of the window's view menu for which the editor has no command of its own: key, line and help.
static OF_WINDOW: LazyLock<Vec<[String; 3]>> = LazyLock::new(|| {
    let made = |row: &KeyRow| [format!("z {}", row.key), format!("view {}", row.command), row.help.to_owned()];
    let rows = window::KEYS.iter().filter(|row| row.context == window::VIEW).map(made);
    rows.filter(|[key, ..]| OWN.iter().all(|own| own.context != EVERYWHERE || own.key != *key)).collect()
});

/// The editor's own bindings.
const OWN: &[KeyRow] = &[
    row(EVERYWHERE, "?", "help", "Show help for what is under the cursor, the keys of this pane, then all others"),
    row(EVERYWHERE, ":", "line", "Type a command"),
    row(EVERYWHERE, "Tab", "pane next", "Go to the next pane"),
    row(EVERYWHERE, "Shift-Tab", "pane previous", "Go to the previous pane"),
    row(EVERYWHERE, "Esc", "back", "End the selection, else running work"),
    row(EVERYWHERE, "Ctrl-c", "leave", "As Esc, and say how to leave"),
    row(EVERYWHERE, "u", "undo", "Undo"),
    row(EVERYWHERE, "Ctrl-r", "redo", "Redo"),
    row(EVERYWHERE, ".", "again", "Repeat the last change here"),
    row(EVERYWHERE, "q {a-z}", "record {a-z}", "Record a macro"),
    row(EVERYWHERE, "@ {a-z}", "play-macro {a-z}", "Play a macro"),
    row(EVERYWHERE, "@ @", "play-macro last", "Play the last macro again"),
    row(EVERYWHERE, "<", "step-size smaller", "Make the step ten times smaller"),
    row(EVERYWHERE, ">", "step-size larger", "Make the step ten times larger"),
    row(EVERYWHERE, "P", "play", "Play or pause"),
    row(EVERYWHERE, "[", "frame previous", "Go one frame back"),
    row(EVERYWHERE, "]", "frame next", "Go one frame forward"),
    row(EVERYWHERE, "{", "frame first", "Go to the first frame"),
    row(EVERYWHERE, "}", "frame last", "Go to the last frame"),
    row(EVERYWHERE, "/", "line /", "Search names and values; a number finds equal numbers"),
    row(EVERYWHERE, "n", "search next", "Go to the next match"),
    row(EVERYWHERE, "N", "search previous", "Go to the previous match"),
    row(EVERYWHERE, "m {a-z}", "mark {a-z}", "Set a mark here"),
    row(EVERYWHERE, "' {a-z}", "jump-mark {a-z}", "Go to a mark"),
    row(EVERYWHERE, "Ctrl-o", "jumps older", "Go back to where the last jump came from"),
    row(EVERYWHERE, "(", "sibling previous", "Go to the same place of the previous item like this one"),
    row(EVERYWHERE, ")", "sibling next", "Go to the same place of the next item like this one"),
    row(EVERYWHERE, "\" {a-z}", "register {a-z}", "Yank into a register next, or paste from it"),
    row(EVERYWHERE, "g g", "move first", "Go to the first row"),
    row(EVERYWHERE, "g o", "jumps newer", "Go forward again along the jumps"),
    row(EVERYWHERE, "G", "move last", "Go to the last row, or to the row of the count"),
    row(EVERYWHERE, "g -", "earlier", "Go to the previous state in time, in whatever branch of undo it is"),
    row(EVERYWHERE, "g a", "flip", "Flip between the snapshot (:snapshot) and the scene as it was before"),
    row(EVERYWHERE, "g +", "later", "Go to the next state in time, in whatever branch of undo it is"),
    row(EVERYWHERE, "g p", "probe", "Open or close the read-out of the pixel under the picture's cursor"),
    row(EVERYWHERE, "g d", "problem next", "Go to the next place where something is wrong"),
    row(EVERYWHERE, "g D", "problem previous", "Go to the previous place where something is wrong"),
    row(EVERYWHERE, "g m", "messages", "Show earlier messages in full"),
    row(EVERYWHERE, "g t", "pane tree", "Go to the tree"),
    row(EVERYWHERE, "g e", "pane table", "Go to the form or table"),
    row(EVERYWHERE, "g i", "pane picture", "Go to the picture"),
    row(EVERYWHERE, "_", "enlarge", "Give the pane that has the focus the whole screen, or show all panes again"),
    row(EVERYWHERE, "z +", "zoom in", "Zoom in, here and in the window"),
    row(EVERYWHERE, "z -", "zoom out", "Zoom out"),
    row(EVERYWHERE, "z f", "zoom fit", "Show the whole picture"),
    row(EVERYWHERE, "z 1", "zoom one", "Show the picture pixel for pixel, here and in the window"),
    row(EVERYWHERE, "z z", "pan cursor", "Show the cursor in the middle of the picture"),
    row(EVERYWHERE, "z h", "pan left", "Show more of the picture on the left"),
    row(EVERYWHERE, "z j", "pan down", "Show more of the picture below"),
    row(EVERYWHERE, "z k", "pan up", "Show more of the picture above"),
    row(EVERYWHERE, "z l", "pan right", "Show more of the picture on the right"),
    row(EVERYWHERE, "z <", "speed slower", "Play slower"),
    row(EVERYWHERE, "z >", "speed faster", "Play faster"),
    row(EVERYWHERE, "Space Space", "palette", "Find a command, a node or a field"),
    row(EVERYWHERE, "Space p", "palette", "Find a command, a node or a field"),
    row(EVERYWHERE, "Space /", "line /", "Search names and values"),
    row(EVERYWHERE, "Space w", "w", "Save"),
    row(EVERYWHERE, "Space x", "wq", "Save and leave"),
    row(EVERYWHERE, "Space q", "q", "Leave"),
    row(EVERYWHERE, "Space v", "view", "Open the preview window"),
    row(EVERYWHERE, "Space r", "line :render", "Start typing :render, for an animation"),
    row(EVERYWHERE, "Space s", "line :synth", "Start typing :synth, for the textures"),
    row(EVERYWHERE, "Space f", "line :field", "Start typing :field, for plots and tables"),
    row(EVERYWHERE, "Space T", "tutor", "Learn the editor, step by step"),
    row(EVERYWHERE, "Space a", "anchor next", "Fix strokes to the next of surface, screen and texture"),
    row(EVERYWHERE, "Space c", "problems", "List what is wrong in the scene; Enter goes there"),
    row(EVERYWHERE, "Space m", "messages", "Show earlier messages in full"),
    row(EVERYWHERE, "Space g", "probe", "Say what the pixel under the picture's cursor does"),
    row(EVERYWHERE, "Space t", "pane tree", "Go to the tree"),
    row(EVERYWHERE, "Space e", "pane table", "Go to the form or table"),
    row(EVERYWHERE, "Space i", "pane picture", "Go to the picture"),
    row(EVERYWHERE, "Space l", "log", "Show the lines of this session"),
    row(EVERYWHERE, "Space k", "keys", "Show your own keys"),
    row(EVERYWHERE, "Space ?", "help", "Show the help"),
    row(EVERYWHERE, "M", "pointer", "Enter the place of the window's pointer, or move the picture's cursor there"),
    row(EVERYWHERE, "Ctrl-l", "redraw", "Redraw the screen"),
    row(EVERYWHERE, "Ctrl-z", "suspend", "Go to the shell (`fg` comes back)"),
    row(SMALL, ":", "line", "Type :q, :wq or :w; nothing else works until the terminal is larger"),
    row(SMALL, "Ctrl-l", "redraw", "Redraw the screen"),
    row(SMALL, "Ctrl-z", "suspend", "Go to the shell (`fg` comes back)"),
    row(RECORDING, "q", "record", "End the macro"),
    row(TREE, "j", "move down", "Go down"),
    row(TREE, "Down", "move down", "Go down"),
    row(TREE, "k", "move up", "Go up"),
    row(TREE, "Up", "move up", "Go up"),
    row(TREE, "h", "collapse", "Collapse the node, else go to its parent"),
    row(TREE, "Left", "collapse", "Collapse the node, else go to its parent"),
    row(TREE, "l", "expand", "Expand the node, else edit it"),
    row(TREE, "Right", "expand", "Expand the node, else edit it"),
    row(TREE, "Enter", "pane table", "Edit the node"),
    row(TREE, "i", "pane table", "Edit the node"),
    row(TREE, "Ctrl-d", "move page-down", "Go half a page down"),
    row(TREE, "Ctrl-u", "move page-up", "Go half a page up"),
    row(TREE, "Backspace", "up", "Go to the parent node"),
    row(TREE, "o", "add", "Add an item to the list, or a node like this one"),
    row(TREE, "d", "delete", "Delete the node"),
    row(TREE, "D", "duplicate", "Duplicate the node"),
    row(TREE, "y", "yank", "Yank the node as JSON, also to the terminal's clipboard"),
    row(TREE, "Y", "yank csv", "Yank the rows of the list as CSV"),
    row(TREE, "p", "paste", "Paste what was yanked into the list, after the node or over it"),
    row(TREE, "R", "rename", "Rename the node"),
    row(TREE, "x", "mute", "Do not show the layer or the zone, or show it again"),
    row(TREE, "s", "solo", "Show only the layer or the zone, or all again"),
    row(TREE, "L", "lock", "Lock the layer or the zone against edits, or unlock it"),
    row(TREE, "J", "reorder down", "Move the node down among its siblings"),
    row(TREE, "K", "reorder up", "Move the node up among its siblings"),
    row(TABLE, "j", "move down", "Go down"),
    row(TABLE, "Down", "move down", "Go down"),
    row(TABLE, "k", "move up", "Go up"),
    row(TABLE, "Up", "move up", "Go up"),
    row(TABLE, "h", "move left", "Go left"),
    row(TABLE, "Left", "move left", "Go left"),
    row(TABLE, "l", "move right", "Go right"),
    row(TABLE, "Right", "move right", "Go right"),
    row(TABLE, "Home", "move start", "Go to the first cell of the row"),
    row(TABLE, "End", "move end", "Go to the last cell of the row"),
    row(TABLE, "Ctrl-d", "move page-down", "Go half a page down"),
    row(TABLE, "Ctrl-u", "move page-up", "Go half a page up"),
    row(TABLE, "Enter", "enter", "Edit the cell, or go into the node"),
    row(TABLE, "i", "enter", "Edit the cell, or go into the node"),
    row(TABLE, "c", "enter clear", "Edit the cell, starting empty"),
    row(TABLE, "Backspace", "up", "Go to the parent node"),
    row(TABLE, "+", "step 1", "Step the number up"),
    row(TABLE, "-", "step -1", "Step the number down"),
    row(TABLE, "v", "select", "Begin or end a selection of rows; an edit applies to all of them"),
    row(TABLE, "V", "select all", "Select all rows"),
    row(TABLE, "%", "select all", "Select all rows"),
    row(TABLE, "g v", "select again", "Select again what was selected last"),
    row(TABLE, "t", "toggle", "Take the row into the selection or out of it, and go to the next"),
    row(TABLE, "~", "invert", "Select the rows that are not selected"),
    row(TABLE, "|", "line :pipe", "Start typing :pipe, for a program that the rows go through as CSV"),
    row(TABLE, "g s", "sort", "Sort the rows by the column under the cursor"),
    row(TABLE, "g S", "sort desc", "The same, the largest first"),
    row(TABLE, "g h", "handles smooth", "Make the handles of the nodes smooth"),
    row(TABLE, "g H", "handles mirrored", "Make both handles of the nodes alike"),
    row(TABLE, "o", "add", "Add an item, or a missing optional node"),
    row(TABLE, "d", "delete", "Delete the row or the selection; a field goes back to its default"),
    row(TABLE, "D", "duplicate", "Duplicate the row or the selection"),
    row(TABLE, "y", "yank", "Yank the row or the selection as JSON, also to the terminal's clipboard"),
    row(TABLE, "Y", "yank csv", "Yank the row or the selection as CSV"),
    row(TABLE, "p", "paste", "Paste what was yanked after the row, into the list or over the field"),
    row(TABLE, "R", "rename", "Rename the row; a picture is renamed everywhere"),
    row(TABLE, "x", "mute", "Do not show the layer or the zone here, or show it again"),
    row(TABLE, "s", "solo", "Show only the layer or the zone here, or all again"),
    row(TABLE, "L", "lock", "Lock the layer or the zone here against edits, or unlock it"),
    row(TABLE, "J", "reorder down", "Move the row or the selection down"),
    row(TABLE, "K", "reorder up", "Move the row or the selection up"),
    row(MOVING, "S p", "snap point", "Move the cursor to the nearest point of the layer"),
    row(MOVING, "S l", "snap line", "Move the cursor to the nearest outline, curve or region"),
    row(MOVING, "S w", "snap whole", "Move the cursor to whole numbers"),
    row(MOVING, "S a", "snap angle", "Move the cursor about the selected point to a multiple of 15°"),
    row(MOVING, "h", "cursor -1 0", "Move the cursor a pixel left"),
    row(MOVING, "Left", "cursor -1 0", "Move the cursor a pixel left"),
    row(MOVING, "j", "cursor 0 1", "Move the cursor a pixel down"),
    row(MOVING, "Down", "cursor 0 1", "Move the cursor a pixel down"),
    row(MOVING, "k", "cursor 0 -1", "Move the cursor a pixel up"),
    row(MOVING, "Up", "cursor 0 -1", "Move the cursor a pixel up"),
    row(MOVING, "l", "cursor 1 0", "Move the cursor a pixel right"),
    row(MOVING, "Right", "cursor 1 0", "Move the cursor a pixel right"),
    row(MOVING, "H", "cursor -10 0", "Move the cursor ten pixels left"),
    row(MOVING, "J", "cursor 0 10", "Move the cursor ten pixels down"),
    row(MOVING, "K", "cursor 0 -10", "Move the cursor ten pixels up"),
    row(MOVING, "L", "cursor 10 0", "Move the cursor ten pixels right"),
    row(TURNING, "r Left", "turn 5", "Turn the strokes of the layer counter-clockwise, by five degrees"),
    row(TURNING, "r Right", "turn -5", "Turn them clockwise"),
    row(TURNING, "r Up", "turn 45", "Turn them by 45 degrees"),
    row(TURNING, "r Down", "turn -45", "Turn them clockwise by 45 degrees"),
    row(PICTURE, "a", "place add", "Add a point here to the list in focus"),
    row(PICTURE, "r", "place move", "Move the selected point here"),
    row(PICTURE, "s", "place aim", "Set the selected point's jump vector, or where it lands: move, then Enter"),
    row(PICTURE, "w", "place next", "Select the next point and go there"),
    row(PICTURE, "b", "place previous", "Select the previous point and go there"),
    row(PICTURE, "d", "delete", "Delete the selected point"),
    row(PICTURE, "+", "zoom in", "Zoom in"),
    row(PICTURE, "-", "zoom out", "Zoom out"),
    row(PICTURE, "0", "zoom fit", "Show the whole picture"),
    row(PICTURE, "Enter", "probe", "Open or close the read-out of the pixel under the cursor"),
    row(PICKABLE, "Enter", "clip show", "Show the clip, to pick sprites from it"),
    row(PICKING, "[", "clip previous", "Go one frame of the clip back"),
    row(PICKING, "]", "clip next", "Go one frame of the clip forward"),
    row(PICKING, "{", "clip first", "Go to the first frame of the clip"),
    row(PICKING, "}", "clip last", "Go to the last frame of the clip"),
    row(PICKING, "a", "pick add", "Pick the square here, in this frame, as a sprite of water"),
    row(PICKING, "A", "pick foam", "Pick it as a sprite of foam"),
    row(PICKING, "r", "pick move", "Move the selected pick here, and to this frame"),
    row(PICKING, "t", "pick track", "Let the selected pick follow what moves, or be a single picture"),
    row(PICKING, "w", "pick next", "Select the next pick, and go there"),
    row(PICKING, "b", "pick previous", "Select the previous pick, and go there"),
    row(PICKING, "z M", "clip cut", "Show what is cut out of the frame, over black, or the frame again"),
    row(PICKING, "z C", "clip sheet", "Show all that is cut out, tracks that hardly move framed, or the frame again"),
    row(PICKING, "Esc", "clip off", "Show the scene again"),
    row(PAINTED, "z )", "layout more", "More of the picture that is painted on, less of what its camera sees"),
    row(PAINTED, "z (", "layout less", "Less of it"),
    row(SELECTING, "a", "sphere add", "Add an extreme point of the selected view here, as far away as its camera"),
    row(SELECTING, "r", "sphere move", "Move the selected extreme point here"),
    row(SELECTING, "s", "sphere blend", "Add a blend point here, which looks where the view looks"),
    row(SELECTING, "Alt-Left", "layout orbit -15 0", "Go round the mesh to the left"),
    row(SELECTING, "Alt-Right", "layout orbit 15 0", "Go round it to the right"),
    row(SELECTING, "Alt-Up", "layout orbit 0 15", "Go up"),
    row(SELECTING, "Alt-Down", "layout orbit 0 -15", "Go down"),
    row(PAINTING, "Tab", "layout next", "From results to the painting, to select, and round"),
    row(PAINTING, "Shift-Tab", "layout previous", "The same the other way"),
    row(PAINTING, "Ctrl-n", "views next", "Paint on the next view"),
    row(PAINTING, "Ctrl-p", "views previous", "Paint on the one before"),
    row(PAINTING, "Esc", "layout usual", "Show all panes as usual"),
    row(AIM, "Enter", "place jump", "End the jump vector, or land, at the cursor"),
    row(AIM, "Esc", "cancel", "Keep the old one"),
    row(AIM, "Ctrl-c", "cancel", "Keep the old one"),
    row(AIM, ":", "line", "Type a command"),
    row(AIM, "?", "help", "Show the help"),
    row(AIM, "Ctrl-l", "redraw", "Redraw the screen"),
    row(AIM, "Ctrl-z", "suspend", "Go to the shell (`fg` comes back)"),
    row(LIST, "j", "choice next", "Go down"),
    row(LIST, "Down", "choice next", "Go down"),
    row(LIST, "k", "choice previous", "Go up"),
    row(LIST, "Up", "choice previous", "Go up"),
    row(LIST, "Enter", "choice take", "Take it"),
    row(LIST, "/", "line /", "Show only what has these letters in it"),
    row(LIST, "Esc", "cancel", "Take nothing"),
    row(LIST, "q", "cancel", "Take nothing"),
    row(LIST, "Ctrl-c", "cancel", "Take nothing"),
    row(LIST, "{a-z}", "choice to {a-z}", "Go to the next word that begins with this letter"),
    row(LIST, "{A-Z}", "choice to {A-Z}", "The same; use it for letters that are keys here"),
    row(PALETTE, "Down", "palette next", "Go down"),
    row(PALETTE, "Ctrl-n", "palette next", "Go down"),
    row(PALETTE, "Tab", "palette next", "Go down"),
    row(PALETTE, "Up", "palette previous", "Go up"),
    row(PALETTE, "Ctrl-p", "palette previous", "Go up"),
    row(PALETTE, "Shift-Tab", "palette previous", "Go up"),
    row(PALETTE, "Enter", "palette take", "Run it, or go there"),
    row(HELP, "j", "scroll 1", "Scroll down"),
    row(HELP, "Down", "scroll 1", "Scroll down"),
    row(HELP, "k", "scroll -1", "Scroll up"),
    row(HELP, "Up", "scroll -1", "Scroll up"),
    row(HELP, "Ctrl-d", "scroll 10", "Scroll ten lines down"),
    row(HELP, "Ctrl-u", "scroll -10", "Scroll ten lines up"),
    row(HELP, "g g", "scroll -100000", "Scroll to the top"),
    row(HELP, "G", "scroll 100000", "Scroll to the end"),
    row(HELP, "/", "line /", "Search in the text"),
    row(HELP, ":", "line :", "Type a command"),
    row(HELP, "n", "scroll next", "Go to the next match"),
    row(HELP, "N", "scroll previous", "Go to the previous match"),
    row(HELP, "Esc", "cancel", "Close the help"),
    row(HELP, "q", "cancel", "Close the help"),
    row(HELP, "?", "cancel", "Close the help"),
    row(HELP, "Ctrl-c", "cancel", "Close the help"),
    row(TYPING, "Left", "text left", "Go left"),
    row(TYPING, "Right", "text right", "Go right"),
    row(TYPING, "Home", "text start", "Go to the start"),
    row(TYPING, "Ctrl-a", "text start", "Go to the start"),
    row(TYPING, "End", "text end", "Go to the end"),
    row(TYPING, "Ctrl-e", "text end", "Go to the end"),
    row(TYPING, "Alt-b", "text word-left", "Go a word left"),
    row(TYPING, "Alt-f", "text word-right", "Go a word right"),
    row(TYPING, "Alt-Left", "text word-left", "Go a word left"),
    row(TYPING, "Ctrl-Left", "text word-left", "Go a word left"),
    row(TYPING, "Alt-Right", "text word-right", "Go a word right"),
    row(TYPING, "Ctrl-Right", "text word-right", "Go a word right"),
    row(TYPING, "Backspace", "text rub", "Delete the character before the cursor"),
    row(TYPING, "Delete", "text delete", "Delete the character under the cursor"),
    row(TYPING, "Ctrl-w", "text rub-word", "Delete the word before the cursor"),
    row(TYPING, "Alt-Backspace", "text rub-word", "Delete the word before the cursor"),
    row(TYPING, "Alt-d", "text delete-word", "Delete the word after the cursor"),
    row(TYPING, "Ctrl-u", "text clear", "Delete everything"),
    row(TYPING, "Esc", "cancel", "Cancel"),
    row(TYPING, "Ctrl-c", "cancel", "Cancel"),
    row(NUMBER, "?", "help put", "Show what can be entered"),
    row(NUMBER, "M", "pointer", "Enter the coordinate of the window's pointer"),
    row(ENTRY, "Enter", "commit", "Enter the value"),
    row(ENTRY, "Tab", "commit next", "Enter the value and edit the next cell"),
    row(ENTRY, "Up", "digit 1", "Step the digit under the cursor up"),
    row(ENTRY, "Down", "digit -1", "Step the digit under the cursor down"),
    row(LINE, "Enter", "run", "Run the command"),
    row(LINE, "Tab", "complete", "Complete the word"),
    row(LINE, "Up", "recall older", "Recall an older line"),
    row(LINE, "Down", "recall newer", "Recall a newer line"),
];
