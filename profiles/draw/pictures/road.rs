//! A desert road at dusk, and the car that flies along it: two pictures, the car on a transparent background.

use super::kit::{Canvas, Mask, Rgb, Stroke, mix, ramp, rgb, times};
use super::noise::{Chance, fbm, hash, noise};

const WIDTH: usize = 560;
const HEIGHT: usize = 320;
const HORIZON: f64 = 188.0;

/// The road without the car.
pub fn road() -> Canvas {
    let mut c = Canvas::new(WIDTH, HEIGHT, rgb(0xFFFFFF));
    c.shade(|x, y, _| if y < HORIZON { sky(x, y) } else { ground(x, y) });
    let mut chance = Chance::new(4);
    for _ in 0..70 {
        let at = (chance.within(0.0, 560.0), chance.within(0.0, 80.0));
        let size = chance.within(0.5, 1.3);
        c.stroke(&Stroke::new(at, (0.1, 0.0), 0.0, (size, size)), rgb(0xFFF6E0), 0.75 - at.1 / 130.0);
    }
    sun(&mut c);
    mesas(&mut c);
    asphalt(&mut c);
    shrubs(&mut c);
    sign(&mut c);
    c
}

fn sky(x: f64, y: f64) -> Rgb {
    let t = y / HORIZON;
    let low = mix(rgb(0xD8588A), rgb(0xFFB061), ramp(0.55, 1.0, t) as f32);
    let air = mix(rgb(0x24225C), low, ramp(-0.05, 0.72, t) as f32);
    let cloud = fbm(x / 120.0, y / 15.0, 5, 21) + 0.3 * noise(x / 200.0, y / 40.0, 22);
    let glow = mix(rgb(0x7A3C7C), rgb(0xFFC58A), ramp(0.3, 0.9, t) as f32);
    mix(air, glow, (0.7 * ramp(0.05, 0.4, cloud) * ramp(0.1, 0.35, t)) as f32)
}

fn sun(c: &mut Canvas) {
    let (x0, y0) = (392.0, 168.0);
    let from = move |x: f64, y: f64| ((x - x0) * (x - x0) + (y - y0) * (y - y0)).sqrt();
    c.light(
        &Mask::from_fn(c, |x, y| ramp(170.0, 10.0, from(x, y)) * ramp(HORIZON + 40.0, HORIZON - 10.0, y)),
        rgb(0xFF9A4A),
        0.55,
    );
    let disc = Mask::from_fn(c, |x, y| ramp(33.5, 32.0, from(x, y)) * ramp(HORIZON + 0.5, HORIZON - 0.5, y));
    c.paint_with(&disc, |_, y, _| (mix(rgb(0xFFF3C4), rgb(0xFF9A55), ramp(136.0, 196.0, y) as f32), 1.0));
}

fn mesas(c: &mut Canvas) {
    let far = "M-10 190 L-10 160 L40 156 L52 142 L120 140 L132 158 L180 164 L260 166 L300 172 L352 174 L470 176 L500 160 L560 158 L570 190 Z";
    let near = "M-10 190 L-10 132 L22 130 L34 124 L70 126 L82 152 L104 164 L150 176 L210 184 L230 190 Z M420 190 L450 172 L474 166 L488 118 L500 114 L530 116 L542 110 L570 112 L570 190 Z";
    for (svg, light, dark, seed) in [(far, 0x9A5A86, 0x7B4A84, 31), (near, 0xB8544E, 0x5A2A4E, 32)] {
        let mask = Mask::path(c, svg);
        c.paint_with(&mask, |x, y, _| {
            let layer = noise(y / 5.0 + 0.4 * noise(x / 30.0, 0.0, seed), x / 200.0, seed + 1);
            let gully = fbm(x / 9.0, y / 40.0, 4, seed + 2);
            let t = 0.5 + 0.35 * layer + 0.75 * gully;
            (mix(rgb(dark), rgb(light), t.clamp(0.0, 1.0) as f32), 1.0)
        });
    }
    let haze = Mask::from_fn(c, |_, y| ramp(150.0, HORIZON, y) * ramp(HORIZON + 6.0, HORIZON, y));
    c.paint(&haze, rgb(0xFFB27A), 0.42);
}

