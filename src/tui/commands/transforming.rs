//! Moves, turns, scales, mirrors, aligns and distributes what is selected in the picture, with everything that is in it.

use kurbo::{Affine, Point, Rect, Vec2};

use super::command::{Call, Command, Done, command};
use super::items::targets;
use crate::base::expression::{Variables, evaluate};
use crate::base::maths;
use crate::base::problem::quoted;
use crate::base::text::counted;
use crate::scene::{Edit, address, transform};
use crate::tui::state::State;
use crate::tui::text::numbers::short;
use crate::tui::text::plain;

pub const COMMANDS: &[Command] = &[
    command("translate", "DX DY", "Move what is selected in the picture: rows, a tool, a zone, a layer", translate)
        .change(),
    command(
        "rotate",
        "DEGREES [about X Y|about cursor]",
        "Turn it counter-clockwise, about its middle or a point",
        rotate,
    )
    .change(),
    command(
        "scale",
        "FACTOR [FACTOR_Y] [about X Y|about cursor]",
        "Scale it, with its feather, radius and spacings, about its middle or a point",
        scale,
    )
    .change(),
    command(
        "mirror",
        "x[=X]|y[=Y]|X1 Y1 X2 Y2",
        "Mirror it across an upright or level line, in the middle of the picture if none is given, or across any line",
        mirror,
    )
    .change(),
    command(
        "align",
        "left|center|right|top|middle|bottom",
        "Align the selected things by an edge or by their middles",
        align,
    )
    .change(),
    command("distribute", "x|y", "Move the selected things so that their middles are evenly spaced", distribute)
        .change(),
];

/// What is selected and has a place: where each is, and the box around it.
struct Placed {
    things: Vec<(String, Rect)>,
    /// How many more are selected, without a place.
    others: usize,
}

/// What is selected; of several those that have a place.
fn placed(state: &State, call: &Call) -> Result<Placed, String> {
    let all = targets(state, call)?;
    let (mut things, mut none) = (Vec::with_capacity(all.len()), None);
    let count = all.len();
    for pointer in all {
        match transformed(state, &pointer, Affine::IDENTITY)? {
            Ok((_, rect)) => things.push((pointer, rect)),
            Err(why) => drop(none.get_or_insert(why)),
        }
    }
    match none {
        Some(why) if things.is_empty() => Err(why),
        _ => Ok(Placed { others: count - things.len(), things }),
    }
}

/// A value under a map of the picture, and the box around it before; or why it has no place.
type Transformed = Result<(serde_json::Value, Rect), String>;

/// What is at a place under a map of the picture.
///
/// # Errors
/// It has a place, but cannot be moved.
fn transformed(state: &State, pointer: &str, by: Affine) -> Result<Transformed, String> {
    let document = state.document();
    let name = || match address::told(document, pointer) {
        name if name.is_empty() => "the scene".to_owned(),
        name => plain(&name),
    };
    match transform::transformed(document, pointer, by) {
        Some(Ok(moved)) => Ok(Ok(moved)),
        Some(Err(why)) => Err(format!("{}: {why}", name())),
        None => Ok(Err(format!("{} has no place in a picture: go to a zone, a tool, an outline or points", name()))),
    }
}

/// Maps everything that is selected, each in its own way.
fn apply(state: &mut State, all: &Placed, done: &str, by: impl Fn(usize, Rect) -> Affine) -> Done {
    let edits = all.things.iter().enumerate().map(|(i, (pointer, rect))| {
        let (value, _) = transformed(state, pointer, by(i, *rect))??;
        Ok(Edit::set(state.document(), pointer, value))
    });
    let edit = Edit::all(edits.collect::<Result<Vec<_>, String>>()?);
    state.edit(edit, false)?;
    let others = match all.others {
        0 => String::new(),
        1 => "; 1 row has no place".into(),
        many => format!("; {many} rows have no place"),
    };
    state.say(format!("{} {done}{others}", counted(all.things.len(), "thing")));
    Ok(())
}

/// The numbers of a command's arguments, which may be computed from the width and the height of the picture.
///
/// # Errors
/// A word is no number.
pub(super) fn numbers<'a>(state: &State, words: impl IntoIterator<Item = &'a str>) -> Result<Vec<f64>, String> {
    let (width, height) = state.picture.size.unwrap_or_default();
    let known = [("w", width as f64), ("h", height as f64)];
    let known = if state.picture.size.is_some() { &known[..] } else { &[] };
    let number =
        |word: &str| evaluate(word, &Variables::numbers(known)).map_err(|why| format!("{}: {why}", quoted(word)));
    words.into_iter().map(number).collect()
}

/// The numbers before `about`, and the point after it; else the middle of what is selected.
fn about(state: &State, call: &Call, all: &Placed) -> Result<(Vec<f64>, Point), String> {
    let middle = || all.things.iter().map(|(_, rect)| *rect).reduce(|a, b| a.union(b)).unwrap_or_default().center();
    let mut words = call.text.split([' ', ',']).filter(|word| !word.is_empty());
    let before: Vec<&str> = words.by_ref().take_while(|word| *word != "about").collect();
    let point = match words.collect::<Vec<_>>().as_slice() {
        [] if call.text.ends_with("about") => return Err("about takes X Y or cursor".into()),
        [] => middle(),
        ["cursor"] => state.picture.cursor,
        after => match numbers(state, after.iter().copied())?.as_slice() {
            &[x, y] => Point::new(x, y),
            _ => return Err("about takes X Y or cursor".into()),
        },
    };
    Ok((numbers(state, before)?, point))
}

