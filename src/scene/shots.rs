//! Pictures with cameras laid on a layer: which one, under which names, and the edit that does it.

use glam::DAffine3;
use serde_json::{Map, json};

use super::build::unique_name;
use super::presets::Applied;
use super::{Document, Edit};
use crate::base::number;
use crate::base::pointer::Pointer;
use crate::base::problem::{Problem, quoted};
use crate::base::text::counted;
use crate::layers::parts::materials::{List, Of, What};
use crate::layers::parts::shots::{Laid, Laying, SeenFrom, Shot};
use crate::layers::starts::NewLayer;
use crate::layers::technique::Kind;
use crate::layers::{KINDS, Layer};

/// A picture that is to lie on a layer.
#[derive(Clone, Debug)]
pub struct Picture {
    /// What it is to be called; a number follows where that is taken.
    pub name: String,
    /// The image.
    pub image: Image,
    /// Its camera, in the model's coordinates.
    pub from: SeenFrom,
    /// What it is for, in the document's word; `None` is the usual.
    pub kind: Option<String>,
    /// How far it fades towards its border, in pixels.
    pub feather_px: f64,
    /// How much of it is left out beside steps in depth, in pixels.
    pub edge_px: f64,
    /// The file of the image that it is painted over, by its path in the scene, if it is.
    pub guide: Option<String>,
}

/// The image of a picture.
#[derive(Clone, Debug)]
pub enum Image {
    /// One of the scene, by its name.
    Named(String),
    /// A file, by its path in the scene.
    File(String),
}

/// The layer `name`, or the first that has pictures with cameras, or the first that can have them; by its index.
///
/// # Errors
/// There is none.
pub fn layer(document: &Document, name: Option<&str>) -> Result<usize, String> {
    let scene = document.scene();
    let lying = |i: usize| scene.layers[i].technique().lying();
    if let Some(name) = name {
        let index = scene.layer_called(name)?;
        return match lying(index) {
            Some(_) => Ok(index),
            None => Err(format!("pictures with cameras lie on meshes, and {} is none", quoted(name))),
        };
    }
    let all = 0..scene.layers.len();
    let first = all.clone().find(|i| lying(*i).is_some_and(|lying| !lying.is_empty()));
    first.or_else(|| all.clone().find(|i| lying(*i).is_some())).ok_or_else(|| "the scene has no mesh".into())
}

/// The mesh of a layer: its name, and the path of the file in which it is.
pub fn mesh_of(document: &Document, layer: usize) -> Option<(&str, &str)> {
    let scene = document.scene();
    scene.layers[layer].technique().uses().into_iter().find_map(|used| match (used.of, used.what) {
        (Of::Name(List::Meshes, name), What::Mesh) => scene.meshes.get(name).map(|mesh| (name, &*mesh.path)),
        _ => None,
    })
}

/// Adds a mesh in a file and a layer that shows it; the edit, and the index of the layer.
pub fn add_mesh(document: &Document, name: &str, path: &str) -> Option<(Edit, usize)> {
    let entry = Map::from_iter([(name.to_owned(), json!({ "path": path }))]);
    let (mesh, at) = Edit::insert_entries(document, "/meshes", entry)?;
    let (_, called) = Pointer(&at).split()?;
    let makes = |kind: &&&Kind| kind.template.is_some_and(|template| template.of == List::Meshes);
    let template = KINDS.iter().find(makes)?.template?;
    let layer = (template.layer)(&NewLayer { name: &called, ..NewLayer::default() });
    let index = document.scene().layers.len();
    let (layer, _) = Edit::insert_all(document, "/layers", index, vec![layer])?;
    Some((Edit::all([mesh, layer]), index))
}

/// Lays pictures on a layer. One whose image lies there already is left out.
///
/// # Errors
/// The layer can have none, or no image is left.
pub fn lay(document: &Document, layer: usize, pictures: Vec<Picture>) -> Result<Applied, String> {
    laid(document, layer, pictures, true)
}

