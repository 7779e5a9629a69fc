//! Shapes of the scene that outlines, fold regions and curves are made of: made from what is there, used, and copied back.

use std::ops::RangeInclusive;

use serde_json::{Map, Value, json};

use super::command::{Call, Command, Done, command};
use super::items::go_to;
use super::shaping::{LIST, Laid, known, laid};
use crate::base::geometry::point;
use crate::base::pointer::Pointer;
use crate::base::problem::quoted;
use crate::layers::parts::materials::List;
use crate::layers::shapes::shape;
use crate::scene::schema::{Body, Place, Shape};
use crate::scene::{Document, Edit, address};
use crate::tui::state::{Pane, State, first};
use crate::tui::text::plain;
use crate::tui::text::said::{one_word, words};

pub const COMMANDS: &[Command] = &[
    command(
        "share",
        "NAME",
        "Make a shape of the outline, the curve, or the selected nodes here, that others can be made of too",
        share,
    )
    .change(),
    command(
        "use",
        "NAME|y=Y|x=X [reverse] ...",
        "Make the outline or the curve here of shapes; an outline of shapes gets more parts",
        take,
    )
    .change(),
    command("unshare", "", "Copy the shapes of the outline or the curve here back into it", unshare).change(),
];

/// Something that can be made of shapes.
enum Line {
    /// Something that is closed: one of several kinds of it is made of shapes.
    Closed(String, Kinds),
    /// The nodes of a curve.
    Open(String),
}

/// How a closed line is written, by the schema.
#[derive(Clone, Copy)]
struct Kinds {
    /// The field with its kind.
    tag: &'static str,
    /// The kind that is made of shapes, and its list of them.
    shared: (&'static str, &'static str),
    /// The kind that has nodes of its own, and the list of them.
    own: (&'static str, &'static str),
}

impl Kinds {
    /// Those of a place; `None` if it cannot be made of shapes.
    fn of(shape: Shape) -> Option<Kinds> {
        let Body::Tagged(tag) = shape.body() else { return None };
        let lists = |holds: fn(Shape) -> bool| {
            let kinds = shape.choices().filter_map(|(kind, _)| Some((kind, shape.variant(kind)?)));
            let lists = kinds.flat_map(|(kind, variant)| {
                variant.properties(None).into_iter().map(move |(field, shape)| (kind, field, shape))
            });
            let mut lists = lists.filter(|(.., shape)| matches!(shape.body(), Body::List(item, ..) if holds(item)));
            lists.next().map(|(kind, field, _)| (kind, field))
        };
        let shared = lists(|item| item.properties(None).iter().any(|(_, part)| part.reference() == Some(LIST)))?;
        Some(Kinds { tag, shared, own: lists(|item| Some(item.id()) == node().map(Shape::id))? })
    }
}

/// The list of nodes of a shape.
const NODES: &str = "nodes";

/// What the nodes of shapes are, by the schema.
fn node() -> Option<Shape> {
    let Body::Map(shape) = Shape::root().property(None, LIST)?.body() else { return None };
    let Body::List(node, ..) = shape.property(None, NODES)?.body() else { return None };
    Some(node)
}

/// The innermost place around the cursor that can be made of shapes.
fn line(state: &State) -> Result<Line, String> {
    let json = state.document().json();
    let closed = |pointer: &str| Some(Line::Closed(pointer.to_owned(), Kinds::of(Place::of(json, pointer)?.shape)?));
    let around = |pointer: &str| {
        closed(pointer).or_else(|| {
            let place = Place::of(json, pointer)?;
            let mut fields = place.shape.properties(place.value).into_iter();
            let named = fields.find(|(_, shape)| shape.named() == Some(LIST));
            named.map(|(field, _)| Line::Open(Pointer(pointer).join(field)))
        })
    };
    let inside = |pointer: &str| {
        let place = Place::of(json, pointer)?;
        let fields = place.shape.properties(place.value);
        fields.iter().find_map(|(field, _)| closed(&Pointer(pointer).join(field)))
    };
    let found = Pointer(&state.here()).upward().find_map(around);
    let outline = || Pointer(&state.here()).upward().find_map(inside);
    found.or_else(outline).ok_or_else(|| "go to an outline, a fold region or a curve first".into())
}

