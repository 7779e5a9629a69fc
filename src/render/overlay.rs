//! What is drawn over a picture to explain it: the marks of all layers, from bottom to top. A pure function from scene,
//! synthesis and view to marks in pixels of the picture.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DVec2;
use kurbo::{Point, Vec2};

use super::Synth;
use super::stage::Group;
use crate::base::pointer::Pointer;
use crate::layers::parts::marks::{Hit, Mark, Overlay, View, When};
use crate::layers::parts::moment::{Columns, Moment};
use crate::layers::parts::vectors::{Reach, VectorLook};
use crate::layers::space::hidden::Depths;
use crate::layers::timeline::Wrap;
use crate::layers::{KINDS, space};
use crate::scene::Scene;

/// How often samplers are shown where they were before, and how far apart that is, as a share of the timeline.
const ONION: (u32, f64) = (6, 1.0 / 48.0);

/// Every overlay of every technique; shared ones once.
pub fn overlays() -> impl Iterator<Item = &'static Overlay> {
    let all = || KINDS.iter().flat_map(|kind| kind.overlays.iter().copied().flatten());
    all().enumerate().filter(move |(i, overlay)| all().take(*i).all(|other| other.name != overlay.name)).map(|(_, o)| o)
}

/// Pixels of the picture between two marks that are to be about `wanted` pixels apart: a power of two.
pub fn spacing(wanted: f64) -> f64 {
    (0..24).map(|k| f64::from(1 << k)).find(|&s| s >= wanted).unwrap_or(wanted)
}

/// The present scene time, and some before it at which samplers were elsewhere.
pub fn times(now: f64, wrap: Wrap) -> Vec<f64> {
    let before = (1..=ONION.0).map(|k| now - f64::from(k) * ONION.1);
    let before = before.filter_map(|t| match wrap {
        Wrap::Once => (t >= 0.0).then_some(t),
        Wrap::Repeat | Wrap::PingPong => Some(t.rem_euclid(1.0)),
    });
    std::iter::once(now).chain(before).collect()
}

/// The marks of a scene, from bottom to top. Marks that need the synthesis are left out without it.
pub fn overlay(scene: &Scene, synth: Option<&Synth>, view: &View) -> Vec<Mark> {
    let of_pixels = overlays().any(|overlay| overlay.when == When::Synthesis && view.shows(overlay.name));
    let reach = synth.filter(|_| of_pixels).map_or(Reach::default(), |synth| reach(synth, &view.vectors));
    let view = View { reach, ..view.clone() };
    let t = view.times.first().copied().unwrap_or(0.0);
    let alone = synth.zip(view.only).map(|(synth, layer)| synth.only(layer));
    let synth = alone.as_ref().or(synth).map(|synth| (synth, synth.moment(t)));
    let nearest = synth.as_ref().map(|(synth, moment)| nearest(synth, moment, &view)).unwrap_or_default();
    let textures = if view.of_textures { BTreeSet::new() } else { scene.textures() };
    let is_shown = |i: usize| !textures.contains(&i) && view.only.is_none_or(|only| only == i);
    let in_layer = view.selection.as_deref().and_then(|selection| Pointer(selection).item_of("/layers"));
    let mut marks = Vec::new();
    if let Some((synth, moment)) = &synth {
        for (i, layer) in synth.layers.iter().enumerate().filter(|(i, _)| is_shown(*i)) {
            let selection = in_layer.filter(|(layer, _)| *layer == i).map(|(_, way)| way.to_owned());
            let own = View { nearest: nearest.get(&i).cloned(), selection, ..view.clone() };
            marks.extend(of_layer(i, layer.marks(&own, moment)));
        }
    }
    for (i, layer) in scene.layers.iter().enumerate().filter(|(i, _)| is_shown(*i)) {
        marks.extend(of_layer(i, layer.technique().marks(&view)));
    }
    for (_, moment) in synth.iter().filter(|(synth, _)| synth.stage.seen_by().is_some()) {
        // The topmost of what is in space.
        let over_ground = View { nearest: nearest.values().next_back().cloned(), ..view.clone() };
        marks.extend(space::marks::marks(&over_ground, moment, scene.camera.as_ref()));
    }
    if let Some(belongs) = view.selection.as_deref().map(belongs) {
        marks.iter_mut().for_each(|mark| mark.selected = belongs(mark));
    }
    marks.sort_by_key(|mark| mark.look.order);
    marks
}

