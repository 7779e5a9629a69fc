//! How the vectors of pixels are drawn, as arrows, streamlines and colors: a value that windows, the terminal's picture and plots
//! share, the words that set it, and the keys that step through them.

use std::fmt::{self, Display, Formatter};
use std::ops::RangeInclusive;

use kurbo::Vec2;

use super::readout::Slopes;
use crate::base::maths::{TAU, atan2};
use crate::base::oklab::{hue, srgb};
use crate::base::problem::{nearest, quoted};
use crate::base::text::short;

/// The command that sets it, before its words.
pub const COMMAND: &str = "vectors";
/// The word that takes back all others.
const DEFAULT: &str = "default";
/// What stands for a range that is that of the scene.
const AUTO: &str = "auto";

/// See the top of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct VectorLook {
    /// How long arrows are, in times of what keeps them apart.
    pub length: f64,
    /// Whether all arrows are equally long.
    pub equal: bool,
    /// The length of a vector, in pixels, from which on arrows are no longer and colors no fuller; `None` for the longest.
    pub longest_px: Option<f64>,
    /// The same of divergence and curl, in pixels a pixel.
    pub steepest: Option<f64>,
    /// How opaque all of it is, 0 to 1.
    pub opacity: f64,
    /// What colors tell.
    pub color: Coloring,
}

impl Default for VectorLook {
    fn default() -> Self {
        let color = Coloring::Plain;
        VectorLook { length: 1.0, equal: false, longest_px: None, steepest: None, opacity: 1.0, color }
    }
}

/// What the colors of vectors tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coloring {
    /// Nothing: arrows and streamlines have one color. Where vectors are colors, these tell the direction.
    Plain,
    /// The direction on the screen.
    Direction,
    /// The length.
    Length,
    /// How much the vectors lead apart.
    Divergence,
    /// How much they lead round, clockwise.
    Curl,
}

impl Coloring {
    const ALL: [(&'static str, Coloring); 5] = [
        ("plain", Coloring::Plain),
        ("direction", Coloring::Direction),
        ("length", Coloring::Length),
        ("divergence", Coloring::Divergence),
        ("curl", Coloring::Curl),
    ];

    /// Its word.
    pub fn name(self) -> &'static str {
        Coloring::ALL.iter().find(|(_, one)| *one == self).map_or("", |(name, _)| name)
    }

    /// What it tells of how a field changes, if that is it.
    pub fn slope(self) -> Option<fn(&Slopes) -> f64> {
        match self {
            Coloring::Divergence => Some(|slopes| slopes.divergence),
            Coloring::Curl => Some(|slopes| slopes.curl),
            Coloring::Plain | Coloring::Direction | Coloring::Length => None,
        }
    }

    fn next(self) -> Coloring {
        let at = Coloring::ALL.iter().position(|(_, one)| *one == self).unwrap_or(0);
        Coloring::ALL[(at + 1) % Coloring::ALL.len()].1
    }
}

/// What is drawn as the longest arrow and in the fullest color.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reach {
    /// The length of a vector, in pixels.
    pub longest_px: f64,
    /// A divergence or curl, of either sign, in pixels a pixel.
    pub steepest: f64,
}

/// One of the words `NAME=VALUE`.
pub struct Setting {
    /// What stands before the sign.
    pub name: &'static str,
    /// What may stand behind it, for people.
    values: &'static str,
    get: fn(&VectorLook) -> String,
    put: fn(&mut VectorLook, &str) -> Option<()>,
}

