//! A cliff with a notch for a waterfall, its pool and its stones: positions alone, normals come from the faces.

use std::fmt::Write;

use plica::base::maths::{TAU, cos, sin, smoothstep};

use super::{HALF, Xyz, share, short};
use crate::pictures::noise::fbm;

/// Positions and faces in the making.
#[derive(Default)]
struct Ground {
    positions: Vec<Xyz>,
    faces: String,
}

impl Ground {
    /// Adds a sheet of rows and columns of faces, which is seen with its rows upward and its columns to the right. Corners at
    /// one place are one corner.
    fn sheet(&mut self, rows: usize, columns: usize, place: impl Fn(usize, usize) -> Xyz) {
        let first = self.positions.len();
        let places = (0..=rows).flat_map(|i| (0..=columns).map(move |j| (i, j)));
        self.positions.extend(places.map(|(i, j)| place(i, j).map(|v| short((v * 1e3).round() / 1e3))));
        let at = |i: usize, j: usize| first + i * (columns + 1) + j;
        for (i, j) in (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))) {
            let corners = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            let apart = |k: &usize| self.positions[corners[*k]] != self.positions[corners[(k + 1) % 4]];
            let named = (0..4).filter(apart).map(|k| format!(" {}", corners[k] + 1)).collect::<String>();
            let _ = writeln!(self.faces, "f{named}");
        }
    }

    fn text(self) -> String {
        let row = |[x, y, z]: &Xyz| format!("v {x} {y} {z}\n");
        self.positions.iter().map(row).collect::<String>() + &self.faces
    }
}

/// A wall of rock 2 m high with a notch 2 m wide, and the ground above it.
pub fn cliff() -> String {
    let (face, rows, columns) = (26, 34, 60);
    let mut ground = Ground::default();
    ground.sheet(rows, columns, |i, j| {
        let x = 7.0 * (share(j, columns) - 0.5);
        let beside = smoothstep(1.0, 1.5, x.abs());
        let top = 1.95 + beside * (0.3 + 0.25 * fbm(0.9 * x, 3.3, 3, 71));
        // Banks come forward on both sides of the pool.
        let bank = 1.5 * smoothstep(1.3, 3.4, x.abs());
        let (up, back) = ((share(i, face)).min(1.0), share(i.saturating_sub(face), rows - face));
        let rough = 0.8 * fbm(1.2 * x, 2.4 * up + 5.0, 4, 73) + 0.2 * fbm(4.0 * x, 7.0 * up, 2, 79);
        let quiet = 1.0 - 0.75 * (1.0 - beside) * smoothstep(0.6, 1.0, up);
        let z = bank - 0.25 - 0.35 * up * beside + rough * quiet;
        [x, -0.4 + (top + 0.4) * up + 0.3 * back * beside, z.min(bank + 0.1) - 3.0 * back]
    });
    ground.text()
}

/// The water beneath, level.
pub fn pool() -> String {
    let mut ground = Ground::default();
    ground.sheet(8, 8, |i, j| [14.0 * (share(j, 8) - 0.5), 0.0, 7.0 - 9.0 * share(i, 8)]);
    ground.text()
}

/// Stones in the pool: the middle and the radius of each.
const STONES: [(Xyz, f64); 7] = [
    ([-1.75, 0.05, 1.0], 0.36),
    ([-2.35, 0.1, 1.6], 0.5),
    ([-1.2, -0.02, 2.0], 0.2),
    ([1.6, 0.02, 1.15], 0.3),
    ([2.3, 0.12, 1.5], 0.55),
    ([1.15, -0.03, 1.9], 0.22),
    ([0.35, -0.06, 2.3], 0.2),
];

/// The stones, worn by the water.
pub fn stones() -> String {
    let (rows, columns) = (12, 20);
    let mut ground = Ground::default();
    for (seed, ([x, y, z], radius)) in (91..).zip(STONES) {
        ground.sheet(rows, columns, |i, j| {
            let (up, round) = (HALF * (share(i, rows) - 0.5), TAU * share(j % columns, columns));
            let [a, b, c] = [cos(up) * sin(round), sin(up), cos(up) * cos(round)];
            let r = radius * (1.0 + 0.25 * fbm(1.3 * a + 0.7 * c, 1.3 * b - 0.9 * c, 3, seed));
            [x + 1.15 * r * a, y + 0.75 * r * b, z + r * c]
        });
    }
    ground.text()
}
