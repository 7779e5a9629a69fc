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

/// A file that was written, in the manifest.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FileNote {
    /// The file.
    pub file: String,
}

/// A written texture of half floats in the manifest: as they are, whatever the bits of other numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HalvesNote {
    /// The file.
    pub file: String,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

/// The bits of the half floats of a texel, by its column and row.
pub type Halves<'a> = &'a (dyn Fn(usize, usize) -> [u16; 4] + Sync);

/// Where the textures of a bundle go. Names are without the extension.
pub trait Sink {
    /// The side of pictures that surfaces are baked into; `None` if they are not.
    fn baked_px(&self) -> Option<usize>;

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

    /// Writes a texture of half floats, of this width and height.
    ///
    /// # Errors
    /// As [`Sink::texture`].
    fn halves(&mut self, name: &str, size: (usize, usize), texel: Halves) -> Result<HalvesNote>;

    /// Writes a mesh, which is the text of an OBJ.
    ///
    /// # Errors
    /// As [`Sink::texture`].
    fn mesh(&mut self, name: &str, text: &str) -> Result<FileNote>;
}

/// What a file of a bundle is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// See [`Sink::texture`].
    Texture,
    /// See [`Sink::picture`].
    Picture,
    /// See [`Sink::halves`].
    Halves,
    /// See [`Sink::mesh`].
    Mesh,
}

/// The names that the files of a bundle may have, declared before anything is made.
#[derive(Clone, Debug, Default)]
pub struct Names {
    /// Pictures, without the extension.
    pub pictures: Vec<String>,
    /// Textures, without the extension.
    pub textures: Vec<String>,
    /// What has files of its own: the name of its layer, if there are several, and its own.
    pub items: Vec<(Option<String>, String)>,
    /// What those files are, and what their names end in; those that are called as the item is end in nothing.
    pub ends: Vec<(Form, String)>,
    /// Whether something is baked if that is asked for.
    pub bakes: bool,
}
