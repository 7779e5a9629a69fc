//! What else a glTF model names: the pictures that its surfaces show, those that are in the file itself, and the files
//! of its buffers.

use std::borrow::Cow;
use std::collections::BTreeSet;

use super::document::{Primitive, Text};
use super::nodes::nodes;
use super::source::{Source, With, data};
use crate::base::budget::Share;
use crate::base::error::{Error, Result};
use crate::files::paths;

/// The pictures of the base colors of the default scene, each once, in the order in which its nodes show them. Paths are
/// as a scene names them that names the model by `place`.
pub(in crate::files::mesh) fn named(bytes: &[u8], with: With) -> Result<Vec<String>> {
    let source = &Source::of(bytes, with)?;
    let named = |index: usize| -> Result<String> {
        let image = source.get(&source.document.images, index, "image")?;
        Ok(match outside(&image.uri) {
            Some(uri) => paths::sibling(with.place, &source.path(uri)?),
            None => format!("{}#{index}", with.place),
        })
    };
    shown(source)?.into_iter().map(named).collect()
}

/// The file, relative to its own, of the first picture that its surfaces show; `None` if that is in it, or if there is none.
pub(super) fn first_file(source: &Source) -> Option<String> {
    let image = source.document.images.get(*shown(source).ok()?.first()?)?;
    // Where that may not be is told by whoever opens it.
    source.any_path(outside(&image.uri)?).ok()
}

/// The images of the base colors of the default scene, each once.
fn shown(source: &Source) -> Result<Vec<usize>> {
    let (mut images, mut found) = (BTreeSet::new(), Vec::new());
    for primitive in primitives(source)? {
        found.extend(base_color(source, primitive.material)?.filter(|&image| images.insert(image)));
    }
    Ok(found)
}

/// The parts of the meshes of the default scene, each once, in the order in which its nodes show them.
pub(super) fn primitives<'a>(source: &'a Source) -> Result<Vec<&'a Primitive>> {
    let (mut meshes, mut found) = (BTreeSet::new(), Vec::new());
    for placed in nodes(source)? {
        let Some(mesh) = placed.node.mesh.filter(|&mesh| meshes.insert(mesh)) else { continue };
        found.extend(&source.get(&source.document.meshes, mesh, "mesh")?.primitives);
    }
    Ok(found)
}

/// The files of its buffers, as a scene names them, as far as they may be read.
pub(in crate::files::mesh) fn parts(bytes: &[u8], with: With) -> Result<Vec<String>> {
    let source = &Source::of(bytes, with)?;
    let uris = source.document.buffers.iter().filter_map(|buffer| outside(&buffer.uri));
    Ok(uris.filter_map(|uri| source.path(uri).ok()).map(|path| paths::sibling(with.place, &path)).collect())
}

/// The address of what is in a file of its own.
fn outside<'a>(uri: &'a Option<Text>) -> Option<&'a str> {
    uri.as_ref().map(|Text(uri)| &**uri).filter(|uri| !uri.starts_with("data:"))
}

/// The image of a material's base color, if it is one that can be read.
pub(super) fn base_color(source: &Source, material: Option<usize>) -> Result<Option<usize>> {
    let Some(material) = material else { return Ok(None) };
    let material = source.get(&source.document.materials, material, "material")?;
    let Some(info) = material.base_color() else { return Ok(None) };
    let texture = source.get(&source.document.textures, info.index, "texture")?;
    let webp = texture.extensions.as_ref().and_then(|extensions| extensions.webp.as_ref());
    Ok(texture.source.or(webp.map(|webp| webp.source)))
}

/// Hands the bytes of the image with this number, which is in the file itself, to `read`.
pub(in crate::files::mesh) fn embedded<T>(
    bytes: &[u8],
    image: usize,
    with: With,
    read: impl FnOnce(&[u8]) -> Result<T>,
) -> Result<T> {
    let source = Source::of(bytes, with)?;
    let Some(found) = source.document.images.get(image) else { return Err(missing(&source, image, with.place)) };
    let (bytes, _share): (Cow<[u8]>, Share) = match (&found.uri, found.buffer_view) {
        (Some(Text(uri)), _) if outside(&found.uri).is_none() => {
            let (bytes, share) = data(uri, &format!("image {image}"), with.place, with.budget)?;
            (bytes.into(), share)
        }
        (None, Some(view)) => (source.view(view)?.into(), Share::default()),
        (Some(Text(uri)), _) => {
            let path = paths::sibling(with.place, &source.path(uri)?);
            return Err(source.wrong(format!("image {image} is not in the file")).cure(format!("name it by {path}")));
        }
        (None, None) => return Err(source.wrong(format!("image {image} is empty"))),
    };
    read(&bytes)
}

/// That there is no image with this number, and which there are.
fn missing(source: &Source, image: usize, place: &str) -> Error {
    let (there, model) = (source.document.images.len(), paths::file_of(place));
    let what = format!("there is no picture {image} in the model");
    let cure = match there {
        0 => "it has no pictures in it: name a file".to_owned(),
        1 => format!("there is only {model}#0"),
        _ => format!("there are {model}#0 to {model}#{}", there - 1),
    };
    source.wrong(what).cure(cure)
}
