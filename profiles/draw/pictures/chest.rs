//! A bare chest from the front, lit from the upper left: two broad muscles that will bounce.

use kurbo::{Point, Vec2};

use super::kit::{Canvas, Mask, Stroke, mix, ramp, rgb, times};
use super::noise::{Chance, fbm};
use super::skin::skin;

const WIDTH: usize = 480;
const HEIGHT: usize = 360;
const TORSO: &str = "M196 -10 C196 26 190 40 160 50 C110 62 60 58 -10 84 L-10 216 C30 206 62 196 84 206 \
    C96 250 108 290 112 380 L368 380 C372 290 384 250 396 206 C418 196 450 206 490 216 L490 84 \
    C420 58 370 62 320 50 C290 40 284 26 284 -10 Z";

/// The chest at rest.
pub fn chest() -> Canvas {
    let mut c = Canvas::new(WIDTH, HEIGHT, rgb(0x35505E));
    c.shade(|x, y, _| {
        let glow = ramp(330.0, 20.0, ((x - 250.0) * (x - 250.0) + (y - 130.0) * (y - 130.0)).sqrt());
        let brush = fbm(x / 70.0 + y / 160.0, y / 40.0, 4, 51);
        times(mix(rgb(0x22343F), rgb(0x6B8C93), glow as f32), (1.0 + 0.12 * brush) as f32)
    });
    let mut body = Canvas::new(WIDTH, HEIGHT, rgb(0xDFA27E));
    model(&mut body);
    body.shade(|x, y, below| skin(x, y, below, 0.62));
    details(&mut body);
    let torso = Mask::path(&c, TORSO);
    let shadow = torso.clone().blur(9.0);
    c.glaze(&shadow, rgb(0x16242C), 0.8);
    c.lay(&body, &torso);
    c
}

fn model(c: &mut Canvas) {
    let soft = |c: &Canvas, svg: &str, blur: f64| Mask::path(c, svg).blur(blur);
    let both = |svg: &str| format!("{svg} {}", mirrored(svg));
    // Away from the light first: the far flank, under the arms, the neck's shade.
    c.glaze(&Mask::from_fn(c, |x, y| ramp(250.0, 470.0, x + 0.15 * y)), rgb(0x9A5F50), 0.75);
    c.glaze(&soft(c, TORSO_RIM, 12.0), rgb(0x6E3B34), 0.85);
    c.glaze(&soft(c, "M200 -10 C206 30 226 44 240 46 C254 44 274 30 280 -10 Z", 9.0), rgb(0x8F5546), 0.6);
    c.glaze(&soft(c, &both("M78 196 C70 160 92 120 120 96 C104 130 100 166 112 214 Z"), 9.0), rgb(0x8A4A3C), 0.75);
    // The muscles: their lower edge in shade, a fall of light over the top, the hollow between them.
    c.glaze(&soft(c, &both("M112 184 C124 216 160 236 200 226 C222 220 234 208 238 192 C238 226 214 246 180 246 C142 246 116 224 112 184 Z"), 5.0), rgb(0x7A3B30), 0.80);
    c.glaze(&soft(c, &both("M106 190 C126 232 170 252 236 224 C226 262 130 266 106 190 Z"), 13.0), rgb(0x8F4E40), 0.55);
    c.glaze(&soft(c, "M234 92 C238 140 237 180 230 214 L250 214 C243 180 242 140 246 92 Z", 5.0), rgb(0x8A4838), 0.70);
    c.light(
        &soft(c, &both("M118 150 C120 108 168 86 224 100 C232 134 230 166 218 190 C190 214 126 206 118 150 Z"), 17.0),
        rgb(0xE8B793),
        0.40,
    );
    c.light(&soft(c, "M136 128 C150 106 186 100 208 112 C200 138 158 152 136 128 Z", 10.0), rgb(0xFFE7D0), 0.55);
    c.light(&soft(c, "M268 116 C288 100 322 104 338 124 C318 142 284 140 268 116 Z", 10.0), rgb(0xFFDFC6), 0.34);
    // Collar bones, the notch of the neck, the front of the shoulders.
    c.light(&soft(c, &both("M232 62 C200 58 160 64 112 78 C160 74 204 70 232 70 Z"), 2.6), rgb(0xFFE3CB), 0.55);
    c.glaze(&soft(c, &both("M230 74 C196 72 160 78 120 90 C160 92 206 88 232 84 Z"), 5.0), rgb(0x8F5040), 0.55);
    c.glaze(&soft(c, "M228 52 C234 66 246 66 252 52 C250 76 230 76 228 52 Z", 3.0), rgb(0x7E4335), 0.7);
    c.light(&soft(c, "M16 92 C44 78 84 74 108 88 C88 120 40 128 12 130 Z", 12.0), rgb(0xFFE0C6), 0.45);
    c.light(&soft(c, "M372 88 C400 76 440 84 470 96 L470 126 C430 126 392 116 372 88 Z", 12.0), rgb(0xF6CFB2), 0.28);
    // The belly: the arch of the ribs and the row of muscle below.
    c.glaze(&soft(c, &both("M236 244 C212 262 176 290 158 340 C150 300 176 256 236 238 Z"), 8.0), rgb(0x94543F), 0.42);
    c.glaze(&soft(c, "M237 236 L243 236 L245 380 L235 380 Z", 4.0), rgb(0x8A4838), 0.6);
    for (y, strength) in [(292.0, 0.45), (340.0, 0.38)] {
        let row = format!(
            "M186 {y} C206 {} 226 {} 240 {} C254 {} 274 {} 294 {y} C270 {} 210 {} 186 {y} Z",
            y + 7.0,
            y + 8.0,
            y + 4.0,
            y + 8.0,
            y + 7.0,
            y + 15.0,
            y + 15.0
        );
        c.glaze(&soft(c, &row, 4.0), rgb(0x8A4838), strength);
    }
    c.light(&soft(c, "M198 262 C212 256 226 258 232 264 L232 284 C218 290 204 288 196 282 Z M198 308 C212 302 226 304 232 310 L232 330 C218 336 204 334 196 328 Z", 7.0), rgb(0xF8D2B2), 0.35);
    c.light(&soft(c, "M248 264 C260 258 274 258 282 264 L282 284 C268 290 256 288 248 282 Z M248 310 C260 304 274 304 282 310 L282 330 C268 336 256 334 248 328 Z", 7.0), rgb(0xF3C8A8), 0.22);
}

