//! The colors and sizes of everything around the picture.

use super::stroke::Color;

/// What is around the picture, one after the other by a key: dark, black, gray, light.
pub const BACKGROUNDS: [Color; 4] = [[18, 20, 24, 255], [0, 0, 0, 255], [119, 119, 119, 255], [235, 235, 235, 255]];
pub const PANEL: Color = [22, 24, 29, 238];
pub const RAIL: Color = [58, 64, 74, 255];
pub const ACCENT: Color = [86, 180, 233, 255];
pub const TEXT: Color = [205, 210, 218, 255];
pub const WARNING: Color = [240, 160, 40, 255];
pub const DIM: Color = [132, 141, 153, 255];

/// Height of a capital, in logical pixels.
pub const TEXT_PX: f64 = 8.0;
pub const MARGIN_PX: f64 = 12.0;
