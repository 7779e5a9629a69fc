//! Impulses that are fixed to the frame, in a grid of cells: a pattern behind a shower door.

use std::ops::RangeInclusive;

use glam::{DVec2, DVec3};

use super::impulse::{Dice, Impulse, Recipe, factor};

/// The columns and rows of cells that may have impulses in a frame, if kernels have this radius.
pub fn cells((width, height): (usize, usize), radius_px: f64) -> [RangeInclusive<i32>; 2] {
    [width, height].map(|length| -1..=((length as f64 + radius_px) / (2.0 * radius_px)).floor() as i32)
}

/// All impulses of a noise that may be seen in a frame; strokes run at `angle`, clockwise from +x, in radians.
pub fn impulses(size_px: (usize, usize), recipe: &Recipe, angle: f64) -> Vec<Impulse> {
    let side = 2.0 * recipe.radius_px;
    let wanted = 4.0 * recipe.overlap / std::f64::consts::PI;
    let mut found = Vec::new();
    let [columns, rows] = cells(size_px, recipe.radius_px);
    for a in columns {
        for b in rows.clone() {
            Dice::each([a as u32, b as u32], recipe, wanted, |dice| {
                let (factor, [x, y]) = (factor(wanted, dice.rank), dice.place);
                if factor > 0.0 {
                    found.push(Impulse {
                        of: dice.of,
                        at: DVec2::new(f64::from(a) + x, f64::from(b) + y) * side,
                        depth: 1.0,
                        factor,
                        phase: dice.phase,
                        angle: angle + dice.spread,
                        sure: 1.0,
                        radius_px: recipe.radius_px,
                        spacing_px: recipe.spacing_px,
                        plane: DVec3::ZERO,
                    });
                }
            });
        }
    }
    found
}
