//! The vector field of the zone that is shown, as arrows: one a cell, by direction; bolder where longer. It shows what the
//! worker synthesised last and evaluates nothing itself.

use kurbo::Vec2;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier, Style};

use super::write;
use crate::layers::folding::field::Field;
use crate::render::LayerSynth;
use crate::tui::app::State;
use crate::tui::numbers::{polar, short};
use crate::tui::{colour, tree};

/// Draws it, its longest vector and its scale below.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let Some(field) = field(state) else {
        let why = if tree::place(&state.node).1.is_none() { "select a zone" } else { "not there yet" };
        write(buffer, area, 1, 0, why, colour::faint());
        return;
    };
    let (width, height) = (field.inside.width(), field.inside.height());
    if width == 0 || height == 0 || area.height < 2 {
        return;
    }
    let rows = area.height - 1;
    // A cell is about twice as high as it is wide.
    let scale = (width as f64 / f64::from(area.width)).max(height as f64 / (2.0 * f64::from(rows)));
    let longest = field.jumps.cells().iter().map(|j| vector(*j).hypot2()).fold(0.0, f64::max).sqrt();
    for y in 0..rows {
        for x in 0..area.width {
            let (i, j) = (((f64::from(x) + 0.5) * scale) as usize, ((f64::from(y) + 0.5) * 2.0 * scale) as usize);
            if i < width && j < height && *field.inside.get(i, j) {
                let (text, style) = arrow(state, vector(*field.jumps.get(i, j)), longest);
                write(buffer, area, i32::from(x), y, text, style);
            }
        }
    }
    let legend = format!("longest {} px   a cell is {} px", short(longest), short((scale * 10.0).round() / 10.0));
    write(buffer, area, 0, rows, &legend, colour::faint());
}

/// The field of the zone that is shown.
fn field(state: &State) -> Option<&Field> {
    let (layer, zone) = tree::place(&state.node);
    let LayerSynth::Picture(synth) = state.seen.synth.as_ref()?.layers.get(layer?)?;
    let zone = synth.zones.iter().find(|one| Some(one.index) == zone)?;
    Some(&zone.field)
}

fn vector([x, y]: [f32; 2]) -> Vec2 {
    Vec2::new(x.into(), y.into())
}

/// One arrow: a dot where there is next to nothing.
fn arrow(state: &State, jump: Vec2, longest: f64) -> (&'static str, Style) {
    let (length, _) = polar(jump);
    if longest == 0.0 || length < longest * 0.02 {
        return ("·", colour::faint());
    }
    let style = match length / longest {
        share if share > 0.66 => state.depth.ink(Style::new().add_modifier(Modifier::BOLD), Color::Green),
        share if share > 0.33 => state.depth.ink(Style::new(), Color::Green),
        _ => state.depth.ink(colour::faint(), Color::Green),
    };
    (super::arrow(jump), style)
}
