//! A mask that was painted without alpha, black on white: its brightness is the alpha of a copy of the picture.

use super::picture::{Channels, Picture, Samples};
use super::pixels::{Rgba, encode};

/// Whether the mask has the size of the picture; a mask of another size is reported and used as it is.
pub fn fits(own: &Picture, mask: &Picture) -> bool {
    (own.width(), own.height()) == (mask.width(), mask.height())
}

/// Bytes that [`by_brightness`] takes.
pub fn bytes(own: &Picture, _mask: &Picture) -> u64 {
    let each = if matches!(own.samples(), Samples::Bytes(..)) { 4 } else { 16 };
    own.width() as u64 * own.height() as u64 * each
}

/// The picture, seen as far as `mask` is bright; gray of code c lets c of 255 through, as a layer's mask does elsewhere.
pub fn by_brightness(own: &Picture, mask: &Picture) -> Picture {
    let (width, height) = (own.width(), own.height());
    let mut light: Vec<Rgba> = vec![[0.0; 4]; width];
    let mut codes = Vec::with_capacity(width * height);
    for y in 0..height {
        mask.row(0, y, &mut light);
        codes.extend(light.iter().map(|&[r, g, b, _]| {
            // A gray is itself, to the bit; sums of the three would round it.
            let y = if r == g && g == b { r } else { 0.2126 * r + 0.7152 * g + 0.0722 * b };
            encode([y, y, y, 1.0])[0]
        }));
    }
    match own.samples() {
        Samples::Bytes(all, light) => {
            let count = own.channels().count();
            let cells = all.chunks_exact(count).zip(&codes).flat_map(|(cell, &code)| match *cell {
                [g] => [g, g, g, code],
                [g, a] => [g, g, g, times(a, code)],
                [r, g, b] => [r, g, b, code],
                [r, g, b, a, ..] => [r, g, b, times(a, code)],
                [] => [0; 4],
            });
            Picture::new(width, height, Channels::Rgba, Samples::Bytes(cells.collect(), light.clone()))
        }
        Samples::Words(..) | Samples::Halves(_) | Samples::Floats(_) => {
            let cells = codes.iter().enumerate().map(|(i, &code)| {
                let alpha = f32::from(code) / 255.0;
                own.texel(i % width, i / width).map(|v| v * alpha)
            });
            Picture::from_cells(width, height, cells.collect())
        }
    }
}

fn times(a: u8, b: u8) -> u8 {
    ((u32::from(a) * u32::from(b) + 127) / 255) as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::picture::SRGB_8;

    #[test]
    fn brightness_becomes_alpha() {
        let bytes = |channels, all: &[u8]| Picture::new(3, 1, channels, Samples::Bytes(all.to_vec(), SRGB_8.clone()));
        let own = bytes(Channels::Rgb, &[10, 20, 30, 40, 50, 60, 70, 80, 90]);
        for mask in
            [bytes(Channels::Grey, &[0, 128, 255]), bytes(Channels::Rgb, &[0, 0, 0, 128, 128, 128, 255, 255, 255])]
        {
            let Samples::Bytes(found, _) = by_brightness(&own, &mask).samples().clone() else { panic!("bytes") };
            assert_eq!(found, [10, 20, 30, 0, 40, 50, 60, 128, 70, 80, 90, 255]);
        }
        let own = Picture::filled(3, 1, [0.5, 0.25, 1.0, 1.0]);
        let masked = by_brightness(&own, &bytes(Channels::Grey, &[0, 255, 51]));
        assert_eq!([0, 1, 2].map(|x| masked.texel(x, 0)[3]), [0.0, 1.0, 0.2]);
        let clear = bytes(Channels::GreyAlpha, &[9, 255, 9, 128, 9, 0]);
        let masked = by_brightness(&clear, &bytes(Channels::Grey, &[128, 128, 255]));
        assert!(matches!(masked.samples(), Samples::Bytes(all, _) if [all[3], all[7], all[11]] == [128, 64, 0]));
    }
}
