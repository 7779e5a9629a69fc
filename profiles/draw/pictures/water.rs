//! A clip of falling water before dark rock: streaks at two speeds in clumps that fall with them.

use super::kit::{Canvas, mix, ramp, rgb};
use super::noise::fbm;

/// One frame.
pub fn frame(number: usize) -> Canvas {
    let k = number as f64;
    let mut canvas = Canvas::new(120, 176, rgb(0x0b0f12));
    canvas.shade(|x, y, rock| {
        let streaks = |speed: f64, wide: f64, long: f64, seed: u32| {
            let fallen = y - speed * k;
            let bent = x + 1.6 * fbm(fallen / 30.0, x / 60.0, 2, seed);
            0.5 + 0.75 * fbm(bent / wide, fallen / long, 4, seed + 1)
        };
        let clump = ramp(0.2, 0.75, streaks(5.0, 26.0, 60.0, 11));
        let light: f64 = 0.65 * streaks(5.0, 11.0, 34.0, 21) + 0.45 * streaks(6.5, 6.5, 22.0, 31);
        let light = light.clamp(0.0, 1.0);
        let light = light * light.sqrt() * (0.25 + 0.75 * clump);
        mix(rock, rgb(0xf4f9ff), (1.25 * light).min(1.0) as f32)
    });
    canvas
}
