//! The read-out of one pixel: what it belongs to, its vectors, its path from 0 to 1 with the points on it, and what it reads.
//! It follows the cursor and the time. Until the worker answers, the previous answer is shown, faint.

use kurbo::Vec2;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use super::write;
use crate::base::text::hex;
use crate::layers::parts::readout::{Axis, Entry, Value};
use crate::tui::graphics::probed::Probed;
use crate::tui::layout::picture;
use crate::tui::state::State;
use crate::tui::text::color;
use crate::tui::text::numbers::{polar, short};
use crate::tui::text::plain;

/// Draws the read-out.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let Some(probed) = &state.picture.probed else {
        write(buffer, area, 0, 0, "looking ...", color::faint());
        return;
    };
    let style = if picture::probe_at(state) == Some(probed.at) { Style::new() } else { color::faint() };
    let (x, y) = probed.at.pixel;
    let place = write(buffer, area, 0, 0, &format!("pixel {x},{y}   "), style);
    let told = told(probed.read.iter().flat_map(|read| &read.entries));
    let Some(of) = told.of.first() else {
        let outside = probed.read.iter().flat_map(|read| &read.entries).next();
        let outside = outside.map(|entry| format!("in no {}", entry.label));
        write(buffer, area, place, 0, &outside.unwrap_or_default(), style);
        write(buffer, area, 0, 1, &shows(probed), style);
        return;
    };
    let after = write(buffer, area, place, 0, &plain(of), style.patch(color::strong()));
    write(buffer, area, after, 0, &told.flags.concat(), style);
    let axis = probed.read.as_ref().and_then(|read| read.axis.as_ref());
    if let Some(axis) = axis {
        draw_path(axis, Rect { y: area.y + 2, height: area.height.saturating_sub(2).min(2), ..area }, style, buffer);
    }
    for (row, line) in (1..).zip(filled(told.places, usize::from(area.width))) {
        write(buffer, area, 0, row, &line, style);
    }
    let read = [told.read, vec![shows(probed)]].concat();
    let lines = [
        (1, told.vectors.join(BETWEEN)),
        (4, numbers(&told.numbers, axis, probed.at.time)),
        (5, read.join(BETWEEN)),
        (6, told.lists.join(BETWEEN)),
    ];
    for (row, line) in lines {
        write(buffer, area, 0, row, &line, style);
    }
}

/// Between the parts of a line.
const BETWEEN: &str = "   ";

/// The entries in words, by the line that they stand in.
#[derive(Default)]
struct InWords<'a> {
    /// What the pixel belongs to.
    of: Vec<&'a str>,
    flags: Vec<String>,
    places: Vec<String>,
    vectors: Vec<String>,
    numbers: Vec<(&'static str, f64)>,
    read: Vec<String>,
    lists: Vec<String>,
}

fn told<'a>(entries: impl Iterator<Item = &'a Entry>) -> InWords<'a> {
    let mut told = InWords::default();
    for Entry { label, value, .. } in entries {
        match value {
            Value::Of(name) => told.of.extend(name.as_deref()),
            Value::Flag { on: true, .. } => told.flags.push(format!("{BETWEEN}{label}")),
            Value::Flag { on: false, .. } => told.flags.push(format!("{BETWEEN}not {label}")),
            Value::Vector(vector) => told.vectors.push(in_words(label, *vector)),
            Value::Number(number) => told.numbers.push((label, *number)),
            Value::Place(place) => told.read.push(format!("{label} {}, {}", short(place.x), short(place.y))),
            Value::List(numbers) if numbers.is_empty() => told.lists.push(format!("no {label}")),
            Value::List(numbers) => told.lists.push(format!("{label} {}", listed(numbers))),
            Value::Index(_) if label.is_empty() => {}
            Value::Index(index) => told.places.push(format!("{label} {index}")),
            Value::Coordinates(numbers, unit) => {
                told.places.push(format!("{label} {} {unit}", listed(numbers)).trim_end().to_owned());
            }
            // Tables, for which the pane has no room: `plica probe` prints them.
            Value::Color(_) | Value::Indices(_) | Value::Shares(_) | Value::Group(_) | Value::Items(_) => {}
        }
    }
    told
}

fn in_words(label: &str, vector: Vec2) -> String {
    let (length, degrees) = polar(vector);
    let (x, y) = (short(vector.x), short(vector.y));
    format!("{label} {x}, {y} px   length {} px   {}°", short(length), short(degrees))
}

