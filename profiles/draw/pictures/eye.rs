//! A human eye, close up: the lid above it is drawn whole, because it will slide down over the eyeball.

use kurbo::{ParamCurve, PathSeg, Point, Vec2};
use plica::base::maths::{TAU, atan2, cos, sin};

use super::kit::{Canvas, Mask, Stroke, curve, mix, ramp, rgb, times};
use super::noise::{Chance, fbm, hash, noise};
use super::skin::skin;

const WIDTH: usize = 480;
const HEIGHT: usize = 360;
const OPENING: &str = "M88 212 C150 118 320 108 396 200 C338 250 170 250 88 212 Z";
const UPPER: &str = "M88 212 C150 118 320 108 396 200";
const LOWER: &str = "M88 212 C170 250 338 250 396 200";
const IRIS: (f64, f64) = (243.0, 180.0);
const IRIS_RADIUS: f64 = 57.0;

/// The eye, open.
pub fn eye() -> Canvas {
    let mut c = Canvas::new(WIDTH, HEIGHT, rgb(0xE3B093));
    face(&mut c);
    c.shade(|x, y, below| skin(x, y, below, 1.0));
    brow(&mut c);
    eyeball(&mut c);
    margins(&mut c);
    c
}

/// The upper lashes, foreshortened: they lengthen as the lid comes down.
pub fn lashes() -> Canvas {
    let mut c = Canvas::clear(WIDTH, HEIGHT);
    let upper = curve(UPPER);
    let mut chance = Chance::new(41);
    for i in 0..96 {
        let t = 0.12 + 0.84 * (i as f64 + chance.within(-0.4, 0.4)) / 95.0;
        let root = upper.eval(t) + Vec2::new(0.0, -1.5);
        let length = (4.0 + 5.5 * t) * chance.within(0.7, 1.1) * ramp(0.05, 0.3, t);
        let lean = (t - 0.45) * 14.0 + chance.within(-2.5, 2.5);
        c.stroke(&Stroke::new(root, (lean, length), 0.14 * (0.5 - t), (2.3, 0.5)), rgb(0x20130F), 0.92);
    }
    c
}

fn face(c: &mut Canvas) {
    let soft = |c: &Canvas, svg: &str, blur: f64| Mask::path(c, svg).blur(blur);
    // The nose falls away on the left, the temple on the right; the socket is deep, brow bone and cheek catch light.
    let side = Mask::from_fn(c, |x, y| 0.9 * ramp(120.0, -60.0, x + 0.25 * (y - 180.0)));
    c.glaze(&side, rgb(0xCF9A84), 0.8);
    let temple = Mask::from_fn(c, |x, y| ramp(380.0, 560.0, x + 0.2 * (y - 150.0)));
    c.glaze(&temple, rgb(0xC08A78), 0.7);
    c.light(&soft(c, "M120 64 C220 24 340 30 420 84 C340 66 220 62 120 64 Z", 9.0), rgb(0xF6D3B4), 0.35);
    c.light(&soft(c, "M150 318 C230 292 350 296 450 262 L450 400 L120 400 Z", 26.0), rgb(0xF2C3A0), 0.32);
    c.glaze(
        &soft(
            c,
            "M62 206 C96 96 190 62 300 70 C390 78 428 140 424 214 C380 130 300 104 226 112 C150 120 104 166 62 206 Z",
            10.0,
        ),
        rgb(0xC58A74),
        0.62,
    );
    c.glaze(&soft(c, "M76 214 C150 282 330 290 424 214 C360 310 140 312 76 214 Z", 9.0), rgb(0xBF7F72), 0.42);
    c.glaze(&soft(c, "M60 190 C40 220 50 260 70 292 C86 262 92 232 96 214 Z", 12.0), rgb(0xA9604F), 0.5);
    // The lid itself is a ball under skin: light on its crown, the crease a soft fold above it.
    c.light(&soft(c, "M140 146 C190 96 300 88 362 142 C300 110 190 116 140 146 Z", 5.0), rgb(0xFFE3C8), 0.42);
    crease(c, "M80 196 C134 92 318 74 412 176 C320 92 140 106 80 196 Z", 3.5, 0.5);
    crease(c, "M96 176 C150 78 320 62 404 150 C316 72 156 86 96 176 Z", 4.5, 0.25);
    crease(c, "M100 246 C170 296 320 300 408 234 C330 288 180 286 100 246 Z", 4.0, 0.30);
    crease(c, "M128 274 C190 310 300 314 372 284 C300 306 200 302 128 274 Z", 5.0, 0.18);
}

