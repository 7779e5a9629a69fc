//! Looks up the shapes that outlines and curves are made of (docs/folding.md, section 7).

use std::collections::BTreeMap;

use super::model::PictureLayer;
use super::outline::Outline;
use crate::layers::shapes::joined::joined;
use crate::layers::shapes::shape::{Part, Shape};

/// Looks up the shapes that a layer names. Those that are not there have no nodes.
pub fn resolve(layer: &mut PictureLayer, shapes: &BTreeMap<String, Shape>) {
    for zone in &mut layer.zones {
        let regions = zone.fold.iter_mut().flat_map(|fold| fold.regions_mut());
        for outline in regions.chain([&mut zone.outline]) {
            if let Outline::Shapes { parts, nodes } = outline {
                *nodes = joined(parts, shapes);
            }
        }
        for tool in &mut zone.motion {
            tool.look_up(|name| shapes.get(name).map(|shape| shape.nodes.clone()).unwrap_or_default());
        }
    }
}

/// The shapes that a layer names, each with its place.
pub fn uses(layer: &PictureLayer) -> impl Iterator<Item = (String, &str)> {
    layer.zones.iter().enumerate().flat_map(|(i, zone)| {
        let regions = zone.fold.iter().flat_map(|fold| fold.regions()).enumerate();
        let regions = regions.map(move |(r, region)| (format!("/zones/{i}/fold/regions/{r}"), region));
        let outlines = std::iter::once((format!("/zones/{i}/outline"), &zone.outline)).chain(regions);
        let parts = outlines.flat_map(|(at, outline)| {
            let parts: &[Part] = if let Outline::Shapes { parts, .. } = outline { parts } else { &[] };
            let named = parts.iter().enumerate();
            named.map(move |(p, part)| (format!("{at}/parts/{p}/shape"), part.shape.as_str())).collect::<Vec<_>>()
        });
        let curves = zone.motion.iter().enumerate().filter_map(move |(t, tool)| {
            Some((format!("/zones/{i}/motion/{t}/nodes"), tool.facts().path?.shape.as_deref()?))
        });
        parts.chain(curves)
    })
}
