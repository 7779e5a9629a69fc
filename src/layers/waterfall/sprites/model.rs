//! Where the pictures of sprites come from, as in the document.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::base::geometry::Xy;

/// The pictures that sprites show: keys, in tracks of keys that follow one another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Sprites {
    /// Texels of a side of a key: a multiple of 16.
    #[schemars(range(min = 16, max = 256), extend("unit" = "texels"))]
    pub size: u32,
    /// Keys of a track from the clip.
    #[schemars(range(min = 1, max = 32), extend("unit" = "1"))]
    pub keys: u32,
    /// Frames of the clip from one key to the next.
    #[schemars(range(min = 1, max = 100), extend("unit" = "frames"))]
    pub step: u32,
    /// How many windows are chosen if `picks` is empty.
    pub growth: Growth,
    /// Windows of the clip that are chosen by hand.
    #[schemars(length(max = 1000))]
    pub picks: Vec<Pick>,
    /// Images that hold keys side by side.
    #[schemars(length(max = 100))]
    pub sheets: Vec<Sheet>,
    /// What of a window is shown.
    pub matte: Matte,
}

/// How many windows are known by time t: c exp((b / a)(1 - exp(-a t))).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Growth {
    /// How soon the growth slows down.
    #[schemars(range(min = 0.001), extend("unit" = "1/s"))]
    pub a: f64,
    /// How fast it grows at the beginning.
    #[schemars(range(min = 0.0), extend("unit" = "1/s"))]
    pub b: f64,
    /// How many there are at the beginning.
    #[schemars(range(min = 1e-6), extend("unit" = "1"))]
    pub c: f64,
    /// How many there may be.
    #[schemars(range(min = 1, max = 256), extend("unit" = "1"))]
    pub max: u32,
}

/// A window of the clip, chosen by hand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pick {
    /// The frame of its first key; 0 is the clip's first. With track, (keys - 1) x step more frames follow it in the clip.
    #[schemars(range(min = 0, max = 999_999), extend("unit" = "frames"))]
    pub frame: u32,
    /// Its middle.
    #[schemars(extend("unit" = "px"))]
    pub at: Xy,
    /// What it shows.
    #[serde(default)]
    pub kind: Shows,
    /// Whether it follows what moves, for a track of keys; otherwise it is a single key.
    #[serde(default = "yes")]
    pub track: bool,
}

/// What a picture shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Shows {
    /// What falls.
    #[default]
    Water,
    /// What springs up.
    Foam,
}

/// An image that holds keys side by side, taken as they are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sheet {
    /// The image, by its name in the scene's images.
    #[schemars(extend("reference" = "images"))]
    pub image: String,
    /// Keys side by side.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 4096), extend("unit" = "1"))]
    pub columns: u32,
    /// Keys one above the other.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 4096), extend("unit" = "1"))]
    pub rows: u32,
    /// What they show.
    #[serde(default)]
    pub kind: Shows,
    /// Which of them follow one another.
    #[serde(default)]
    pub tracks: Rows,
}

/// Which keys of a sheet follow one another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Rows {
    /// Those of a row.
    #[default]
    Rows,
    /// All of them, row by row.
    All,
}

/// What of a window is shown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Matte {
    /// What is shown.
    pub kind: MatteKind,
    /// Of the texels of a track, this share is too dark to be seen.
    #[schemars(range(min = 0.0, max = 100.0), extend("unit" = "percent"))]
    pub low: f64,
    /// From this share on they are seen as much as can be.
    #[schemars(range(min = 0.0, max = 100.0), extend("unit" = "percent"))]
    pub high: f64,
    /// The least difference in brightness between the two, as a code of 8 bits.
    #[schemars(range(min = 1.0, max = 255.0), extend("unit" = "1"))]
    pub contrast: f64,
    /// The share of the way from the middle to the sides of a window on which it fades.
    #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1"))]
    pub feather: f64,
    /// The light that the brightest texels get; 0 leaves it as it is.
    #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1"))]
    pub white: f64,
}

/// What of a window is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MatteKind {
    /// What is bright.
    #[default]
    Luma,
    /// What is brighter than the same place at most other times.
    Motion,
    /// Light, taken against black: fire.
    Glow,
    /// Everything.
    None,
}

impl Default for Sprites {
    fn default() -> Self {
        let (growth, matte) = (Growth::default(), Matte::default());
        Sprites { size: 64, keys: 6, step: 2, growth, picks: Vec::new(), sheets: Vec::new(), matte }
    }
}

impl Default for Growth {
    fn default() -> Self {
        Growth { a: 0.8, b: 1.6, c: 4.0, max: 24 }
    }
}

impl Default for Matte {
    fn default() -> Self {
        Matte { kind: MatteKind::Luma, low: 25.0, high: 98.0, contrast: 16.0, feather: 1.0, white: 0.8 }
    }
}

impl Sprites {
    /// Frames of the clip from the first key of a track to the last, both counted.
    pub fn track_frames(&self) -> usize {
        (self.keys.max(1) - 1) as usize * self.step as usize + 1
    }

    /// How many tracks and keys there may be, and how many keys a sprite runs through.
    pub fn most(&self) -> (u64, u64, u64) {
        let keys = u64::from(self.keys);
        let laid = self.sheets.iter().map(|sheet| {
            let (columns, rows) = (u64::from(sheet.columns), u64::from(sheet.rows));
            match sheet.tracks {
                Rows::Rows => (rows, columns),
                Rows::All => (1, rows * columns),
            }
        });
        let picked = self.picks.iter().map(|pick| (1, if pick.track { keys } else { 1 }));
        let chosen = self.is_automatic().then_some((u64::from(self.growth.max), keys));
        let all = laid.chain(picked).chain(chosen);
        all.fold((0, 0, keys), |most, (tracks, keys)| (most.0 + tracks, most.1 + tracks * keys, most.2.max(keys)))
    }

    /// Whether windows are chosen automatically.
    pub fn is_automatic(&self) -> bool {
        let picked = self.picks.iter().map(|pick| pick.kind);
        let laid = self.sheets.iter().map(|sheet| sheet.kind);
        !picked.chain(laid).any(|kind| kind == Shows::Water)
    }
}

fn yes() -> bool {
    true
}

fn one() -> u32 {
    1
}