/// Maps about a point.
fn around(point: Point, by: Affine) -> Affine {
    Affine::translate(point.to_vec2()) * by * Affine::translate(-point.to_vec2())
}

fn told(point: Point) -> String {
    format!("{}, {}", short(point.x), short(point.y))
}

fn translate(state: &mut State, call: &Call) -> Done {
    let by = numbers(state, call.text.split([' ', ',']).filter(|word| !word.is_empty()))?;
    let &[x, y] = by.as_slice() else { return Err("translate takes DX DY, in pixels".into()) };
    let all = placed(state, call)?;
    apply(state, &all, &format!("moved by {}, {}", short(x), short(y)), |_, _| Affine::translate((x, y)))
}

fn rotate(state: &mut State, call: &Call) -> Done {
    let all = placed(state, call)?;
    let (by, point) = about(state, call, &all)?;
    let &[degrees] = by.as_slice() else { return Err("rotate takes DEGREES, counter-clockwise".into()) };
    let (sin, cos) = (maths::sin(degrees.to_radians()), maths::cos(degrees.to_radians()));
    let turn = around(point, Affine::new([cos, -sin, sin, cos, 0.0, 0.0]));
    apply(state, &all, &format!("turned by {}° about {}", short(degrees), told(point)), |_, _| turn)
}

fn scale(state: &mut State, call: &Call) -> Done {
    let all = placed(state, call)?;
    let (by, point) = about(state, call, &all)?;
    let (x, y) = match *by.as_slice() {
        [both] => (both, both),
        [x, y] => (x, y),
        _ => return Err("scale takes one FACTOR, or two: along x and along y".into()),
    };
    if x == 0.0 || y == 0.0 {
        return Err("a factor of 0 would leave nothing".into());
    }
    let by = around(point, Affine::scale_non_uniform(x, y));
    apply(state, &all, &format!("scaled by {}, {} about {}", short(x), short(y), told(point)), |_, _| by)
}

fn mirror(state: &mut State, call: &Call) -> Done {
    let takes = "mirror takes x, x=X, y, y=Y, or X1 Y1 X2 Y2 of a line";
    let text: String = call.text.split_whitespace().collect::<Vec<_>>().join(" ");
    let (name, at) = text.split_once('=').map_or((text.as_str(), None), |(name, at)| (name.trim(), Some(at.trim())));
    let line = |half: &'static str| numbers(state, [at.unwrap_or(half)]).map(|all| all[0]);
    let (from, to) = match name {
        "x" => line("w/2").map(|x| (Point::new(x, 0.0), Point::new(x, 1.0)))?,
        "y" => line("h/2").map(|y| (Point::new(0.0, y), Point::new(1.0, y)))?,
        _ => match numbers(state, text.split([' ', ',']).filter(|word| !word.is_empty())).as_deref() {
            Ok(&[x1, y1, x2, y2]) if (x1, y1) != (x2, y2) => (Point::new(x1, y1), Point::new(x2, y2)),
            _ => return Err(takes.into()),
        },
    };
    let along = (to - from) / (to - from).hypot();
    let (both, square) = (2.0 * along.x * along.y, along.x * along.x - along.y * along.y);
    let by = around(from, Affine::new([square, both, both, -square, 0.0, 0.0]));
    let all = placed(state, call)?;
    apply(state, &all, "mirrored", |_, _| by)
}

/// Several things that are selected.
fn several(state: &State, call: &Call, least: usize) -> Result<Placed, String> {
    let all = placed(state, call)?;
    if all.things.len() < least {
        return Err(format!("{} things or more have to be selected (v, t, :select)", least));
    }
    Ok(all)
}

fn align(state: &mut State, call: &Call) -> Done {
    let all = several(state, call, 2)?;
    let whole = all.things.iter().map(|(_, rect)| *rect).reduce(|a, b| a.union(b)).unwrap_or_default();
    let by = |rect: Rect| match call.text {
        "left" => Vec2::new(whole.x0 - rect.x0, 0.0),
        "right" => Vec2::new(whole.x1 - rect.x1, 0.0),
        "center" => Vec2::new(whole.center().x - rect.center().x, 0.0),
        "top" => Vec2::new(0.0, whole.y0 - rect.y0),
        "bottom" => Vec2::new(0.0, whole.y1 - rect.y1),
        _ => Vec2::new(0.0, whole.center().y - rect.center().y),
    };
    apply(state, &all, "aligned", |_, rect| Affine::translate(by(rect)))
}

fn distribute(state: &mut State, call: &Call) -> Done {
    let all = several(state, call, 3)?;
    let things = &all.things;
    let middle = |rect: Rect| if call.text == "x" { rect.center().x } else { rect.center().y };
    let mut order: Vec<usize> = (0..things.len()).collect();
    order.sort_by(|&a, &b| middle(things[a].1).total_cmp(&middle(things[b].1)));
    let end = |i: Option<&usize>| i.map_or(0.0, |&i| middle(things[i].1));
    let (first, last) = (end(order.first()), end(order.last()));
    let mut ranks = vec![0; things.len()];
    order.iter().enumerate().for_each(|(rank, &i)| ranks[i] = rank);
    let place = |i: usize| ranks[i] as f64 / (things.len() - 1) as f64;
    let by = |i: usize, rect: Rect| {
        let by = maths::lerp(first, last, place(i)) - middle(rect);
        Affine::translate(if call.text == "x" { (by, 0.0) } else { (0.0, by) })
    };
    apply(state, &all, "distributed", by)
}
