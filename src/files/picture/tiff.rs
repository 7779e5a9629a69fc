//! TIFF: samples of 1 to 64 bits, integers or floating point, gray, RGB, palette, CMYK, YCbCr or Lab. Of several pages
//! the first that is not a thumbnail is read; raw photographs are recognized and refused.

use std::fs::File;
use std::io::BufReader;

use image::metadata::Orientation;
use tiff::decoder::{Decoder, DecodingResult, Limits as TiffLimits};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};

use super::decoded::{Color, Decoded, Model, Raw, Undecoded};
use super::ifd::{
    self, BITS, COLOR_MAP, COMPRESSION, DNG, EXTRA_SAMPLES, Form, PHOTOMETRIC, PLANES, PROFILE, Page, Patched, SAMPLES,
    SUBFILE,
};
use super::limits::{self, check_size};
use super::{jpeg, kinds};
use crate::base::error::{Error, Result};
use crate::files::Limits;

type Tiff = Decoder<BufReader<Patched>>;

/// The photometric interpretations of raw photographs: a color filter array, or linear sensor data.
const RAW_PHOTOMETRIC: [u64; 2] = [32803, 34892];
/// Compressions of raw photographs: Nikon, Sony, Pentax, Kodak.
const RAW_COMPRESSION: [u64; 4] = [34713, 32767, 65535, 65000];

const PALETTE: u64 = 3;
const CIE_LAB: u64 = 8;
const ICC_LAB: u64 = 9;

/// What is hidden from the decoder, or what it does not report.
struct About {
    /// Red, green and blue of every index, 16 bits each, all reds first.
    palette: Option<Vec<u16>>,
    /// Whether zero of a and b is code 0 (signed), not the middle code; `None` if it is not Lab.
    lab: Option<bool>,
    /// Whether alpha is among the extra samples, and multiplied into the others.
    associated: Option<bool>,
    /// Where only some samples are used.
    picked: Option<Picked>,
    /// The color profile; the decoder refuses one that is large compared with its picture.
    profile: Option<Vec<u8>>,
}

/// The samples of a pixel that are used, and what they are. The decoder is told that all of them are bands: by itself
/// it leaves extra samples out before it adds up the differences that a predictor has made of all.
struct Picked {
    samples: Vec<usize>,
    color: fn(u8) -> ColorType,
}

/// Reads the header.
pub(super) fn open(mut file: File, place: &str, limits: &Limits) -> Result<Undecoded> {
    let (form, pages) = ifd::pages(&mut file).map_err(|error| limits::reading(place, &error))?;
    let page = choose(&mut file, form, &pages, place)?;
    let (about, changes) = about(&mut file, form, page);
    let failed = |error| explain(place, error);
    let mut decoder = Decoder::new(BufReader::new(Patched { file, at: 0, changes })).map_err(failed)?;
    let (width, height) = decoder.dimensions().map_err(failed)?;
    let size = (width as usize, height as usize);
    check_size(place, size, limits)?;
    let color = decoder.colortype().map_err(failed)?;
    if !matches!(color.bit_depth(), 1 | 2 | 4 | 8 | 16 | 32 | 64) {
        return Err(kinds::other_kind(place, format!("a TIFF of {} bits a sample", color.bit_depth())));
    }
    let layout = decoder.image_buffer_layout().map_err(failed)?;
    // The decoded samples and what they are converted to are both in memory for a moment.
    let samples = size.0 as u64 * size.1 as u64 * u64::from(color.num_samples());
    let other = if about.palette.is_some() { samples * 6 } else { samples * u64::from(color.bit_depth().max(8)) / 8 };
    let bytes = (layout.complete_len as u64).saturating_add(if is_simple(color, &about) { 0 } else { other });
    let decoder = decoder.with_limits(tiff_limits(layout.complete_len, limits));
    let place = place.to_owned();
    let mut decoder = decoder;
    let orientation = decoder.find_tag(Tag::Orientation).ok().flatten().and_then(|v| v.into_u16().ok());
    let orientation =
        orientation.and_then(|v| Orientation::from_exif(v.min(255) as u8)).map_or(1, Orientation::to_exif);
    let decode = Box::new(move || decode(decoder, color, size, about, &place));
    Ok(Undecoded { size, orientation, bytes, decode })
}

