//! A small drawing of what is selected: a piece of a pattern, with its lengths to scale, or a curve over the shares of the
//! picture's pixels.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Color, Style};

use super::braille::Braille;
use super::write;
use crate::layers::parts::sketch::{Curve, Patch, Sketch};
use crate::tui::document::tree;
use crate::tui::graphics::counts::PARTS;
use crate::tui::layout::{picture, sketch};
use crate::tui::state::State;
use crate::tui::text::color::{self, Depth};
use crate::tui::text::numbers::short;
use crate::tui::text::wrap::width;

/// A patch is at least so many times as wide as strokes are apart.
const SPACINGS: f64 = 4.0;

/// Draws it; what has one, if the selected thing has none.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    if area.height < 3 || area.width < 12 {
        return;
    }
    match sketch::sketch(state) {
        Some((_, Sketch::Patch(patch))) => draw_patch(&patch, state.depth, area, buffer),
        Some((_, Sketch::Curve(curve))) => draw_curve(state, &curve, area, buffer),
        None => drop(write(buffer, area, 1, 0, &nothing(state), color::faint())),
    }
}

fn nothing(state: &State) -> String {
    let layer = state.document().scene().layers.get(tree::layer_of(&state.cursor.node).unwrap_or(0));
    let of = layer.map_or(&[] as &[_], |layer| layer.technique().sketched());
    if of.is_empty() { "nothing here is drawn small".into() } else { format!("select a {}", of.join(" or a ")) }
}

/// A pixel of the picture is as wide as a cell, or less where strokes are far apart.
fn draw_patch(patch: &Patch, depth: Depth, area: Rect, buffer: &mut Buffer) {
    let far = patch.lengths_px.first().map_or(1.0, |(_, px)| *px);
    let px = (SPACINGS * far / f64::from(area.width)).max(1.0);
    let rows = area.height - 1;
    let light = (patch.make)((area.width.into(), usize::from(rows) * 2), px);
    for (x, y) in (0..rows).flat_map(|y| (0..area.width).map(move |x| (x, y))) {
        let at = |half: u16| {
            let code = (light.get(x.into(), usize::from(y * 2 + half)) * 255.0).round() as u8;
            [code; 3]
        };
        let Some(cell) = buffer.cell_mut(Position::new(area.x + x, area.y + y)) else { continue };
        if depth == Depth::None {
            let [upper, ..] = at(0);
            let [lower, ..] = at(1);
            cell.set_char(color::shade([upper.midpoint(lower); 3]));
            continue;
        }
        let paint = |half: u16| depth.color(at(half)).unwrap_or(Color::Reset);
        cell.set_symbol("▀").set_style(Style::new().fg(paint(0)).bg(paint(1)));
    }
    let mut x = 0;
    for (name, length_px) in &patch.lengths_px {
        let cells = (length_px / px).round().max(1.0) as usize;
        let line = if cells > 1 { format!("├{}┤", "─".repeat(cells - 2)) } else { "│".into() };
        let told = format!("{name} {} px {line}   ", short(*length_px));
        if x + width(&told) as i32 > i32::from(area.width) + 3 {
            break;
        }
        x = write(buffer, area, x, rows, &told, Style::new());
    }
}

/// The curve in braille; behind it columns as high as the shares of the pixels, the greatest as high as the curve can be.
fn draw_curve(state: &State, curve: &Curve, area: Rect, buffer: &mut Buffer) {
    let plot = Rect { height: area.height - 1, ..area };
    let (columns, dots) = (usize::from(plot.width) * 2, usize::from(plot.height) * 4);
    let mut braille = Braille::new(plot.width.into(), plot.height.into());
    let counts = state.picture.counts.as_ref().filter(|counts| picture::count_at(state).as_ref() == Some(&counts.at));
    let greatest = counts.map_or(0.0, |counts| counts.shares.iter().copied().fold(0.0, f64::max));
    let row = |height: f64| ((1.0 - height) * (dots - 1) as f64).round().clamp(0.0, (dots - 1) as f64) as usize;
    if let Some(counts) = counts.filter(|_| greatest > 0.0) {
        for x in 0..columns {
            let share = counts.shares[x * PARTS / columns] / greatest;
            // Every second dot, so that the curve stands out.
            let filled = (row(share)..dots).filter(|y| share > 0.0 && (x + y) % 2 == 0);
            filled.for_each(|y| braille.set(x, y, color::faint()));
        }
    }
    let line = state.depth.ink(Style::new(), Color::Cyan).patch(color::strong());
    let heights: Vec<usize> = (0..columns).map(|x| row((curve.value)(x as f64 / (columns - 1) as f64))).collect();
    for (x, pair) in heights.windows(2).enumerate() {
        (pair[0].min(pair[1])..=pair[0].max(pair[1])).for_each(|y| braille.set(x + 1, y, line));
    }
    braille.set(0, heights[0], line);
    braille.draw(plot, buffer);
    let [across, up] = curve.axes;
    let x = write(buffer, area, 0, plot.height, &format!("{across} 0 to 1, "), Style::new());
    let x = write(buffer, area, x, plot.height, &format!("{up} 0 to 1"), line);
    let pixels = if counts.is_some() { "   pixels of each" } else { "   counting pixels ..." };
    write(buffer, area, x, plot.height, &format!("{pixels} {across}"), color::faint());
}
