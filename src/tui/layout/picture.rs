//! What the panes want from the worker, as a function of the state. The worker is asked whenever that changes.

use crate::tui::graphics::request::{CountAt, ProbeAt, Request};
use crate::tui::layout;
use kurbo::Point;

use std::collections::BTreeSet;

use crate::layers::parts::marks::{Overlay, View, When};
use crate::layers::parts::sketch::Sketch;
use crate::render::overlay;
use crate::render::part::Part;
use crate::render::passes::Asked;
use crate::render::sight::Sight;
use crate::tui::document::tree;
use crate::tui::graphics::{Marks, Protocol, Wanted, viewport};
use crate::tui::state::painting::{self, Sees};
use crate::tui::state::{Mode, State, looking, place};

/// What the panes want from the worker now.
pub fn request(state: &State) -> Request {
    let scene = state.document().scene().clone();
    let path = state.scene.path().to_owned();
    let how = state.apart.shown(state.document());
    let (time, picture) = (state.play.time, wanted(state));
    Request { scene, how, path, time, fresh: false, picture, probe: probe_at(state), counts: count_at(state) }
}

/// The pass that the curve which is shown is over, if one is.
pub fn count_at(state: &State) -> Option<CountAt> {
    layout::areas_of(state).sketch?;
    let (layer, sketch) = layout::sketch::sketch(state)?;
    let Sketch::Curve(curve) = sketch else { return None };
    Some(CountAt { of: Asked { pass: curve.over, of: None, layer: Some(layer) }, time: state.play.time })
}

/// The pixel under the cursor, if its read-out is open.
pub fn probe_at(state: &State) -> Option<ProbeAt> {
    let at = state.picture.cursor;
    let pixel = (at.x.max(0.0) as usize, at.y.max(0.0) as usize);
    let layer = tree::layer_of(&state.cursor.node).unwrap_or(0);
    (state.picture.probing && sees(state) == Sees::Results).then_some(ProbeAt { layer, pixel, time: state.play.time })
}

/// Which view of the layout for painting is seen; the results without it.
pub fn sees(state: &State) -> Sees {
    state.picture.painting.map_or(Sees::Results, |painting| painting.sees)
}

/// The protocol in use.
pub fn protocol(state: &State) -> Protocol {
    state.picture.graphics.protocol(state.depth)
}

/// The part of the picture that its pane shows; `None` if there is no such pane on the screen.
pub fn part(state: &State) -> Option<Part> {
    let area = layout::picture_area(state)?;
    let dots = state.picture.graphics.dots(protocol(state), (area.width, area.height));
    Some(viewport::part(&state.picture.viewport, state.picture.cursor, state.picture.size?, dots))
}

/// Remembers what is visible, so that the picture only moves when the cursor would leave it.
pub fn settle(state: &mut State) {
    if let Some(part) = part(state) {
        state.picture.viewport.center = part.corner + part.extent() / 2.0;
    }
}

/// Which overlays of the document are drawn over the picture, and what is selected.
pub fn overlays(state: &State) -> View {
    let selection = Some(painting::selection(state));
    let is_shown = |overlay: &&Overlay| {
        overlay.when == When::Document && !overlay.is_words && !state.picture.off.contains(overlay.name)
    };
    let of_document = overlay::overlays().filter(is_shown);
    let shown = of_document.map(|overlay| overlay.name).collect();
    View { shown, selection, only: only_shown(state), ..View::default() }
}

/// The only layer that is shown, where a pass is of one.
fn only_shown(state: &State) -> Option<usize> {
    state.picture.pass.as_ref()?.layer
}

/// Whether a picture is seen in place of the scene.
fn is_painting(sight: &Option<Sight>) -> bool {
    matches!(sight, Some(Sight::Painting { .. }))
}

/// The other overlays that are shown, no denser than stays legible.
fn switched(state: &State, part: &Part, protocol: Protocol, selects: bool) -> View {
    let is_on = |overlay: &Overlay| state.picture.switches.is_on(overlay.name) || selects && overlay.selects;
    let is_shown = |overlay: &&Overlay| overlay.when != When::Document && is_on(overlay);
    let shown: BTreeSet<_> = overlay::overlays().filter(is_shown).map(|overlay| overlay.name).collect();
    if shown.is_empty() {
        return View::default();
    }
    let dots = if protocol == Protocol::Blocks { [4.0, 1.0, 3.0] } else { [22.0, 4.0, 2.0] };
    let [spacing, cell, least_px] = dots.map(|dots| dots * part.scale);
    let [spacing_px, cell_px] = [spacing, cell].map(overlay::spacing);
    let times = overlay::times(state.play.time, state.document().scene().timeline.wrap);
    let vectors = state.picture.switches.vectors.clone();
    let selection = Some(painting::selection(state));
    let only = only_shown(state);
    View { shown, only, spacing_px, cell_px, least_px, times, vectors, selection, ..View::default() }
}

fn wanted(state: &State) -> Option<Wanted> {
    let area = layout::picture_area(state)?;
    let graphics = &state.picture.graphics;
    let (playing, still) = graphics.bytes;
    let protocol = protocol(state);
    let part = part(state)?;
    let sight = painting::sight(state);
    let over = switched(state, &part, protocol, matches!(sight, Some(Sight::From(_))));
    let marks = || Marks {
        view: overlays(state),
        cursor: state.picture.cursor,
        aim: place::selected(state).filter(|_| matches!(state.typing.mode, Mode::Aim)),
    };
    Some(Wanted {
        part,
        cells: (area.width, area.height),
        protocol,
        tmux: graphics.tmux,
        bytes: if state.play.playing { playing } else { still },
        calm: state.play.playing && protocol == Protocol::Blocks,
        pass: state.picture.pass.clone().filter(|_| state.picture.looking.is_none() && !is_painting(&sight)),
        clip: looking::view(state),
        sight,
        over,
        marks: (protocol != Protocol::Blocks).then(marks),
    })
}

/// Where the cursor is in the pane, in cells from its corner.
pub fn cursor_cell(state: &State, part: &Part) -> Point {
    let (across, down) = state.picture.graphics.dots_a_cell(protocol(state));
    let dot = part.dot_of(state.picture.cursor);
    Point::new((dot.x / across as f64).floor(), (dot.y / down as f64).floor())
}