fn tiff_limits(bytes: usize, limits: &Limits) -> TiffLimits {
    let besides = limits.memory.saturating_sub(bytes as u64).min(limits::BESIDES_PIXELS.max(bytes as u64));
    let mut own = TiffLimits::default();
    own.decoding_buffer_size = bytes;
    own.intermediate_buffer_size = usize::try_from(besides).unwrap_or(usize::MAX);
    own.ifd_value_size = own.intermediate_buffer_size;
    own
}

fn is_simple(color: ColorType, about: &About) -> bool {
    let plain = matches!(color, ColorType::Gray(8 | 16) | ColorType::RGB(8 | 16 | 32) | ColorType::RGBA(8 | 16 | 32));
    plain && about.palette.is_none()
}

fn choose<'a>(file: &mut File, form: Form, pages: &'a [Page], place: &str) -> Result<&'a Page> {
    for page in pages {
        let is = |file: &mut File, tag, known: &[u64]| page.value(file, form, tag).is_some_and(|v| known.contains(&v));
        if page.has(DNG) || is(file, PHOTOMETRIC, &RAW_PHOTOMETRIC) || is(file, COMPRESSION, &RAW_COMPRESSION) {
            return Err(kinds::raw(place));
        }
    }
    let mut whole = None;
    for page in pages {
        let reduced = page.value(file, form, SUBFILE).is_some_and(|kind| kind & 1 == 1);
        if !reduced && whole.is_none() {
            whole = Some(page);
        }
    }
    whole.or(pages.first()).ok_or_else(|| limits::broken(place, &"it has no pages"))
}

const GREY: u16 = 1;
const RGB: u16 = 2;
const CMYK: u64 = 5;

/// Which samples are used of those that extra samples follow, where the decoder would lose its way.
fn picked(file: &mut File, form: Form, page: &Page, photometric: u64) -> Option<Picked> {
    const PLANAR: u64 = 2;
    const JPEG: [u64; 2] = [6, 7];
    let one = |file: &mut File, tag, default| page.value(file, form, tag).unwrap_or(default);
    let extra = page.values(file, form, EXTRA_SAMPLES);
    let alpha = extra.iter().position(|&kind| matches!(kind, 1 | 2));
    let (count, color, with_alpha): (usize, fn(u8) -> ColorType, Option<fn(u8) -> ColorType>) = match photometric {
        v if v == u64::from(GREY) => (1, ColorType::Gray, Some(ColorType::GrayA)),
        v if v == u64::from(RGB) => (3, ColorType::RGB, Some(ColorType::RGBA)),
        CMYK => (4, ColorType::CMYK, None),
        CIE_LAB | ICC_LAB if alpha.is_none() => (3, ColorType::RGB, None),
        _ => return None,
    };
    let simple = extra.is_empty() || extra.len() == 1 && alpha.is_some();
    let all = one(file, SAMPLES, 1) == (count + extra.len()) as u64;
    let whole = matches!(one(file, BITS, 1), 8 | 16 | 32 | 64);
    let apart = one(file, PLANES, 1) == PLANAR || JPEG.contains(&one(file, COMPRESSION, 1));
    if simple || !all || !whole || apart {
        return None;
    }
    let (alpha, color) = match (alpha, with_alpha) {
        (Some(at), Some(with_alpha)) => (Some(count + at), with_alpha),
        _ => (None, color),
    };
    Some(Picked { samples: (0..count).chain(alpha).collect(), color })
}