fn crease(c: &mut Canvas, svg: &str, blur: f64, strength: f64) {
    let fold = Mask::path(c, svg).blur(blur);
    c.glaze(&fold, rgb(0x8A4538), strength);
    let core = Mask::path(c, svg).blur(1.2);
    c.glaze(&core, rgb(0x9A5140), strength * 0.7);
}

fn brow(c: &mut Canvas) {
    let shade = Mask::path(c, "M70 64 C150 4 300 -8 452 58 C340 24 180 30 84 84 Z").blur(6.0);
    c.glaze(&shade, rgb(0x8A5A44), 0.55);
    let mut chance = Chance::new(5);
    for i in 0..620 {
        let t = i as f64 / 620.0;
        let spine = Point::new(74.0 + 372.0 * t, 60.0 - 92.0 * t * (1.0 - t) * 1.35 + 4.0 * t);
        let thick = 15.0 * ramp(-0.05, 0.25, t) * (1.0 - 0.72 * t);
        let root = spine + Vec2::new(chance.within(-4.0, 4.0), chance.within(-1.0, 1.0) * thick);
        let rise = -14.0 * (1.0 - t) * (1.0 - t) + 4.0 * t + chance.within(-2.0, 2.0);
        let by = Vec2::new(8.0 + 10.0 * t + chance.within(-2.0, 5.0), rise);
        let tone = mix(rgb(0x3A2218), rgb(0x6B4630), chance.within(0.0, 1.0) as f32);
        c.stroke(&Stroke::new(root, by, 0.08, (1.5, 0.4)), tone, 0.62);
    }
}

fn eyeball(c: &mut Canvas) {
    let opening = Mask::path(c, OPENING);
    c.paint_with(&opening, |x, y, _| {
        let ball = 1.0 - 0.30 * ramp(60.0, 190.0, (x - 240.0).abs()) - 0.10 * ((y - 180.0) / 60.0).abs();
        let pink = 0.16 * ramp(70.0, 150.0, (x - 240.0).abs()) + 0.03 * fbm(x / 20.0, y / 20.0, 3, 2);
        (times(mix(rgb(0xF4EFE9), rgb(0xD98E80), pink as f32), ball as f32), 1.0)
    });
    veins(c, &opening);
    let iris = Mask::ellipse(c, IRIS, (IRIS_RADIUS, IRIS_RADIUS));
    let soft_iris = iris.clone().blur(1.0).and(&opening);
    c.glaze(
        &Mask::ellipse(c, IRIS, (IRIS_RADIUS + 3.0, IRIS_RADIUS + 3.0)).blur(3.0).and(&opening),
        rgb(0x4A5560),
        0.5,
    );
    c.paint_with(&soft_iris, |x, y, _| (iris_color(x - IRIS.0, y - IRIS.1), 1.0));
    let pupil = Mask::ellipse(c, IRIS, (23.0, 23.0)).blur(1.0).and(&opening);
    c.paint(&pupil, rgb(0x0B0908), 1.0);
    // The lid's shadow on the ball, then reflections: a window, its lower rim, a wet line.
    let lid =
        Mask::path(c, "M60 220 C140 86 330 70 430 200 L396 214 C330 134 150 140 92 224 Z").blur(7.0).and(&opening);
    c.glaze(&lid, rgb(0x5A3B38), 0.72);
    c.light(&Mask::path(c, "M213 150 L234 143 L236 166 L214 171 Z").blur(1.0).and(&opening), rgb(0xFFFFFF), 0.94);
    c.light(&Mask::path(c, "M238 142 L246 140 L247 163 L240 165 Z").blur(1.0).and(&opening), rgb(0xFFFFFF), 0.80);
    c.light(&Mask::ellipse(c, (268.0, 208.0), (13.0, 6.0)).blur(3.0).and(&opening), rgb(0xC8E4F0), 0.42);
    let caruncle = Mask::path(c, "M84 211 C96 198 112 200 118 212 C112 224 98 222 84 211 Z").blur(2.0).and(&opening);
    c.paint(&caruncle, rgb(0xD9897C), 0.85);
    c.light(&Mask::ellipse(c, (103.0, 209.0), (3.0, 1.6)).blur(1.0), rgb(0xFFFFFF), 0.6);
}

fn veins(c: &mut Canvas, opening: &Mask) {
    let mut over = Canvas::clear(WIDTH, HEIGHT);
    let mut chance = Chance::new(77);
    for i in 0..26 {
        let from_left = i % 2 == 0;
        let (x, way) = if from_left { (112.0, 1.0) } else { (386.0, -1.0) };
        let from = Point::new(x + chance.within(-4.0, 10.0), 205.0 + chance.within(-26.0, 22.0));
        let by = Vec2::new(way * chance.within(24.0, 62.0), chance.within(-12.0, 12.0));
        over.stroke(&Stroke::new(from, by, chance.within(-0.25, 0.25), (1.1, 0.3)), rgb(0xC4584E), 0.30);
    }
    c.lay(&over, opening);
}

