//! What a manifest says about layers that fold: everything a player must know besides the numbers in the textures.

use serde::Serialize;

use super::function::Knot;
use crate::layers::folding::breaks::Break;
use crate::layers::folding::fold;
use crate::layers::parts::bundle::{PictureNote, TextureNote};
use crate::layers::timeline::Wrap;

/// What the manifest says about layers that fold.
#[derive(Debug, Serialize)]
pub struct Manifest {
    /// How all of it is read, in words.
    pub conventions: Conventions,
    /// The color atlas.
    #[serde(rename = "colour")]
    pub color: ColorNote,
    /// The position functions.
    pub function: Function,
    /// The layers, composed in this order: later over earlier.
    pub layers: Vec<Layer>,
}

/// How the textures are read, in words for whoever writes a player.
#[derive(Debug, Serialize)]
pub struct Conventions {
    texels: &'static str,
    coordinates: &'static str,
    #[serde(rename = "colour")]
    color: &'static str,
    data: &'static str,
    codes: &'static str,
    time: &'static str,
    function: &'static str,
    sampler: &'static str,
    first_stretch: &'static str,
    thresholds: &'static str,
    rules: &'static str,
    compose: &'static str,
}

/// The conventions of this version.
pub const CONVENTIONS: Conventions = Conventions {
    texels: "rows from the top; the centre of texel (i, j) is at (i + 0.5, j + 0.5)",
    coordinates: "u = x / width and v = y / height of the colour texture, v downward; flip v only where a target wants it",
    color: "sRGB with straight alpha; decode to linear light and premultiply before bilinear reads, encode at the end; where there is a float file take that, linear and premultiplied as it is",
    data: "read init, jump, function and thresholds as they are: no colour space, no premultiplying, compression or mip maps; init, jump and thresholds nearest, texel for texel of the zone's box",
    codes: "whole numbers: value = (code - zero) / (one - zero) * scale, so that the code zero is exactly 0; 32 bits: the value itself",
    time: "frame k has t = k / frames, for once k / max(frames - 1, 1); a zone's x = speed (t + shift); tau = x - floor(x) for repeat, 1 - |1 - 2 (x - floor(x))| for ping-pong, clamp(x, 0, 1) for once",
    function: "s of a zone stands in its row: texel i at tau = i / (columns - 1), and in its knots [tau, s before, s at, s after]; at a knot s is s at, else linear between the nearest points (texels and knots) on either side, s after of a knot on the left, s before of one on the right",
    sampler: "init R, G is where the sampler stands at s = 0, the same as (origin + pixel of the box) / (width, height); it reads init + e * jump, clamped to the texel centres of the zone's piece, bilinear; init A is 0 outside the zone, else (row + 0.5) / rows",
    first_stretch: "without a thresholds texture: where the rule is none or mask every sampler is active with e = s; else it is active, with e = s, where s0 < s <= s1, at s = 0 where s0 = 0 < s1, below 0 as at 0, above 1 as at 1",
    thresholds: "slot 0 is 1 where the pixel itself lies in a fold region; then the crossings with s >= 0, ascending, then those with s <= 0, descending, on which side of 0 s is. Slot n is channel n mod 4 of block n div 4; blocks are as large as the box and stacked downward. Starting from slot 0, each crossing c that s has passed (|s| > |c| + tolerance) changes inside to outside and back",
    rules: fold::IN_WORDS,
    compose: "a layer begins as its piece at (0, 0); its zones follow in order, each reading only its own source: lay replace puts the read in place of what lies beneath, lay over puts it over that (Porter and Duff), in linear light",
};

/// The color atlas in the manifest.
#[derive(Debug, Serialize)]
pub struct ColorNote {
    /// The files.
    #[serde(flatten)]
    pub files: PictureNote,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Its pieces.
    pub pieces: Vec<PieceNote>,
}

/// A piece of the atlas.
#[derive(Debug, Serialize)]
pub struct PieceNote {
    /// The image it is cut from.
    pub image: String,
    /// Its first column in the atlas.
    pub x: usize,
    /// Its first row in the atlas.
    pub y: usize,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Where its first texel lies in the image; one beyond the edge is transparent.
    pub from: [i64; 2],
}

/// The function texture in the manifest.
#[derive(Debug, Serialize)]
pub struct Function {
    /// The texture: one row a zone.
    #[serde(flatten)]
    pub texture: TextureNote,
    /// The largest difference between s and what is read between texels, measured at eight places in each interval.
    pub error_between: f64,
}

/// A layer.
#[derive(Debug, Serialize)]
pub struct Layer {
    /// Its name.
    pub name: String,
    /// The piece that it begins as.
    pub piece: usize,
    /// Its zones, in the order they are shown.
    pub zones: Vec<Zone>,
}

/// A zone.
#[derive(Debug, Serialize)]
pub struct Zone {
    /// Its name.
    pub name: String,
    /// Its row in the function texture.
    pub row: usize,
    /// The piece that its samplers read.
    pub piece: usize,
    /// The pixels of the layer that init and jump cover.
    #[serde(rename = "box")]
    pub bounds: Box,
    /// Its fold's rule, as in the document, or none.
    pub rule: &'static str,
    /// How what is read is laid on what is beneath: replace or over.
    pub lay: &'static str,
    /// What follows the end.
    pub wrap: Wrap,
    /// Passes in one timeline.
    pub speed: f64,
    /// Temporal shift in timelines; the same as init B.
    pub shift: f64,
    /// The smallest and largest s.
    pub range: [f64; 2],
    /// Where s jumps, ascending.
    pub breaks: Vec<Break>,
    /// Points between the columns of the function texture, ascending: τ, and s just before it, at it and just after it.
    pub knots: Vec<Knot>,
    /// Where the sampler of the box's first pixel is at s = 0, in atlas pixels: init R and G without their rounding.
    pub origin: [f64; 2],
    /// The init texture.
    pub init: TextureNote,
    /// The jump texture.
    pub jump: TextureNote,
    /// The thresholds texture, where the first stretch does not tell all.
    pub thresholds: Option<ThresholdsNote>,
}

/// A part of a layer's picture.
#[derive(Debug, Serialize)]
pub struct Box {
    /// First column.
    pub x: usize,
    /// First row.
    pub y: usize,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

/// A thresholds texture in the manifest.
#[derive(Debug, Serialize)]
pub struct ThresholdsNote {
    /// The texture.
    #[serde(flatten)]
    pub texture: TextureNote,
    /// Which slots hold what.
    pub slots: Slots,
    /// How far s must be beyond a crossing to have passed it.
    pub tolerance: f64,
}

/// The slots of a thresholds texture; slot 0 tells whether the pixel itself lies in a fold region.
#[derive(Debug, Serialize)]
pub struct Slots {
    /// Crossings with s >= 0, from slot 1 on.
    pub ahead: usize,
    /// Crossings with s <= 0, after those.
    pub behind: usize,
}