fn ground(x: f64, y: f64) -> Rgb {
    let depth = (y - HORIZON) / (HEIGHT as f64 - HORIZON);
    let near = 1.0 / (depth + 0.06);
    let dune = fbm((x - 280.0) * near / 60.0, near * 2.2, 5, 41);
    let grain = hash(x as i64, y as i64, 42) - 0.5;
    let base = mix(rgb(0xE08A5A), rgb(0x8A4A44), ramp(0.0, 0.9, depth) as f32);
    times(base, (1.0 + 0.26 * dune + 0.05 * grain) as f32)
}

/// The road runs across the picture: shoulders, asphalt with its stones, lines worn by wheels.
fn asphalt(c: &mut Canvas) {
    let band = Mask::from_fn(c, |x, y| {
        let rough = 1.6 * noise(x / 6.0, y / 3.0, 51);
        ramp(221.0, 224.0, y + rough) * ramp(292.0, 287.0, y + rough)
    });
    let shoulder = Mask::from_fn(c, |x, y| ramp(214.0, 222.0, y + 2.0 * noise(x / 9.0, y, 52)) * ramp(302.0, 290.0, y));
    c.glaze(&shoulder, rgb(0x8A6A70), 0.7);
    c.paint_with(&band, |x, y, _| {
        let stone = hash(x as i64, y as i64, 53) - 0.5 + 0.8 * (hash((x / 2.0) as i64, (y / 1.5) as i64, 54) - 0.5);
        let worn = 0.10 * ramp(9.0, 2.0, (y - 240.0).abs()) + 0.10 * ramp(10.0, 2.0, (y - 272.0).abs());
        let patch = fbm(x / 80.0, y / 18.0, 4, 55);
        let lit = mix(rgb(0x4A3F56), rgb(0x7A5F68), ramp(290.0, 222.0, y) as f32);
        (times(lit, (1.0 - worn + 0.17 * stone + 0.16 * patch) as f32), 1.0)
    });
    let paint = Mask::from_fn(c, |x, y| {
        let worn = ramp(-0.32, 0.05, fbm(x / 5.0, y / 3.0, 4, 56));
        let edge = |at: f64, half: f64| ramp(half + 0.8, half - 0.2, (y - at).abs());
        let along = (x + (y - 254.0) * 0.8 + 30.0).rem_euclid(70.0);
        let dash = ramp(0.0, 1.0, along) * ramp(39.0, 38.0, along);
        worn * (edge(227.0, 1.0).max(edge(285.0, 1.8)) * 0.9).max(edge(254.0, 1.7) * dash)
    });
    c.paint(&paint, rgb(0xFFE3B0), 0.85);
    crack(c);
    let sunlit =
        Mask::from_fn(c, |x, y| ramp(190.0, 20.0, (x - 392.0).abs()) * ramp(300.0, 222.0, y) * ramp(220.0, 224.0, y));
    c.light(&sunlit, rgb(0xFF8A50), 0.20);
}

fn crack(c: &mut Canvas) {
    let mut chance = Chance::new(58);
    for start in [(40.0, 232.0), (208.0, 262.0), (350.0, 236.0), (470.0, 268.0)] {
        let mut at = start;
        for _ in 0..9 {
            let by = (chance.within(3.0, 9.0), chance.within(-3.5, 4.0));
            c.stroke(&Stroke::new(at, by, chance.within(-0.3, 0.3), (1.0, 0.9)), rgb(0x231B2C), 0.55);
            at = (at.0 + by.0, at.1 + by.1);
        }
    }
}

fn shrubs(c: &mut Canvas) {
    let mut chance = Chance::new(63);
    for i in 0..44 {
        let back = i % 3 != 0;
        let (x, y) =
            (chance.within(-10.0, 570.0), if back { chance.within(194.0, 216.0) } else { chance.within(304.0, 322.0) });
        let size = if back { (y - 184.0) * 0.35 } else { (y - 284.0) * 0.55 };
        let dark = mix(rgb(0x4A3A3E), rgb(0x2C2A34), chance.within(0.0, 1.0) as f32);
        for _ in 0..26 {
            let by = (chance.within(-1.0, 1.0) * size, -chance.within(0.4, 1.0) * size);
            let tone = mix(dark, rgb(0x9A7A4E), chance.within(0.0, 0.8) as f32);
            c.stroke(&Stroke::new((x + by.0 * 0.3, y), by, chance.within(-0.3, 0.3), (1.2, 0.4)), tone, 0.75);
        }
    }
}