/// The marks that a layer made, as marks of the document.
fn of_layer(layer: usize, marks: Vec<Mark>) -> impl Iterator<Item = Mark> {
    marks.into_iter().map(move |mark| Mark { layer: Some(layer), ..mark })
}

/// Whether a mark belongs to what is at a JSON pointer.
pub fn belongs(selection: &str) -> impl Fn(&Mark) -> bool {
    let in_layer = Pointer(selection).item_of("/layers");
    move |mark| match (mark.layer, in_layer) {
        (None, _) => is_selected(&mark.path, selection),
        (Some(layer), Some((selected, way))) => layer == selected && is_selected(&mark.path, way),
        (Some(_), None) => false,
    }
}

/// The marks of what is at a JSON pointer if it went to where a place of the picture points, at scene time `t`.
pub fn aimed(scene: &Scene, synth: &Synth, t: f64, (pointer, at): (&str, Point)) -> Vec<Mark> {
    let moment = synth.moment(t);
    let Some((layer, way)) = Pointer(pointer).item_of("/layers") else { return Vec::new() };
    let Some((eye, layer)) = moment.eye.zip(scene.layers.get(layer)) else { return Vec::new() };
    let marks = layer.technique().aimed_marks(way, &eye.ray_in_world(DVec2::new(at.x, at.y)), &moment);
    marks.into_iter().map(|mark| Mark { selected: true, ..mark }).collect()
}

/// For each layer in space what is nearest in its group, if marks are shown that surfaces hide.
fn nearest(synth: &Synth, moment: &Moment, view: &View) -> BTreeMap<usize, Arc<Depths>> {
    if !overlays().any(|overlay| overlay.hidden && view.shows(overlay.name)) {
        return BTreeMap::new();
    }
    let of_group = |group: &Group| {
        let Group::World(layers) = group else { return Vec::new() };
        let stills: Vec<_> = layers.iter().map(|&layer| synth.layers[layer].at(moment)).collect();
        let row = |y: usize, columns: Columns, depth: &mut [f64]| {
            let mut colors = vec![[0.0; 4]; depth.len()];
            stills.iter().for_each(|still| still.surface(y, columns, depth, &mut colors));
        };
        let depths = Arc::new(Depths::new(synth.size, row));
        layers.iter().map(|&layer| (layer, depths.clone())).collect()
    };
    synth.stage.groups.iter().flat_map(of_group).collect()
}

/// What is drawn as the longest arrow and in the fullest color: what the look says, else the most that the scene has.
pub fn reach(synth: &Synth, look: &VectorLook) -> Reach {
    let fields = || synth.layers.iter().flat_map(|layer| layer.fields());
    let longest = || fields().map(|field| field.longest()).fold(0.0, f64::max);
    let steepest = |slope| fields().map(|field| field.steepest(slope)).fold(0.0, f64::max);
    let slope = look.color.slope().map(|slope| look.steepest.unwrap_or_else(|| steepest(slope)));
    Reach { longest_px: look.longest_px.unwrap_or_else(longest), steepest: slope.unwrap_or(0.0) }
}

/// The jump vector of the pixel at a place in the picture: that of the topmost field there.
pub fn jump_at(synth: &Synth, at: Point) -> Option<Vec2> {
    let pixel = (at.x >= 0.0 && at.y >= 0.0).then_some((at.x as usize, at.y as usize))?;
    let fields = synth.layers.iter().rev().flat_map(|layer| layer.fields().into_iter().rev());
    fields.filter_map(|field| field.at(pixel)).next()
}

