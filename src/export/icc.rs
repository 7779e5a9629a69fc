//! sRGB as an ICC profile, for files that cannot say their colors in any other way. It is written here number by number, so that it
//! is small and the same everywhere.
//!
//! Layout: ICC.1:2010 (version 4.3). The primaries are those of BT.709 adapted to D50, and add up to it exactly.

/// D50, the white of the connection space.
const D50: [u32; 3] = [0xf6d6, 0x10000, 0xd32d];
const RED: [u32; 3] = [0x6fa0, 0x38f5, 0x0390];
const GREEN: [u32; 3] = [0x6297, 0xb787, 0x18d9];
const BLUE: [u32; 3] = [0x249f, 0x0f84, 0xb6c4];
/// From D65 to D50, by Bradford.
const ADAPTATION: [u32; 9] = [0x10c42, 0x05de, 0xffff_f325, 0x0793, 0xfd90, 0xffff_fba1, 0xffff_fda2, 0x03dc, 0xc06e];
/// (a x + b)^g from d on, c x below: g, a, b, c, d.
const TRANSFER: [u32; 5] = [0x26666, 0xf2a7, 0x0d59, 0x13d0, 0x0a5b];

const HEADER: usize = 128;

/// The profile.
pub fn srgb() -> Vec<u8> {
    let curve: Vec<u8> = [b"para".to_vec(), vec![0; 4], vec![0, 3, 0, 0], numbers(&TRANSFER)].concat();
    // The three curves are one.
    let parts: [(&[&[u8; 4]], Vec<u8>); 8] = [
        (&[b"desc"], text("sRGB")),
        (&[b"cprt"], text("CC0")),
        (&[b"wtpt"], xyz(&D50)),
        (&[b"chad"], [b"sf32".to_vec(), vec![0; 4], numbers(&ADAPTATION)].concat()),
        (&[b"rXYZ"], xyz(&RED)),
        (&[b"gXYZ"], xyz(&GREEN)),
        (&[b"bXYZ"], xyz(&BLUE)),
        (&[b"rTRC", b"gTRC", b"bTRC"], curve),
    ];
    let count: usize = parts.iter().map(|(names, _)| names.len()).sum();
    let first = HEADER + 4 + 12 * count;
    let (mut table, mut data) = (numbers(&[count as u32]), Vec::new());
    for (names, part) in parts {
        for name in names {
            table.extend(*name);
            table.extend(numbers(&[(first + data.len()) as u32, part.len() as u32]));
        }
        data.extend(part);
        data.resize(data.len().next_multiple_of(4), 0);
    }
    [header((first + data.len()) as u32), table, data].concat()
}

fn header(length: u32) -> Vec<u8> {
    let mut bytes = numbers(&[length, 0, 0x0430_0000]);
    bytes.extend(b"mntrRGB XYZ ");
    bytes.extend([0x07, 0xe9, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0]); // 2025-01-01
    bytes.extend(b"acsp");
    bytes.resize(68, 0); // nobody's platform, device and settings; perceptual
    bytes.extend(numbers(&D50));
    bytes.resize(HEADER, 0);
    bytes
}

fn numbers(numbers: &[u32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_be_bytes()).collect()
}

fn xyz(color: &[u32; 3]) -> Vec<u8> {
    [b"XYZ ".to_vec(), vec![0; 4], numbers(color)].concat()
}

/// A text in one language.
fn text(text: &str) -> Vec<u8> {
    let letters: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
    let head = numbers(&[0, 1, 12, u32::from_be_bytes(*b"enUS"), letters.len() as u32, 28]);
    [b"mluc".to_vec(), head, letters].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_profile_is_whole() {
        let profile = srgb();
        let number = |at: usize| u32::from_be_bytes(profile[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!((number(0), &profile[36..40]), (profile.len(), &b"acsp"[..]));
        assert_eq!(number(HEADER), 10);
        for row in 0..10 {
            let at = HEADER + 4 + 12 * row;
            let (offset, length) = (number(at + 4), number(at + 8));
            assert!(offset % 4 == 0 && offset + length <= profile.len(), "{row}");
            let kind = &profile[offset..offset + 4];
            assert!([&b"mluc"[..], b"XYZ ", b"sf32", b"para"].contains(&kind), "{kind:?}");
        }
        let sum = |at: usize| RED[at] + GREEN[at] + BLUE[at];
        assert_eq!([sum(0), sum(1), sum(2)], D50);
    }
}
