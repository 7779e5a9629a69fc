//! Textures for other engines: what a technique gives of its layers, and what the exporter reports back.

use serde::Serialize;

use crate::base::error::Result;
use crate::base::pixels::{Frame, Grid, Linear};

/// What a channel holds.
#[derive(Clone, Copy, Debug)]
pub struct Channel {
    /// Its name.
    pub name: &'static str,
    /// What its numbers mean.
    pub meaning: &'static str,
    /// Channels of one group have one scale.
    pub group: u8,
    /// Pixels a unit, for numbers that are places.
    pub pixels: Option<f64>,
}

impl Channel {
    /// A channel of plain numbers.
    pub const fn new(name: &'static str, meaning: &'static str, group: u8) -> Self {
        Channel { name, meaning, group, pixels: None }
    }
}

/// A data texture; channels without a meaning hold 0.
pub struct Texture {
    /// The numbers.
    pub values: Grid<[f64; 4]>,
    /// What they mean, in the order R, G, B, A.
    pub channels: Vec<Channel>,
}

/// How a channel is read: value = (code - zero) / (one - zero) * scale; a float is the value itself.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChannelNote {
    /// R, G, B or A.
    pub channel: &'static str,
    /// Its name.
    pub name: &'static str,
    /// What its numbers mean.
    pub meaning: &'static str,
    /// The code of 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zero: Option<u16>,
    /// The code of `scale`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub one: Option<u16>,
    /// The value of the code `one`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// The largest difference between a number and what is read back, measured over the texture.
    pub error: f64,
    /// The same in pixels, for places.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_px: Option<f64>,
}

/// A written texture in the manifest.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TextureNote {
    /// The file, in the folder of the manifest.
    pub file: String,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Bits a number; 32 are floats.
    pub bits: u8,
    /// What the channels hold; those not named hold nothing.
    pub channels: Vec<ChannelNote>,
}

/// A written picture in the manifest.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PictureNote {
    /// The file: sRGB with straight alpha, 8 bits.
    pub file: String,
    /// The same in floats, linear light premultiplied by alpha, where a picture holds light that 8 bits cannot.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub float: Option<FloatNote>,
}

/// A written picture in floats.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FloatNote {
    /// The file.
    pub file: String,
}

/// Where the textures of a bundle go. Names are without the extension.
pub trait Sink {
    /// The largest code of a number; `None` if numbers are floats.
    fn largest_code(&self) -> Option<u16>;

    /// `done` of `total` steps are done.
    ///
    /// # Errors
    /// The work is to end.
    fn step(&mut self, done: u64, all: u64) -> Result<()>;

    /// What the names of the textures of an item begin with: one of the declared names, and such that there is
    /// no texture that ends in `end` yet.
    fn stem(&self, layer: Option<&str>, item: &str, end: &str) -> String;

    /// Writes numbers.
    ///
    /// # Errors
    /// The file cannot be written, or is not among the names declared before.
    fn texture(&mut self, name: &str, texture: &Texture) -> Result<TextureNote>;

    /// Writes a picture in linear light, premultiplied by alpha; `finish` may still change the 8-bit codes.
    ///
    /// # Errors
    /// As [`Sink::texture`].
    fn picture(&mut self, name: &str, colors: &Linear, finish: &dyn Fn(&mut Frame)) -> Result<PictureNote>;
}

/// The names that the files of a bundle may have, declared before anything is made.
#[derive(Clone, Debug, Default)]
pub struct Names {
    /// Pictures, without the extension.
    pub pictures: Vec<String>,
    /// Textures, without the extension.
    pub textures: Vec<String>,
    /// What has textures of its own: the name of its layer, if there are several, and its own.
    pub items: Vec<(Option<String>, String)>,
    /// What the names of those textures end in.
    pub ends: &'static [&'static str],
}
