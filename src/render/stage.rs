//! What all layers of a scene are shown in: the background, the camera, and which layers lie over which.

use crate::base::color;
use crate::base::pixels::{Rgba, decode};
use crate::layers::parts::moment::{Moment, Space};
use crate::layers::space::camera::Camera;
use crate::scene::Scene;

/// What the layers are shown in.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stage {
    /// The color behind all layers: linear light, premultiplied.
    pub background: Rgba,
    /// Where layers in space are seen from.
    pub camera: Option<Camera>,
    /// The layers by their indices, from bottom to top; those that others show as textures are left out.
    pub groups: Vec<Group>,
    /// See [`Moment::left_out`].
    pub left_out: u32,
    /// See [`Moment::magnified`].
    pub magnified: u32,
}

/// Layers that are composed as one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Group {
    /// A layer in the frame.
    Plane(usize),
    /// Neighbors in space: the nearest surface hides the others.
    World(Vec<usize>),
}

impl Group {
    /// Its layers.
    pub fn layers(&self) -> &[usize] {
        match self {
            Group::Plane(layer) => std::slice::from_ref(layer),
            Group::World(layers) => layers,
        }
    }
}

impl Stage {
    /// The stage of a scene.
    pub fn of(scene: &Scene) -> Stage {
        let textures = scene.textures();
        let mut groups: Vec<Group> = Vec::new();
        for (i, layer) in scene.layers.iter().enumerate().filter(|(i, _)| !textures.contains(i)) {
            match (layer.technique().kind().space, groups.last_mut()) {
                (Space::Plane, _) => groups.push(Group::Plane(i)),
                (Space::World, Some(Group::World(layers))) => layers.push(i),
                (Space::World, _) => groups.push(Group::World(vec![i])),
            }
        }
        let background = color::parse(&scene.background).map_or([0.0; 4], decode);
        Stage { background, camera: scene.camera.clone(), groups, left_out: 0, magnified: 1 }
    }

    /// What a frame at scene time `t` depends on besides the layers.
    pub fn moment(&self, t: f64, size_px: (usize, usize)) -> Moment {
        let eye = self.camera.as_ref().map(|camera| camera.at(t, size_px));
        Moment { t, size_px, eye, left_out: self.left_out, magnified: self.magnified }
    }

    /// The camera, if layers are seen by it.
    pub fn seen_by(&self) -> Option<&Camera> {
        let space = self.groups.iter().any(|group| matches!(group, Group::World(_)));
        self.camera.as_ref().filter(|_| space)
    }

    /// Only one of its layers, over nothing.
    pub fn only(&self, layer: usize) -> Stage {
        let group = |group: &Group| match group {
            Group::Plane(_) => Group::Plane(layer),
            Group::World(_) => Group::World(vec![layer]),
        };
        let groups = self.groups.iter().filter(|group| group.layers().contains(&layer)).map(group).collect();
        Stage { background: [0.0; 4], groups, ..self.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::parts::materials::Materials;
    use crate::render::{cpu, synth};

    #[test]
    fn the_frame_has_the_size_and_the_background_of_the_scene() {
        let scene: Scene = serde_json::from_str(
            r##"{"plica": 1, "size": [3, 2], "background": "#ff0000",
                "layers": [{"kind": "fill", "name": "veil", "color": "#00000080"}]}"##,
        )
        .unwrap();
        let synth = synth(&scene, &Materials::default(), None).unwrap();
        let frame = cpu::linear(&synth, 0.0);
        assert_eq!((frame.width(), frame.height()), (3, 2));
        let rest = 1.0 - 128.0 / 255.0;
        assert!(frame.cells().iter().all(|cell| (cell[0] - rest).abs() < 1e-6 && cell[3] == 1.0), "{frame:?}");
        assert_eq!(synth.stage.only(0).background, [0.0; 4]);
    }
}
