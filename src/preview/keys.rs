//! The keys of the window, which are also those of the editor's `z` menu and of playing. In the window `z` may be
//! pressed before a letter of the menu or left out.

use crate::base::keys::KeyRow;

/// Playing: the same keys in the editor.
pub const PLAY: &str = "play";
/// The view menu: behind `z` in the editor, direct in the window.
pub const VIEW: &str = "view";
/// The window alone.
pub const WINDOW: &str = "window";

const fn row(context: &'static str, key: &'static str, command: &'static str, help: &'static str) -> KeyRow {
    KeyRow { context, key, command, help }
}

/// Every key of the window.
pub const KEYS: &[KeyRow] = &[
    row(PLAY, "P", "play", "play or pause"),
    row(PLAY, "[", "frame-back", "one frame back"),
    row(PLAY, "]", "frame-on", "one frame on"),
    row(PLAY, "{", "first-frame", "to the first frame"),
    row(PLAY, "}", "last-frame", "to the last frame"),
    row(VIEW, "o", "view-outlines", "zone outlines"),
    row(VIEW, "r", "view-regions", "fold regions"),
    row(VIEW, "a", "view-anchors", "anchors and their jump vectors"),
    row(VIEW, "c", "view-curves", "curves, lassos and handles"),
    row(VIEW, "v", "view-field", "the vector field"),
    row(VIEW, "n", "view-labels", "names and numbers"),
    row(VIEW, "s", "view-still", "the still picture, for comparison"),
    row(VIEW, "t", "view-checkerboard", "a checkerboard under transparency"),
    row(VIEW, "+", "zoom-in", "larger"),
    row(VIEW, "-", "zoom-out", "smaller"),
    row(VIEW, "f", "zoom-fit", "fit the window"),
    row(VIEW, "1", "zoom-one", "one pixel a pixel"),
    row(WINDOW, "Left", "pan-left", "show more on the left"),
    row(WINDOW, "Right", "pan-right", "show more on the right"),
    row(WINDOW, "Up", "pan-up", "show more above"),
    row(WINDOW, "Down", "pan-down", "show more below"),
    row(WINDOW, "?", "help", "these keys"),
    row(WINDOW, "q", "quit", "close the window"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_complete_and_no_key_is_bound_twice() {
        for (i, row) in KEYS.iter().enumerate() {
            assert!(!row.command.is_empty() && !row.help.is_empty() && !row.help.ends_with('.'), "{row:?}");
            assert!(KEYS[i + 1..].iter().all(|r| r.key != row.key && r.command != row.command), "{row:?}");
        }
    }
}
