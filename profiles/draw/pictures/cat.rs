//! A tabby's face, hair by hair: each points away from the nose and takes its color from the coat beneath.

use kurbo::{ParamCurve, Point, Vec2};
use plica::base::maths::{atan2, cos};

use super::kit::{Canvas, Mask, Rgb, Stroke, curve, mix, path, ramp, rgb, times};
use super::noise::{Chance, fbm, noise};

const WIDTH: usize = 480;
const HEIGHT: usize = 400;
const MIDDLE: f64 = 240.0;
const HEAD: &str = "M240 74 C300 72 352 92 384 134 C410 170 420 214 412 250 C402 300 352 348 292 364 C270 374 210 374 188 364 \
    C128 348 78 300 68 250 C60 214 70 170 96 134 C128 92 180 72 240 74 Z";
const EAR: &str = "M92 150 C78 96 76 50 88 16 C128 30 172 60 204 88 C170 100 120 120 92 150 Z";
const EAR_INSIDE: &str = "M106 128 C96 92 94 62 98 40 C126 52 152 70 174 90 C148 98 122 110 106 128 Z";
const EYE: &str = "M128 186 C138 150 194 146 210 208 C184 228 142 222 128 186 Z";
const UPPER: &str = "M128 186 C138 150 194 146 210 208";
const LOWER: &str = "M128 186 C142 222 184 228 210 208";
const IRIS: (f64, f64) = (170.0, 187.0);

/// The face, eyes wide open.
pub fn cat() -> Canvas {
    let mut c = Canvas::new(WIDTH, HEIGHT, rgb(0xFFFFFF));
    c.shade(|x, y, _| room(x, y));
    chest(&mut c);
    for side in [1.0, -1.0] {
        ear(&mut c, side);
    }
    head(&mut c);
    for side in [1.0, -1.0] {
        eye(&mut c, side);
    }
    muzzle(&mut c);
    whiskers(&mut c);
    c
}

/// The shape for the other side of the face where `side` is -1.
fn sided(svg: &str, side: f64) -> kurbo::BezPath {
    kurbo::Affine::new([side, 0.0, 0.0, 1.0, MIDDLE * (1.0 - side), 0.0]) * path(svg)
}

fn across(p: Point, side: f64) -> Point {
    Point::new(MIDDLE + (p.x - MIDDLE) * side, p.y)
}

fn room(x: f64, y: f64) -> Rgb {
    let warm = mix(
        rgb(0x39474A),
        rgb(0xA8A489),
        ramp(420.0, 40.0, ((x - 380.0) * (x - 380.0) + (y - 90.0) * (y - 90.0)).sqrt()) as f32,
    );
    let soft = fbm(x / 150.0 + 1.0, y / 120.0, 3, 11);
    times(warm, (0.95 + 0.28 * soft) as f32)
}

/// The color of the coat: ginger, pale round mouth and eyes, with a tabby's stripes.
fn coat(p: Point) -> Rgb {
    let (x, y) = ((p.x - MIDDLE).abs(), p.y);
    let wander = noise(p.x / 24.0, y / 24.0, 17);
    let mut color = mix(rgb(0xC97F3E), rgb(0xE2A866), (0.5 + 0.5 * fbm(p.x / 40.0, y / 40.0, 3, 18)) as f32);
    let oval =
        |cx: f64, cy: f64, rx: f64, ry: f64| ((x - cx) * (x - cx) / (rx * rx) + (y - cy) * (y - cy) / (ry * ry)).sqrt();
    let pale = ramp(1.15, 0.75, oval(26.0, 302.0, 54.0, 44.0)).max(ramp(1.1, 0.6, oval(0.0, 350.0, 90.0, 36.0)));
    let bridge = 0.55 * ramp(26.0, 8.0, x + 3.0 * wander) * ramp(150.0, 200.0, y) * ramp(280.0, 240.0, y);
    let around_eye = 0.7 * ramp(1.35, 1.0, oval(70.0, 188.0, 50.0, 42.0));
    // The M of the forehead, bars across the cheeks.
    let brow = ramp(0.25, 0.75, cos((x + 5.0 * wander + 0.10 * (y - 80.0)) / 5.4))
        * ramp(172.0, 130.0, y)
        * ramp(96.0, 70.0, x);
    let bar = ramp(0.35, 0.8, cos((y - 0.45 * x + 9.0 * wander) / 6.6))
        * ramp(92.0, 126.0, x)
        * ramp(160.0, 200.0, y)
        * ramp(330.0, 290.0, y);
    let side =
        ramp(0.3, 0.8, cos((x * 0.8 - y * 0.5 + 8.0 * wander) / 7.5)) * ramp(84.0, 104.0, x) * ramp(190.0, 150.0, y);
    let liner = ramp(5.5, 1.5, (y - 206.0 - (x - 112.0) * -0.30 + 4.0 * wander).abs())
        * ramp(108.0, 118.0, x)
        * ramp(172.0, 150.0, x);
    color = mix(color, rgb(0x7A3F1C), (0.78 * brow.max(bar).max(side).max(liner)) as f32);
    color = mix(color, rgb(0xF3D2A2), bridge as f32);
    color = mix(color, rgb(0xF6DDB8), around_eye as f32);
    color = mix(color, rgb(0xFBF1E2), pale as f32);
    shadow(p, color)
}

