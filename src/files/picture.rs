//! Pictures from files, kept as they were read. The header is read first and held against the limits, so that a
//! huge picture is refused before memory is taken for it.
//!
//! 8 and 16 bits a channel are sRGB with straight alpha; floating point (OpenEXR, HDR, TIFF) is linear light, with
//! premultiplied alpha. Colour profiles are not followed. A photograph is turned upright as its EXIF orientation says, as
//! every viewer shows it. Of an animation the first frame is taken.

use std::fs::File;
use std::io::{BufReader, Seek, SeekFrom};
use std::path::Path;

use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageError, ImageReader};
use rayon::prelude::*;

use super::{Limits, paths};
use crate::base::error::{Error, Result};
use crate::base::picture::{Channels, Picture, SRGB_8, SRGB_16, Samples};

/// What a PNG may take besides its pixels: profiles and comments are made small and then dropped.
const BESIDES_PIXELS: u64 = 32 << 20;

/// Reads the picture at `path`.
///
/// # Errors
/// One message when it cannot be opened, is no picture, is broken, or is larger than the limits allow.
pub fn read(path: &Path, limits: &Limits) -> Result<Picture> {
    decode(paths::open_named(path)?, &path.display().to_string(), limits)
}

/// Width and height of the picture at `path`, as [`read`] would give it; only the header is looked at.
///
/// # Errors
/// As [`read`], as far as the header tells.
pub fn size(path: &Path, limits: &Limits) -> Result<(usize, usize)> {
    header(paths::open_named(path)?, &path.display().to_string(), limits)
}

/// The picture in an open file; `place` is what messages call it.
///
/// # Errors
/// As [`read`].
pub fn decode(file: File, place: &str, limits: &Limits) -> Result<Picture> {
    let mut decoder = decoder(file, place, limits)?;
    let orientation = orientation(&mut decoder);
    let mut image = DynamicImage::from_decoder(decoder).map_err(|error| explain(place, error))?;
    image.apply_orientation(orientation);
    kept(image).ok_or_else(|| Error::at(place, "has a kind of pixels that is not known"))
}

/// Width and height of the picture in an open file, upright.
///
/// # Errors
/// As [`size`].
pub fn header(file: File, place: &str, limits: &Limits) -> Result<(usize, usize)> {
    let mut decoder = decoder(file, place, limits)?;
    let (width, height) = decoder.dimensions();
    let (width, height) = (width as usize, height as usize);
    Ok(match orientation(&mut decoder) {
        Orientation::Rotate90 | Orientation::Rotate270 | Orientation::Rotate90FlipH | Orientation::Rotate270FlipH => {
            (height, width)
        }
        _ => (width, height),
    })
}

/// A decoder that has read the header, and found it within the limits.
pub(super) fn decoder(mut file: File, place: &str, limits: &Limits) -> Result<impl ImageDecoder> {
    let length = file.seek(SeekFrom::End(0)).and_then(|length| file.rewind().map(|()| length));
    within(place, "is", "bytes long", "memory", length.map_err(|error| Error::at(place, error))?, limits.memory)?;
    let mut reader =
        ImageReader::new(BufReader::new(file)).with_guessed_format().map_err(|error| Error::at(place, error))?;
    reader.limits(image_limits(limits.memory.min(BESIDES_PIXELS)));
    let mut decoder = reader.into_decoder().map_err(|error| explain(place, error))?;
    let (width, height) = decoder.dimensions();
    if width == 0 || height == 0 {
        return Err(Error::at(place, format!("has no pixels: it is {width} x {height}")));
    }
    let size = format!("is {width} x {height}:");
    within(place, &size, "pixels wide or high", "side", u64::from(width.max(height)), limits.side)?;
    within(place, &size, "pixels", "pixels", u64::from(width) * u64::from(height), limits.pixels)?;
    within(place, &size, "bytes to decode", "memory", decoder.total_bytes(), limits.memory)?;
    decoder.set_limits(image_limits(limits.memory)).map_err(|error| explain(place, error))?;
    Ok(decoder)
}

/// Refuses `found` above `most`, naming the limit.
pub(super) fn within(place: &str, size: &str, unit: &str, limit: &str, found: u64, most: u64) -> Result<()> {
    if found <= most {
        return Ok(());
    }
    Err(Error::at(place, format!("{size} {found} {unit}, at most {most} are allowed"))
        .cure(format!("make it smaller, or give --limit {limit}={found}")))
}

fn image_limits(bytes: u64) -> image::Limits {
    let mut limits = image::Limits::no_limits();
    limits.max_alloc = Some(bytes);
    limits
}

