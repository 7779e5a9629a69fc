//! Profiles, written here tag by tag, against the results of Little CMS.

use super::super::decoded::{Color, Decoded, Model, Raw};
use super::super::icc::understand;
use super::*;

fn fixed(value: f64) -> [u8; 4] {
    ((value * 65536.0).round() as i32).to_be_bytes()
}

fn xyz(values: [f64; 3]) -> Vec<u8> {
    [b"XYZ \0\0\0\0".to_vec(), values.map(fixed).concat()].concat()
}

fn gamma(value: f64) -> Vec<u8> {
    [b"curv\0\0\0\0\0\0\0\x01".to_vec(), ((value * 256.0).round() as u16).to_be_bytes().to_vec(), vec![0; 2]].concat()
}

/// The curve of sRGB, as in version 4.
fn parametric() -> Vec<u8> {
    let numbers = [2.4, 1.0 / 1.055, 0.055 / 1.055, 1.0 / 12.92, 0.04045].map(fixed).concat();
    [b"para\0\0\0\0\0\x03\0\0".to_vec(), numbers].concat()
}

fn profile(space: &[u8; 4], pcs: &[u8; 4], tags: &[(&[u8; 4], Vec<u8>)]) -> Vec<u8> {
    let mut table = (tags.len() as u32).to_be_bytes().to_vec();
    let mut data = Vec::new();
    for (name, tag) in tags {
        let at = 128 + 4 + 12 * tags.len() + data.len();
        table.extend([&name[..], &(at as u32).to_be_bytes(), &(tag.len() as u32).to_be_bytes()].concat());
        data.extend(tag);
        data.resize(data.len().next_multiple_of(4), 0);
    }
    let size = (128 + table.len() + data.len()) as u32;
    let mut head =
        [&size.to_be_bytes()[..], &[0; 4], &[4, 0x40, 0, 0], b"mntr", space, pcs, &[0; 12], b"acsp"].concat();
    head.resize(64, 0);
    head.extend([0, 0, 0, 1]);
    head.extend([0.9642, 1.0, 0.8249].map(fixed).concat());
    head.resize(128, 0);
    [head, table, data].concat()
}

const P3: [[f64; 3]; 3] = [[0.51512, 0.2412, -0.00105], [0.29198, 0.69225, 0.04189], [0.1571, 0.06657, 0.78407]];
const SRGB: [[f64; 3]; 3] = [[0.43607, 0.22249, 0.01392], [0.38515, 0.71687, 0.09708], [0.14307, 0.06061, 0.7141]];

fn rgb(columns: [[f64; 3]; 3], curve: Vec<u8>) -> Vec<u8> {
    let [r, g, b] = columns.map(xyz);
    let tags: [(&[u8; 4], Vec<u8>); 6] = [
        (b"rXYZ", r),
        (b"gXYZ", g),
        (b"bXYZ", b),
        (b"rTRC", curve.clone()),
        (b"gTRC", curve.clone()),
        (b"bTRC", curve),
    ];
    profile(b"RGB ", b"XYZ ", &tags)
}

fn grey(curve: Vec<u8>) -> Vec<u8> {
    profile(b"GRAY", b"XYZ ", &[(b"kTRC", curve)])
}

/// The color of `codes` under a profile, and the notes.
fn shown(icc: Vec<u8>, model: Model, codes: &[u8]) -> ([u8; 3], Vec<String>) {
    let decoded =
        Decoded { size: (1, 1), model, samples: Raw::Bytes(codes.to_vec()), color: Color::Icc(icc), notes: Vec::new() };
    let found = super::super::color::apply(decoded).unwrap();
    let [r, g, b, _] = pixels::encode(found.picture.texel(0, 0));
    ([r, g, b], found.notes)
}

