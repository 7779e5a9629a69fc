//! Which kind of picture a file is, by its first bytes; and for the kinds that Plica does not read, the command that
//! converts them to one that it does. File names are used only where there is nothing else to go by (TGA).

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};

use image::ImageFormat;

use crate::base::error::{Error, Result};

/// How many first bytes are looked at.
pub(in crate::files) const LOOKED_AT: u64 = 512;

/// A kind that is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Png,
    Jpeg,
    Tiff,
    Exr,
    /// A kind that the image crate reads completely by itself.
    Plain(ImageFormat),
}

/// The first bytes of the kinds that are read, and what each is.
const KINDS: &[(&[u8], Kind, &str)] = &[
    (b"\x89PNG\r\n\x1a\n", Kind::Png, "a PNG picture"),
    (b"\xff\xd8\xff", Kind::Jpeg, "a JPEG picture"),
    (b"II*\0", Kind::Tiff, "a TIFF picture"),
    (b"MM\0*", Kind::Tiff, "a TIFF picture"),
    (b"II+\0", Kind::Tiff, "a TIFF picture"),
    (b"MM\0+", Kind::Tiff, "a TIFF picture"),
    (b"\x76\x2f\x31\x01", Kind::Exr, "an OpenEXR picture"),
    (b"GIF87a", Kind::Plain(ImageFormat::Gif), "a GIF picture"),
    (b"GIF89a", Kind::Plain(ImageFormat::Gif), "a GIF picture"),
    (b"#?RADIANCE", Kind::Plain(ImageFormat::Hdr), "a Radiance HDR picture"),
    (b"#?RGBE", Kind::Plain(ImageFormat::Hdr), "a Radiance HDR picture"),
    (b"BM", Kind::Plain(ImageFormat::Bmp), "a BMP picture"),
    (b"qoif", Kind::Plain(ImageFormat::Qoi), "a QOI picture"),
    (b"DDS ", Kind::Plain(ImageFormat::Dds), "a DDS picture"),
    (b"\0\0\x01\0", Kind::Plain(ImageFormat::Ico), "an icon of Windows"),
];

const READ: &str = "Plica reads PNG, JPEG, TIFF, WebP, GIF, OpenEXR, Radiance HDR, BMP, TGA, PNM, QOI, DDS and ICO";

/// What is said of a file that tells nothing else of itself.
pub(in crate::files) const UNKNOWN: &str = "is not a picture of a known kind";

/// A kind that is not read: its name, and the command that converts `IN` to `OUT` (with an extension).
struct Foreign {
    name: &'static str,
    command: &'static str,
}

const fn foreign(name: &'static str, command: &'static str) -> Foreign {
    Foreign { name, command }
}

const HEIC: Foreign = foreign("a HEIC picture", "heif-convert IN OUT.png");
const AVIF: Foreign = foreign("an AVIF picture", "avifdec IN OUT.png");
const JXL: Foreign = foreign("a JPEG XL picture", "djxl IN OUT.png");
const JP2: Foreign = foreign("a JPEG 2000 picture", "opj_decompress -i IN -o OUT.png");
const PSD: Foreign = foreign("a Photoshop document", "magick IN[0] OUT.png");
const SVG: Foreign = foreign("an SVG drawing", "rsvg-convert IN -o OUT.png");
const RAW: Foreign = foreign("a raw photograph", "darktable-cli IN OUT.tif");
const FILM: Foreign = foreign("a film", "ffmpeg -i IN -frames:v 1 OUT.png");
const LAYERED: Foreign = foreign("a picture with layers", "magick IN -flatten OUT.png");

/// The bytes, at an offset, of the kinds that are not read.
const FOREIGN: &[(usize, &[u8], Foreign)] = &[
    (0, b"\xff\x0a", JXL),
    (0, b"\0\0\0\x0cJXL ", JXL),
    (0, b"\0\0\0\x0cjP  ", JP2),
    (0, b"\xff\x4f\xff\x51", JP2),
    (0, b"8BPS", PSD),
    (0, b"gimp xcf", LAYERED),
    (38, b"image/openraster", LAYERED),
    (38, b"application/x-krita", LAYERED),
    (8, b"CR\x02", RAW),
    (0, b"FUJIFILMCCD-RAW", RAW),
    (0, b"IIRO", RAW),
    (0, b"IIRS", RAW),
    (0, b"MMOR", RAW),
    (0, b"IIU\0", RAW),
    (0, b"FOVb", RAW),
    (0, b"\0MRM", RAW),
    (0, b"%PDF", foreign("a PDF document", "pdftoppm -png -singlefile IN OUT")),
    (0, b"%!PS", foreign("a PostScript document", "gs -dBATCH -dNOPAUSE -sDEVICE=png16m -o OUT.png IN")),
    (0, b"\x1a\x45\xdf\xa3", FILM),
    (0, b"SIMPLE  =", foreign("a FITS picture", "magick IN OUT.png")),
    (0, b"farbfeld", foreign("a farbfeld picture", "magick IN OUT.png")),
    (0, b"icns", foreign("an icon of macOS", "magick IN OUT.png")),
    (0, b"FLIF", foreign("a FLIF picture", "flif -d IN OUT.png")),
    (0, b"AT&TFORM", foreign("a DjVu document", "ddjvu -format=tiff -page=1 IN OUT.tif")),
];

/// Brands of the ISO container (`ftyp`), by their first bytes.
const BRANDS: &[(&[u8], Foreign)] =
    &[(b"avi", AVIF), (b"he", HEIC), (b"mif1", HEIC), (b"msf1", HEIC), (b"crx ", RAW), (b"jp2", JP2), (b"", FILM)];

