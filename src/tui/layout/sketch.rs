//! What is drawn small beside the table.

use crate::base::pointer::Pointer;
use crate::layers::parts::sketch::Sketch;
use crate::tui::state::State;

/// The small drawing of what is selected, and the index of its layer.
pub fn sketch(state: &State) -> Option<(usize, Sketch)> {
    let focused = state.focused();
    let (layer, path) = Pointer(&focused).item_of("/layers")?;
    Some((layer, state.document().scene().layers.get(layer)?.technique().sketch(path)?))
}
