//! The position functions of all zones of a layer on one time axis: s over t in braille. Each zone has a letter and a color;
//! the selected one is bold and on top; the present time is marked.

use crate::tui::text::plain;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Style};

use super::braille::Braille;
use super::write;
use crate::layers::parts::readout;
use crate::scene::words::item_of;
use crate::tui::document::tree;
use crate::tui::state::State;
use crate::tui::text::color;
use crate::tui::text::numbers::short;
use crate::tui::text::wrap::width;

/// The colors of the zones. If they repeat, letters tell the zones apart.
const COLORS: [Color; 6] = [Color::Cyan, Color::Yellow, Color::Magenta, Color::Green, Color::Blue, Color::Red];

/// The curve of one item of the layer.
struct Curve<'a> {
    name: String,
    letter: char,
    of: readout::Curve<'a>,
    selected: bool,
    style: Style,
}

/// Draws the range of s on the left, the curves, the time axis and the legend; with few rows, only the legend.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let curves = curves(state);
    if curves.is_empty() {
        let word = tree::item_word(state.document(), &state.cursor.node);
        let why = word.map_or("nothing here moves".into(), |word| format!("the layer has no {word}s"));
        write(buffer, area, 1, 0, &why, color::faint());
        return;
    }
    if area.width < 12 || area.height < 3 {
        draw_legend(&curves, state.play.time, true, area, buffer);
        return;
    }
    // The axis, if there is room for it.
    let axis = u16::from(area.height >= 5);
    let plot = Rect { height: area.height - 1 - axis, ..area };
    draw_curves(&curves, state.play.time, plot, buffer);
    if axis > 0 {
        draw_axis(state.play.time, Rect { y: plot.bottom(), height: 1, ..area }, buffer);
    }
    draw_legend(&curves, state.play.time, false, Rect { y: area.bottom() - 1, height: 1, ..area }, buffer);
}

/// The curves of the layer that is shown (else of the first), the selected one last, so that it is drawn on top.
fn curves<'a>(state: &'a State) -> Vec<Curve<'a>> {
    let index = tree::layer_of(&state.cursor.node).unwrap_or(0);
    let scene = state.document().scene();
    let Some(layer) = scene.layers.get(index) else { return Vec::new() };
    let selected = item_of(&state.cursor.node).and_then(|item| item.strip_prefix(&format!("/layers/{index}")));
    let curve = |(i, of): (usize, readout::Curve<'a>)| {
        let selected = selected == Some(&of.path);
        let style = state.depth.ink(Style::new(), COLORS[i % COLORS.len()]);
        Curve {
            name: plain(of.name),
            letter: char::from(b'a' + (i % 26) as u8),
            of,
            selected,
            style: if selected { style.patch(color::strong()) } else { style },
        }
    };
    let mut curves: Vec<Curve> =
        layer.technique().curves(scene.timeline.wrap).into_iter().enumerate().map(curve).collect();
    curves.sort_by_key(|curve| curve.selected);
    curves
}

