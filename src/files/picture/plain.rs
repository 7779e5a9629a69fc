//! The kinds that the image crate reads completely by itself; PNG goes through here too (`png.rs`).

use std::io::{BufRead, Read, Seek, SeekFrom};

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, metadata::Orientation};

use super::decoded::{Color, Decoded, Model, Raw, Undecoded};
use super::kinds;
use super::limits::{self, BESIDES_PIXELS};
use crate::base::error::{Error, Result};
use crate::files::Limits;

/// So many bytes hold what is looked at before a decoder is.
const HEAD: u64 = 128;

/// Reads the header.
pub(super) fn open(
    reader: impl BufRead + Seek + 'static,
    format: ImageFormat,
    place: &str,
    limits: &Limits,
) -> Result<Undecoded> {
    let mut reader = reader;
    look(&mut reader, format, place)?;
    let mut decoder = decoder(reader, format, place, limits)?;
    let (width, height) = decoder.dimensions();
    let size = (width as usize, height as usize);
    // Upright if there is no orientation in the file, or a broken one.
    let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms).to_exif();
    let profile = decoder.icc_profile().ok().flatten();
    let (bytes, place) = (decoder.total_bytes(), place.to_owned());
    let decode = Box::new(move || {
        let image = DynamicImage::from_decoder(decoder).map_err(|error| limits::explain(&place, error))?;
        let (model, samples) =
            kept(image).ok_or_else(|| Error::at(&place, "has a kind of pixels that is not known"))?;
        let color = profile.map_or(Color::Untagged, Color::Icc);
        Ok(Decoded { size, model, samples, color, notes: Vec::new() })
    });
    Ok(Undecoded { size, orientation, bytes, decode })
}

/// What the decoders do not tell rightly of the kinds themselves.
fn look(reader: &mut (impl BufRead + Seek), format: ImageFormat, place: &str) -> Result<()> {
    let failed = |error| limits::reading(place, &error);
    let length = reader.seek(SeekFrom::End(0)).map_err(failed)?;
    reader.rewind().map_err(failed)?;
    let mut head = Vec::new();
    reader.take(HEAD).read_to_end(&mut head).map_err(failed)?;
    reader.rewind().map_err(failed)?;
    let number = |at: usize| head.get(at..at + 4).and_then(|b| b.first_chunk()).map(|b| u32::from_le_bytes(*b));
    match format {
        // The header of a PAM has an end.
        ImageFormat::Pnm if length < HEAD && head.starts_with(b"P7") && !head.windows(6).any(|w| w == b"ENDHDR") => {
            Err(limits::cut_short(place))
        }
        // A WebP says how long it is.
        ImageFormat::WebP if number(4).is_some_and(|rest| length < u64::from(rest) + 8) => {
            Err(limits::cut_short(place))
        }
        ImageFormat::Dds => match (head.get(84..88), number(12), number(16)) {
            (Some(b"DXT1" | b"DXT3" | b"DXT5" | b"DX10"), Some(height), Some(width)) => {
                let odd = width % 4 != 0 || height % 4 != 0;
                let what = format!("a DDS of {width} x {height}, whose sides are no multiples of 4");
                if odd { Err(kinds::other_kind(place, what)) } else { Ok(()) }
            }
            (None, ..) => Err(limits::cut_short(place)),
            _ => Err(kinds::other_kind(place, "a DDS that is not compressed as DXT1, DXT3 or DXT5")),
        },
        _ => Ok(()),
    }
}

fn decoder(
    reader: impl BufRead + Seek + 'static,
    format: ImageFormat,
    place: &str,
    limits: &Limits,
) -> Result<Box<dyn ImageDecoder>> {
    let mut reader = ImageReader::with_format(reader, format);
    reader.limits(limits::for_decoder(limits.memory.min(BESIDES_PIXELS)));
    let mut decoder = reader.into_decoder().map_err(|error| limits::explain(place, error))?;
    let (width, height) = decoder.dimensions();
    limits::check_size(place, (width as usize, height as usize), limits)?;
    decoder.set_limits(limits::for_decoder(limits.memory)).map_err(|error| limits::explain(place, error))?;
    Ok(Box::new(decoder))
}

/// The samples as decoded.
fn kept(image: DynamicImage) -> Option<(Model, Raw)> {
    let model = Model::of(image.color().channel_count().into())?;
    let samples = match image {
        DynamicImage::ImageLuma8(b) => Raw::Bytes(b.into_raw()),
        DynamicImage::ImageLumaA8(b) => Raw::Bytes(b.into_raw()),
        DynamicImage::ImageRgb8(b) => Raw::Bytes(b.into_raw()),
        DynamicImage::ImageRgba8(b) => Raw::Bytes(b.into_raw()),
        DynamicImage::ImageLuma16(b) => Raw::Words(b.into_raw()),
        DynamicImage::ImageLumaA16(b) => Raw::Words(b.into_raw()),
        DynamicImage::ImageRgb16(b) => Raw::Words(b.into_raw()),
        DynamicImage::ImageRgba16(b) => Raw::Words(b.into_raw()),
        DynamicImage::ImageRgb32F(b) => Raw::Floats(b.into_raw()),
        DynamicImage::ImageRgba32F(b) => Raw::Floats(b.into_raw()),
        _ => return None,
    };
    Some((model, samples))
}
