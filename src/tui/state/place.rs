//! Placing things on the picture with its cursor. What has a place, and which lists take points, is read from the schema.

use crate::base::number;
use crate::base::pointer::Pointer;
use kurbo::{Point, Vec2};
use serde_json::Value;

use super::{State, painting, spatial};
use crate::scene::field::{self, Field, Kind};
use crate::scene::{Document, Edit};
use crate::tui::text::numbers::tidy;

/// Whether a field is a pair of lengths with these names.
fn is_pair(field: &Field, names: [&str; 2]) -> bool {
    field.unit == Some("px") && matches!(&field.kind, Kind::Numbers(all) if *all == names)
}

fn read(document: &Document, pointer: &str) -> Option<Point> {
    let value = field::value(document, pointer)?;
    Some(Point::new(value.get(0)?.as_f64()?, value.get(1)?.as_f64()?))
}

/// Where the place of something is written: as a pair, or as separate x and y.
enum WrittenAt {
    Pair(String),
    Apart(String),
}

/// The place of what is at `pointer`; `None` if it has none.
fn place(document: &Document, pointer: &str) -> Option<(WrittenAt, Point)> {
    let field = field::field(document, pointer)?;
    if is_pair(&field, ["x", "y"]) {
        return read(document, pointer).map(|at| (WrittenAt::Pair(pointer.into()), at));
    }
    if !field.kind.is_object() {
        return None;
    }
    let children = field::children(document, pointer);
    if let Some(child) = children.iter().find(|child| is_pair(&child.field, ["x", "y"])) {
        return read(document, &child.pointer).map(|at| (WrittenAt::Pair(child.pointer.clone()), at));
    }
    let number = |name: &str| field::value(document, &format!("{pointer}/{name}"))?.as_f64();
    Some((WrittenAt::Apart(pointer.into()), Point::new(number("x")?, number("y")?)))
}

/// Where what is at `pointer` is; `None` if it has no place.
pub fn of(document: &Document, pointer: &str) -> Option<Point> {
    place(document, pointer).map(|(_, at)| at)
}

fn move_to(document: &Document, place: &WrittenAt, to: Point) -> Edit {
    let (x, y) = (number::json(tidy(to.x)), number::json(tidy(to.y)));
    match place {
        WrittenAt::Pair(pointer) => Edit::set(document, pointer, Value::from(vec![x, y])),
        WrittenAt::Apart(pointer) => Edit::all(
            [("x", x), ("y", y)].map(|(name, value)| Edit::set(document, &format!("{pointer}/{name}"), value)),
        ),
    }
}

/// What has the focus and a place: the row, or one of its ancestors.
fn placed(state: &State) -> Option<(String, WrittenAt, Point)> {
    let focused = state.focused();
    let document = state.document();
    Pointer(&focused)
        .upward()
        // The size of the frame is no place.
        .filter(|pointer| !pointer.is_empty())
        .find_map(|pointer| place(document, pointer).map(|(place, at)| (pointer.to_string(), place, at)))
}

/// Moves what has the focus to the cursor.
pub fn move_here(state: &State) -> Result<Edit, String> {
    if let Some((pointer, _)) = spatial::selected(state) {
        let moved = spatial::moved(state, state.document(), &pointer);
        return moved.ok_or_else(|| "the camera does not see what is selected".into());
    }
    let (_, place, _) = placed(state).ok_or("what is selected has no place: select a point (w, b)")?;
    Ok(move_to(state.document(), &place, state.picture.cursor))
}

/// The pointer of the cell under the cursor.
fn cell(state: &State) -> Option<String> {
    let row = state.row()?;
    state.cursor.cell(&row).map(|cell| cell.pointer.clone())
}

/// The jump vector that would end at the picture's cursor, if the cell in focus is a jump vector.
pub fn jump_in_focus(state: &State) -> Option<Vec2> {
    let (pointer, _, at) = placed(state)?;
    let cell = cell(state)?;
    let children = field::children(state.document(), &pointer);
    let is_jump = children.iter().any(|child| is_pair(&child.field, ["dx", "dy"]) && child.pointer == cell);
    is_jump.then(|| state.picture.cursor - at)
}

