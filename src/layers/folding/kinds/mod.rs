//! Changing the kind of a thing: an outline, a tool, a position function. The shape is kept as far as the new kind can
//! express it, and what is lost is reported. Fields with the same name do not always mean the same (the `factor` of a
//! scale is not that of a shear), so nothing here goes by names.

use serde::de::DeserializeOwned;
use serde_json::Value;

use super::model::PictureLayer;
use super::outline::Outline;
use crate::base::pointer::Pointer;
use crate::layers::technique::Turned;

mod outlines;
mod positions;
#[cfg(test)]
mod tests;
mod tools;

/// The `old` thing at `path` (relative to the layer), turned into a `to`. `None` if there is nothing to do but keep
/// fields with the same name.
pub fn turned(layer: &PictureLayer, path: &str, old: &Value, to: &str) -> Option<Turned> {
    let (zone, way) = Pointer(path).item_of("/zones")?;
    let zone = layer.zones.get(zone)?;
    let tokens: Vec<String> = Pointer(way).tokens().collect();
    match tokens.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        ["outline"] => outlines::turned(&found(read(old)?, &zone.outline), to),
        ["fold", "regions", region] => {
            let region = zone.fold.as_ref().and_then(|fold| fold.regions().get(region.parse::<usize>().ok()?));
            outlines::turned(&region.map_or_else(|| read(old), |known| Some(found(read(old)?, known)))?, to)
        }
        ["motion", _] => tools::turned(zone, &read(old)?, to),
        ["position"] | ["position", .., "ease"] => positions::turned(&read(old)?, to),
        _ => None,
    }
}

/// An outline as it is written, with the shapes looked up that it is made of.
fn found(written: Outline, known: &Outline) -> Outline {
    match written {
        Outline::Shapes { .. } => known.clone(),
        own => own,
    }
}

/// An outline as one of the kind `to`.
pub fn outline_as(old: &Outline, to: &str) -> Option<Value> {
    outlines::turned(old, to)?.items.into_iter().next()
}

fn read<T: DeserializeOwned>(value: &Value) -> Option<T> {
    T::deserialize(value).ok()
}
