//! The legend of a plot.

use kurbo::{Point, Vec2};

use super::letters;
use super::strokes::{PlotMark, draw_arrow, fill, line, turned};
use crate::base::maths::nice;
use crate::base::oklab::hue;
use crate::base::text::short;
use crate::layers::parts::marks::{Legend, View};
use crate::render::overlay::overlays;

const INK: [u8; 4] = [60, 64, 72, 255];
/// A length of the legend where no round one fits.
const SHORTEST: f64 = 1e-6;
/// Width of a scale of colors, and where the arrow and the distance begin.
const SCALE: f64 = 110.0;
const JUMP: f64 = 132.0;
const DISTANCE: f64 = 250.0;

/// What colors tell, an arrow of a round length with what it stands for, and a bar for distances in the picture, at so many
/// pixels of the plot a pixel of it.
pub fn legend(at: Point, view: &View, scale: f64, marks: &mut Vec<PlotMark>) {
    colors(at, view, marks);
    let stretch = view.arrow_scale() * scale;
    let has_arrows = overlays().any(|overlay| overlay.legend == Some(Legend::Arrows) && view.shows(overlay.name));
    if has_arrows && !view.vectors.equal && view.reach.longest_px > 0.0 {
        let jump = nice(view.reach.longest_px.min(90.0 / stretch)).unwrap_or(SHORTEST);
        let from = at + Vec2::new(JUMP, 6.0);
        draw_arrow(from, Vec2::new(jump * stretch, 0.0), (20.0, INK), marks);
        letters::write(&format!("jump {} px", short(jump, 6)), from + Vec2::new(0.0, -12.0), INK, marks);
    }
    let distance = nice(90.0 / scale).unwrap_or(SHORTEST);
    let from = at + Vec2::new(DISTANCE, 6.0);
    let to = from + Vec2::new(distance * scale, 0.0);
    let tick = Vec2::new(0.0, 4.0);
    marks.push(line(vec![from - tick, from + tick], 1.4, INK));
    marks.push(line(vec![to - tick, to + tick], 1.4, INK));
    marks.push(line(vec![from, to], 1.4, INK));
    letters::write(&format!("picture {} px", short(distance, 6)), from + Vec2::new(0.0, -12.0), INK, marks);
}

/// The wheel of directions, or a scale with its ends below and what it tells above.
fn colors(at: Point, view: &View, marks: &mut Vec<PlotMark>) {
    const STEPS: usize = 24;
    let Some((color, ends)) = view.vectors.scale(view.reach) else {
        let wheel = at + Vec2::new(22.0, 0.0);
        for k in 0..STEPS {
            let (from, to) = ((k as f64 - 0.53) / STEPS as f64, (k as f64 + 0.53) / STEPS as f64);
            let [r, g, b] = hue(k as f64 / STEPS as f64);
            let ring = [turned(from) * 20.0, turned(to) * 20.0, turned(to) * 10.0, turned(from) * 10.0];
            marks.push(fill(ring.map(|v| wheel + v).to_vec(), [r, g, b, 255]));
        }
        return;
    };
    let step = SCALE / STEPS as f64;
    for k in 0..STEPS {
        let [r, g, b] = color((k as f64 + 0.5) / STEPS as f64);
        let place = |i: usize, y: f64| at + Vec2::new(step * i as f64, y);
        marks.push(fill(vec![place(k, -4.0), place(k + 1, -4.0), place(k + 1, 4.0), place(k, 4.0)], [r, g, b, 255]));
    }
    letters::write(view.vectors.color.name(), at + Vec2::new(0.0, -10.0), INK, marks);
    let [least, most] = ends;
    letters::write(&least, at + Vec2::new(0.0, 18.0), INK, marks);
    letters::write(&most, at + Vec2::new(SCALE - letters::width(&most), 18.0), INK, marks);
}