/// A sign close to us on the left, which the car passes behind.
fn sign(c: &mut Canvas) {
    let post = Mask::path(c, "M93 206 L101 206 L102 330 L92 330 Z");
    c.paint_with(&post, |x, _, _| (mix(rgb(0x8A6A5A), rgb(0x3A2A30), ramp(93.0, 102.0, x) as f32), 1.0));
    let plate = Mask::path(
        c,
        "M97 116 L146 165 C148 167 148 169 146 171 L100 214 C98 216 96 216 94 214 L48 171 C46 169 46 167 48 165 L94 117 C95 116 96 116 97 116 Z",
    );
    c.paint_with(&plate, |x, y, _| {
        let rust = ramp(
            0.12,
            0.4,
            fbm(x / 12.0, y / 12.0, 4, 71) + 0.2 * ramp(30.0, 50.0, (x - 97.0).abs() + (y - 166.0).abs()),
        );
        let enamel = mix(rgb(0xF7B733), rgb(0xC9812A), ramp(60.0, 150.0, x) as f32);
        (mix(enamel, rgb(0x6B3320), (0.75 * rust) as f32), 1.0)
    });
    let frame = Mask::path(c, "M97 122 L142 168 L97 210 L52 168 Z M97 127 L57 168 L97 205 L137 168 Z");
    c.paint(&frame, rgb(0x2A2028), 0.85);
    let glyph = Mask::path(
        c,
        "M72 176 C74 168 80 165 84 164 L92 155 C94 153 100 153 106 154 L114 163 C120 164 124 166 124 172 L123 176 L116 177 L78 177 Z M76 184 L120 184 L116 187 L80 187 Z M84 191 L112 191 L108 194 L88 194 Z",
    );
    c.paint(&glyph, rgb(0x2A2028), 0.9);
    let lit = Mask::path(c, "M97 116 L146 165 L142 165 L97 120 Z");
    c.light(&lit, rgb(0xFFE0A0), 0.6);
}

/// The car alone, flying: body, glass, fins, the light below it.
pub fn car() -> Canvas {
    let mut c = Canvas::clear(220, 110);
    let glow = Mask::ellipse(&c, (112.0, 82.0), (74.0, 6.0)).blur(6.0);
    c.paint(&glow, rgb(0x6FF2FF), 0.85);
    for (x, length) in [(20.0, 18.0), (15.0, 14.0)] {
        let flame = Mask::path(
            &c,
            &format!(
                "M{} 54 C{} 50 {} 56 2 60 C{} 62 {} 66 {} 66 Z",
                x + 20.0,
                x + 8.0,
                x,
                x - length * 0.2,
                x + 8.0,
                x + 20.0
            ),
        )
        .blur(2.0);
        c.paint(&flame, if length > 16.0 { rgb(0xFF8A3A) } else { rgb(0xFFF0B0) }, 0.8);
    }
    body(&mut c);
    glass(&mut c);
    trim(&mut c);
    c
}

const BODY: &str = "M22 66 C20 56 22 48 30 44 L24 24 C30 22 38 24 44 30 L56 42 C70 38 80 36 88 36 C130 32 158 40 172 46 C194 49 206 54 209 62 C210 68 206 73 196 75 L46 77 C32 77 24 74 22 66 Z";

