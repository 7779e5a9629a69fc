//! A layer without some of its zones, which keep their places in the list.

use super::model::PictureLayer;
use super::outline::Outline;
use crate::base::pointer::Pointer;

/// Beside every picture, so that no pixel is in it.
const NOWHERE: Outline = Outline::Rectangle { x: -2.0, y: -2.0, width: 1.0, height: 1.0 };

/// Whether the thing at `path` can be left out by itself.
pub fn can_be(path: &str) -> bool {
    Pointer(path).item_of("/zones").is_some_and(|(_, way)| way.is_empty())
}

/// The layer as if these of its zones were not there.
pub fn layer(layer: &PictureLayer, paths: &[&str]) -> PictureLayer {
    let mut layer = layer.clone();
    for (i, _) in paths.iter().filter_map(|path| Pointer(path).item_of("/zones")) {
        if let Some(zone) = layer.zones.get_mut(i) {
            (zone.outline, zone.fold, zone.sampler) = (NOWHERE, None, None);
            zone.motion.clear();
        }
    }
    layer
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zones_are_left_out_one_by_one() {
        assert!(can_be("/zones/3"));
        for path in ["", "/zones", "/zones/3/motion", "/name"] {
            assert!(!can_be(path), "{path}");
        }
    }
}
