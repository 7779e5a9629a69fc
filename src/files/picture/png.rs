//! PNG: its chunks are walked first. Texts, thumbnails and other chunks that do not affect pixels never reach the
//! decoder, so that they take no memory; a file without its last chunk is truncated. Color chunks take precedence in
//! the order of the PNG specification: cICP, iCCP, sRGB, then gAMA with cHRM.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};

use image::ImageFormat;

use super::conversion::{Spoken, Transfer};
use super::decoded::{Color, Decoded, Model, Raw, Undecoded};
use super::{limits, plain};
use crate::base::error::{Error, Result};
use crate::files::Limits;

/// Chunks that affect pixels or their orientation.
const KEPT: [&[u8; 4]; 7] = [b"IHDR", b"PLTE", b"tRNS", b"IDAT", b"IEND", b"iCCP", b"eXIf"];

/// Color chunks that are read here, and their largest sizes in bytes.
const READ: [(&[u8; 4], u32); 4] = [(b"cICP", 4), (b"sRGB", 1), (b"gAMA", 4), (b"cHRM", 32)];

/// No camera writes larger EXIF data; larger chunks are dropped.
const MOST_EXIF: u32 = 1 << 20;

/// Reads the header.
pub(super) fn open(file: File, place: &str, limits: &Limits) -> Result<Undecoded> {
    let chunks = Chunks::of(file).map_err(|error| limits::reading(place, &error))?;
    let (said, has_profile, whole) = (chunks.said.clone(), chunks.has_profile, chunks.whole);
    let opened = plain::open(BufReader::new(chunks), ImageFormat::Png, place, limits)?;
    if !whole {
        return Err(limits::cut_short(place));
    }
    let decode = Box::new(move || {
        let decoded = (opened.decode)()?;
        Ok(colored(decoded, said, has_profile))
    });
    Ok(Undecoded { decode, ..opened })
}

/// The samples of a PNG with red, green and blue of 16 bits each, as KITTI stores vectors; `allow` is asked first for
/// the bytes that this takes.
pub(in crate::files) fn words(
    file: File,
    place: &str,
    limits: &Limits,
    allow: impl FnOnce(u64) -> Result<()>,
) -> Result<((usize, usize), Vec<[u16; 3]>)> {
    let opened = open(file, place, limits)?;
    allow(opened.bytes)?;
    let decoded = (opened.decode)()?;
    match (decoded.model, decoded.samples) {
        (Model::Rgb, Raw::Words(words)) => Ok((decoded.size, words.as_chunks::<3>().0.to_vec())),
        _ => Err(Error::at(place, "is a picture, not a vector field")
            .cure("a KITTI PNG has red, green and blue with 16 bits each")),
    }
}

/// Sets the color of the picture from the chunks, by precedence.
fn colored(mut decoded: Decoded, said: Said, has_profile: bool) -> Decoded {
    if let Some([primaries, transfer, matrix, full]) = said.cicp {
        match Spoken::of_cicp(primaries, transfer, matrix, full == 1) {
            Some(spoken) => {
                decoded.color = Color::Spoken(spoken);
                return decoded;
            }
            None => decoded.notes.push(format!(
                "its color ({primaries}/{transfer}/{matrix} in its cICP chunk) is not known and was not applied"
            )),
        }
    }
    if has_profile && decoded.color == Color::Untagged {
        decoded.notes.push("its color profile is broken or too large, and was not applied".to_owned());
    }
    if has_profile || said.srgb {
        return decoded;
    }
    decoded.color = match (said.gamma, said.primaries) {
        (None, None) => Color::Untagged,
        (gamma, primaries) => {
            let transfer = gamma.map_or(Transfer::Srgb, Transfer::of_png_gamma);
            Color::Spoken(Spoken { transfer, primaries, narrow: false })
        }
    };
    decoded
}

/// What the chunks say about color, besides a profile.
#[derive(Clone, Debug, Default)]
struct Said {
    cicp: Option<[u8; 4]>,
    srgb: bool,
    /// 100000 / gamma.
    gamma: Option<u32>,
    /// x and y of white, red, green and blue.
    primaries: Option<[[f64; 2]; 4]>,
}

