//! Position functions as a texture: one row per zone, columns spread evenly in τ. The manifest adds knots between them:
//! where s jumps or bends, and where it is too steep for straight lines from column to column.

use crate::base::pixels::Grid;
use crate::layers::folding::position::Position;
use crate::layers::parts::bundle::{Channel, Texture};

/// Numbers of columns, the first that will do is taken.
const COLUMNS: [usize; 4] = [1024, 4096, 16384, 65536];
/// A row with at most this many knots will do.
const FEW: usize = 512;
/// No row has more, however far off it is.
const MOST: usize = 4096;
/// Places between two points at which the error is measured.
const BETWEEN: usize = 8;
/// Values nearer to each other than this are one.
const SAME: f64 = 1e-9;
/// No two knots are nearer to each other in τ.
const NEAREST: f64 = 1e-12;

/// A place in τ, and s just before it, at it, and just after it.
pub type Knot = [f64; 4];

/// A position function, and how far off s may be between its points.
pub struct Row<'a> {
    /// The function.
    pub position: &'a Position,
    /// The largest error.
    pub tolerance: f64,
}

/// The position functions of a scene.
pub struct Table<'a> {
    rows: &'a [Row<'a>],
    columns: usize,
    /// The knots of each row, ascending.
    pub knots: Vec<Vec<Knot>>,
}

impl<'a> Table<'a> {
    /// With as many columns and knots as the tolerances need; only `exact` numbers are worth more than the fewest columns.
    pub fn new(rows: &'a [Row<'a>], exact: bool) -> Self {
        let sizes = if exact { &COLUMNS[..] } else { &COLUMNS[..1] };
        let mut columns = sizes[0];
        for &size in sizes {
            columns = size;
            let will_do = |row: &Row| {
                let knots = refined(row.position, row.tolerance, columns).len();
                knots <= FEW.max(2 * row.position.corners().len())
            };
            if rows.iter().all(will_do) {
                break;
            }
        }
        let knots = rows.iter().map(|row| knots(row, columns)).collect();
        Table { rows, columns, knots }
    }

    /// One row a function.
    pub fn texture(&self) -> Texture {
        let cell = |row: &Row, i: usize| [row.position.eval(self.tau(i)), 0.0, 0.0, 0.0];
        let cells = self.rows.iter().flat_map(|row| (0..self.columns).map(move |i| cell(row, i)));
        let mut cells: Vec<[f64; 4]> = cells.collect();
        if cells.is_empty() {
            cells = vec![[0.0; 4]; self.columns]; // a scene without zones: a texture has at least one row
        }
        let channels = vec![Channel::new("s", "place along the jump path", 0)];
        Texture { values: Grid::from_cells(self.columns, self.rows.len().max(1), cells), channels }
    }

    /// The largest difference between a function and its interpolation.
    pub fn error_between(&self) -> f64 {
        let of_row = |(row, knots): (&Row, &Vec<Knot>)| {
            let texels: Vec<f64> = (0..self.columns).map(|i| row.position.eval(self.tau(i))).collect();
            let steps = (self.columns - 1) * BETWEEN;
            let places = (0..steps).map(|k| k as f64 / steps as f64);
            let error = |tau| (read(&texels, knots, tau) - row.position.eval(tau)).abs();
            places.map(error).fold(0.0, f64::max)
        };
        self.rows.iter().zip(&self.knots).map(of_row).fold(0.0, f64::max)
    }

    fn tau(&self, column: usize) -> f64 {
        column as f64 / (self.columns - 1) as f64
    }
}

/// What a player reads at `tau`.
fn read(texels: &[f64], knots: &[Knot], tau: f64) -> f64 {
    let last = (texels.len() - 1) as f64;
    let i = ((tau * last).floor() as usize).min(texels.len() - 2);
    let (mut left, mut right) = ((i as f64 / last, texels[i]), ((i + 1) as f64 / last, texels[i + 1]));
    for &[t, before, at, after] in &knots[knots.partition_point(|knot| knot[0] < left.0)..] {
        if t == tau {
            return at;
        }
        if t < tau {
            left = (t, after);
        } else {
            if t <= right.0 {
                right = (t, before);
            }
            break;
        }
    }
    left.1 + (right.1 - left.1) * (tau - left.0) / (right.0 - left.0)
}

