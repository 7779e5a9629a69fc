//! One picture as a PNG file: finished frames, and data that no colour management may touch.

use png::{BitDepth, ColorType, Encoder, EncodingError};

use crate::base::pixels::Frame;

/// A finished frame: sRGB, straight alpha.
pub fn frame(frame: &Frame) -> Result<Vec<u8>, EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, frame.width() as u32, frame.height() as u32);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(frame.cells().as_flattened())?;
    writer.finish()?;
    Ok(bytes)
}

/// Data in four channels of `depth` bits, 8 or 16, row by row; without a colour space, so that nobody converts it.
pub fn data(width: usize, height: usize, depth: u8, codes: &[u16]) -> Result<Vec<u8>, EncodingError> {
    let (depth, raw) = match depth {
        8 => (BitDepth::Eight, codes.iter().map(|&c| c as u8).collect::<Vec<u8>>()),
        _ => (BitDepth::Sixteen, codes.iter().flat_map(|c| c.to_be_bytes()).collect()),
    };
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&raw)?;
    writer.finish()?;
    Ok(bytes)
}
