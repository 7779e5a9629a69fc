//! Pictures of 32-bit floats, as OpenEXR.

use std::io::Cursor;

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

fn encode(picture: &Linear, bytes: &[u8], color: ExtendedColorType) -> Result<Vec<u8>, ImageError> {
    let mut out = Cursor::new(Vec::new());
    let (width, height) = (picture.width() as u32, picture.height() as u32);
    OpenExrEncoder::new(&mut out).write_image(bytes, width, height, color)?;
    Ok(out.into_inner())
}
