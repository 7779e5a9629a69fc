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
    /// The scene, its pictures and meshes: name and bytes.
    pub files: &'static [(&'static str, &'static [u8])],
}

macro_rules! profile {
    ($name:literal, $help:literal, $($file:literal),+) => { profile!($name, $help, $($name / $file),+) };
    ($name:literal, $help:literal, $($folder:literal / $file:literal),+) => {
        Profile {
            name: $name,
            help: $help,
            files: &[$((
                $file,
                include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/profiles/", $folder, "/", $file)),
            )),+],
        }
    };
}

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
        "falls" / "stones.obj",
        "falls" / "water-0000.png",
        "falls" / "water-0001.png",
        "falls" / "water-0002.png",
        "falls" / "water-0003.png",
        "falls" / "water-0004.png",
        "falls" / "water-0005.png",
        "falls" / "water-0006.png",
        "falls" / "water-0007.png",
        "falls" / "water-0008.png",
        "falls" / "water-0009.png",
        "falls" / "water-0010.png",
        "falls" / "water-0011.png",
        "falls" / "water-0012.png",
        "falls" / "water-0013.png",
        "falls" / "water-0014.png",
        "falls" / "water-0015.png",
        "falls" / "water-0016.png",
        "falls" / "water-0017.png",
        "falls" / "water-0018.png",
        "falls" / "water-0019.png"
    ),
    profile!(
        "fire",
        "a fire, its flames from a clip against black",
        "fire" / "fire.plica.json",
        "fire" / "fire-0000.png",
        "fire" / "fire-0001.png",
        "fire" / "fire-0002.png",
        "fire" / "fire-0003.png",
        "fire" / "fire-0004.png",
        "fire" / "fire-0005.png",
        "fire" / "fire-0006.png",
        "fire" / "fire-0007.png",
        "fire" / "fire-0008.png",
        "fire" / "fire-0009.png",
        "fire" / "fire-0010.png",
        "fire" / "fire-0011.png",
        "fire" / "fire-0012.png",
        "fire" / "fire-0013.png",
        "fire" / "fire-0014.png",
        "fire" / "fire-0015.png",
        "fire" / "fire-0016.png",
        "fire" / "fire-0017.png",
        "fire" / "fire-0018.png",
        "fire" / "fire-0019.png"
    ),
    profile!(
        "mug",
        "the squinting cat on a mug that turns",
        "mug" / "mug.plica.json",
        "mug" / "mug.obj",
        "mug" / "print.obj",
        "cat" / "cat.png"
    ),
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
        for (name, bytes) in self.files {
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
            assert!(profile.files.iter().any(|(file, _)| *file == profile.scene_file()), "{}", profile.name);
            assert!(profile.files.iter().all(|(_, bytes)| bytes.len() < 300_000), "{}", profile.name);
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