fn laid(document: &Document, layer: usize, pictures: Vec<Picture>, once: bool) -> Result<Applied, String> {
    let technique = document.scene().layers.get(layer).map(Layer::technique).ok_or("there is no such layer")?;
    let lying = technique.lying().ok_or_else(|| format!("{} has no pictures", quoted(technique.name())))?;
    let mut names: Vec<String> = lying.iter().map(|lying| lying.name.to_owned()).collect();
    let mut images: Vec<(String, String)> =
        document.scene().images.iter().map(|(name, image)| (name.clone(), image.path.clone())).collect();
    let mut fresh = Map::new();
    let (mut laid, wanted) = (Vec::new(), pictures.len());
    let mut named = |path: String, wanted: &str| match images.iter().find(|(_, known)| *known == path) {
        Some((name, _)) => name.clone(),
        None => {
            let name = unique_name(wanted, |name| images.iter().any(|(known, _)| known == name));
            fresh.insert(name.clone(), json!({ "path": path }));
            images.push((name.clone(), path));
            name
        }
    };
    for picture in pictures {
        let image = match picture.image {
            Image::Named(name) => name,
            Image::File(path) => named(path, &picture.name),
        };
        if once && lying.iter().any(|lying| lying.image == image) {
            continue;
        }
        let name = unique_name(&picture.name, |name| names.iter().any(|taken| taken == name));
        names.push(name.clone());
        let guide = picture.guide.map(|path| named(path, &format!("{name}-guide")));
        let Picture { from, kind, feather_px, edge_px, .. } = picture;
        laid.push(Laid { name, image, from, kind, feather_px, edge_px, guide });
    }
    let there = wanted - laid.len();
    let there = if there > 0 { format!("; {there} lie there already") } else { String::new() };
    let told = format!("{} laid on {}{there}", counted(laid.len(), "picture"), technique.name());
    if laid.is_empty() {
        return Ok(Applied { edit: Edit::default(), told });
    }
    let Laying { first, list, items } = technique.lay(&laid).ok_or("nothing can lie there")?;
    let mut edits: Vec<Edit> =
        Edit::insert_entries(document, "/images", fresh).map(|(edit, _)| edit).into_iter().collect();
    let at = |path: &str| format!("/layers/{layer}{path}");
    edits.extend(first.map(|(path, value)| Edit::set(document, &at(path), value)));
    let with = document.apply(&Edit::all(edits.clone())).map_err(|problems| words(&problems))?;
    edits.extend(Edit::insert_all(&with, &at(list), usize::MAX, items).map(|(edit, _)| edit));
    Ok(Applied { edit: Edit::all(edits), told })
}

fn words(problems: &[Problem]) -> String {
    problems.first().map(Problem::to_string).unwrap_or_default()
}

/// Whether the surface of a layer gives way to the first picture that lies there.
pub fn replaces(document: &Document, layer: usize) -> bool {
    let laying = document.scene().layers.get(layer).and_then(|layer| layer.technique().lay(&[]));
    laying.is_some_and(|laying| laying.first.is_some())
}

/// Lays one picture on a layer under its own name, also where its image lies there already. If the surface gives way to it,
/// `base` are the pictures that keep what it showed.
///
/// # Errors
/// The name is taken, or the layer can have none.
pub fn add(document: &Document, layer: usize, picture: Picture, base: Vec<Picture>) -> Result<Applied, String> {
    let technique = document.scene().layers.get(layer).map(Layer::technique).ok_or("there is no such layer")?;
    let lying = technique.lying().ok_or_else(|| format!("{} has no pictures", quoted(technique.name())))?;
    if lying.iter().any(|lying| lying.name == picture.name) {
        return Err(format!("the name {} is taken by another view", quoted(&picture.name)));
    }
    if base.is_empty() || !replaces(document, layer) {
        return laid(document, layer, vec![picture], false);
    }
    let (count, pictures) = (base.len(), base.into_iter().chain([picture]).collect());
    let Applied { edit, .. } = laid(document, layer, pictures, false)?;
    let name = technique.name();
    let told = format!("1 picture laid on {name}; {} of it as it was are its base coat", counted(count, "picture"));
    Ok(Applied { edit, told })
}

/// The camera that sees what `shot` sees, through the pose of the model, looking at a place on its axis so far away; for a
/// picture of that height.
pub fn camera(document: &Document, shot: &Shot, place: &DAffine3, distance: f64, height_px: f64) -> Edit {
    let position = shot.position();
    let target = position + shot.forward() * distance;
    let point = |point| place.transform_point3(point).to_array().map(number::json);
    let up = place.transform_vector3(shot.up()).normalize_or_zero().to_array().map(number::json);
    let camera = json!({ "position": point(position), "target": point(target), "up": up, "fov": number::json(shot.fov(height_px)) });
    Edit::set(document, "/camera", camera)
}
