//! What else flows along lines: presets that turn the default fall into a fountain, smoke, a fire or a cloud.

use crate::layers::starts::Preset;

macro_rules! preset {
    ($name:literal, $help:literal, $wants:literal) => {
        Preset {
            name: $name,
            help: $help,
            wants: $wants,
            patch: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/profiles/waterfall/", $name, ".json")),
        }
    };
}

/// All of them.
pub const PRESETS: &[Preset] = &[
    preset!("curtain", "a thin, even sheet of water, as over a weir", ""),
    preset!("fountain", "a jet of water that rises from one place and falls around it", ""),
    preset!(
        "smoke",
        "smoke that rises from one place and spreads",
        "a camera that sees it rise (in the editor :camera fit)"
    ),
    preset!("fire", "flames from a burning log or bowl", "a clip that was taken against black"),
    preset!("cloud", "a cloud that drifts slowly and never ends", "a timeline of 12 s (timeline.duration=12)"),
];
