//! The picture's cursor, and what it places.

use kurbo::{Point, Vec2};
use serde_json::{Value, json};

use super::command::{Call, Command, Done, command};
use super::items::go_to;
use super::transforming::numbers;
use crate::base::number::rounded;
use crate::base::pointer::Pointer;
use crate::base::problem::quoted;
use crate::base::text::hex;
use crate::render::{cpu, overlay, passes};
use crate::scene::{Edit, address, grips};
use crate::tui::events::Effect;
use crate::tui::layout::picture;
use crate::tui::state::memory::Yanked;
use crate::tui::state::painting::Sees;
use crate::tui::state::{Mode, Pane, State, entry, place, spatial};
use crate::tui::text::numbers::short;
use crate::tui::text::said::one_word;

pub const COMMANDS: &[Command] = &[
    command("cursor", "[at] X Y", "Move the picture's cursor by X Y, or to a place", cursor).counted(),
    command("place", "add|move|aim|jump|next|previous", "Place points with the picture's cursor", placed)
        .change()
        // In space a place is only known in a frame of a known size.
        .awaiting(|state, _| state.picture.size.is_none())
        .counted_with(&["next", "previous"]),
    command(
        "pointer",
        "[mark|select|copy|take POINTER|drag POINTER|undrag|drop POINTER|file PATH|band X Y X Y]",
        "Enter the place of the window's pointer, or move the picture's cursor or something else there",
        pointer,
    )
    .inside(),
];

/// An anchor is picked within this distance, as a share of the picture's longer side.
const PICK_REACH: f64 = 0.02;

fn cursor(state: &mut State, call: &Call) -> Done {
    let (place, text) = call.text.strip_prefix("at ").map_or((false, call.text), |text| (true, text));
    let [x, y] = numbers(state, text.split_whitespace())?[..] else {
        return Err(format!("cursor takes X Y, or at X Y, not {}", quoted(call.text)));
    };
    if place && call.count.is_some() {
        return Err("cursor at takes no count".into());
    }
    let to =
        if place { Vec2::new(x, y) - state.picture.cursor.to_vec2() } else { Vec2::new(x, y) * call.times() as f64 };
    state.picture.step(to);
    picture::settle(state);
    Ok(())
}

fn placed(state: &mut State, call: &Call) -> Done {
    if picture::sees(state) != Sees::Results {
        return Err(
            "things are placed in the results (:layout results), and points of views in select (:layout select)".into(),
        );
    }
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
            match spatial::aim_from(state)? {
                Some(from) => {
                    state.picture.cursor = from;
                    picture::settle(state);
                    state.ask(Effect::Show);
                }
                None => _ = place::aim_here(state)?,
            }
            state.typing.mode = Mode::Aim;
            Ok(())
        }
        "jump" => {
            let edit = place::aim_here(state)?;
            state.edit(edit, false)?;
            state.typing.mode = Mode::Normal;
            Ok(())
        }
        way => {
            let by = if way == "previous" { -call.times() } else { call.times() };
            let (row, at) = place::next_point(state, by).ok_or("no row here has a place")?;
            state.cursor.row = row;
            state.settle();
            state.picture.cursor = at;
            picture::settle(state);
            state.ask(Effect::Show);
            Ok(())
        }
    }
}

/// The fields, and their values, with which what a window drags goes to where its pointer is.
fn dragged_to(state: &State, dragged: &str) -> Result<Vec<(String, Value)>, String> {
    let (x, y) = state.outside.pointer.ok_or(BESIDE)?;
    match grips::dragged(state.document(), dragged, (x, y).into()) {
        Some(set) => Ok(set),
        None => Ok(vec![spatial::dropped(state, dragged)?]),
    }
}

/// A drag of a window goes on: what it drags is where the pointer is. All of a drag is one step of undo.
fn dragged(state: &mut State, call: &Call, dragged: &str) -> Done {
    idle(state)?;
    let set = dragged_to(state, dragged)?;
    if state.outside.dragged.as_ref().is_none_or(|(pointer, _)| pointer != dragged) {
        set.first().map_or(Ok(()), |(pointer, _)| call.obey(state, &format!("go {pointer}")))?;
        state.scene.close_step();
        state.outside.dragged = Some((dragged.to_owned(), state.scene.revision()));
    }
    let edit = Edit::all(set.into_iter().map(|(pointer, value)| Edit::set(state.document(), &pointer, value)));
    state.edit(edit, true)
}

/// Ends a drag of a window. Its line in the log is what it has set.
fn dropped(state: &mut State, call: &Call, pointer: &str) -> Done {
    dragged(state, call, pointer)?;
    state.outside.dragged = None;
    let set = dragged_to(state, pointer)?.into_iter();
    let set = set.map(|(pointer, value)| format!(" {}={value}", address::address(state.document(), &pointer)));
    call.obey(state, &format!("set{}", set.collect::<String>()))
}

/// Ends a drag of a window as if it had not been.
fn undragged(state: &mut State, call: &Call) -> Done {
    match state.outside.dragged.take() {
        Some((_, revision)) if revision != state.scene.revision() => call.obey(state, "undo"),
        _ => Ok(()),
    }
}

