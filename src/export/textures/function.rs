//! Position functions as a texture: one row a zone, 1024 places in τ.

use super::data::{Channel, Texture};
use crate::base::pixels::Grid;
use crate::layers::folding::position::{Break, Position, Side};

/// Places in τ.
pub const COLUMNS: usize = 1024;
/// Places between two columns at which the error is measured.
const BETWEEN: usize = 8;

/// One row a position function.
pub fn texture(rows: &[&Position]) -> Texture {
    let cell = |position: &&Position, i: usize| [position.eval(tau(i as f64)), 0.0, 0.0, 0.0];
    let mut cells: Vec<[f64; 4]> = rows.iter().flat_map(|row| (0..COLUMNS).map(move |i| cell(row, i))).collect();
    if rows.is_empty() {
        cells = vec![[0.0; 4]; COLUMNS]; // a scene without zones: a texture has at least one row
    }
    let channels = vec![Channel::new("s", "place along the jump path", 0)];
    Texture { values: Grid::from_cells(COLUMNS, rows.len().max(1), cells), channels }
}

/// The largest difference between a function and what is read between texels.
pub fn error_between(rows: &[&Position]) -> f64 {
    rows.iter().map(|position| error_of(position)).fold(0.0, f64::max)
}

fn error_of(position: &Position) -> f64 {
    let texels: Vec<f64> = (0..COLUMNS).map(|i| position.eval(tau(i as f64))).collect();
    let breaks = position.breaks();
    let places = (0..(COLUMNS - 1) * BETWEEN).map(|k| tau(k as f64 / BETWEEN as f64));
    places.map(|tau| (read(&texels, &breaks, tau) - position.eval(tau)).abs()).fold(0.0, f64::max)
}

/// What a player reads at `tau`.
fn read(texels: &[f64], breaks: &[Break], tau: f64) -> f64 {
    let last = texels.len() - 1;
    let x = tau * last as f64;
    let i = (x.floor() as usize).min(last - 1);
    let at = |tau: f64| tau * last as f64;
    let within = breaks.iter().find(|b| at(b.tau) >= i as f64 && at(b.tau) <= (i + 1) as f64);
    let from = match within {
        None => i,
        Some(b) if tau < b.tau || (tau == b.tau && b.holds == Side::Before) => match i {
            0 => return texels[0],
            _ => i - 1,
        },
        Some(_) if i + 1 == last => return texels[last],
        Some(_) => i + 1,
    };
    texels[from] + (texels[from + 1] - texels[from]) * (x - from as f64)
}

fn tau(column: f64) -> f64 {
    column / (COLUMNS - 1) as f64
}
