//! Another size for a finished frame, in linear light, with alpha premultiplied: no dark fringes.

use image::{ImageBuffer, Rgba, imageops};

use crate::base::error::{Error, Result};
use crate::base::pixels::Linear;

/// The size `text` asks for, `WxH`, of frames that are `size` large. A 0 keeps the ratio.
///
/// # Errors
///
/// A wrong command line.
pub fn parse(text: &str, size: (usize, usize)) -> Result<(usize, usize)> {
    const MOST: usize = 1 << 20;
    let wrong = |what: &str| Error::Usage(format!("--size {text}: {what} (as in 640x480, or 640x0 to keep the ratio)"));
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.trim().parse().ok()?, h.trim().parse().ok()?)));
    let in_ratio = |side: usize, of: usize, other: usize| ((side * other + of / 2) / of.max(1)).max(1);
    let (width, height) = match sides.ok_or_else(|| wrong("not a width and a height"))? {
        (w, h) if w > MOST || h > MOST => return Err(wrong("a side is at most 1048576 pixels")),
        (0, 0) => return Err(wrong("0 is for one side")),
        (w, 0) => (w, in_ratio(w, size.0, size.1)),
        (0, h) => (in_ratio(h, size.1, size.0), h),
        both => both,
    };
    if width * height > 1 << 28 { Err(wrong("a frame has at most 2^28 pixels")) } else { Ok((width, height)) }
}

/// `picture` at another size (Catmull-Rom, widened where it shrinks).
pub fn resize(picture: &Linear, (width, height): (usize, usize)) -> Linear {
    if (picture.width(), picture.height()) == (width, height) {
        return picture.clone();
    }
    let channels = picture.cells().as_flattened().to_vec();
    let image = ImageBuffer::<Rgba<f32>, _>::from_raw(picture.width() as u32, picture.height() as u32, channels);
    let image = image.expect("a picture has four channels a pixel");
    let resized = imageops::resize(&image, width as u32, height as u32, imageops::FilterType::CatmullRom);
    let within = |p: &Rgba<f32>| {
        let alpha = p.0[3].clamp(0.0, 1.0); // the filter overshoots at edges
        [p.0[0].clamp(0.0, alpha), p.0[1].clamp(0.0, alpha), p.0[2].clamp(0.0, alpha), alpha]
    };
    Linear::from_cells(width, height, resized.pixels().map(within).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        for (text, size) in
            [("640x480", (640, 480)), ("150x0", (150, 100)), ("0x50", (75, 50)), ("1x0", (1, 1)), ("20 X 10", (20, 10))]
        {
            assert_eq!(parse(text, (300, 200)).unwrap(), size, "{text}");
        }
        for text in ["640", "0x0", "x", "1x2x3", "-1x5", "1048577x1", "99999x99999", ""] {
            assert_eq!(parse(text, (300, 200)).unwrap_err().exit_status(), 2, "{text}");
        }
    }

    #[test]
    fn halving_is_linear_and_makes_no_fringe() {
        let mut picture = Linear::filled(64, 64, [0.0; 4]);
        for (i, cell) in picture.cells_mut().iter_mut().enumerate() {
            if (i % 2 + i / 64 % 2) % 2 == 0 {
                *cell = [1.0, 1.0, 1.0, 1.0];
            }
        }
        let half = resize(&picture, (32, 32));
        let [r, .., a] = *half.get(16, 16);
        assert!((r - 0.5).abs() < 0.02 && (a - 0.5).abs() < 0.02, "{r} {a}");
        assert_eq!(crate::base::pixels::encode(*half.get(16, 16))[0], 255, "white stays white under half alpha");
    }
}