/// Jumps and bends, and the knots that it takes to be within the tolerance, or as near to it as the limit on knots allows.
fn knots(row: &Row, columns: usize) -> Vec<Knot> {
    let mut tolerance = row.tolerance;
    loop {
        let knots = refined(row.position, tolerance, columns);
        if knots.len() <= MOST.max(row.position.corners().len()) {
            return knots;
        }
        tolerance *= 4.0;
    }
}

fn refined(position: &Position, tolerance: f64, columns: usize) -> Vec<Knot> {
    let mut corners = position.corners();
    corners.dedup();
    let mut corners = corners.into_iter().filter(|tau| (0.0..=1.0).contains(tau)).peekable();
    let mut found = Vec::new();
    let mut left = [0.0, position.eval(0.0)];
    for column in 0..columns {
        let tau = column as f64 / (columns - 1) as f64;
        while let Some(corner) = corners.next_if(|corner| *corner <= tau) {
            let knot = knot(position, corner);
            refine(position, left, [corner, knot[1]], tolerance, &mut found);
            found.push(knot);
            left = [corner, knot[3]];
        }
        if tau > left[0] {
            let right = [tau, position.eval(tau)];
            refine(position, left, right, tolerance, &mut found);
            left = right;
        }
    }
    found
}

fn knot(position: &Position, tau: f64) -> Knot {
    let at = position.eval(tau);
    let beside = |tau: f64| {
        let s = position.eval(tau.clamp(0.0, 1.0));
        if (s - at).abs() > SAME { s } else { at }
    };
    [tau, beside(tau.next_down()), at, beside(tau.next_up())]
}

/// Adds knots between two points until straight lines are within the tolerance.
fn refine(position: &Position, left: [f64; 2], right: [f64; 2], tolerance: f64, found: &mut Vec<Knot>) {
    let ([t0, s0], [t1, s1]) = (left, right);
    let off = |k: usize| {
        let part = k as f64 / BETWEEN as f64;
        (position.eval(t0 + (t1 - t0) * part) - (s0 + (s1 - s0) * part)).abs()
    };
    if t1 - t0 < NEAREST || found.len() > MOST || (1..BETWEEN).all(|k| off(k) <= tolerance) {
        return;
    }
    let middle = (t0 + t1) / 2.0;
    let s = position.eval(middle);
    refine(position, left, [middle, s], tolerance, found);
    found.push([middle, s, s, s]);
    refine(position, [middle, s], right, tolerance, found);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_read_is_within_the_tolerance() {
        for (json, columns) in [
            (r#"{"function":"linear"}"#, 1024),
            (r#"{"function":"cosine"}"#, 1024),
            (r#"{"function":"sine","cycles":100}"#, 65536),
            (r#"{"function":"sigmoid","rate":1e6}"#, 1024),
            (r#"{"function":"cubic-bezier","x1":1,"y1":0,"x2":0,"y2":1}"#, 1024),
            (r#"{"function":"keyframes","points":[[0.3,0],[0.3001,1],[0.30015,-3],[0.8,2]]}"#, 1024),
            (r#"{"function":"keyframes","points":[[0.1,0.2],[0.5,1.3],[0.75,0]],"between":"step"}"#, 1024),
        ] {
            let position: Position = serde_json::from_str(json).unwrap();
            let rows = [Row { position: &position, tolerance: 2e-5 }];
            let table = Table::new(&rows, true);
            assert!(table.error_between() <= 2.5e-5, "{json}: {}", table.error_between());
            assert!(table.knots[0].len() <= FEW, "{json}: {} knots", table.knots[0].len());
            assert_eq!(table.columns, columns, "{json}");
        }
    }
}
