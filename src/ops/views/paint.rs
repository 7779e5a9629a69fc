//! Painting over what is seen: the picture that is painted on, and the one it is told apart from.

use std::path::{Path, PathBuf};

use glam::DVec3;

use super::base::Base;
use super::beside::{FOLDER, file};
use crate::base::error::{Error, Result};
use crate::base::geometry;
use crate::base::problem::Problem;
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

/// Writes what is seen twice beside the scene, to be painted over and to be told apart from, and lays the first on the layer.
/// Returns the edit and the picture to paint on.
///
/// # Errors
/// The name is taken or cannot name a file, or nothing can be written.
pub fn begin(
    (scene, document): (&Path, &Document),
    synth: &Synth,
    sight: &Standpoint,
    (name, kind): (&str, Option<&str>),
) -> Result<(Applied, PathBuf)> {
    let wrong = |what: &str| Error::at(name, what).cure("choose another name");
    if name.contains(['/', '\\']) || name.starts_with('.') {
        return Err(wrong("is no name for a file"));
    }
    let from =
        sight.of_model(document).ok_or_else(|| Error::at(name, "the layer has no size, or nothing is seen of it"))?;
    let picture = Picture {
        name: name.to_owned(),
        image: Image::File(file(name, false)),
        from,
        kind: Some(kind.unwrap_or(Feeds::Dependent.word()).to_owned()),
        feather_px: 0.0,
        edge_px: 0.0,
        guide: Some(file(name, true)),
    };
    let base = Base::new(document, synth, (sight.layer, sight.time), name)?;
    // Checked before anything is written.
    let applied =
        shots::add(document, sight.layer, picture, base.pictures.clone()).map_err(|why| Error::at(name, why))?;
    document.apply(&applied.edit).map_err(|problems| refused(name, &problems))?;
    let folder = disk::folder_of(scene);
    let (own, guide) = (file(name, false), file(name, true));
    if let Some(there) = [&own, &guide].into_iter().find(|file| folder.join(file).symlink_metadata().is_ok()) {
        return Err(wrong(&format!("{there} is there already")));
    }
    let png = sight.png(synth)?;
    base.write(scene)?;
    write::put_into(folder, &guide, &png)?;
    write::put_into(folder, &own, &png)?;
    Ok((applied, folder.join(own)))
}

fn refused(name: &str, problems: &[Problem]) -> Error {
    Error::at(name, problems.first().map(ToString::to_string).unwrap_or_default())
}
