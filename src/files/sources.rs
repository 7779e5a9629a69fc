//! What a person means by a path that a scene is to show: a picture, a model or a clip. A name that says it is a model or a video
//! counts, so that what is in it instead is told; else the content of the file decides.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::picture::kinds;
use super::{Limits, clips, mesh, models, paths, picture};
use crate::base::error::{Error, Result};
use crate::base::numbered;
use crate::layers::parts::materials::List;

/// The list of a scene that the file, the pattern of files or the folder at `path` goes to.
pub fn list_of(path: &Path) -> List {
    let in_model = path.to_str().and_then(paths::image_of).is_some();
    match () {
        () if in_model => List::Images,
        () if clips::is_one(path) => List::Clips,
        () if models::is_one(path) => List::Meshes,
        () => List::Images,
    }
}

/// Reads the picture at `path`.
///
/// # Errors
/// As [`picture::read`]; of what is called neither as a picture nor as something else that a scene shows, what that can be.
pub fn picture(path: &Path, limits: &Limits) -> Result<picture::Loaded> {
    let name = path.to_string_lossy();
    let is_other = || path.is_file() && paths::kind_of(paths::file_of(&name)).is_none() && !picture::is_one(path);
    picture::read(path, limits).map_err(|error| match &error {
        Error::Failed { what, .. } if what == kinds::UNKNOWN && is_other() => {
            Error::at(path.display(), "is nothing that a scene shows").cure(
                "name a picture (PNG, JPEG, TIFF, OpenEXR and others), a model (.obj, .glb, .gltf) or a clip (falls/%04d.jpg, a \
                 folder of numbered pictures, a video)",
            )
        }
        _ => error,
    })
}

/// How many first bytes tell a video from another file: an animated PNG says that it is one before its pixels, perhaps after a
/// color profile.
const LOOKED_AT: u64 = 1 << 20;

/// Refuses an open file that is a picture or a mesh, where a video is meant; `place` is its path as written.
///
/// # Errors
/// What it is, and what to do; that it cannot be read.
pub(super) fn expect_video(file: &File, place: &str) -> Result<()> {
    let mut start = Vec::new();
    file.take(LOOKED_AT).read_to_end(&mut start).map_err(|error| Error::at(place, error))?;
    let is = |what: &str, cure: &str| Err(Error::at(place, format!("is {what}")).cure(cure));
    match kinds::still(&start) {
        _ if start.is_empty() => is("empty", "copy it again from where it came"),
        Some(picture) => is(&format!("{picture}, not a video"), &pattern_for(place)),
        None => match mesh::instead(&start, place) {
            Some([what, cure]) => is(&format!("{what}, not a video"), cure),
            None => Ok(()),
        },
    }
}

/// How to name the numbered pictures of which the one at `place` is perhaps the first.
fn pattern_for(place: &str) -> String {
    let (folder, name) = place.split_at(place.rfind('/').map_or(0, |slash| slash + 1));
    match numbered::series([name].into_iter()).first() {
        Some(series) => format!("write {folder}{}", series.pattern),
        None => "a clip is made of numbered pictures, as falls/%04d.jpg".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_called_a_model_or_a_video_is_meant_as_one_and_else_the_content_decides() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        image::RgbaImage::new(2, 2).save(at("cat.png")).unwrap();
        for name in ["cat.obj", "cat.mp4"] {
            std::fs::copy(at("cat.png"), at(name)).unwrap();
        }
        std::fs::write(at("cow.dat"), "glTF").unwrap();
        std::fs::write(at("cow"), "# by hand\nv 0 0 0\n").unwrap();
        std::fs::write(at("cow.json"), r#"{"asset": {"version": "2.0"}}"#).unwrap();
        std::fs::write(at("other.json"), "{}").unwrap();
        std::fs::write(at("cow.obj"), "v 0 0 0\n").unwrap();
        for (name, expected) in [
            ("cat.png", List::Images),
            ("cat.obj", List::Meshes),
            ("cat.mp4", List::Clips),
            ("cow.dat", List::Meshes),
            ("cow", List::Meshes),
            ("cow.json", List::Meshes),
            ("other.json", List::Images),
            ("cow.obj", List::Meshes),
            ("cow.glb#0", List::Images),
            ("no.glb", List::Meshes),
            ("no.ply", List::Meshes),
            ("no.mp4", List::Clips),
            ("a%d.png", List::Clips),
            ("", List::Clips),
            ("no.png", List::Images),
        ] {
            assert_eq!(list_of(&at(name)), expected, "{name}");
        }
    }

    #[test]
    fn a_picture_or_a_mesh_is_no_video() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        for (place, bytes, expected) in [
            ("cl/0000.png", &b"\x89PNG\r\n\x1a\n...."[..], "is a PNG picture, not a video (write cl/%04d.png)"),
            ("cat.mp4", b"\xff\xd8\xff", "is a JPEG picture, not a video (a clip is made of numbered pictures, as"),
            (
                "cow.mp4",
                b"glTF",
                "is a mesh, not a video (call it .obj, .glb or .gltf, and list it among the scene's meshes)",
            ),
            ("cow.OBJ", b"v 0 0 0\n", "is a mesh, not a video (list it among the scene's meshes)"),
            ("a.mp4", b"{ \"plica\": 1 }", "is a Plica scene, not a video (plica edit opens it)"),
            ("cow.mp4", b"v 0 0 0\n", "is a mesh, not a video"),
            ("a.mp4", b"", "is empty (copy it again from where it came)"),
            ("a.png", b"\x89PNG\r\n\x1a\n....acTL", ""),
            ("a.gif", b"GIF89a", ""),
            ("a.m4v", b"\0\0\x01\0", ""),
            ("a.mp4", b"\0\0\0\x18ftypisom", ""),
            ("a.mp4", b"no video", ""),
            ("a.y4m", b"YUV4MPEG2 W8 H8 F25:1\n", ""),
        ] {
            std::fs::write(&path, bytes).unwrap();
            let told = expect_video(&File::open(&path).unwrap(), place).err().map(|error| error.to_string());
            let expected = if expected.is_empty() { String::new() } else { format!("{place}: {expected}") };
            assert_eq!(told.is_none(), expected.is_empty(), "{place}: {told:?}");
            assert!(told.unwrap_or_default().starts_with(&expected), "{expected}");
        }
    }
}