fn body(c: &mut Canvas) {
    let mask = Mask::path(c, BODY);
    c.paint_with(&mask, |x, y, _| {
        let sky = mix(rgb(0xE9547A), rgb(0x7A1638), ramp(38.0, 56.0, y) as f32);
        let low = mix(sky, rgb(0x2E0A24), ramp(58.0, 76.0, y) as f32);
        let band = ramp(4.0, 0.0, (y - 53.0 - 0.02 * (x - 110.0)).abs());
        (mix(low, rgb(0xFFD0B0), (0.75 * band) as f32), 1.0)
    });
    let top = Mask::path(c, "M58 43 C76 38 96 36 112 36 C140 36 160 42 172 47 C192 50 204 55 207 60 C190 54 170 51 150 50 C110 47 76 46 58 43 Z").blur(1.0).and(&mask);
    c.light(&top, rgb(0xFFB0A0), 0.55);
    let fin = Mask::path(c, "M25 25 C31 24 37 26 42 31 L54 43 L38 45 C32 40 28 32 25 25 Z").blur(1.0).and(&mask);
    c.light(&fin, rgb(0xFF8FA0), 0.35);
    c.glaze(&Mask::path(c, "M22 66 C60 70 160 72 209 63 L209 80 L22 80 Z").blur(3.0).and(&mask), rgb(0x5A2A4A), 0.6);
    let under = Mask::path(c, "M30 73 L200 72 C206 72 208 70 209 68 L206 78 L32 80 Z").blur(2.0).and(&mask);
    c.light(&under, rgb(0x3AB8E0), 0.8);
    for x in [62.0, 166.0] {
        c.paint(&Mask::ellipse(c, (x, 74.0), (17.0, 6.5)), rgb(0x231A2C), 1.0);
        c.paint(&Mask::ellipse(c, (x, 77.0), (13.0, 3.0)).blur(1.0), rgb(0xA8FAFF), 0.95);
        c.light(&Mask::ellipse(c, (x, 71.0), (14.0, 1.2)).blur(1.0), rgb(0xB0A0C0), 0.7);
    }
}

fn glass(c: &mut Canvas) {
    let dome = Mask::path(c, "M74 39 C80 24 96 17 114 18 C134 19 148 30 158 43 C130 38 100 36 74 39 Z");
    c.paint_with(&dome, |x, y, _| {
        let t = ramp(18.0, 42.0, y + 0.1 * (x - 110.0));
        (mix(rgb(0x9AD4EC), rgb(0x1F2C56), t as f32), 0.90)
    });
    let driver =
        Mask::path(c, "M98 38 C97 33 101 32 102 30 C99 27 101 22 106 22 C111 22 113 27 110 30 C113 32 116 34 116 38 Z")
            .and(&dome);
    c.paint(&driver, rgb(0x1A1228), 0.85);
    let gleam = Mask::path(c, "M82 36 C86 26 98 21 110 21 C100 24 92 29 89 37 Z").blur(1.0).and(&dome);
    c.light(&gleam, rgb(0xFFFFFF), 0.8);
    for pillar in ["M118 18 L121 18 L127 38 L124 38 Z", "M73 40 C98 35 130 37 160 44 L160 46 C130 39 98 38 73 42 Z"] {
        c.paint(&Mask::path(c, pillar), rgb(0xE8D8D0), 0.95);
    }
}

fn trim(c: &mut Canvas) {
    let lines: [((f64, f64), (f64, f64), f64); 4] = [
        ((100.0, 46.0), (-2.0, 27.0), 0.8),
        ((136.0, 47.0), (6.0, 26.0), 0.8),
        ((36.0, 61.0), (164.0, 1.0), 1.6),
        ((106.0, 55.0), (8.0, 0.2), 1.6),
    ];
    for (i, (at, by, width)) in lines.into_iter().enumerate() {
        let color = if i < 2 { rgb(0x3A0A22) } else { rgb(0xFFE9DA) };
        c.stroke(&Stroke::new(at, by, 0.0, (width, width)), color, 0.75);
    }
    c.paint(&Mask::ellipse(c, (202.0, 59.0), (5.0, 3.0)), rgb(0xFFF8D8), 1.0);
    c.light(&Mask::ellipse(c, (207.0, 60.0), (12.0, 6.0)).blur(3.0), rgb(0xFFEFB0), 0.8);
    c.paint(&Mask::path(c, "M23 52 L29 50 L29 60 L22 62 Z"), rgb(0xFF3A3A), 1.0);
    c.light(&Mask::ellipse(c, (25.0, 56.0), (2.0, 3.0)).blur(1.0), rgb(0xFFC0A0), 0.8);
}

/// The reflection of the car's light on the road.
pub fn light() -> Canvas {
    let mut c = Canvas::clear(220, 40);
    c.paint(&Mask::ellipse(&c, (110.0, 20.0), (76.0, 8.0)).blur(5.0), rgb(0x140C20), 0.62);
    c.paint(&Mask::ellipse(&c, (112.0, 19.0), (58.0, 4.0)).blur(4.0), rgb(0x5AD8F0), 0.42);
    c
}
