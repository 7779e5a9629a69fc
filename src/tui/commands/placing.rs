//! The picture: its cursor, its zoom, and what the cursor places.

use kurbo::Vec2;

use super::items::go_to;
use super::{Call, Command, Done, command, obey};
use crate::tui::app::{Mode, Pane, State};
use crate::tui::numbers::short;
use crate::tui::update::Effect;
use crate::tui::{entry, place, seeing};

pub const COMMANDS: &[Command] = &[
    command("cursor", "[at] X Y", "Move the picture's cursor by X Y, or to a place", cursor),
    command("place", "add|move|aim|jump|next|previous", "Place points with the picture's cursor", placed).change(),
    command("pointer", "[mark]", "Take the window's pointer into the field, else into the picture's cursor", pointer)
        .inside(),
];

fn cursor(state: &mut State, call: &Call) -> Done {
    let (place, text) = call.text.strip_prefix("at ").map_or((false, call.text), |text| (true, text));
    let numbers: Vec<f64> = text.split(' ').filter_map(|number| number.parse().ok()).collect();
    let [x, y] = numbers[..] else { return Err("cursor takes X Y, or at X Y".into()) };
    let to =
        if place { Vec2::new(x, y) - state.placing.cursor.to_vec2() } else { Vec2::new(x, y) * call.times() as f64 };
    state.placing.step(to, state.picture_size);
    seeing::settle(state);
    Ok(())
}

fn placed(state: &mut State, call: &Call) -> Done {
    match call.text {
        "add" => {
            let (edit, pointer) = place::add_here(state)?;
            state.edit(edit, false)?;
            go_to(state, &pointer);
            Ok(())
        }
        "move" => {
            let edit = place::move_here(state)?;
            state.edit(edit, false)
        }
        "aim" => {
            place::aim_here(state)?;
            state.mode = Mode::Aim;
            Ok(())
        }
        "jump" => {
            state.mode = Mode::Normal;
            let edit = place::aim_here(state)?;
            state.edit(edit, false)
        }
        way => {
            let by = if way == "previous" { -call.times() } else { call.times() };
            let (row, at) = place::next_point(state, by).ok_or("no row here has a place")?;
            state.row = row;
            state.settle();
            state.placing.cursor = at;
            seeing::settle(state);
            state.ask(Effect::Show);
            Ok(())
        }
    }
}

/// In an entry the window's pointer gives the field's coordinate; else the picture's cursor goes there, and the row under
/// the cursor where it has a place, unless the point is only marked.
fn pointer(state: &mut State, call: &Call) -> Done {
    let (x, y) = state.seen.pointer.ok_or("the window's pointer is not over the picture")?;
    if matches!(state.mode, Mode::Entry(_)) {
        return entry::offer(state, (x, y).into());
    }
    obey(state, &format!("cursor at {x} {y}"), None)?;
    match (call.text, state.focus) {
        ("mark", _) => {
            state.say(format!("marked {}, {}: in the picture (g i) a adds a point there", short(x), short(y)));
            Ok(())
        }
        (_, Pane::Table) => obey(state, "place move", None),
        _ => Ok(()),
    }
}
