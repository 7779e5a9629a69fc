//! How a scene is looked at for now, which the document knows nothing of: without some of its things, in several ways side
//! by side, or as one sees it who paints on it.

use std::sync::Arc;

use super::beside::Beside;
use super::sight::{Sight, Visible};
use super::{Synth, frame_size, synth};
use crate::base::problem::Problem;
use crate::layers::parts::marks::Mark;
use crate::layers::parts::materials::Materials;
use crate::scene::Scene;

/// See the top of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shown {
    /// What is not shown: JSON pointers.
    pub muted: Vec<String>,
    /// The comparison that is shown, such as "anchor": see [`Scene::compared`].
    pub compared: Option<String>,
    /// What is seen in place of what the camera sees.
    pub sight: Option<Sight>,
}

impl Shown {
    /// What is shown of a scene, for overlays and for what is told of pixels, and its synthesis, in which what `previous` has in
    /// common with it is reused. Nothing is told of several ways.
    ///
    /// # Errors
    /// As [`synth`], and if the scene has no such ways.
    pub fn synth(
        &self,
        scene: &Arc<Scene>,
        materials: &Materials,
        previous: Option<&Synth>,
    ) -> Result<(Arc<Scene>, Synth), Problem> {
        let shown = match self.muted.is_empty() {
            true => scene.clone(),
            false => Arc::new(scene.without(&self.muted, frame_size(scene, materials))),
        };
        let Some(by) = &self.compared else {
            let synth = synth(&shown, materials, previous)?;
            return Ok((shown, synth));
        };
        let wanted = shown.compared(by).map_err(|why| Problem::error("/layers", why).hint(":compare none"))?;
        let before = previous.and_then(|synth| synth.layers.first()?.downcast::<Beside>());
        let mut ways: Vec<Synth> = Vec::new();
        for (i, (_, scene)) in wanted.iter().enumerate() {
            let own = before.and_then(|before| before.ways.get(i)).or(ways.last()).or(previous);
            ways.push(synth(scene, materials, own)?);
        }
        let synth = Beside::synth(ways);
        Ok((Arc::new(frames_alone(&shown, &synth)), synth))
    }

    /// What is seen of the same in place of what the camera sees, with the marks over it; as it was if that is not there.
    pub fn seen(&self, scene: Arc<Scene>, synth: Synth) -> (Arc<Scene>, Synth, Vec<Mark>) {
        match self.sight.as_ref().and_then(|sight| sight.of(&synth)) {
            Some(Visible { synth, marks: Some(marks) }) => (Arc::new(frames_alone(&scene, &synth)), synth, marks),
            Some(Visible { synth, marks: None }) => (scene, synth, Vec::new()),
            None => (scene, synth, Vec::new()),
        }
    }
}

/// A scene of which nothing is told but its frames.
fn frames_alone(scene: &Scene, synth: &Synth) -> Scene {
    let side = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
    let size = Some([side(synth.size.0), side(synth.size.1)]);
    Scene { layers: Vec::new(), camera: None, size, ..scene.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::pixels::side_by_side;
    use crate::layers::space::camera::Camera;
    use crate::render::cpu;
    use crate::render::samples::square_with_strokes;

    #[test]
    fn ways_are_side_by_side_and_what_is_muted_is_in_none() {
        let (scene, materials) = square_with_strokes();
        let shown = |muted: &[&str], compared: Option<&str>| {
            let muted = muted.iter().map(|one| (*one).to_owned()).collect();
            Shown { muted, compared: compared.map(str::to_owned), sight: None }.synth(&scene, &materials, None)
        };
        let (told, plain) = shown(&[], None).unwrap();
        assert!(Arc::ptr_eq(&told, &scene));
        let (told, three) = shown(&[], Some("anchor")).unwrap();
        assert_eq!((told.layers.len(), three.size), (0, (3 * plain.size.0, plain.size.1)));
        let ways = scene.compared("anchor").unwrap();
        let frames: Vec<_> =
            ways.iter().map(|(_, way)| cpu::linear(&synth(way, &materials, None).unwrap(), 0.5)).collect();
        assert!(frames[0] != frames[1] && frames[1] != frames[2]);
        assert_eq!(cpu::linear(&three, 0.5), side_by_side(&frames));
        // From elsewhere; and there is no picture to paint on.
        let painting = Sight::Painting { layer: 0, picture: 0, share: 0.5 };
        let nearer = Camera { position: [0.0, 0.0, 2.5], fov: 40.0, ..Camera::default() };
        for (sight, is_seen) in [(Sight::From(Box::new(nearer)), true), (painting, false)] {
            let shown = Shown { sight: Some(sight.clone()), ..Shown::default() };
            let (told, synth, marks) = shown.seen(scene.clone(), plain.clone());
            assert!(Arc::ptr_eq(&told, &scene) && marks.is_empty(), "{sight:?}");
            assert_eq!(cpu::linear(&synth, 0.5) != cpu::linear(&plain, 0.5), is_seen, "{sight:?}");
        }
        // What was made before is taken over only where it is the same.
        let shown_by_style = Shown { compared: Some("style".into()), ..Shown::default() };
        let (_, again) = shown_by_style.synth(&scene, &materials, Some(&three)).unwrap();
        let (_, anew) = shown_by_style.synth(&scene, &materials, None).unwrap();
        assert_eq!(cpu::linear(&again, 0.5), cpu::linear(&anew, 0.5));
        let why = shown(&["/layers/0"], Some("anchor")).unwrap_err().to_string();
        assert!(why.contains("no layer has strokes"), "{why}");
    }
}
