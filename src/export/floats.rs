//! Pictures of floats, as OpenEXR.

use std::io::Cursor;

use exr::error::Error;
use exr::image::Encoding;
use exr::prelude::{Image, SpecificChannels, Vec2, WritableImage, f16};
use image::codecs::openexr::OpenExrEncoder;
use image::{ExtendedColorType, ImageEncoder, ImageError};

use crate::base::pixels::Linear;

/// The channels R, G, B and A.
///
/// # Errors
/// Returns the encoder's error.
pub fn rgba(picture: &Linear) -> Result<Vec<u8>, ImageError> {
    encode(picture, bytemuck::cast_slice(picture.cells()), ExtendedColorType::Rgba32F)
}

/// The channels R, G and B.
///
/// # Errors
/// Returns the encoder's error.
pub fn rgb(picture: &Linear) -> Result<Vec<u8>, ImageError> {
    let cells: Vec<[f32; 3]> = picture.cells().iter().map(|&[r, g, b, _]| [r, g, b]).collect();
    encode(picture, bytemuck::cast_slice(&cells), ExtendedColorType::Rgb32F)
}

/// The channels R, G, B and A of half floats, each texel by its column and row, as bits.
///
/// # Errors
/// Returns the encoder's error.
pub fn halves(
    (width, height): (usize, usize),
    texel: &(dyn Fn(usize, usize) -> [u16; 4] + Sync),
) -> Result<Vec<u8>, Error> {
    let channels = SpecificChannels::rgba(|Vec2(x, y): Vec2<usize>| {
        let [r, g, b, a] = texel(x, y).map(f16::from_bits);
        (r, g, b, a)
    });
    let mut out = Cursor::new(Vec::new());
    Image::from_encoded_channels((width, height), Encoding::SMALL_FAST_LOSSLESS, channels)
        .write()
        .to_buffered(&mut out)?;
    Ok(out.into_inner())
}

fn encode(picture: &Linear, bytes: &[u8], color: ExtendedColorType) -> Result<Vec<u8>, ImageError> {
    let mut out = Cursor::new(Vec::new());
    let (width, height) = (picture.width() as u32, picture.height() as u32);
    OpenExrEncoder::new(&mut out).write_image(bytes, width, height, color)?;
    Ok(out.into_inner())
}