/// Selects what stands within a box that a window's mouse has drawn: rows of the table that is shown, or if none of them has a
/// place, of the list that has what is nearest to the middle of the box.
fn banded(state: &mut State, call: &Call, corners: &str) -> Done {
    idle(state)?;
    let numbers: Vec<f64> = corners.split(' ').filter_map(|number| number.parse().ok()).collect();
    let [x0, y0, x1, y1] = numbers[..] else { return Err("band takes X Y X Y".into()) };
    let sheet = state.sheet();
    let stands = |row| sheet.pointer(row).is_some_and(|pointer| place::seen(state, &pointer).is_some());
    if !(0..sheet.len()).any(stands) {
        let middle = Point::new(f64::midpoint(x0, x1), f64::midpoint(y0, y1));
        let reach_px = Point::new(x0, y0).distance((x1, y1).into()) / 2.0;
        let list = overlay::pick(state.document().scene(), middle, reach_px.max(1.0))
            .and_then(|hit| Pointer(&hit.path).parent().map(str::to_owned));
        list.map_or(Ok(()), |list| call.obey(state, &format!("go {list}")))?;
    }
    call.obey(state, &format!("select within {corners}"))
}

/// Why nothing goes to where a window's pointer is.
const BESIDE: &str = "the window's pointer is not over the picture";

/// A window's mouse changes nothing meanwhile.
fn idle(state: &State) -> Done {
    let is_idle = matches!(state.typing.mode, Mode::Normal);
    if is_idle { Ok(()) } else { Err("something is being typed or chosen: end that first (Esc)".into()) }
}

/// Goes to what is at a place of the picture: an anchor near it, else the zone; else the layer in space that is seen there.
fn select(state: &mut State, call: &Call, at: Point) -> Done {
    idle(state)?;
    let (width, height) = state.picture.size.unwrap_or_default();
    let reach_px = (PICK_REACH * width.max(height) as f64).max(1.0);
    match overlay::pick(state.document().scene(), at, reach_px) {
        Some(hit) => call.obey(state, &format!("go {}{}", hit.path, hit.cell)),
        None => {
            let layer = seen_at(state, at).ok_or("there is nothing to select there")?;
            call.obey(state, &format!("go /layers/{layer}"))
        }
    }
}

/// The layer in space that a window shows at a place of the picture.
fn seen_at(state: &State, at: Point) -> Option<usize> {
    let synth = state.picture.synth.as_ref()?;
    let own = state.outside.camera.clone().map(|camera| synth.seen_from(camera));
    passes::topmost(own.as_ref().unwrap_or(synth), state.play.time, (at.x as usize, at.y as usize))
}

/// Yanks a place of the picture, also to the terminal's clipboard, there with the color that the frame has.
fn copied(state: &mut State, at: Point) -> Done {
    let place = [at.x, at.y].map(|number| rounded(number, 3));
    let (synth, pixel) = (state.picture.synth.as_ref(), (at.x.max(0.0) as usize, at.y.max(0.0) as usize));
    let color = synth.and_then(|synth| cpu::color_at(synth, state.play.time, pixel));
    let color = color.map(|[r, g, b, _]| format!("  #{}", hex(&[r, g, b]))).unwrap_or_default();
    let text = format!("{}, {}{color}", short(place[0]), short(place[1]));
    state.memory.yank(Yanked { value: json!(place), name: None });
    state.ask(Effect::Copy(text.clone()));
    state.say(format!("{text} yanked"));
    Ok(())
}

/// A file that was dropped on a window: a scene is opened as by `:e`, anything else comes into this one with a layer.
fn brought(state: &mut State, call: &Call, path: &str) -> Done {
    idle(state)?;
    let command = if path.ends_with(".json") { "e" } else { "add" };
    call.obey(state, &format!("{command} {}", one_word(path)))
}

/// In an entry, types the coordinate of the window's pointer. Otherwise moves the picture's cursor there, and unless the point
/// is only to be marked, also the point of the row under the cursor, or the end of the jump vector under it.
fn pointer(state: &mut State, call: &Call) -> Done {
    match call.text.split_once(' ').unwrap_or((call.text, "")) {
        ("take", pointer) => return idle(state).and_then(|()| call.obey(state, &format!("go {pointer}"))),
        ("drag", pointer) => return dragged(state, call, pointer),
        ("drop", pointer) => return dropped(state, call, pointer),
        ("undrag", _) => return undragged(state, call),
        ("band", corners) => return banded(state, call, corners),
        ("file", path) => return brought(state, call, path),
        _ => {}
    }
    let (x, y) = state.outside.pointer.ok_or(BESIDE)?;
    if call.text == "copy" {
        return copied(state, (x, y).into());
    }
    if call.text == "select" {
        return select(state, call, (x, y).into());
    }
    if matches!(state.typing.mode, Mode::Entry(_)) {
        return entry::offer(state, (x, y).into());
    }
    call.obey(state, &format!("cursor at {x} {y}"))?;
    match (call.text, state.cursor.focus) {
        ("mark", _) => {
            state.say(format!("marked {}, {}: in the picture (g i), a adds a point there", short(x), short(y)));
            Ok(())
        }
        (_, Pane::Table) => match place::jump_in_focus(state) {
            Some(Vec2 { x: dx, y: dy }) => {
                call.obey(state, "place jump")?;
                state.say(format!("jump {}, {}: it ends at the window's pointer", short(dx), short(dy)));
                Ok(())
            }
            None => call.obey(state, "place move"),
        },
        _ => Ok(()),
    }
}
