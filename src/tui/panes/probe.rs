//! The read-out of one pixel: its zone, its jump vector, its path from 0 to 1 with thresholds, s and e on it, and what it
//! reads. It follows the cursor and the time; while the worker looks, the last answer stands there, faint.

use crate::tui::text::plain;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use super::write;
use crate::layers::folding::probe::Probe;
use crate::tui::graphics::probed::Probed;
use crate::tui::layout::seeing;
use crate::tui::state::State;
use crate::tui::text::colour;
use crate::tui::text::numbers::{polar, short};

/// Draws it.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let Some(probed) = &state.seeing.probed else {
        write(buffer, area, 0, 0, "looking ...", colour::faint());
        return;
    };
    let style = if seeing::asked(state) == Some(probed.asked) { Style::new() } else { colour::faint() };
    let (x, y) = probed.asked.pixel;
    let place = write(buffer, area, 0, 0, &format!("pixel {x},{y}   "), style);
    match &probed.probe {
        None => {
            write(buffer, area, place, 0, "in no zone: it stays as it is", style);
            write(buffer, area, 0, 1, &shows(probed), style);
        }
        Some(probe) => {
            let active = if probe.active { "active" } else { "not active" };
            let zone = plain(&probe.zone);
            let after = write(buffer, area, place, 0, &zone, style.patch(colour::strong()));
            write(buffer, area, after, 0, &format!("   {active}"), style);
            draw_path(
                probe,
                Rect { y: area.y + 2, height: area.height.saturating_sub(2).min(2), ..area },
                style,
                buffer,
            );
            for (row, line) in [(1, jump(probe)), (4, places(probe, probed.asked.time)), (5, reads(probe, probed))] {
                write(buffer, area, 0, row, &line, style);
            }
            write(buffer, area, 0, 6, &thresholds(probe), style);
        }
    }
}

fn jump(probe: &Probe) -> String {
    let (length, degrees) = polar(probe.jump);
    let (x, y) = (short(probe.jump.x), short(probe.jump.y));
    format!("jump {x}, {y} px   length {} px   {}°", short(length), short(degrees))
}

fn places(probe: &Probe, time: f64) -> String {
    format!("s {}   e {}   τ {}   t {}", short(probe.s), short(probe.e), short(probe.tau), short(time))
}

fn reads(probe: &Probe, probed: &Probed) -> String {
    format!("reads {}, {}   {}", short(probe.read.x), short(probe.read.y), shows(probed))
}

fn shows(probed: &Probed) -> String {
    let [r, g, b, a] = probed.colour;
    format!("shows #{r:02x}{g:02x}{b:02x} alpha {a}")
}

fn thresholds(probe: &Probe) -> String {
    match &probe.thresholds[..] {
        [] => "no thresholds".into(),
        some => format!("thresholds {}", some.iter().map(|&s| short(s)).collect::<Vec<_>>().join(", ")),
    }
}

/// The path from 0 to 1: a thick line where the sampler is active, a broken one where not, a bar at every threshold; below
/// it s and e, at the edge where they lie beyond it.
fn draw_path(probe: &Probe, area: Rect, style: Style, buffer: &mut Buffer) {
    let cells = i32::from(area.width) - 4;
    if cells < 10 || area.height < 2 {
        return;
    }
    let cell = |s: f64| 2 + (s.clamp(0.0, 1.0) * f64::from(cells - 1)).round() as i32;
    write(buffer, area, 0, 0, "0", style);
    write(buffer, area, cells + 3, 0, "1", style);
    for x in 0..cells {
        let s = f64::from(x) / f64::from(cells - 1);
        let active = probe.active_parts.iter().any(|&(from, to)| (from..=to).contains(&s));
        write(buffer, area, x + 2, 0, if active { "━" } else { "┄" }, style);
    }
    probe.thresholds.iter().for_each(|&s| {
        write(buffer, area, cell(s), 0, "┃", style.patch(colour::strong()));
    });
    let (s, e) = (cell(probe.s), cell(probe.e));
    if s == e {
        write(buffer, area, s.min(cells - 1), 1, "s=e", style);
        write(buffer, area, s, 0, "●", style.patch(colour::strong()));
    } else {
        for (at, glyph, name) in [(e, "◆", "e"), (s, "●", "s")] {
            write(buffer, area, at, 0, glyph, style.patch(colour::strong()));
            write(buffer, area, at, 1, name, style);
        }
    }
    let beyond = |value: f64| if value < 0.0 { Some((0, "‹")) } else { (value > 1.0).then_some((cells + 3, "›")) };
    beyond(probe.s).into_iter().for_each(|(x, glyph)| {
        write(buffer, area, x, 1, glyph, style);
    });
}
