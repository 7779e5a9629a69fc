//! A surface that shows an image.

use std::sync::Arc;

use glam::DVec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::base::mesh::Mesh;
use crate::base::picture::Picture;
use crate::base::pixels::{Rgba, texture_place};
use crate::base::problem::Problem;
use crate::base::reduce::Reduced;
use crate::layers::mesh::pose::Placed;
use crate::layers::mesh::surface::{Before, Look, Reader, ReadySurface, StillSurface, SurfaceSlot};
use crate::layers::parts::materials::{List, Of, Use, What};
use crate::layers::parts::moment::Moment;
use crate::layers::parts::plan::Bind;
use crate::layers::ready::Making;

/// An image, by the texture coordinates of the mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Texture {
    /// The image, by its name in the scene's images; it repeats.
    #[schemars(extend("reference" = "images"))]
    pub image: String,
}

impl SurfaceSlot for Texture {
    fn uses(&self) -> Vec<Use<'_>> {
        vec![Use { at: "/image".into(), of: Of::Name(List::Images, &self.image), what: What::Picture }]
    }

    fn needs_uv(&self) -> bool {
        true
    }

    fn synth(&self, _mesh: &Arc<Mesh>, making: &Making, _before: Before) -> Result<Arc<dyn ReadySurface>, Problem> {
        Ok(Arc::new(Image(making.materials.picture(&self.image, "/image")?)))
    }
}

#[derive(Debug)]
struct Image(Arc<Picture>);

impl ReadySurface for Image {
    fn at<'a>(&'a self, _moment: &'a Moment, _placed: &Placed) -> Box<dyn StillSurface + 'a> {
        Box::new(Still(&self.0))
    }

    fn plan(&self, _moment: &Moment, _placed: &Placed) -> Look {
        Look::Picture(Bind::Upload(self.0.clone(), 0))
    }

    fn unmoved(self: Arc<Self>) -> Arc<dyn ReadySurface> {
        self
    }

    fn reduced(self: Arc<Self>, pictures: &mut Reduced) -> Arc<dyn ReadySurface> {
        Arc::new(Image(pictures.picture(&self.0)))
    }

    fn largest_texture(&self) -> usize {
        self.0.width().max(self.0.height())
    }
}

struct Still<'a>(&'a Picture);

impl Still<'_> {
    fn color(&self, uv: DVec2) -> Rgba {
        let (x, y) = texture_place(uv.to_array(), (self.0.width(), self.0.height()));
        self.0.read_repeated(x, y)
    }
}

impl StillSurface for Still<'_> {
    fn reader(&self) -> Reader<'_> {
        Box::new(|place| self.color(place.uv))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texture_coordinates_go_up_and_repeat() {
        let cells = [0.0, 0.25, 0.5, 1.0].map(|v| [v, v, v, 1.0]).to_vec();
        let picture = Picture::from_cells(2, 2, cells);
        let red = |u: f64, v: f64| Still(&picture).color(DVec2::new(u, v))[0];
        assert_eq!([red(0.25, 0.75), red(0.75, 0.75), red(0.25, 0.25), red(0.75, 0.25)], [0.0, 0.25, 0.5, 1.0]);
        assert_eq!([red(1.25, -0.25), red(-0.25, 3.25)], [0.0, 1.0]);
        // Over the edge, half of each side.
        assert_eq!(red(0.0, 0.75), 0.125);
        assert_eq!(red(1.0, 0.25), 0.75);
        assert_eq!(red(0.25, 0.0), 0.25);
    }
}