/// Makes the jump vector (or the dragged place) of what has the focus end at the cursor.
pub fn aim_here(state: &State) -> Result<Edit, String> {
    if let Some(edit) = spatial::aim_here(state)? {
        return Ok(edit);
    }
    let document = state.document();
    let (pointer, _, at) = placed(state).ok_or("what is selected has no place: select a point (w, b)")?;
    let children = field::children(document, &pointer);
    let cursor = state.picture.cursor;
    let cell = cell(state);
    let vectors = || children.iter().filter(|child| is_pair(&child.field, ["dx", "dy"]));
    let in_focus = vectors().find(|child| Some(&child.pointer) == cell.as_ref());
    let (target, value) = match in_focus.or_else(|| vectors().next()) {
        Some(jump) => (jump, (cursor - at).to_point()),
        None => {
            let dragged = children.iter().filter(|child| is_pair(&child.field, ["x", "y"])).nth(1);
            (dragged.ok_or("what is selected has no jump vector")?, cursor)
        }
    };
    let value = vec![number::json(tidy(value.x)), number::json(tidy(value.y))];
    Ok(Edit::set(document, &target.pointer, Value::from(value)))
}

/// Adds a point at the cursor to the list in focus; also returns the pointer of the point.
pub fn add_here(state: &State) -> Result<(Edit, String), String> {
    let document = state.document();
    let focused = state.focused();
    let mut inner = None;
    for pointer in Pointer(&focused).upward() {
        let after = inner.replace(pointer).and_then(|child: &str| child[pointer.len() + 1..].parse::<usize>().ok());
        let is_list = field::field(document, pointer).is_some_and(|field| field.kind.is_list());
        let lists = match is_list {
            true => vec![pointer.to_string()],
            false => lists(document, pointer),
        };
        for list in lists {
            let end = document.json().pointer(&list).and_then(Value::as_array).map_or(0, Vec::len);
            let index = if is_list { after.map_or(end, |i| i + 1) } else { end };
            if let Some(added) = add_to(state, &list, index) {
                return Ok(added);
            }
        }
    }
    let views = painting::current(state).map_or("", |_| ", and points of views are put in select (:layout select)");
    Err(format!("no list in focus takes points: go to one that does first{views}"))
}

/// The lists directly inside the node at `pointer`.
pub fn lists(document: &Document, pointer: &str) -> Vec<String> {
    let children = field::children(document, pointer).into_iter();
    children.filter(|child| child.field.kind.is_list()).map(|child| child.pointer).collect()
}

fn add_to(state: &State, list: &str, index: usize) -> Option<(Edit, String)> {
    let insert = |index: usize| {
        let (edit, pointer) = Edit::insert_new(state.document(), list, index)?;
        let with = state.document().apply(&edit).ok()?;
        Some((edit, pointer, with))
    };
    let (edit, pointer, with) = insert(index)?;
    if let Some((place, _)) = place(&with, &pointer) {
        return Some((Edit::all([edit, move_to(&with, &place, state.picture.cursor)]), pointer));
    }
    // A line in space goes on, or bends, where that makes it longer by the least.
    let (_, to) = spatial::under(state, &with, &pointer)?;
    let (edit, pointer, with) = insert(spatial::least_detour(state, list, to))?;
    let moved = spatial::moved(state, &with, &pointer)?;
    Some((Edit::all([edit, moved]), pointer))
}

/// Where what is at `pointer` is in the picture.
pub fn seen(state: &State, pointer: &str) -> Option<Point> {
    let in_space = || spatial::seen(state, spatial::place(state, state.document(), pointer)?.1);
    place(state.document(), pointer).map(|(_, at)| at).or_else(in_space)
}

/// The next (1) or previous (-1) row that has a place: its index and the place.
pub fn next_point(state: &State, by: i64) -> Option<(usize, Point)> {
    let sheet = state.sheet();
    let n = sheet.len() as i64;
    (1..=n).find_map(|step| {
        let row = (state.cursor.row as i64 + by * step).rem_euclid(n) as usize;
        seen(state, &sheet.pointer(row)?).map(|at| (row, at))
    })
}

/// The place of what has the focus, for the marks on the picture.
pub fn selected(state: &State) -> Option<Point> {
    let in_space = || spatial::seen(state, spatial::selected(state)?.1.1);
    placed(state).map(|(_, _, at)| at).or_else(in_space)
}
