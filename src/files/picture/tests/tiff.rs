//! TIFFs, written here value by value, because our encoders cannot write most of them.

use super::*;

/// An entry: its tag, the type of its values (1: bytes, 3: 16 bits, 4: 32 bits), and the values.
type Entry = (u16, u16, Vec<u32>);

/// A little-endian TIFF of pages, each with entries and the bytes of a single strip.
fn tiff(pages: &[(Vec<Entry>, Vec<u8>)]) -> Vec<u8> {
    let mut file = b"II*\0\0\0\0\0".to_vec();
    let mut link = 4;
    for (entries, pixels) in pages {
        let strip = file.len() as u32;
        file.extend(pixels);
        let mut entries = entries.clone();
        entries.extend([(273, 4, vec![strip]), (279, 4, vec![pixels.len() as u32])]);
        entries.sort();
        let bytes_of = |(_, kind, values): &Entry| -> Vec<u8> {
            let size = [1, 0, 2, 4, 8, 1, 1][usize::from(*kind) - 1];
            values.iter().flat_map(|value| value.to_le_bytes()[..size].to_vec()).collect()
        };
        let mut rows = Vec::new();
        for entry in &entries {
            let mut bytes = bytes_of(entry);
            if bytes.len() > 4 {
                let at = file.len() as u32;
                file.extend(&bytes);
                bytes = at.to_le_bytes().to_vec();
            }
            bytes.resize(4, 0);
            rows.push(
                [&entry.0.to_le_bytes()[..], &entry.1.to_le_bytes(), &(entry.2.len() as u32).to_le_bytes(), &bytes]
                    .concat(),
            );
        }
        let at = file.len() as u32;
        file[link..link + 4].copy_from_slice(&at.to_le_bytes());
        file.extend((rows.len() as u16).to_le_bytes());
        file.extend(rows.concat());
        link = file.len();
        file.extend([0; 4]);
    }
    file
}

/// The entries that every page needs: size, bits of every sample, photometric, no compression.
fn page(size: (u32, u32), bits: &[u32], photometric: u32) -> Vec<Entry> {
    vec![
        (256, 4, vec![size.0]),
        (257, 4, vec![size.1]),
        (258, 3, bits.to_vec()),
        (259, 3, vec![1]),
        (262, 3, vec![photometric]),
        (277, 3, vec![bits.len() as u32]),
        (278, 4, vec![size.1]),
    ]
}

fn read_bytes(bytes: &[u8]) -> Result<Loaded> {
    let folder = folder();
    let path = folder.path().join("a.tif");
    std::fs::write(&path, bytes).unwrap();
    let header = size(&path, &Limits::default());
    let found = read(&path, &Limits::default());
    if let (Ok(header), Ok(found)) = (header, &found) {
        assert_eq!(header, (found.picture.width(), found.picture.height()));
    }
    found
}

#[test]
fn samples_of_every_kind_are_read() {
    let grey = |bits: u32, format: u32| {
        let mut entries = page((2, 1), &[bits], 1);
        entries.push((339, 3, vec![format]));
        entries
    };
    let rgba = |bits: u32, extra: u32| {
        let mut entries = page((1, 1), &[bits; 4], 2);
        entries.push((338, 3, vec![extra]));
        entries
    };
    let palette = |bits: u32, colors: usize| {
        let mut entries = page((2, 1), &[bits], 3);
        let ramp = (0..3).flat_map(|c| (0..colors).map(move |i| ((i * 10 + c * 20) * 257) as u32));
        entries.push((320, 3, ramp.collect()));
        entries
    };
    let lin = |code: f64| pixels::linear_from_srgb(code / 255.0) as f32;
    let grey_of = |g: f32| [g, g, g, 1.0];
    let third = |i: f64| [lin(i * 10.0), lin(i * 10.0 + 20.0), lin(i * 10.0 + 40.0), 1.0];
    let half = 128.0f32 / 255.0;
    let cases: Vec<(&str, Vec<Entry>, Vec<u8>, Rgba)> = vec![
        ("8-bit palette", palette(8, 256), vec![3, 9], third(3.0)),
        ("4-bit palette", palette(4, 16), vec![0x39], third(3.0)),
        ("4-bit grey", page((2, 1), &[4], 1), vec![0x80], grey_of(lin(136.0))),
        ("float grey", grey(32, 3), [0.25f32, 2.0].iter().flat_map(|v| v.to_le_bytes()).collect(), grey_of(0.25)),
        ("half grey", grey(16, 3), vec![0, 0x38, 0, 0], grey_of(0.5)),
        (
            "32-bit grey",
            grey(32, 1),
            [0x8080_8080u32, 0].iter().flat_map(|v| v.to_le_bytes()).collect(),
            grey_of(lin(128.0)),
        ),
        ("premultiplied", rgba(8, 1), vec![68, 34, 128, 128], [lin(135.0) * half, lin(68.0) * half, half, half]),
        ("straight", rgba(8, 2), vec![136, 0, 255, 128], [lin(136.0) * half, 0.0, half, half]),
        (
            "grey and alpha",
            {
                let mut e = page((1, 1), &[8, 8], 1);
                e.push((338, 3, vec![2]));
                e
            },
            vec![255, 128],
            [half; 4],
        ),
        ("Lab", page((1, 1), &[8; 3], 8), vec![255, 0, 0], grey_of(1.0)),
        ("ICC Lab", page((1, 1), &[8; 3], 9), vec![255, 128, 128], grey_of(1.0)),
        ("CMYK", page((1, 1), &[8; 4], 5), vec![0, 255, 255, 0], [1.0, 0.0, 0.0, 1.0]),
    ];
    for (name, entries, pixels, expected) in cases {
        let found = read_bytes(&tiff(&[(entries, pixels)])).unwrap_or_else(|error| panic!("{name}: {error}"));
        let texel = found.picture.texel(0, 0);
        assert!(texel.iter().zip(expected).all(|(a, b)| (a - b).abs() < 2e-3), "{name}: {texel:?} for {expected:?}");
    }
}

