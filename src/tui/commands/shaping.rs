//! Shapes laid through points, and curves of a zone's motion along them.

use kurbo::{Point, Vec2};

use super::command::{Call, Command, Done, command};
use super::transforming::numbers;
use crate::base::pointer::Pointer;
use crate::base::problem::{nearest, quoted};
use crate::layers::parts::materials::List;
use crate::layers::shapes::handles::through;
use crate::layers::shapes::node;
use crate::layers::shapes::shape;
use crate::layers::technique::Lead;
use crate::scene::{Document, Edit, address};
use crate::tui::state::{State, first};
use crate::tui::text::numbers::short;
use crate::tui::text::plain;
use crate::tui::text::said::words;

pub const COMMANDS: &[Command] = &[
    command(
        "shape",
        "NAME X,Y X,Y ...|y=Y|x=X",
        "Lay a shape smoothly through points, or straight across the picture, a new one or one that is there",
        lay,
    )
    .change(),
    command(
        "along",
        "NAME|y=Y|x=X [to NAME|by X,Y] ...",
        "Hold the picture still along shapes, in the zone here; or let the samplers go from one to another, or by a vector",
        along,
    )
    .change(),
];

/// The key of the scene's list of shapes.
pub const LIST: &str = "shapes";

fn lay(state: &mut State, call: &Call) -> Done {
    let words = words(call.text)?;
    let usage =
        || "shape takes a name and two points or more: :shape lid 88,212 240,134 396,200, :shape sea y=120".to_owned();
    let (name, places) = words.split_first().ok_or_else(usage)?;
    let points = places.iter().map(|word| points(state, word)).collect::<Result<Vec<_>, String>>()?.concat();
    if points.len() < 2 {
        return Err(usage());
    }
    let document = state.document();
    let is_new = !document.scene().shapes.contains_key(name);
    state.edit(lies(document, name, &points), false)?;
    state.say(plain(&match is_new {
        true => format!("the shape {} is there: :use makes an outline of it, :along what moves", quoted(name)),
        false => format!("the shape {} is laid anew, and all that is made of it", quoted(name)),
    }));
    Ok(())
}

/// A place of the picture, or the ends of a line across it, as they are typed.
fn points(state: &State, word: &str) -> Result<Vec<Point>, String> {
    let Some(ends) = ends(word) else { return Ok(vec![place(state, word)?]) };
    ends.into_iter().map(|at| point(state, at)).collect()
}

/// The ends of a line across the picture, as it is typed.
fn ends(word: &str) -> Option<[[&str; 2]; 2]> {
    match word.split_once('=')? {
        ("y", y) => Some([["0", y], ["w", y]]),
        ("x", x) => Some([[x, "0"], [x, "h"]]),
        _ => None,
    }
}

/// Words of a line with what they name.
pub struct Laid {
    /// The words, with the names of shapes for lines across the picture.
    pub words: Vec<String>,
    /// The edit that lays those of these lines that are no shapes yet.
    pub edit: Edit,
    /// The scene with them.
    pub document: Document,
}

/// Lays the lines across the picture that are among these words: `y=120` is the shape `y120`.
pub fn laid(state: &State, words: Vec<String>) -> Result<Laid, String> {
    let mut laid = Laid { words, edit: Edit::all([]), document: state.document().clone() };
    for word in laid.words.iter_mut().filter(|word| ends(word).is_some()) {
        let points = points(state, word)?;
        let (letter, at) = if word.starts_with('y') { ('y', points[0].y) } else { ('x', points[0].x) };
        let line = std::mem::replace(word, format!("{letter}{}", short(at)));
        let edit = lies(&laid.document, word, &points);
        let with = laid.document.apply(&edit).map_err(|problems| first(&problems))?;
        let shapes = &laid.document.scene().shapes;
        if shapes.get(word) == with.scene().shapes.get(word) {
            continue;
        }
        if shapes.contains_key(word) {
            return Err(format!("the shape {} lies elsewhere: name this line, :shape NAME {line}", quoted(word)));
        }
        (laid.edit, laid.document) = (Edit::all([laid.edit, edit]), with);
    }
    Ok(laid)
}

/// The edit that lays a shape smoothly through points.
fn lies(document: &Document, name: &str, points: &[Point]) -> Edit {
    let nodes = through(points).iter().map(node::written).collect();
    Edit::set(document, &Pointer(&Pointer("").join(LIST)).join(name), shape::written(nodes))
}

