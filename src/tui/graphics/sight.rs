//! What is seen in place of what the scene's camera sees, while one paints on a mesh.

use super::clip::alone;
use crate::layers::parts::marks::Mark;
use crate::layers::space::camera::Camera;
use crate::render::Synth;

/// What is seen.
#[derive(Clone, Debug, PartialEq)]
pub enum Sight {
    /// A picture that lies on a layer, over what its camera sees.
    Painting {
        /// The layer.
        layer: usize,
        /// The index of the picture.
        picture: usize,
        /// How much of the picture, from 0 to 1.
        share: f64,
    },
    /// All of it from elsewhere.
    From(Box<Camera>),
}

/// What a sight shows: a scene, and the marks over it where it is not the scene itself.
pub struct Visible {
    /// What there is to see.
    pub synth: Synth,
    /// The marks over a picture that stands alone; `None` where the scene is seen.
    pub marks: Option<Vec<Mark>>,
}

impl Sight {
    /// What is to be seen; `None` if there is nothing.
    pub fn of(&self, synth: &Synth) -> Option<Visible> {
        match self {
            Sight::From(camera) => Some(Visible { synth: synth.seen_from((**camera).clone()), marks: None }),
            Sight::Painting { layer, picture, share } => {
                let found = synth.layers.get(*layer)?.painted(*picture, *share)?;
                let told = |mark: Mark| Mark { path: format!("/layers/{layer}{}", mark.path), ..mark };
                let marks = found.marks.into_iter().map(told).collect();
                Some(Visible { synth: alone(found.picture)?, marks: Some(marks) })
            }
        }
    }
}
