//! What is laid on the fish: its skin on both sides, scales that are seen from the side, and their shine.

use kurbo::Vec2;
use plica::base::maths::smoothstep;

use super::kit::{Canvas, Mask, Rgb, mix, ramp, rgb, times};
use super::noise::{fbm, hash};

/// The skin, with the head to the left.
pub fn left() -> Canvas {
    skin(false)
}

/// The skin on the other side.
pub fn right() -> Canvas {
    skin(true)
}

const WIDTH: usize = 224;
const HEIGHT: usize = 104;

fn skin(mirrored: bool) -> Canvas {
    let mut canvas = Canvas::new(WIDTH, HEIGHT, rgb(0x9FB4B8));
    let along = |x: f64| if mirrored { WIDTH as f64 - x } else { x };
    canvas.shade(|x, y, _| {
        let (x, up) = (along(x), 1.0 - y / HEIGHT as f64);
        let back = mix(rgb(0xB9C7C4), rgb(0x24566A), smoothstep(0.5, 0.78, up) as f32);
        let body = mix(rgb(0xEFE3C8), back, smoothstep(0.26, 0.5, up) as f32);
        let fin = mix(body, rgb(0xC2622E), smoothstep(160.0, 182.0, x) as f32);
        let ray = if x > 172.0 { 0.1 * fbm(0.0, (y - 52.0) * 60.0 / (x - 130.0), 2, 4) } else { 0.0 };
        times(fin, (1.0 + 0.05 * fbm(x / 9.0, y / 9.0, 3, 2) + ray) as f32)
    });
    let eye = |canvas: &Canvas, radius: f64| Mask::ellipse(canvas, (along(38.5), 44.5), (radius, radius));
    let gill = Mask::from_fn(&canvas, |x, y| {
        let (x, y) = (along(x) - 40.0, y - 52.0);
        (1.6 - (Vec2::new(x, y).hypot2().sqrt() - 22.0).abs()) * ramp(0.0, 12.0, x)
    });
    canvas.paint(&gill, rgb(0x3A4A50), 0.6);
    for (radius, color) in [(5.0, 0xE8D9A0), (3.4, 0x15191C)] {
        let mask = eye(&canvas, radius);
        canvas.paint(&mask, rgb(color), 1.0);
    }
    let glint = Mask::ellipse(&canvas, (along(38.5) - 1.2, 43.0), (1.1, 1.1));
    canvas.paint(&glint, [1.0; 3], 1.0);
    canvas
}

/// The scale at a place: how far its middle is, from 0 to 1 at its rim, and its place in the rows.
fn scale(x: f64, y: f64, size: f64) -> (f64, [i64; 2]) {
    let row = (y / (0.62 * size)).floor();
    // The scale of the row before lies over this one.
    let of = |row: f64| {
        let shift = if row as i64 % 2 == 0 { 0.0 } else { 0.5 };
        let column = (x / size + shift).floor();
        let middle = ((column - shift + 0.5) * size, (row + 0.2) * 0.62 * size);
        let far = Vec2::new(x - middle.0, y - middle.1).hypot2().sqrt();
        (far / (0.62 * size), [column as i64, row as i64])
    };
    let (over, own) = (of(row - 1.0), of(row));
    if over.0 < 1.0 { over } else { own }
}

/// How much of the body has scales.
fn body(x: f64, y: f64, (width, height): (f64, f64)) -> f64 {
    let (x, y) = (x / width, (y / height - 0.5).abs());
    ramp(0.27, 0.42, x) * ramp(0.72, 0.6, x) * ramp(0.4, 0.3, y)
}

/// Scales along the side. Rows run from the head to the tail.
pub fn scales() -> Canvas {
    drawn((336, 156), |far, place, x| {
        let tone = mix(rgb(0x4E8F9C), rgb(0xD9C27A), hash(place[0], place[1], 3) as f32 * 0.6);
        let rim = smoothstep(0.7, 1.0, far);
        (mix(times(tone, 1.15), rgb(0x1B3C48), rim as f32), 0.55 + 0.45 * rim * ramp(0.0, 60.0, x))
    })
}

/// The light on them, as it is seen from farther in front.
pub fn shine() -> Canvas {
    drawn((224, 104), |far, place, _| {
        let tones = [0xFFF1B8, 0xB8F4FF, 0xFFC9E6];
        let tone = rgb(tones[(hash(place[0], place[1], 7) * 2.99) as usize]);
        (tone, (hash(place[0], place[1], 5) * 1.4 - 0.4).max(0.0) * ramp(1.0, 0.2, far))
    })
}

fn drawn((width, height): (usize, usize), of: impl Fn(f64, [i64; 2], f64) -> (Rgb, f64)) -> Canvas {
    let mut canvas = Canvas::clear(width, height);
    let (whole, size) = ((width as f64, height as f64), width as f64 / 30.0);
    let mask = Mask::from_fn(&canvas, |x, y| body(x, y, whole));
    canvas.paint_with(&mask, |x, y, _| {
        // Scales hang to the tail: what are rows of them are columns of the picture.
        let (far, place) = scale(y, whole.0 - x, size);
        of(far, place, x)
    });
    canvas
}
