//! The layout for painting on a mesh: results, painting and select, one at a time and large.

use super::command::{Call, Command, Done, command};
use crate::tui::layout::picture;
use crate::tui::state::painting::{self, ALL, Painting, Sees};
use crate::tui::state::{Pane, State};
use crate::tui::text::plain;

pub const COMMANDS: &[Command] = &[command(
    "layout",
    "paint|usual|results|painting|select|next|previous|more|less|orbit X Y",
    "Show results, the painting and the cameras of views large, one after the other, or all panes as usual",
    layout,
)];

/// How much more or less of a picture is shown by one step.
const STEP: f64 = 0.125;

fn layout(state: &mut State, call: &Call) -> Done {
    if call.text == "usual" {
        state.picture.painting = None;
        return shown(state);
    }
    let (layer, index, name) =
        painting::current(state).ok_or("no picture lies on a mesh yet: :views add NAME lays one")?;
    let known = state.picture.painting;
    let now = known.unwrap_or_default();
    let step = |by: i64| {
        let at = ALL.iter().position(|sees| *sees == now.sees).unwrap_or(0) as i64;
        ALL[(at + by).rem_euclid(ALL.len() as i64) as usize]
    };
    let share = |by: f64| (now.share + by * STEP).clamp(0.0, 1.0);
    let to = match call.text {
        "paint" if known.is_none() => Painting::default(),
        "paint" | "results" => Painting { sees: Sees::Results, ..now },
        "painting" => Painting { sees: Sees::Painting, ..now },
        "select" => Painting { sees: Sees::Select, ..now },
        "next" => Painting { sees: step(1), ..now },
        "previous" => Painting { sees: step(-1), ..now },
        "more" => Painting { sees: Sees::Painting, share: share(1.0), ..now },
        "less" => Painting { sees: Sees::Painting, share: share(-1.0), ..now },
        text => {
            let by = text.strip_prefix("orbit ").and_then(|by| by.split_once(' '));
            let by = by.and_then(|(x, y)| Some((x.parse::<f64>().ok()?, y.parse::<f64>().ok()?)));
            let (x, y) = by.ok_or(
                "layout takes paint, usual, results, painting, select, next, previous, more, less or orbit X Y",
            )?;
            let (right, up) = now.around;
            let around = ((right + x).rem_euclid(360.0), (up + y).clamp(-180.0, 180.0));
            Painting { sees: Sees::Select, around, ..now }
        }
    };
    state.picture.painting = Some(to);
    state.cursor.focus = Pane::Picture;
    let is_there = state
        .picture
        .synth
        .as_ref()
        .is_some_and(|synth| synth.layers.get(layer).is_some_and(|made| made.laid_px(index).is_some()));
    if to.sees == Sees::Painting && !is_there {
        state.say(format!("{} is shown once it is active and the picture is made", plain(&name)));
    }
    shown(state)
}

/// Shows what is to be seen now.
fn shown(state: &mut State) -> Done {
    painting::follow(state);
    picture::settle(state);
    Ok(())
}
