//! What a person means by a path that a scene is to show: a picture, a model or a clip. The content of the file decides, and its
//! name where it is not there or does not tell.

use std::path::Path;

use super::{clips, models, paths};
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_content_decides_and_else_the_name() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        image::RgbaImage::new(2, 2).save(at("cat.png")).unwrap();
        for name in ["cat.obj", "cat.mp4"] {
            std::fs::copy(at("cat.png"), at(name)).unwrap();
        }
        std::fs::write(at("cow.dat"), "glTF").unwrap();
        std::fs::write(at("cow.obj"), "v 0 0 0\n").unwrap();
        for (name, expected) in [
            ("cat.png", List::Images),
            ("cat.obj", List::Images),
            ("cat.mp4", List::Images),
            ("cow.dat", List::Meshes),
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
}