/// Shape: light from the upper right; the cheeks turn away, the eyes are in hollows.
fn shadow(p: Point, color: Rgb) -> Rgb {
    let (dx, dy) = ((p.x - 262.0) / 190.0, (p.y - 190.0) / 180.0);
    let round = 1.08 - 0.36 * ramp(0.35, 1.05, (dx * dx + dy * dy).sqrt());
    let x = (p.x - MIDDLE).abs();
    let socket = 1.0
        - 0.16
            * ramp(22.0, 6.0, (x - 36.0 + 0.1 * (p.y - 200.0)).abs())
            * ramp(160.0, 190.0, p.y)
            * ramp(262.0, 230.0, p.y);
    let jaw = 1.0 - 0.30 * ramp(318.0, 372.0, p.y);
    times(color, (round * socket * jaw) as f32)
}

/// Hairs rooted in a shape, the farthest from `source` first, each pointing away from it.
struct Fur<'a> {
    roots: &'a Mask,
    source: Point,
    count: usize,
    length: (f64, f64),
    seed: u32,
}

fn fur(c: &mut Canvas, fur: &Fur, color: impl Fn(Point) -> Rgb) {
    let mut chance = Chance::new(fur.seed);
    let mut roots: Vec<Point> = (0..fur.count)
        .map(|_| Point::new(chance.within(0.0, WIDTH as f64), chance.within(0.0, HEIGHT as f64)))
        .filter(|&p| fur.roots.at(p) > 0.5)
        .collect();
    let far = |p: &Point| (*p - fur.source).hypot2();
    roots.sort_by(|a, b| far(b).total_cmp(&far(a)));
    for root in roots {
        let away = root - fur.source;
        let distance = away.hypot2().sqrt().max(1.0);
        let turn = 0.55 * noise(root.x / 30.0, root.y / 30.0, fur.seed + 1) + chance.within(-0.22, 0.22);
        let way = away / distance + Vec2::new(-away.y, away.x) / distance * turn;
        let length = fur.length.0 + (fur.length.1 - fur.length.0) * ramp(20.0, 190.0, distance);
        let tone = times(color(root), chance.within(0.80, 1.17) as f32);
        let by = way * length * chance.within(0.7, 1.2);
        c.stroke(&Stroke::new(root, by, chance.within(-0.15, 0.15), (1.7, 0.35)), tone, 0.75);
    }
}

fn chest(c: &mut Canvas) {
    let body = Mask::path(c, "M70 410 C80 340 130 300 240 300 C350 300 400 340 414 410 Z");
    let tone =
        |p: Point| times(mix(rgb(0xB8743A), rgb(0xF3E6D2), ramp(110.0, 50.0, (p.x - MIDDLE).abs()) as f32), 0.74);
    c.paint_with(&body.clone().blur(3.0), |x, y, _| (tone(Point::new(x, y)), 1.0));
    fur(c, &Fur { roots: &body, source: Point::new(240.0, 160.0), count: 5200, length: (16.0, 24.0), seed: 301 }, tone);
    let under = Mask::bez(c, &path(HEAD)).blur(14.0);
    c.glaze(&under, rgb(0x5A3A2A), 0.75);
}

