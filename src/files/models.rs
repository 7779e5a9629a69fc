//! Models that a person names to make a scene of them: the mesh, and which other files a scene of it reads.

use std::path::Path;

use super::{Options, mesh, paths, picture};
use crate::base::error::{Error, Result};
use crate::base::mesh::Mesh;
use crate::layers::parts::materials::List;
use crate::layers::space::eye::FAR_M;

/// A model, read completely. Files are named relative to its folder.
#[derive(Debug)]
pub struct Model {
    /// Its triangles.
    pub mesh: Mesh,
    /// The picture on its surface, if it has one that can be shown: a file, or a part of the model (`cow.glb#0`).
    pub picture: Option<String>,
    /// The color of its surface, if it says one and no picture is shown.
    pub color: Option<String>,
    /// Whether both sides of its triangles are meant to be seen.
    pub both_sides: bool,
    /// The files that it is in, besides its own.
    pub beside: Vec<String>,
    /// What in it is not supported, in words.
    pub notes: Vec<String>,
}

/// Whether the file at `path` is to be a model, also of a kind that is not read: by its name, or by how it begins.
pub fn is_one(path: &Path) -> bool {
    let name = path.to_string_lossy().to_ascii_lowercase();
    let is_called = paths::kind_of(&name) == Some(List::Meshes) || mesh::is_foreign(&name);
    is_called || paths::open_named(path).is_ok_and(|file| mesh::is_one(&file, &name))
}

/// Reads a model with everything that a scene of it would read. A picture that cannot be shown is left out, which a note
/// tells.
///
/// # Errors
/// If it is no mesh, is broken, or is larger than the limits allow; if a file that it is in cannot be read.
pub fn read(path: &Path, options: &Options) -> Result<Model> {
    let limits = &options.limits;
    // What a scene beside it may read.
    let scene = path.with_extension("plica.json");
    let open = || paths::open_named(path);
    let sibling = |name: &str| paths::open(&scene, name, options);
    let place = path.display().to_string();
    let (mesh, mut notes, _share) = mesh::decode(open()?, &place, options, &limits.budget(), &sibling)?;
    let reach = mesh.bounds().map_or(0.0, |(least, most)| least.abs().max(most.abs()).max_element());
    if reach > FAR_M {
        let what = format!("its coordinates reach {reach:e} m, and no camera sees more than {FAR_M:e} m");
        return Err(Error::at(&place, what).cure("scale it down where it was made, and export it again"));
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let mut beside = mesh::parts(open()?, &name, options)?;
    let lost = |error: Error| format!("its picture is not shown: {error}");
    let offered = mesh::pictures(open()?, &name, options).unwrap_or_else(|error| {
        notes.push(lost(error));
        Vec::new()
    });
    let shown = |picture: &String| picture::decode(sibling(picture)?, picture, limits, &limits.budget()).map(|_| ());
    let picture = match offered.first() {
        Some(_) if mesh.without_uv.is_some() => {
            notes.push("its picture is not shown: the mesh has no texture coordinates (unwrap it)".to_owned());
            None
        }
        Some(picture) => match shown(picture) {
            Ok(()) => Some(picture.clone()),
            Err(error) => {
                notes.push(lost(error));
                None
            }
        },
        None => None,
    };
    if let (Some(first), 2..) = (&picture, offered.len()) {
        notes.push(format!("of its {} pictures only {first} is shown", offered.len()));
    }
    let looks = mesh::looks(open()?, &name, options)?;
    if !looks.left_out.is_empty() {
        let left_out = looks.left_out.join(", ");
        notes.push(format!("a layer has one surface, and these materials are left out: {left_out}"));
    }
    let color = match (looks.color, &picture) {
        (Some(color), Some(_)) if color != "#ffffff" => {
            notes.push(format!("its picture is shown without the color {color} that its material lays over it"));
            None
        }
        (_, Some(_)) => None,
        (color, None) => color,
    };
    beside.extend(picture.iter().filter(|picture| paths::image_of(picture).is_none()).cloned());
    Ok(Model { mesh, picture, color, both_sides: looks.both_sides, beside, notes })
}