fn about(file: &mut File, form: Form, page: &Page) -> (About, Vec<(u64, Vec<u8>)>) {
    let photometric = page.value(file, form, PHOTOMETRIC);
    let extra = page.values(file, form, EXTRA_SAMPLES);
    let associated = extra.iter().find(|kind| matches!(kind, 1 | 2)).map(|&kind| kind == 1);
    let profile = page.has(PROFILE).then(|| page.values(file, form, PROFILE).iter().map(|&v| v as u8).collect());
    let picked = photometric.and_then(|photometric| picked(file, form, page, photometric));
    let mut about = About { palette: None, lab: None, associated, picked, profile };
    let mut changes = vec![page.first(form)];
    let samples_are = if about.picked.is_some() { GREY } else { RGB };
    match photometric {
        Some(PALETTE) => {
            about.palette = Some(page.values(file, form, COLOR_MAP).iter().map(|&v| v as u16).collect());
            changes.extend(page.told(form, PHOTOMETRIC, GREY));
        }
        Some(CIE_LAB | ICC_LAB) => {
            about.lab = Some(photometric == Some(CIE_LAB));
            changes.extend(page.told(form, PHOTOMETRIC, samples_are));
        }
        _ if about.picked.is_some() => changes.extend(page.told(form, PHOTOMETRIC, GREY)),
        _ => {}
    }
    (about, changes)
}

fn decode(mut decoder: Tiff, color: ColorType, size: (usize, usize), about: About, place: &str) -> Result<Decoded> {
    let mut result = DecodingResult::U8(Vec::new());
    let layout = decoder.read_image_to_buffer(&mut result).map_err(|error| explain(place, error))?;
    if result.as_buffer(0).byte_len() < layout.complete_len {
        return Err(Error::at(place, "takes more memory to decode than is allowed")
            .cure("give --limit memory=BYTES, or save it in a simpler way"));
    }
    let raw = raw(result, color.bit_depth(), &layout, size, color.num_samples().into());
    let raw = raw.ok_or_else(|| unknown(place, color))?;
    let (raw, color) = match &about.picked {
        Some(picked) => (some(raw, color.num_samples().into(), &picked.samples), (picked.color)(color.bit_depth())),
        None if layout.planes > 1 => (interleaved(raw, layout.planes), color),
        None => (raw, color),
    };
    let (model, samples) = shaped(raw, color, &about).ok_or_else(|| unknown(place, color))?;
    let color = about.profile.map_or(Color::Untagged, Color::Icc);
    Ok(Decoded { size, model, samples, color, notes: Vec::new() })
}

fn unknown(place: &str, color: ColorType) -> Error {
    kinds::other_kind(place, format!("{color:?} samples in a TIFF"))
}

fn explain(place: &str, error: TiffError) -> Error {
    match error {
        TiffError::IoError(error) => limits::reading(place, &error),
        TiffError::UnsupportedError(what) => kinds::other_kind(place, limits::one_line(&what)),
        TiffError::LimitsExceeded => Error::at(place, "takes more memory to decode than is allowed")
            .cure("give --limit memory=BYTES, or save it in a simpler way"),
        error => limits::broken(place, &error),
    }
}

/// The decoded samples, as one of four kinds; samples of few bits are unpacked.
fn raw(
    result: DecodingResult,
    bits: u8,
    layout: &tiff::decoder::BufferLayoutPreference,
    (width, height): (usize, usize),
    count: usize,
) -> Option<Raw> {
    let word = |v: f64| (v.clamp(0.0, 1.0) * 65535.0 + 0.5) as u16;
    Some(match result {
        DecodingResult::U8(packed) if bits < 8 => {
            let stride = layout.row_stride?.get();
            let each = width * if layout.planes > 1 { 1 } else { count };
            let rows = packed.chunks_exact(stride).take(height * layout.planes);
            Raw::Bytes(rows.flat_map(|row| (0..each).map(move |i| few(row, i, bits))).collect())
        }
        DecodingResult::U8(all) => Raw::Bytes(all),
        DecodingResult::U16(all) if bits == 16 => Raw::Words(all),
        DecodingResult::U16(all) => {
            let most = f64::from((1u32 << bits) - 1);
            Raw::Words(all.into_iter().map(|v| word(f64::from(v) / most)).collect())
        }
        DecodingResult::U32(all) => {
            Raw::Words(all.into_iter().map(|v| word(f64::from(v) / f64::from(u32::MAX))).collect())
        }
        DecodingResult::U64(all) => Raw::Words(all.into_iter().map(|v| (v >> 48) as u16).collect()),
        DecodingResult::I8(all) => Raw::Bytes(all.into_iter().map(|v| (v as u8) ^ 0x80).collect()),
        DecodingResult::I16(all) => Raw::Words(all.into_iter().map(|v| (v as u16) ^ 0x8000).collect()),
        DecodingResult::I32(all) => {
            Raw::Words(all.into_iter().map(|v| word(f64::from(v) / f64::from(i32::MAX))).collect())
        }
        DecodingResult::I64(all) => Raw::Words(all.into_iter().map(|v| (v.max(0) >> 47) as u16).collect()),
        DecodingResult::F16(all) => Raw::Halves(all.into_iter().map(|v| v.to_bits()).collect()),
        DecodingResult::F32(all) => Raw::Floats(all),
        DecodingResult::F64(all) => Raw::Floats(all.into_iter().map(|v| v as f32).collect()),
    })
}