fn draw_curves(curves: &[Curve], time: f64, area: Rect, buffer: &mut Buffer) {
    let columns = usize::from(area.width) * 2;
    // Stop just before the end: there a repeating function starts again.
    let time_at = |x: f64| (x / (columns - 1) as f64).min(1.0 - 1e-9);
    let values = |curve: &Curve| -> Vec<f64> { (0..columns).map(|x| (curve.of.value)(time_at(x as f64))).collect() };
    let all: Vec<Vec<f64>> = curves.iter().map(values).collect();
    let ends = curves.iter().zip(&all).flat_map(|(curve, values)| ends(&curve.of, values, &time_at));
    let ends = ends.chain(all.iter().flatten().copied());
    let (mut low, mut high) = ends.fold((0.0f64, 0.0f64), |(low, high), s| (low.min(s), high.max(s)));
    if low == high {
        (low, high) = (low - 0.5, high + 0.5);
    }
    let dots = usize::from(area.height) * 4;
    let row = |s: f64| ((high - s) / (high - low) * (dots - 1) as f64).round().clamp(0.0, (dots - 1) as f64) as usize;
    let mut braille = Braille::new(area.width.into(), area.height.into());
    (0..columns).step_by(4).for_each(|x| braille.set(x, row(0.0), color::faint()));
    for (curve, values) in curves.iter().zip(&all) {
        for (x, pair) in values.windows(2).enumerate() {
            let (from, to) = (row(pair[0]), row(pair[1]));
            // A gap at a jump of s, a line where it is only steep.
            if from.abs_diff(to) * 3 < dots * 2 {
                (from.min(to)..=from.max(to)).for_each(|y| braille.set(x + 1, y, curve.style));
            }
            braille.set(x, from, curve.style);
        }
    }
    braille.draw(area, buffer);
    let now = now(time, area);
    (0..area.height).for_each(|y| {
        write(buffer, area, now, y, "┊", color::faint());
    });
    for (i, (curve, values)) in curves.iter().zip(&all).enumerate() {
        // Letters on the curves, each at another time.
        let at = (i + 1) * columns / (curves.len() + 1);
        write(buffer, area, (at / 2) as i32, (row(values[at]) / 4) as u16, &curve.letter.to_string(), curve.style);
        let glyph = if curve.selected { "●" } else { "○" };
        write(buffer, area, now, (row((curve.of.value)(time)) / 4) as u16, glyph, curve.style);
    }
    // Last, so that nothing is drawn over a digit.
    let label = Style::reset().patch(color::faint());
    write(buffer, area, 0, 0, &short(high), label);
    write(buffer, area, 0, area.height - 1, &short(low), label);
}

/// The values of a curve on both sides of its jumps, which may lie between two columns.
fn ends(of: &readout::Curve, values: &[f64], time_at: &impl Fn(f64) -> f64) -> Vec<f64> {
    const JUMP: f64 = 0.25;
    let jumps = values.windows(2).enumerate().filter(|(_, pair)| (pair[0] - pair[1]).abs() > JUMP);
    let both = jumps.flat_map(|(x, pair)| {
        let (mut from, mut to) = (x as f64, x as f64 + 1.0);
        for _ in 0..40 {
            let middle = (from + to) / 2.0;
            let s = (of.value)(time_at(middle));
            if (s - pair[0]).abs() <= (s - pair[1]).abs() { from = middle } else { to = middle }
        }
        [(of.value)(time_at(from)), (of.value)(time_at(to))]
    });
    both.collect()
}

fn now(time: f64, area: Rect) -> i32 {
    (time.clamp(0.0, 1.0) * f64::from(area.width - 1)).round() as i32
}

/// Draws the time axis: 0 on the left, 1 on the right, t in its place.
fn draw_axis(time: f64, area: Rect, buffer: &mut Buffer) {
    let text = format!("t {}", short(time));
    let most = i32::from(area.width) - i32::from(width(&text)) - 2;
    let at = (now(time, area) - 1).clamp(2, most.max(2));
    write(buffer, area, 0, 0, "0", color::faint());
    write(buffer, area, i32::from(area.width) - 1, 0, "1", color::faint());
    write(buffer, area, at, 0, &text, color::faint());
}

/// Draws letters and names, the selected zone first with its s. If there is no room for curves, every zone has its s.
fn draw_legend(curves: &[Curve], time: f64, alone: bool, area: Rect, buffer: &mut Buffer) {
    let (mut x, mut y) = (0, 0);
    for curve in curves.iter().rev().take_while(|curve| curve.selected).chain(curves.iter().filter(|c| !c.selected)) {
        let s = if curve.selected || alone {
            format!(" {} {}", curve.of.symbol, short((curve.of.value)(time)))
        } else {
            String::new()
        };
        let text = format!("{} {}{s}", curve.letter, curve.name);
        if alone && x > 0 && y + 1 < area.height && x + i32::from(width(&text)) > i32::from(area.width) {
            (x, y) = (0, y + 1);
        }
        x = write(buffer, area, x, y, &text, curve.style) + 2;
    }
}
