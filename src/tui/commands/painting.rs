//! The layout for painting on a mesh: results, painting and select, one at a time and large.

use kurbo::Point;
use serde_json::Value;

use super::command::{Call, Command, Done, command};
use super::items::go_to;
use crate::base::pointer::Pointer;
use crate::layers::parts::shots::Put;
use crate::scene::Edit;
use crate::tui::layout::picture;
use crate::tui::state::painting::{self, ALL, Painting, Sees};
use crate::tui::state::{Pane, State, place};
use crate::tui::text::plain;

pub const COMMANDS: &[Command] = &[
    command(
        "sphere",
        "add|move|blend",
        "In select, put an extreme point or a blend point where the cursor is, as far away as the selected view",
        sphere,
    )
    .change(),
    command(
        "layout",
        "paint|usual|results|painting|select|next|previous|more|less|orbit X Y",
        "Show results, the painting and the cameras of views large, one after the other, or all panes as usual",
        layout,
    ),
];

/// How much more or less of a picture is shown by one step.
const STEP: f64 = 0.125;

fn layout(state: &mut State, call: &Call) -> Done {
    if call.text == "usual" {
        state.picture.painting = None;
        picture::settle(state);
        return Ok(());
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
    picture::settle(state);
    Ok(())
}

fn sphere(state: &mut State, call: &Call) -> Done {
    let what = if call.text == "blend" { Put::Blend } else { Put::Extreme };
    let (path, value) = painting::put(state, what)?;
    let document = state.document();
    let list = document.json().pointer(&path).and_then(Value::as_array).cloned();
    if what == Put::Extreme && list.is_none() {
        let edit = Edit::set(document, &path, value);
        state.edit(edit, false)?;
        state.say("its extremes are points now, where it was gone: r moves the selected one, a adds one");
        let points = place::lists(state.document(), &path);
        go_to(state, &points.first().map_or(path, |points| format!("{points}/0")));
        return Ok(());
    }
    let list = list.unwrap_or_default();
    let focused = state.focused();
    let selected = Pointer(&focused).item_of(&path).map(|(index, _)| index).filter(|index| *index < list.len());
    let (edit, index) = match (call.text, selected) {
        ("move", Some(index)) => (Edit::set(document, &format!("{path}/{index}"), value), index),
        ("move", None) => return Err("no extreme point is selected: go to one, or a adds one".into()),
        (_, after) => {
            let index = if what == Put::Extreme { round(&list, &value) } else { after.map_or(list.len(), |at| at + 1) };
            (Edit::insert(document, &path, index, value), index)
        }
    };
    state.edit(edit, false)?;
    let of = if what == Put::Blend { "blend" } else { "extreme" };
    state.say(format!("{of} point {index} stands here now"));
    go_to(state, &format!("{path}/{index}"));
    Ok(())
}

/// Where a point comes into a list of points that goes round, so that it goes round as shortly as can be.
fn round(list: &[Value], value: &Value) -> usize {
    let at = |value: &Value| {
        let number = |k: usize| value.get(k).and_then(Value::as_f64).unwrap_or_default();
        Point::new(number(0), number(1))
    };
    let longer = |k: usize| {
        let (from, to, new) = (at(&list[k]), at(&list[(k + 1) % list.len()]), at(value));
        from.distance(new) + new.distance(to) - from.distance(to)
    };
    (0..list.len()).min_by(|a, b| longer(*a).total_cmp(&longer(*b))).map_or(0, |k| k + 1)
}
