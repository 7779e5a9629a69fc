//! A beach: sky, a sea with a breaking wave, lace of foam at the waterline, wet and dry sand.

use kurbo::ParamCurve;

use super::kit::{Canvas, Mask, Rgb, Stroke, mix, path, ramp, rgb, times};
use super::noise::{Chance, cells, fbm, hash, noise};

const WIDTH: usize = 480;
const HEIGHT: usize = 360;
const HORIZON: f64 = 84.0;
const SHORE: &str = "M-20 216 C50 198 96 236 160 226 C226 216 262 244 326 232 C392 220 430 206 500 220";

/// The beach, the water drawn back.
pub fn beach() -> Canvas {
    let shore = shore_rows();
    let mut c = Canvas::new(WIDTH, HEIGHT, rgb(0xFFFFFF));
    c.shade(|x, y, _| {
        let up = shore[x as usize] - y;
        if y < HORIZON {
            sky(x, y)
        } else if up > 0.0 {
            water(x, y, up)
        } else {
            sand(x, y, -up)
        }
    });
    headland(&mut c);
    breaker(&mut c, &shore);
    waterline(&mut c, &shore);
    pebbles(&mut c, &shore);
    c
}

/// The waterline's y in every column.
fn shore_rows() -> Vec<f64> {
    let mut rows = vec![0.0; WIDTH];
    for segment in path(SHORE).segments() {
        for i in 0..=1200 {
            let p = segment.eval(f64::from(i) / 1200.0);
            if (0.0..WIDTH as f64).contains(&p.x) {
                rows[p.x as usize] = p.y;
            }
        }
    }
    rows
}

fn sky(x: f64, y: f64) -> Rgb {
    let air = mix(rgb(0x4E9FD6), rgb(0xF6E7CF), ramp(0.0, HORIZON + 6.0, y) as f32);
    let cloud = fbm(x / 90.0 + 3.0, y / 24.0, 5, 61) + 0.25 * (y / HORIZON - 0.5);
    let lit = fbm(x / 90.0 + 2.9, y / 24.0 - 0.25, 5, 61) - cloud;
    let color = mix(rgb(0xFFFFFF), rgb(0xC9CBD8), ramp(-0.05, 0.18, lit) as f32);
    mix(air, color, (0.85 * ramp(0.02, 0.34, cloud)) as f32)
}

fn water(x: f64, y: f64, up: f64) -> Rgb {
    let far = ramp(150.0, 20.0, y - HORIZON);
    let deep = mix(rgb(0x2FA7B5), rgb(0x1D6C96), far as f32);
    let shallow = mix(rgb(0xCFC59B), rgb(0x7FD0C6), ramp(0.0, 42.0, up) as f32);
    let base = mix(shallow, deep, ramp(18.0, 84.0, up) as f32);
    // Waves in the world's plane: the same pattern, seen at a grazing angle.
    let distance = 900.0 / (y - HORIZON + 7.0);
    let (wx, wz) = ((x - 240.0) * distance / 420.0, distance * 1.1);
    let wave = fbm(wx * 0.35, wz * 1.5, 4, 71) + 0.5 * noise(wx * 0.1, wz * 0.55, 72);
    let swell = times(base, (1.0 + 0.30 * wave) as f32);
    let glint = ramp(0.34, 0.62, wave) * (0.35 + 0.4 * far);
    // Light through the shallows draws a net on the sand.
    let (first, second) = cells(x / 15.0 + noise(x / 20.0, y / 9.0, 4), y / 7.0, 73);
    let net = ramp(0.16, 0.0, second - first) * ramp(70.0, 22.0, up) * ramp(4.0, 16.0, up);
    mix(mix(swell, rgb(0xEAF7F4), glint as f32), rgb(0xF4FFF2), (0.30 * net) as f32)
}

fn sand(x: f64, y: f64, down: f64) -> Rgb {
    let wander = 16.0 * noise(x / 70.0, 0.0, 81) + 5.0 * noise(x / 21.0, 0.0, 82);
    let wet = ramp(92.0 + wander, 66.0 + wander, down);
    let ripple = fbm(x / 60.0 + 0.02 * y, y / 11.0, 4, 83);
    let grain = hash(x as i64, y as i64, 84) - 0.5;
    let speck = if hash(x as i64, y as i64, 85) > 0.994 { -0.16 } else { 0.0 };
    let dry = times(rgb(0xEBD3A4), (0.97 + 0.08 * ripple + 0.055 * grain + speck) as f32);
    let mirror = mix(rgb(0xB09468), rgb(0xC9C6B4), (0.55 * ramp(40.0, 0.0, down)) as f32);
    let moist = times(mirror, (0.96 + 0.045 * ripple + 0.025 * grain + speck) as f32);
    // The last wave left a fine dark line where it turned.
    let edge = ramp(3.0, 0.0, (down - 80.0 - wander).abs());
    times(mix(dry, moist, wet as f32), (1.0 - 0.10 * edge) as f32)
}