/// Upright unless the file says otherwise; what it says may well be broken.
fn orientation(decoder: &mut impl ImageDecoder) -> Orientation {
    decoder.orientation().unwrap_or(Orientation::NoTransforms)
}

pub(super) fn explain(place: &str, error: ImageError) -> Error {
    const READ: &str = "Plica reads PNG, JPEG, TIFF, WebP, GIF, OpenEXR and Radiance HDR";
    match error {
        ImageError::Unsupported(_) => Error::at(place, "is not a picture of a known kind").cure(READ),
        ImageError::Limits(_) => Error::at(place, "takes more memory to decode than is allowed")
            .cure("give --limit memory=BYTES, or save it in a simpler way"),
        ImageError::IoError(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            Error::at(place, "is cut short").cure("copy it again from where it came")
        }
        error => {
            // Some decoders end their message with a line end, or write several lines.
            let what = error.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
            Error::at(place, format!("cannot be decoded: {what}")).cure("save it again from another program")
        }
    }
}

/// The picture as it was decoded: nothing is computed but floats that no light has.
fn kept(image: DynamicImage) -> Option<Picture> {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let channels = Channels::of(image.color().channel_count().into())?;
    let samples = match image {
        DynamicImage::ImageLuma8(b) => Samples::Bytes(b.into_raw(), SRGB_8.clone()),
        DynamicImage::ImageLumaA8(b) => Samples::Bytes(b.into_raw(), SRGB_8.clone()),
        DynamicImage::ImageRgb8(b) => Samples::Bytes(b.into_raw(), SRGB_8.clone()),
        DynamicImage::ImageRgba8(b) => Samples::Bytes(b.into_raw(), SRGB_8.clone()),
        DynamicImage::ImageLuma16(b) => Samples::Words(b.into_raw(), SRGB_16.clone()),
        DynamicImage::ImageLumaA16(b) => Samples::Words(b.into_raw(), SRGB_16.clone()),
        DynamicImage::ImageRgb16(b) => Samples::Words(b.into_raw(), SRGB_16.clone()),
        DynamicImage::ImageRgba16(b) => Samples::Words(b.into_raw(), SRGB_16.clone()),
        DynamicImage::ImageRgb32F(b) => Samples::Floats(finite(b.into_raw(), channels)),
        DynamicImage::ImageRgba32F(b) => Samples::Floats(finite(b.into_raw(), channels)),
        _ => return None,
    };
    Some(Picture::new(width, height, channels, samples))
}