/// The nodes of a line, as they are written.
fn nodes(document: &Document, line: &Line) -> Result<Vec<Value>, String> {
    let of = |document: &Document, pointer: &str| {
        document.json().pointer(pointer).and_then(Value::as_array).cloned().unwrap_or_default()
    };
    match line {
        Line::Open(pointer) => Ok(of(document, pointer)),
        Line::Closed(pointer, kinds) => {
            let path = document.apply(&Edit::set(document, &Pointer(pointer).join(kinds.tag), kinds.own.0.into()));
            Ok(of(&path.map_err(|problems| first(&problems))?, &Pointer(pointer).join(kinds.own.1)))
        }
    }
}

fn is_shared(document: &Document, line: &Line) -> bool {
    let value = |pointer: &str| document.json().pointer(pointer).and_then(Value::as_str).map(str::to_owned);
    match line {
        Line::Open(pointer) => value(pointer).is_some(),
        Line::Closed(pointer, kinds) => value(&Pointer(pointer).join(kinds.tag)).as_deref() == Some(kinds.shared.0),
    }
}

/// A closed line that is made of these parts, as it is written.
fn of_parts(kinds: &Kinds, parts: Vec<Value>) -> Value {
    let (kind, list) = kinds.shared;
    json!({ kinds.tag: kind, list: parts })
}

/// The edit that makes a line of shapes, one after the other.
fn made_of(document: &Document, line: &Line, names: &[&str]) -> Edit {
    match line {
        Line::Open(pointer) => Edit::set(document, pointer, names.first().copied().unwrap_or_default().into()),
        Line::Closed(pointer, kinds) => {
            let parts = names.iter().map(|name| shape::part(name, false)).collect();
            Edit::set(document, pointer, of_parts(kinds, parts))
        }
    }
}

/// The selected nodes of a path, if rows of its list are selected and not all of them: the first, and how many. A closed path
/// has the first next to the last.
fn selected(state: &State, line: &Line, count: usize) -> Result<Option<(usize, usize)>, String> {
    let list = match line {
        Line::Closed(pointer, kinds) => Pointer(pointer).join(kinds.own.1),
        Line::Open(pointer) => pointer.clone(),
    };
    let sheet = state.sheet();
    let item = |row: usize| Some(Pointer(&sheet.pointer(row)?).item_of(&list)?.0);
    if state.cursor.focus != Pane::Table || !state.cursor.selects() {
        return Ok(None);
    }
    let Some(rows) = state.cursor.rows().into_iter().map(item).collect::<Option<Vec<usize>>>() else { return Ok(None) };
    let many = rows.len();
    if many == count {
        return Ok(None);
    }
    if matches!(line, Line::Open(_)) {
        return Err("a curve is made of one shape as a whole: end the selection (Esc)".into());
    }
    // Where the rows begin, going around.
    let begins: Vec<usize> = rows.iter().copied().filter(|row| !rows.contains(&((row + count - 1) % count))).collect();
    match begins.as_slice() {
        [first] if many > 1 => Ok(Some((*first, many))),
        _ => Err("a shape is made of two nodes or more that are next to each other".into()),
    }
}

