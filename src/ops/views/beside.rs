//! Files that a scene is to name: below its folder they are named where they lie, others are copied beside it.

use std::path::{Path, PathBuf};

use crate::base::error::{Error, Result};
use crate::files::{disk, write};

/// The folder beside a scene for pictures that are painted.
pub const FOLDER: &str = "views";

/// The path of the picture of a view, or of its guide, in the scene.
pub fn file(name: &str, guide: bool) -> String {
    format!("{FOLDER}/{name}{}.png", if guide { "-guide" } else { "" })
}

/// A file of a scene.
pub struct Beside {
    /// Its path in the scene.
    pub path: String,
    /// Where it is now, if it is not there yet.
    from: Option<PathBuf>,
}

impl Beside {
    /// The file at `path` for the scene at `scene`: one outside its folder keeps its way from `root`, if it is below that.
    ///
    /// # Errors
    /// It is not there, or no scene can name it.
    pub fn new(path: &Path, root: &Path, scene: &Path) -> Result<Beside> {
        let whole = |path: &Path| path.canonicalize().map_err(|error| Error::at(path.display(), error));
        let (file, scene) = (whole(path)?, whole(disk::folder_of(scene))?);
        let (path, from) = match file.strip_prefix(&scene) {
            Ok(below) => (below.to_owned(), None),
            Err(_) => {
                let root = whole(root)?;
                let name = file.strip_prefix(&root).ok().map(Path::to_owned);
                let name = name.or_else(|| file.file_name().map(PathBuf::from)).unwrap_or_default();
                (name, Some(file))
            }
        };
        let text = path.to_str().filter(|text| !text.contains(char::is_control));
        let refused = || Error::at(path.display(), "has a name that no scene can have").cure("rename it");
        Ok(Beside { path: text.ok_or_else(refused)?.to_owned(), from })
    }

    /// Copies the file beside the scene, if it is not there.
    ///
    /// # Errors
    /// It cannot be read or written, or another file has its name.
    pub fn copy(&self, scene: &Path) -> Result<()> {
        self.from.as_ref().map_or(Ok(()), |from| write::copy_into(from, disk::folder_of(scene), &self.path))
    }
}
