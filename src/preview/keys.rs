//! The keys of the window, which are also those of the editor's `z` menu and of playing. In the window `z` may be
//! pressed before a letter of the menu, which it then shows, or left out.

use std::sync::LazyLock;

use crate::base::keys::KeyRow;
use crate::render::overlay::overlays;

/// Playing: the same keys in the editor.
pub const PLAY: &str = "play";
/// The view menu: behind `z` in the editor, direct in the window.
pub const VIEW: &str = "view";
/// The command of a window that connects again at once: answered by whatever follows the scene, not by an editor.
pub const TRY_NOW: &str = "try-now";
/// The command of a window that captures what it shows, with the extension of a file behind it.
pub const CAPTURE: &str = "capture";
/// The window alone.
pub const WINDOW: &str = "window";

const fn row(context: &'static str, key: &'static str, command: &'static str, help: &'static str) -> KeyRow {
    KeyRow { context, key, command, help }
}

/// Every key of the window: its own, and those of the overlays at the head of the view menu.
pub static KEYS: LazyLock<Vec<KeyRow>> = LazyLock::new(|| {
    let (play, own) = OWN.split_at(OWN.iter().take_while(|row| row.context == PLAY).count());
    let overlays = overlays().map(|overlay| row(VIEW, overlay.key, overlay.name, overlay.help));
    play.iter().copied().chain(overlays).chain(own.iter().copied()).collect()
});