fn ear(c: &mut Canvas, side: f64) {
    let outer = Mask::bez(c, &sided(EAR, side));
    let inner = Mask::bez(c, &sided(EAR_INSIDE, side));
    let tone = |p: Point| times(mix(rgb(0x9A5526), rgb(0xC98245), ramp(20.0, 130.0, p.y) as f32), 0.95);
    c.paint_with(&outer, |x, y, _| (tone(Point::new(x, y)), 1.0));
    let source = across(Point::new(160.0, 190.0), side);
    fur(c, &Fur { roots: &outer, source, count: 7000, length: (6.0, 9.0), seed: 311 }, tone);
    let soft = inner.clone().blur(3.0);
    c.paint_with(&soft, |_, y, _| (mix(rgb(0xE8A79A), rgb(0x8A4A44), ramp(50.0, 130.0, y) as f32), 0.92));
    let base = across(Point::new(168.0, 112.0), side);
    let mut chance = Chance::new(317);
    for _ in 0..150 {
        let root = across(Point::new(chance.within(112.0, 186.0), chance.within(92.0, 136.0)), side);
        let up = Vec2::new((root.x - base.x) * 0.25 - side * chance.within(2.0, 18.0), -chance.within(18.0, 46.0));
        c.stroke(&Stroke::new(root, up, side * 0.12, (1.4, 0.3)), rgb(0xF7E6CC), 0.55);
    }
}

fn head(c: &mut Canvas) {
    let head = Mask::bez(c, &path(HEAD));
    c.paint_with(&head.clone().blur(2.0), |x, y, _| (coat(Point::new(x, y)), 1.0));
    fur(c, &Fur { roots: &head, source: Point::new(240.0, 246.0), count: 26000, length: (4.5, 15.0), seed: 331 }, coat);
}

fn eye(c: &mut Canvas, side: f64) {
    let opening = Mask::bez(c, &sided(EYE, side));
    // The dark rim of the lids, widest at the inner corner where it runs down to the nose.
    c.paint(&opening.clone().blur(4.0), rgb(0x2A160E), 0.55);
    for (edge, lift) in [(UPPER, -1.8), (LOWER, 1.5)] {
        lid(c, edge, side, lift, rgb(0x1C0E0A));
    }
    let duct = Stroke::new(across(Point::new(208.0, 205.0), side), (side * 9.0, 13.0), side * -0.2, (6.0, 0.8));
    c.stroke(&duct, rgb(0x2A160E), 0.85);
    let at = across(Point::new(IRIS.0, IRIS.1), side);
    c.paint_with(&opening, |x, y, _| (iris(x - at.x, y - at.y, side), 1.0));
    let slit = Mask::ellipse(c, (at.x, at.y), (9.5, 29.0)).blur(1.0).and(&opening);
    c.paint(&slit, rgb(0x070605), 1.0);
    let brow = Mask::bez(c, &sided("M120 196 C130 132 204 130 218 214 L208 206 C190 158 144 162 130 190 Z", side))
        .blur(5.0)
        .and(&opening);
    c.glaze(&brow, rgb(0x3A2A10), 0.75);
    let window = Mask::path(c, &format!("M{} 170 l13 -4 l1 14 l-13 3 Z", at.x - 17.0)).blur(1.0).and(&opening);
    c.light(&window, rgb(0xFFFFFF), 0.95);
    c.light(&Mask::ellipse(c, (at.x + 14.0, at.y + 16.0), (9.0, 4.5)).blur(2.0).and(&opening), rgb(0xD8F0E0), 0.40);
}

fn lid(c: &mut Canvas, edge: &str, side: f64, lift: f64, color: Rgb) {
    let edge = curve(edge);
    let at = |t: f64| across(edge.eval(t) + Vec2::new(0.0, lift), side);
    for i in 0..60 {
        let (t0, t1) = (f64::from(i) / 60.0, f64::from(i + 1) / 60.0);
        let width = |t: f64| 3.4 + 1.6 * t;
        c.stroke(
            &Stroke { points: [at(t0), at((t0 + t1) / 2.0), at(t1)], widths: (width(t0), width(t1)) },
            color,
            0.92,
        );
    }
}