const TORSO_RIM: &str = "M84 206 C96 250 108 290 112 380 L126 380 C122 290 112 250 100 204 Z \
    M368 380 C372 290 384 250 396 206 L376 204 C364 250 352 290 350 380 Z \
    M-10 190 C30 186 62 180 90 190 L84 210 C62 196 30 206 -10 218 Z \
    M490 190 C450 186 418 180 390 190 L396 210 C418 196 450 206 490 218 Z";

/// The path mirrored about the middle of the body.
fn mirrored(svg: &str) -> String {
    (kurbo::Affine::new([-1.0, 0.0, 0.0, 1.0, 480.0, 0.0]) * super::kit::path(svg)).to_svg()
}

fn details(c: &mut Canvas) {
    for x in [152.0, 328.0] {
        let at = (x, 196.0);
        c.paint(&Mask::ellipse(c, at, (11.0, 8.0)).blur(2.0), rgb(0xA05C4C), 0.80);
        c.paint(&Mask::ellipse(c, at, (4.4, 3.8)).blur(1.0), rgb(0x8A4438), 0.85);
        c.light(&Mask::ellipse(c, (x - 1.5, 194.0), (1.6, 1.2)).blur(1.0), rgb(0xFFDCCB), 0.6);
        c.glaze(&Mask::ellipse(c, (x + 1.0, 200.0), (5.0, 2.0)).blur(1.0), rgb(0x6A3028), 0.5);
    }
    let mut chance = Chance::new(61);
    for _ in 0..210 {
        let (u, v) = (chance.within(-1.0, 1.0), chance.within(0.0, 1.0));
        let root = Point::new(240.0 + u * u * u * 74.0 + u * 8.0, 118.0 + v * 116.0);
        let by = Vec2::new(-u * 9.0 + chance.within(-3.0, 3.0), chance.within(4.0, 10.0));
        c.stroke(&Stroke::new(root, by, chance.within(-0.4, 0.4), (0.9, 0.3)), rgb(0x4A2A1E), 0.34);
    }
}