impl Said {
    fn chunk(&mut self, kind: &[u8; 4], data: &[u8]) {
        let number = |bytes: &[u8; 4]| u32::from_be_bytes(*bytes);
        match (kind, data) {
            (b"cICP", &[a, b, c, d]) => self.cicp = Some([a, b, c, d]),
            (b"sRGB", _) => self.srgb = true,
            (b"gAMA", data) => self.gamma = data.first_chunk().map(number).filter(|&gamma| gamma > 0),
            (b"cHRM", data) => {
                let numbers: Vec<f64> = data.as_chunks().0.iter().map(|c| f64::from(number(c)) / 100_000.0).collect();
                let pairs = numbers.as_chunks::<2>().0;
                self.primaries = pairs.try_into().ok().filter(|all: &[[f64; 2]; 4]| all.iter().all(|p| p[1] > 0.0));
            }
            _ => {}
        }
    }
}

/// The file without the chunks that the pixels do not need.
struct Chunks {
    file: File,
    /// Each kept part: its offset for the reader, its offset in the file, its length.
    parts: Vec<(u64, u64, u64)>,
    at: u64,
    said: Said,
    has_profile: bool,
    /// Whether the last chunk was found.
    whole: bool,
}

impl Chunks {
    fn of(file: File) -> io::Result<Chunks> {
        let length = file.metadata()?.len();
        let mut chunks =
            Chunks { file, parts: vec![(0, 0, 8)], at: 0, said: Said::default(), has_profile: false, whole: false };
        let (mut from, mut pixels) = (8, false);
        while from + 12 <= length && !chunks.whole {
            let mut head = [0; 8];
            chunks.file.seek(SeekFrom::Start(from))?;
            chunks.file.read_exact(&mut head)?;
            let [a, b, c, d, kind @ ..] = head;
            let size = u32::from_be_bytes([a, b, c, d]);
            let end = from + 12 + u64::from(size);
            if end > length {
                break;
            }
            pixels |= &kind == b"IDAT";
            if !pixels && READ.iter().any(|(name, most)| **name == kind && size <= *most) {
                let mut data = vec![0; size as usize];
                chunks.file.read_exact(&mut data)?;
                chunks.said.chunk(&kind, &data);
            }
            chunks.has_profile |= &kind == b"iCCP";
            chunks.whole = &kind == b"IEND";
            let known = KEPT.contains(&&kind) && (&kind != b"eXIf" || size <= MOST_EXIF);
            // Unknown critical chunks are for the decoder to refuse.
            if known || kind[0].is_ascii_uppercase() {
                chunks.keep(from, end - from);
            }
            from = end;
        }
        Ok(chunks)
    }

    fn keep(&mut self, from: u64, length: u64) {
        let end = self.length();
        match self.parts.last_mut() {
            Some((_, start, size)) if *start + *size == from => *size += length,
            _ => self.parts.push((end, from, length)),
        }
    }

    fn length(&self) -> u64 {
        self.parts.last().map_or(0, |(begins, _, length)| begins + length)
    }
}

impl Read for Chunks {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let part = self.parts.partition_point(|(begins, ..)| *begins <= self.at).saturating_sub(1);
        let (begins, start, length) = self.parts[part];
        let within = self.at - begins;
        if within >= length {
            return Ok(0);
        }
        let most = usize::try_from(length - within).unwrap_or(usize::MAX).min(buffer.len());
        self.file.seek(SeekFrom::Start(start + within))?;
        let read = self.file.read(&mut buffer[..most])?;
        self.at += read as u64;
        Ok(read)
    }
}

impl Seek for Chunks {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let at = match to {
            SeekFrom::Start(at) => Some(at),
            SeekFrom::Current(by) => self.at.checked_add_signed(by),
            SeekFrom::End(by) => self.length().checked_add_signed(by),
        };
        self.at = at.ok_or_else(|| io::Error::from(io::ErrorKind::InvalidInput))?;
        Ok(self.at)
    }
}
