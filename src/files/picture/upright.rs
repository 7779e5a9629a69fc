//! Turns photographs upright, by the eight orientations of EXIF.

use super::decoded::Raw;

/// Width and height after turning.
pub(super) fn size((width, height): (usize, usize), orientation: u8) -> (usize, usize) {
    if (5..=8).contains(&orientation) { (height, width) } else { (width, height) }
}

/// Turns pixels of `count` samples each; returns the new size.
pub(super) fn turn(samples: &mut Raw, count: usize, from: (usize, usize), orientation: u8) -> (usize, usize) {
    if (2..=8).contains(&orientation) {
        match samples {
            Raw::Bytes(all) => *all = turned(all, count, from, orientation),
            Raw::Words(all) | Raw::Halves(all) => *all = turned(all, count, from, orientation),
            Raw::Floats(all) => *all = turned(all, count, from, orientation),
        }
    }
    size(from, orientation)
}

fn turned<T: Copy>(all: &[T], count: usize, (w, h): (usize, usize), orientation: u8) -> Vec<T> {
    let (width, height) = size((w, h), orientation);
    let mut out = Vec::with_capacity(all.len());
    for y in 0..height {
        for x in 0..width {
            let (x, y) = match orientation {
                2 => (w - 1 - x, y),
                3 => (w - 1 - x, h - 1 - y),
                4 => (x, h - 1 - y),
                5 => (y, x),
                6 => (y, h - 1 - x),
                7 => (w - 1 - y, h - 1 - x),
                _ => (w - 1 - y, x),
            };
            out.extend_from_slice(&all[(y * w + x) * count..][..count]);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{DynamicImage, GrayImage, metadata::Orientation};

    #[test]
    fn all_eight_are_as_exif_says() {
        let codes: Vec<u8> = (0..6).collect();
        for orientation in 1..=8 {
            let mut image = DynamicImage::from(GrayImage::from_raw(3, 2, codes.clone()).unwrap());
            image.apply_orientation(Orientation::from_exif(orientation).unwrap());
            let mut samples = Raw::Bytes(codes.clone());
            let size = turn(&mut samples, 1, (3, 2), orientation);
            assert_eq!(size, (image.width() as usize, image.height() as usize), "{orientation}");
            assert!(matches!(samples, Raw::Bytes(found) if found == image.as_bytes()), "{orientation}");
        }
    }
}
