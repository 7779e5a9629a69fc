//! The clips of a scene, and the names of their frames.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::base::numbered::Pattern;
use crate::base::problem::{Problem, quoted};

/// A clip of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Clip {
    /// Numbered pictures of one size, relative to the scene, as falls/%04d.jpg; or a video, which ffmpeg reads.
    #[schemars(length(min = 1))]
    pub path: String,
    /// The number of the first frame; of a video, from 0.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1000000000), extend("unit" = "frames"))]
    pub first: u32,
    /// How many frames; if left out, all that follow without a gap.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 1000000), extend("unit" = "frames"))]
    pub count: Option<u32>,
    /// Frames per second.
    #[serde(default = "fps")]
    #[schemars(range(min = 0.001, max = 1000.0), extend("unit" = "fps"))]
    pub fps: f64,
}

fn fps() -> f64 {
    25.0
}

/// The paths of a clip's frames, as written in the scene.
#[derive(Clone, Debug)]
pub struct Frames<'a> {
    folder: &'a str,
    name: Pattern,
    first: u64,
}

impl Clip {
    /// No clip has more frames.
    pub const MOST: u64 = 1_000_000;

    /// The paths of its frames.
    ///
    /// # Errors
    /// What is wrong with its own path; the problem's path is relative to the clip.
    pub fn frames(&self) -> Result<Frames<'_>, Problem> {
        let wrong = |what: &str| Problem::error("/path", format!("{}: {what}", quoted(&self.path)));
        let (folder, name) = self.path.split_at(self.path.rfind('/').map_or(0, |slash| slash + 1));
        let name = Pattern::of(name).map_err(|what| wrong(&what).hint("as in falls/%04d.jpg; %% is a %"))?;
        Ok(Frames { folder, name, first: self.first.into() })
    }
}

impl Frames<'_> {
    /// Whether all frames are in one file, a video.
    pub fn is_video(&self) -> bool {
        !self.name.is_numbered()
    }

    /// The index of the frame in a file of this name, if it is one of them.
    pub fn index(&self, name: &str) -> Option<u64> {
        self.name.number(name)?.checked_sub(self.first)
    }

    /// The path of frame `index`, from 0.
    pub fn path(&self, index: u64) -> String {
        format!("{}{}", self.folder, self.name.name(self.first + index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_files_in_order() {
        for (path, first, index, frame) in [
            ("falls/%04d.jpg", 0, 7, "falls/0007.jpg"),
            ("falls/a%d.png", 998, 2, "falls/a1000.png"),
            ("%d%%/100%%-%03d.png", 0, 5, "%d%%/100%-005.png"),
        ] {
            let clip = Clip { path: path.into(), first, count: None, fps: 25.0 };
            assert_eq!(clip.frames().unwrap().path(index), frame);
            let name = frame.rsplit('/').next().unwrap();
            assert_eq!(clip.frames().unwrap().index(name), Some(index));
        }
    }
}