/// What is at a place, in pixels of the picture: the nearest thing within `reach_px`, otherwise the topmost area that
/// contains it; its path is a pointer into the document.
pub fn pick(scene: &Scene, at: Point, reach_px: f64) -> Option<Hit> {
    let textures = scene.textures();
    let layers = scene.layers.iter().enumerate().rev().filter(|(i, _)| !textures.contains(i));
    let hits = layers.filter_map(|(i, layer)| {
        let hit = layer.technique().pick(at, reach_px)?;
        Some(Hit { path: format!("/layers/{i}{}", hit.path), ..hit })
    });
    hits.min_by(|a, b| a.distance_px.total_cmp(&b.distance_px))
}

/// A mark is selected if the selection is in it, or if it is in the selection and that is an item of the layer or
/// something smaller. What belongs to nothing in the document, as the ground, or to all of a layer, as its edges, never is.
fn is_selected(mark: &str, selection: &str) -> bool {
    // `/zones/2` and deeper.
    let takes_all = || Pointer(mark).is_within(selection) && Pointer(selection).depth() >= 2;
    !mark.is_empty() && (Pointer(selection).is_within(mark) || takes_all())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::parts::marks::Look;

    #[test]
    fn selection_reaches_up_to_the_zone_and_down() {
        for (mark, selection, selected) in [
            ("/zones/2", "/zones/2/interpolation/radius", true),
            ("/zones/2/motion/1", "/zones/2", true),
            ("/zones/2/motion/1", "/zones/2/motion/10", false),
            ("/zones/2", "/zones", false),
            ("/zones/2", "", false),
            ("", "/kind", false),
            ("/camera", "/camera/fov", true),
        ] {
            assert_eq!(is_selected(mark, selection), selected, "{mark} {selection}");
        }
    }

    #[test]
    fn a_mesh_hides_the_edges_of_another_behind_it() {
        let (scene, synth) = crate::render::samples::two_squares();
        // One edge of the far square is hidden, and parts of three.
        for (shown, edges) in [(&["view-wires"][..], 9), (&["view-wires", "view-backs"], 10), (&["view-backs"], 0)] {
            let marks = overlay(&scene, Some(&synth), &View { cell_px: 4.0, ..View::of(shown) });
            assert_eq!(marks.iter().filter(|mark| mark.look.name == "edge").count(), edges, "{shown:?}");
        }
        for only in [0, 1] {
            let marks = overlay(&scene, Some(&synth), &View { only: Some(only), ..View::of(&["view-wires"]) });
            assert!(marks.iter().all(|mark| mark.layer == Some(only)), "{only}");
            assert_eq!(marks.len(), 5, "nothing hides what is alone: {only}");
        }
    }

    #[test]
    fn a_layer_that_lies_on_another_has_no_marks_in_the_frame() {
        let scene: Scene = serde_json::from_str(
            r#"{ "plica": 1, "images": {"a": {"path": "a.png"}}, "meshes": {"m": {"path": "m.obj"}}, "camera": {}, "layers": [
              {"kind": "picture", "name": "eye", "image": "a", "zones": [
                {"name": "lid", "outline": {"kind": "rectangle", "x": 0, "y": 0, "width": 4, "height": 4}}]},
              {"kind": "mesh", "name": "ball", "mesh": "m", "surface": {"kind": "layer", "layer": "eye"}} ]}"#,
        )
        .unwrap();
        for (of_textures, count) in [(false, 0), (true, 1)] {
            let view = View { of_textures, ..View::of(&["view-outlines"]) };
            assert_eq!(overlay(&scene, None, &view).len(), count, "{of_textures}");
        }
        assert_eq!(pick(&scene, Point::new(2.0, 2.0), 1.0), None);
    }

    #[test]
    fn looks_differ_in_more_than_color_and_in_their_order() {
        for kind in KINDS {
            let looks = kind.looks.concat();
            for (i, look) in looks.iter().enumerate() {
                for other in &looks[i + 1..] {
                    let shape = |look: &Look| (look.width_px, look.dash_px, look.dot, look.dot_px);
                    assert!(shape(look) != shape(other), "{} {}", look.name, other.name);
                    assert!(look.order < other.order, "{} {}", look.name, other.name);
                }
            }
        }
    }

    #[test]
    fn no_two_overlays_share_a_key() {
        let all: Vec<_> = overlays().collect();
        for (i, overlay) in all.iter().enumerate() {
            assert!(overlay.name.starts_with("view-"), "{overlay:?}");
            let twice = all[i + 1..].iter().find(|other| other.key == overlay.key || other.name == overlay.name);
            assert_eq!(twice, None, "{overlay:?}");
        }
    }

    #[test]
    fn the_nearest_anchor_else_the_topmost_zone_is_picked() {
        let zone = |name: &str, x: u32| {
            format!(
                r#"{{ "name": "{name}", "outline": {{"kind": "rectangle", "x": {x}, "y": 0, "width": 40, "height": 20}},
                    "motion": [{{"tool": "translate", "by": [1, 0]}}, {{"tool": "point", "at": [{}, 10]}}]}}"#,
                x + 5
            )
        };
        let scene: Scene = serde_json::from_str(&format!(
            r#"{{ "plica": 1, "images": {{"a": {{"path": "a.png"}}}},
              "layers": [{{ "kind": "picture", "name": "l", "image": "a", "zones": [{}, {}]}}]}}"#,
            zone("below", 0),
            zone("above", 30)
        ))
        .unwrap();
        for ((x, y), expected) in [
            ((5.0, 10.0), Some("/layers/0/zones/0/motion/1")),
            ((8.0, 10.0), Some("/layers/0/zones/0/motion/1")),
            ((37.0, 11.0), Some("/layers/0/zones/1/motion/1")),
            ((12.0, 3.0), Some("/layers/0/zones/0")),
            ((38.0, 3.0), Some("/layers/0/zones/1")),
            ((60.0, 3.0), Some("/layers/0/zones/1")),
            ((90.0, 3.0), None),
            ((1.0, 25.0), None),
        ] {
            let hit = pick(&scene, Point::new(x, y), 4.0);
            assert_eq!(hit.as_ref().map(|hit| hit.path.as_str()), expected, "{x} {y}");
            assert!(hit.is_none_or(|hit| hit.cell.is_empty() != hit.path.contains("motion")), "{x} {y}");
        }
    }

    #[test]
    fn the_topmost_zone_under_the_pointer_gives_the_jump() {
        use crate::base::picture::Picture;
        use crate::layers::parts::materials::Materials;
        let zone = |name: &str, x: u32, jump: u32| {
            format!(
                r#"{{ "name": "{name}", "outline": {{"kind": "rectangle", "x": {x}, "y": 2, "width": 4, "height": 4}},
                    "motion": [{{"tool": "translate", "by": [{jump}, 0]}}]}}"#
            )
        };
        let scene = format!(
            r#"{{ "plica": 1, "images": {{"a": {{"path": "a.png"}}}}, "layers": [{{ "kind": "picture", "name": "l", "image": "a",
              "zones": [{}, {}]}}]}}"#,
            zone("below", 1, 3),
            zone("above", 4, 5)
        );
        let scene = serde_json::from_str(&scene).unwrap();
        let picture = Arc::new(Picture::filled(16, 16, [1.0; 4]));
        let materials = Materials { pictures: [("a".to_owned(), picture)].into(), ..Materials::default() };
        let synth = crate::render::synth(&scene, &materials, None).unwrap();
        let table =
            [(1.5, 2.0, Some(3.0)), (4.9, 3.0, Some(5.0)), (0.9, 3.0, None), (-1.0, 3.0, None), (5.0, 6.0, None)];
        for (x, y, expected) in table {
            assert_eq!(jump_at(&synth, Point::new(x, y)).map(|jump| jump.x), expected, "{x} {y}");
        }
    }
}
