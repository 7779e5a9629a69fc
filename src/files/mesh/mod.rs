//! Meshes from files: Wavefront OBJ and glTF 2.0. The size of a file and what it counts are checked against the limits
//! before memory is taken. Numbers are finite and indices in range, or the file is refused with the place of the first
//! that is not.

use std::fs::File;

use super::picture::kinds;
use super::{Limits, Options, paths};
use crate::base::budget::{Budget, Share};
use crate::base::error::{Error, Result};
use crate::base::mesh::Mesh;
use crate::base::system;
use crate::layers::parts::materials::List;

mod gltf;
mod input;
mod looks;
mod obj;
#[cfg(test)]
mod tests;

pub use input::Opener;
pub use looks::Looks;

use gltf::With;

/// A kind of file that is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Obj,
    Gltf,
}

/// Kinds that are not read: the end of the name, how the file may begin, and what it is.
const FOREIGN: &[(&str, &[&[u8]], &str)] = &[
    (".ply", &[b"ply\n", b"ply\r"], "a PLY mesh"),
    (".stl", &[b"solid "], "an STL mesh"),
    (".off", &[b"OFF\n", b"OFF\r", b"COFF"], "an OFF mesh"),
    (".fbx", &[b"Kaydara FBX", b"; FBX"], "an FBX scene"),
    (".blend", &[b"BLENDER"], "a file of Blender"),
    (".dae", &[], "a Collada scene"),
    (".usda", &[b"#usda"], "a USD scene"),
    (".usdc", &[b"PXR-USDC"], "a USD scene"),
    (".usdz", &[], "a USD scene"),
    (".usd", &[], "a USD scene"),
    (".abc", &[b"Ogawa"], "an Alembic scene"),
    (".3ds", &[], "a 3DS scene"),
    (".3mf", &[], "a 3MF model"),
    (".zip", &[b"PK\x03\x04"], "a ZIP archive"),
    (".gz", &[b"\x1f\x8b"], "compressed by gzip"),
];

/// What a file called `place` is that begins with `start`, if it is a scene or a mesh that is read, and what to do with it
/// where something else is wanted.
pub(super) fn instead(start: &[u8], place: &str) -> Option<[&'static str; 2]> {
    match () {
        () if is_scene(start) => Some(SCENE),
        () if kind(start, place).is_ok() => {
            let is_called_so = [".obj", ".glb", ".gltf"].iter().any(|end| place.to_lowercase().ends_with(end));
            let cure = match is_called_so {
                true => "list it among the scene's meshes",
                false => "call it .obj, .glb or .gltf, and list it among the scene's meshes",
            };
            Some(["a mesh", cure])
        }
        () => None,
    }
}

/// Whether an open file called `place` begins as a mesh does: a `.glb` whatever it is called, others unless that is what
/// something else is called.
pub(super) fn is_one(file: &File, place: &str) -> bool {
    let Ok(start) = input::start(file, place) else { return false };
    let is_free = paths::kind_of(place).is_none();
    let is_json = start.first() == Some(&b'{');
    match kind(&start, place) {
        Ok(Format::Gltf) if is_json => is_free && names(&start, "asset"),
        Ok(Format::Gltf) => true,
        Ok(Format::Obj) => is_free,
        Err(_) => false,
    }
}

/// Refuses an open file that does not begin as a mesh does; it stays where it was: at its beginning.
///
/// # Errors
/// What it is, and what to do.
pub(super) fn expect(file: &File, place: &str) -> Result<()> {
    kind(&input::start(file, place)?, place).map(drop)
}

const SCENE: [&str; 2] = ["a Plica scene", "plica edit opens it"];

/// Whether a file begins as a scene does, and not as a glTF, which is such JSON too.
fn is_scene(start: &[u8]) -> bool {
    input::text(start).trim_ascii_start().starts_with(b"{") && names(start, "plica") && !names(start, "asset")
}

/// Whether a text that begins so names this key.
fn names(start: &[u8], key: &str) -> bool {
    String::from_utf8_lossy(start).contains(&format!("\"{key}\""))
}

/// Whether a file called `name`, in lower case, is a mesh or a scene of a kind that is not read.
pub fn is_foreign(name: &str) -> bool {
    let archive = [".zip", ".gz"].iter().any(|end| name.ends_with(end));
    !archive && FOREIGN.iter().any(|(end, ..)| name.ends_with(end))
}

/// The mesh in an open file, what in it is not supported in words, and the memory that it takes; `place` is its name
/// in messages. `sibling` opens a file that the mesh names, by a path relative to it.
///
/// # Errors
/// If it is no mesh, is broken, or is larger than the limits allow.
pub fn decode(
    file: File,
    place: &str,
    options: &Options,
    budget: &Budget,
    sibling: Opener,
) -> Result<(Mesh, Vec<String>, Share)> {
    let Options { limits, allow_outside: outside } = options;
    let (kind, bytes, share) = whole(file, place, limits, budget)?;
    let (builder, mut notes, picture) = match kind {
        Format::Obj => obj::read(&bytes, place, limits, budget).map(|(builder, notes)| (builder, notes, None))?,
        Format::Gltf => gltf::read(&bytes, With { place, limits, budget, sibling, outside: *outside })?,
    };
    let (mesh, of_mesh) = builder.finish()?;
    // Not before: once a large piece of memory was freed, the allocator keeps smaller ones, and the mesh would lie among holes.
    drop((bytes, share));
    let mesh = Mesh { picture, ..mesh };
    notes.extend(unseen(&mesh));
    Ok((mesh, notes, of_mesh))
}

