//! How marks look: one table of colours, widths, dashes and dots, and the wheel of colours for directions.

use kurbo::Vec2;

use crate::base::oklab::srgb;

/// What a mark shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// The jump vectors of pixels as colours.
    Wheel,
    /// The jump vectors of pixels.
    Field,
    /// The outline of a zone.
    ZoneOutline,
    /// A fold region.
    FoldRegion,
    /// The jump path of a pixel.
    Path,
    /// A curve along which anchors stand.
    Curve,
    /// A lasso, where it is.
    Lasso,
    /// A node of a path or curve, and the lines to its handles.
    Handle,
    /// The jump vector of an anchor.
    Jump,
    /// An anchor that moves.
    Anchor,
    /// An anchor with a jump of (0, 0).
    Still,
    /// Where a jump path meets a fold region.
    Threshold,
    /// A sampler that a fold keeps still.
    Resting,
    /// A sampler, at its effective place.
    Sampler,
}

/// How a kind looks. Lengths are in pixels of the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// sRGB with straight alpha.
    pub color: [u8; 4],
    /// Width of lines.
    pub width_px: f32,
    /// Length of a dash and of the gap after it; none: solid.
    pub dash_px: Option<(f32, f32)>,
    /// The shape of dots.
    pub dot: Dot,
    /// Radius of dots.
    pub dot_px: f32,
}

/// The shape of a dot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dot {
    /// A filled disc.
    Disc,
    /// A filled square.
    Square,
    /// A filled square on its corner.
    Diamond,
}

/// The look of what is selected: this colour, and lines and dots larger by [`SELECTED_GROWTH`].
pub const SELECTED: [u8; 4] = [255, 255, 255, 255];
/// See [`SELECTED`].
pub const SELECTED_GROWTH: f32 = 1.6;
/// Opacity of a [`Shape::Fill`] in its kind's colour.
pub const FILL_ALPHA: f32 = 0.16;

/// Every kind, what it is called, and its look. The colours keep apart for colour-blind eyes (after Okabe and Ito).
pub const STYLES: [(Kind, &str, Style); 14] = {
    const fn style(color: [u8; 4], width_px: f32, dash_px: Option<(f32, f32)>, dot: Dot, dot_px: f32) -> Style {
        Style { color, width_px, dash_px, dot, dot_px }
    }
    [
        (Kind::Wheel, "vector field as colours", style([255, 255, 255, 220], 0.0, None, Dot::Square, 0.0)),
        (Kind::Field, "vector field", style([190, 205, 220, 230], 1.0, None, Dot::Disc, 1.0)),
        (Kind::ZoneOutline, "zone outline", style([86, 180, 233, 255], 1.6, None, Dot::Square, 3.0)),
        (Kind::FoldRegion, "fold region", style([240, 160, 40, 255], 1.6, Some((6.0, 4.0)), Dot::Square, 3.0)),
        (Kind::Path, "jump path", style([240, 230, 190, 190], 1.0, None, Dot::Disc, 1.5)),
        (Kind::Curve, "curve", style([214, 130, 190, 255], 1.6, None, Dot::Diamond, 4.0)),
        (Kind::Lasso, "lasso", style([240, 228, 66, 255], 1.4, Some((2.0, 3.0)), Dot::Square, 3.0)),
        (Kind::Handle, "handle", style([170, 150, 165, 255], 1.0, None, Dot::Diamond, 3.5)),
        (Kind::Jump, "jump vector", style([60, 210, 160, 255], 1.8, None, Dot::Disc, 2.0)),
        (Kind::Anchor, "anchor", style([60, 210, 160, 255], 1.4, None, Dot::Disc, 3.5)),
        (Kind::Still, "still anchor", style([235, 120, 80, 255], 1.4, None, Dot::Square, 2.5)),
        (Kind::Threshold, "threshold", style([240, 160, 40, 255], 1.2, None, Dot::Diamond, 3.0)),
        (Kind::Resting, "resting sampler", style([150, 160, 175, 255], 1.2, None, Dot::Square, 1.8)),
        (Kind::Sampler, "sampler", style([255, 236, 150, 255], 1.2, None, Dot::Disc, 2.2)),
    ]
};

impl Kind {
    /// How the kind looks.
    pub fn style(self) -> Style {
        let row = STYLES.iter().find(|(kind, ..)| *kind == self);
        row.expect("every kind has a style").2
    }
}

/// The colour of a jump vector where the longest is `longest`: its hue is the direction on the screen, and the longer the
/// lighter and the more colourful it is. No jump is dark grey.
pub fn wheel(jump: Vec2, longest: f64) -> [u8; 4] {
    let length = jump.hypot2().sqrt();
    let share = if longest > 0.0 { (length / longest).min(1.0) } else { 0.0 };
    let way = if length > 0.0 { jump / length } else { Vec2::ZERO } * (0.02 + 0.12 * share);
    let [r, g, b] = srgb([0.28 + 0.46 * share, way.x, way.y]);
    [r, g, b, Kind::Wheel.style().color[3]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_has_a_style_of_its_own() {
        for (i, (_, name, style)) in STYLES.iter().enumerate() {
            for (_, other, s) in &STYLES[i + 1..] {
                let look = |s: &Style| (s.width_px, s.dash_px, s.dot, s.dot_px);
                assert!(look(style) != look(s), "{name} {other}");
            }
        }
    }

    #[test]
    fn the_wheel_tells_directions_and_lengths_apart() {
        let ways = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (0.5, 0.0), (0.0, 0.0)];
        let colors = ways.map(|way| wheel(way.into(), 1.0));
        for (i, color) in colors.iter().enumerate() {
            assert!(colors[i + 1..].iter().all(|other| (0..3).any(|c| color[c].abs_diff(other[c]) > 30)), "{colors:?}");
        }
        assert_eq!(wheel(Vec2::ZERO, 0.0), colors[5]);
    }
}