#[test]
fn matrix_and_curves_are_followed() {
    let swapped = [SRGB[1], SRGB[0], SRGB[2]];
    for (icc, codes, expected) in [
        (rgb(P3, parametric()), [200, 60, 60], [217, 42, 52]),
        (rgb(P3, parametric()), [0, 255, 0], [0, 255, 0]),
        (rgb(swapped, parametric()), [200, 60, 10], [60, 200, 10]),
        (rgb(SRGB, gamma(1.0)), [55, 128, 255], [128, 188, 255]),
    ] {
        let (found, notes) = shown(icc, Model::Rgb, &codes);
        assert!(found.iter().zip(expected).all(|(a, b): (&u8, u8)| a.abs_diff(b) <= 1), "{found:?} for {expected:?}");
        assert!(notes.is_empty(), "{notes:?}");
    }
    assert_eq!(shown(grey(gamma(1.0)), Model::Grey, &[55]).0, [128; 3]);
    assert_eq!(shown(rgb(P3, gamma(1.0)), Model::Grey, &[55]).0, [128; 3], "a grey in the wide one is grey");
}

#[test]
fn an_srgb_profile_changes_nothing_to_the_bit() {
    let decoded = |color| Decoded {
        size: (256, 1),
        model: Model::Grey,
        samples: Raw::Bytes((0..=255).collect()),
        color,
        notes: Vec::new(),
    };
    let light = |color| super::super::color::apply(decoded(color)).unwrap().picture.to_linear();
    assert_eq!(light(Color::Icc(rgb(SRGB, parametric()))), light(Color::Untagged));
    assert_eq!(light(Color::Icc(grey(parametric()))), light(Color::Untagged));
}

#[test]
fn what_cannot_be_applied_is_told() {
    let cut = rgb(P3, parametric())[..200].to_vec();
    for (icc, model, part) in [
        (b"no profile".to_vec(), Model::Rgb, "broken"),
        (Vec::new(), Model::Rgb, "broken"),
        (cut, Model::Rgb, "profile"),
        (grey(gamma(2.2)), Model::Rgb, "for grey"),
        (profile(b"CMYK", b"Lab ", &[]), Model::Rgb, "for CMYK"),
        (profile(b"CMYK", b"Lab ", &[]), Model::Cmyk, "not known"),
        (profile(b"RGB ", b"XYZ ", &[]), Model::Rgb, "not known"),
    ] {
        let (_, notes) = shown(icc, model, &[9; 4][..model.count()]);
        assert!(notes.len() == 1 && notes[0].contains(part), "{notes:?} has not {part}");
    }
}

/// A 16-bit table from four inks to Lab: each ink takes away its share of lightness.
fn inks() -> Vec<u8> {
    let mut lut = b"mft2\0\0\0\0\x04\x03\x02\0".to_vec();
    lut.extend([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0].map(fixed).concat());
    lut.extend([0, 2, 0, 2]);
    let line = [0u16, 65535].map(u16::to_be_bytes).concat();
    lut.extend(line.repeat(4));
    for node in 0..16u16 {
        let light = 65280 - node.count_ones() as u16 * 16320;
        lut.extend([light, 0x8000, 0x8000].map(u16::to_be_bytes).concat());
    }
    lut.extend(line.repeat(3));
    profile(b"CMYK", b"Lab ", &[(b"A2B0", lut)])
}

#[test]
fn tables_of_inks_are_followed() {
    let (paper, notes) = shown(inks(), Model::Cmyk, &[0; 4]);
    assert_eq!((paper, notes.len()), ([255; 3], 0));
    // All inks give L* 0, three give 25 and two give 50: grays of 59 and 119.
    for (codes, grey) in [([255; 4], 0), ([255, 255, 255, 0], 59), ([255, 0, 255, 0], 119)] {
        let (found, _) = shown(inks(), Model::Cmyk, &codes);
        assert!(found.iter().all(|v| v.abs_diff(grey) <= 1), "{found:?} for {grey}");
    }
}

#[test]
fn no_profile_brings_it_down() {
    // Preparing a table takes long, so few of its bytes are tried.
    for (whole, model, step) in [(inks(), Model::Cmyk, 97), (rgb(P3, parametric()), Model::Rgb, 1)] {
        for at in (0..whole.len()).step_by(step) {
            for byte in [0, 1, 0x7f, 0xff] {
                let mut bytes = whole.clone();
                bytes[at] = byte;
                let _ = understand(&bytes, model);
            }
        }
    }
}