fn headland(c: &mut Canvas) {
    let hill = "M300 85 C330 74 348 60 372 62 C398 50 420 40 446 46 C466 38 480 36 490 34 L490 88 L300 86 Z";
    let mask = Mask::path(c, hill);
    c.paint_with(&mask, |x, y, _| {
        let leaf = fbm(x / 7.0, y / 4.0, 4, 91);
        (times(mix(rgb(0x4C7F5C), rgb(0x8FB3B4), ramp(480.0, 290.0, x) as f32), (1.0 + 0.45 * leaf) as f32), 1.0)
    });
    let strand = Mask::path(c, "M316 86 C360 82 420 80 490 80 L490 88 L316 87 Z").blur(1.0);
    c.paint(&strand, rgb(0xEAD9B0), 0.9);
    let haze = Mask::from_fn(c, |_, y| ramp(7.0, 0.0, (y - HORIZON).abs()));
    c.paint(&haze, rgb(0xE9EDE6), 0.45);
}

/// One wave breaks a little way out: dark face, bright crest, foam that trails behind it.
fn breaker(c: &mut Canvas, shore: &[f64]) {
    let crest = |x: f64| shore[(x as usize).min(WIDTH - 1)] * 0.55 + 76.0 + 4.0 * noise(x / 34.0, 3.0, 95);
    let strength = |x: f64| ramp(30.0, 130.0, x) * ramp(470.0, 330.0, x);
    let face = Mask::from_fn(c, |x, y| strength(x) * ramp(20.0, 4.0, y - crest(x)) * ramp(-1.0, 3.0, y - crest(x)));
    c.glaze(&face, rgb(0x2F8E92), 0.62);
    let foam = Mask::from_fn(c, |x, y| {
        let d = y - crest(x);
        let rough = fbm(x / 9.0, y / 4.0, 4, 96);
        let top = ramp(-7.0, -2.0, d + 3.0 * rough) * ramp(7.0, 2.0, d + 5.0 * rough);
        strength(x) * top
    });
    c.paint_with(&foam, |x, y, _| (times(rgb(0xFFFFFF), (0.93 + 0.12 * fbm(x / 6.0, y / 3.0, 3, 97)) as f32), 0.96));
    let trail = Mask::from_fn(c, |x, y| {
        let behind = crest(x) - y;
        strength(x) * ramp(34.0, 4.0, behind) * ramp(0.0, 4.0, behind) * lace(x, y, 13.0, 98)
    });
    c.paint(&trail, rgb(0xFFFFFF), 0.55);
}

/// Foam at the water's edge: a bright rim, its shadow on the sand, and lace behind it.
fn waterline(c: &mut Canvas, shore: &[f64]) {
    let edge = |x: f64| shore[(x as usize).min(WIDTH - 1)];
    let shadow = Mask::from_fn(c, |x, y| ramp(6.0, 0.0, y - edge(x)) * ramp(-2.0, 0.5, y - edge(x)));
    c.glaze(&shadow, rgb(0x6B5538), 0.42);
    let veil = Mask::from_fn(c, |x, y| {
        let up = edge(x) - y;
        let fade = ramp(62.0, 6.0, up + 16.0 * noise(x / 40.0, y / 22.0, 99)) * ramp(0.0, 2.0, up);
        fade * lace(x, y, 17.0, 100).max(0.75 * lace(x, y, 8.0, 101) * ramp(30.0, 8.0, up))
    });
    c.paint(&veil, rgb(0xFFFFFF), 0.82);
    let rim = Mask::from_fn(c, |x, y| {
        let up = edge(x) - y + 2.2 * fbm(x / 8.0, y / 6.0, 3, 102);
        ramp(9.5, 5.0, up) * if edge(x) > y { 1.0 } else { ramp(1.0, 0.0, y - edge(x)) }
    });
    c.paint_with(&rim, |x, y, _| {
        let bubble = cells(x / 3.1, y / 2.4, 103).0;
        (times(rgb(0xFFFDF8), (0.90 + 0.14 * bubble.min(0.8)) as f32), 0.95)
    });
}

/// Threads of foam around clear cells, flattened by the view.
fn lace(x: f64, y: f64, size: f64, seed: u32) -> f64 {
    let (u, v) = (x + 6.0 * noise(x / 19.0, y / 12.0, seed), y + 3.0 * noise(x / 15.0, y / 9.0, seed + 1));
    let (first, second) = cells(u / size, v / (size * 0.5), seed);
    ramp(0.22, 0.05, second - first) * ramp(-0.5, 0.2, noise(x / 30.0, y / 18.0, seed + 2))
}

fn pebbles(c: &mut Canvas, shore: &[f64]) {
    let mut chance = Chance::new(12);
    for _ in 0..34 {
        let (x, y) = (chance.within(6.0, 474.0), chance.within(312.0, 356.0));
        if y < shore[x as usize] + 84.0 {
            continue;
        }
        let r = chance.within(1.0, 3.4);
        c.stroke(&Stroke::new((x + 1.2, y + r * 0.5), (r * 1.4, 0.0), 0.0, (r * 1.3, r)), rgb(0x7A6242), 0.45);
        let tone = mix(rgb(0xF7EBDD), rgb(0xA98B70), chance.within(0.0, 1.0) as f32);
        c.stroke(&Stroke::new((x, y), (r * 1.2, -0.3), 0.1, (r * 1.3, r * 0.9)), tone, 0.95);
    }
}
