//! JPEG. Its markers are walked first: a truncated file is detected here, because the decoder would paint what is
//! missing gray; and the pieces of a color profile are joined. Inks (CMYK, YCCK) stay inks if there is a profile for
//! them.

use std::fs::File;
use std::io::Read;

use image::metadata::Orientation;
use zune_core::bytestream::ZCursor;
use zune_core::colorspace::ColorSpace;
use zune_core::options::DecoderOptions;
use zune_jpeg::{JpegDecoder, errors::DecodeErrors};

use super::decoded::{Color, Decoded, Model, Raw, Undecoded};
use super::limits;
use super::{icc, kinds};
use crate::base::error::{Error, Result};
use crate::files::Limits;
use crate::files::limits::within;

/// Reads the header, and checks that the file is complete.
pub(super) fn open(mut file: File, length: u64, place: &str, limits: &Limits) -> Result<Undecoded> {
    within(place, "is", "bytes long", "memory", length, limits.memory)?;
    let mut input = Vec::new();
    file.read_to_end(&mut input).map_err(|error| limits::reading(place, &error))?;
    let walked = Walked::of(&input);
    if let Some((_, what)) = walked.form.and_then(|form| FORMS.iter().find(|(marker, _)| *marker == form)) {
        return Err(kinds::other_kind(place, what));
    }
    let mut decoder = decoder(&input, ColorSpace::RGB);
    if let Err(error) = decoder.decode_headers() {
        return Err(if walked.ended { explain(place, error) } else { limits::cut_short(place) });
    }
    let (Some(size), Some(inside)) = (decoder.dimensions(), decoder.input_colorspace()) else {
        return Err(limits::cut_short(place));
    };
    limits::check_size(place, size, limits)?;
    if !walked.ended {
        return Err(limits::cut_short(place));
    }
    let orientation = walked.exif.and_then(Orientation::from_exif_chunk).map_or(1, Orientation::to_exif);
    let how = How::new(inside, walked.profile());
    let pixels = (size.0 * size.1) as u64;
    // A progressive file is kept as coefficients until all of them are read.
    let waiting = if walked.progressive { inside.num_components() as u64 * 2 } else { 0 };
    let bytes = length + pixels * (how.out.num_components() as u64 + waiting);
    let place = place.to_owned();
    let decode = Box::new(move || how.decode(&input, size, &place));
    Ok(Undecoded { size, orientation, bytes, decode })
}

/// The options are those of the image crate, so that pictures without a profile look as in other programs.
fn decoder(input: &[u8], out: ColorSpace) -> JpegDecoder<ZCursor<&[u8]>> {
    let options = DecoderOptions::default()
        .jpeg_set_out_colorspace(out)
        .set_strict_mode(false)
        .set_max_width(usize::MAX)
        .set_max_height(usize::MAX);
    JpegDecoder::new_with_options(ZCursor::new(input), options)
}

/// What to ask of the decoder, and what to do with its output.
struct How {
    out: ColorSpace,
    color: Color,
    notes: Vec<String>,
}

impl How {
    fn new(inside: ColorSpace, profile: Option<Vec<u8>>) -> How {
        let mut notes = Vec::new();
        let inks = matches!(inside, ColorSpace::CMYK | ColorSpace::YCCK);
        let out = match inside {
            ColorSpace::Luma | ColorSpace::LumaA | ColorSpace::RGB | ColorSpace::RGBA => inside,
            _ => ColorSpace::RGB,
        };
        match profile {
            None => How { out, color: Color::Untagged, notes },
            Some(profile) if inks => match icc::understand(&profile, Model::Cmyk) {
                Ok(_) => How { out: inside, color: Color::Icc(profile), notes },
                Err(why) => {
                    notes.push(why);
                    How { out, color: Color::Untagged, notes }
                }
            },
            Some(profile) => How { out, color: Color::Icc(profile), notes },
        }
    }

    fn decode(self, input: &[u8], size: (usize, usize), place: &str) -> Result<Decoded> {
        let mut samples = vec![0; size.0 * size.1 * self.out.num_components()];
        decoder(input, self.out).decode_into(&mut samples).map_err(|error| explain(place, error))?;
        let model = match self.out {
            ColorSpace::CMYK => {
                // Every program writes inks in a JPEG inverted, as Adobe's first did.
                samples.iter_mut().for_each(|ink| *ink = 255 - *ink);
                Some(Model::Cmyk)
            }
            ColorSpace::YCCK => {
                samples.as_chunks_mut::<4>().0.iter_mut().for_each(|cell| *cell = inks(*cell));
                Some(Model::Cmyk)
            }
            other => Model::of(other.num_components()),
        };
        let model = model.ok_or_else(|| Error::at(place, "has a kind of pixels that is not known"))?;
        Ok(Decoded { size, model, samples: Raw::Bytes(samples), color: self.color, notes: self.notes })
    }
}

