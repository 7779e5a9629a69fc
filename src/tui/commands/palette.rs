//! The palette and the leader menu: what there is, to be chosen from.

use super::{Call, Command, Done, command, obey};
use crate::tui::document::palette::Palette;
use crate::tui::state::{Mode, State};

pub const COMMANDS: &[Command] = &[
    command("palette", "[next|previous|take]", "Find commands, nodes and fields by a few of their letters", palette)
        .inside()
        .counted_with(&["next", "previous"]),
    command("leader", "[menu]", "Show the keys of the leader menu", |state, _| {
        state.pressed = "Space".into();
        Ok(())
    })
    .inside(),
];

fn palette(state: &mut State, call: &Call) -> Done {
    let Mode::Palette(palette) = &mut state.mode else {
        state.mode = Mode::Palette(Palette::new(state));
        return Ok(());
    };
    match call.text {
        "next" => palette.step(call.times()),
        "previous" => palette.step(-call.times()),
        "take" => {
            let row = palette.row(palette.at);
            state.mode = Mode::Normal;
            if let Some(row) = row {
                return obey(state, &row.line, None);
            }
        }
        _ => {}
    }
    Ok(())
}
