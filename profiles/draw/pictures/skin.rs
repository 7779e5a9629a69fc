//! Skin, shared by the eye, the wound and the chest: varying color, pores, fine lines and grain.

use super::kit::{Rgb, mix, rgb, times};
use super::noise::{cells, fbm, hash, noise};

/// The texture of skin laid over a color: `scale` 1 for a close-up, smaller from farther away.
pub fn skin(x: f64, y: f64, below: Rgb, scale: f64) -> Rgb {
    let blotch = fbm(x / (46.0 * scale), y / (46.0 * scale), 3, 3);
    let color = mix(below, rgb(0xC9705C), (0.10 * blotch + 0.04).max(0.0) as f32);
    // Skin is a net of fine lines around tiny plates; the lines catch no light.
    let wobble = 1.6 * noise(x / 9.0, y / 9.0, 21);
    let (first, second) = cells((x + wobble) / (5.2 * scale), (y - wobble) / (4.4 * scale), 5);
    let plate = ((second - first) * 2.2).min(1.0);
    let pore = if first < 0.16 && hash((x / 5.0) as i64, (y / 5.0) as i64, 9) > 0.6 { 0.03 } else { 0.0 };
    let grain = hash(x as i64, y as i64, 11) - 0.5;
    times(color, (0.972 + 0.030 * plate - pore + 0.018 * grain + 0.02 * blotch) as f32)
}
