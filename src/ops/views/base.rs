//! What a surface showed before pictures lie on it, as their base coat: pictures of it from around, in files of their own.

use std::path::Path;

use super::beside::FOLDER;
use crate::base::error::{Error, Result};
use crate::base::progress::Watch;
use crate::export::still;
use crate::files::{disk, write};
use crate::layers::parts::shots::Feeds;
use crate::render::{self, Synth};
use crate::scene::Document;
use crate::scene::shots::{self, Image, Picture};

/// A pixel beside what hides something is left out, or it would show on that.
const EDGE_PX: f64 = 1.0;
/// How many pixels the side of one may have.
const SIDES: (usize, usize) = (64, 1024);
/// How many there are at most.
pub const MOST: usize = 14;

/// The pictures, and their files.
#[derive(Debug, Default)]
pub struct Base {
    /// The pictures, as they are to lie on the layer.
    pub pictures: Vec<Picture>,
    /// Each by its path in the scene.
    files: Vec<(String, Vec<u8>)>,
}

impl Base {
    /// Those of a layer at a scene time, for a view of this name; none if pictures can lie on it as it is. Each is one piece of work.
    ///
    /// # Errors
    /// One cannot be packed.
    pub fn new(
        document: &Document,
        synth: &Synth,
        (layer, time): (usize, f64),
        name: &str,
        watch: &Watch,
    ) -> Result<Base> {
        let mut base = Base::default();
        if !shots::replaces(document, layer) {
            return Ok(base);
        }
        let side_px = synth.size.0.max(synth.size.1).clamp(SIDES.0, SIDES.1);
        for taken in synth.layers.get(layer).map(|ready| ready.around(time, side_px, watch)).unwrap_or_default() {
            let path = format!("{FOLDER}/{name}-base-{}.png", taken.name);
            let png = still::frame(&render::cpu::finish(&taken.picture)).map_err(|error| Error::at(&path, error))?;
            base.pictures.push(Picture {
                name: format!("base-{}", taken.name),
                image: Image::File(path.clone()),
                from: taken.from,
                kind: Some(Feeds::Independent.word().into()),
                feather_px: 0.0,
                edge_px: EDGE_PX,
                guide: None,
            });
            base.files.push((path, png));
        }
        Ok(base)
    }

    /// Writes the files beside the scene.
    ///
    /// # Errors
    /// One cannot be written, or another file has its name.
    pub fn write(&self, scene: &Path) -> Result<()> {
        self.files.iter().try_for_each(|(path, png)| write::put_into(disk::folder_of(scene), path, png))
    }
}