fn listed(numbers: &[f64]) -> String {
    numbers.iter().map(|&number| short(number)).collect::<Vec<_>>().join(", ")
}

/// Parts in at most three lines of this many cells.
fn filled(parts: Vec<String>, cells: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for part in parts {
        let full = lines.len() == 3;
        match lines.last_mut() {
            Some(line) if full || line.len() + BETWEEN.len() + part.len() <= cells => {
                *line += &(BETWEEN.to_owned() + &part)
            }
            _ => lines.push(part),
        }
    }
    lines
}

/// The numbers, first those that are places on the path, and the time.
fn numbers(all: &[(&str, f64)], axis: Option<&Axis>, time: f64) -> String {
    let points = axis.map_or(&[] as &[_], |axis| &axis.points);
    let others = all.iter().filter(|(label, _)| points.iter().all(|(point, _)| point != label));
    let now = [("t", time)];
    let all = points.iter().chain(others).chain(&now);
    all.map(|(label, number)| format!("{label} {}", short(*number))).collect::<Vec<_>>().join(BETWEEN)
}

fn shows(probed: &Probed) -> String {
    let [r, g, b, a] = probed.color;
    format!("shows #{} alpha {a}", hex(&[r, g, b]))
}

/// Draws the path from 0 to 1: a solid line where it is open, a broken one elsewhere, a bar at every tick. Below are the
/// points; those beyond the path are at its ends.
fn draw_path(axis: &Axis, area: Rect, style: Style, buffer: &mut Buffer) {
    const POINTS: [&str; 2] = ["●", "◆"];
    let cells = i32::from(area.width) - 4;
    if cells < 10 || area.height < 2 {
        return;
    }
    let cell = |s: f64| 2 + (s.clamp(0.0, 1.0) * f64::from(cells - 1)).round() as i32;
    write(buffer, area, 0, 0, "0", style);
    write(buffer, area, cells + 3, 0, "1", style);
    for x in 0..cells {
        let s = f64::from(x) / f64::from(cells - 1);
        let open = axis.stretches.iter().any(|&(from, to)| (from..=to).contains(&s));
        write(buffer, area, x + 2, 0, if open { "━" } else { "┄" }, style);
    }
    axis.ticks.iter().for_each(|&s| {
        write(buffer, area, cell(s), 0, "┃", style.patch(color::strong()));
    });
    let Some(&(_, first)) = axis.points.first() else { return };
    if axis.points.len() > 1 && axis.points.iter().all(|&(_, at)| cell(at) == cell(first)) {
        let names: Vec<&str> = axis.points.iter().map(|&(name, _)| name).collect();
        write(buffer, area, cell(first).min(cells - 1), 1, &names.join("="), style);
        write(buffer, area, cell(first), 0, POINTS[0], style.patch(color::strong()));
    } else {
        // In reverse, so that the first is drawn over the others.
        for (i, &(name, at)) in axis.points.iter().enumerate().rev() {
            write(buffer, area, cell(at), 0, POINTS[i % POINTS.len()], style.patch(color::strong()));
            write(buffer, area, cell(at), 1, name, style);
        }
    }
    let beyond = |value: f64| if value < 0.0 { Some((0, "‹")) } else { (value > 1.0).then_some((cells + 3, "›")) };
    beyond(first).into_iter().for_each(|(x, glyph)| {
        write(buffer, area, x, 1, glyph, style);
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_in_space_takes_at_most_three_lines() {
        let entry = |label, value| Entry { key: label, label, value };
        let entries = [
            entry("layer", Value::Of(Some("cow".into()))),
            entry("triangle", Value::Index(7)),
            entry("position", Value::Coordinates(vec![0.5, 1.0, -2.0], "m")),
            entry("normal", Value::Coordinates(vec![0.0, 0.0, 1.0], "")),
            entry("depth", Value::Coordinates(vec![2.25], "m")),
        ];
        let wide = ["triangle 7   position 0.5, 1, -2 m   normal 0, 0, 1   depth 2.25 m"];
        let filled = |cells| filled(told(entries.iter()).places, cells);
        assert_eq!(filled(80), wide);
        let narrow = ["triangle 7", "position 0.5, 1, -2 m", "normal 0, 0, 1   depth 2.25 m"];
        assert_eq!(filled(24), narrow);
    }
}
