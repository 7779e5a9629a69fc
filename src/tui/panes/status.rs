//! The status line: mode, place, what is not saved, time, the last synthesis, the window, the step.

use crate::tui::text::plain;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

use super::write;
use crate::layers::Layer;
use crate::layers::folding::position::Clock;
use crate::tui::document::tree;
use crate::tui::state::{Mode, Pane, State};
use crate::tui::text::numbers::{short, step_of};
use crate::tui::text::wrap::{clipped, width};

/// Draws it.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let bar = Style::new().add_modifier(Modifier::REVERSED);
    buffer.set_style(area, bar);
    let (mode, marks, right) = (mode(state), marks(state), right(state));
    // A long name gives way: what is not saved, the time and the step are seen first.
    let others = width(&format!(" {mode}  {marks}  {right} "));
    let room = area.width.saturating_sub(others).max(LEAST_NAME);
    let left = format!(" {mode}  {}{marks}", clipped(&place(state), room.into()));
    let x = write(buffer, area, 0, 0, &left, bar) + 2;
    let x = (i32::from(area.width) - i32::from(width(&right)) - 1).max(x);
    write(buffer, area, x, 0, &right, bar);
}

/// Columns that a name has at least.
const LEAST_NAME: u16 = 12;

/// Three letters for what the keys do.
fn mode(state: &State) -> &'static str {
    match (&state.mode, state.focus) {
        (Mode::Entry(_), _) => "INS",
        (Mode::Line(line), _) if line.kind == '/' => "SEA",
        (Mode::Line(_), _) => "CMD",
        (Mode::Choice(_), _) => "CHO",
        (Mode::Palette(_), _) => "FND",
        (Mode::Pages(_), _) => "HLP",
        (Mode::Aim, _) => "AIM",
        (Mode::Normal, _) if state.selected_from.is_some() => "SEL",
        (Mode::Normal, Pane::Picture) => "PIC",
        (Mode::Normal, _) => "NOR",
    }
}

/// The layer and the zone that is shown.
fn place(state: &State) -> String {
    let (layer, zone) = tree::place(&state.node);
    let Some(Layer::Picture(layer)) = layer.and_then(|i| state.document().scene().layers.get(i)) else {
        return "scene".into();
    };
    let zone = zone.and_then(|i| layer.zones.get(i)).map(|zone| format!("/{}", zone.name));
    plain(&format!("{}{}", layer.name, zone.unwrap_or_default()))
}

fn marks(state: &State) -> String {
    let failing = state.door.failing().map(|why| format!("  no journal: {}", plain(&why)));
    let mark = |on: bool, text: &'static str| if on { text } else { "" };
    [
        mark(!state.door.is_saved(), "  *"),
        mark(!state.door.is_synced(), " ~"),
        mark(state.door.read_only(), "  RO"),
        &state.life.file.map(|word| format!("  {word}")).unwrap_or_default(),
        failing.as_deref().unwrap_or_default(),
    ]
    .concat()
}

fn right(state: &State) -> String {
    let mut parts = Vec::new();
    if let Some(letter) = state.recorder.recording() {
        parts.push(format!("recording {letter}"));
    }
    if let Some(count) = state.count {
        parts.push(count.to_string());
    }
    if !state.pressed.is_empty() {
        parts.push(format!("{}-", state.pressed));
    }
    if let Some(work) = &state.seen.work {
        // What it is about to say counts more than what stands still meanwhile.
        parts.push(format!("{}  Esc cancels", plain(work)));
        return parts.join("  ");
    }
    parts.push(format!("{}t {}", if state.playing { "> " } else { "" }, short(state.time)));
    if let Some(s) = place_on_path(state) {
        parts.push(format!("s {}", short(s)));
    }
    if state.seeing.synthesising {
        parts.push("field ...".into());
    } else if let Some(ms) = state.seen.synth_ms {
        parts.push(format!("field {ms:.0} ms"));
    }
    parts.push(format!("step {}", short(step_of(state.step))));
    if let Some((x, y)) = state.seen.pointer {
        parts.push(format!("at {}, {}", short(x), short(y)));
    }
    if !state.seen.window.is_empty() {
        parts.push(plain(&state.seen.window));
    }
    parts.join("  ")
}

/// The clock of the zone that is shown.
pub fn clock(state: &State) -> Option<Clock> {
    let (layer, zone) = tree::place(&state.node);
    let scene = state.document().scene();
    let Layer::Picture(layer) = scene.layers.get(layer?)?;
    Some(layer.zones.get(zone?)?.clock(scene.timeline.wrap))
}

fn place_on_path(state: &State) -> Option<f64> {
    clock(state).map(|clock| clock.s(state.time))
}
