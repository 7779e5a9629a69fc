//! What a waterfall is made from, as pictures of numbers.

use glam::{DVec2, DVec3};

use super::cells::{covered, inside};
use super::lines::Line;
use super::splat::Splat;
use super::synth::Synth;
use crate::base::pixels::Rgba;
use crate::layers::parts::pass::{Holds, Pass};
use crate::layers::space::eye::{Eye, NEAR_M};

/// Pieces that a line is drawn in.
pub const PIECES: usize = 64;

/// The lines.
pub const LINES: Pass = Pass {
    name: "lines",
    help: "flow lines: number from 1, age in seconds, speed in m/s; 0 where none is",
    holds: Holds::Speed,
};
/// The sprites.
pub const SPRITES: Pass =
    Pass { name: "sprites", help: "how many sprites of water and the like lie over a pixel", holds: Holds::Count };

/// Adds how many sprites lie over each place of a row.
pub fn sprites(splats: &[Splat], places: &[Vec<f64>; 2], depth: &mut [f64], out: &mut [Rgba]) {
    for splat in splats {
        let Some([columns, _]) = covered(splat, places) else { continue };
        for x in columns.filter(|&x| inside(splat, places[0][x], places[1][0]).is_some()) {
            if splat.depth < depth[x] {
                let [count, ..] = out[x];
                out[x] = [count + 1.0, count + 1.0, count + 1.0, 1.0];
            }
        }
    }
}

/// A piece of a line in the frame.
pub struct Piece {
    /// The number of the line.
    line: usize,
    /// Where it begins and ends, in pixels.
    ends: [DVec2; 2],
    /// How far away its ends are, in meters.
    depths: [f64; 2],
    /// How old what is carried is there, in seconds.
    ages: [f64; 2],
}

/// The pieces of all lines.
pub fn pieces(synth: &Synth, eye: &Eye) -> Vec<Piece> {
    let of_line = |(line, path): (usize, &Line)| {
        let age = |i: usize| path.life * i as f64 / PIECES as f64;
        let ends: Vec<DVec3> = (0..=PIECES).map(|i| eye.seen(synth.values.laws.at(&path.path, age(i)).0)).collect();
        let piece = |i: usize| piece(eye, line, [ends[i], ends[i + 1]], [age(i), age(i + 1)]);
        (0..PIECES).filter_map(piece).collect::<Vec<_>>()
    };
    synth.lines.iter().enumerate().filter(|(_, line)| line.carries()).flat_map(of_line).collect()
}

/// What of a piece is in front of the eye.
fn piece(eye: &Eye, line: usize, [a, b]: [DVec3; 2], [from, to]: [f64; 2]) -> Option<Piece> {
    let share = (NEAR_M + a.z) / (a.z - b.z);
    let cut = (a.lerp(b, share).with_z(-NEAR_M), from + (to - from) * share);
    let (first, last) = match (-a.z >= NEAR_M, -b.z >= NEAR_M) {
        (true, true) => ((a, from), (b, to)),
        (true, false) => ((a, from), cut),
        (false, true) => (cut, (b, to)),
        (false, false) => return None,
    };
    Some(Piece {
        line,
        ends: [eye.project(first.0), eye.project(last.0)],
        depths: [-first.0.z, -last.0.z],
        ages: [first.1, last.1],
    })
}

/// Draws the pieces that meet a row, one pixel thick, where they are nearer than `depth`, which becomes theirs.
pub fn lines(synth: &Synth, pieces: &[Piece], places: &[Vec<f64>; 2], depth: &mut [f64], out: &mut [Rgba]) {
    let y = places[1][0];
    for piece in pieces {
        let [a, b] = piece.ends;
        let way = b - a;
        let (low, high) = (a.y.min(b.y), a.y.max(b.y));
        if low > y + 0.5 || high < y - 0.5 {
            continue;
        }
        let mut put = |cell: usize, share: f64| {
            let inverse = piece.depths.map(|depth| 1.0 / depth);
            let found = 1.0 / (inverse[0] + (inverse[1] - inverse[0]) * share);
            if found < depth[cell] {
                depth[cell] = found;
                let along = share * inverse[1] * found;
                let age = piece.ages[0] + (piece.ages[1] - piece.ages[0]) * along;
                let speed = synth.values.laws.at(&synth.lines[piece.line].path, age).1.length();
                out[cell] = [piece.line as f32 + 1.0, age as f32, speed as f32, 1.0];
            }
        };
        if way.x.abs() >= way.y.abs() {
            // As many pixels as there are columns: in each, the one that holds the line.
            let from = places[0].partition_point(|x| *x < a.x.min(b.x));
            for (cell, x) in places[0].iter().enumerate().skip(from).take_while(|(_, x)| **x <= a.x.max(b.x)) {
                let share = if way.x == 0.0 { 0.0 } else { (x - a.x) / way.x };
                let off = a.y + way.y * share - y;
                if (-0.5..0.5).contains(&off) {
                    put(cell, share);
                }
            }
        } else if low <= y && y <= high {
            let share = (y - a.y) / way.y;
            let x = a.x + way.x * share;
            let cell = places[0].partition_point(|place| *place <= x - 0.5);
            if places[0].get(cell).is_some_and(|place| *place <= x + 0.5) {
                put(cell, share);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::frame::WaterfallAt;
    use super::super::model::WaterfallLayer;
    use super::super::sprites::Source;
    use super::*;
    use crate::base::clip::Clip;
    use crate::base::picture::Picture;
    use crate::layers::parts::materials::Materials;
    use crate::layers::parts::moment::{Columns, Moment};
    use crate::layers::ready::{Making, Still};
    use crate::layers::space::camera::Camera;
    use crate::layers::timeline::Wrap;

    #[test]
    fn passes_are_the_same_where_nothing_is_cut_out_of_the_clip_for_them() {
        let layer = r#"{ "name": "f", "clip": "c", "lines": 24,
            "sprites": { "size": 16, "keys": 1, "picks": [{ "frame": 0, "at": [16, 16], "track": false }] } }"#;
        let layer: WaterfallLayer = serde_json::from_str(layer).unwrap();
        let frame = Arc::new(Picture::filled(32, 32, [1.0; 4]));
        let clip = Arc::new(Clip { fps: 25.0, frames: vec![frame; 2] });
        let materials = Materials { clips: [("c".to_owned(), clip)].into(), ..Materials::default() };
        let making = Making::plain(Wrap::Repeat, &materials);
        let [whole, bare] =
            [true, false].map(|painted| Synth::new(&layer, &Making { painted, ..making }, None).unwrap());
        assert_eq!([&whole, &bare].map(|synth| synth.pictures.tracks[0].source), [Source::Pick, Source::Auto]);
        let size_px = (64, 40);
        let eye = Some(Camera::default().at(0.3, size_px));
        let moment = Moment { t: 0.3, size_px, eye, left_out: 0, magnified: 1 };
        for pass in [LINES, SPRITES] {
            let rows = |synth: &Synth| {
                let seen = WaterfallAt::new(synth, &moment);
                let row = |y: usize| {
                    let (mut depth, mut out) = (vec![f64::INFINITY; 64], vec![[0.0; 4]; 64]);
                    seen.pass(&pass, y, Columns::All, &mut depth, &mut out);
                    out
                };
                (0..40).map(row).collect::<Vec<_>>()
            };
            let found = rows(&bare);
            assert!(found.iter().flatten().filter(|cell| cell[0] > 0.0).count() > 100, "{pass:?}");
            assert_eq!(found, rows(&whole), "{pass:?}");
        }
    }
}
