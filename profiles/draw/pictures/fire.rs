//! A clip of a fire against black: heat that rises, torn at its edges.

use plica::base::maths::powi;

use super::kit::{Canvas, Rgb, mix, rgb};
use super::noise::fbm;

/// Colors by heat, from 0 to 1.
const HEAT: [u32; 5] = [0x000000, 0x5a1004, 0xd8480c, 0xffb43c, 0xfff3c0];

fn color(heat: f64) -> Rgb {
    let place = heat.clamp(0.0, 1.0) * 3.999;
    let i = place as usize;
    mix(rgb(HEAT[i]), rgb(HEAT[i + 1]), (place - i as f64) as f32)
}

/// One frame.
pub fn frame(number: usize) -> Canvas {
    let k = number as f64;
    let (width, height) = (120.0, 176.0);
    let mut canvas = Canvas::new(width as usize, height as usize, rgb(0x000000));
    canvas.shade(|x, y, _| {
        let risen = y + 4.5 * k;
        let up = 1.0 - y / height;
        let sway = 16.0 * up * fbm(0.3, risen / 70.0, 2, 41);
        let aside = (x - width / 2.0 + sway) / (width * (0.42 - 0.3 * up * up.sqrt()));
        let torn = fbm((x + sway) / 17.0, risen / 30.0, 4, 43) + 0.5 * fbm(x / 7.0, (y + 6.0 * k) / 14.0, 3, 47);
        let heat = 1.15 - aside * aside - 0.75 * up + (0.35 + 0.9 * up) * torn;
        // Nothing leaves the picture.
        color(heat * (1.0 - powi(2.0 * (x / width - 0.5), 6)) * (5.0 * (1.0 - up)).min(1.0) - 0.12)
    });
    canvas
}