#[test]
fn a_profile_is_larger_than_its_picture() {
    let mut entries = page((1, 1), &[8], 1);
    entries.push((34675, 7, vec![9; 200_000]));
    let found = read_bytes(&tiff(&[(entries, vec![255])])).unwrap();
    assert!(found.notes[0].contains("profile is broken"), "{:?}", found.notes);
}

#[test]
fn a_thumbnail_is_not_the_picture() {
    let mut small = page((1, 1), &[8], 1);
    small.push((254, 4, vec![1]));
    let large = (page((2, 1), &[8], 1), vec![7, 255]);
    let found = read_bytes(&tiff(&[(small.clone(), vec![9]), large])).unwrap();
    assert_eq!((found.picture.width(), pixels::encode(found.picture.texel(1, 0))[0]), (2, 255));
    // If it is the only page, it is read.
    assert_eq!(read_bytes(&tiff(&[(small.clone(), vec![9])])).unwrap().picture.width(), 1);
    let mosaic = (page((4, 4), &[16], 32803), vec![0; 32]);
    let mut dng = small.clone();
    dng.push((50706, 1, vec![1, 4, 0, 0]));
    for raw in [tiff(&[(small, vec![9]), mosaic]), tiff(&[(dng, vec![9])])] {
        let error = read_bytes(&raw).unwrap_err().to_string();
        assert!(error.contains("is a raw photograph") && error.contains("darktable-cli"), "{error}");
    }
}

#[test]
fn what_is_wrong_with_a_tiff_is_told_truly() {
    let whole = tiff(&[(page((8, 8), &[8], 1), vec![5; 64])]);
    let odd = tiff(&[(page((1, 1), &[8; 3], 10), vec![1, 2, 3])]);
    for bits in [3, 10, 12, 24] {
        let odd = tiff(&[(page((8, 1), &[bits; 3], 2), vec![1; 96])]);
        let error = read_bytes(&odd).unwrap_err().to_string();
        assert!(error.contains(&format!("a TIFF of {bits} bits a sample (convert it: magick")), "{error}");
    }
    let error = read_bytes(&odd).unwrap_err().to_string();
    assert!(error.contains("in a form that Plica does not read") && error.contains("magick"), "{error}");
    // With any byte changed, there is a message or a picture, and no panic.
    for at in 0..whole.len() {
        for byte in [0, 1, 0x7f, 0xff] {
            let mut bytes = whole.clone();
            bytes[at] = byte;
            if let Err(error) = read_bytes(&bytes) {
                assert_eq!(error.to_string().lines().count(), 1, "{error}");
            }
        }
    }
    for cut in [4, 8, 40, whole.len() - 3] {
        assert!(read_bytes(&whole[..cut]).is_err(), "cut at {cut}");
    }
}

/// Bytes as deflate stores them uncompressed, with the head and the sum of zlib.
fn stored(bytes: &[u8]) -> Vec<u8> {
    let length = bytes.len() as u16;
    let (a, b) = bytes.iter().fold((1u32, 0u32), |(a, b), &byte| {
        let a = (a + u32::from(byte)) % 65521;
        (a, (b + a) % 65521)
    });
    [&[0x78, 1, 1][..], &length.to_le_bytes(), &(!length).to_le_bytes(), bytes, &(b << 16 | a).to_be_bytes()].concat()
}

