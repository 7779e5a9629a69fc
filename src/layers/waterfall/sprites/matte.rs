//! What of a window is shown: alpha, and premultiplied light.

use super::model::{Matte, MatteKind};
use crate::base::maths::smoothstep;
use crate::base::pixels::{Rgba, linear_from_srgb};

/// The brightest code of brightness in 16 bits.
const BRIGHTEST: f64 = 65_280.0;
/// Windows become at most so many times brighter.
const MOST_GAIN: f64 = 8.0;

/// The window of one key.
pub struct Cut {
    /// Its brightness in 16 bits.
    pub luma: Vec<u16>,
    /// Its light.
    pub light: Vec<[f32; 3]>,
    /// What counts as dark there, in brightness of 16 bits, if each pixel has its own.
    pub dark: Option<Vec<u16>>,
}

/// The keys of one track, each of `side` by `side` texels.
pub fn keys(matte: &Matte, side: usize, cuts: &[Cut]) -> Vec<Vec<Rgba>> {
    let mut all: Vec<u16> = cuts.iter().flat_map(|cut| &cut.luma).copied().collect();
    all.sort_unstable();
    let at = |percent: f64| {
        let index = (all.len() as f64 * percent / 100.0).floor() as usize;
        f64::from(all[index.min(all.len() - 1)])
    };
    let (low, high) = (at(matte.low), at(matte.high));
    let gain = if matte.white == 0.0 { 1.0 } else { (matte.white / linear_from_srgb(high / BRIGHTEST)).min(MOST_GAIN) };
    let round: Vec<f64> = (0..side * side).map(|i| roundness(matte.feather, side, i)).collect();
    let key = |cut: &Cut| {
        let texel = |i: usize| {
            let light = cut.light[i].map(f64::from);
            let low = cut.dark.as_ref().map_or(low, |dark| f64::from(dark[i]));
            let (alpha, color) = match matte.kind {
                MatteKind::Luma | MatteKind::Motion => {
                    let least = 256.0 * matte.contrast;
                    let bright = (f64::from(cut.luma[i]) - low) / (high - low).max(least);
                    let alpha = round[i] * bright.clamp(0.0, 1.0);
                    (alpha, light.map(|v| (gain * v).min(1.0) * alpha))
                }
                MatteKind::Glow => {
                    let color = light.map(|v| round[i] * v);
                    (color[0].max(color[1]).max(color[2]), color)
                }
                MatteKind::None => (round[i], light.map(|v| round[i] * v)),
            };
            [color[0], color[1], color[2], alpha].map(|v| v as f32)
        };
        (0..side * side).map(texel).collect()
    };
    cuts.iter().map(key).collect()
}

/// How much of texel `i` is in the round part of a window.
fn roundness(feather: f64, side: usize, i: usize) -> f64 {
    let from_middle = |v: usize| v as f64 + 0.5 - side as f64 / 2.0;
    let (x, y) = (from_middle(i % side), from_middle(i / side));
    let far = 2.0 * (x * x + y * y).sqrt() / side as f64;
    if far >= 1.0 { 0.0 } else { 1.0 - smoothstep(1.0 - feather, 1.0, far) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: usize = 4;

    fn cut(code: u16) -> Cut {
        let light = linear_from_srgb(f64::from(code) / 255.0) as f32;
        Cut { luma: vec![256 * code; SIDE * SIDE], light: vec![[light, light, 0.0]; SIDE * SIDE], dark: None }
    }

    #[test]
    fn a_matte_shows_what_its_kind_says() {
        let matte = Matte { low: 50.0, high: 100.0, feather: 0.0, white: 0.0, ..Matte::default() };
        let dark = Some(vec![10 * 256; SIDE * SIDE]);
        let (middle, corner) = (SIDE + 1, 0);
        let light = |code: f64| linear_from_srgb(code / 255.0);
        for (matte, key, [r, b, alpha]) in [
            // Of 16 texels of code 10 and 16 of code 30, the one in the middle of the order has code 30.
            (Matte { low: 0.0, ..matte.clone() }, 1, [light(30.0), 0.0, 1.0]),
            (Matte { low: 0.0, ..matte.clone() }, 0, [0.0, 0.0, 0.0]),
            (Matte { low: 0.0, contrast: 40.0, ..matte.clone() }, 1, [light(30.0) / 2.0, 0.0, 0.5]),
            (Matte { low: 0.0, white: 0.1, ..matte.clone() }, 1, [(light(30.0) * 8.0).min(0.1), 0.0, 1.0]),
            (Matte { kind: MatteKind::Glow, ..matte.clone() }, 1, [light(30.0), 0.0, light(30.0)]),
            (Matte { kind: MatteKind::None, ..matte.clone() }, 0, [light(10.0), 0.0, 1.0]),
            (Matte { kind: MatteKind::Motion, ..matte.clone() }, 1, [light(30.0), 0.0, 1.0]),
        ] {
            let own = if matte.kind == MatteKind::Motion { dark.clone() } else { None };
            let cuts = [cut(10), Cut { dark: own, ..cut(30) }];
            let found = keys(&matte, SIDE, &cuts);
            let [red, _, blue, a] = found[key][middle].map(f64::from);
            let far = (red - r).abs().max((blue - b).abs()).max((a - alpha).abs());
            assert!(far < 1e-6, "{matte:?}: {:?}", found[key][middle]);
            assert_eq!(found[key][corner], [0.0; 4], "{matte:?}");
        }
    }

    #[test]
    fn a_feather_fades_from_the_middle() {
        let near = |found: f64, wanted: f64| assert!((found - wanted).abs() < 1e-12, "{found}");
        near(
            roundness(1.0, 64, 64 * 32 + 63),
            1.0 - smoothstep(0.0, 1.0, 2.0 * (31.5 * 31.5 + 0.25_f64).sqrt() / 64.0),
        );
        near(roundness(0.0, 64, 64 * 32 + 63), 1.0);
        near(roundness(0.5, 64, 64 * 32 + 40), 1.0);
    }
}
