//! Oklab (Ottosson 2020): distances are what an eye sees.

use super::maths::{cbrt, cos, sin};
use super::pixels::{encode, linear_from_srgb};

/// Lightness, and the axes green to red and blue to yellow.
pub type Lab = [f64; 3];

/// sRGB code values, 0 to 255, to Oklab.
pub fn lab(codes: [f64; 3]) -> Lab {
    let [r, g, b] = codes.map(|c| linear_from_srgb(c / 255.0));
    let l = cbrt(0.412_221_470_8 * r + 0.536_332_536_3 * g + 0.051_445_992_9 * b);
    let m = cbrt(0.211_903_498_2 * r + 0.680_699_545_1 * g + 0.107_396_956_6 * b);
    let s = cbrt(0.088_302_461_9 * r + 0.281_718_837_6 * g + 0.629_978_700_5 * b);
    [
        0.210_454_255_3 * l + 0.793_617_785_0 * m - 0.004_072_046_8 * s,
        1.977_998_495_1 * l - 2.428_592_205_0 * m + 0.450_593_709_9 * s,
        0.025_904_037_1 * l + 0.782_771_766_2 * m - 0.808_675_766_0 * s,
    ]
}

/// The nearest sRGB code values of an Oklab color.
pub fn srgb([l, a, b]: Lab) -> [u8; 3] {
    let cube = |x: f64| x * x * x;
    let (l, m, s) = (
        cube(l + 0.396_337_777_4 * a + 0.215_803_757_3 * b),
        cube(l - 0.105_561_345_8 * a - 0.063_854_172_8 * b),
        cube(l - 0.089_484_177_5 * a - 1.291_485_548_0 * b),
    );
    let linear = [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ];
    let [r, g, b, _] = encode([linear[0] as f32, linear[1] as f32, linear[2] as f32, 1.0]);
    [r, g, b]
}

/// A color of the wheel: `turns` of a whole turn from red on, at a lightness and colorfulness that every hue has.
pub fn hue(turns: f64) -> [u8; 3] {
    let angle = turns * super::maths::TAU + 0.5;
    srgb([0.62, 0.14 * cos(angle), 0.14 * sin(angle)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn oklab_round_trips() {
        for color in [[0, 0, 0], [255, 255, 255], [12, 200, 99], [255, 0, 255]] {
            assert_eq!(srgb(lab(color.map(f64::from))), color);
        }
    }
}