/// The kind of the file that begins with `start`.
pub(super) fn kind(start: &[u8], file: &mut File, place: &str) -> Result<Kind> {
    if start.is_empty() {
        return Err(Error::at(place, "is empty").cure("copy it again from where it came, or export it again"));
    }
    if let Some(found) = unread(start) {
        return Err(convert(place, found));
    }
    if let Some((kind, _)) = read(start) {
        return Ok(kind);
    }
    if is_tga(start, file, place) {
        return Ok(Kind::Plain(ImageFormat::Tga));
    }
    Err(Error::at(place, UNKNOWN).cure(READ))
}

/// What a picture is that begins with `start`, as "a PNG picture".
pub(in crate::files) fn name(start: &[u8]) -> Option<&'static str> {
    unread(start).map(|found| found.name).or_else(|| read(start).map(|(_, name)| name))
}

/// What a picture is that begins with `start`, if no film is a file of that kind: an animation is one.
pub(in crate::files) fn still(start: &[u8]) -> Option<&'static str> {
    let (kind, name) = read(start)?;
    let is_animated = match kind {
        Kind::Png => start.windows(4).any(|four| four == b"acTL"),
        // Streams of MPEG-4 begin as an icon does.
        Kind::Plain(format) => matches!(format, ImageFormat::Gif | ImageFormat::Ico),
        Kind::Jpeg | Kind::Tiff | Kind::Exr => false,
    };
    (!is_animated).then_some(name)
}

/// The kind that begins with `start`, if it is not read.
fn unread(start: &[u8]) -> Option<&'static Foreign> {
    let begins = |(at, magic, _): &&(usize, &[u8], Foreign)| start.get(*at..).is_some_and(|s| s.starts_with(magic));
    match FOREIGN.iter().find(begins) {
        Some((.., found)) => Some(found),
        None if start.get(4..8) == Some(b"ftyp") => Some(brand(start)),
        None => is_svg(start).then_some(&SVG),
    }
}

/// The kind that begins with `start`, if it is read, and what it is.
fn read(start: &[u8]) -> Option<(Kind, &'static str)> {
    if let Some((_, kind, name)) = KINDS.iter().find(|(magic, ..)| start.starts_with(magic)) {
        return Some((*kind, name));
    }
    if start.starts_with(b"RIFF") && start.get(8..12) == Some(b"WEBP") {
        return Some((Kind::Plain(ImageFormat::WebP), "a WebP picture"));
    }
    match start {
        [b'P', b'1'..=b'7', space, ..] if space.is_ascii_whitespace() => {
            Some((Kind::Plain(ImageFormat::Pnm), "a PNM picture"))
        }
        _ => None,
    }
}

/// The kind that the first known brand names; brands of AVIF take precedence over those of HEIF.
fn brand(start: &[u8]) -> &'static Foreign {
    let length = start.first_chunk::<4>().map_or(0, |bytes| u32::from_be_bytes(*bytes) as usize);
    let brands = start.get(8..length.min(start.len())).unwrap_or_default();
    let known = |brand: &[u8]| BRANDS.iter().find(|(begins, _)| brand.starts_with(begins)).map(|(_, found)| found);
    let all: Vec<&Foreign> = brands.chunks_exact(4).filter_map(known).collect();
    let first = all.first().copied().unwrap_or(&FILM);
    let named = all.iter().find(|found| found.name == AVIF.name && first.name == HEIC.name);
    named.copied().unwrap_or(first)
}

fn is_svg(start: &[u8]) -> bool {
    let text = String::from_utf8_lossy(start);
    let text = text.trim_start_matches('\u{feff}').trim_start();
    text.starts_with("<svg") || text.starts_with("<?xml") && text.contains("<svg") || text.starts_with("<!DOCTYPE svg")
}

/// Whether it is a TGA, which has no magic bytes: newer files have a footer, older ones only their name.
fn is_tga(start: &[u8], file: &mut File, place: &str) -> bool {
    let mut footer = [0; 18];
    let at_end = file.seek(SeekFrom::End(-18)).and_then(|_| file.read_exact(&mut footer)).is_ok();
    let plausible = matches!(start, [_, 0 | 1, 1 | 2 | 3 | 9 | 10 | 11, ..]);
    let named = place.to_ascii_lowercase().ends_with(".tga");
    plausible && (named || at_end && footer == *b"TRUEVISION-XFILE.\0")
}

fn convert(place: &str, Foreign { name, command }: &Foreign) -> Error {
    let command = self::command(command, place);
    Error::at(place, format!("is {name}, which Plica does not read")).cure(format!("convert it: {command}"))
}

/// A command for a shell: `IN` stands for the file, `OUT` for its name without an extension.
pub(in crate::files) fn command(command: &str, place: &str) -> String {
    let stem = place.rsplit_once('.').map_or(place, |(stem, end)| if end.contains('/') { place } else { stem });
    command.split(' ').map(|word| word_of(word, place, stem)).collect::<Vec<_>>().join(" ")
}

fn word_of(word: &str, place: &str, stem: &str) -> String {
    match word.strip_prefix("IN").map(|rest| (place, rest)).or_else(|| word.strip_prefix("OUT").map(|r| (stem, r))) {
        Some((name, rest)) => quoted(&format!("{name}{rest}")),
        None => word.to_owned(),
    }
}

/// Quoted so that a shell takes it as one word.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "/._-+,=@%".contains(c);
    if word.chars().all(plain) { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}

/// The error for a raw photograph in a TIFF.
pub(super) fn raw(place: &str) -> Error {
    convert(place, &RAW)
}

/// The error for a picture of a known kind in a form that is not read.
pub(super) fn other_kind(place: &str, what: impl std::fmt::Display) -> Error {
    let cure = format!("convert it: {}", command("magick IN OUT.png", place));
    Error::at(place, format!("is a picture in a form that Plica does not read: {what}")).cure(cure)
}