/// The iris at an offset from its center: fibres around a golden ring, dark at the rim.
fn iris_color(dx: f64, dy: f64) -> [f32; 3] {
    let (r, turn) = ((dx * dx + dy * dy).sqrt() / IRIS_RADIUS, atan2(dy, dx) / TAU);
    let around = |n: f64| (n * cos(turn * TAU), n * sin(turn * TAU));
    let (fx, fy) = around(15.0);
    let fibre = noise(fx + 9.0, fy + r * 1.5, 31) * 0.6 + noise(fx * 2.4, fy * 2.4 + r * 2.2, 32) * 0.5;
    let (gx, gy) = around(2.2);
    let base = mix(rgb(0x2F6F86), rgb(0x7FB7B4), ramp(0.95, 0.45, r + 0.08 * fibre) as f32);
    let ring = ramp(0.66, 0.44, r + 0.07 * fibre + 0.10 * noise(gx, gy, 33));
    let color = mix(base, rgb(0xC08A3C), (0.75 * ring) as f32);
    let rim = ramp(0.80, 1.0, r);
    let lit = 0.80 + 0.28 * fibre + 0.30 * ramp(-20.0, 50.0, dy + 0.3 * dx) - 0.72 * rim;
    times(color, lit.max(0.06) as f32)
}

fn margins(c: &mut Canvas) {
    // The wet rim of the lower lid, then the dark line the upper lashes grow from.
    rim(c, &curve(LOWER), 5.5, rgb(0xE6A998), 0.9, 1.0);
    rim(c, &curve(LOWER), 1.6, rgb(0xB2655A), 0.5, 0.0);
    rim(c, &curve(UPPER), 8.0, rgb(0x4A2A22), 0.35, -1.0);
    rim(c, &curve(UPPER), 4.6, rgb(0x24140F), 0.95, -1.0);
    let (upper, lower) = (curve(UPPER), curve(LOWER));
    let mut chance = Chance::new(8);
    for i in 0..64 {
        let t = 0.30 + 0.67 * i as f64 / 63.0;
        let root = upper.eval(t) + Vec2::new(0.0, -2.0);
        let long = ramp(0.25, 0.9, t) * chance.within(6.0, 11.0);
        let by = Vec2::new(long * (0.2 + 1.1 * t), -long * chance.within(0.3, 0.6));
        c.stroke(&Stroke::new(root, by, -0.22, (1.8, 0.4)), rgb(0x24140F), 0.85);
    }
    for i in 0..52 {
        let t = 0.22 + 0.75 * (i as f64 + chance.within(-0.4, 0.4)) / 51.0;
        let root = lower.eval(t) + Vec2::new(0.0, 5.0);
        let long = chance.within(5.0, 11.0) * ramp(0.1, 0.7, t);
        let by = Vec2::new(long * (t - 0.35) * 1.2, long);
        c.stroke(&Stroke::new(root, by, 0.15, (1.2, 0.3)), rgb(0x3A2119), 0.55);
    }
    let spark = |x: f64| hash((x / 6.0) as i64, 0, 3);
    let wet = Mask::from_fn(c, |x, y| {
        let at = lower.eval(((x - 88.0) / 308.0).clamp(0.0, 1.0));
        if (130.0..370.0).contains(&x) { ramp(1.6, 0.4, (y - at.y - 1.0).abs()) * spark(x) } else { 0.0 }
    });
    c.light(&wet, rgb(0xFFFFFF), 0.45);
}

/// A line of varying width along a lid's edge; `side` -1 puts it above the edge, 1 below, 0 on it.
fn rim(c: &mut Canvas, edge: &PathSeg, width: f64, color: [f32; 3], alpha: f64, side: f64) {
    let pen = |t: f64| width * (0.35 + 0.65 * ramp(0.0, 0.35, t) * (1.0 - 0.35 * ramp(0.75, 1.0, t)));
    for i in 0..90 {
        let (t0, t1) = (f64::from(i) / 90.0, f64::from(i + 1) / 90.0);
        let lift = |t: f64| edge.eval(t) + Vec2::new(0.0, side * pen(t) / 2.0);
        let stroke = Stroke { points: [lift(t0), lift((t0 + t1) / 2.0), lift(t1)], widths: (pen(t0), pen(t1)) };
        c.stroke(&stroke, color, alpha);
    }
}
