//! Shapes laid through points, and curves of a zone's motion along them.

use kurbo::Point;

use super::command::{Call, Command, Done, command};
use super::sharing::{LIST, known};
use crate::base::pointer::Pointer;
use crate::base::problem::quoted;
use crate::layers::shapes::handles::through;
use crate::layers::shapes::node::{self, Node};
use crate::layers::shapes::shape;
use crate::scene::{Edit, address};
use crate::tui::state::State;
use crate::tui::text::plain;
use crate::tui::text::said::words;

pub const COMMANDS: &[Command] = &[
    command("shape", "NAME X,Y X,Y ...", "Lay a shape smoothly through points, a new one or one that is there", lay)
        .change(),
    command(
        "along",
        "NAME [to NAME]",
        "Hold the picture still along a shape, in the zone here; or let the samplers go from there to another shape",
        along,
    )
    .change(),
];

fn lay(state: &mut State, call: &Call) -> Done {
    let words = words(call.text)?;
    let usage = || "shape takes a name and two points or more: :shape lid 88,212 240,134 396,200".to_owned();
    let (name, points) = words.split_first().ok_or_else(usage)?;
    let points = points.iter().map(|word| place(word)).collect::<Result<Vec<Point>, String>>()?;
    if points.len() < 2 {
        return Err(usage());
    }
    let nodes = through(&points).iter().map(node::written).collect();
    let pointer = Pointer(&Pointer("").join(LIST)).join(name);
    let document = state.document();
    let is_new = !document.scene().shapes.contains_key(name);
    state.edit(Edit::set(document, &pointer, shape::written(nodes)), false)?;
    state.say(plain(&match is_new {
        true => format!("the shape {} is there: :use makes an outline of it, :along what moves", quoted(name)),
        false => format!("the shape {} is laid anew, and all that is made of it", quoted(name)),
    }));
    Ok(())
}

/// A place of the picture, as it is typed.
fn place(word: &str) -> Result<Point, String> {
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
    let place = word.split_once(',').and_then(|(x, y)| Some(Point::new(number(x)?, number(y)?)));
    place.ok_or_else(|| format!("{} is no place of the picture: write it as X,Y, as 88,212", quoted(word)))
}

fn along(state: &mut State, call: &Call) -> Done {
    let words = words(call.text)?;
    let (name, to) = match words.as_slice() {
        [name] => (name, None),
        [name, to, other] if to == "to" => (name, Some(other)),
        _ => return Err("along takes the name of a shape, and where to: :along low to lid".into()),
    };
    let shapes = &state.document().scene().shapes;
    let nodes = |name: &String| -> Result<&[Node], String> {
        known(state, name)?;
        Ok(shapes.get(name).map_or(&[], |shape| &shape.nodes))
    };
    let (own, other) = (nodes(name)?, to.map(nodes).transpose()?);
    let at = state.here();
    let layer = Pointer(&at).item_of("/layers");
    let found = layer.and_then(|(index, way)| {
        let layer = state.document().scene().layers.get(index)?.technique();
        let (path, value) = layer.along(way, (name, own), other)?;
        Some((format!("/layers/{index}{path}"), value))
    });
    let (pointer, curve) = found.ok_or("along is for what moves in a zone: go to one")?;
    state.edit(Edit::set(state.document(), &pointer, curve), false)?;
    let zone = Pointer(&pointer).parent().and_then(|list| Pointer(list).parent()).unwrap_or_default();
    let zone = address::address(state.document(), zone);
    state.say(plain(&match to {
        None => format!("along {} nothing moves in {zone}", quoted(name)),
        Some(to) => format!("{zone} moves along {}: its samplers go to {}", quoted(name), quoted(to)),
    }));
    Ok(())
}
