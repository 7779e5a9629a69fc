//! What is seen in place of what the scene's camera sees, while one paints on a mesh: in the terminal and in windows.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use serde_json::json;

use super::{Synth, synth};
use crate::base::picture::Picture;
use crate::layers::KINDS;
use crate::layers::parts::marks::Mark;
use crate::layers::parts::materials::{List, Materials};
use crate::layers::space::camera::Camera;
use crate::layers::starts::NewLayer;

/// What is seen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
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
    /// The marks over a picture that stands alone; `None` if the scene is seen.
    pub marks: Option<Vec<Mark>>,
}

impl Sight {
    /// What is to be seen; `None` if there is nothing.
    pub fn of(&self, synth: &Synth) -> Option<Visible> {
        match self {
            Sight::From(camera) => Some(Visible { synth: synth.seen_from((**camera).clone()), marks: None }),
            Sight::Painting { layer, picture, share } => {
                let found = synth.layers.get(*layer)?.painted(*picture, *share)?;
                let told = |mark: Mark| Mark { layer: Some(*layer), ..mark };
                let marks = found.marks.into_iter().map(told).collect();
                Some(Visible { synth: alone(found.picture)?, marks: Some(marks) })
            }
        }
    }

    /// Whether the cameras of pictures are seen, to select one of them.
    pub fn selects(&self) -> bool {
        matches!(self, Sight::From(_))
    }
}

/// A picture as a scene that shows nothing else.
pub fn alone(picture: Arc<Picture>) -> Option<Synth> {
    const NAME: &str = "frame";
    let templates = KINDS.iter().filter_map(|kind| kind.template);
    let shows = templates.into_iter().find(|template| template.of == List::Images)?;
    let layer = (shows.layer)(&NewLayer { name: NAME, bare: true, ..NewLayer::default() });
    let scene = json!({ "plica": 1, "images": { NAME: { "path": NAME } }, "layers": [layer] });
    let materials = Materials { pictures: [(NAME.to_owned(), picture)].into(), ..Materials::default() };
    synth(&serde_json::from_value(scene).ok()?, &materials, None).ok()
}
