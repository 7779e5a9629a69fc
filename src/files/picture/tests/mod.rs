//! Pictures of every kind, whole and broken.

use super::*;
use crate::base::pixels::{self, Rgba};
use image::{DynamicImage, ImageBuffer, Luma, LumaA, Rgb, Rgba as ImageRgba};

mod color;
mod exr;
mod tiff;

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

fn refusal(path: &Path, limits: &Limits) -> String {
    let said = size(path, limits).err().map(|e| e.to_string());
    let read = read(path, limits).unwrap_err().to_string();
    assert!(said.is_none_or(|said| said == read), "header and picture say the same");
    read
}

/// A PNG made of chunks, each with its length and checksum.
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
        ("rgba8.png", ImageBuffer::from_pixel(2, 1, ImageRgba([128u8, 0, 255, 128])).into(), [g8 * a8, 0.0, a8, a8]),
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
        let picture = read(&path, &Limits::default()).unwrap().picture;
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
    let mut encoder = ::png::Encoder::new(&mut bytes, 2, 1);
    encoder.set_color(::png::ColorType::Indexed);
    encoder.set_palette(vec![255, 0, 0, 0, 0, 255]);
    encoder.set_trns(vec![255, 0]);
    encoder.write_header().unwrap().write_image_data(&[0, 1]).unwrap();
    std::fs::write(&path, bytes).unwrap();
    let picture = read(&path, &Limits::default()).unwrap().picture;
    assert_eq!(picture.to_linear().cells(), [[1.0, 0.0, 0.0, 1.0], [0.0; 4]]);
}

#[test]
fn a_photograph_is_turned_upright() {
    let folder = folder();
    let path = folder.path().join("turned.png");
    // EXIF with one entry: orientation 6, the picture must be turned clockwise.
    let exif = b"MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0".to_vec();
    let mut plain = Vec::new();
    let image: DynamicImage = ImageBuffer::from_fn(3, 1, |x, _| Luma([x as u8 * 100])).into();
    image.write_to(&mut std::io::Cursor::new(&mut plain), image::ImageFormat::Png).unwrap();
    let (head, rest) = plain.split_at(33);
    std::fs::write(&path, [head, &png(&[(b"eXIf", exif)])[8..], rest].concat()).unwrap();
    assert_eq!(size(&path, &Limits::default()).unwrap(), (1, 3));
    let picture = read(&path, &Limits::default()).unwrap().picture;
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
        std::fs::write(&path, png(&[(b"IHDR", ihdr(width, height)), (b"IDAT", vec![]), (b"IEND", vec![])])).unwrap();
        let error = refusal(&path, &default);
        assert!(error.contains(part) && error.lines().count() == 1, "{error}");
    }
    std::fs::write(&path, png(&[(b"IHDR", ihdr(1000, 1000)), (b"IDAT", vec![]), (b"IEND", vec![])])).unwrap();
    for (setting, part) in [("pixels=999999", "pixels"), ("side=999", "side"), ("memory=3999999", "memory")] {
        let limits = Limits::from_settings(&[setting.into()]).unwrap();
        assert!(refusal(&path, &limits).contains(&format!("--limit {part}")));
    }
    let strip: DynamicImage = ImageBuffer::from_pixel(65535, 1, Luma([9u8])).into();
    strip.save(&path).unwrap();
    assert_eq!(read(&path, &default).unwrap().picture.width(), 65535);
}

#[test]
fn a_profile_is_not_unpacked_without_end() {
    let folder = folder();
    let path = folder.path().join("bomb.png");
    let icc = [b"x\0\0".to_vec(), deflated_zeros(8 << 20)].concat();
    write_png(&path, &[(b"iCCP", icc)]);
    for setting in ["memory=1M", "memory=16M"] {
        let limits = Limits::from_settings(&[setting.into()]).unwrap();
        let found = read(&path, &limits).unwrap();
        assert_eq!(found.picture.texel(0, 0)[0], 1.0);
        assert!(found.notes[0].contains("profile") && found.notes.len() == 1, "{:?}", found.notes);
    }
}

/// A PNG of one white pixel, with `chunks` before its pixels.
fn write_png(path: &Path, chunks: &[(&[u8; 4], Vec<u8>)]) {
    write_png_of(path, ImageBuffer::from_pixel(1, 1, Luma([255u8])).into(), chunks);
}

