//! A forearm's skin with a cut, open: the lips swollen around wet flesh. The lips will close over it.

use kurbo::{ParamCurve, Point, Vec2};
use plica::base::maths::smoothstep;

use super::kit::{Canvas, Mask, Stroke, curve, mix, ramp, rgb, times};
use super::noise::{Chance, fbm, hash};
use super::skin::skin;

const WIDTH: usize = 480;
const HEIGHT: usize = 320;
const CUT: &str = "M104 178 C180 128 300 122 384 150 C310 164 190 186 104 178 Z";
const UPPER: &str = "M104 178 C180 128 300 122 384 150";
const LOWER: &str = "M104 178 C190 186 310 164 384 150";

/// The cut, open, on its skin.
pub fn wound() -> Canvas {
    let mut c = Canvas::new(WIDTH, HEIGHT, rgb(0xE6B698));
    let round = Mask::from_fn(&c, |x, y| {
        let across = (y + 0.12 * x - 190.0) / 210.0;
        smoothstep(0.25, 1.0, across.abs())
    });
    c.glaze(&round, rgb(0xA86A55), 0.85);
    let lit = Mask::from_fn(&c, |x, y| ramp(120.0, 0.0, (y + 0.12 * x - 110.0).abs()));
    c.light(&lit, rgb(0xF5CFB0), 0.28);
    veins(&mut c);
    lips(&mut c);
    c.shade(|x, y, below| skin(x, y, below, 1.2));
    hairs(&mut c);
    flesh(&mut c, CUT, UPPER, LOWER);
    c
}

/// Only the inside of a cut, to be put on a photograph; its shape is [`HAND_CUT`].
pub fn flesh_for_hand() -> Canvas {
    let mut c = Canvas::clear(150, 120);
    flesh(&mut c, HAND_CUT, HAND_UPPER, HAND_LOWER);
    c
}

const HAND_CUT: &str = "M14 84 C44 50 92 28 136 30 C106 58 58 80 14 84 Z";
const HAND_UPPER: &str = "M14 84 C44 50 92 28 136 30";
const HAND_LOWER: &str = "M14 84 C58 80 106 58 136 30";

fn veins(c: &mut Canvas) {
    for (svg, strength) in [
        (
            "M-10 262 C90 238 150 256 240 232 C320 212 400 236 500 206 L500 216 C400 246 320 222 240 242 C150 266 90 248 -10 272 Z",
            0.34,
        ),
        (
            "M40 60 C120 76 160 52 250 66 C330 76 380 60 470 70 L470 77 C380 68 330 84 250 74 C160 60 120 84 40 68 Z",
            0.22,
        ),
    ] {
        let vein = Mask::path(c, svg).blur(4.0);
        c.glaze(&vein, rgb(0x8C8C9A), strength);
    }
}

fn lips(c: &mut Canvas) {
    let around = Mask::path(c, "M70 184 C150 92 320 92 412 144 C330 196 190 216 70 184 Z").blur(16.0);
    c.glaze(&around, rgb(0xD97C6C), 0.62);
    let near = Mask::path(c, "M92 180 C170 116 310 110 396 150 C316 178 190 198 92 180 Z").blur(5.0);
    c.glaze(&near, rgb(0xD66A5E), 0.55);
    for (edge, up) in [(UPPER, -1.0), (LOWER, 1.0)] {
        ridge(c, edge, up * 9.0, 8.0, rgb(0xFFE0CC), 0.045);
        ridge(c, edge, up * 7.0, 2.5, rgb(0xFFF2E6), 0.07);
        ridge(c, edge, up * 17.0, 7.0, rgb(0x9C4A40), 0.030);
    }
}

/// A soft line beside an edge, shorter than it and thinner at its ends.
fn ridge(c: &mut Canvas, edge: &str, offset: f64, width: f64, color: [f32; 3], alpha: f64) {
    let edge = curve(edge);
    for i in 0..120 {
        let t = 0.05 + 0.90 * f64::from(i) / 119.0;
        let swell = (4.0 * t * (1.0 - t)).sqrt();
        let at = edge.eval(t) + Vec2::new(0.0, offset * swell);
        c.stroke(&Stroke::new(at, (5.0, 0.0), 0.0, (width * swell, width * swell)), color, alpha * 2.0);
    }
}

fn hairs(c: &mut Canvas) {
    let mut chance = Chance::new(19);
    let near_cut = Mask::path(c, CUT).blur(14.0);
    for _ in 0..150 {
        let root = Point::new(chance.within(-10.0, 480.0), chance.within(-5.0, 325.0));
        if near_cut.at(root) > 0.05 {
            continue;
        }
        let by = Vec2::new(chance.within(10.0, 24.0), chance.within(-9.0, 5.0));
        c.stroke(&Stroke::new(root, by, chance.within(-0.2, 0.2), (0.8, 0.2)), rgb(0x6B4632), 0.32);
    }
}

/// The inside of a cut: a pale rim of fat, wet muscle fibres, dark depth, light on the wet.
fn flesh(c: &mut Canvas, cut: &str, upper: &str, lower: &str) {
    let inside = Mask::path(c, cut);
    let (upper, lower) = (curve(upper), curve(lower));
    let depth = inside.clone().blur(4.0).and(&inside);
    c.paint_with(&inside, |x, y, _| {
        let fibre = fbm((x + y * 0.4) / 5.0, (y - 0.2 * x) / 22.0, 4, 13);
        let wet = fbm(x / 13.0, y / 8.0, 3, 14);
        (times(mix(rgb(0xB3202A), rgb(0x8E0F1C), ramp(-0.3, 0.3, wet) as f32), (1.0 + 0.28 * fibre) as f32), 1.0)
    });
    c.paint_with(&depth, |x, y, _| {
        (mix(rgb(0x5C0710), rgb(0x2C0206), (fbm(x / 9.0, y / 6.0, 3, 15) * 0.5 + 0.5) as f32), 0.62)
    });
    let core = inside.clone().blur(7.0).and(&inside).and(&depth);
    c.paint(&core, rgb(0x240206), 0.55);
    for (edge, side, tone) in [(upper, 1.0, rgb(0x4A0A0C)), (lower, -1.0, rgb(0xF0B48A))] {
        for i in 0..100 {
            let t = 0.02 + 0.96 * f64::from(i) / 99.0;
            let swell = (4.0 * t * (1.0 - t)).sqrt();
            let at = edge.eval(t) + Vec2::new(0.0, side * 2.0 * swell);
            let alpha = 0.45 + 0.3 * hash(i64::from(i), 2, 6);
            c.stroke_within(&Stroke::new(at, (4.5, -0.4), 0.0, (3.6 * swell, 3.6 * swell)), tone, alpha * 0.5, &inside);
        }
    }
    let mut chance = Chance::new(23);
    for _ in 0..26 {
        let t = chance.within(0.12, 0.88);
        let (a, b) = (upper.eval(t), lower.eval(t));
        let at = a.lerp(b, chance.within(0.3, 0.8));
        c.stroke_within(
            &Stroke::new(at, (chance.within(2.0, 9.0), -0.8), 0.1, (1.4, 0.5)),
            rgb(0xFFD9D2),
            0.55,
            &inside,
        );
    }
}
