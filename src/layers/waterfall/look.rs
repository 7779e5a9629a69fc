//! How sprites look. Water and foam have the same fields, and other values where they are not set.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::base::color;
use crate::base::pixels::decode;

/// How a sprite looks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Look {
    /// Its width at birth and at death.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(inner(range(min = 1e-6)), extend("unit" = "m"))]
    pub width: Option<[f64; 2]>,
    /// Widths differ by up to this share.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 0.99), extend("unit" = "1"))]
    pub jitter: Option<f64>,
    /// It is as much longer than wide as it travels in this time.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 10.0), extend("unit" = "s"))]
    pub streak: Option<f64>,
    /// Whether it is turned to where it goes, so that what was down in the clip leads.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub align: Option<bool>,
    /// A smaller angle counts as 0, which is drawn faster.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 90.0), extend("unit" = "degrees"))]
    pub snap: Option<f64>,
    /// It is turned at random at birth, up to this far either way.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "degrees"))]
    pub tilt: Option<f64>,
    /// It turns this far in a life, either way.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "degrees"))]
    pub spin: Option<f64>,
    /// Whether half of them are mirrored left to right.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mirror: Option<bool>,
    /// How much it covers.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1"))]
    pub opacity: Option<f64>,
    /// The shares of a life in which it appears and vanishes.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(inner(range(min = 0.0, max = 1.0)), extend("unit" = "1"))]
    pub fade: Option<[f64; 2]>,
    /// How many times brighter it is; its opacity stays.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 100.0), extend("unit" = "1"))]
    pub gain: Option<f64>,
    /// Colors over the age, ascending, that its own is multiplied by; their alpha multiplies its opacity.
    pub tint: Vec<Tint>,
}

/// A color at an age.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tint {
    /// The age, as a share of the life.
    #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1"))]
    pub at: f64,
    /// sRGB with straight alpha: #rrggbb or #rrggbbaa.
    pub color: String,
}

/// How sprites of one kind look, with everything set.
#[derive(Clone, Debug, PartialEq)]
pub struct FullLook {
    /// Width at birth and at death, in meters.
    pub width: [f64; 2],
    /// By which share widths differ.
    pub jitter: f64,
    /// In seconds of travel, how much longer than wide it is.
    pub streak: f64,
    /// Whether it is turned to where it goes.
    pub align: bool,
    /// Smaller angles are 0, in degrees.
    pub snap: f64,
    /// How far it is turned at birth at most, in degrees.
    pub tilt: f64,
    /// How far it turns in a life, in degrees.
    pub spin: f64,
    /// Whether half of them are mirrored.
    pub mirror: bool,
    /// How much it covers.
    pub opacity: f64,
    /// The shares of a life in which it appears and vanishes.
    pub fade: [f64; 2],
    /// How many times brighter it is.
    pub gain: f64,
    /// Colors over the age: linear light with straight alpha.
    pub tint: Vec<(f64, [f64; 4])>,
}

impl Look {
    /// The look with everything set: what is not set is as in `otherwise`.
    pub fn or(&self, otherwise: FullLook) -> FullLook {
        // An invalid color counts as transparent.
        let light = |tint: &Tint| {
            let [r, g, b, a] = color::parse(&tint.color).unwrap_or([0; 4]);
            let [r, g, b, _] = decode([r, g, b, 255]).map(f64::from);
            (tint.at, [r, g, b, f64::from(a) / 255.0])
        };
        FullLook {
            width: self.width.unwrap_or(otherwise.width),
            jitter: self.jitter.unwrap_or(otherwise.jitter),
            streak: self.streak.unwrap_or(otherwise.streak),
            align: self.align.unwrap_or(otherwise.align),
            snap: self.snap.unwrap_or(otherwise.snap),
            tilt: self.tilt.unwrap_or(otherwise.tilt),
            spin: self.spin.unwrap_or(otherwise.spin),
            mirror: self.mirror.unwrap_or(otherwise.mirror),
            opacity: self.opacity.unwrap_or(otherwise.opacity),
            fade: self.fade.unwrap_or(otherwise.fade),
            gain: self.gain.unwrap_or(otherwise.gain),
            tint: self.tint.iter().map(light).collect(),
        }
    }
}

impl FullLook {
    /// What water looks like in a fall of this height in meters; `free` is how long a free fall from there takes.
    pub fn water(height: f64, free: f64) -> FullLook {
        FullLook {
            width: [0.04 * height, 0.11 * height],
            jitter: 0.3,
            streak: 0.12 * free,
            align: true,
            snap: 2.0,
            tilt: 0.0,
            spin: 0.0,
            mirror: true,
            opacity: 0.7,
            fade: [0.05, 0.1],
            gain: 1.0,
            tint: Vec::new(),
        }
    }

    /// What its foam looks like.
    pub fn foam(height: f64) -> FullLook {
        FullLook {
            width: [0.06 * height, 0.2 * height],
            jitter: 0.5,
            streak: 0.0,
            align: false,
            tilt: 180.0,
            spin: 40.0,
            opacity: 0.3,
            fade: [0.1, 0.9],
            ..FullLook::water(height, 0.0)
        }
    }

    /// The tint at `s`, a share of the life: linear light with straight alpha.
    pub fn tint(&self, s: f64) -> [f64; 4] {
        let after = self.tint.partition_point(|(at, _)| *at <= s);
        match (after.checked_sub(1).map(|i| &self.tint[i]), self.tint.get(after)) {
            (None, None) => [1.0; 4],
            (Some((_, color)), None) | (None, Some((_, color))) => *color,
            (Some((from, a)), Some((to, b))) => {
                let share = (s - from) / (to - from);
                std::array::from_fn(|c| a[c] + (b[c] - a[c]) * share)
            }
        }
    }

    /// The widest that a sprite can be, in meters.
    pub fn widest(&self) -> f64 {
        self.width[0].max(self.width[1]) * (1.0 + self.jitter)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tints_change_evenly_in_linear_light_and_stay_beyond_the_ends() {
        let at = |at: f64, color: &str| Tint { at, color: color.into() };
        let look = Look { tint: vec![at(0.2, "#ffffff00"), at(0.6, "#000000ff")], ..Look::default() };
        let look = look.or(FullLook::foam(1.0));
        for (s, tint) in [
            (0.0, [1.0, 1.0, 1.0, 0.0]),
            (0.2, [1.0, 1.0, 1.0, 0.0]),
            (0.4, [0.5; 4]),
            (0.6, [0.0, 0.0, 0.0, 1.0]),
            (1.0, [0.0, 0.0, 0.0, 1.0]),
        ] {
            let found = look.tint(s);
            assert!(found.iter().zip(tint).all(|(a, b)| (a - b).abs() < 1e-12), "{s}: {found:?}");
        }
        assert_eq!(FullLook::foam(1.0).tint(0.5), [1.0; 4]);
    }
}