fn write_png_of(path: &Path, image: DynamicImage, chunks: &[(&[u8; 4], Vec<u8>)]) {
    let mut plain = Vec::new();
    image.write_to(&mut std::io::Cursor::new(&mut plain), image::ImageFormat::Png).unwrap();
    let (head, rest) = plain.split_at(33);
    std::fs::write(path, [head, &png(chunks)[8..], rest].concat()).unwrap();
}

#[test]
fn texts_take_no_memory() {
    let folder = folder();
    let path = folder.path().join("xmp.png");
    let text = [b"XML:com.adobe.xmp\0\0\0\0\0".to_vec(), vec![b'x'; 17 << 20]].concat();
    write_png(&path, &[(b"iTXt", text.clone()), (b"caBX", text)]);
    let limits = Limits::from_settings(&["memory=1M".into()]).unwrap();
    assert_eq!(read(&path, &limits).unwrap().picture.texel(0, 0)[0], 1.0);
}

/// Zeros compressed by zlib, taken from a picture of nothing but zeros.
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
        (&b""[..], "is empty (copy it again"),
        (b"hello, world", "not a picture"),
        (b"BM6\0\0\0\0\0\0\0", "cat.png"),
        (b"qoif\0\0\0\x01", "cat.png"),
        (b"P6 1", "cat.png"),
        (b"DDS ", "cat.png"),
        (b"\0\0\x01\0\x01\0", "cat.png"),
        (b"MM\0+\0\x08\0\0\0\0\0\0\0\0\0\x10", "cat.png"),
        (
            b"\0\0\0\x18ftypheic\0\0\0\0mif1heic",
            "is a HEIC picture, which Plica does not read (convert it: heif-convert",
        ),
        (b"\0\0\0\x18ftypmif1\0\0\0\0mif1avif", "avifdec"),
        (b"\xff\x0a", "djxl"),
        (b"8BPS", "cat.png[0]"),
        (b"<?xml version='1.0'?>\n<svg/>", "rsvg-convert"),
        (b"II*\0\x10\0\0\0CR\x02\0", "a raw photograph"),
        (b"%PDF-1.7", "pdftoppm"),
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

fn saved(name: &str, image: &DynamicImage) -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = folder();
    let path = folder.path().join(name);
    image.save(&path).unwrap();
    (folder, path)
}

#[test]
fn the_plain_kinds_are_read() {
    let rgb: DynamicImage = ImageBuffer::from_fn(40, 20, |x, y| Rgb([x as u8 * 6, y as u8 * 10, 7u8])).into();
    for name in ["a.bmp", "a.tga", "a.ppm", "a.qoi", "a.tiff", "a.webp", "a.png"] {
        let (_folder, path) = saved(name, &rgb);
        let picture = read(&path, &Limits::default()).unwrap().picture;
        assert_eq!(pixels::encode(picture.texel(30, 19)), [180, 190, 7, 255], "{name}");
        let whole = std::fs::read(&path).unwrap();
        for cut in [whole.len() / 4, whole.len() / 2, whole.len() - 3] {
            std::fs::write(&path, &whole[..cut]).unwrap();
            let error = read(&path, &Limits::default()).map(|found| found.notes);
            // The last bytes of a QOI and a TGA are a marker, not pixels.
            let said = error.as_ref().is_err_and(|error| error.to_string().contains("is cut short (copy it again"));
            assert!(said || cut == whole.len() - 3, "{name} cut at {cut}: {error:?}");
        }
    }
}

#[test]
fn a_cut_jpeg_is_refused() {
    let noise: DynamicImage = ImageBuffer::from_fn(64, 64, |x, y| Luma([(x * y * 7) as u8])).into();
    let (_folder, path) = saved("a.jpg", &noise);
    let whole = std::fs::read(&path).unwrap();
    // What a camera appends does not matter, nor does a thumbnail with an end of its own.
    let thumbnail = [b"\xff\xd8\xff\xe1\0\x0eExif\0\0\xff\xd8\xff\xd9\0\0".as_slice(), &whole[2..]].concat();
    for good in [whole.clone(), [&whole[..], b"junk"].concat(), thumbnail.clone()] {
        std::fs::write(&path, good).unwrap();
        assert_eq!(read(&path, &Limits::default()).unwrap().picture.width(), 64);
    }
    for bad in [&whole[..whole.len() - 2], &whole[..whole.len() * 2 / 3], &whole[..200], &thumbnail[..400]] {
        std::fs::write(&path, bad).unwrap();
        let error = refusal(&path, &Limits::default());
        assert!(error.contains("is cut short"), "{error}");
    }
}