/// The keys that no overlay brings.
const OWN: &[KeyRow] = &[
    row(PLAY, "P", "play", "Plays or pauses"),
    row(PLAY, "[", "frame-back", "One frame back"),
    row(PLAY, "]", "frame-on", "One frame on"),
    row(PLAY, "{", "first-frame", "To the first frame"),
    row(PLAY, "}", "last-frame", "To the last frame"),
    row(VIEW, ",", "field-closer", "More of the field and its paths"),
    row(VIEW, ".", "field-wider", "Less of the field and its paths"),
    row(VIEW, "*", "arrows-longer", "Longer arrows"),
    row(VIEW, "/", "arrows-shorter", "Shorter arrows"),
    row(VIEW, "Y", "arrows-equal", "Arrows of one length, or as long as their vectors"),
    row(VIEW, "H", "next-coloring", "Colors of the field: plain, direction, length, divergence, curl"),
    row(VIEW, "U", "next-opacity", "The field more transparent, or opaque again"),
    row(VIEW, "g", "view-grid", "The pixel grid, when large enough"),
    row(VIEW, "s", "view-still", "The still picture, for comparison"),
    row(VIEW, "b", "view-wipe", "Before and after, still on the left"),
    row(VIEW, "(", "wipe-left", "Move the before/after border left"),
    row(VIEW, ")", "wipe-right", "Move the before/after border right"),
    row(VIEW, "w", "view-seam", "The loop's seam, the last frame against the first"),
    row(VIEW, "t", "view-checkerboard", "A checkerboard under transparency"),
    row(VIEW, "E", "view-legends", "Legends of the vector field"),
    row(VIEW, "m", "next-background", "The background of the window: dark, black, gray or light"),
    row(VIEW, "+", "zoom-in", "Larger"),
    row(VIEW, "-", "zoom-out", "Smaller"),
    row(VIEW, "f", "zoom-fit", "Fits the window"),
    row(VIEW, "W", "zoom-whole", "Fits the window by a whole factor"),
    row(VIEW, "1", "zoom-one", "Actual size (1:1)"),
    row(VIEW, "F", "view-full-screen", "The whole screen"),
    row(VIEW, "<", "slower", "Plays slower"),
    row(VIEW, ">", "faster", "Plays faster"),
    row(VIEW, "S", "shot", "A picture of what the window shows, saved beside the scene"),
    row(VIEW, "Z", CAPTURE, "One round of what the window shows, as a GIF beside the scene"),
    row(VIEW, "R", "view-whole-frames", "The display's rate, or the scene's frames only"),
    row(WINDOW, "Left", "pan-left", "Shows more on the left"),
    row(WINDOW, "Right", "pan-right", "Shows more on the right"),
    row(WINDOW, "Up", "pan-up", "Shows more above"),
    row(WINDOW, "Down", "pan-down", "Shows more below"),
    row(WINDOW, "4", "orbit-left", "The window's own camera round to the left; so does a drag with the middle button"),
    row(WINDOW, "6", "orbit-right", "Round to the right"),
    row(WINDOW, "8", "orbit-up", "Round over the top"),
    row(WINDOW, "2", "orbit-down", "Round below"),
    row(WINDOW, "9", "dolly-nearer", "Nearer to what it looks at; so does the wheel with Ctrl or Alt"),
    row(WINDOW, "3", "dolly-farther", "Farther away"),
    row(WINDOW, "h", "walk-left", "Walks to the left; a drag with Shift moves it along"),
    row(WINDOW, "l", "walk-right", "Walks to the right"),
    row(WINDOW, "k", "walk-forward", "Walks forward"),
    row(WINDOW, "j", "walk-back", "Walks back"),
    row(WINDOW, "5", "own-view-all", "All that is in space comes into view, seen from the same side"),
    row(WINDOW, "0", "own-view-off", "The scene's camera again"),
    row(WINDOW, "D", "next-pass", "The next pass that the scene has, from depth on; the frame at the end"),
    row(WINDOW, "Backspace", "previous-pass", "The pass before"),
    row(WINDOW, "Tab", "next-sight", "Painting on a mesh: from results to the painting, to select, and round"),
    row(WINDOW, "F11", "view-full-screen", "The whole screen"),
    row(WINDOW, "Enter", "mark-point", "Marks the pointer's place, for the editor"),
    row(WINDOW, "u", "select-point", "Selects what is under the pointer; so does a click"),
    row(WINDOW, "X", "copy-point", "Copies the pointer's place and the color there: the editor yanks it"),
    row(WINDOW, "Space", PLAY, "Plays or pauses"),
    row(WINDOW, "A", "play-part", "From here on is played, then up to here, then all again"),
    row(WINDOW, "T", TRY_NOW, "Tries at once to connect again"),
    row(WINDOW, "z", "view-menu", "The view menu"),
    row(WINDOW, "?", "help", "These keys, page by page"),
    row(WINDOW, "Esc", "close-panel", "Closes help and problems, leaves the full screen"),
    row(WINDOW, "q", "quit", "Closes the window"),
];

/// Whether a command repeats while its key is held: steps and moves do, a switch would flicker.
pub fn repeats(command: &str) -> bool {
    let steps = [
        "frame-",
        "arrows-longer",
        "arrows-shorter",
        "zoom-in",
        "zoom-out",
        "pan-",
        "wipe-",
        "field-",
        "orbit-",
        "dolly-",
        "walk-",
    ];
    steps.iter().any(|step| command.starts_with(step))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_complete_and_nothing_is_bound_twice() {
        for (i, row) in KEYS.iter().enumerate() {
            assert!(!row.command.is_empty() && !row.help.is_empty() && !row.help.ends_with('.'), "{row:?}");
            assert!(KEYS[i + 1..].iter().all(|r| r.key != row.key), "{row:?}");
        }
    }

    #[test]
    fn only_what_steps_and_moves_goes_on_while_a_key_is_held() {
        let held: Vec<&str> = KEYS.iter().filter(|row| repeats(row.command)).map(|row| row.key).collect();
        let own = ["4", "6", "8", "2", "9", "3", "h", "l", "k", "j"];
        let steps = ["[", "]", ",", ".", "*", "/", "(", ")", "+", "-", "Left", "Right", "Up", "Down"];
        assert_eq!(held, [&steps[..], &own].concat());
    }
}
