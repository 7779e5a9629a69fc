//! Painting over what is seen: the picture that is painted on, and the one it is told apart from.

use std::path::{Path, PathBuf};

use glam::DVec3;

use super::base::{Base, MOST};
use super::beside::{FOLDER, file};
use crate::base::error::{Error, Result};
use crate::base::geometry;
use crate::base::problem::Problem;
use crate::base::progress::Watch;
use crate::export::still;
use crate::files::{disk, write};
use crate::layers::parts::pass::SHADE;
use crate::layers::parts::shots::{Feeds, SeenFrom};
use crate::layers::space::camera::Camera;
use crate::render::passes::Asked;
use crate::render::{self, Synth};
use crate::scene::Document;
use crate::scene::presets::Applied;
use crate::scene::shots::{self, Image, Picture};

/// From where a layer is seen, and when.
#[derive(Clone, Debug)]
pub struct Standpoint {
    /// The layer, by its index.
    pub layer: usize,
    /// The camera, in the world.
    pub camera: Camera,
    /// The scene time.
    pub time: f64,
    /// Width and height of the picture.
    pub size_px: (usize, usize),
}

impl Standpoint {
    /// What is seen of the layer, without what is drawn on its surface: a PNG.
    fn png(&self, synth: &Synth) -> Result<Vec<u8>> {
        let seen = Synth { size: self.size_px, ..synth.seen_from(self.camera.clone()) };
        let asked = Asked { pass: &SHADE, of: None, layer: Some(self.layer) };
        still::frame(&render::cpu::finish(&asked.picture(&seen, self.time))).map_err(|error| Error::at(FOLDER, error))
    }

    /// The same camera in the coordinates of the layer's model.
    fn of_model(&self, document: &Document) -> Option<SeenFrom> {
        let place = document.scene().layers.get(self.layer)?.technique().model_to_world(self.time)?;
        let ([position, target, up], fov) = self.camera.view(self.time);
        let model = place.inverse();
        let point = |at: DVec3| short(model.transform_point3(at));
        let (position, target) = (point(position), point(target));
        let up = short(model.transform_vector3(up).normalize_or_zero());
        let all = [position, target, up];
        let fits = all.iter().all(|at| at.is_finite()) && position != target && up != DVec3::ZERO;
        fits.then_some(SeenFrom::Standing {
            position,
            target,
            up: Some(up).filter(|up| *up != DVec3::Y),
            fov: Some(fov),
        })
    }
}

/// A place without decimals that nobody can see.
fn short(at: DVec3) -> DVec3 {
    geometry::rounded(at, 6)
}

/// A view that is to be painted over what is seen of a layer.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// What it is called.
    pub name: String,
    /// What it feeds.
    kind: String,
    sight: Standpoint,
    from: SeenFrom,
    /// The layer's name, by which it is found again.
    layer: String,
    /// Whether pictures that keep its look come with it.
    replaces: bool,
}

/// What is to be painted over, and what comes with it.
#[derive(Debug)]
pub struct Drawn {
    png: Vec<u8>,
    base: Base,
}

impl Wanted {
    /// What is to be added, by its name and what it feeds, to the scene at a path.
    ///
    /// # Errors
    /// The name is taken or cannot name a file, or nothing is seen.
    pub fn new(
        (scene, document): (&Path, &Document),
        sight: Standpoint,
        (name, kind): (&str, Option<&str>),
    ) -> Result<Wanted> {
        if name.contains(['/', '\\']) || name.starts_with('.') {
            return Err(wrong(name, "is no name for a file"));
        }
        let nothing = || Error::at(name, "the layer has no size, or nothing is seen of it");
        let from = sight.of_model(document).ok_or_else(nothing)?;
        let layer = document.scene().layers.get(sight.layer).map_or("", |layer| layer.technique().name()).to_owned();
        let (name, kind) = (name.to_owned(), kind.unwrap_or(Feeds::Dependent.word()).to_owned());
        let wanted = Wanted { name, kind, from, layer, replaces: shots::replaces(document, sight.layer), sight };
        wanted.applied((scene, document), Vec::new())?;
        Ok(wanted)
    }

    /// How many pieces of work it is to draw it.
    pub fn pieces(&self) -> usize {
        1 + if self.replaces { MOST } else { 0 }
    }

    /// Draws what is seen, and what keeps the look of the surface.
    ///
    /// # Errors
    /// It cannot be packed.
    pub fn draw(&self, document: &Document, synth: &Synth, watch: &Watch) -> Result<Drawn> {
        let png = self.sight.png(synth)?;
        (watch.done)(0);
        let base = Base::new(document, synth, (self.sight.layer, self.sight.time), &self.name, watch)?;
        Ok(Drawn { png, base })
    }

    /// Writes what is seen twice beside the scene, to be painted over and to be told apart from, and lays the first on the layer.
    /// Returns the layer, the edit, and the picture to paint on.
    ///
    /// # Errors
    /// As [`Wanted::new`], or nothing can be written.
    pub fn lay(&self, (scene, document): (&Path, &Document), drawn: &Drawn) -> Result<(usize, Applied, PathBuf)> {
        let (layer, applied) = self.applied((scene, document), drawn.base.pictures.clone())?;
        let (folder, own) = (disk::folder_of(scene), file(&self.name, false));
        drawn.base.write(scene)?;
        write::put_into(folder, &file(&self.name, true), &drawn.png)?;
        write::put_into(folder, &own, &drawn.png)?;
        Ok((layer, applied, folder.join(own)))
    }

    /// The layer as it is in a document now, and the edit; everything is checked before anything is written.
    fn applied(&self, (scene, document): (&Path, &Document), base: Vec<Picture>) -> Result<(usize, Applied)> {
        let name = &self.name;
        let layer = shots::layer(document, Some(&self.layer)).map_err(|why| Error::at(name, why))?;
        if shots::replaces(document, layer) != self.replaces {
            return Err(Error::at(name, "the surface has become another meanwhile").cure("add it again"));
        }
        let [own, guide] = [false, true].map(|guide| file(name, guide));
        let picture = Picture {
            name: name.clone(),
            image: Image::File(own.clone()),
            from: self.from,
            kind: Some(self.kind.clone()),
            feather_px: 0.0,
            edge_px: 0.0,
            guide: Some(guide.clone()),
        };
        let applied = shots::add(document, layer, picture, base).map_err(|why| Error::at(name, why))?;
        document.apply(&applied.edit).map_err(|problems| refused(name, &problems))?;
        let folder = disk::folder_of(scene);
        if let Some(there) = [&own, &guide].into_iter().find(|file| folder.join(file).symlink_metadata().is_ok()) {
            return Err(wrong(name, &format!("{there} is there already")));
        }
        Ok((layer, applied))
    }
}

fn wrong(name: &str, what: &str) -> Error {
    Error::at(name, what).cure("choose another name")
}

fn refused(name: &str, problems: &[Problem]) -> Error {
    Error::at(name, problems.first().map(ToString::to_string).unwrap_or_default())
}