/// All settings.
pub static SETTINGS: [Setting; 6] = [
    Setting {
        name: "color",
        values: "plain, direction, length, divergence or curl",
        get: |look| look.color.name().to_owned(),
        put: |look, word| {
            look.color = Coloring::ALL.iter().find(|(name, _)| *name == word)?.1;
            Some(())
        },
    },
    Setting {
        name: "length",
        values: "a number from 0.1 to 10",
        get: |look| short(look.length, 3),
        put: |look, word| number(word, 0.1..=10.0).map(|length| look.length = length),
    },
    Setting {
        name: "equal",
        values: "on or off",
        get: |look| if look.equal { "on" } else { "off" }.to_owned(),
        put: |look, word| {
            look.equal = [("on", true), ("off", false)].into_iter().find(|(name, _)| *name == word)?.1;
            Some(())
        },
    },
    Setting {
        name: "longest",
        values: "auto or a length in pixels",
        get: |look| look.longest_px.map_or(AUTO.to_owned(), |px| short(px, 3)),
        put: |look, word| range(word).map(|px| look.longest_px = px),
    },
    Setting {
        name: "steepest",
        values: "auto or a number of pixels a pixel",
        get: |look| look.steepest.map_or(AUTO.to_owned(), |slope| short(slope, 3)),
        put: |look, word| range(word).map(|slope| look.steepest = slope),
    },
    Setting {
        name: "opacity",
        values: "a number from 0.05 to 1",
        get: |look| short(look.opacity, 3),
        put: |look, word| number(word, 0.05..=1.0).map(|opacity| look.opacity = opacity),
    },
];

fn number(word: &str, range: RangeInclusive<f64>) -> Option<f64> {
    word.parse().ok().filter(|number| range.contains(number))
}

fn range(word: &str) -> Option<Option<f64>> {
    if word == AUTO { Some(None) } else { number(word, 1e-3..=1e6).map(Some) }
}

/// Lengths and opacities that keys step through.
const LENGTHS: [f64; 11] = [0.1, 0.2, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 3.0, 5.0, 10.0];
const OPACITIES: [f64; 3] = [1.0, 0.6, 0.3];

/// The commands of keys.
const STEPS: [(&str, fn(&mut VectorLook)); 5] = [
    ("arrows-longer", |look| {
        look.length = LENGTHS.into_iter().find(|length| *length > look.length).unwrap_or(look.length);
    }),
    ("arrows-shorter", |look| {
        look.length = LENGTHS.into_iter().rfind(|length| *length < look.length).unwrap_or(look.length);
    }),
    ("arrows-equal", |look| look.equal = !look.equal),
    ("next-coloring", |look| look.color = look.color.next()),
    ("next-opacity", |look| {
        look.opacity = OPACITIES.into_iter().find(|opacity| *opacity < look.opacity).unwrap_or(OPACITIES[0]);
    }),
];

impl VectorLook {
    /// Sets what words say, one after the other.
    ///
    /// # Errors
    /// The first word that says nothing, and what would.
    pub fn set(&mut self, words: &str) -> Result<(), String> {
        for word in words.split_whitespace() {
            if word == DEFAULT {
                *self = VectorLook::default();
                continue;
            }
            let (name, value) = word.split_once('=').unwrap_or((word, ""));
            let Some(setting) = SETTINGS.iter().find(|setting| setting.name == name) else {
                let names = SETTINGS.iter().map(|setting| setting.name).chain([DEFAULT]);
                return Err(format!("vectors have no {} ({})", quoted(name), nearest(name, names).unwrap_or_default()));
            };
            (setting.put)(self, value).ok_or_else(|| format!("{name}= is followed by {}", setting.values))?;
        }
        Ok(())
    }

    /// Takes a command: its own with words, or that of a key. Whether it was one.
    pub fn take(&mut self, command: &str) -> bool {
        let (name, words) = command.split_once(' ').unwrap_or((command, ""));
        if name == COMMAND {
            let mut set = self.clone();
            return set.set(words).is_ok() && {
                *self = set;
                true
            };
        }
        let step = STEPS.iter().find(|(own, _)| *own == command);
        step.map(|(_, step)| step(self)).is_some()
    }

