//! The status line: mode, place, unsaved edits, time, synthesis, window, step.

use crate::tui::text::plain;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

use super::write;
use crate::base::maths::ten_to;
use crate::layers::parts::readout::Fact;
use crate::layers::technique::Technique;
use crate::scene::words::item_of;
use crate::tui::document::tree;
use crate::tui::state::{Mode, Pane, State, entry, spatial};
use crate::tui::text::numbers::short;
use crate::tui::text::wrap::{clipped, width};

/// Draws the status line.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let bar = Style::new().add_modifier(Modifier::REVERSED);
    buffer.set_style(area, bar);
    let (mode, marks) = (mode(state), marks(state));
    let taken = width(&format!(" {mode}  {marks}   ")) + LEAST_NAME;
    let right = right(state, area.width.saturating_sub(taken));
    // A long name is clipped, because the rest of the line matters more.
    let others = width(&format!(" {mode}  {marks}  {right} "));
    let room = area.width.saturating_sub(others).max(LEAST_NAME);
    let left = format!(" {mode}  {}{marks}", clipped(&place(state), room.into()));
    let x = write(buffer, area, 0, 0, &left, bar) + 2;
    let x = (i32::from(area.width) - i32::from(width(&right)) - 1).max(x);
    write(buffer, area, x, 0, &right, bar);
}

/// The least width of the name.
const LEAST_NAME: u16 = 12;

/// Three letters for what the keys do.
fn mode(state: &State) -> &'static str {
    match (&state.typing.mode, state.cursor.focus) {
        (Mode::Entry(_), _) => "INS",
        (Mode::Line(line), _) if line.kind == '/' => "SEA",
        (Mode::Line(_), _) => "CMD",
        (Mode::Choice(_), _) => "CHO",
        (Mode::Palette(_), _) => "FND",
        (Mode::Pages(_), _) => "HLP",
        (Mode::Aim, _) => "AIM",
        (Mode::Normal, _) if state.cursor.selects() => "SEL",
        (Mode::Normal, Pane::Picture) => "PIC",
        (Mode::Normal, _) => "NOR",
    }
}

/// The layer that is shown, and the named item in it.
fn place(state: &State) -> String {
    let Some((layer, _)) = inside(state, &state.cursor.node) else { return "scene".into() };
    let item = item_of(&state.cursor.node).and_then(|item| layer.item_name(inside(state, item)?.1));
    plain(&[layer.name(), item.map_or("", |_| "/"), item.unwrap_or_default()].concat())
}

fn marks(state: &State) -> String {
    let failing = state.scene.failing().map(|why| format!("  no journal: {}", plain(&why)));
    let mark = |on: bool, text: &'static str| if on { text } else { "" };
    [
        mark(!state.scene.is_saved(), "  *"),
        mark(!state.scene.is_synced(), " ~"),
        mark(state.scene.read_only(), "  RO"),
        mark(!state.apart.solo.is_empty(), "  solo"),
        mark(!state.apart.muted.is_empty(), "  muted"),
        mark(!state.apart.locked.is_empty(), "  locked"),
        mark(state.apart.compared.is_some(), "  compared"),
        &state.outside.file.map(|word| format!("  {word}")).unwrap_or_default(),
        failing.as_deref().unwrap_or_default(),
    ]
    .concat()
}

/// What stands on the right; what work says of itself has so much room.
fn right(state: &State, room: u16) -> String {
    let mut parts = Vec::new();
    if let Some(letter) = state.memory.recorder.recording() {
        parts.push(format!("recording {letter}"));
    }
    if let Some(letter) = state.memory.register {
        parts.push(format!("register {letter}"));
    }
    if let Some(count) = state.typing.count {
        parts.push(count.to_string());
    }
    if !state.typing.pressed.is_empty() {
        parts.push(format!("{}-", state.typing.pressed));
    }
    if let Some(work) = &state.outside.work {
        // Its progress matters more than what does not change meanwhile, and how to end it more than that.
        let first = if state.cursor.selects() && state.outside.piping.is_none() { "Esc Esc" } else { "Esc" };
        let end = format!("{first} cancels");
        let before = width(&parts.join("  ")) + width(&end) + 4;
        parts.push(clipped(&plain(work), room.saturating_sub(before).max(8).into()));
        parts.push(end);
        return parts.join("  ");
    }
    if let Some(aiming) = spatial::aiming(state).filter(|_| matches!(state.typing.mode, Mode::Aim)) {
        match aiming {
            Ok(facts) => parts.extend(facts.into_iter().map(told)),
            Err(why) => parts.push(plain(&why)),
        }
        return parts.join("  ");
    }
    parts.extend(entry::summed(state).map(|summed| plain(&summed)));
    parts.push(format!("{}t {}", if state.play.playing { "> " } else { "" }, short(state.play.time)));
    if let Some((symbol, value)) = now(state) {
        parts.push(format!("{symbol} {}", short(value)));
    }
    let mut facts = facts(state);
    if state.picture.synthesising {
        let far = state.picture.filled.map_or("...".to_owned(), |percent| format!("{percent} %"));
        let making = || format!("{} {far}", made(state));
        parts.push(state.picture.read.map_or_else(making, |percent| format!("files {percent} %")));
    } else if !facts.is_empty() {
        parts.append(&mut facts);
        parts.extend(state.picture.frame_ms.map(|ms| format!("frame {ms:.0} ms")));
    } else if let Some(ms) = state.picture.synth_ms {
        parts.push(format!("{} {ms:.0} ms", made(state)));
    }
    parts.push(format!("step {}", short(ten_to(state.typing.step))));
    if let Some((x, y)) = state.outside.pointer {
        parts.push(format!("at {}, {}", short(x), short(y)));
    }
    if !state.outside.window.is_empty() {
        parts.push(plain(&state.outside.window));
    }
    parts.join("  ")
}

/// What a synthesis makes, in a word: vector fields where the scene has pictures.
fn made(state: &State) -> &'static str {
    let pictures = state.document().scene().layers.iter().any(|layer| layer.technique().frame_of().is_some());
    if pictures { "field" } else { "synthesis" }
}

/// What is good to know of the layer that is shown.
fn facts(state: &State) -> Vec<String> {
    let made = state.picture.synth.as_ref().zip(tree::layer_of(&state.cursor.node));
    let facts = made.and_then(|(synth, layer)| synth.layers.get(layer)).map(|layer| layer.facts()).unwrap_or_default();
    facts.into_iter().map(told).collect()
}

fn told(Fact { name, value, unit }: Fact) -> String {
    format!("{name} {} {unit}", short(value)).trim_end().into()
}

/// The present value of what changes over time in the item that is shown, with its symbol.
fn now(state: &State) -> Option<(&'static str, f64)> {
    let item = item_of(&state.cursor.node)?;
    let (layer, path) = inside(state, item)?;
    let curves = layer.curves(state.timeline().wrap);
    curves.iter().find(|curve| curve.path == path).map(|curve| (curve.symbol, (curve.value)(state.play.time)))
}

/// The layer that a place belongs to, and the place relative to it.
fn inside<'a>(state: &'a State, pointer: &'a str) -> Option<(&'a dyn Technique, &'a str)> {
    let index = tree::layer_of(pointer)?;
    let layer = state.document().scene().layers.get(index)?.technique();
    Some((layer, pointer.strip_prefix(&format!("/layers/{index}"))?))
}