/// Bytes as LZW has them where it has learnt nothing: codes of 9 bits, forgotten before they would be longer.
fn lzw(bytes: &[u8]) -> Vec<u8> {
    let codes = bytes.chunks(200).flat_map(|part| std::iter::once(256).chain(part.iter().map(|&b| u32::from(b))));
    let bits: Vec<u32> = codes.chain([257]).flat_map(|code| (0..9).rev().map(move |bit| code >> bit & 1)).collect();
    bits.chunks(8).map(|byte| byte.iter().enumerate().fold(0, |sum, (i, bit)| sum | (*bit as u8) << (7 - i))).collect()
}

/// Rows of samples as differences from the pixel before (predictor 2).
fn differences(samples: &[u32], row: usize, count: usize) -> Vec<u32> {
    let before = |i: usize| if i % row < count { 0 } else { samples[i - count] };
    (0..samples.len()).map(|i| samples[i].wrapping_sub(before(i))).collect()
}

/// Floats with their bytes set apart in each row, and those as differences (predictor 3).
fn apart(samples: &[u32], row: usize, count: usize) -> Vec<u8> {
    let of_row = |samples: &[u32]| {
        let bytes: Vec<u32> = (0..4).flat_map(|b| samples.iter().map(move |v| u32::from(v.to_be_bytes()[b]))).collect();
        differences(&bytes, bytes.len(), count).iter().map(|&v| v as u8).collect::<Vec<_>>()
    };
    samples.chunks(row).flat_map(of_row).collect()
}

/// Photometric, extra samples; the samples that are used, and the extra samples of a file that has no others.
const KINDS: [(u32, &[u32], &[usize], &[u32]); 11] = [
    (2, &[0], &[0, 1, 2], &[]),
    (2, &[0, 0], &[0, 1, 2], &[]),
    (2, &[2], &[0, 1, 2, 3], &[2]),
    (2, &[2, 0], &[0, 1, 2, 3], &[2]),
    (2, &[0, 2], &[0, 1, 2, 4], &[2]),
    (2, &[1, 0, 0], &[0, 1, 2, 3], &[1]),
    (1, &[0], &[0], &[]),
    (1, &[0, 2], &[0, 2], &[2]),
    (5, &[0], &[0, 1, 2, 3], &[]),
    (8, &[0], &[0, 1, 2], &[]),
    (9, &[0, 0], &[0, 1, 2], &[]),
];

#[test]
fn extra_samples_are_left_out_after_differences_are_added_up() {
    const SIZE: (u32, u32) = (5, 3);
    for (photometric, extra, used, kept) in KINDS {
        let count = used.len() - kept.len() + extra.len();
        let row = SIZE.0 as usize * count;
        for (bits, compression, predictor) in
            [(8, 1, 1), (8, 8, 1), (8, 8, 2), (8, 5, 2), (16, 8, 2), (16, 5, 2), (16, 1, 1), (32, 8, 3), (32, 8, 2)]
        {
            let is_float = predictor == 3;
            if bits == 32 && photometric != 2 {
                continue;
            }
            let code = |i: usize| ((i * 2_654_435_761 + 77) >> 7) as u32 & (u32::MAX >> (32 - bits));
            let sample = |i: usize| if is_float { (i as f32 / 7.0).to_bits() } else { code(i) };
            let samples: Vec<u32> = (0..row * SIZE.1 as usize).map(sample).collect();
            let bytes = |all: &[u32]| all.iter().flat_map(|v| v.to_le_bytes()[..bits as usize / 8].to_vec()).collect();
            let entries = |count: usize, extra: &[u32]| {
                let mut entries = page(SIZE, &vec![bits; count], photometric);
                if !extra.is_empty() {
                    entries.push((338, 3, extra.to_vec()));
                }
                entries.push((339, 3, vec![if is_float { 3 } else { 1 }; count]));
                entries
            };
            let plain = samples.chunks(count).flat_map(|cell| used.iter().map(|&i| cell[i])).collect::<Vec<_>>();
            let plain = tiff(&[(entries(used.len(), kept), bytes(&plain))]);
            let mut with = entries(count, extra);
            with[3].2 = vec![compression];
            with.push((317, 3, vec![predictor]));
            let bytes: Vec<u8> = match predictor {
                1 => bytes(&samples),
                2 => bytes(&differences(&samples, row, count)),
                _ => apart(&samples, row, count),
            };
            let bytes = match compression {
                8 => stored(&bytes),
                5 => lzw(&bytes),
                _ => bytes,
            };
            let what =
                format!("{photometric} with {extra:?}, {bits} bits, compression {compression}, predictor {predictor}");
            let (found, plain) = (read_bytes(&tiff(&[(with, bytes)])), read_bytes(&plain).unwrap().picture);
            let found = found.unwrap_or_else(|error| panic!("{what}: {error}")).picture;
            for (x, y) in (0..SIZE.1 as usize).flat_map(|y| (0..SIZE.0 as usize).map(move |x| (x, y))) {
                assert_eq!(found.texel(x, y), plain.texel(x, y), "{what} at {x}, {y}");
            }
        }
    }
}