    /// The command that makes any look this one.
    pub fn command(&self) -> String {
        let default = VectorLook::default();
        let differs = SETTINGS.iter().filter(|setting| (setting.get)(self) != (setting.get)(&default));
        let words = differs.map(|setting| format!(" {}={}", setting.name, (setting.get)(self)));
        format!("{COMMAND} {DEFAULT}{}", words.collect::<String>())
    }

    /// The color of a vector as a square: of no vector and no slope it is dark gray.
    pub fn color(&self, vector: Vec2, slopes: impl FnOnce() -> Slopes, reach: Reach) -> [u8; 3] {
        let length = vector.hypot2().sqrt();
        match self.color.slope() {
            Some(slope) => signed(share(slope(&slopes()), reach.steepest)),
            None if self.color == Coloring::Length => by_length(share(length, reach.longest_px)),
            None => by_direction(vector, share(length, reach.longest_px)),
        }
    }

    /// The color of an arrow or a streamline there, if it has one of its own.
    pub fn stroke_color(&self, vector: Vec2, slopes: impl FnOnce() -> Slopes, reach: Reach) -> Option<[u8; 3]> {
        match self.color {
            Coloring::Plain => None,
            Coloring::Direction => Some(hue(atan2(vector.y, vector.x) / TAU)),
            Coloring::Length | Coloring::Divergence | Coloring::Curl => {
                // Thin lines with dark rims: the dark ends of scales would not be seen.
                Some(self.color(vector, slopes, reach).map(|code| code / 4 * 3 + 64))
            }
        }
    }

    /// Colors from the least to the most that they tell, and both ends in words; `None` if they tell a direction.
    pub fn scale(&self, reach: Reach) -> Option<(fn(f64) -> [u8; 3], [String; 2])> {
        let most = |number: f64, unit: &str| format!("{}{unit}", short(number, 2));
        match self.color {
            Coloring::Plain | Coloring::Direction => None,
            Coloring::Length => Some((by_length, ["0".to_owned(), most(reach.longest_px, " px")])),
            Coloring::Divergence | Coloring::Curl => {
                Some((|at| signed(2.0 * at - 1.0), [-reach.steepest, reach.steepest].map(|slope| most(slope, ""))))
            }
        }
    }
}

impl Display for VectorLook {
    /// All settings as they are.
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let words: Vec<String> =
            SETTINGS.iter().map(|setting| format!("{}={}", setting.name, (setting.get)(self))).collect();
        write!(f, "{COMMAND} {}", words.join(" "))
    }
}

/// A number as a share of the most, from -1 to 1.
fn share(number: f64, most: f64) -> f64 {
    if most > 0.0 { (number / most).clamp(-1.0, 1.0) } else { 0.0 }
}

/// The hue is the direction on the screen, and the longer, the lighter and the more saturated.
pub fn by_direction(vector: Vec2, share: f64) -> [u8; 3] {
    let length = vector.hypot2().sqrt();
    let way = if length > 0.0 { vector / length } else { Vec2::ZERO } * (0.02 + 0.12 * share);
    srgb([0.28 + 0.46 * share, way.x, way.y])
}

/// From dark violet over green to light yellow.
fn by_length(share: f64) -> [u8; 3] {
    srgb([0.36 + 0.54 * share, 0.07 - 0.17 * share * (2.0 - share) / 1.2, -0.12 + 0.27 * share])
}

