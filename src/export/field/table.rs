//! A vector field as a table.

use std::fmt::Write;

use super::Arrow;
use super::strokes::degrees;
use crate::files::outputs::CSV_HEADER;

/// Comma-separated values with a head: the center of each pixel, its jump vector, that vector's length, and its direction
/// in degrees from the x axis toward the y axis (clockwise on the screen); 0 where there is no jump.
pub fn csv(arrows: &[Arrow]) -> String {
    let mut text = format!("{CSV_HEADER}\n");
    for arrow in arrows {
        let Arrow { at, jump: [dx, dy] } = arrow;
        let length = arrow.vector().hypot2().sqrt();
        let degrees = if length > 0.0 { degrees(arrow.vector()) } else { 0.0 };
        let _ = writeln!(text, "{},{},{dx},{dy},{length:.6},{degrees:.4}", at.x, at.y); // a String takes all
    }
    text
}
