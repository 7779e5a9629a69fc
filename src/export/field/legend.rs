//! The legend of a plot.

use kurbo::{Point, Vec2};

use super::letters;
use super::strokes::{PlotMark, draw_arrow, fill, line, turned};
use crate::base::maths::nice;
use crate::base::oklab::hue;
use crate::base::text::short;

const INK: [u8; 4] = [60, 64, 72, 255];
/// A length of the legend where no round one fits.
const SHORTEST: f64 = 1e-6;

/// The wheel of directions, an arrow of a round length with what it stands for, and a bar for distances in the picture.
pub fn legend(at: Point, stretch: f64, longest: f64, scale: f64, marks: &mut Vec<PlotMark>) {
    let wheel = at + Vec2::new(22.0, 0.0);
    const SPOKES: usize = 24;
    for k in 0..SPOKES {
        let (from, to) = ((k as f64 - 0.53) / SPOKES as f64, (k as f64 + 0.53) / SPOKES as f64);
        let [r, g, b] = hue(k as f64 / SPOKES as f64);
        let ring = [turned(from) * 20.0, turned(to) * 20.0, turned(to) * 10.0, turned(from) * 10.0];
        marks.push(fill(ring.map(|v| wheel + v).to_vec(), [r, g, b, 255]));
    }
    if longest > 0.0 {
        let jump = nice(longest.min(90.0 / stretch)).unwrap_or(SHORTEST);
        let from = at + Vec2::new(66.0, 6.0);
        let vector = Vec2::new(jump * stretch, 0.0);
        draw_arrow(from, vector, 20.0, marks);
        letters::write(&format!("jump {} px", short(jump, 6)), from + Vec2::new(0.0, -12.0), INK, marks);
    }
    let distance = nice(90.0 / scale).unwrap_or(SHORTEST);
    let from = at + Vec2::new(200.0, 6.0);
    let to = from + Vec2::new(distance * scale, 0.0);
    let tick = Vec2::new(0.0, 4.0);
    marks.push(line(vec![from - tick, from + tick], 1.4, INK));
    marks.push(line(vec![to - tick, to + tick], 1.4, INK));
    marks.push(line(vec![from, to], 1.4, INK));
    letters::write(&format!("picture {} px", short(distance, 6)), from + Vec2::new(0.0, -12.0), INK, marks);
}
