//! A surface that shows another layer at its own time.

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::base::mesh::Mesh;
use crate::base::pixels::{Linear, Rgba, bilinear_repeated, texture_place};
use crate::base::problem::Problem;
use crate::base::reduce::Reduced;
use crate::layers::mesh::pose::Placed;
use crate::layers::mesh::surface::{Before, Look, Reader, ReadySurface, StillSurface, SurfaceSlot};
use crate::layers::parts::materials::{List, Of, Use, What};
use crate::layers::parts::moment::{Columns, Moment};
use crate::layers::parts::plan::{Bind, DrawnTexture};
use crate::layers::ready::{Making, Texture};

/// A layer of the scene, by the texture coordinates of the mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LayerSurface {
    /// The layer, by its name; it is seen only here. Its picture repeats.
    #[schemars(extend("reference" = "layers"))]
    pub layer: String,
}

impl SurfaceSlot for LayerSurface {
    fn uses(&self) -> Vec<Use<'_>> {
        vec![Use { at: "/layer".into(), of: Of::Name(List::Layers, &self.layer), what: What::Layer }]
    }

    fn needs_uv(&self) -> bool {
        true
    }

    fn synth(&self, _mesh: &Arc<Mesh>, making: &Making, _before: Before) -> Result<Arc<dyn ReadySurface>, Problem> {
        let missing = || Problem::error("/layer", format!("the layer \"{}\" is not there", self.layer));
        Ok(Arc::new(LayerTexture(making.textures.get(&self.layer).cloned().ok_or_else(missing)?)))
    }
}

#[derive(Debug)]
struct LayerTexture(Texture);

impl LayerTexture {
    fn moment(&self, moment: &Moment) -> Moment {
        Moment { size_px: self.0.size_px, ..*moment }
    }
}

impl ReadySurface for LayerTexture {
    fn at<'a>(&'a self, moment: &'a Moment, _placed: &Placed) -> Box<dyn StillSurface + 'a> {
        let own = self.moment(moment);
        let still = self.0.layer.at(&own);
        let (width, height) = self.0.size_px;
        let mut picture = Linear::filled(width, height, [0.0; 4]);
        let (first, rest) = picture.cells_mut().split_at_mut(width);
        // By itself: it makes what all of them are read from, which others would make again.
        still.row(0, Columns::All, first);
        let rows = rest.par_chunks_mut(width.max(1)).enumerate().map(|(y, row)| (y + 1, row));
        rows.for_each(|(y, row)| still.row(y, Columns::All, row));
        drop(still);
        Box::new(Still(picture))
    }

    fn plan(&self, moment: &Moment, _placed: &Placed) -> Look {
        let plan = self.0.layer.plan(&self.moment(moment));
        Look::Picture(Bind::Drawn(Box::new(DrawnTexture { size_px: self.0.size_px, plan })))
    }

    fn unmoved(self: Arc<Self>) -> Arc<dyn ReadySurface> {
        Arc::new(LayerTexture(Texture { layer: self.0.layer.clone().unmoved(), size_px: self.0.size_px }))
    }

    fn reduced(self: Arc<Self>, pictures: &mut Reduced) -> Arc<dyn ReadySurface> {
        let by = pictures.by;
        let (width, height) = self.0.size_px;
        let layer = self.0.layer.reduced(pictures);
        Arc::new(LayerTexture(Texture { layer, size_px: (width.div_ceil(by), height.div_ceil(by)) }))
    }

    fn largest_texture(&self) -> usize {
        self.0.layer.largest_texture().max(self.0.size_px.0).max(self.0.size_px.1)
    }
}

/// The layer's picture at one time.
struct Still(Linear);

impl Still {
    fn color(&self, uv: DVec2) -> Rgba {
        let size = (self.0.width(), self.0.height());
        bilinear_repeated(size, texture_place(uv.to_array(), size), |i| self.0.cells()[i])
    }
}

impl StillSurface for Still {
    fn reader(&self) -> Reader<'_> {
        Box::new(|place| self.color(place.uv))
    }
}
