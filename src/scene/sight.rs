//! What is seen of a scene once its files are there: how large its frame is, and which layers are never in it.

use super::{FRAME, Scene};
use crate::base::problem::Problem;
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

/// Layers in space that no camera sees, or that are in the frame at no time.
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
    let unseen = layers.filter_map(|(i, layer)| Some((i, layer.technique().unseen(&moments, materials)?)));
    unseen.map(|(i, problem)| problem.under(&format!("/layers/{i}"))).collect()
}
