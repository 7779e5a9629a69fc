//! What is made of a scene: all that its frames need, and what was made whole of the last of them (`whole.rs`).

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

#[cfg(feature = "window")]
use super::stage::Group;
use super::stage::Stage;
use crate::base::last::Last;
use crate::base::pixels::Rgba;
use crate::base::problem::Problem;
use crate::layers::parts::moment::Moment;
use crate::layers::parts::pass::Pass;
use crate::layers::ready::Ready;
use crate::layers::space::camera::Camera;

/// Everything that a frame of a scene needs except the time.
#[derive(Clone, Debug, Default)]
pub struct Synth {
    /// Width and height of a frame, in pixels.
    pub size: (usize, usize),
    /// The layers, in the scene's order.
    pub layers: Vec<Arc<dyn Ready>>,
    /// What they are shown in.
    pub stage: Arc<Stage>,
    /// Once it is set, frames are given up, with anything in them.
    pub stop: Option<Arc<AtomicBool>>,
    /// What was made whole of the last frame of which some pixels were wanted.
    pub kept: LastMade,
}

impl Synth {
    /// What a frame at scene time `t` depends on besides the layers.
    pub fn moment(&self, t: f64) -> Moment {
        self.stage.moment(t, self.size)
    }

    /// Whether anything of it may be in its frame at one scene time.
    pub fn shows_something(&self, t: f64) -> bool {
        let moment = self.moment(t);
        let drawn = self.stage.groups.iter().flat_map(|group| group.layers());
        drawn.filter_map(|&layer| self.layers.get(layer)).any(|layer| layer.is_in_frame(&moment))
    }

    /// What its layers do not show, as there was too little memory for it (`Materials::leaves_out`).
    pub fn lacks(&self) -> Vec<Problem> {
        let layers = self.layers.iter().enumerate();
        layers.filter_map(|(i, layer)| Some(layer.lacks()?.under(&format!("/layers/{i}")))).collect()
    }

    /// Whether it has strokes.
    pub fn has_strokes(&self) -> bool {
        self.layers.iter().any(|layer| layer.has_strokes())
    }

    /// Why the CPU alone can draw it; `None` if a GPU can too.
    pub fn by_cpu(&self) -> Option<&'static str> {
        self.layers.iter().find_map(|layer| layer.by_cpu())
    }

    /// Whether the CPU takes long for a frame: one should not wait for it.
    pub fn takes_long(&self) -> bool {
        self.layers.iter().any(|layer| layer.takes_long())
    }

    /// Whether its frames are given up.
    pub fn is_stopped(&self) -> bool {
        self.stop.as_ref().is_some_and(|stop| stop.load(Ordering::Relaxed))
    }

    /// The same, whose frames are given up once `stop` is set.
    pub fn stoppable(&self, stop: &Arc<AtomicBool>) -> Synth {
        let layer = |layer: &Arc<dyn Ready>| layer.stoppable(stop).unwrap_or_else(|| layer.clone());
        Synth { layers: self.layers.iter().map(layer).collect(), stop: Some(stop.clone()), ..self.clone() }
    }

    /// The same, seen by another camera.
    pub fn seen_from(&self, camera: Camera) -> Synth {
        let stage = Stage { camera: Some(camera), ..(*self.stage).clone() };
        Synth { stage: Arc::new(stage), ..self.clone() }
    }

    /// The same with only one of its layers, over nothing.
    pub fn only(&self, layer: usize) -> Synth {
        Synth { stage: Arc::new(self.stage.only(layer)), ..self.clone() }
    }

    /// The same with so many births left out after each that is shown: see [`Moment::left_out`].
    #[cfg(feature = "window")]
    pub fn thinned(&self, left_out: u32) -> Synth {
        let stage = Stage { left_out, ..(*self.stage).clone() };
        Synth { stage: Arc::new(stage), ..self.clone() }
    }

    /// The same of a frame that is so many times larger on each side, with all samples of a pixel in pixels of their own; `None` if
    /// something in it is of a fixed number of pixels: a layer in the frame, or sprites.
    #[cfg(feature = "window")]
    pub fn magnified(&self, by: u32) -> Option<Synth> {
        let in_space = self.stage.groups.iter().all(|group| matches!(group, Group::World(_)));
        let fixed = !in_space || self.layers.iter().any(|layer| layer.has_sprites());
        let stage = Stage { magnified: by, ..(*self.stage).clone() };
        let size = (self.size.0 * by as usize, self.size.1 * by as usize);
        (!fixed).then(|| Synth { size, stage: Arc::new(stage), ..self.clone() })
    }

    /// The same with nothing that moves.
    pub fn unmoved(&self) -> Synth {
        let camera = self.stage.camera.as_ref().map(|camera| camera.unmoved());
        let stage = Stage { camera, ..(*self.stage).clone() };
        let layers = self.layers.iter().map(|layer| layer.clone().unmoved()).collect();
        Synth { layers, stage: Arc::new(stage), ..self.clone() }
    }
}

/// The groups of a scene at one time that are made whole.
#[derive(Debug)]
pub struct Wholes {
    /// How many samples a pixel has in each direction.
    pub(super) each_way: usize,
    /// One for each group; `None` for those that are made row by row.
    pub(super) groups: Vec<Option<Whole>>,
}

/// What was made whole last, for those who want some pixels after others: of a frame, and of a pass.
#[derive(Clone, Debug, Default)]
pub struct LastMade {
    pub(super) frame: Last<MadeOf, Wholes>,
    pub(super) pass: Last<MadeOf, DrawnPass>,
}

/// What of a pass is drawn on surfaces.
#[derive(Debug)]
pub struct DrawnPass {
    pub(super) pass: Pass,
    pub(super) of: Option<String>,
    /// One for each group, all its pixels; `None` if nothing is drawn.
    pub groups: Vec<Option<Vec<Rgba>>>,
}

/// The scene time, the stage and the layers.
pub(super) type MadeOf = (f64, Arc<Stage>, Vec<Arc<dyn Ready>>);

/// All pixels of a group.
#[derive(Debug)]
pub struct Whole {
    pub(super) width: usize,
    /// Their colors, premultiplied.
    pub(super) color: Vec<Rgba>,
    /// How far away they are, in meters.
    pub(super) depth: Vec<f64>,
    /// Which layer each is of.
    pub(super) layer: Vec<u32>,
    /// Which part of it.
    pub(super) part: Vec<u32>,
}

#[cfg(test)]
mod tests {
    use super::super::samples;
    use super::*;

    #[test]
    fn whether_anything_is_in_the_frame_is_known_without_drawing() {
        let (_, synth) = samples::two_squares();
        for (position, target, shows) in [
            ([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], true),
            ([0.0, 0.0, 4.0], [0.0, 0.0, 9.0], false),
            ([0.0, 0.0, 4.0], [40.0, 0.0, 0.0], false),
            ([0.0, 0.0, -4.0], [0.0, 0.0, 0.0], false),
            ([0.0, 0.0, -0.5], [0.0, 0.0, -4.0], true),
        ] {
            let seen = synth.seen_from(Camera { position, target, ..Camera::default() });
            assert_eq!(seen.shows_something(0.0), shows, "{position:?} {target:?}");
        }
    }
}
