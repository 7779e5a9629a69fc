//! The overlays of folding, and how their marks look. The colors are distinguishable for color-blind eyes (after Okabe
//! and Ito).

use crate::layers::parts::marks::{Dot, InPlots, Legend, Look, Overlay, VECTOR_COLORS, VECTORS, When};

pub(super) const OUTLINES: &str = "view-outlines";
pub(super) const REGIONS: &str = "view-regions";
pub(super) const ANCHORS: &str = "view-anchors";
pub(super) const CURVES: &str = "view-curves";
pub(super) const FIELD: &str = "view-field";
pub(super) const STREAMLINES: &str = "view-streamlines";
pub(super) const WHEEL: &str = "view-wheel";
pub(super) const PATHS: &str = "view-paths";
pub(super) const THRESHOLDS: &str = "view-thresholds";
pub(super) const SAMPLERS: &str = "view-samplers";
pub(super) const ONION: &str = "view-onion";
pub(super) const LABELS: &str = "view-labels";

/// Every overlay.
pub static OVERLAYS: &[Overlay] = &[
    Overlay::new(OUTLINES, "o", "Zone outlines", When::Document).plotted(InPlots::Beneath),
    Overlay::new(REGIONS, "r", "Fold regions", When::Document).plotted(InPlots::Beneath),
    Overlay::new(ANCHORS, "a", "Anchors and their jump vectors", When::Document).plotted(InPlots::Above),
    Overlay::new(CURVES, "c", "Curves, lassos and handles", When::Document),
    Overlay::new(LABELS, "n", "Names and numbers", When::Document).words(),
    Overlay::new(FIELD, "v", "The vector field as arrows", When::Synthesis)
        .plotted(InPlots::Field)
        .explained(Legend::Arrows),
    Overlay::new(STREAMLINES, "y", "The vector field as streamlines", When::Synthesis)
        .plotted(InPlots::Field)
        .explained(Legend::Lines),
    Overlay::new(WHEEL, "d", "The vector field as colors", When::Synthesis)
        .plotted(InPlots::Field)
        .explained(Legend::Colors),
    Overlay::new(PATHS, "p", "Jump paths", When::Synthesis),
    Overlay::new(THRESHOLDS, "x", "Where jump paths meet fold regions", When::Synthesis),
    Overlay::new(SAMPLERS, "e", "Samplers, at their effective places", When::EveryFrame),
    Overlay::new(ONION, "i", "Where the samplers were before", When::EveryFrame),
];

/// The outline of a zone.
pub static ZONE_OUTLINE: Look = Look::new("zone outline", 2, [86, 180, 233, 255], 1.6).dots(Dot::Square, 3.0);
/// A fold region.
pub static FOLD_REGION: Look =
    Look::new("fold region", 3, [240, 160, 40, 255], 1.6).dashed(6.0, 4.0).dots(Dot::Square, 3.0).stroke("x");
/// The jump path of a pixel.
pub static PATH: Look = Look::new("jump path", 4, [240, 230, 190, 190], 1.0).dots(Dot::Disc, 1.5);
/// A curve with anchors along it.
pub static CURVE: Look = Look::new("curve", 5, [214, 130, 190, 255], 1.6).dots(Dot::Diamond, 4.0).stroke("~");
/// A lasso, where it is.
pub static LASSO: Look =
    Look::new("lasso", 6, [240, 228, 66, 255], 1.4).dashed(2.0, 3.0).dots(Dot::Square, 3.0).stroke(":");
/// A node of a path or curve, and the lines to its handles.
pub static HANDLE: Look = Look::new("handle", 7, [170, 150, 165, 255], 1.0).dots(Dot::Diamond, 3.5).stroke("'");
/// The jump vector of an anchor.
pub static JUMP: Look = Look::new("jump vector", 8, [60, 210, 160, 255], 1.8).dots(Dot::Disc, 2.0).off_labels();
/// An anchor that moves.
pub static ANCHOR: Look = Look::new("anchor", 9, [60, 210, 160, 255], 1.4).dots(Dot::Disc, 3.5).off_labels();
/// An anchor with a jump of (0, 0).
pub static STILL: Look = Look::new("still anchor", 10, [235, 120, 80, 255], 1.4).dots(Dot::Square, 2.5).off_labels();
/// Where a jump path meets a fold region.
pub static THRESHOLD: Look = Look::new("threshold", 11, [240, 160, 40, 255], 1.2).dots(Dot::Diamond, 3.0);
/// A sampler that a fold keeps still.
pub static RESTING: Look = Look::new("resting sampler", 12, [150, 160, 175, 255], 1.2).dots(Dot::Square, 1.8);
/// A sampler, at its effective place.
pub static SAMPLER: Look = Look::new("sampler", 13, [255, 236, 150, 255], 1.2).dots(Dot::Disc, 2.2);

/// Every look, from bottom to top.
pub static LOOKS: &[&Look] = &[
    &VECTOR_COLORS,
    &VECTORS,
    &ZONE_OUTLINE,
    &FOLD_REGION,
    &PATH,
    &CURVE,
    &LASSO,
    &HANDLE,
    &JUMP,
    &ANCHOR,
    &STILL,
    &THRESHOLD,
    &RESTING,
    &SAMPLER,
];

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::base::picture::Picture;
    use crate::layers::Layer;
    use crate::layers::folding::synth::synth;
    use crate::layers::folding::{marks, pixel_marks};
    use crate::layers::parts::marks::{Mark, View};
    use crate::layers::parts::materials::Materials;
    use crate::layers::parts::vectors::Reach;
    use crate::layers::ready::Making;
    use crate::layers::timeline::Wrap;
    use crate::scene::Scene;

    #[test]
    fn every_overlay_draws_something_and_every_look_is_used() {
        let scene: Scene = serde_json::from_str(include_str!("overlays.json")).unwrap();
        let Some(Layer::Picture(layer)) = scene.layers.first() else { panic!("a picture layer") };
        let picture = Arc::new(Picture::filled(64, 64, [1.0; 4]));
        let materials = Materials { pictures: [("a".to_owned(), picture)].into(), ..Materials::default() };
        let synth = synth(layer, &Making::plain(Wrap::default(), &materials), None).unwrap();
        let drawn = |names: &[&'static str]| -> Vec<Mark> {
            let view = View {
                spacing_px: 4.0,
                cell_px: 4.0,
                times: vec![0.3, 0.2],
                reach: Reach { longest_px: 20.0, ..Reach::default() },
                ..View::of(names)
            };
            pixel_marks::marks(&synth, &view).into_iter().chain(marks::marks(layer, &view)).collect()
        };
        let all: Vec<&'static str> = OVERLAYS.iter().map(|overlay| overlay.name).collect();
        for name in &all {
            let others: Vec<&'static str> = all.iter().copied().filter(|other| other != name).collect();
            // Labels name what others draw.
            assert!(!drawn(&[name]).is_empty() || drawn(&all) != drawn(&others), "{name} draws nothing");
        }
        let all = drawn(&all);
        for look in LOOKS {
            assert!(all.iter().any(|mark| mark.look.name == look.name), "nothing looks like {}", look.name);
        }
    }
}
