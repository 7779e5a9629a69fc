//! What is seen of a scene once its files are there: how large its frame is, and which layers in space are never in it.

use super::{FRAME, Scene};
use crate::base::problem::{Problem, quoted};
use crate::layers::Layer;
use crate::layers::parts::materials::Materials;
use crate::layers::parts::moment::{Moment, Space};

/// At most about so many moments are looked at.
const MOST_MOMENTS: u64 = 64;

/// Width and height of a frame: those of the scene, else those of the first picture that a layer gives it, else
/// 1280 x 720.
pub fn frame_size(scene: &Scene, materials: &Materials) -> (usize, usize) {
    if let Some([width, height]) = scene.size {
        return (width as usize, height as usize);
    }
    let named = scene.layers.iter().find_map(|layer| layer.technique().frame_of());
    let picture = named.and_then(|name| materials.pictures.get(name));
    picture.map_or(FRAME, |picture| (picture.width(), picture.height()))
}

/// Layers in space that no camera sees, that are in the frame at no time, or that others hide.
pub fn problems(scene: &Scene, materials: &Materials) -> Vec<Problem> {
    let in_space = |layer: &Layer| layer.technique().kind().space == Space::World;
    let Some(camera) = &scene.camera else {
        let lost = scene.layers.iter().position(in_space);
        let problem =
            |lost| Problem::error(format!("/layers/{lost}"), "the layer is in space, and the scene has no camera");
        let hint = "set camera={}, or in the editor :camera fit, which sees everything";
        return lost.map(|lost| problem(lost).hint(hint)).into_iter().collect();
    };
    let (timeline, size_px) = (&scene.timeline, frame_size(scene, materials));
    let frames = timeline.frames();
    let step = frames.div_ceil(MOST_MOMENTS).max(1) as usize;
    let times = (0..frames).step_by(step).chain([frames - 1]).map(|frame| timeline.time_of(frame));
    let times = times.chain(camera.keys.iter().map(|key| key.at));
    let moment = |t| Moment { t, size_px, eye: Some(camera.at(t, size_px)), left_out: 0, magnified: 1 };
    let moments: Vec<Moment> = times.map(moment).collect();
    // What is shown on another layer is not seen by itself.
    let textures = scene.textures();
    let layers = scene.layers.iter().enumerate().filter(|(i, layer)| in_space(layer) && !textures.contains(i));
    let covering = |i: usize| {
        let above =
            scene.layers.iter().enumerate().skip(i + 1).filter(|(j, layer)| !in_space(layer) && !textures.contains(j));
        above.map(|(_, layer)| layer.technique()).find(|layer| layer.covers(size_px, materials))
    };
    let covered = |i: usize| {
        let message =
            format!("nothing of it is seen: the layer {} over it fills the frame", quoted(covering(i)?.name()));
        let hint = "move it up in the list, or give what is over it a picture that is clear where it is to be seen";
        Some(Problem::warning("", message).hint(hint))
    };
    let unseen = layers
        .filter_map(|(i, layer)| Some((i, layer.technique().unseen(&moments, materials).or_else(|| covered(i))?)));
    unseen.map(|(i, problem)| problem.under(&format!("/layers/{i}"))).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::base::picture::Picture;
    use crate::scene::Document;

    #[test]
    fn a_fall_behind_what_fills_the_frame_is_warned_of() {
        let picture = |size: usize, alpha: f32| Arc::new(Picture::filled(size, 8, [0.0, 0.0, 0.0, alpha]));
        let fall = r#"{ "kind": "waterfall", "name": "fall", "clip": "c" }"#;
        let picture_layer =
            |image: &str| format!(r#"{{ "kind": "picture", "name": "rocks", "image": "{image}", "zones": [] }}"#);
        let fill = |color: &str| format!(r#"{{ "kind": "fill", "name": "veil", "color": "{color}" }}"#);
        for (above, told) in [
            (picture_layer("whole"), Some("rocks")),
            (picture_layer("clear"), None),
            (picture_layer("small"), None),
            (fill("#102030"), Some("veil")),
            (fill("#10203080"), None),
        ] {
            for (layers, told) in [(format!("{fall}, {above}"), told), (format!("{above}, {fall}"), None)] {
                let text = format!(
                    r#"{{ "plica": 1, "size": [8, 8], "camera": {{}}, "clips": {{ "c": {{ "path": "c/%d.png" }} }},
                    "images": {{ "whole": {{ "path": "w.png" }}, "clear": {{ "path": "c.png" }}, "small": {{ "path": "s.png" }} }},
                    "layers": [{layers}] }}"#
                );
                let document = Document::parse(&text).unwrap();
                let pictures = [("whole", picture(8, 1.0)), ("clear", picture(9, 0.5)), ("small", picture(7, 1.0))];
                let pictures = pictures.into_iter().map(|(name, picture)| (name.to_owned(), picture)).collect();
                let found = problems(document.scene(), &Materials { pictures, ..Materials::default() });
                let found: Vec<String> = found.iter().map(ToString::to_string).collect();
                assert_eq!(found.len(), usize::from(told.is_some()), "{layers}: {found:?}");
                assert!(
                    told.is_none_or(|name| found[0].contains(&format!("the layer \"{name}\" over it"))),
                    "{found:?}"
                );
            }
        }
    }
}
