//! The vector field of the zone that is shown, as arrows. Glyph and color are the direction, weight and brightness the
//! length; below them are a legend and the exact value under the picture's cursor. It shows the worker's last synthesis.

use kurbo::Vec2;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier, Style};

use super::{arrow, write};
use crate::base::number::rounded;
use crate::base::oklab;
use crate::layers::parts::readout::{VectorField, vector};
use crate::scene::words::item_of;
use crate::tui::document::tree;
use crate::tui::state::State;
use crate::tui::text::color;
use crate::tui::text::color::Depth;
use crate::tui::text::numbers::{polar, short};

/// Vectors shorter than this share of the longest are dots.
const NOTHING: f64 = 0.02;
/// Vectors of at least this share of the longest have long arrows.
const LONG: f64 = 0.5;

/// Draws the arrows, and below them the legend and the value under the cursor.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let Some((field, longest)) = field(state) else {
        let why = match (item_of(&state.cursor.node), tree::item_word(state.document(), &state.cursor.node)) {
            (Some(_), _) => "not there yet".into(),
            (None, Some(word)) => format!("select a {word}"),
            (None, None) => "this layer has no vector field".into(),
        };
        write(buffer, area, 1, 0, &why, color::faint());
        return;
    };
    let (width, height) = (field.inside.width(), field.inside.height());
    if width == 0 || height == 0 || area.height < 3 || area.width < 4 {
        return;
    }
    let rows = area.height - 2;
    // An arrow in every second column, because a cell is about twice as high as wide.
    let across = area.width / 2;
    let step = (width as f64 / f64::from(across)).max(height as f64 / f64::from(rows));
    for (x, y) in (0..rows).flat_map(|y| (0..across).map(move |x| (x, y))) {
        let (i, j) = (((f64::from(x) + 0.5) * step) as usize, ((f64::from(y) + 0.5) * step) as usize);
        if i < width && j < height && *field.inside.get(i, j) {
            let (text, style) = glyph(state.depth, vector(*field.vectors.get(i, j)), longest);
            let flagged = field.flag.as_ref().is_some_and(|(_, has)| has(j * width + i));
            let style = if flagged { style.add_modifier(Modifier::UNDERLINED) } else { style };
            write(buffer, area, i32::from(x) * 2, y, text, style);
        }
    }
    draw_legend(&field, longest, step, Rect { y: area.y + rows, height: 1, ..area }, buffer);
    write(buffer, area, 0, rows + 1, &under_cursor(state, &field), Style::new());
}

/// The legend: how long and how far apart the arrows are.
fn draw_legend(field: &VectorField, longest: f64, step: f64, area: Rect, buffer: &mut Buffer) {
    let half = short(rounded(longest * LONG, 2));
    let step = short(rounded(step, 1));
    let longest = short(longest);
    let text = format!("longest {longest} px  → to {half}  ⇒ more  · none  every {step} px");
    let x = write(buffer, area, 0, 0, &text, color::faint());
    if let Some((name, _)) = &field.flag {
        write(buffer, area, x + 2, 0, name, color::faint().add_modifier(Modifier::UNDERLINED));
    }
}

/// The jump vector of the pixel under the picture's cursor.
fn under_cursor(state: &State, field: &VectorField) -> String {
    let at = state.picture.cursor;
    let (x, y) = (at.x.max(0.0) as usize, at.y.max(0.0) as usize);
    let Some(jump) = field.at((x, y)) else {
        let word = tree::item_word(state.document(), &state.cursor.node).unwrap_or("field");
        return format!("at {x},{y}: outside the {word}");
    };
    let (length, degrees) = polar(jump);
    format!("at {x},{y}: {}, {} px  {} px {}°", short(jump.x), short(jump.y), short(length), short(degrees))
}

/// The vector field of what is shown, and the length of its longest vector.
fn field(state: &State) -> Option<(VectorField<'_>, f64)> {
    let item = item_of(&state.cursor.node)?;
    let layer = tree::layer_of(item)?;
    let fields = state.picture.synth.as_ref()?.layers.get(layer)?.fields();
    let own = |path: &str| item.strip_prefix(&format!("/layers/{layer}")) == Some(path);
    let field = fields.into_iter().find(|field| own(&field.path))?;
    let longest = state.picture.longest.iter().find(|(path, _)| path == item);
    Some((field, longest.map_or(0.0, |(_, longest)| *longest)))
}

/// One arrow: a dot for a very short vector, a double arrow for a long one, in the color of its direction.
fn glyph(depth: Depth, jump: Vec2, longest: f64) -> (&'static str, Style) {
    let (length, degrees) = polar(jump);
    let share = if longest > 0.0 { length / longest } else { 0.0 };
    if share < NOTHING {
        return ("·", color::faint());
    }
    let style = hue(depth, degrees.rem_euclid(360.0) / 360.0);
    if share > LONG {
        return (double(arrow(jump)), style.add_modifier(Modifier::BOLD));
    }
    (arrow(jump), style)
}

fn double(arrow: &'static str) -> &'static str {
    const PAIRS: [(&str, &str); 8] =
        [("→", "⇒"), ("↗", "⇗"), ("↑", "⇑"), ("↖", "⇖"), ("←", "⇐"), ("↙", "⇙"), ("↓", "⇓"), ("↘", "⇘")];
    PAIRS.iter().find(|(single, _)| *single == arrow).map_or(arrow, |(_, double)| double)
}

/// The color of a direction: from a color wheel of even lightness, which is visible on light and dark backgrounds; with 16
/// colors, one of six.
fn hue(depth: Depth, turns: f64) -> Style {
    const SIX: [Color; 6] = [Color::Red, Color::Yellow, Color::Green, Color::Cyan, Color::Blue, Color::Magenta];
    match depth {
        Depth::None => Style::new(),
        Depth::Ansi => Style::new().fg(SIX[(turns * 6.0).round() as usize % 6]),
        _ => depth.color(oklab::hue(turns)).map_or(Style::new(), |ink| Style::new().fg(ink)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrows_tell_direction_and_length_without_color() {
        for (jump, glyph_there) in [
            ((0.0, -18.0), "⇑"),
            ((0.0, -5.0), "↑"),
            ((18.0, 0.0), "⇒"),
            ((-4.0, 4.0), "↙"),
            ((0.1, 0.0), "·"),
            ((0.0, 0.0), "·"),
        ] {
            for depth in [Depth::None, Depth::Ansi, Depth::Indexed, Depth::True] {
                assert_eq!(glyph(depth, Vec2::from(jump), 18.0).0, glyph_there, "{jump:?}");
            }
        }
    }
}
