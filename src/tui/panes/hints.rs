//! What the most useful keys of the focused pane do, in the last line while it has nothing else to say. The keys come from the
//! table of keys, so that they are the person's own where those are others.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::write;
use crate::tui::commands::contexts::contexts;
use crate::tui::keys;
use crate::tui::state::{Mode, State};
use crate::tui::text::color;
use crate::tui::text::wrap::width;

/// For each context its most useful commands, each with a word or two.
const HINTS: &[(&str, &[(&str, &str)])] = &[
    (
        keys::TREE,
        &[
            ("pane table", "edit"),
            ("add", "add"),
            ("delete", "delete"),
            ("help", "help"),
            ("line", "command"),
            ("line /", "search"),
            ("undo", "undo"),
            ("play", "play"),
            ("duplicate", "copy"),
        ],
    ),
    (
        keys::TABLE,
        &[
            ("enter", "edit"),
            ("add", "add"),
            ("delete", "delete"),
            ("help", "help"),
            ("line", "command"),
            ("select", "select"),
            ("toggle", "take row"),
            ("undo", "undo"),
            ("step 1", "step"),
            ("pane picture", "picture"),
        ],
    ),
    (
        keys::PICTURE,
        &[
            ("place add", "add"),
            ("place move", "move"),
            ("help", "help"),
            ("enlarge", "enlarge"),
            ("place aim", "aim"),
            ("place next", "next"),
            ("probe", "read out"),
            ("zoom in", "zoom"),
            ("play", "play"),
        ],
    ),
    (
        keys::PICKING,
        &[
            ("pick add", "pick"),
            ("pick foam", "foam"),
            ("pick track", "track"),
            ("clip next", "frame"),
            ("clip off", "scene"),
        ],
    ),
    (
        keys::SELECTING,
        &[
            ("sphere add", "extreme"),
            ("sphere move", "move it"),
            ("sphere blend", "blend"),
            ("layout next", "next view"),
            ("layout orbit 15 0", "round"),
            ("layout usual", "all panes"),
        ],
    ),
    (
        keys::PAINTED,
        &[
            ("layout next", "next view"),
            ("layout more", "more of the picture"),
            ("layout less", "less"),
            ("layout usual", "all panes"),
        ],
    ),
    (keys::PAINTING, &[("layout next", "next view"), ("probe", "read out"), ("layout usual", "all panes")]),
    (keys::AIM, &[("place jump", "take it"), ("cancel", "keep the old one"), ("help", "help")]),
    (
        keys::ENTRY,
        &[
            ("commit", "take it"),
            ("commit next", "next cell"),
            ("digit 1", "step"),
            ("cancel", "keep the old one"),
            ("help put", "what fits"),
        ],
    ),
    (keys::LIST, &[("choice take", "take it"), ("choice next", "down"), ("line /", "narrow"), ("cancel", "nothing")]),
];

/// Draws them as far as they fit.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    if state.is_small() || !matches!(state.typing.mode, Mode::Normal | Mode::Aim | Mode::Entry(_) | Mode::Choice(_)) {
        return;
    }
    let contexts = contexts(state);
    let of = |context: &&str| HINTS.iter().find(|(own, _)| own == context);
    let hints = contexts.iter().find_map(of).map_or(&[] as &[_], |(_, hints)| hints);
    let mut x = 1;
    for (command, word) in hints {
        let rows = state.keymap.rows().iter().filter(|row| row.command == *command && contexts.contains(&row.context));
        // Of several keys the first of the innermost context.
        let inner = |context: &str| contexts.iter().position(|own| *own == context);
        let Some(row) = rows.min_by_key(|row| inner(row.context)) else { continue };
        let key = row.key.replace(' ', "");
        let text = format!("{key} {word}");
        if x + i32::from(width(&text)) + 1 > i32::from(area.width) {
            return;
        }
        write(buffer, area, x, 0, &key, color::strong());
        x = write(buffer, area, x + i32::from(width(&key)) + 1, 0, word, color::faint()) + 3;
    }
}
