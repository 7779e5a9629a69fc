//! What a technique knows of new things without a layer: how they begin, and what they may look like at once.

use kurbo::Rect;
use serde_json::Value;

use super::parts::materials::List;

/// What makes a new layer from something that it shows.
#[derive(Clone, Copy, Debug)]
pub struct Template {
    /// The list of the scene that this is in.
    pub of: List,
    /// The layer, called as what it shows.
    pub layer: fn(shown: &NewLayer) -> Value,
    /// The background of a new scene on which it is seen best, if nothing else is in the scene.
    pub ground: Option<&'static str>,
}

/// What a new layer shows.
#[derive(Clone, Copy, Debug, Default)]
pub struct NewLayer<'a> {
    /// Its name in its list.
    pub name: &'a str,
    /// Width and height of its frames in pixels, as far as they are known.
    pub size_px: (usize, usize),
    /// How many frames it has, if it is a clip and that is known.
    pub frames: Option<usize>,
    /// Whether nothing moves in it.
    pub is_still: bool,
    /// The image on its surface, if it has one.
    pub image: Option<&'a str>,
    /// Whether the layer is only to show it as it is, with nothing to edit.
    pub bare: bool,
    /// The color of its surface, if it says one.
    pub color: Option<&'a str>,
    /// Whether both of its sides are meant to be seen.
    pub both_sides: bool,
}

/// Settings that change what a layer looks like.
#[derive(Clone, Copy, Debug)]
pub struct Preset {
    /// Its name, unique among those of all techniques.
    pub name: &'static str,
    /// When to use it, in one line.
    pub help: &'static str,
    /// What else it wants of the scene, in words; empty for nothing.
    pub wants: &'static str,
    /// What it sets: a JSON Merge Patch (RFC 7396) on the layer.
    pub patch: &'static str,
}

/// The styles that layers of a technique can be drawn in.
#[derive(Debug)]
pub struct Styles {
    /// Where a layer says in which it is: a JSON pointer.
    pub field: &'static str,
    /// The field, within that, with the name of the style.
    pub name: &'static str,
    /// The field, within that, with what the drawing is fixed to.
    pub anchor: &'static str,
    /// The field, within that, with the angle by which all of it is turned, in degrees.
    pub turn: &'static str,
    /// Those that the program brings.
    pub list: &'static [Style],
    /// The fields of the table of a style by which it is known.
    pub marks: &'static [&'static str],
    /// What the field is to be for the style of this name, if it is this now.
    pub named: fn(now: Option<&Value>, name: &str) -> Value,
    /// What the field is to be for a table that is no style of the program.
    pub own: fn(table: Value) -> Value,
    /// The table of everything that is in force by what is written in the field.
    pub whole: fn(written: &Value) -> Result<Value, String>,
}

/// A style.
#[derive(Debug)]
pub struct Style {
    /// Its name.
    pub name: &'static str,
    /// What it is for, in one line.
    pub help: &'static str,
    /// Its table: JSON.
    pub table: &'static str,
}

/// Ways of the same layer to be looked at side by side.
#[derive(Debug)]
pub struct Comparison {
    /// What differs: "anchor".
    pub by: &'static str,
    /// The layer in each way, with its name, from left to right; empty if it has no such ways.
    pub ways: fn(layer: &Value) -> Vec<(&'static str, Value)>,
}

/// How new things in a document begin, and which lists ascend.
#[derive(Debug)]
pub struct Starts {
    /// The initial value of the field `field` of a new `variant`, if the schema has no default and zeros will not do.
    pub start: fn(variant: &str, field: &str, bounds: Rect) -> Option<Value>,
    /// An optional field, with its value, that a new item of the list `list` of a `variant` starts with.
    pub beyond: fn(variant: &str, list: &str) -> Option<(&'static str, Value)>,
    /// The JSON pointer, within its items, to the numbers in which the list `list` of a `variant` ascends, if it does.
    pub ascending: fn(variant: &str, list: &str) -> Option<&'static str>,
    /// A new item for the list `list` of a `variant`, to go before item `index`, and the index it gets; `None` if items
    /// do not depend on their neighbors.
    pub item: fn(variant: &str, list: &str, items: &[Value], index: usize) -> Option<(usize, Value)>,
    /// Whether the last item of the list `list` of a `variant` comes before the first again, as the corners of a polygon.
    pub closed: fn(variant: &str, list: &str) -> bool,
}

impl Starts {
    /// Everything by the schema alone.
    pub const PLAIN: Starts = Starts {
        start: |_, _, _| None,
        beyond: |_, _| None,
        ascending: |_, _| None,
        item: |_, _, _, _| None,
        closed: |_, _| false,
    };
}

/// A new item for a list that ascends from 0 to 1 in the numbers at `key`: half way between its neighbors, otherwise like
/// the one before; and the index it gets.
pub fn halfway(items: &[Value], index: usize, key: &str) -> Option<(usize, Value)> {
    let at = |i: usize| items.get(i)?.pointer(key)?.as_f64();
    // Nothing fits before 0 or after 1.
    let index = if at(0) == Some(0.0) { index.max(1) } else { index };
    let index = if at(items.len().checked_sub(1)?) == Some(1.0) { index.min(items.len() - 1) } else { index };
    let before = index.checked_sub(1);
    let middle = (before.and_then(at).unwrap_or(0.0) + at(index).unwrap_or(1.0)) / 2.0;
    let mut item = items.get(before.unwrap_or(0))?.clone();
    *item.pointer_mut(key)? = middle.into();
    Some((index, item))
}