/// Sample `i` of a row whose samples have 1, 2 or 4 bits.
fn few(row: &[u8], i: usize, bits: u8) -> u8 {
    let at = i * usize::from(bits);
    row.get(at / 8).map_or(0, |byte| byte << (at % 8) >> (8 - bits))
}

/// Turns planes, one after another, into pixels.
fn interleaved(raw: Raw, planes: usize) -> Raw {
    fn woven<T: Copy>(all: &[T], planes: usize) -> Vec<T> {
        let each = all.len() / planes;
        (0..each).flat_map(|i| (0..planes).map(move |plane| all[plane * each + i])).collect()
    }
    match raw {
        Raw::Bytes(all) => Raw::Bytes(woven(&all, planes)),
        Raw::Words(all) => Raw::Words(woven(&all, planes)),
        Raw::Halves(all) => Raw::Halves(woven(&all, planes)),
        Raw::Floats(all) => Raw::Floats(woven(&all, planes)),
    }
}

/// The model of the samples, and only those samples that are used.
fn shaped(raw: Raw, color: ColorType, about: &About) -> Option<(Model, Raw)> {
    let bits = color.bit_depth();
    if let Some(palette) = &about.palette {
        return looked_up(raw, usize::from(color.num_samples()), bits, palette);
    }
    if let Some(signed) = about.lab {
        let raw = match raw {
            Raw::Bytes(all) if signed => Raw::Bytes(centered(all, 0x80)),
            Raw::Words(all) if signed => Raw::Words(centered(all, 0x8000)),
            other => other,
        };
        return (color.num_samples() == 3).then_some((Model::Lab, raw));
    }
    let spread = |raw| match raw {
        // 1, 2 and 4 bits are scaled to the full range.
        Raw::Bytes(all) if bits < 8 => {
            let step = 255 / ((1u16 << bits) - 1);
            Raw::Bytes(all.into_iter().map(|v| (u16::from(v) * step) as u8).collect())
        }
        other => other,
    };
    let with_alpha = |model, raw| (model, alpha(raw, model, about.associated));
    Some(match color {
        ColorType::Gray(_) => (Model::Grey, spread(raw)),
        ColorType::RGB(_) => (Model::Rgb, spread(raw)),
        ColorType::RGBA(_) => with_alpha(Model::Rgba, raw),
        ColorType::CMYK(_) => (Model::Cmyk, raw),
        ColorType::CMYKA(_) => (Model::Cmyk, some(raw, 5, &[0, 1, 2, 3])),
        ColorType::YCbCr(8) => (Model::Rgb, of_ycbcr(raw)?),
        ColorType::GrayA(_) => with_alpha(Model::GreyAlpha, raw),
        ColorType::Multiband { num_samples: 2, .. } if about.associated.is_some() => with_alpha(Model::GreyAlpha, raw),
        ColorType::Multiband { num_samples, .. } => (Model::Grey, spread(some(raw, num_samples.into(), &[0]))),
        _ => return None,
    })
}

