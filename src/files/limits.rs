//! How much a file may take, checked before memory is allocated: one table of names, defaults and help, for the checks
//! and for `--limit NAME=VALUE`.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use crate::base::budget::Budget;
use crate::base::error::{Error, Result};
use crate::layers::KINDS;
use crate::layers::technique::Counted;

/// Limits on what is read. Every sane file is within the defaults.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Pixels of a picture: width times height.
    pub pixels: u64,
    /// Width and height of a picture, each.
    pub side: u64,
    /// Bytes that everything read and computed may take in total.
    pub memory: u64,
    /// Bytes of a scene file.
    pub scene: u64,
    /// Depth of a scene's JSON.
    pub depth: u64,
    /// The limits on what techniques count in a scene, by its name.
    pub counted: BTreeMap<&'static str, u64>,
    /// Bytes of an expression.
    pub expression: u64,
    /// Depth of an expression.
    pub expression_depth: u64,
    /// Bytes of a file that holds a mesh, or a part of one.
    pub mesh: u64,
    /// Triangles of a mesh.
    pub triangles: u64,
    /// Frames of an animation, or of a clip.
    pub frames: u64,
    /// Pixels of all frames of a clip.
    pub clip: u64,
    /// Bytes of a message between editor and window.
    pub message: u64,
    /// Bytes pasted at once.
    pub paste: u64,
    /// Width and height of a picture that the window gives to the GPU, each.
    pub texture: u64,
    /// Bytes of cached files from other machines.
    pub cache: u64,
}

/// A row of the table.
#[derive(Debug)]
pub struct Limit {
    /// Its name in `--limit`.
    pub name: &'static str,
    /// What it limits.
    pub help: &'static str,
    /// Its value unless set.
    pub default: u64,
    of: Of,
}

/// Where a limit is stored.
#[derive(Debug)]
enum Of {
    Field(fn(&mut Limits) -> &mut u64),
    Counted,
}

impl Limit {
    fn of<'a>(&self, limits: &'a mut Limits) -> &'a mut u64 {
        match self.of {
            Of::Field(field) => field(limits),
            Of::Counted => limits.counted.entry(self.name).or_insert(self.default),
        }
    }
}

const MIB: u64 = 1 << 20;

/// Every limit.
pub static TABLE: LazyLock<Vec<Limit>> = LazyLock::new(|| {
    let mut counted: Vec<Limit> = Vec::new();
    for &Counted { name, help, most } in KINDS.iter().flat_map(|kind| kind.counted) {
        if counted.iter().all(|row| row.name != name) {
            counted.push(Limit { name, help, default: most, of: Of::Counted });
        }
    }
    SCENE.into_iter().chain(counted).chain(REST).collect()
});

const SCENE: [Limit; 8] = [
    limit("pixels", "pixels of a picture, width times height", 1 << 28, |l| &mut l.pixels),
    limit("side", "width and height of a picture, in pixels", 1 << 20, |l| &mut l.side),
    limit("memory", "bytes that everything read and computed may take in total", 4096 * MIB, |l| &mut l.memory),
    limit("scene", "bytes of a scene file", 64 * MIB, |l| &mut l.scene),
    limit("depth", "depth of a scene's JSON", 64, |l| &mut l.depth),
    limit("mesh", "bytes of a file with a mesh, or with a part of one", 512 * MIB, |l| &mut l.mesh),
    limit("triangles", "triangles of a mesh", 10_000_000, |l| &mut l.triangles),
    limit("clip", "pixels of a clip, all frames together", 1 << 30, |l| &mut l.clip),
];

const REST: [Limit; 7] = [
    limit("expression", "bytes of an expression", 4096, |l| &mut l.expression),
    limit("expression-depth", "depth of an expression", 64, |l| &mut l.expression_depth),
    limit("frames", "frames of an animation, or of a clip", 100_000, |l| &mut l.frames),
    limit("message", "bytes of a message between editor and window", 64 * MIB, |l| &mut l.message),
    limit("paste", "bytes pasted at once", 16 * MIB, |l| &mut l.paste),
    limit("texture", "side of a picture in the window; larger ones are reduced", 1 << 20, |l| &mut l.texture),
    limit("cache", "bytes of cached files from other machines", 1024 * MIB, |l| &mut l.cache),
];

const fn limit(name: &'static str, help: &'static str, default: u64, of: fn(&mut Limits) -> &mut u64) -> Limit {
    Limit { name, help, default, of: Of::Field(of) }
}

impl Default for Limits {
    fn default() -> Self {
        let mut limits = Limits {
            pixels: 0,
            side: 0,
            memory: 0,
            scene: 0,
            depth: 0,
            counted: BTreeMap::new(),
            expression: 0,
            expression_depth: 0,
            mesh: 0,
            triangles: 0,
            frames: 0,
            clip: 0,
            message: 0,
            paste: 0,
            texture: 0,
            cache: 0,
        };
        for row in &*TABLE {
            *row.of(&mut limits) = row.default;
        }
        limits
    }
}

