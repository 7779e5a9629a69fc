//! `plica views add`: a picture on a mesh, seen from a place.

use std::path::{Path, PathBuf};

use glam::DVec3;

use super::base::{Base, MOST};
use super::beside::Beside;
use super::feather;
use crate::base::error::Result;
use crate::base::problem::{nearest, quoted};
use crate::files::{Limits, disk, paths, picture};
use crate::layers::parts::shots::{Feeds, SeenFrom};
use crate::ops::opened::Unloaded;
use crate::ops::scene_options::{RecoveryOptions, SceneOptions};
use crate::ops::watched::in_pieces;
use crate::ops::{Context, set};
use crate::scene::Document;
use crate::scene::shots::{self, Image, Picture};

#[derive(clap::Args)]
pub struct Args {
    /// What the view is called
    name: String,
    /// The scene
    scene: PathBuf,
    /// Name of the layer [default: the first mesh with views, otherwise the first mesh]
    #[arg(long, value_name = "LAYER")]
    layer: Option<String>,
    /// The picture: the name of an image of the scene, or a file
    #[arg(long, value_name = "IMAGE")]
    image: String,
    /// Where it is seen from, in the model's coordinates
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = place)]
    position: DVec3,
    /// What it looks at, in the model's coordinates
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = place, default_value = "0,0,0")]
    target: DVec3,
    /// Its vertical field of view, in degrees [default: 40]
    #[arg(long, value_name = "DEGREES")]
    fov: Option<f64>,
    /// What the view feeds
    #[arg(long, value_name = "KIND", value_parser = Feeds::ALL.map(Feeds::word))]
    kind: Option<String>,
    #[command(flatten)]
    recovery: RecoveryOptions,
    #[command(flatten)]
    reading: SceneOptions,
}

fn place(text: &str) -> std::result::Result<DVec3, String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    match numbers[..] {
        [x, y, z] if text.split(',').count() == 3 && [x, y, z].iter().all(|v| v.is_finite()) => Ok(DVec3::new(x, y, z)),
        _ => Err("expected three numbers, as 0,1.2,4".into()),
    }
}

/// Lays the picture on the layer, as one edit.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    set::refuse_input(&args.scene)?;
    let options = args.reading.options()?;
    let path = found(&args.image, &args.scene, &options.limits);
    let file = path.as_deref().map(|path| Beside::new(path, disk::folder_of(path), &args.scene)).transpose()?;
    let base = base(&args, context)?;
    let make = |document: &Document| {
        let layer = shots::layer(document, args.layer.as_deref())?;
        let images = &document.scene().images;
        let image = match &file {
            _ if images.contains_key(&args.image) => Image::Named(args.image.clone()),
            Some(file) => Image::File(file.path.clone()),
            None => {
                let hint = nearest(&args.image, images.keys().map(String::as_str));
                let hint = hint.map(|hint| format!(" ({hint})")).unwrap_or_default();
                return Err(format!(
                    "there is no image {}{hint}, and no picture in a file of that name here or beside the scene",
                    quoted(&args.image)
                ));
            }
        };
        let from = SeenFrom::Standing { position: args.position, target: args.target, up: None, fov: args.fov };
        let (name, kind) = (args.name.clone(), args.kind.clone());
        let feather_px = match &image {
            Image::Named(image) => images.get(image).map(|image| paths::beside(&args.scene, &image.path)),
            Image::File(_) => path.clone(),
        };
        let feather_px = feather_px.and_then(|path| picture::read(&path, &options.limits).ok());
        let feather_px = feather_px.map_or(0.0, |read| feather::px(&read.picture));
        let picture = Picture { name, image, from, kind, feather_px, edge_px: 0.0, guide: None };
        shots::add(document, layer, picture, base.pictures.clone())
    };
    base.write(&args.scene)?;
    if let Some(file) = &file {
        file.copy(&args.scene)?;
    }
    set::apply(&args.scene, (&args.recovery, &args.reading), make, context)
}

/// Where the file of a picture is: named from here, or as a scene names it.
fn found(image: &str, scene: &Path, limits: &Limits) -> Option<PathBuf> {
    let places = [PathBuf::from(image), paths::beside(scene, image)];
    places.into_iter().find(|path| picture::size(path, limits).is_ok())
}

/// What keeps the look of the surface, if it gives way to the picture: only then it is drawn.
fn base(args: &Args, context: &mut Context) -> Result<Base> {
    let unloaded = Unloaded::read(&args.scene, &args.reading, context)?;
    match shots::layer(&unloaded.document, args.layer.as_deref()) {
        Ok(layer) if shots::replaces(&unloaded.document, layer) => {
            let opened = unloaded.load(context)?;
            let synth = opened.synth_told(&mut *context.messages)?;
            in_pieces(context, "picture", MOST, |watch| {
                Base::new(&opened.document, &synth, (layer, 0.0), &args.name, watch)
            })?
        }
        _ => Ok(Base::default()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::pixels::Frame;
    use crate::export::still;

    #[test]
    fn a_picture_is_found_from_here_and_beside_the_scene() {
        let folder = tempfile::tempdir().unwrap();
        let [scene, clay] = ["a.plica.json", "clay.png"].map(|name| folder.path().join(name));
        std::fs::write(&clay, still::frame(&Frame::from_cells(1, 1, vec![[0; 4]])).unwrap()).unwrap();
        for (image, there) in [("clay.png", true), (clay.to_str().unwrap(), true), ("mud.png", false)] {
            assert_eq!(found(image, &scene, &Limits::default()), there.then(|| clay.clone()), "{image}");
        }
    }
}