/// CMYK of YCCK.
fn inks([y, cb, cr, k]: [u8; 4]) -> [u8; 4] {
    let [c, m, y] = rgb([y, cb, cr]);
    [c, m, y, 255 - k]
}

/// RGB of YCbCr, by JFIF.
pub(super) fn rgb([y, cb, cr]: [u8; 3]) -> [u8; 3] {
    let (y, cb, cr) = (f32::from(y), f32::from(cb) - 128.0, f32::from(cr) - 128.0);
    [y + 1.402 * cr, y - 0.344_136 * cb - 0.714_136 * cr, y + 1.772 * cb].map(|v| (v + 0.5) as u8)
}

fn explain(place: &str, error: DecodeErrors) -> Error {
    match error {
        DecodeErrors::ExhaustedData => limits::cut_short(place),
        DecodeErrors::Unsupported(what) => kinds::other_kind(place, limits::one_line(&format!("{what:?}"))),
        error => limits::broken(place, &format!("{error:?}").replace('"', "")),
    }
}

/// Forms of JPEG that are not read, by the marker of the frame.
const FORMS: &[(u8, &str)] = &[
    (0xc3, "a lossless JPEG"),
    (0xc5, "a hierarchical JPEG"),
    (0xc6, "a hierarchical JPEG"),
    (0xc7, "a hierarchical JPEG"),
    (0xc9, "a JPEG with arithmetic coding"),
    (0xca, "a JPEG with arithmetic coding"),
    (0xcb, "a JPEG with arithmetic coding"),
    (0xcd, "a JPEG with arithmetic coding"),
    (0xce, "a JPEG with arithmetic coding"),
    (0xcf, "a JPEG with arithmetic coding"),
    (0xf7, "a JPEG-LS picture"),
];

/// What the markers say.
#[derive(Default)]
struct Walked<'a> {
    exif: Option<&'a [u8]>,
    /// Pieces of the color profile with their numbers from 1, and how many there should be.
    pieces: Vec<(u8, u8, &'a [u8])>,
    progressive: bool,
    /// The marker of the first frame: which form of JPEG it is.
    form: Option<u8>,
    /// Whether the end marker was found.
    ended: bool,
}

impl<'a> Walked<'a> {
    fn of(input: &'a [u8]) -> Self {
        let mut walked = Walked::default();
        let mut at = 2;
        while let Some(marker) = marker(input, &mut at) {
            match marker {
                0xd9 => {
                    walked.ended = true;
                    break;
                }
                // The restart and start markers have no length.
                0x01 | 0xd0..=0xd8 => continue,
                _ => {}
            }
            let Some(&[high, low]) = input.get(at..at + 2).and_then(|b| b.first_chunk()) else { break };
            let length = usize::from(high) << 8 | usize::from(low);
            let data = input.get(at + 2..at + length.max(2)).unwrap_or_default();
            // Not among them: tables (c4, c8, cc) stand beside the frames.
            if matches!(marker, 0xc0..=0xcf | 0xf7) && !matches!(marker, 0xc4 | 0xc8 | 0xcc) {
                walked.form = walked.form.or(Some(marker));
            }
            match marker {
                0xe1 => walked.exif = walked.exif.or_else(|| data.strip_prefix(b"Exif\0\0")),
                0xe2 => walked.pieces.extend(piece(data)),
                0xc2 | 0xc6 | 0xca | 0xce => walked.progressive = true,
                _ => {}
            }
            at += length.max(2);
        }
        walked
    }

    /// The color profile; empty if pieces of it are missing, `None` if it has none.
    fn profile(&self) -> Option<Vec<u8>> {
        let mut pieces = self.pieces.clone();
        pieces.sort_by_key(|piece| piece.0);
        pieces.dedup_by_key(|piece| piece.0);
        let all = pieces.iter().map(|piece| piece.0).eq(1..=pieces.first()?.1);
        // An incomplete profile is empty, and will be reported as broken.
        Some(if all { pieces.iter().flat_map(|piece| piece.2).copied().collect() } else { Vec::new() })
    }
}

fn piece(data: &[u8]) -> Option<(u8, u8, &[u8])> {
    match data.strip_prefix(b"ICC_PROFILE\0")? {
        [number, count, rest @ ..] => Some((*number, *count, rest)),
        _ => None,
    }
}

/// The next marker from `at` on, wherever it is: between segments, or after the data of a scan.
fn marker(input: &[u8], at: &mut usize) -> Option<u8> {
    loop {
        let begins = input.get(*at..)?.iter().position(|&byte| byte == 0xff)?;
        *at += begins + 1;
        match input.get(*at)? {
            0x00 => {}
            0xff => continue,
            &code => {
                *at += 1;
                return Some(code);
            }
        }
    }
}