impl Limits {
    /// Sets one limit from `NAME=VALUE`; the value may end in K, M or G (2^10, 2^20, 2^30).
    ///
    /// # Errors
    /// If the name is unknown (the message lists the known ones) or the value is no whole number.
    pub fn set(&mut self, setting: &str) -> Result<()> {
        let (name, value) = setting
            .split_once('=')
            .ok_or_else(|| Error::Usage(format!("--limit {setting}: write it as NAME=VALUE, as pixels=1000000")))?;
        let row = TABLE.iter().find(|row| row.name == name).ok_or_else(|| unknown(name))?;
        *row.of(self) = parse(value).ok_or_else(|| {
            Error::Usage(format!("--limit {setting}: a whole number was expected, as 1000000 or 64M, not \"{value}\""))
        })?;
        Ok(())
    }

    /// The defaults, changed by the limits that a command line sets.
    ///
    /// # Errors
    /// As [`Limits::set`].
    pub fn from_settings(settings: &[String]) -> Result<Self> {
        let mut limits = Limits::default();
        settings.iter().try_for_each(|setting| limits.set(setting))?;
        Ok(limits)
    }

    /// The memory budget of one piece of work; everything in it shares this.
    pub fn budget(&self) -> Budget {
        Budget::new(self.memory)
    }

    /// The most items that a list may get at once: as many as a scene may have of anything that is counted.
    pub fn items(&self) -> u64 {
        self.counted.values().copied().max().unwrap_or(u64::MAX)
    }

    /// The settings that give these limits, as `NAME=VALUE`; defaults are left out.
    pub fn settings(&self) -> Vec<String> {
        let mut own = self.clone();
        let values = TABLE.iter().map(|row| (row, *row.of(&mut own)));
        values
            .filter(|(row, value)| *value != row.default)
            .map(|(row, value)| format!("{}={value}", row.name))
            .collect()
    }
}

/// Refuses `found` above `most`, naming the limit.
pub(super) fn within(place: &str, size: &str, unit: &str, limit: &str, found: u64, most: u64) -> Result<()> {
    if found <= most {
        return Ok(());
    }
    Err(Error::at(place, format!("{size} {found} {unit}, at most {most} are allowed"))
        .cure(format!("make it smaller, or give --limit {limit}={found}")))
}

fn unknown(name: &str) -> Error {
    let known: Vec<_> = TABLE.iter().map(|row| row.name).collect();
    Error::Usage(format!("--limit {name}: no such limit; there are {}", known.join(", ")))
}

fn parse(value: &str) -> Option<u64> {
    let (digits, unit) = match value.char_indices().last()? {
        (end, 'K' | 'k') => (&value[..end], 1 << 10),
        (end, 'M' | 'm') => (&value[..end], 1 << 20),
        (end, 'G' | 'g') => (&value[..end], 1 << 30),
        _ => (value, 1),
    };
    digits.bytes().all(|b| b.is_ascii_digit()).then(|| digits.parse::<u64>().ok()?.checked_mul(unit))?
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_limit_can_be_set_alone() {
        for row in &*TABLE {
            let mut limits = Limits::from_settings(&[format!("{}=7", row.name)]).unwrap();
            assert_eq!(*row.of(&mut limits), 7);
            assert_eq!(limits.settings(), [format!("{}=7", row.name)]);
            *row.of(&mut limits) = row.default;
            assert_eq!(limits, Limits::default(), "{}: two rows share a field", row.name);
            assert!(row.default > 0 && !row.help.is_empty());
        }
    }

    #[test]
    fn values_are_whole_numbers_with_a_unit() {
        for (value, parsed) in [
            ("0", Some(0)),
            ("64", Some(64)),
            ("2K", Some(2048)),
            ("3m", Some(3 << 20)),
            ("1G", Some(1 << 30)),
            ("", None),
            ("M", None),
            ("-1", None),
            ("+1", None),
            ("1.5", None),
            ("18446744073709551616", None),
            ("18446744073709551615G", None),
        ] {
            assert_eq!(parse(value), parsed, "{value}");
        }
    }

    #[test]
    fn a_wrong_setting_says_what_is_right() {
        for (setting, part) in [("pixel=1", "pixels, side, memory"), ("pixels", "NAME=VALUE"), ("side=x", "\"x\"")] {
            let error = Limits::default().set(setting).unwrap_err();
            assert!(error.to_string().contains(part), "{error}");
            assert_eq!(error.exit_status(), 2);
        }
    }
}
