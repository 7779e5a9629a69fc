//! Turns the color that a file declares for its samples into linear sRGB light. Matrix and curves become a table of
//! light for every code, and the samples stay as they were; what needs a table of colors (inks, some scanners) becomes
//! sRGB codes of 16 bits. An sRGB profile changes nothing, to the bit.

use std::sync::Arc;

use rayon::prelude::*;

use super::conversion::{FROM_XYZ, Profile, Table, Transfer, from_lab, multiply};
use super::decoded::{Color, Decoded, Loaded, Model, Raw};
use super::icc;
use crate::base::half::value_of_half;
use crate::base::picture::{Channels, Picture, SRGB_8, SRGB_16, Samples};
use crate::base::pixels::srgb_from_linear;

/// The picture, with its declared color applied as far as possible; `None` if its samples do not fit its size and
/// model.
pub(super) fn apply(decoded: Decoded) -> Option<Loaded> {
    let Decoded { size: (width, height), model, samples, color, mut notes } = decoded;
    let profile = profile(&color, model, &samples, &mut notes);
    let (channels, samples) = match (profile, samples) {
        (_, samples) if model == Model::Lab => (Channels::Rgb, of_lab(samples)),
        (Some(Profile::Table(table)), samples) => of_table(&table, model, samples),
        (_, samples) if model == Model::Cmyk => (Channels::Rgb, of_inks(samples)?),
        (Some(Profile::Shaper(shaper)), Raw::Bytes(all)) => {
            (Channels::of(model.count())?, Samples::Bytes(all, Arc::new(shaper.light())))
        }
        (Some(Profile::Shaper(shaper)), Raw::Words(all)) => {
            (Channels::of(model.count())?, Samples::Words(all, Arc::new(shaper.light())))
        }
        (_, Raw::Bytes(all)) => (Channels::of(model.count())?, Samples::Bytes(all, SRGB_8.clone())),
        (_, Raw::Words(all)) => (Channels::of(model.count())?, Samples::Words(all, SRGB_16.clone())),
        (_, Raw::Halves(all)) => (Channels::of(model.count())?, Samples::Halves(finite_halves(all, model))),
        (_, Raw::Floats(all)) => (Channels::of(model.count())?, Samples::Floats(finite(all, model))),
    };
    let fits = match &samples {
        Samples::Bytes(all, _) => all.len(),
        Samples::Words(all, _) | Samples::Halves(all) => all.len(),
        Samples::Floats(all) => all.len(),
    } == width * height * channels.count();
    fits.then(|| Loaded { picture: Picture::new(width, height, channels, samples), notes })
}

/// The profile to apply; `None` for sRGB, and if it cannot be applied, with a note.
fn profile(color: &Color, model: Model, samples: &Raw, notes: &mut Vec<String>) -> Option<Profile> {
    let profile = match color {
        Color::Untagged => return None,
        Color::Icc(_) if matches!(samples, Raw::Halves(_) | Raw::Floats(_)) => {
            notes.push("it is floating point, which is linear light: its color profile was not applied".to_owned());
            return None;
        }
        Color::Icc(bytes) => icc::understand(bytes, model).map_err(|why| notes.push(why)).ok()?,
        Color::Spoken(spoken) => {
            if matches!(spoken.transfer, Transfer::Pq | Transfer::Hlg) {
                notes.push("it is HDR: what is brighter than white is clipped to it".to_owned());
            }
            Profile::Shaper(Box::new(spoken.shaper()?))
        }
    };
    match profile {
        Profile::Shaper(shaper) if shaper.is_srgb() => None,
        other => Some(other),
    }
}

fn of_table(table: &Table, model: Model, samples: Raw) -> (Channels, Samples) {
    let count = model.count();
    let alpha = model.alpha();
    let channels = if alpha.is_some() { Channels::Rgba } else { Channels::Rgb };
    let codes = match samples {
        Raw::Bytes(all) => through(table, &all, count, alpha, |code| u16::from(code) * 257),
        Raw::Words(all) | Raw::Halves(all) => through(table, &all, count, alpha, |code| code),
        Raw::Floats(all) => through(table, &all, count, alpha, |value| (value.clamp(0.0, 1.0) * 65535.0) as u16),
    };
    (channels, Samples::Words(codes, SRGB_16.clone()))
}

