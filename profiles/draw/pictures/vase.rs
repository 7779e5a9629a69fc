//! What is laid on the vase: its clay, its mouth, flowers for whoever stands near, and dots for whoever stands far.

use kurbo::Vec2;
use plica::base::maths::{TAU, atan2, cos, sin, smoothstep};

use super::kit::{Canvas, Mask, Stroke, mix, rgb, times};
use super::noise::fbm;

/// The clay as it is seen from a side: the same from all sides but for its grain.
pub fn clay() -> Canvas {
    let mut canvas = Canvas::new(112, 112, rgb(0xC9825A));
    canvas.shade(|x, y, clay| {
        let up = 1.0 - y / 112.0;
        let shade = 0.72 + 0.4 * smoothstep(0.05, 0.75, up) - 0.12 * smoothstep(0.72, 0.82, up);
        let groove = 0.02 * sin(TAU * y / 5.0) + 0.03 * fbm(x / 16.0, y / 3.5, 3, 8);
        times(mix(clay, rgb(0xE0A070), (0.5 * up) as f32), (shade + groove) as f32)
    });
    canvas
}

/// The mouth from above: the lip, and the dark in it.
pub fn mouth() -> Canvas {
    let mut canvas = Canvas::clear(96, 96);
    let disc = |radius: f64| Mask::ellipse(&canvas, (48.0, 48.0), (radius, radius));
    let (lip, dark, deep) = (disc(26.0), disc(22.0), disc(15.0));
    canvas.paint(&lip, rgb(0xD9966A), 1.0);
    canvas.paint(&dark, rgb(0x4A2A1C), 1.0);
    canvas.paint(&deep.blur(5.0), rgb(0x1E100A), 1.0);
    canvas
}

/// Where the flowers are, in pixels of their picture, and their radii.
const FLOWERS: [(f64, f64, f64); 8] = [
    (120.0, 130.0, 27.0),
    (83.0, 120.0, 16.0),
    (157.0, 119.0, 16.0),
    (92.0, 174.0, 17.0),
    (148.0, 176.0, 17.0),
    (113.0, 84.0, 12.0),
    (126.0, 60.0, 8.0),
    (166.0, 152.0, 9.0),
];

/// Flowers with their tendrils, near.
pub fn flowers() -> Canvas {
    const TURN: f64 = TAU / 5.0;
    let mut canvas = Canvas::clear(240, 240);
    for pair in FLOWERS.windows(2) {
        let (from, to) = (Vec2::new(pair[0].0, pair[0].1), Vec2::new(pair[1].0, pair[1].1));
        canvas.stroke(&Stroke::new(from.to_point(), to - from, 0.28, (3.0, 1.4)), rgb(0x2F5D3A), 1.0);
        let middle = from.lerp(to, 0.5);
        for turn in [0.0, 2.2] {
            let by = Vec2::new(cos(turn + from.x), sin(turn + from.x)) * 13.0;
            canvas.stroke(&Stroke::new(middle.to_point(), by, 0.2, (5.0, 0.6)), rgb(0x3F7A4A), 1.0);
        }
    }
    for (number, (x, y, radius)) in FLOWERS.into_iter().enumerate() {
        let polar = |px: f64, py: f64| {
            (Vec2::new(px - x, py - y).hypot2().sqrt() / radius, atan2(py - y, px - x) + number as f64)
        };
        let petals = Mask::from_fn(&canvas, |px, py| {
            let (far, angle) = polar(px, py);
            (0.68 + 0.3 * cos(5.0 * angle) - far) * radius + 0.5
        });
        let [outer, inner] = if number % 3 == 1 { [0x3B5FB5, 0x9DB8F2] } else { [0xF4EFE2, 0xE2B7B7] };
        canvas.paint_with(&petals, |px, py, _| {
            let (far, angle) = polar(px, py);
            let vein = 0.06 * cos(25.0 * angle) as f32;
            (times(mix(rgb(inner), rgb(outer), (1.5 * far) as f32), 1.0 + vein), 1.0)
        });
        for petal in 0..5 {
            let angle = TURN * f64::from(petal) - number as f64;
            let by = Vec2::new(cos(angle), sin(angle)) * radius * 0.55;
            canvas.stroke(&Stroke::new((x, y), by, 0.0, (1.2, 0.3)), rgb(0x7A5C50), 0.6);
        }
        let heart = Mask::ellipse(&canvas, (x, y), (radius * 0.2, radius * 0.2));
        canvas.paint(&heart, rgb(0xE3A92B), 1.0);
    }
    canvas
}

/// The same flowers from afar: only dots.
pub fn dots() -> Canvas {
    let mut canvas = Canvas::clear(64, 64);
    for (number, (x, y, radius)) in FLOWERS.into_iter().enumerate().filter(|(_, flower)| flower.2 > 12.0) {
        // From so far the vase is seen as in the middle of the other picture.
        let place = |at: f64| 32.0 + (at - 120.0) * 0.222;
        let disc = Mask::ellipse(&canvas, (place(x), place(y)), (radius * 0.19, radius * 0.19));
        canvas.paint(&disc, rgb(if number % 3 == 1 { 0x3B5FB5 } else { 0xF4EFE2 }), 1.0);
    }
    canvas
}