fn iris(dx: f64, dy: f64, side: f64) -> Rgb {
    let r = (dx * dx + dy * dy).sqrt() / 40.0;
    let turn = atan2(dy, dx * side);
    let fibre = noise(turn * 9.0 + 40.0, r * 3.0, 351) * 0.6 + noise(turn * 21.0 + 90.0, r * 5.0, 352) * 0.4;
    let inner = mix(rgb(0xD9C24A), rgb(0x7FA64A), ramp(0.25, 0.85, r + 0.10 * fibre) as f32);
    let lit = 0.82 + 0.20 * fibre + 0.34 * ramp(-18.0, 30.0, dy + 0.2 * dx) - 0.55 * ramp(0.78, 1.05, r);
    times(inner, lit.max(0.08) as f32)
}

fn muzzle(c: &mut Canvas) {
    // The two pads of the upper lip cast a soft shade; the nose is a wet, rounded heart.
    let seam = Mask::path(
        c,
        "M238 284 L242 284 L242 306 C252 322 276 324 294 312 C278 332 250 330 240 314 C230 330 202 332 186 312 C204 324 228 322 238 306 Z",
    );
    c.glaze(&seam.clone().blur(5.0), rgb(0x6A3A2A), 0.75);
    c.paint(&seam.blur(1.0), rgb(0x4A2018), 0.80);
    c.glaze(
        &Mask::path(c, "M206 330 C226 346 254 346 274 330 C262 352 218 352 206 330 Z").blur(4.0),
        rgb(0x7A4A3A),
        0.55,
    );
    let nose = Mask::path(
        c,
        "M216 260 C222 252 234 250 240 250 C246 250 258 252 264 260 C268 268 254 276 246 286 C243 289 237 289 234 286 C226 276 212 268 216 260 Z",
    );
    c.glaze(&nose.clone().blur(4.0), rgb(0x6A2E22), 0.6);
    c.paint_with(&nose, |x, y, _| {
        let grain = fbm(x / 2.4, y / 2.4, 2, 361);
        (times(mix(rgb(0xE8978A), rgb(0xA84A48), ramp(254.0, 288.0, y) as f32), (1.0 + 0.10 * grain) as f32), 1.0)
    });
    for side in [1.0, -1.0] {
        let nostril =
            Mask::bez(c, &sided("M220 266 C224 262 231 264 233 271 C228 272 222 271 220 266 Z", side)).blur(1.0);
        c.paint(&nostril, rgb(0x3A1014), 0.9);
    }
    c.light(
        &Mask::path(c, "M226 256 C234 253 246 253 252 256 C246 259 234 259 226 256 Z").blur(1.0),
        rgb(0xFFE8E0),
        0.65,
    );
    let mut chance = Chance::new(367);
    for _ in 0..14 {
        for side in [1.0, -1.0] {
            let p = across(Point::new(chance.within(186.0, 222.0), chance.within(284.0, 308.0)), side);
            c.stroke(&Stroke::new(p, (0.6, 0.2), 0.0, (1.7, 1.4)), rgb(0x5A2E1E), 0.6);
        }
    }
}

fn whiskers(c: &mut Canvas) {
    let mut chance = Chance::new(373);
    for side in [1.0, -1.0] {
        for i in 0..11 {
            let root = across(Point::new(chance.within(188.0, 218.0), 286.0 + 2.2 * f64::from(i)), side);
            let by =
                Vec2::new(-side * chance.within(100.0, 165.0), -34.0 + 9.0 * f64::from(i) + chance.within(-8.0, 8.0));
            c.stroke(&Stroke::new(root, by, side * chance.within(0.06, 0.2), (1.5, 0.3)), rgb(0xFFFAF0), 0.85);
        }
        for i in 0..3 {
            let root = across(Point::new(160.0 + 10.0 * f64::from(i), 138.0), side);
            let by = Vec2::new(-side * chance.within(20.0, 44.0), -chance.within(46.0, 70.0));
            c.stroke(&Stroke::new(root, by, side * 0.15, (1.2, 0.3)), rgb(0xFFFAF0), 0.7);
        }
    }
}