/// A place of the picture, as it is typed.
fn place(state: &State, word: &str) -> Result<Point, String> {
    let no_place = || format!("{} is no place of the picture: write it as X,Y, as 88,212", quoted(word));
    let (x, y) = word.split_once(',').ok_or_else(no_place)?;
    point(state, [x, y])
}

fn point(state: &State, at: [&str; 2]) -> Result<Point, String> {
    match numbers(state, at)?.as_slice() {
        &[x, y] => Ok(Point::new(x, y)),
        _ => Err("a place is two numbers".into()),
    }
}

/// Refuses a name that no shape has.
pub fn known(document: &Document, name: &str) -> Done {
    let all = document.scene().names(List::Shapes);
    if all.contains(name) {
        return Ok(());
    }
    let near =
        nearest(name, all.iter().copied()).unwrap_or(":shape lays one, :share makes one of what is there".into());
    Err(format!("there is no shape {} ({near})", quoted(name)))
}

/// Where the samplers along a shape go, as it is typed.
enum Way<'a> {
    Nowhere,
    To(&'a str),
    By(Vec2),
}

/// Each shape in the words of a line, and where the samplers go from there.
fn ways<'a>(state: &State, document: &Document, words: &'a [String]) -> Result<Vec<(&'a str, Way<'a>)>, String> {
    let usage =
        || "along takes names of shapes, and where to from each: :along brow low to lid, :along sea by 6,3".to_owned();
    let (mut ways, mut words) = (Vec::new(), words.iter().map(String::as_str).peekable());
    while let Some(name) = words.next() {
        known(document, name)?;
        let way = match words.next_if(|word| ["to", "by"].contains(word)) {
            None => Way::Nowhere,
            Some("to") => Way::To(words.next().ok_or_else(usage)?),
            Some(_) => Way::By(place(state, words.next().ok_or_else(usage)?)?.to_vec2()),
        };
        if let Way::To(other) = way {
            known(document, other)?;
        }
        ways.push((name, way));
    }
    if ways.is_empty() { Err(usage()) } else { Ok(ways) }
}

fn along(state: &mut State, call: &Call) -> Done {
    let Laid { words, edit: laid, mut document } = laid(state, words(call.text)?)?;
    let ways = ways(state, &document, &words)?;
    let here = state.here();
    let (mut edits, mut told, mut zone) = (vec![laid], Vec::new(), String::new());
    for (name, way) in &ways {
        let (pointer, edit) =
            moved(&document, &here, name, way).ok_or("along is for what moves in a zone: go to one")?;
        document = document.apply(&edit).map_err(|problems| first(&problems))?;
        edits.push(edit);
        zone = Pointer(&pointer).parent().and_then(|list| Pointer(list).parent()).unwrap_or_default().to_owned();
        told.push(match way {
            Way::Nowhere => format!("nothing moves along {}", quoted(name)),
            Way::To(other) => format!("along {} the samplers go to {}", quoted(name), quoted(other)),
            Way::By(by) => format!("along {} the samplers go by {}, {}", quoted(name), short(by.x), short(by.y)),
        });
    }
    state.edit(Edit::all(edits), false)?;
    state.say(plain(&format!("{}: {}", address::address(state.document(), &zone), told.join("; "))));
    Ok(())
}

/// The edit that lets what is at a place of a zone move along a shape, and where it writes; `None` if nothing there moves.
fn moved(document: &Document, here: &str, name: &str, way: &Way) -> Option<(String, Edit)> {
    let nodes = |name: &str| document.scene().shapes.get(name).map_or(&[][..], |shape| &shape.nodes);
    let lead = match way {
        Way::Nowhere => Lead::By(Vec2::ZERO),
        Way::To(other) => Lead::To(nodes(other)),
        Way::By(by) => Lead::By(*by),
    };
    let (index, path) = Pointer(here).item_of("/layers")?;
    let layer = document.scene().layers.get(index)?.technique();
    let (path, curve) = layer.along(path, (name, nodes(name)), lead)?;
    let pointer = format!("/layers/{index}{path}");
    let edit = Edit::set(document, &pointer, curve);
    Some((pointer, edit))
}