fn through<T: Copy + PartialEq + Sync>(
    table: &Table,
    all: &[T],
    count: usize,
    alpha: Option<usize>,
    word: impl Fn(T) -> u16 + Sync,
) -> Vec<u16> {
    let each = 3 + usize::from(alpha.is_some());
    let mut out = vec![0; all.len() / count * each];
    const RUN: usize = 4096;
    out.par_chunks_mut(RUN * each).zip(all.par_chunks(RUN * count)).for_each(|(out, all)| {
        let mut last: Option<(&[T], [u16; 3])> = None;
        for (out, cell) in out.chunks_exact_mut(each).zip(all.chunks_exact(count)) {
            let device = &cell[..table.inputs];
            let code = match last {
                Some((known, code)) if known == device => code,
                _ => {
                    let values: [f64; 4] =
                        std::array::from_fn(|c| device.get(c).map_or(0.0, |&v| f64::from(word(v)) / 65535.0));
                    table.code(&values)
                }
            };
            last = Some((device, code));
            out[..3].copy_from_slice(&code);
            if let Some(alpha) = alpha {
                out[3] = word(cell[alpha]);
            }
        }
    });
    out
}

/// Inks without a profile, converted as the image crate does.
fn of_inks(samples: Raw) -> Option<Samples> {
    match samples {
        Raw::Bytes(all) => {
            let rgb = |&[c, m, y, k]: &[u8; 4]| {
                let rest = 1.0 - f32::from(k) / 255.0;
                [c, m, y].map(|ink| ((255.0 - f32::from(ink)) * rest) as u8)
            };
            let all: Vec<[u8; 3]> = all.as_chunks::<4>().0.iter().map(rgb).collect();
            Some(Samples::Bytes(all.into_flattened(), SRGB_8.clone()))
        }
        Raw::Words(all) => {
            let rgb = |&[c, m, y, k]: &[u16; 4]| {
                let rest = 1.0 - f32::from(k) / 65535.0;
                [c, m, y].map(|ink| ((65535.0 - f32::from(ink)) * rest) as u16)
            };
            let all: Vec<[u16; 3]> = all.as_chunks::<4>().0.iter().map(rgb).collect();
            Some(Samples::Words(all.into_flattened(), SRGB_16.clone()))
        }
        Raw::Halves(_) | Raw::Floats(_) => None,
    }
}

fn of_lab(samples: Raw) -> Samples {
    let code = |l: f64, a: f64, b: f64| {
        let light = multiply(&FROM_XYZ, from_lab([l * 100.0, a, b]));
        light.map(|light| (srgb_from_linear(light.clamp(0.0, 1.0)) * 65535.0 + 0.5) as u16)
    };
    let words: Vec<[u16; 3]> = match samples {
        Raw::Bytes(all) => {
            let lab = |&[l, a, b]: &[u8; 3]| code(f64::from(l) / 255.0, f64::from(a) - 128.0, f64::from(b) - 128.0);
            all.as_chunks::<3>().0.par_iter().map(lab).collect()
        }
        Raw::Words(all) | Raw::Halves(all) => {
            let ab = |v: u16| f64::from(v) / 256.0 - 128.0;
            let lab = |&[l, a, b]: &[u16; 3]| code(f64::from(l) / 65535.0, ab(a), ab(b));
            all.as_chunks::<3>().0.par_iter().map(lab).collect()
        }
        Raw::Floats(all) => {
            let lab = |&[l, a, b]: &[f32; 3]| code(f64::from(l) / 100.0, a.into(), b.into());
            all.as_chunks::<3>().0.par_iter().map(lab).collect()
        }
    };
    Samples::Words(words.into_flattened(), SRGB_16.clone())
}

/// The largest half float.
const LARGEST: f32 = 65504.0;

/// Renderers can leave NaN and infinite pixels: they become 0 and the largest half float, so that bilinear
/// interpolation does not spread them.
fn finite(mut values: Vec<f32>, model: Model) -> Vec<f32> {
    values.par_chunks_mut(model.count()).for_each(|cell| {
        for (i, x) in cell.iter_mut().enumerate() {
            let (low, high) = if Some(i) == model.alpha() { (0.0, 1.0) } else { (-LARGEST, LARGEST) };
            *x = if x.is_nan() { 0.0 } else { x.clamp(low, high) };
        }
    });
    values
}

fn finite_halves(mut values: Vec<u16>, model: Model) -> Vec<u16> {
    const ONE: u16 = 0x3c00;
    values.par_chunks_mut(model.count()).for_each(|cell| {
        for (i, bits) in cell.iter_mut().enumerate() {
            let value = value_of_half(*bits);
            *bits = match Some(i) == model.alpha() {
                _ if value.is_nan() => 0,
                true if value < 0.0 => 0,
                true if value > 1.0 => ONE,
                false if value.is_infinite() => *bits & 0x8000 | 0x7bff,
                _ => *bits,
            };
        }
    });
    values
}
