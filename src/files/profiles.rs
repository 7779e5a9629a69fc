//! The demo scenes, embedded in the binary so that it needs no other files, and unpacked where they can be edited.

use std::path::{Path, PathBuf};

use super::write::write_new;
use crate::base::error::{Error, Result};
use crate::base::problem::nearest;
use crate::base::system;

/// A scene that ships with the program.
#[derive(Debug)]
pub struct Profile {
    /// Its name; the scene's file is `NAME.plica.json`.
    pub name: &'static str,
    /// What it shows, in one line.
    pub help: &'static str,
    /// The scene, its pictures and meshes.
    own: &'static [File],
    /// The frames of its clip, which others may share.
    clip: &'static [File],
}

/// The name and the bytes of a file.
pub type File = (&'static str, &'static [u8]);

/// The clip of a profile, or no files.
const fn first(clips: &[&'static [File]]) -> &'static [File] {
    clips[0]
}

macro_rules! bytes {
    ($($part:literal),+) => { include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/profiles/", $($part),+)) };
}

macro_rules! profile {
    ($name:literal, $help:literal, $($file:literal),+) => { profile!($name, $help, $($name / $file),+) };
    ($name:literal, $help:literal, $($folder:literal / $file:literal),+ $(; $clip:expr)?) => {
        Profile {
            name: $name,
            help: $help,
            own: &[$(($file, bytes!($folder, "/", $file))),+],
            clip: first(&[$($clip,)? &[]]),
        }
    };
}

macro_rules! clip {
    ($folder:literal / $name:literal, $($number:literal)+) => {
        &[$((concat!($name, "-00", $number, ".png"), bytes!($folder, "/", $name, "-00", $number, ".png"))),+]
    };
}

macro_rules! twenty {
    ($folder:literal / $name:literal) => {
        clip!(
            $folder / $name, "00" "01" "02" "03" "04" "05" "06" "07" "08" "09" "10" "11" "12" "13" "14" "15" "16" "17"
            "18" "19"
        )
    };
}

/// Falling water.
const WATER: &[File] = twenty!("falls" / "water");
/// Flames against black.
const FIRE: &[File] = twenty!("fire" / "fire");

/// Every demo scene; the first is the default.
pub const TABLE: &[Profile] = &[
    profile!("blink", "an eyelid slides over an eyeball", "blink.plica.json", "eye.png", "lashes.png"),
    profile!("cat", "a cat squints: two fold regions in one zone", "cat.plica.json", "cat.png"),
    profile!("waves", "waves swash over a beach", "waves.plica.json", "beach.png"),
    profile!("wound", "a cut closes and opens: 62 anchors from three curves", "wound.plica.json", "arm.png"),
    profile!("pecs", "a chest bounces: two zones, one half a timeline ahead", "pecs.plica.json", "chest.png"),
    profile!("car", "a car flies past a sign", "car.plica.json", "road.png", "car.png", "light.png"),
    profile!(
        "ball",
        "the blinking eye on a ball that looks around",
        "ball" / "ball.plica.json",
        "ball" / "ball.obj",
        "blink" / "eye.png",
        "blink" / "lashes.png"
    ),
    profile!(
        "falls",
        "a waterfall between rocks, its water from a clip",
        "falls" / "falls.plica.json",
        "falls" / "cliff.obj",
        "falls" / "pool.obj",
        "falls" / "stones.obj";
        WATER
    ),
    profile!("curtain", "a thin sheet of falling water", "curtain" / "curtain.plica.json"; WATER),
    profile!("fountain", "a jet of water that rises and falls", "fountain" / "fountain.plica.json"; WATER),
    profile!("smoke", "smoke that rises and spreads", "smoke" / "smoke.plica.json"; WATER),
    profile!("fire", "a fire, its flames from a clip against black", "fire" / "fire.plica.json"; FIRE),
    profile!("cloud", "a cloud that drifts", "cloud" / "cloud.plica.json"; WATER),
    profile!(
        "mug",
        "the squinting cat on a mug that turns",
        "mug" / "mug.plica.json",
        "mug" / "mug.obj",
        "mug" / "print.obj",
        "cat" / "cat.png"
    ),
    profile!(
        "vase",
        "a painted vase: flowers from near, dots from afar, none from the side",
        "vase" / "vase.plica.json",
        "vase" / "vase.obj",
        "vase" / "clay.png",
        "vase" / "mouth.png",
        "vase" / "flowers.png",
        "vase" / "dots.png"
    ),
    profile!(
        "fish",
        "a fish whose scales come and go",
        "fish" / "fish.plica.json",
        "fish" / "fish.obj",
        "fish" / "left.png",
        "fish" / "right.png",
        "fish" / "scales.png",
        "fish" / "shine.png"
    ),
    profile!("sketch", "a mug that turns, drawn with a pen", "sketch" / "sketch.plica.json", "mug" / "mug.obj"),
];

/// The scene that the tutor begins with: a picture, the lid and the opening of an eye, and a curve that does not move
/// yet.
pub const TUTOR: Profile = profile!("tutor", "a first animation", "cat" / "tutor.plica.json", "cat" / "cat.png");

/// The demo scene called `name`.
///
/// # Errors
/// [`Error::Usage`] if the name is not in the table; the message suggests the nearest one.
pub fn find(name: &str) -> Result<&'static Profile> {
    TABLE.iter().find(|profile| profile.name == name).ok_or_else(|| {
        let hint = nearest(name, TABLE.iter().map(|profile| profile.name)).unwrap_or_default();
        Error::Usage(format!("there is no demo '{name}' ({hint})"))
    })
}

impl Profile {
    /// The default folder to unpack it into: in the user's cache, otherwise in the temporary folder.
    pub fn scratch(&self) -> PathBuf {
        let folder = format!("plica-demo-{}", self.name);
        match system::folders::cache() {
            Some(cache) => cache.join(folder),
            None => std::env::temp_dir().join(format!("{folder}-{}", system::user())),
        }
    }

    /// A new folder for it, in the temporary folder.
    ///
    /// # Errors
    /// If it cannot be created.
    pub fn fresh(&self) -> Result<PathBuf> {
        let names = (1..).map(|n| format!("plica-{}-{}-{n}", self.name, std::process::id()));
        let folders = names.map(|name| std::env::temp_dir().join(name));
        let folder = folders.take(1000).find(|folder| std::fs::create_dir(folder).is_ok());
        folder.ok_or_else(|| {
            Error::at(std::env::temp_dir().display(), "no folder can be made here")
                .cure("set TMPDIR to one that you may write")
        })
    }

    /// Everything in it: the scene, its pictures, meshes and clip.
    pub fn files(&self) -> impl Iterator<Item = File> {
        self.own.iter().chain(self.clip).copied()
    }

    /// The name of the scene's file.
    pub fn scene_file(&self) -> String {
        format!("{}.plica.json", self.name)
    }

    /// Writes those files of the scene that are missing in `folder`, and returns the scene's path. Files that are
    /// already there are left as they are: somebody may have edited them.
    ///
    /// # Errors
    /// If the folder cannot be created or written.
    pub fn unpack(&self, folder: &Path) -> Result<PathBuf> {
        std::fs::create_dir_all(folder)
            .map_err(|error| Error::at(folder.display(), error).cure("name another folder with -o"))?;
        for (name, bytes) in self.files() {
            let path = folder.join(name);
            if path.symlink_metadata().is_err() {
                write_new(&path, bytes)?;
            }
        }
        Ok(folder.join(self.scene_file()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_profile_holds_its_scene() {
        for profile in TABLE {
            assert!(profile.files().any(|(file, _)| file == profile.scene_file()), "{}", profile.name);
            assert!(profile.files().all(|(_, bytes)| bytes.len() < 300_000), "{}", profile.name);
        }
    }

    #[test]
    fn an_unknown_name_is_told_the_nearest() {
        let message = find("blik").unwrap_err().to_string();
        assert!(message.contains("blink"), "{message}");
        assert_eq!(find("car").unwrap().name, "car");
    }

    #[test]
    fn unpacking_keeps_what_is_there() {
        let outer = tempfile::tempdir().unwrap();
        let folder = outer.path().join("a/b");
        let scene = TABLE[0].unpack(&folder).unwrap();
        std::fs::write(&scene, "edited").unwrap();
        std::fs::remove_file(folder.join("eye.png")).unwrap();
        TABLE[0].unpack(&folder).unwrap();
        assert_eq!(std::fs::read_to_string(&scene).unwrap(), "edited");
        assert!(folder.join("eye.png").is_file());
    }
}