fn share(state: &mut State, call: &Call) -> Done {
    let words = words(call.text)?;
    let [name] = words.as_slice() else {
        return Err("share takes a name for the shape, one with spaces in double quotes: :share lid".into());
    };
    let document = state.document();
    if document.scene().names(List::Shapes).contains(name.as_str()) {
        return Err(format!("there is already a shape {}: :use makes this of it", quoted(name)));
    }
    let line = line(state)?;
    if is_shared(document, &line) {
        return Err("this is made of shapes already: :unshare copies them back".into());
    }
    let nodes = nodes(document, &line)?;
    let (shapes, told) = match selected(state, &line, nodes.len())? {
        None => {
            // A closed path goes back to where it began.
            let begin = nodes.first().cloned().filter(|_| matches!(line, Line::Closed(..)));
            (vec![(name.clone(), shape::written(nodes.into_iter().chain(begin).collect()))], String::new())
        }
        Some((from, many)) => {
            let around = |range: RangeInclusive<usize>| range.map(|i| nodes[i % nodes.len()].clone()).collect();
            // The rest goes from the last of these nodes around to the first.
            let (own, rest) = (around(from..=from + many - 1), around(from + many - 1..=from + nodes.len()));
            let other = format!("{name} rest");
            let told = format!(", and what is left of the outline, {}", quoted(&other));
            (vec![(name.clone(), shape::written(own)), (other, shape::written(rest))], told)
        }
    };
    let names: Vec<&str> = shapes.iter().map(|(name, _)| name.as_str()).collect();
    let made = made_of(document, &line, &names);
    let entries: Map<String, Value> = shapes.clone().into_iter().collect();
    let (added, _) =
        Edit::insert_entries(document, &Pointer("").join(LIST), entries).ok_or("there is no list of shapes")?;
    state.edit(Edit::all([added, made]), false)?;
    leave_rows(state, &line);
    let place = address(state, &line);
    state.say(plain(&format!("{place} is made of the shape {} now{told}: :use makes others of it", quoted(name))));
    Ok(())
}

/// Where a line is, for people.
fn address(state: &State, line: &Line) -> String {
    let (Line::Closed(pointer, _) | Line::Open(pointer)) = line;
    address::address(state.document(), pointer)
}

/// The list of nodes is not there any more.
fn leave_rows(state: &mut State, line: &Line) {
    let (Line::Closed(pointer, _) | Line::Open(pointer)) = line;
    state.cursor.unselect();
    go_to(state, pointer);
}

/// A shape that is used, and whether from its end.
type Used<'a> = (&'a str, bool);

/// The shapes in the words of a line, each of which may have `reverse` behind it. One that ends where the one before ends is turned
/// by itself.
fn used<'a>(document: &Document, words: &'a [String]) -> Result<Vec<Used<'a>>, String> {
    const BACK: &str = "reverse";
    let shapes = &document.scene().shapes;
    let ends = |name: &str, reverse: bool| {
        let nodes = &shapes.get(name)?.nodes;
        let ends = (point(nodes.first()?.at), point(nodes.last()?.at));
        Some(if reverse { (ends.1, ends.0) } else { ends })
    };
    let mut used: Vec<Used> = Vec::new();
    for (i, word) in words.iter().enumerate() {
        if word == BACK && i > 0 && words[i - 1] != BACK {
            continue;
        }
        known(document, word)?;
        let is_turned = || {
            let (name, reverse) = *used.last()?;
            let ((_, end), (a, b)) = (ends(name, reverse)?, ends(word, false)?);
            Some(end.distance(b) < end.distance(a))
        };
        let reverse = words.get(i + 1).is_some_and(|next| next == BACK) || is_turned().unwrap_or(false);
        used.push((word, reverse));
    }
    match used.is_empty() {
        false => Ok(used),
        true => {
            Err("use takes names of shapes, those with spaces in double quotes, each with or without reverse".into())
        }
    }
}

