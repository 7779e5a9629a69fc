//! Looking at a clip, in the picture's pane, while pictures are picked from it.

use kurbo::Point;

pub use super::picture::Looking;
use super::{State, painting};
use crate::base::pointer::Pointer;
use crate::layers::parts::picking::{Picking, Picks};
use crate::scene::field;
use crate::tui::graphics::clip::ClipView;
use crate::tui::graphics::viewport::Viewport;

/// Where the layer that the tree's cursor is in has its picks, and whether the cursor is on the node for them.
pub fn picks(state: &State) -> Option<(usize, Picks, bool)> {
    let node = &state.cursor.node;
    let (index, way) = Pointer(node).item_of("/layers")?;
    let (layer, _) = field::layer_of(state.document(), node)?;
    layer.picks().map(|picks| (index, picks, picks.node == way))
}

/// What there is to see.
fn seen(state: &State, looking: Looking) -> Option<Picking> {
    state.picture.synth.as_ref()?.layers.get(looking.layer)?.picking(looking.sight())
}

/// What the picture's pane shows in place of the scene.
pub fn view(state: &State) -> Option<ClipView> {
    let looking = state.picture.looking?;
    Some(ClipView { layer: looking.layer, sight: looking.sight(), selection: state.focused() })
}

/// Takes what is looked at, or the scene again. Between the two, and between pictures of other sizes, the pane shows all of it.
pub fn look(state: &mut State, looking: Option<Looking>) {
    let before = state.picture.looking.is_some();
    let found = looking.and_then(|looking| Some((looking, seen(state, looking)?)));
    state.picture.looking = found.as_ref().map(|(looking, seen)| {
        let Picking { frames, followed, side, .. } = *seen;
        Looking { frames, followed, side, ..*looking }
    });
    let of_scene = painting::size(state);
    let size = found.map(|(_, seen)| (seen.picture.width(), seen.picture.height())).or(of_scene);
    let other = std::mem::replace(&mut state.picture.size, size) != size;
    if other && (before || state.picture.looking.is_some()) {
        let (width, height) = size.unwrap_or_default();
        let center = Point::new((width / 2) as f64 + 0.5, (height / 2) as f64 + 0.5);
        state.picture.viewport = Viewport { zoom: None, center };
        state.picture.cursor = center;
    }
}