/// The pictures that the surfaces of a model show, as a scene names them that names the model by `place`: files of their
/// own, or by their number in it (`cow.glb#0`). An OBJ names none.
///
/// # Errors
/// As [`decode`], as far as what it lists shows.
pub fn pictures(file: File, place: &str, options: &Options) -> Result<Vec<String>> {
    told_by_gltf(file, place, options, gltf::named)
}

/// The looks of the model in an open file. An OBJ names its materials in another file, which is not read.
///
/// # Errors
/// As [`pictures`].
pub fn looks(file: File, place: &str, options: &Options) -> Result<Looks> {
    told_by_gltf(file, place, options, gltf::looks)
}

/// The files that a model is made from besides its own, as a scene names them that names the model by `place`.
///
/// # Errors
/// As [`pictures`].
pub fn parts(file: File, place: &str, options: &Options) -> Result<Vec<String>> {
    told_by_gltf(file, place, options, gltf::parts)
}

/// What a glTF tells of itself without the files that it names; an OBJ tells nothing of that.
fn told_by_gltf<T: Default>(
    file: File,
    place: &str,
    options: &Options,
    read: impl FnOnce(&[u8], With) -> Result<T>,
) -> Result<T> {
    let Options { limits, allow_outside: outside } = options;
    let budget = &limits.budget();
    let (kind, bytes, _share) = whole(file, place, limits, budget)?;
    match kind {
        Format::Obj => Ok(T::default()),
        Format::Gltf => read(&bytes, With { place, limits, budget, sibling: &alone, outside: *outside }),
    }
}

/// The picture with this number in a model, as a file of its own that is nowhere but in memory.
pub(super) fn embedded(file: File, place: &str, image: usize, limits: &Limits) -> Result<File> {
    let budget = &limits.budget();
    let (_, bytes, _share) = whole(file, place, limits, budget)?;
    let with = With { place, limits, budget, sibling: &alone, outside: false };
    gltf::embedded(&bytes, image, with, |bytes| {
        let _share = budget.take(bytes.len() as u64, place)?;
        system::in_memory(bytes).map_err(|error| Error::at(place, error))
    })
}

fn alone(path: &str) -> Result<File> {
    Err(Error::at(path, "has pictures of a model in it, which Plica does not read there").cure("export it as .glb"))
}

/// What a layer of the mesh does not tell: where no triangle has an area, that says so.
fn unseen(mesh: &Mesh) -> Option<String> {
    let (unseen, all) = (mesh.degenerate, mesh.triangles.len());
    let have = if unseen == 1 { "has no area and is" } else { "have no area and are" };
    (unseen > 0 && unseen < all).then(|| format!("{unseen} of {all} triangles {have} never seen"))
}

/// The kind of an open file, all of it, and the memory that it takes. What is no mesh is not read further than to where
/// that shows.
fn whole(file: File, place: &str, limits: &Limits, budget: &Budget) -> Result<(Format, Vec<u8>, Share)> {
    let kind = kind(&input::start(&file, place)?, place)?;
    let (bytes, share) = input::whole(file, place, limits, budget)?;
    Ok((kind, bytes, share))
}

/// The kind of a file by how it begins, and by its name if that does not decide.
fn kind(start: &[u8], place: &str) -> Result<Format> {
    const READ: &str = "Plica reads Wavefront OBJ (.obj) and glTF 2.0 (.glb, .gltf)";
    if start.is_empty() {
        return Err(Error::at(place, "is empty").cure("copy it again from where it came, or export it again"));
    }
    let name = place.to_ascii_lowercase();
    if start.starts_with(b"glTF") {
        return Ok(Format::Gltf);
    }
    let foreign = |(_, begins, _): &&(_, &[&[u8]], _)| begins.iter().any(|begin| start.starts_with(begin));
    let foreign = FOREIGN.iter().find(foreign);
    let picture = kinds::name(&start[..start.len().min(kinds::LOOKED_AT as usize)]).filter(|_| foreign.is_none());
    if let Some(picture) = picture {
        let cure = match paths::kind_of(&name) == Some(List::Meshes) {
            true => format!("rename it if it is to be shown as a picture; {READ}"),
            false => READ.to_owned(),
        };
        return Err(Error::at(place, format!("is {picture}, not a mesh")).cure(cure));
    }
    let text = input::text(start);
    let is_text = !start.contains(&0);
    let first = text.trim_ascii_start().first();
    if is_scene(start) {
        let [what, cure] = SCENE;
        return Err(Error::at(place, format!("is {what}, not a mesh")).cure(cure));
    }
    if foreign.is_none() && first == Some(&b'{') {
        return Ok(Format::Gltf);
    }
    if foreign.is_none() && is_text && (obj::begins(text) || name.ends_with(".obj") && first != Some(&b'<')) {
        return Ok(Format::Obj);
    }
    let foreign = foreign.or_else(|| FOREIGN.iter().find(|(end, ..)| name.ends_with(end)));
    Err(match foreign {
        Some((.., what)) => Error::at(place, format!("is {what}, which Plica does not read"))
            .cure("export it as .glb or .obj, with Blender for example"),
        None if !is_text && [".obj", ".gltf"].iter().any(|end| name.ends_with(end)) => input::not_text(place),
        None => Error::at(place, "is not a mesh").cure(READ),
    })
}
