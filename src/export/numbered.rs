//! Files numbered by a pattern such as `%04d.png`.

use std::path::{Path, PathBuf};

use crate::base::error::{Error, Result};
use crate::base::numbered;

/// How the names of numbered frames end: as one sees them, and as light.
pub const PICTURES: [&str; 2] = [".png", ".exr"];

/// Whether a file of this name is a picture, and one alone.
pub fn is_one_picture(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    PICTURES.iter().any(|ending| name.ends_with(ending))
        && !numbered::Pattern::of(&name).is_ok_and(|name| name.is_numbered())
}

/// A file name with one frame number in it.
#[derive(Debug, PartialEq)]
pub struct Pattern {
    folder: PathBuf,
    name: numbered::Pattern,
}

impl Pattern {
    /// The pattern in the file name of `path`: `%d`, or `%04d` for at least four digits; `%%` is a `%`. `None` if the
    /// name has no `%`.
    ///
    /// # Errors
    /// The name holds more than one number, something else after a `%`, or does not end in one of `endings` (for
    /// frames that are `what`); the number is in the name of a folder.
    pub fn parse(path: &Path, endings: &[&str], what: &str) -> Result<Option<Self>> {
        let wrong = |what: &str| Error::Usage(format!("{}: {what} (as in frame-%04d.png)", path.display()));
        let open = |folder: &Path| {
            let name = folder.file_name().unwrap_or_default().to_string_lossy();
            numbered::Pattern::of(&name).is_ok_and(|name| name.is_numbered()) && !folder.is_dir()
        };
        if path.ancestors().skip(1).any(open) {
            return Err(wrong("the number of a frame is in the name of its file, not of its folder"));
        }
        let name = path.file_name().map(|n| n.to_string_lossy()).unwrap_or_default();
        let name = numbered::Pattern::of(&name).map_err(|what| wrong(&what))?;
        if !name.is_numbered() {
            return Ok(None);
        }
        if !endings.iter().any(|ending| name.after().to_lowercase().ends_with(ending)) {
            return Err(wrong(&format!("{what} and end in {}", endings.join(" or "))));
        }
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Ok(Some(Pattern { folder: folder.to_path_buf(), name }))
    }

    /// The folder of the files.
    ///
    /// # Errors
    /// It does not exist.
    pub fn folder(&self) -> Result<&Path> {
        let missing = || Error::at(self.folder.display(), "the folder is not there").cure("make it first");
        if self.folder.is_dir() { Ok(&self.folder) } else { Err(missing()) }
    }

    /// The name of the file with this number.
    pub fn name(&self, number: u64) -> String {
        self.name.name(number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(path: &str) -> Result<Option<Pattern>> {
        Pattern::parse(Path::new(path), &PICTURES, "frames are pictures")
    }

    #[test]
    fn patterns() {
        for (path, number, name) in [
            ("%04d.png", 7, "0007.png"),
            ("out/a-%d.PNG", 12, "a-12.PNG"),
            ("100%%-%3d.png", 5, "100%-005.png"),
            ("%02d.png", 12345, "12345.png"),
            ("depth-%d.exr", 3, "depth-3.exr"),
        ] {
            assert_eq!(parse(path).unwrap().unwrap().name(number), name);
        }
        assert_eq!(parse("a.gif").unwrap(), None);
        assert_eq!(parse("100%%.png").unwrap(), None);
    }

    #[test]
    fn wrong_patterns_say_what_is_wrong() {
        for (path, what) in [
            ("%04x.png", "\"%04x\" is no frame number"),
            ("%.png", "\"%.\" is no frame number"),
            ("%d-%d.png", "two frame numbers"),
            ("%04d.gif", "frames are pictures and end in .png or .exr"),
            ("50%", "\"%\" is no frame number"),
            ("out/%04d/a.png", "in the name of its file, not of its folder (as in frame-%04d.png)"),
            ("%d/a.gif", "not of its folder"),
        ] {
            let error = parse(path).unwrap_err().to_string();
            assert!(error.contains(what), "{path}: {error}");
        }
    }
}