/// The samples of each pixel that are at these places.
fn some(raw: Raw, count: usize, places: &[usize]) -> Raw {
    fn of<T: Copy>(all: &[T], count: usize, places: &[usize]) -> Vec<T> {
        all.chunks_exact(count).flat_map(|cell| places.iter().map(|&place| cell[place])).collect()
    }
    match raw {
        Raw::Bytes(all) => Raw::Bytes(of(&all, count, places)),
        Raw::Words(all) => Raw::Words(of(&all, count, places)),
        Raw::Halves(all) => Raw::Halves(of(&all, count, places)),
        Raw::Floats(all) => Raw::Floats(of(&all, count, places)),
    }
}

/// a and b of signed Lab, with zero moved to the middle code.
fn centered<T: Copy + std::ops::BitXor<Output = T>>(mut all: Vec<T>, middle: T) -> Vec<T> {
    for cell in all.as_chunks_mut::<3>().0 {
        cell[1] = cell[1] ^ middle;
        cell[2] = cell[2] ^ middle;
    }
    all
}

fn of_ycbcr(raw: Raw) -> Option<Raw> {
    match raw {
        Raw::Bytes(mut all) => {
            all.as_chunks_mut::<3>().0.iter_mut().for_each(|cell| *cell = jpeg::rgb(*cell));
            Some(Raw::Bytes(all))
        }
        _ => None,
    }
}

fn looked_up(raw: Raw, count: usize, bits: u8, palette: &[u16]) -> Option<(Model, Raw)> {
    let third = palette.len() / 3;
    if third == 0 || third < 1 << bits.min(16) {
        return None;
    }
    let color = |i: usize| [palette[i], palette[third + i], palette[2 * third + i]];
    let indices: Vec<usize> = match raw {
        Raw::Bytes(all) => all.chunks_exact(count).map(|cell| cell[0].into()).collect(),
        Raw::Words(all) => all.chunks_exact(count).map(|cell| cell[0].into()).collect(),
        _ => return None,
    };
    // Palettes are nearly always 8-bit colors written with 16 bits, in one of two ways.
    let bytes = palette.iter().all(|&v| v & 255 == v >> 8) || palette.iter().all(|&v| v & 255 == 0);
    Some(if bytes {
        (Model::Rgb, Raw::Bytes(indices.into_iter().flat_map(|i| color(i).map(|v| (v >> 8) as u8)).collect()))
    } else {
        (Model::Rgb, Raw::Words(indices.into_iter().flat_map(color).collect()))
    })
}

/// Converts to straight alpha for integers and premultiplied for the others, whatever the file has.
fn alpha(raw: Raw, model: Model, associated: Option<bool>) -> Raw {
    let count = model.count();
    match (raw, associated) {
        (Raw::Bytes(mut all), Some(true)) => {
            for cell in all.chunks_exact_mut(count) {
                let a = u32::from(cell[count - 1]);
                let part = |v: u8| (u32::from(v) * 255 + a / 2).checked_div(a).map_or(0, |v| v.min(255) as u8);
                cell[..count - 1].iter_mut().for_each(|v| *v = part(*v));
            }
            Raw::Bytes(all)
        }
        (Raw::Words(mut all), Some(true)) => {
            for cell in all.chunks_exact_mut(count) {
                let a = u64::from(cell[count - 1]);
                let part = |v: u16| (u64::from(v) * 65535 + a / 2).checked_div(a).map_or(0, |v| v.min(65535) as u16);
                cell[..count - 1].iter_mut().for_each(|v| *v = part(*v));
            }
            Raw::Words(all)
        }
        (Raw::Floats(mut all), Some(false)) => {
            for cell in all.chunks_exact_mut(count) {
                let a = cell[count - 1];
                cell[..count - 1].iter_mut().for_each(|v| *v *= a);
            }
            Raw::Floats(all)
        }
        (Raw::Halves(all), Some(false)) => {
            let floats = all.into_iter().map(crate::base::half::value_of_half).collect();
            alpha(Raw::Floats(floats), model, associated)
        }
        (raw, _) => raw,
    }
}