#[test]
fn what_is_not_read_of_a_kind_is_called_by_its_name() {
    let folder = folder();
    let dds = |form: &[u8; 4], size: [u32; 2]| {
        let mut head = vec![0; 160];
        head[..4].copy_from_slice(b"DDS ");
        head[12..16].copy_from_slice(&size[1].to_le_bytes());
        head[16..20].copy_from_slice(&size[0].to_le_bytes());
        head[84..88].copy_from_slice(form);
        head
    };
    let jpeg = |marker: u8| [&[0xff, 0xd8, 0xff, marker, 0, 11, 8, 0, 1, 0, 1, 1, 1, 0x11, 0, 0xff, 0xd9][..]].concat();
    for (name, bytes, wanted) in [
        ("odd.dds", dds(b"DXT1", [61, 47]), "a DDS of 61 x 47, whose sides are no multiples of 4 (convert it: magick"),
        ("plain.dds", dds(&[0; 4], [64, 48]), "a DDS that is not compressed as DXT1, DXT3 or DXT5 (convert it: magick"),
        ("cut.dds", dds(b"DXT1", [64, 48])[..60].to_vec(), "is cut short (copy it again"),
        ("a.jls", jpeg(0xf7), "a JPEG-LS picture (convert it: magick"),
        ("a.jpg", jpeg(0xc3), "a lossless JPEG (convert it: magick"),
        ("b.jpg", jpeg(0xc9), "a JPEG with arithmetic coding (convert it: magick"),
        ("cut.pam", b"P7\nWIDTH 4\nTU".to_vec(), "is cut short (copy it again"),
        ("cut.pnm", b"P3 2 2 255 1 2 3 4 5".to_vec(), "is cut short (copy it again"),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        let error = refusal(&path, &Limits::default());
        assert!(error.contains(wanted), "{error}");
    }
}

#[test]
fn png_says_its_color_in_four_ways() {
    let folder = folder();
    let path = folder.path().join("a.png");
    let number = |v: u32| v.to_be_bytes().to_vec();
    let p3 = [31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000].into_iter().flat_map(number).collect::<Vec<_>>();
    let srgb = [31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000].into_iter().flat_map(number).collect::<Vec<_>>();
    // (200, 60, 60) in Display P3 is (217, 42, 52) in sRGB; a gamma of 1 turns 46 into 118.
    let (plain, wide) = ([200, 60, 60], [217, 42, 52]);
    type Case<'a> = (&'a [(&'a [u8; 4], Vec<u8>)], [u8; 3]);
    let cases: [Case; 9] = [
        (&[], plain),
        (&[(b"sRGB", vec![0])], plain),
        (&[(b"gAMA", number(45455)), (b"cHRM", srgb.clone())], plain),
        (&[(b"cICP", vec![12, 13, 0, 1])], wide),
        (&[(b"cICP", vec![1, 13, 0, 1]), (b"cHRM", p3.clone())], plain),
        (&[(b"cHRM", p3.clone())], wide),
        (&[(b"gAMA", number(45455)), (b"cHRM", p3.clone())], wide),
        (&[(b"sRGB", vec![0]), (b"cHRM", p3)], plain),
        (&[(b"gAMA", number(100_000))], [228, 132, 132]),
    ];
    for (chunks, expected) in cases {
        write_png_of(&path, ImageBuffer::from_pixel(1, 1, Rgb([200u8, 60, 60])).into(), chunks);
        let found = read(&path, &Limits::default()).unwrap();
        let [r, g, b, _] = pixels::encode(found.picture.texel(0, 0));
        let names: Vec<_> = chunks.iter().map(|(name, _)| String::from_utf8_lossy(*name)).collect();
        assert!([r, g, b].iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 1), "{names:?}: {r} {g} {b}");
        assert!(found.notes.is_empty());
    }
    write_png(&path, &[(b"cICP", vec![2, 2, 0, 1])]);
    assert!(read(&path, &Limits::default()).unwrap().notes[0].contains("cICP"));
}