/// Renderers leave NaN and infinite pixels behind: they become 0 and the largest half float, so that no bilinear read
/// spreads them.
fn finite(mut values: Vec<f32>, channels: Channels) -> Vec<f32> {
    const LARGEST: f32 = 65504.0;
    let count = channels.count();
    let alpha = if channels.have_alpha() { count - 1 } else { count };
    values.par_chunks_mut(count).for_each(|cell| {
        for (i, x) in cell.iter_mut().enumerate() {
            let (low, high) = if i == alpha { (0.0, 1.0) } else { (-LARGEST, LARGEST) };
            *x = if x.is_nan() { 0.0 } else { x.clamp(low, high) };
        }
    });
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::pixels::{self, Rgba};
    use image::{ImageBuffer, Luma, LumaA, Rgb, Rgba as ImageRgba};

    fn folder() -> tempfile::TempDir {
        tempfile::tempdir().unwrap()
    }

    fn refusal(path: &Path, limits: &Limits) -> String {
        let said = size(path, limits).err().map(|e| e.to_string());
        let read = read(path, limits).unwrap_err().to_string();
        assert!(said.is_none_or(|said| said == read), "header and picture say the same");
        read
    }

    /// A PNG of one chunk after another, each with its length and checksum.
    fn png(chunks: &[(&[u8; 4], Vec<u8>)]) -> Vec<u8> {
        let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
        for (kind, data) in chunks {
            bytes.extend((data.len() as u32).to_be_bytes());
            let checked: Vec<u8> = kind.iter().chain(data).copied().collect();
            bytes.extend(&checked);
            bytes.extend(crc32(&checked).to_be_bytes());
        }
        bytes
    }

    fn crc32(bytes: &[u8]) -> u32 {
        !bytes.iter().fold(!0, |crc, &byte| {
            (0..8).fold(crc ^ u32::from(byte), |c, _| if c & 1 == 1 { c >> 1 ^ 0xedb8_8320 } else { c >> 1 })
        })
    }

    fn ihdr(width: u32, height: u32) -> Vec<u8> {
        [&width.to_be_bytes()[..], &height.to_be_bytes(), &[8, 6, 0, 0, 0]].concat()
    }

    #[test]
    fn every_kind_of_pixel_is_linear_and_premultiplied() {
        let folder = folder();
        let lin = |code: f64| pixels::linear_from_srgb(code) as f32;
        let half = 128.0 / 255.0;
        let (g8, a8) = (lin(half), half as f32);
        let g16 = lin(0x8000 as f64 / 65535.0);
        let a16 = 0x8000 as f32 / 65535.0;
        let cases: [(&str, DynamicImage, Rgba); 11] = [
            ("l8.png", ImageBuffer::from_pixel(2, 1, Luma([128u8])).into(), [g8, g8, g8, 1.0]),
            ("la8.png", ImageBuffer::from_pixel(2, 1, LumaA([128u8, 128])).into(), [g8 * a8, g8 * a8, g8 * a8, a8]),
            ("rgb8.png", ImageBuffer::from_pixel(2, 1, Rgb([128u8, 0, 255])).into(), [g8, 0.0, 1.0, 1.0]),
            (
                "rgba8.png",
                ImageBuffer::from_pixel(2, 1, ImageRgba([128u8, 0, 255, 128])).into(),
                [g8 * a8, 0.0, a8, a8],
            ),
            ("l16.png", ImageBuffer::from_pixel(2, 1, Luma([0x8000u16])).into(), [g16, g16, g16, 1.0]),
            ("la16.png", ImageBuffer::from_pixel(2, 1, LumaA([0x8000u16, 0])).into(), [0.0; 4]),
            ("rgb16.png", ImageBuffer::from_pixel(2, 1, Rgb([0x8000u16, 0, 0xffff])).into(), [g16, 0.0, 1.0, 1.0]),
            (
                "rgba16.tiff",
                ImageBuffer::from_pixel(2, 1, ImageRgba([0x8000u16, 0, 0xffff, 0x8000])).into(),
                [g16 * a16, 0.0, a16, a16],
            ),
            ("rgb32.exr", ImageBuffer::from_pixel(2, 1, Rgb([0.25f32, f32::NAN, 2.0])).into(), [0.25, 0.0, 2.0, 1.0]),
            (
                "rgba32.exr",
                ImageBuffer::from_pixel(2, 1, ImageRgba([0.25f32, f32::INFINITY, 0.0, 0.5])).into(),
                [0.25, 65504.0, 0.0, 0.5],
            ),
            ("rgb8.gif", ImageBuffer::from_pixel(2, 1, Rgb([255u8, 0, 0])).into(), [1.0, 0.0, 0.0, 1.0]),
        ];
        for (name, image, expected) in cases {
            let path = folder.path().join(name);
            image.save(&path).unwrap();
            let picture = read(&path, &Limits::default()).unwrap();
            assert_eq!((picture.width(), picture.height()), (2, 1), "{name}");
            assert_eq!(size(&path, &Limits::default()).unwrap(), (2, 1), "{name}");
            for (found, expected) in picture.texel(1, 0).iter().zip(expected) {
                assert!((found - expected).abs() <= 1e-6, "{name}: {found} for {expected}");
            }
        }
    }

    #[test]
    fn a_palette_is_looked_up() {
        let folder = folder();
        let path = folder.path().join("palette.png");
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 2, 1);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(vec![255, 0, 0, 0, 0, 255]);
        encoder.set_trns(vec![255, 0]);
        encoder.write_header().unwrap().write_image_data(&[0, 1]).unwrap();
        std::fs::write(&path, bytes).unwrap();
        let picture = read(&path, &Limits::default()).unwrap();
        assert_eq!(picture.to_linear().cells(), [[1.0, 0.0, 0.0, 1.0], [0.0; 4]]);
    }

    #[test]
    fn a_photograph_is_turned_upright() {
        let folder = folder();
        let path = folder.path().join("turned.png");
        // EXIF of one entry: orientation 6, the picture is to be turned clockwise.
        let exif = b"MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0".to_vec();
        let mut plain = Vec::new();
        let image: DynamicImage = ImageBuffer::from_fn(3, 1, |x, _| Luma([x as u8 * 100])).into();
        image.write_to(&mut std::io::Cursor::new(&mut plain), image::ImageFormat::Png).unwrap();
        let (head, rest) = plain.split_at(33);
        std::fs::write(&path, [head, &png(&[(b"eXIf", exif)])[8..], rest].concat()).unwrap();
        assert_eq!(size(&path, &Limits::default()).unwrap(), (1, 3));
        let picture = read(&path, &Limits::default()).unwrap();
        assert_eq!((picture.width(), picture.height()), (1, 3));
        assert_eq!(pixels::encode(picture.texel(0, 2))[0], 200);
    }

    #[test]
    fn what_is_too_large_is_refused_from_its_header() {
        let folder = folder();
        let path = folder.path().join("huge.png");
        let default = Limits::default();
        for (width, height, part) in
            [(65535, 65535, "--limit pixels=4294836225"), (1 << 21, 1, "--limit side=2097152"), (0, 10, "huge.png")]
        {
            std::fs::write(&path, png(&[(b"IHDR", ihdr(width, height)), (b"IDAT", vec![])])).unwrap();
            let error = refusal(&path, &default);
            assert!(error.contains(part) && error.lines().count() == 1, "{error}");
        }
        std::fs::write(&path, png(&[(b"IHDR", ihdr(1000, 1000)), (b"IDAT", vec![])])).unwrap();
        for (setting, part) in [("pixels=999999", "pixels"), ("side=999", "side"), ("memory=3999999", "memory")] {
            let limits = Limits::from_settings(&[setting.into()]).unwrap();
            assert!(refusal(&path, &limits).contains(&format!("--limit {part}")));
        }
        let strip: DynamicImage = ImageBuffer::from_pixel(65535, 1, Luma([9u8])).into();
        strip.save(&path).unwrap();
        assert_eq!(read(&path, &default).unwrap().width(), 65535);
    }

    #[test]
    fn a_profile_is_not_unpacked_without_end() {
        let folder = folder();
        let path = folder.path().join("bomb.png");
        let profile = deflated_zeros(8 << 20);
        let icc = [b"x\0\0".to_vec(), profile].concat();
        let image: DynamicImage = ImageBuffer::from_pixel(1, 1, Luma([255u8])).into();
        let mut plain = Vec::new();
        image.write_to(&mut std::io::Cursor::new(&mut plain), image::ImageFormat::Png).unwrap();
        let (head, rest) = plain.split_at(33);
        std::fs::write(&path, [head, &png(&[(b"iCCP", icc)])[8..], rest].concat()).unwrap();
        for (setting, unpacked) in [("memory=1M", false), ("memory=16M", true)] {
            let limits = Limits::from_settings(&[setting.into()]).unwrap();
            let mut decoder = decoder(File::open(&path).unwrap(), "bomb.png", &limits).unwrap();
            assert_eq!(decoder.icc_profile().unwrap().is_some(), unpacked, "{setting}");
            assert_eq!(read(&path, &limits).unwrap().texel(0, 0)[0], 1.0);
        }
    }

    /// Zeros as zlib would pack them, taken from a picture of nothing but zeros.
    fn deflated_zeros(count: u32) -> Vec<u8> {
        let side = count.isqrt();
        let image: DynamicImage = ImageBuffer::from_pixel(side, side, Luma([0u8])).into();
        let mut bytes = Vec::new();
        image.write_to(&mut std::io::Cursor::new(&mut bytes), image::ImageFormat::Png).unwrap();
        let at = bytes.windows(4).position(|w| w == b"IDAT").unwrap();
        let length = u32::from_be_bytes(bytes[at - 4..at].try_into().unwrap()) as usize;
        bytes[at + 4..][..length].to_vec()
    }

    #[test]
    fn what_is_no_picture_says_so() {
        let folder = folder();
        let path = folder.path().join("cat.png");
        let image: DynamicImage = ImageBuffer::from_fn(64, 64, |x, y| Luma([(x * y) as u8])).into();
        let mut whole = Vec::new();
        image.write_to(&mut std::io::Cursor::new(&mut whole), image::ImageFormat::Png).unwrap();
        for (bytes, part) in [
            (&b""[..], "not a picture"),
            (b"hello, world", "not a picture"),
            (b"BM6\0\0\0\0\0\0\0", "not a picture"),
            (&whole[..20], "cat.png"),
            (&whole[..whole.len() / 2], "cat.png"),
            (b"\xff\xd8\xff\xe0", "cat.png"),
            (b"GIF89a", "cat.png"),
            (b"\x76\x2f\x31\x01\x02\0\0\0", "cat.png"),
            (b"RIFF\0\0\0\0WEBPVP8 ", "cat.png"),
            (b"II*\0\x08\0\0\0", "cat.png"),
            (b"#?RADIANCE\n", "cat.png"),
        ] {
            std::fs::write(&path, bytes).unwrap();
            let error = refusal(&path, &Limits::default());
            assert!(error.contains(part) && error.lines().count() == 1, "{error}");
        }
    }
}
