//! One picture as a PNG file: finished frames, and data that no color management may touch.

use std::io::Write;

use png::{BitDepth, ColorType, Compression, Encoder, EncodingError};

use crate::base::pixels::Frame;

/// Above this many bytes pixels are packed piece by piece: as a whole they would be in memory once more.
const LARGE: usize = 256 << 20;
const CHUNK: usize = 1 << 20;

/// Bytes that packing so many pixels takes besides the frame: they are filtered, and packed in a buffer that grows.
pub fn memory(pixels: u64) -> u64 {
    if pixels * 4 <= LARGE as u64 { pixels * 8 } else { 8 * CHUNK as u64 }
}

/// sRGB in the numbers of ITU-T H.273: primaries of BT.709, transfer of sRGB, no matrix, full range.
const CICP_SRGB: [u8; 4] = [1, 13, 0, 1];

/// The header of a picture of 8 bits in sRGB with straight alpha, which says so in both ways that PNG has. `more` sets what
/// else belongs in it. Packed fast: forty times as fast as by what the crate takes by itself, and at most a quarter larger.
pub fn srgb<'a, W: Write>(
    out: W,
    (width, height): (usize, usize),
    more: impl FnOnce(&mut Encoder<'a, W>) -> Result<(), EncodingError>,
) -> Result<png::Writer<W>, EncodingError> {
    let mut encoder = Encoder::new(out, width as u32, height as u32);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(Compression::Fast);
    more(&mut encoder)?;
    let mut writer = encoder.write_header()?;
    writer.write_chunk(png::chunk::cICP, &CICP_SRGB)?;
    Ok(writer)
}

/// A finished frame: sRGB, straight alpha.
pub fn frame(frame: &Frame) -> Result<Vec<u8>, EncodingError> {
    pixels((frame.width(), frame.height()), frame.cells().as_flattened())
}

/// Finished pixels, 4 bytes each: sRGB, straight alpha.
pub fn pixels(size: (usize, usize), pixels: &[u8]) -> Result<Vec<u8>, EncodingError> {
    let mut bytes = Vec::new();
    let mut writer = srgb(&mut bytes, size, |_| Ok(()))?;
    put(&mut writer, pixels)?;
    writer.finish()?;
    Ok(bytes)
}

/// Packs the pixels of a PNG that is not an animation.
pub fn put<W: Write>(writer: &mut png::Writer<W>, pixels: &[u8]) -> Result<(), EncodingError> {
    if pixels.len() <= LARGE {
        return writer.write_image_data(pixels);
    }
    let mut stream = writer.stream_writer_with_size(CHUNK)?;
    stream.write_all(pixels)?;
    stream.finish()
}

/// Data in four channels of `depth` bits, 8 or 16, row by row; without a color space, so that no reader converts it.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The names of the chunks of a PNG, in order.
    fn chunks(bytes: &[u8]) -> Vec<String> {
        let (mut at, mut names) = (8, Vec::new());
        while at < bytes.len() {
            let length = u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
            names.push(String::from_utf8_lossy(&bytes[at + 4..at + 8]).into_owned());
            at += 12 + length;
        }
        names
    }

    #[test]
    fn a_frame_says_that_it_is_srgb_and_data_says_nothing() {
        let bytes = frame(&Frame::filled(3, 2, [1, 2, 3, 4])).unwrap();
        assert_eq!(chunks(&bytes), ["IHDR", "sRGB", "cICP", "IDAT", "IEND"]);
        let info = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        let cicp = info.info().coding_independent_code_points.unwrap();
        assert_eq!((cicp.color_primaries, cicp.transfer_function, cicp.matrix_coefficients), (1, 13, 0));
        assert!(cicp.is_video_full_range_image);
        assert_eq!(chunks(&data(1, 1, 16, &[1, 2, 3, 4]).unwrap()), ["IHDR", "IDAT", "IEND"]);
    }
}