fn take(state: &mut State, call: &Call) -> Done {
    let Laid { words, edit: laid, document } = laid(state, words(call.text)?)?;
    let used = used(&document, &words)?;
    if let Some((list, kinds)) = regions(state) {
        return add_region(state, (laid, &document), (&list, &kinds), &used);
    }
    let line = line(state)?;
    let parts: Vec<Value> = used.iter().map(|&(name, reverse)| shape::part(name, reverse)).collect();
    let more = is_shared(&document, &line);
    let edit = match (&line, used.as_slice()) {
        (Line::Open(_), [(name, false)]) => made_of(&document, &line, &[name]),
        (Line::Open(_), _) => return Err("a curve follows one shape, from its beginning to its end".into()),
        (Line::Closed(pointer, kinds), _) if more => {
            let list = Pointer(pointer).join(kinds.shared.1);
            let count = document.json().pointer(&list).and_then(Value::as_array).map_or(0, Vec::len);
            let insert = |(i, part): (usize, Value)| Edit::insert(&document, &list, count + i, part);
            Edit::all(parts.into_iter().enumerate().map(insert))
        }
        (Line::Closed(pointer, kinds), _) => Edit::set(&document, pointer, of_parts(kinds, parts)),
    };
    let done = state.edit(Edit::all([laid, edit]), false);
    done.map_err(|why| match used.len() {
        1 if !more => format!("{why}; an outline of several: :use {} OTHER", one_word(used[0].0)),
        _ => why,
    })?;
    leave_rows(state, &line);
    let told = told(&used);
    let (place, too) = (address(state, &line), if more && matches!(line, Line::Closed(..)) { " too" } else { "" });
    state.say(plain(&format!("{place} is made of {told}{too}")));
    Ok(())
}

fn told(used: &[Used]) -> String {
    let one = |&(name, reverse): &Used| format!("{}{}", quoted(name), if reverse { " reversed" } else { "" });
    used.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// The list of closed lines under the cursor, or of what there may be.
fn regions(state: &State) -> Option<(String, Kinds)> {
    let here = state.here();
    let shape = Place::of(state.document().json(), &here)?.shape;
    let of_list = |shape: Shape| match shape.body() {
        Body::List(item, ..) => Kinds::of(item),
        _ => None,
    };
    let within = |shape: Shape| {
        let kinds = shape.choices().filter_map(|(kind, _)| shape.variant(kind));
        let mut fields = kinds.flat_map(|variant| variant.properties(None));
        fields.find_map(|(field, shape)| Some((Pointer(&here).join(field), of_list(shape)?)))
    };
    match shape.body() {
        Body::Tagged(_) => within(shape),
        _ => of_list(shape).map(|kinds| (here, kinds)),
    }
}

/// Adds a closed line to a list, which may be that of something that is not there yet.
fn add_region(
    state: &mut State,
    (laid, document): (Edit, &Document),
    (list, kinds): (&str, &Kinds),
    used: &[Used],
) -> Done {
    let region = of_parts(kinds, used.iter().map(|&(name, reverse)| shape::part(name, reverse)).collect());
    let holder = Pointer(list).parent().unwrap_or_default();
    let edit = match document.json().pointer(list).and_then(Value::as_array).map(Vec::len) {
        Some(count) => Edit::insert(document, list, count, region),
        None => {
            let begin = Edit::begin(document, holder).ok_or("there is no fold here")?;
            let begun = document.apply(&begin).map_err(|problems| first(&problems))?;
            Edit::all([begin, Edit::set(&begun, list, Value::Array(vec![region]))])
        }
    };
    state.edit(Edit::all([laid, edit]), false)?;
    go_to(state, holder);
    let place = address::address(state.document(), list);
    state.say(plain(&format!("{place} has one that is made of {}", told(used))));
    Ok(())
}

fn unshare(state: &mut State, _: &Call) -> Done {
    let line = line(state)?;
    let document = state.document();
    if !is_shared(document, &line) {
        return Err("this is not made of shapes: :use makes it of one".into());
    }
    let edit = match &line {
        Line::Closed(pointer, kinds) => Edit::set(document, &Pointer(pointer).join(kinds.tag), kinds.own.0.into()),
        Line::Open(pointer) => {
            let name = document.json().pointer(pointer).and_then(Value::as_str).unwrap_or_default();
            let nodes = document
                .json()
                .pointer(&[LIST, name, NODES].iter().fold(String::new(), |at, token| Pointer(&at).join(token)));
            Edit::set(document, pointer, nodes.cloned().unwrap_or_default())
        }
    };
    state.edit(edit, false)?;
    leave_rows(state, &line);
    state.say("it has nodes of its own now");
    Ok(())
}
