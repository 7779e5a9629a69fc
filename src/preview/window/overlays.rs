//! What of the overlays the window shows, and how densely: as much as the screen can bear.

use super::state::State;
use crate::base::maths::pow;
use crate::layers::timeline::Wrap;
use crate::render::overlay::{Samplers, View};

/// An arrow of the vector field stands about every so many logical pixels of the screen, unless keys change it, by so many
/// times twice or half.
const FIELD_PX: f64 = 22.0;
/// A square of the field in colors, in logical pixels of the screen.
const WHEEL_PX: f64 = 4.0;
/// How often samplers are shown where they were before, and how far apart that is, as a share of the timeline.
const ONION: (u32, f64) = (6, 1.0 / 48.0);

impl State {
    /// Pixels of the picture between two of those whose jump vectors are shown, when they are about `px` logical pixels
    /// of the screen apart: a power of two.
    fn spacing(&self, px: f64) -> f64 {
        let wanted = px * self.scale / self.camera.zoom;
        (0..24).map(|k| f64::from(1 << k)).find(|&s| s >= wanted).unwrap_or(wanted)
    }

    /// The samplers that are shown: now, and where they were before.
    pub fn samplers(&self) -> Option<Samplers> {
        let now = self.transport.scene_time(&self.timeline);
        let before = (1..=ONION.0).map(|k| now - f64::from(k) * ONION.1);
        let before = before.filter_map(|t| match self.timeline.wrap {
            Wrap::Once => (t >= 0.0).then_some(t),
            Wrap::Repeat | Wrap::PingPong => Some(t.rem_euclid(1.0)),
        });
        let before = before.filter(|_| self.shows("view-onion"));
        let shown = self.shows("view-samplers") || self.shows("view-onion");
        shown.then(|| Samplers { spacing: self.field_spacing(), times: std::iter::once(now).chain(before).collect() })
    }

    /// Pixels of the picture between two arrows of the field, two jump paths or two samplers.
    pub fn field_spacing(&self) -> f64 {
        self.spacing(FIELD_PX * pow(2.0, f64::from(self.field_step)))
    }

    /// Whether anything is shown of the jump vectors of pixels.
    pub fn shows_jumps(&self) -> bool {
        let of_jumps = ["view-field", "view-wheel", "view-paths", "view-samplers", "view-onion", "view-thresholds"];
        of_jumps.iter().any(|name| self.shows(name))
    }

    /// What the overlay shows but the samplers, its field as dense as the screen bears.
    pub fn overlay_view(&self) -> View {
        let spacing = Some(self.field_spacing());
        View {
            outlines: self.shows("view-outlines"),
            regions: self.shows("view-regions"),
            anchors: self.shows("view-anchors"),
            curves: self.shows("view-curves"),
            labels: self.shows("view-labels"),
            field: spacing.filter(|_| self.shows("view-field")),
            wheel: self.shows("view-wheel").then(|| self.spacing(WHEEL_PX)),
            paths: spacing.filter(|_| self.shows("view-paths")),
            thresholds: spacing.filter(|_| self.shows("view-thresholds")),
            samplers: None,
            selection: self.selection.clone(),
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
            let on_screen = state.overlay_view().field.unwrap() * state.camera.zoom;
            assert!(on_screen >= FIELD_PX, "{on_screen}");
            state.run("zoom-out");
        }
    }
}
