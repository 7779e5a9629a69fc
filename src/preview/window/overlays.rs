//! What of the overlays the window shows, and how densely: no more than stays legible.

use super::state::State;
use crate::base::maths::pow;
use crate::layers::parts::marks::{Overlay, View, When};
use crate::render::overlay::{self, overlays};
use crate::render::sight::Sight;

/// An arrow of the vector field stands about every so many logical pixels of the screen, unless keys change it, by so many
/// times twice or half.
const FIELD_PX: f64 = 22.0;
/// A square of the field in colors, in logical pixels of the screen.
const WHEEL_PX: f64 = 4.0;

/// Lines shorter than this, in logical pixels of the screen, run together.
const LEAST_PX: f64 = 2.0;

impl State {
    /// Pixels of the picture between two of those whose jump vectors are shown, when they are about `px` logical pixels
    /// of the screen apart: a power of two.
    fn spacing(&self, px: f64) -> f64 {
        overlay::spacing(px * self.scale / self.viewport.zoom)
    }

    /// Pixels of the picture between two arrows of the field, two jump paths or two samplers.
    pub fn field_spacing(&self) -> f64 {
        self.spacing(FIELD_PX * pow(2.0, f64::from(self.field_step)))
    }

    /// Whether anything is shown of the vectors of pixels.
    pub fn shows_vectors(&self) -> bool {
        overlays().any(|overlay| overlay.when != When::Document && self.shows(overlay.name))
    }

    /// What stays as it is while the animation runs.
    pub fn fixed_view(&self) -> View {
        self.view(|when| when != When::EveryFrame)
    }

    /// What changes with every frame.
    pub fn moving_view(&self) -> View {
        let view = self.view(|when| when == When::EveryFrame);
        let now = self.transport.scene_time(&self.timeline);
        let times = if view.shown.is_empty() { Vec::new() } else { overlay::times(now, self.timeline.wrap) };
        View { times, ..view }
    }

    /// The overlays that are shown, no denser than stays legible on the screen.
    fn view(&self, wanted: impl Fn(When) -> bool) -> View {
        let is_on = |overlay: &Overlay| {
            self.shows(overlay.name) || self.sight.as_ref().is_some_and(Sight::selects) && overlay.selects
        };
        let shown = overlays().filter(|overlay| wanted(overlay.when) && is_on(overlay));
        View {
            shown: shown.map(|overlay| overlay.name).collect(),
            spacing_px: self.field_spacing(),
            cell_px: self.spacing(WHEEL_PX),
            vectors: self.switches.vectors.clone(),
            least_px: LEAST_PX * self.scale / self.viewport.zoom,
            selection: self.selection.clone(),
            ..View::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_field_keeps_its_distance_on_the_screen() {
        let mut state = State::for_tests();
        state.run("view-field");
        for _ in 0..16 {
            let on_screen = state.fixed_view().spacing_px * state.viewport.zoom;
            assert!(on_screen >= FIELD_PX, "{on_screen}");
            state.run("zoom-out");
        }
    }
}
