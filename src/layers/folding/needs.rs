//! What a layer needs: the pictures and files that it names, and how much will be made of it, before any of it is.

use super::counts;
use super::model::{PictureLayer, Zone};
use super::shared;
use crate::layers::parts::materials::{List, Materials, Of, Use, What};
use crate::layers::technique::Count;

/// The pictures and files that the layer names: its own, then zone by zone.
pub fn uses(layer: &PictureLayer) -> Vec<Use<'_>> {
    let picture = |at, image| Use { at, of: Of::Name(List::Images, image), what: What::Picture };
    let mut uses = vec![picture("/image".to_owned(), &layer.image)];
    for (i, zone) in layer.zones.iter().enumerate() {
        if let Some(image) = zone.fold.as_ref().and_then(|fold| fold.mask()) {
            let at = format!("/zones/{i}/fold/image");
            uses.push(Use { at, of: Of::Name(List::Images, image), what: What::Mask { on: &layer.image } });
        }
        let image = zone.sampler.as_ref().and_then(|sampler| sampler.image.as_deref());
        uses.extend(image.map(|image| picture(format!("/zones/{i}/sampler/image"), image)));
        let clip =
            |clip| Use { at: format!("/zones/{i}/sampler/clip"), of: Of::Name(List::Clips, clip), what: What::Clip };
        uses.extend(zone.clip().map(clip));
        for (j, tool) in zone.motion.iter().enumerate() {
            if let Some(path) = tool.facts().file {
                uses.push(Use { at: format!("/zones/{i}/motion/{j}/path"), of: Of::Path(path), what: What::Vectors });
            }
        }
    }
    let named = shared::uses(layer).map(|(at, name)| Use { at, of: Of::Name(List::Shapes, name), what: What::Shape });
    uses.extend(named);
    uses
}

/// Whether the layer hides all that is beneath it in a frame of this size: its picture fills it, and nothing shines through that or
/// through another one that a zone shows.
pub fn covers(layer: &PictureLayer, size_px: (usize, usize), materials: &Materials) -> bool {
    let own = materials.pictures.get(&layer.image);
    let fills = own.is_some_and(|own| own.width() >= size_px.0 && own.height() >= size_px.1);
    let images = layer.zones.iter().filter_map(|zone| zone.sampler.as_ref()?.image.as_ref());
    let mut shown = std::iter::once(&layer.image).chain(images);
    fills && shown.all(|image| materials.pictures.get(image).is_some_and(|image| image.is_opaque()))
}

/// The numbers of anchors and outline points that the layer asks for, place by place, before any are made.
pub fn counts(layer: &PictureLayer, each: &mut dyn FnMut(Count)) {
    for (i, zone) in layer.zones.iter().enumerate() {
        let path = || format!("/zones/{i}/outline");
        each(Count { what: "points", path: &path, count: counts::points(&zone.outline) });
        for (k, region) in zone.fold.iter().flat_map(|fold| fold.regions()).enumerate() {
            let path = || format!("/zones/{i}/fold/regions/{k}");
            each(Count { what: "points", path: &path, count: counts::points(region) });
        }
        for (j, tool) in zone.motion.iter().enumerate() {
            let path = || format!("/zones/{i}/motion/{j}");
            each(Count { what: "anchors", path: &path, count: counts::anchors(tool, &zone.outline) });
        }
    }
}

/// Bytes that the equations of interpolations will take, before they are made.
pub fn memory(layer: &PictureLayer) -> Vec<(String, u64)> {
    let bytes = |(i, zone): (usize, &Zone)| {
        let bytes = zone.interpolation.bytes(counts::all_anchors(zone) as u64);
        (bytes > 0).then(|| (format!("/zones/{i}/interpolation"), bytes))
    };
    layer.zones.iter().enumerate().filter_map(bytes).collect()
}
