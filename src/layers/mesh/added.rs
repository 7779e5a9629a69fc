//! What a slot of the mesh layer adds to what is known of the technique without a layer.

use crate::layers::parts::marks::{Look, Overlay};
use crate::layers::parts::pass::Pass;
use crate::layers::parts::plan::{Program, Routine};
use crate::layers::parts::twin::Twin;
use crate::layers::starts::{Comparison, Starts, Styles};

/// See `Kind`, whose fields these go to.
pub struct Added {
    /// Its programs.
    pub programs: &'static [&'static Program],
    /// Its routines.
    pub routines: &'static [&'static Routine],
    /// What these read of structs.
    pub twins: &'static [Twin],
    /// Its overlays.
    pub overlays: &'static [Overlay],
    /// How they look, in ascending order.
    pub looks: &'static [&'static Look],
    /// Its passes.
    pub passes: &'static [Pass],
    /// What is looked at in place of one of them, under names of their own.
    pub colors: &'static [Pass],
    /// How new things in it begin.
    pub starts: Starts,
    /// Its styles.
    pub styles: Option<&'static Styles>,
    /// Ways of it that can be looked at side by side.
    pub comparisons: &'static [Comparison],
}

impl Added {
    /// Nothing.
    pub const NONE: Added = Added {
        programs: &[],
        routines: &[],
        twins: &[],
        overlays: &[],
        looks: &[],
        passes: &[],
        colors: &[],
        starts: Starts::PLAIN,
        styles: None,
        comparisons: &[],
    };
}