/// Blue below zero and orange above.
fn signed(share: f64) -> [u8; 3] {
    let (a, b) = if share < 0.0 { (-0.02, -0.14) } else { (0.08, 0.11) };
    let much = share.abs();
    srgb([0.32 + 0.42 * much, a * much, b * much])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_set_a_look_and_its_command_makes_it_again() {
        for (words, command) in [
            ("", "vectors default"),
            ("length=2 equal=on", "vectors default length=2 equal=on"),
            (
                "color=curl steepest=0.5 longest=20 opacity=0.3",
                "vectors default color=curl longest=20 steepest=0.5 opacity=0.3",
            ),
            ("color=curl default length=3", "vectors default length=3"),
            ("longest=20 longest=auto", "vectors default"),
        ] {
            let mut look = VectorLook::default();
            look.set(words).unwrap();
            assert_eq!(look.command(), command, "{words}");
            let mut again = VectorLook { length: 7.0, color: Coloring::Length, ..VectorLook::default() };
            assert!(again.take(command));
            assert_eq!(again, look, "{words}");
        }
        for (words, why) in [
            ("colour=curl", "vectors have no \"colour\" (did you mean \"color\"?)"),
            ("color=blue", "color= is followed by plain, direction, length, divergence or curl"),
            ("length=11", "length= is followed by a number from 0.1 to 10"),
            ("equal", "equal= is followed by on or off"),
            ("longest=-1", "longest= is followed by auto or a length in pixels"),
        ] {
            assert_eq!(VectorLook::default().set(words).unwrap_err(), why);
        }
    }

    #[test]
    fn keys_step_through_lengths_colorings_and_opacities() {
        for (keys, expected) in [
            (&["arrows-longer"][..], "length=1.4"),
            (&["arrows-longer"; 20], "length=10"),
            (&["arrows-shorter", "arrows-shorter"], "length=0.5"),
            (&["arrows-equal"], "equal=on"),
            (&["next-coloring", "next-coloring"], "color=length"),
            (&["next-opacity", "next-opacity"], "opacity=0.3"),
        ] {
            let mut look = VectorLook::default();
            assert!(keys.iter().all(|key| look.take(key)));
            assert_eq!(look.command(), format!("vectors default {expected}"));
        }
        let mut look = VectorLook::default();
        (0..5).for_each(|_| assert!(look.take("next-coloring")));
        (0..3).for_each(|_| assert!(look.take("next-opacity")));
        assert_eq!(look, VectorLook::default(), "round once");
        assert!(!look.take("arrows") && !look.take("vectors length=11"));
    }

    #[test]
    fn colors_tell_directions_and_lengths_apart() {
        let look = VectorLook::default();
        let reach = Reach { longest_px: 1.0, steepest: 0.0 };
        let ways = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (0.5, 0.0), (0.0, 0.0)];
        let colors = ways.map(|way| look.color(way.into(), Slopes::default, reach));
        for (i, color) in colors.iter().enumerate() {
            assert!(colors[i + 1..].iter().all(|other| (0..3).any(|c| color[c].abs_diff(other[c]) > 30)), "{colors:?}");
        }
        assert_eq!(look.color(Vec2::ZERO, Slopes::default, Reach::default()), colors[5]);
    }

    #[test]
    fn colors_of_scales_get_lighter_on_both_sides_and_stop_at_the_range() {
        let light = |color: [u8; 3]| color.iter().map(|&c| u32::from(c)).sum::<u32>();
        let at = |color, vector: (f64, f64), curl| {
            let look = VectorLook { color, ..VectorLook::default() };
            look.color(vector.into(), || Slopes { curl, divergence: 0.0 }, Reach { longest_px: 4.0, steepest: 0.5 })
        };
        let lengths = [0.0, 1.0, 2.0, 3.0, 4.0].map(|x| light(at(Coloring::Length, (x, 0.0), 0.0)));
        assert!(lengths.is_sorted_by(|a, b| a < b), "{lengths:?}");
        assert_eq!(at(Coloring::Length, (9.0, 0.0), 0.0), at(Coloring::Length, (0.0, 4.0), 0.0));
        let [below, none, above] = [-0.5, 0.0, 0.5].map(|curl| at(Coloring::Curl, (1.0, 0.0), curl));
        assert!(
            below[2] > below[0] + 60 && above[0] > above[2] + 60 && light(none) < light(below),
            "{below:?} {above:?}"
        );
        assert_eq!(at(Coloring::Curl, (1.0, 0.0), 9.0), above);
        assert_eq!(at(Coloring::Divergence, (1.0, 0.0), 9.0), none);
    }
}
