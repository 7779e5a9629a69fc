//! The initial values of new things in a picture layer where the schema has no default: an outline where the old one
//! was, an anchor in the middle of its zone, a keyframe between its neighbors.

use kurbo::Rect;
use serde_json::{Value, json};

use super::model::PictureLayer;
use super::neat::{corners, middle, neat, neat_pair};
use super::{interpolation, position, tools};
use crate::base::pointer::Pointer;
use crate::layers::starts::NewLayer;

/// Used in place of a zone where there is none yet.
const NOWHERE: Rect = Rect::new(0.0, 0.0, 100.0, 100.0);

/// The part of the picture for something new at `path` (relative to the layer): the outline itself, otherwise the
/// outline of its zone, otherwise what all zones cover; new items in a list of zones or regions get the middle of it.
pub fn bounds(layer: &PictureLayer, path: &str) -> Rect {
    let all = || layer.zones.iter().map(|zone| zone.outline.polygon().bounds()).reduce(|a, b| a.union(b));
    let zone = Pointer(path).item_of("/zones").and_then(|(zone, way)| Some((layer.zones.get(zone)?, way)));
    let Some((zone, way)) = zone else { return middle(all().unwrap_or(NOWHERE)) };
    let whole = zone.outline.polygon().bounds();
    if !Pointer(way).is_within("/fold") {
        return whole;
    }
    let region =
        Pointer(way).item_of("/fold/regions").and_then(|(region, _)| zone.fold.as_ref()?.regions().get(region));
    region.map_or(middle(whole), |region| region.polygon().bounds())
}

/// The initial value of the field `field` of a new `variant` (a kind of outline, a tool, a method, a function); `None`
/// if zeros will do.
pub fn start(variant: &str, field: &str, bounds: Rect) -> Option<Value> {
    let (c, w, h) = (bounds.center(), bounds.width(), bounds.height());
    let [tl, tr, br, bl] = corners(bounds);
    Some(match (variant, field) {
        ("rectangle", "x") => json!(neat(bounds.x0)),
        ("rectangle", "y") => json!(neat(bounds.y0)),
        ("rectangle", "width") => json!(neat(w)),
        ("rectangle", "height") => json!(neat(h)),
        ("ellipse", "radii") => json!([neat(w / 2.0), neat(h / 2.0)]),
        ("polygon", "points") => json!([tl, tr, br, bl]),
        ("path", "nodes") => json!([{ "at": tl }, { "at": tr }, { "at": br }, { "at": bl }]),
        (_, "at" | "center") => neat_pair(c),
        _ => {
            let of_tool = || tools::fresh(variant, bounds)?.get(field).cloned();
            let others = || interpolation::fresh(variant, field, bounds).or_else(|| position::fresh(variant, field));
            return of_tool().or_else(others);
        }
    })
}

/// A layer that shows an image, with one zone that covers it.
pub fn template(shown: &NewLayer) -> Value {
    let (name, (width, height)) = (shown.name, shown.size_px);
    if shown.bare {
        return json!({ "kind": "picture", "name": name, "image": name });
    }
    let outline = json!({ "kind": "rectangle", "x": 0, "y": 0, "width": width, "height": height });
    let zone = json!({ "name": "all", "outline": outline, "position": comes_back() });
    json!({ "kind": "picture", "name": name, "image": name, "zones": [zone] })
}

/// An optional field that a new item of a list starts with: a new zone goes there and back, so that its loop closes.
pub fn beyond(variant: &str, list: &str) -> Option<(&'static str, Value)> {
    ((variant, list) == ("picture", "zones")).then(|| ("position", comes_back()))
}

fn comes_back() -> Value {
    json!({ "function": "cosine" })
}

/// The pointer, within its items, to the numbers in which a list must ascend.
pub fn ascending(variant: &str, list: &str) -> Option<&'static str> {
    match (variant, list) {
        ("curve", "jumps") => Some("/along"),
        ("keyframes", "points") => Some("/0"),
        ("piecewise", "segments") => Some("/until"),
        _ => None,
    }
}

/// Whether the last item of the list `list` of a `variant` comes before the first again.
pub fn closed(variant: &str, list: &str) -> bool {
    matches!((variant, list), ("polygon" | "path" | "lasso", "points" | "nodes" | "vertices"))
}

/// A new item for the list `list` of a `variant`, to go before item `index`, and the index it gets; `None` if items do
/// not depend on their neighbors.
pub fn item(variant: &str, list: &str, items: &[Value], index: usize) -> Option<(usize, Value)> {
    let closed = closed(variant, list);
    if !closed && (variant, list) != ("curve", "nodes") && ascending(variant, list).is_none() {
        return None;
    }
    let last = items.last()?;
    match ascending(variant, list) {
        None => {
            let before = index.checked_sub(1).map_or(if closed { last } else { &items[0] }, |i| &items[i]);
            let after = items.get(index).unwrap_or(if closed { &items[0] } else { last });
            Some((index, between(before, after)))
        }
        Some(key) => {
            let at = |i: usize| items[i].pointer(key).and_then(Value::as_f64).unwrap_or(0.0);
            let full = at(items.len() - 1) >= 1.0;
            let index = if full { index.min(items.len() - 1) } else { index };
            let index = if at(0) <= 0.0 { index.max(1) } else { index };
            let low = if index == 0 { 0.0 } else { at(index - 1) };
            let high = if index == items.len() { 1.0 } else { at(index) };
            let mut item = items.get(index).unwrap_or(last).clone();
            if let Some(from) = item.get("from").cloned() {
                item["to"] = from;
            }
            *item.pointer_mut(key)? = json!(neat((low + high) / 2.0));
            Some((index, item))
        }
    }
}

/// Half way between two values of the same structure, number by number; handles of curves are left out.
fn between(a: &Value, b: &Value) -> Value {
    match (a, b) {
        (Value::Number(x), Value::Number(y)) => {
            json!(neat((x.as_f64().unwrap_or(0.0) + y.as_f64().unwrap_or(0.0)) / 2.0))
        }
        (Value::Array(a), Value::Array(b)) => a.iter().zip(b).map(|(a, b)| between(a, b)).collect(),
        (Value::Object(a), Value::Object(b)) => {
            let both = a.iter().filter(|(key, _)| !matches!(key.as_str(), "in" | "out"));
            Value::Object(both.filter_map(|(key, a)| Some((key.clone(), between(a, b.get(key)?)))).collect())
        }
        (a, _) => a.clone(),
    }
}
